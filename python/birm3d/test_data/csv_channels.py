"""Channels from a table of comma-separated values with units in its head."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from .. import units
from ..channel import Channel
from ._lines import number, read_text

__all__ = ["read_csv_channels"]

# "force [kN]" or "force (kN)"
_HEAD = re.compile(r"\s*(.*?)\s*(?:\[([^\[\]]*)\]|\(([^()]*)\))\s*")
_DELIMITERS = ",;\t"


def read_csv_channels(
    path: str | Path,
    columns: Iterable[str] | None = None,
    *,
    time: str | None = None,
    cfc: float | None = None,
) -> dict[str, Channel]:
    """Read channels from a table.

    The head names each column with its unit, ``time [ms],force [kN]`` or ``time (ms);force (kN)``; or a
    second row of the head has the units alone. Columns are separated by commas, semicolons or tabs. Lines
    that start with ``#`` and empty lines are skipped.

    Parameters
    ----------
    path
        Text file in UTF-8.
    columns
        Names of the columns wanted, without their units; None: all but the time.
    time
        Name of the time column; None: the only one whose unit measures time.
    cfc
        Channel frequency class that all columns have been filtered to; None: none.

    Returns
    -------
    dict of Channel
        By name, in the order wanted; values in the file's units, time in s.

    Raises
    ------
    ValueError
        With file and line, if a name is missing or there twice, a unit is missing or unknown, there is no
        time column or no way to choose, a row has too few or too many cells or one that is no finite number,
        or time does not increase.
    """
    file = Path(path)
    lines = [
        (i, line)
        for i, line in enumerate(read_text(file).splitlines(), 1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    if not lines:
        raise ValueError(f"{file}: path must have a head and rows, got an empty table")
    delimiter = _delimiter(lines[0][1])
    rows = [
        (i, [cell.strip() for cell in next(csv.reader([line], delimiter=delimiter))]) for i, line in lines
    ]
    names, symbols, body = _head(file, rows)
    for line, cells in body:
        if len(cells) != len(names):
            raise ValueError(f"{file}:{line}: a row must have {len(names)} cells, got {len(cells)}")
    time_name = _time_column(file, rows[0][0], names, symbols, time)
    wanted = [name for name in names if name != time_name] if columns is None else list(columns)
    for name in wanted:
        if name not in names:
            raise ValueError(f"{file}:{rows[0][0]}: columns must be of {', '.join(names)}, got {name!r}")

    def column(name: str) -> list[float]:
        k = names.index(name)
        return [number(file, line, cells[k], f"column {name!r}") for line, cells in body]

    if len(body) < 2:
        raise ValueError(f"{file}:{rows[-1][0]}: a table must have at least two rows, got {len(body)}")
    instants = np.array(column(time_name)) * units.measure(symbols[names.index(time_name)]).size
    back = np.flatnonzero(np.diff(instants) <= 0.0)
    if len(back):
        row = int(back[0]) + 1
        raise ValueError(
            f"{file}:{body[row][0]}: {time_name!r} must be strictly increasing, got {instants[row - 1]:g} s "
            f"and then {instants[row]:g} s"
        )
    return {
        name: Channel(
            name, instants, np.array(column(name)), symbols[names.index(name)], cfc, f"{file.name}: {name}"
        )
        for name in wanted
    }


def _delimiter(head: str) -> str:
    return max(_DELIMITERS, key=head.count)


def _head(
    file: Path, rows: list[tuple[int, list[str]]]
) -> tuple[list[str], list[str], list[tuple[int, list[str]]]]:
    """Names and units of the columns, and the rows below the head."""
    line, cells = rows[0]
    matches = [_HEAD.fullmatch(cell) for cell in cells]
    if any(matches):
        names = [m[1] if m else cell for m, cell in zip(matches, cells, strict=True)]
        symbols = [(m[2] if m[2] is not None else m[3]) if m else "" for m in matches]
        body = rows[1:]
    else:
        if len(rows) < 2:
            raise ValueError(f"{file}:{line}: the head must have units, such as 'force [kN]', got none")
        names, (line, symbols), body = cells, rows[1], rows[2:]
        if len(symbols) != len(names):
            raise ValueError(
                f"{file}:{line}: the row of units must have {len(names)} cells, got {len(symbols)}"
            )
    for name, symbol in zip(names, symbols, strict=True):
        if not name or names.count(name) > 1:
            raise ValueError(f"{file}:{rows[0][0]}: columns must have names of their own, got {name!r} twice")
        try:
            units.measure(symbol)
        except ValueError as error:
            raise ValueError(f"{file}:{line}: column {name!r}: {error}") from None
    return names, symbols, body


def _time_column(file: Path, line: int, names: list[str], symbols: list[str], wanted: str | None) -> str:
    times = [n for n, s in zip(names, symbols, strict=True) if units.measure(s).quantity == "time"]
    if wanted is not None:
        if wanted not in times:
            raise ValueError(f"{file}:{line}: time must name a column of time ({times}), got {wanted!r}")
        return wanted
    if len(times) != 1:
        raise ValueError(f"{file}:{line}: time must be named unless one column is of time, got {times}")
    return times[0]
