"""Columns of the lines of a keyword file, cut out of all lines at once; fixed and free format."""

from __future__ import annotations

import re
from itertools import pairwise

import numpy as np
import numpy.typing as npt

__all__ = ["columns", "lines_of", "real", "whole"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

_SHORT_EXPONENT = re.compile(rb"(?<=[\d.])([+-]\d)")


def lines_of(body: bytes) -> list[bytes]:
    """Return the lines of a block that hold data."""
    return [line for line in body.replace(b"\r", b"").split(b"\n") if line.strip() and line[:1] != b"$"]


def columns(lines: list[bytes], widths: tuple[int, ...], long: bool) -> list[npt.NDArray[np.bytes_]]:
    """Return the first columns of all lines; empty ones are empty."""
    if any(b"&" in line for line in lines[:1]):
        raise ValueError(f"got the parameter in {lines[0].decode('latin-1').strip()!r}")
    if any(b"," in line for line in lines[:3]):
        rows = [[*(cell.strip() for cell in line.split(b",")), *([b""] * len(widths))] for line in lines]
        return [np.array([row[i] for row in rows], dtype=np.bytes_) for i in range(len(widths))]
    if long:
        widths = (20,) * len(widths)
    total = sum(widths)
    table = np.array([line[:total] for line in lines], dtype=f"S{total}").view("S1").reshape(-1, total)
    edges = np.cumsum((0, *widths))
    return [np.ascontiguousarray(table[:, a:b]).view(f"S{b - a}")[:, 0] for a, b in pairwise(edges.tolist())]


def whole(column: npt.NDArray[np.bytes_]) -> Ints:
    """Return a column of whole numbers; empty cells are 0."""
    return _filled(column).astype(np.int64)


def real(column: npt.NDArray[np.bytes_]) -> Floats:
    """Return a column of numbers; empty cells are 0."""
    column = _filled(column)
    try:
        return column.astype(np.float64)
    except ValueError:  # Fortran writes 1.5-3 for 1.5e-3
        return np.array([float(_SHORT_EXPONENT.sub(rb"e\1", cell.strip())) for cell in column.tolist()])


def _filled(column: npt.NDArray[np.bytes_]) -> npt.NDArray[np.bytes_]:
    """Return a column with 0 where it is empty."""
    stripped = np.strings.strip(column) if hasattr(np, "strings") else np.char.strip(column)
    return np.where(stripped == b"", b"0", stripped)
