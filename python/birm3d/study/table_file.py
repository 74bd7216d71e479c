"""Tables of studies, read from CSV files whose first line is a comment with the rest, as JSON."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ..io.file_format import FileFormatError, check_sum, read_bytes, read_json, reads, received

__all__ = ["read_table"]


@reads("must be a table of a study")
def read_table(path: Path, formats: Sequence[str], texts: Sequence[str]) -> dict[str, Any]:
    """Return the arguments of a study that its file has.

    Parameters
    ----------
    path
        File of :meth:`birm3d.Study.save`.
    formats
        Known ones; all but the last have a checksum.
    texts
        Names of the columns at the end, which are text.

    Raises
    ------
    FileFormatError
        With the line, if the file is no study, is damaged, or was changed after it was written.
    """
    first, _, rest = _text(path).partition("\n")
    head = _head(path, first, formats)
    names, lines = _lines(path, rest)
    found = head.pop("checksum", None)
    if head["format"] == formats[-1]:  # some of its files have no outcomes
        texts = [name for name in texts if name in names]
    kinds = head["parameters"]
    metrics = names[1 + len(kinds) : len(names) - len(texts)]
    if names != ["run", *kinds, *metrics, *texts] or len(set(names)) < len(names):
        wanted = f"run, {', '.join(kinds)}, metrics, {', '.join(texts)}"
        raise FileFormatError.at(path, 2, f"columns must be {wanted}, got {received(names)}")
    if found is not None or head["format"] != formats[-1]:  # that had none
        check_sum(path, found, [head, names, [cells for _, cells in lines]])

    def column(name: str) -> list[tuple[int, str]]:
        place = names.index(name)
        return [(line, cells[place]) for line, cells in lines]

    def numbers(name: str) -> list[float]:
        return [_number(path, line, cell, name) for line, cell in column(name)]

    return {
        "vehicle": head["vehicle"],
        "barrier": head.get("barrier", ""),  # not in files of older versions
        "run": [_whole(path, line, cell) for line, cell in column("run")],
        "parameters": {
            name: numbers(name) if kind == "f" else _objects([cell for _, cell in column(name)])
            for name, kind in kinds.items()
        },
        "metrics": {name: numbers(name) for name in metrics},
        **{name: [cell for _, cell in column(name)] for name in texts},
        "units": head["units"],
        "grid": head["grid"],
        "version": head["version"],
    }


def _text(path: Path) -> str:
    content = read_bytes(path)
    try:
        return content.decode("utf-8")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise FileFormatError.at(
            path, line, f"must be UTF-8 text, got byte {content[error.start]:#x}"
        ) from error


def _head(path: Path, line: str, formats: Sequence[str]) -> dict[str, Any]:
    known = " or ".join(map(repr, formats))
    if not line.startswith("# {"):
        raise FileFormatError.at(path, 1, f"must be a study with format {known}, got {received(line)}")
    head = read_json(path, line.removeprefix("# "))
    found = head.get("format")
    if found not in formats:
        raise FileFormatError.at(path, 1, f"must be a study with format {known}, got {received(found)}")
    kinds: dict[str, tuple[type, ...]] = {
        "vehicle": (str,), "version": (str,), "units": (dict,), "parameters": (dict,),
        "grid": (dict, type(None)),
    }  # fmt: skip
    if "barrier" in head:
        kinds["barrier"] = (str,)
    for key, kind in kinds.items():
        if not isinstance(head.get(key), kind):
            got = received(head[key]) if key in head else "none"
            raise FileFormatError.at(path, 1, f"{key} must be {_name(kind[0])}, got {got}")
    for key, values in _mappings(head):
        inner = list if key == "grid" else str
        for name, value in values.items():
            if not isinstance(value, inner):
                raise FileFormatError.at(
                    path, 1, f"{key}.{name} must be {_name(inner)}, got {received(value)}"
                )
    return dict(head)


def _mappings(head: Mapping[str, Any]) -> list[tuple[str, Mapping[str, Any]]]:
    return [(key, head[key]) for key in ("units", "parameters", "grid") if head[key] is not None]


def _name(kind: type) -> str:
    if kind is str:
        return "text"
    return "a mapping" if kind is dict else "a list"


def _lines(path: Path, text: str) -> tuple[list[str], list[tuple[int, list[str]]]]:
    """Return the names of the columns, and each row with the line on which it ends."""
    reader = csv.reader(io.StringIO(text, newline=""), strict=True)
    rows: list[tuple[int, list[str]]] = []
    try:
        for cells in reader:
            rows.append((reader.line_num + 1, cells))
    except csv.Error as error:
        raise FileFormatError.at(path, reader.line_num + 1, f"must be CSV: {error}") from error
    if not rows:
        raise FileFormatError.at(path, 2, "must have a line with the names of the columns, got none")
    names = rows[0][1]
    for line, cells in rows[1:]:
        if len(cells) != len(names):
            raise FileFormatError.at(path, line, f"a row must have {len(names)} cells, got {len(cells)}")
    return names, rows[1:]


def _number(path: Path, line: int, cell: str, name: str) -> float:
    if not cell:
        return math.nan
    try:
        value = float(cell)
    except ValueError:
        value = math.nan
    if math.isnan(value):
        raise FileFormatError.at(path, line, f"{name} must be a number or empty, got {received(cell)}")
    return value


def _whole(path: Path, line: int, cell: str) -> int:
    if not (cell.isascii() and cell.isdigit() and len(cell) <= 18):
        raise FileFormatError.at(path, line, f"run must be a whole number >= 0, got {received(cell)}")
    return int(cell)


def _objects(cells: list[str]) -> npt.NDArray[Any]:
    return np.array(cells, dtype=object)
