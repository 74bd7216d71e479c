"""What a reader of design loads has to know of them: their cautions, from all scenes together."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from ..barrier.kinds import Bollards
from .design_caution import barrier_caution
from .design_plan import ASSUMED_PERIOD, DesignPlan
from .design_table import DesignLoad
from .element_design import ElementDesign
from .oscillator import LEAST_INTERVALS
from .vehicles import HEAVY_KG

__all__ = ["ASSUMED", "design_cautions", "greatest_of_periods"]

ASSUMED = f"The natural period of {ASSUMED_PERIOD:g} s is assumed: give that of the element."
"""Caution where no natural period was given."""
_PERIODS, _POINTS = (0.03, 0.3), 31  # s: about a third to three times the period that is assumed
_MOST_OF_ONE_PULSE = 2.0  # no single pulse has a greater dynamic load factor
_CLOSE = 0.02  # of the spacing: offsets that are as near to a post or to the middle of a gap are there

_ADDED = (
    "A dynamic load factor above 2 has one of two causes. Blows follow each other while the element swings; "
    "damping lessens that. Or CFC60 cuts the peak off the peak force. On a wall that is one element, blows "
    "at distant places add up: give it segments."
)


_STATICS = (
    "Where a post yields, natural period and ductility do not change the equivalent static force: the run "
    "has spent the yielding already."
)
_BEYOND_YIELD = (
    "Some posts do not yield in the run that their equivalent static force comes from. That force, of an "
    "elastic system, is greater than the post resists: {posts}. Design their foundations for the lesser of "
    "two: what the post resists with the upper bound of its strength, and the elastic force."
)
_LOWEST = "Of several scenes, that force comes from the one with the shortest arm."

_LOWER_SPEEDS = (
    "A lower speed can load a post more: engine zones of light vehicles soften beyond 0.45 m of crush. Force "
    "and moment over 50 ms were up to 17 % greater at two thirds of the speed: list impact_speeds."
)


def design_cautions(
    load: DesignLoad,
    plan: DesignPlan,
    rows: Sequence[ElementDesign],
    of_runs: Iterable[str],
) -> Iterator[str]:
    """Yield the cautions of an envelope in the order of reading; the same sentence may come twice.

    Parameters
    ----------
    load
        The envelope.
    plan
        Its scenes.
    rows, of_runs
        Rows of all runs that are finished, and what their cautions are together.
    """
    yield from barrier_caution(plan.barrier)
    if any(row.has_yielded for row in load.rows):
        yield _STATICS
        if len(load.scenes) > 1:
            yield _LOWEST
    beyond = [
        f"{row.name}: {row.equivalent_static_force / 1e3:,.0f} kN, resistance {row.yield_force / 1e3:,.0f} kN"
        for row in load.rows
        if row.exceeds_yield
    ]
    if beyond:
        yield _BEYOND_YIELD.format(posts="; ".join(beyond))
    if plan.period_is_assumed and not all(row.has_yielded for row in load.rows if row.touched):
        yield ASSUMED
        yield from _of_other_periods(load)
    yield from of_runs
    least = 0.01 * max(row.peak_force for row in rows)  # what carries less than 1 % is left out
    if any(row.dynamic_load_factor > _MOST_OF_ONE_PULSE for row in rows if row.peak_force > least):
        yield _ADDED
    yield from _at_ends(load, plan)
    yield from _of_lower_speeds(plan)


def _of_lower_speeds(plan: DesignPlan) -> Iterator[str]:
    """Yield that a lower speed can load a post more, where only one speed is asked for."""
    light = any(scene.vehicle.mass <= HEAVY_KG for scene in plan.scenes)
    if light and isinstance(plan.barrier, Bollards) and len({s.impact_speed for s in plan.scenes}) == 1:
        yield _LOWER_SPEEDS


def _of_other_periods(load: DesignLoad) -> Iterator[str]:
    """Yield what the governing element carries at other periods than the one that was assumed."""
    found = greatest_of_periods(load)
    if found is not None:
        force, period = found
        times = force / load.governing.equivalent_static_force
        yield (
            f"With natural periods from {_PERIODS[0]:g} to {_PERIODS[1]:g} s, {load.governing.name} carries "
            f"up to {times:.2f} times the equivalent static force of this vehicle (at {period:.2g} s). "
            "Take the same factor on the design value."
        )
        if force > _MOST_OF_ONE_PULSE * load.governing.peak_force:
            yield _ADDED


def greatest_of_periods(load: DesignLoad) -> tuple[float, float] | None:
    """Return the greatest equivalent static force of the governing element [N], and its period [s].

    Over a third to three times the period that is assumed where none is given; ``None`` of one that nothing
    touches or that yields, or where the rows are too far apart.
    """
    row = load.governing
    if row.has_yielded or row.load is None or _PERIODS[0] < LEAST_INTERVALS * row.load.interval:
        return None
    periods = np.geomspace(*_PERIODS, _POINTS)
    forces = load.spectrum(periods)
    at = int(np.argmax(forces))
    return float(forces[at]), float(periods[at])


def _at_ends(load: DesignLoad, plan: DesignPlan) -> Iterator[str]:
    """Yield a sentence for each list whose first or last value governs: beyond it the load may be greater."""
    row = load.governing
    if not row.touched:
        return
    scene = load.scenes[row.scene["equivalent_static_force"]]
    for name in ("impact_offset", "impact_angle"):
        values = plan.varied.get(name, ())
        if name == "impact_offset" and _cover_the_row(values, plan):
            continue
        if len(set(values)) > 1 and getattr(scene, name) in (min(values), max(values)):
            words = name.replace("_", " ")
            if not (name == "impact_angle" and scene.impact_angle == 90.0):
                yield f"The governing load is at the end of the listed {words}s: add values beyond it."


def _cover_the_row(offsets: Sequence[float], plan: DesignPlan) -> bool:
    """Return whether all other offsets at a row of posts load it as some of these do, but at its ends.

    They do over a whole spacing. Square to the row they do over half a spacing, between a post and the middle
    of a gap: the rest is their mirror image.
    """
    barrier = plan.barrier
    if not isinstance(barrier, Bollards) or barrier.count < 2 or barrier.rows > 1 or len(offsets) < 2:
        return False
    low, high = min(offsets), max(offsets)
    shares = (high - low) / barrier.spacing
    if shares >= 1.0 - _CLOSE:
        return True
    if shares < 0.5 - _CLOSE or any(
        scene.impact_angle != 90.0 or scene.impact_yaw != 0.0 for scene in plan.scenes
    ):
        return False
    first = barrier.station() + barrier.places()[0][1]
    at = 2.0 * (low - first) / barrier.spacing
    return abs(at - round(at)) < 2.0 * _CLOSE
