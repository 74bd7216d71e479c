"""Channels from a table of comma-separated values with units in its head."""

from __future__ import annotations

import csv
from collections import Counter
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from ... import units
from ...io.file_format import FileFormatError, reads, received
from ..channel import Channel
from ._lines import number, read_text

__all__ = ["read_csv_channels"]

_DELIMITERS = ",;\t"


@reads("must be a table with units in its head")
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
    FileFormatError
        With file and line. If a name is missing or there twice, or a unit is missing or unknown. If there is
        no time column or no way to choose one, or time does not increase. If a row has too few or too many
        cells, or one that is no finite number.
    """
    file = Path(path)
    lines = [
        (i, line)
        for i, line in enumerate(read_text(file).splitlines(), 1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    if not lines:
        raise FileFormatError.at(file, None, "path must have a head and rows, got an empty table")
    delimiter = _delimiter(lines[0][1])
    rows = [
        (i, [cell.strip() for cell in next(csv.reader([line], delimiter=delimiter))]) for i, line in lines
    ]
    names, symbols, body = _head(file, rows)
    for line, cells in body:
        if len(cells) != len(names):
            raise FileFormatError.at(file, line, f"a row must have {len(names)} cells, got {len(cells)}")
    time_name = _time_column(file, rows[0][0], names, symbols, time)
    wanted = [name for name in names if name != time_name] if columns is None else list(columns)
    for name in wanted:
        if name not in names:
            raise FileFormatError.at(
                file, rows[0][0], f"columns must be of {', '.join(names)}, got {received(name)}"
            )

    def column(name: str) -> list[float]:
        k = names.index(name)
        return [number(file, line, cells[k], f"column {name!r}") for line, cells in body]

    if len(body) < 2:
        raise FileFormatError.at(file, rows[-1][0], f"a table must have at least two rows, got {len(body)}")
    instants = np.array(column(time_name)) * units.measure(symbols[names.index(time_name)]).size
    back = np.flatnonzero(np.diff(instants) <= 0.0)
    if len(back):
        row = int(back[0]) + 1
        raise FileFormatError.at(
            file,
            body[row][0],
            f"{time_name!r} must be strictly increasing, got {instants[row - 1]:g} s "
            f"and then {instants[row]:g} s",
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
    parts = [_name_and_unit(cell) for cell in cells]
    if any(parts):
        names = [part[0] if part else cell for part, cell in zip(parts, cells, strict=True)]
        symbols = [part[1] if part else "" for part in parts]
        body = rows[1:]
    else:
        if len(rows) < 2:
            raise FileFormatError.at(file, line, "the head must have units, such as 'force [kN]', got none")
        names, (line, symbols), body = cells, rows[1], rows[2:]
        if len(symbols) != len(names):
            raise FileFormatError.at(
                file, line, f"the row of units must have {len(names)} cells, got {len(symbols)}"
            )
    times = Counter(names)
    for name, symbol in zip(names, symbols, strict=True):
        if not name or times[name] > 1:
            raise FileFormatError.at(
                file, rows[0][0], f"columns must have names of their own, got {received(name)} twice"
            )
        try:
            units.measure(symbol)
        except ValueError as error:
            raise FileFormatError.at(file, line, f"column {received(name)}: {error}") from None
    return names, symbols, body


def _name_and_unit(cell: str) -> tuple[str, str] | None:
    """Take "force [kN]" or "force (kN)" apart; None: there is no unit."""
    cell = cell.strip()
    for opening, closing in ("[]", "()"):
        if cell.endswith(closing):
            name, found, unit = cell[:-1].rpartition(opening)
            if found and closing not in unit:
                return name.strip(), unit
    return None


def _time_column(file: Path, line: int, names: list[str], symbols: list[str], wanted: str | None) -> str:
    times = [n for n, s in zip(names, symbols, strict=True) if units.measure(s).quantity == "time"]
    if wanted is not None:
        if wanted not in times:
            raise FileFormatError.at(file, line, f"time must name a column of time ({times}), got {wanted!r}")
        return wanted
    if len(times) != 1:
        raise FileFormatError.at(file, line, f"time must be named unless one column is of time, got {times}")
    return times[0]
