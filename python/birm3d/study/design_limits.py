"""Searches that a designer asks for by name: greatest gap, least height, segment mass or wall of a tube."""

# Longer than 300 lines: four searches with arguments explained for users.
from __future__ import annotations

import dataclasses
import math
import warnings
from collections.abc import Callable, Sequence
from functools import partial
from operator import add
from typing import Any

from ..barrier.barrier import Barrier
from ..barrier.free_standing import FreeStanding
from ..barrier.kinds import PROFILES, Bollards, Jersey
from ..base.arguments import checked
from ..result.event import CONTAINED, HELD
from ..result.leaning_posts import LeaningPostWarning
from ..result.low_barrier import LowBarrierWarning
from ..result.tipping import RATIO, TIPPING_LIMIT, TippingWarning
from ..simulation.simulation import Simulation
from ..units import Quantity, si
from .limit_question import Question
from .limit_search import Effort, Limit, search_limit
from .runner import run_study

__all__ = [
    "OFFSET_SHARES",
    "OFFSET_SHARES_YIELDING",
    "greatest_gap",
    "least_height",
    "least_segment_mass",
    "least_tube_thickness",
]

OFFSET_SHARES = (-0.25, 0.0, 0.25, 0.5)
"""Impact offsets over the spacing, from the middle of a row of posts: at a post, in a gap, and between."""
OFFSET_SHARES_YIELDING = (-0.25, 0.0, 0.0625, 0.125, 0.1875, 0.25, 0.375, 0.5)
"""The same of posts that yield: a vehicle may be held at both places and go over the posts between them."""

_HEIGHTS, _ABOVE_BREAK, _INCH = (0.15, 1.3), 0.02, 0.0254  # m

# What IWA 14-2 and its forerunner PAS 69 ask for, as commonly reported: the texts are not at hand.
_SKIN = (
    "Computed, not tested. The vehicle's skin does not tear and its parts stay on: leave a margin. Guidance "
    "for security bollards asks for clear gaps of 1.2 m or less, whatever is computed."
)
_OVER = (
    "Computed, not tested. Here a barrier that catches the lower edge of the front holds the vehicle, though "
    "a real front rides up on it: do not go below {}. The springs of the vehicle "
    "are estimates: leave a margin. {} Guidance for security bollards asks for 0.5 m or more."
)
_RIGID = "The barrier does not give way under it."
_LEAN = "Posts that yield lean, and are lower then: look at post_tilt too."
_SLIDE = "Segments slide under it, but do not tip: look at max_overturning_ratio too."
_STRONG = "{:.2f} m: more than a third of the front's resistance would stand above the barrier"
_SLIDES = "Computed, not tested. Segments slide but do not tip, and their joints do not break."
_TIPS = (
    " At {value:,.0f} kg max_overturning_ratio is {ratio:.3g}: a segment would begin to tip, and the answer "
    "is not to be used unless something keeps it upright."
)
_STANDS = " At {value:,.0f} kg max_overturning_ratio is {ratio:.2f}: no segment would begin to tip."

_YIELDS = (
    "Computed, not tested. Tubes do not buckle or tear, whatever their D/t, and have the yield stress that "
    "they were given: look at post_tilt too. Where posts tilt far, a few percent of strength decide whether "
    "a vehicle is held or rides over: leave a margin. How firmly a front that has folded round a leaning "
    "post holds to it is not known from any test."
)


@checked
def greatest_gap(
    simulation: Simulation,
    gaps: Sequence[Quantity] = (0.5, 3.0),
    *,
    penetration: Quantity | None = None,
    offset_shares: Sequence[float] | None = None,
    points: int = 11,
    resolution: Quantity | None = None,
    draws: int | None = None,
    executor: Any = None,
    progress: bool | None = None,
) -> Limit:
    """Return the greatest clear gap between bollards that still stops the vehicle at every offset.

    The gap is ``spacing - diameter``. At each gap the vehicle is run at several offsets, head-on at a post
    and at the middle of a gap among them. A gap holds if no run gets past the row: its outcome is
    ``stopped``, ``redirected`` or ``rolled_over``.

    Parameters
    ----------
    simulation
        A scene with a row of at least two bollards, wider than the vehicle at every gap. Its own
        ``impact_offset`` counts for nothing.
    gaps
        (least, greatest) [m].
    penetration
        Greatest ``vehicle_penetration`` [m] that is allowed as well; ``None``: any.
    offset_shares
        Impact offsets over the spacing, counted from the row's middle. ``None``: :data:`OFFSET_SHARES`, of
        posts that yield :data:`OFFSET_SHARES_YIELDING`.
    points
        Of the scan of the range, >= 2; a bisection follows.
    resolution
        Width at which the bisection stops [m]; ``None``: a hundredth of the range.
    draws
        Number of vehicles of the class for which the limit and safer values are checked, a power of 2 from 8,
        or 0; see :func:`birm3d.predict`. ``None``: 16, where the vehicle's file says how its class scatters.
    executor, progress
        See :func:`birm3d.study.runner.run_study`.

    Raises
    ------
    ValueError
        Naming the argument, its limit and the value; :class:`birm3d.NotInRangeError` if the least gap does
        not hold.
    StudyInterrupted
        With the finished runs.

    Examples
    --------
    >>> found = birm3d.greatest_gap(sim, gaps=(0.8, 2.5))
    >>> found.value, found.fails_at, found.monotonic
    """
    row = _row(simulation)
    shares = _shares_of(row) if offset_shares is None else tuple(offset_shares)
    _check_offsets("offset_shares", shares)
    question = Question(
        name="clear gap",
        argument="gaps",
        unit="m",
        greatest=True,
        parameter="barrier.spacing",
        of_value=partial(add, row.diameter),
        offsets=partial(_along_row, row, shares),
        measure="vehicle_penetration",
        most=_at_most("penetration", penetration),
        caution=_SKIN,
    )
    limits = [si("gaps", gap, "length") for gap in gaps]
    _check_width(simulation, row, limits)
    effort = Effort(points, resolution, draws, executor, progress)
    return search_limit(simulation, question, limits, effort)


@checked
def least_height(
    simulation: Simulation,
    heights: Sequence[Quantity] | None = None,
    *,
    penetration: Quantity | None = None,
    offsets: Sequence[Quantity] | None = None,
    points: int = 11,
    resolution: Quantity | None = None,
    draws: int | None = None,
    executor: Any = None,
    progress: bool | None = None,
) -> Limit:
    """Return the least height of a barrier that the vehicle does not get over.

    A height holds if no run gets past the barrier, be it over or through it, or rolls over.

    Parameters
    ----------
    simulation
        A scene with a barrier that has a height, as bollards and Jersey barriers have.
    heights
        (least, greatest) [m], within what the barrier can have; ``None``: 0.15 to 1.3 m, of a Jersey barrier
        from just above the break of its face.
    penetration
        Greatest ``vehicle_penetration`` [m] that is allowed as well; ``None``: any.
    offsets
        ``impact_offset`` of the runs [m]. ``None``: in a row of posts those of :func:`greatest_gap`, else the
        scene's own.
    points, resolution, draws, executor, progress
        See :func:`greatest_gap`.

    Raises
    ------
    ValueError
        Naming the argument, its limit and the value; :class:`birm3d.NotInRangeError` if the greatest height
        does not hold.
    StudyInterrupted
        With the finished runs.
    """
    barrier = _barrier(simulation)
    if "height" not in (field.name for field in dataclasses.fields(barrier)):
        raise ValueError(
            f"simulation must have a barrier with a height, as bollards or a wall, "
            f"got {type(barrier).__name__}"
        )
    if isinstance(barrier, Jersey) and not isinstance(barrier.profile, str):
        raise ValueError("simulation must have a barrier of a named profile, got one of points")
    height = simulation.scene.vehicle.units[0]._strong_height
    question = Question(
        name="height",
        argument="heights",
        unit="m",
        greatest=False,
        parameter="barrier.height",
        of_value=float,
        offsets=_usual_offsets(simulation, barrier, offsets),
        measure="vehicle_penetration",
        most=_at_most("penetration", penetration),
        caution=_OVER.format(
            "the bumper beam" if height is None else _STRONG.format(height), _gives_way(barrier)
        ),
        outcomes=CONTAINED,  # who rolls over leans across the top
    )
    limits = _usual_heights(barrier) if heights is None else heights
    effort = Effort(points, resolution, draws, executor, progress)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", LowBarrierWarning)  # low heights are tried on purpose
        return search_limit(simulation, question, limits, effort)


@checked
def least_segment_mass(
    simulation: Simulation,
    masses: Sequence[Quantity] = (500.0, 8000.0),
    *,
    deflection: Quantity,
    offsets: Sequence[Quantity] | None = None,
    points: int = 11,
    resolution: Quantity | None = None,
    draws: int | None = None,
    executor: Any = None,
    progress: bool | None = None,
) -> Limit:
    """Return the least mass of a free-standing segment at which the barrier moves no further than a limit.

    A mass holds if no run gets over or through the barrier, and ``barrier_deflection`` is within the limit.
    A vehicle that slides to the end of pinned segments and passes it there is no failure, but it is said. The
    segments keep their shape; their density changes.

    Parameters
    ----------
    simulation
        A scene with a free-standing Jersey barrier, so long that the vehicle does not reach its end.
    masses
        Of one segment: (least, greatest) [kg].
    deflection
        Greatest ``barrier_deflection`` [m].
    offsets
        ``impact_offset`` of the runs [m]; ``None``: the scene's own.
    points, resolution, draws, executor, progress
        See :func:`greatest_gap`; the resolution in kg.

    Raises
    ------
    ValueError
        Naming the argument, its limit and the value; :class:`birm3d.NotInRangeError` if the greatest mass
        does not hold.
    StudyInterrupted
        With the finished runs.
    """
    barrier = _barrier(simulation)
    if not isinstance(barrier, Jersey) or barrier.free_standing is None:
        raise ValueError(f"simulation must have a free-standing Jersey barrier, got {barrier}")
    question = Question(
        name="segment mass",
        argument="masses",
        unit="kg",
        greatest=False,
        parameter="barrier.free_standing",
        of_value=partial(_with_mass, barrier.free_standing, barrier.length / barrier.segments),
        offsets=_usual_offsets(simulation, barrier, offsets),
        measure="barrier_deflection",
        most=_at_most("deflection", deflection),
        caution=_SLIDES,
        # Between pinned segments nothing passes: who is past the barrier and not over it has slid to its end.
        outcomes=(*HELD, "passed") if barrier.is_pinned else HELD,
        remark=_of_tipping,
    )
    effort = Effort(points, resolution, draws, executor, progress)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", TippingWarning)  # light segments are tried on purpose
        return search_limit(simulation, question, masses, effort)


@checked
def least_tube_thickness(
    simulation: Simulation,
    thicknesses: Sequence[Quantity] = (0.004, 0.03),
    *,
    deflection: Quantity | None = None,
    offsets: Sequence[Quantity] | None = None,
    points: int = 11,
    resolution: Quantity | None = None,
    draws: int | None = None,
    executor: Any = None,
    progress: bool | None = None,
) -> Limit:
    """Return the least wall of the steel tubes with which a row of bollards stops the vehicle.

    A wall thickness holds if no run gets over or through the row, and ``barrier_deflection``, that of a
    post's top, is within the limit. Diameter, steel and filling stay as they are.

    Parameters
    ----------
    simulation
        A scene with bollards that yield, of any ``wall_thickness``. A foundation that gives way before the
        tube does bounds what a thicker wall can do.
    thicknesses
        (least, greatest) [m]; at most half of the diameter.
    deflection
        Greatest ``barrier_deflection`` [m]; ``None``: any.
    offsets
        ``impact_offset`` of the runs [m]; ``None``: at a post, in a gap, and between; of
        one bollard the scene's.
    points, resolution, draws, executor, progress
        See :func:`greatest_gap`.

    Raises
    ------
    ValueError
        Naming the argument, its limit and the value; :class:`birm3d.NotInRangeError` if the greatest
        thickness does not hold.
    StudyInterrupted
        With the finished runs.
    """
    barrier = _barrier(simulation)
    if not isinstance(barrier, Bollards) or barrier.wall_thickness is None:
        raise ValueError(f"simulation must have bollards with a wall_thickness, got {barrier}")
    question = Question(
        name="tube thickness",
        argument="thicknesses",
        unit="m",
        greatest=False,
        parameter="barrier.wall_thickness",
        of_value=float,
        offsets=_usual_offsets(simulation, barrier, offsets),
        measure="barrier_deflection",
        most=_at_most("deflection", deflection),
        caution=_YIELDS,
    )
    effort = Effort(points, resolution, draws, executor, progress)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", LeaningPostWarning)  # weak tubes are tried on purpose
        return search_limit(simulation, question, thicknesses, effort)


def _of_tipping(simulation: Simulation, question: Question, value: float, executor: Any) -> str:
    """Return how far beyond tipping the segments are at a mass, the worst of all offsets."""
    study = run_study(
        simulation,
        (question.parameter, "impact_offset"),
        question.rows(value),
        metrics=[RATIO],
        executor=executor,
        progress=False,
    )
    ratio = float(study[RATIO].max())
    if math.isnan(ratio):
        return ""  # without gravity nothing holds a segment down
    return (_TIPS if ratio > TIPPING_LIMIT else _STANDS).format(value=value, ratio=ratio)


def _barrier(simulation: Simulation) -> Barrier:
    barrier = simulation.scene.barrier
    if barrier is None:
        raise ValueError("simulation must have a barrier, got none")
    return barrier


def _row(simulation: Simulation) -> Bollards:
    barrier = _barrier(simulation)
    if not isinstance(barrier, Bollards) or barrier.count < 2:
        raise ValueError(f"simulation must have a row of at least two bollards, got {barrier}")
    return barrier


def _check_width(simulation: Simulation, row: Bollards, gaps: Sequence[float]) -> None:
    """Refuse a row that the vehicle could pass beside."""
    width = simulation.scene.vehicle.width
    covered = (row.count - 1) * (gaps[0] + row.diameter) if gaps else 0.0
    if width is not None and gaps and covered < width:
        raise ValueError(
            f"gaps must leave a row wider than the vehicle ({width:.3g} m), got {gaps[0]:g} m between "
            f"{row.count} bollards: give more bollards"
        )


def _gives_way(barrier: Barrier) -> str:
    """Return what becomes of the barrier while the vehicle stands on it, as a sentence."""
    if barrier.stands_free() is not None:
        return _SLIDE
    return _RIGID if barrier.yields() is None else _LEAN


def _usual_heights(barrier: Barrier) -> tuple[float, float]:
    low, high = _HEIGHTS
    if isinstance(barrier, Jersey) and isinstance(barrier.profile, str):
        low = max(low, PROFILES[barrier.profile][-1][1] * _INCH + _ABOVE_BREAK)
    return low, high


def _shares_of(row: Bollards) -> tuple[float, ...]:
    return OFFSET_SHARES if row.yields() is None else OFFSET_SHARES_YIELDING


def _usual_offsets(
    simulation: Simulation, barrier: Barrier, offsets: Sequence[Quantity] | None
) -> Callable[[float], Sequence[float]]:
    """Return the offsets of a search in which the spacing does not change."""
    if offsets is not None:
        listed = [si("offsets", offset, "length") for offset in offsets]
        _check_offsets("offsets", listed)
    elif isinstance(barrier, Bollards) and barrier.count > 1:
        listed = [barrier.station() + share * barrier.spacing for share in _shares_of(barrier)]
    else:
        listed = [simulation.scene.impact_offset]
    return partial(_at_any_value, listed)


def _at_any_value(offsets: Sequence[float], _value: float) -> Sequence[float]:
    """Return the same offsets [m] whatever the value."""
    return offsets


def _along_row(row: Bollards, shares: Sequence[float], gap: float) -> Sequence[float]:
    """Return the offsets [m] at a clear gap [m], from those over the spacing."""
    return [row.station() + share * (gap + row.diameter) for share in shares]


def _with_mass(free: FreeStanding, length: float, mass: float) -> FreeStanding:
    """Return free-standing segments of this length [m] and mass [kg]."""
    return dataclasses.replace(free, density=None, mass_per_length=mass / length)


def _check_offsets(name: str, offsets: Sequence[float]) -> None:
    if len(offsets) == 0:
        raise ValueError(f"{name} must be at least one, got an empty list")
    for offset in offsets:
        if not math.isfinite(offset):
            raise ValueError(f"{name} must be finite, got {offset}")


def _at_most(name: str, value: Quantity | None) -> float | None:
    if value is None:
        return None
    found = si(name, value, "length")
    if not found >= 0.0:
        raise ValueError(f"{name} must be >= 0 m, got {found}")
    return found
