"""What the cells of a load-cell wall have measured, as a load map.

Cells are known by row and column, in one of two ways. ``A1`` has a letter for the row and a number for the
column, as load-cell walls of crash laboratories have them; ``R1C1`` has two numbers. Words may stand before
them, as in ``load cell B07``. Row A is the lowest and column 1 is on the left, as the vehicle sees the wall,
unless told otherwise: laboratories differ, and the drawing in the test report decides.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import numpy.typing as npt

from ..base.arguments import checked
from ..signals.channel import Channel
from ..signals.readers import read_csv_channels
from ..units import Quantity, si
from .face_grid import edges_of_cells
from .load_map import LoadMap

__all__ = ["measured_load_map", "read_load_cells"]

_LEAST_CLASS = 60.0  # SAE J211-1, barrier forces
_SAME_INSTANT = 1e-9  # s
_MOST_BEFORE = 0.02  # of the impulse, before time zero: what offsets of good cells leave there
_LETTER = re.compile(r"(?:.*[^A-Za-z0-9])?([A-Za-z])[ _-]?0*([1-9]\d?)")
_NUMBERS = re.compile(
    r"(?:.*[^a-z0-9])?r(?:ow)?[ _-]?0*([1-9]\d?)[ _-]*c(?:ol(?:umn)?)?[ _-]?0*([1-9]\d?)", re.I
)


@checked
def read_load_cells(
    path: str | Path,
    *,
    lateral: npt.ArrayLike,
    height: npt.ArrayLike,
    first_row: str = "bottom",
    first_column: str = "left",
    time: str | None = None,
    cfc: float | None = None,
    time_zero: Quantity = 0.0,
) -> LoadMap:
    """Return the load map that a load-cell wall has measured, from a table with a column for each cell.

    The head names the columns with their units: ``time [ms],A1 [kN],A2 [kN],...,D9 [kN]``. Separators,
    comments and a row of units are those of :func:`birm3d.read_csv_channels`. Cells are named by row and
    column, as ``A1`` or ``R1C1``, see :mod:`birm3d.result.measured_cells`. Columns that measure no force or
    are not named so, as a sum, are left out.

    Parameters
    ----------
    path
        Text file in UTF-8.
    lateral, height
        Increasing edges of the columns and rows of cells, as of :meth:`birm3d.Result.load_map` [m]. Lateral
        ones are along the line from the barrier's origin, positive to the vehicle's left; heights are above
        the wall's foot.
    first_row
        Where row A or 1 is: ``"bottom"`` or ``"top"``.
    first_column
        Where column 1 is, as the vehicle sees the wall: ``"left"`` or ``"right"``.
    time
        Name of the time column; ``None``: the only one whose unit measures time.
    cfc
        Channel frequency class that the forces have been filtered to; ``None``: none.
    time_zero
        Instant of the first contact in the file's time [s].

    Raises
    ------
    FileFormatError
        If the table can not be read; see :func:`birm3d.read_csv_channels`.
    ValueError
        As :func:`birm3d.measured_load_map`.
    """
    channels = read_csv_channels(path, time=time, cfc=cfc)
    return measured_load_map(
        channels, lateral=lateral, height=height, first_row=first_row, first_column=first_column,
        time_zero=time_zero, title=Path(path).name,
    )  # fmt: skip


@checked
def measured_load_map(
    channels: Mapping[str, Channel],
    *,
    lateral: npt.ArrayLike,
    height: npt.ArrayLike,
    first_row: str = "bottom",
    first_column: str = "left",
    time_zero: Quantity = 0.0,
    title: str = "measured",
) -> LoadMap:
    """Return the load map of channels of a load-cell wall, whatever file they are from.

    Parameters
    ----------
    channels
        Name of the cell, as ``"A1"`` or ``"R1C1"``, to its force; positive where the vehicle presses. Those
        that measure no force or are not named so are left out.
    lateral, height, first_row, first_column, time_zero
        As of :func:`birm3d.read_load_cells`.
    title
        What figures call the test.

    Raises
    ------
    ValueError
        If a cell of the grid has no channel or two, or a channel is of a cell that the grid has not. If
        channels differ in filter class or instants, are not evenly sampled, or have a class below CFC 60. If
        the wall pulls on the whole. If `time_zero` is outside the record, or more than 2 % of the impulse is
        before it.
    """
    edges = edges_of_cells("lateral", lateral), edges_of_cells("height", height)
    columns, rows = (len(one) - 1 for one in edges)
    for name, value, known in (
        ("first_row", first_row, ("bottom", "top")),
        ("first_column", first_column, ("left", "right")),
    ):
        if value not in known:
            raise ValueError(f"{name} must be {' or '.join(map(repr, known))}, got {value!r}")
    cells = _by_place(channels, rows, columns)
    first = cells[0, 0]
    _require_alike(cells, first)
    zero = si("time_zero", time_zero, "time")
    if not first.time[0] <= zero < first.time[-1]:
        raise ValueError(
            f"time_zero must be within the record, {first.time[0]:g} to {first.time[-1]:g} s, got {zero:g}"
        )
    force = np.empty((len(first), rows, columns))
    for (row, column), channel in cells.items():
        i = row if first_row == "bottom" else rows - 1 - row
        j = column if first_column == "right" else columns - 1 - column  # y runs to the left
        force[:, i, j] = channel.to_si().values
    _check_sum(force.sum(axis=(1, 2)) * first.interval, first.time < zero)
    time = first.time[0] - zero + first.interval * np.arange(len(first))
    return LoadMap(time, *edges, force, np.zeros(len(first)), title, first.cfc, first_contact=0.0)


def _check_sum(impulses: npt.NDArray[np.float64], before: npt.NDArray[np.bool_]) -> None:
    """Refuse impulses of the rows [N s] that pull, or that begin before time zero."""
    total = impulses.sum()
    if total < 0.0:
        raise ValueError(
            f"channels must be positive where the vehicle presses on the wall, got {total / 1e3:.3g} kN s in "
            "all; turn them by Channel.flipped and give them to measured_load_map"
        )
    early = impulses[before].sum()
    if abs(early) > _MOST_BEFORE * total:
        raise ValueError(
            f"time_zero must be the first contact, with at most {_MOST_BEFORE:.0%} of the impulse before it; "
            f"got {early / 1e3:.3g} of {total / 1e3:.3g} kN s. Shift it, or take off the cells' offsets "
            "(Channel.without_bias)"
        )


def _by_place(channels: Mapping[str, Channel], rows: int, columns: int) -> dict[tuple[int, int], Channel]:
    """Return the channels of cells by row and column, from 0, in the order of the cells.

    Raises
    ------
    ValueError
        If a cell has none or two, or one is of a cell that the grid has not.
    """
    grid = f"the {rows} x {columns} cells that height and lateral have, {_cell(0, 0)} to "
    grid += _cell(rows - 1, columns - 1)
    found: dict[tuple[int, int], Channel] = {}
    names: dict[tuple[int, int], str] = {}
    for name, channel in channels.items():
        place = _place_of(name)
        if place is None or channel.quantity != "force":
            continue
        if not (place[0] < rows and place[1] < columns):
            raise ValueError(f"channels must be of {grid}; got {name!r}")
        if place in names:
            raise ValueError(f"channels must have one of each cell, got {names[place]!r} and {name!r}")
        found[place], names[place] = channel, name
    missing = [_cell(*place) for place in np.ndindex(rows, columns) if place not in found]
    if missing:
        few = ", ".join(missing[:8]) + (f" and {len(missing) - 8} more" if len(missing) > 8 else "")
        raise ValueError(f"channels must have a force of each of {grid}; got none of {few}")
    return {place: found[place] for place in np.ndindex(rows, columns)}


def _place_of(name: str) -> tuple[int, int] | None:
    """Return row and column, from 0, of a cell's name; ``None`` where it is no such name."""
    if (numbers := _NUMBERS.fullmatch(name.strip())) is not None:
        return int(numbers[1]) - 1, int(numbers[2]) - 1
    if (letter := _LETTER.fullmatch(name.strip())) is not None:
        return ord(letter[1].upper()) - ord("A"), int(letter[2]) - 1
    return None


def _cell(row: int, column: int) -> str:
    return f"{chr(ord('A') + row)}{column + 1}" if row < 26 else f"R{row + 1}C{column + 1}"


def _require_alike(cells: Mapping[tuple[int, int], Channel], first: Channel) -> None:
    """Refuse channels that differ in filter class or instants, or have too low a class."""
    if first.cfc is not None and first.cfc < _LEAST_CLASS:
        raise ValueError(f"cfc must be at least {_LEAST_CLASS:g} (SAE J211-1, barrier), got {first.cfc:g}")
    for channel in cells.values():
        if channel.cfc != first.cfc:
            raise ValueError(
                f"channels must have one cfc, got {first.cfc} of {first.name!r} and {channel.cfc} of "
                f"{channel.name!r}"
            )
        if len(channel) != len(first) or np.abs(channel.time - first.time).max() > _SAME_INSTANT:
            raise ValueError(f"channels must have the same instants, got others in {channel.name!r}")
