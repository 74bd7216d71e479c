"""Bands of design loads over the vehicles of a class."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from ..base.frozen_mapping import FrozenMapping
from ..result.result import Result
from ..scene.scene import Scene
from ..simulation.parameters import varied_scene
from ..simulation.simulation import Simulation
from ..study.class_draws import check_draws, drawn_parameters
from ..study.predict import SHARE, quantiles
from .design_cells import load_text
from .element_design import BANDED, DESIGNED, ElementDesign

__all__ = ["Bands", "ClassDraws", "Seen", "bands_of", "class_draws", "governing_scenes", "with_bands"]

Seen = tuple[list[ElementDesign], bool]
"""What each element carries in a run, and whether the rigid body strikes one."""

_DRAWS = 16
_OF_FORCE = ("height", "direction")  # where and in which direction the greatest 50-ms force acts

_BLOWS = (
    "With {n} of {all} vehicles of the class a crush zone is used up and the rigid body strikes. The design "
    "values of peak, equivalent static force and moment rest on that blow and are too high."
)
_BLOWS_OF_PEAKS = (
    "With {n} of {all} vehicles of the class a crush zone is used up and the rigid body strikes. The design "
    "values of peak force rest on that blow and are too high."
)
_BEYOND_YIELD = (
    "With {n} of {all} vehicles of the class a post does not yield in the run, but the elastic equivalent "
    "static force is more than it resists."
)
_BELOW = (
    "On {elements}, {values} of this vehicle {verb} below the band: do not design with it. Most vehicles "
    "of the class ask for more. The design value is the upper end of the band."
)
_ABOVE = (
    "On {elements}, {values} of this vehicle {verb} above the band: most vehicles of the class ask for less. "
    "The design value is this vehicle's own."
)
_NAMES = {
    **{name: name.replace("_", " ") for name in BANDED},
    "force_50ms": "50-ms force",
    "longitudinal_force_50ms": "50-ms force along the barrier",
    "moment": "50-ms moment",
}
_LEAST_SHARE = 0.01  # elements that carry less than this share of the greatest load are not mentioned
_FAILED = "{n} of {all} vehicles of the class could not be run and are not in the bands."


class Bands(NamedTuple):
    """Rows with their bands, and cautions about these."""

    rows: tuple[ElementDesign, ...]
    cautions: list[str]


class ClassDraws(NamedTuple):
    """Vehicles that are drawn for each scene; none: why there is no band."""

    power: int | None
    reason: str

    @property
    def vehicles(self) -> int:
        """Number of vehicles."""
        return 0 if self.power is None else 2**self.power


def class_draws(scenes: Iterable[Scene], draws: int | None, refusal: str) -> ClassDraws:
    """Return how many vehicles are drawn.

    Parameters
    ----------
    scenes
        Of the envelope.
    draws
        As asked for; ``None``: 16 where every vehicle's file says how its class scatters.
    refusal
        Why these cases can not have a band; "" where they can.

    Raises
    ------
    ValueError
        If draws are asked for that are no power of 2, or that can not be made.
    """
    if draws == 0:
        return ClassDraws(None, "no vehicles of its class were drawn (draws=0)")
    if not refusal:
        silent = [one.vehicle.name for one in scenes if not any(u.scatter for u in one.vehicle.units)]
        refusal = f"the file of {silent[0]!r} says nothing of its class" if silent else ""
    if refusal:
        if draws is not None:
            raise ValueError(f"draws must be 0 where {refusal}, got {draws}")
        return ClassDraws(None, refusal)
    return ClassDraws(check_draws("draws", _DRAWS if draws is None else draws), "")


def governing_scenes(rows: Iterable[ElementDesign]) -> list[int]:
    """Return the numbers of the scenes that some value of the envelope comes from."""
    return sorted({number for row in rows for number in row.scene.values()})


def with_bands(
    rows: Sequence[ElementDesign],
    scenes: Mapping[int, Scene],
    power: int,
    look: Callable[[Result], Seen],
    **how: Any,
) -> Bands:
    """Return rows of an envelope with the bands of their values over vehicles of the class.

    Each vehicle is run in every scene; of each value its greatest over the scenes counts. Vehicles with
    a run that fails are left out.

    Parameters
    ----------
    rows
        Of the envelope.
    scenes
        Those that govern.
    power
        Of two: the number of vehicles.
    look
        Returns what each element carries in a run, and whether the rigid body strikes one.
    how
        Executor and progress, see :func:`birm3d.study.whole_runs.look_at_runs`.
    """
    from ..study.whole_runs import look_at_runs

    drawn: list[Scene] = []
    for scene in scenes.values():
        columns = drawn_parameters(Simulation.from_scene(scene), power)
        for j in range(2**power):
            drawn.append(varied_scene(scene, {name: float(values[j]) for name, values in columns.items()}))
    seen: list[tuple[int, Seen | None]] = [
        (one.run % 2**power, one.found)
        for one in look_at_runs(drawn, look, title="bands of design loads", **how)
    ]
    return bands_of(rows, seen, 2**power)


def bands_of(rows: Sequence[ElementDesign], seen: Iterable[tuple[int, Seen | None]], vehicles: int) -> Bands:
    """Return rows of an envelope with the bands of what vehicles of the class were seen to do.

    Parameters
    ----------
    rows
        Of the envelope.
    seen
        Number of the vehicle, and what each element carries in a run of it; ``None``: the run failed.
    vehicles
        How many were drawn.
    """
    found: dict[int, list[list[ElementDesign]]] = {}
    failed: set[int] = set()
    struck: set[int] = set()
    beyond: set[int] = set()
    for vehicle, one in seen:
        if one is None:
            failed.add(vehicle)
            continue
        designs, blow = one
        found.setdefault(vehicle, []).append(designs)
        if blow:
            struck.add(vehicle)
        if any(design.exceeds_yield for design in designs):
            beyond.add(vehicle)
    whole = [runs for vehicle, runs in found.items() if vehicle not in failed]
    banded = tuple(_banded(row, [[run[i] for run in runs] for runs in whole]) for i, row in enumerate(rows))
    by_statics = all(row.has_yielded for row in banded if row.touched)
    counts = (
        (_BLOWS_OF_PEAKS if by_statics else _BLOWS, len(struck)),
        (_BEYOND_YIELD, len(beyond)),
        (_FAILED, len(failed)),
    )
    cautions = [text.format(n=n, all=vehicles) for text, n in counts if n]
    return Bands(banded, cautions + list(_of_outside(banded)))


def _of_outside(rows: Sequence[ElementDesign]) -> Iterator[str]:
    """Yield which values lie below or above their bands, once for all elements with the same ones."""
    least = _LEAST_SHARE * max((row.peak_force for row in rows), default=0.0)
    for text, sign in ((_BELOW, 1.0), (_ABOVE, -1.0)):
        elements: dict[tuple[str, ...], list[str]] = {}
        for row in rows:
            names = tuple(_outside(row, sign)) if row.peak_force > least else ()
            if names:
                elements.setdefault(names, []).append(row.name)
        for names, found in elements.items():
            verb = "lies" if len(names) == 1 else "lie"
            yield text.format(elements=", ".join(found), values=_listed(names), verb=verb)


def _outside(row: ElementDesign, sign: float) -> Iterator[str]:
    """Yield the values of a row that lie below their bands (sign 1), or above them (sign -1).

    A value that is printed as the end of its band is not outside of it.
    """
    for name in DESIGNED:
        if name not in row.band:
            continue
        value, ends = getattr(row, name), row.band[name]
        if name == "impulse" and value < 0.0:  # away from the barrier: its size counts
            value, ends = -value, (-ends[1], -ends[0])
        end = ends[0] if sign > 0.0 else ends[1]
        if sign * (end - value) > 0.0 and load_text(name, value) != load_text(name, end):
            yield _NAMES[name]


def _listed(names: Sequence[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


def _banded(row: ElementDesign, vehicles: Sequence[Sequence[ElementDesign]]) -> ElementDesign:
    """Return a row with its bands; of each vehicle there is what the element carries in every scene."""
    if not vehicles or not row.scene:
        return row
    bands = {}
    for name in BANDED:
        values = np.array([_enveloped(runs, name) for runs in vehicles])
        low, _, high = quantiles(values, SHARE)
        bands[name] = (low, high)
    return replace(row, band=FrozenMapping(bands))


def _enveloped(runs: Sequence[ElementDesign], name: str) -> float:
    """Return the value of one vehicle over all scenes, as the row of an envelope has it."""
    if name == "dynamic_load_factor":
        peak = _enveloped(runs, "peak_force")
        return _enveloped(runs, "equivalent_static_force") / peak if peak > 0.0 else 0.0
    by = "force_50ms" if name in _OF_FORCE else name
    return float(getattr(max(runs, key=lambda one: abs(getattr(one, by))), name))
