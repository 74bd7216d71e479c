"""Loads on each element of the barrier: tables, histories and files to hand on."""

from __future__ import annotations

import csv
import io

from ..assessment.design_caution import height_caution
from ..barrier.barrier import Barrier
from ..barrier.kinds import Bollards
from ..result.barrier_fronts import front_of
from ..result.element_loads import touched_elements
from ..result.metrics import METRIC_UNITS
from ..result.result import Result
from ..result.summary import ELEMENT_COLUMNS, element_rows
from .blocks import Block, Caution, Items, Section, Table, Text
from .figures import figure
from .study_case import Case

__all__ = ["load_section", "loads_csv", "metrics_csv"]

_IMPULSE = "Impulse: until the vehicle leaves the barrier or comes to rest; what follows is not in it."
_DESIGN_WITH = (
    "A peak after CFC 60 may last some milliseconds: design with the 50-ms means or with a response of the "
    "element. The file has the unfiltered peaks too."
)
_FIXED = (
    "The barrier is rigid: it takes the greatest force that the vehicle can press it with. A barrier that "
    "gives way takes less force over a longer time."
)
_YIELDING = (
    "The posts yield: {what} of {moment:,.0f} kN m limits the force, beside the inertia of the post. {more}"
)
_STEEL = "Steel that is stronger than nominal loads the foundation more."
_SOIL = "Soil or steel that is stronger than given loads the post and its foundation more."
_FREE = (
    "The segments stand free: their inertia and the friction of their bases limit the force. The ground gets "
    "no more than that friction."
)

_WHOLE_FORCE = (
    "Whole forces have their parts up and along the line. The lateral force is horizontal, of walls across "
    "their line; design loads have this one. Each greatest value is of an instant of its own: a moment is "
    "not a force times its height."
)


def load_section(case: Case) -> Section:
    """Return what each element that was touched has to carry."""
    rows = element_rows(case.result)
    if case.result.scene.barrier is None or not rows:
        return Section("Loads on the barrier", "loads", [Text("Nothing of a barrier was touched.")])
    blocks: list[Block] = [
        Table(
            "Loads on each element that was touched", ELEMENT_COLUMNS, rows, note=_WHOLE_FORCE, numbers=True
        ),
        figure(case.result.plot_elements(), "Loads on the elements over time"),
        *_map_blocks(case.result),
        *_design_blocks(case),
        Caution(f"{_gives_way(case.result.scene.barrier)} {_DESIGN_WITH}"),
        Items(links=(("The same table with all digits, SI", "loads.csv"),)),
    ]
    return Section("Loads on the barrier", "loads", blocks)


def _gives_way(barrier: Barrier) -> str:
    """Return what limits the force on a barrier: nothing, what its posts resist, or its inertia."""
    if barrier.stands_free() is not None:
        return _FREE
    weaker = barrier.weaker if isinstance(barrier, Bollards) else None
    if weaker is None:
        return _FIXED
    turns = weaker.foundation_turns
    what = "the moment of their foundation" if turns else "the plastic moment of their tubes"
    return _YIELDING.format(
        what=what, moment=weaker.posts.plastic_moment / 1e3, more=_SOIL if turns else _STEEL
    )


def _map_blocks(result: Result) -> list[Block]:
    """Return the picture of the load by cell; of a barrier that has none nothing."""
    try:
        front_of(result.scene.barrier)
    except ValueError:  # meshes, segments that move and several rows of posts have no load map
        return []
    note = "Load on the barrier by cell, seen from the vehicle; the cells add up to the force across its line"
    return [figure(result.load_map().plot(), note)]


def _design_blocks(case: Case) -> list[Block]:
    loads = case.design_loads
    if isinstance(loads, str):
        low = height_caution(case.result)
        return [Text(f"Design loads are not computed: {loads}"), *([Caution(low)] if low else [])]
    cells = [cells for row, cells in zip(loads.rows, loads._cells(), strict=True) if row.touched]
    note = " ".join([*loads._legend(), loads.basis, _IMPULSE])
    return [
        Table(loads.title, loads._head(), cells, note=note, numbers=True),
        figure(loads.plot(), "Design loads: elements, histories of the governing one, response spectrum"),
        Caution(loads.caution),
        Items(links=(("Design loads with all digits, SI", "design_loads.csv"),)),
    ]


def loads_csv(result: Result) -> bytes:
    """Return the loads as a file, SI, all digits."""
    names = (
        *("peak_force", "peak_force_50ms", "height_at_peak"),
        *("peak_overturning_moment", "peak_overturning_moment_50ms"),
        *("peak_force_cfc60", "peak_lateral_force_50ms"),
    )
    units = ("N", "N", "m", "N m", "N m", "N", "N")
    head = ["element", *(f"{name} [{unit}]" for name, unit in zip(names, units, strict=True))]
    rows = [
        [load.name, *(repr(getattr(load, name)) for name in names)]
        for load in touched_elements(result.element_loads)
    ]
    return _csv([head, *rows])


def metrics_csv(result: Result) -> bytes:
    """Return all metrics as a file, SI and degrees, all digits."""
    rows = [[name, repr(value), METRIC_UNITS.get(name, "")] for name, value in result.metrics.items()]
    return _csv([["metric", "value", "unit"], *rows])


def _csv(rows: list[list[str]]) -> bytes:
    stream = io.StringIO()
    csv.writer(stream, lineterminator="\n").writerows(rows)
    return stream.getvalue().encode()
