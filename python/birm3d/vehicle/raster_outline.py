"""Outline of very many triangles seen from above, by the cells of a grid that they cover."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import shapely
from scipy import ndimage

__all__ = ["CELL", "raster_outline"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]
Mask = npt.NDArray[np.bool_]
Outline: TypeAlias = Any
"""A polygon of shapely, or several."""

CELL = 0.01
"""Size of the cells [m]; the outline is as accurate."""

_COARSE = 4  # cells of a coarse one, in which the inner part is found
_LEAST_PART = 10  # cells of a part; fewer are what is left of a sliver
_SIMPLER = 0.7  # cells by which the outline's steps are smoothed


def raster_outline(places: Floats, triangles: Ints) -> Outline:
    """Return the outline of the union of triangles, to the size of a cell.

    Triangles in the inner part are left out: around them all places are covered, so that they do not show in
    the outline. Holes and slits of less than 4 cm may be filled.

    Parameters
    ----------
    places
        Corners, shape (n, 2) [m].
    triangles
        Rows of them, shape (k, 3).
    """
    low = np.floor(places.min(axis=0) / CELL) - 2.0
    cells = places / CELL - low
    inner = _inner(cells, triangles)
    at = (cells / _COARSE).astype(np.int64)
    inside = inner[at[:, 0], at[:, 1]]
    covered: Mask = np.kron(inner, np.ones((_COARSE, _COARSE), bool))
    a, b, c = triangles.T
    _fill(covered, cells[triangles[~(inside[a] & inside[b] & inside[c])]])
    closed: Mask = ndimage.binary_closing(covered, np.ones((3, 3), bool))
    steps = (_boxes(closed) + low[[0, 1, 0, 1]]) * CELL
    parts = shapely.get_parts(shapely.union_all(shapely.box(*steps.T)))
    area = shapely.area(parts)
    large = parts[area >= min(_LEAST_PART * CELL**2, area.max(initial=0.0))]
    return shapely.union_all(large).simplify(_SIMPLER * CELL)


def _inner(cells: Floats, triangles: Ints) -> Mask:
    """Return the coarse cells around which all have a corner or a middle of a triangle."""
    a, b, c = triangles.T
    points = np.vstack([cells, (cells[a] + cells[b] + cells[c]) / 3.0]) / _COARSE
    hit: Mask = np.zeros(np.ceil(cells.max(axis=0) / _COARSE).astype(int) + 2, bool)
    rows = points.astype(np.int64)
    hit[rows[:, 0], rows[:, 1]] = True
    inner: Mask = ndimage.binary_erosion(hit, np.ones((3, 3), bool))
    return inner


def _fill(covered: Mask, corners: Floats) -> None:
    """Mark the cells whose middles lie in a triangle, shape (k, 3, 2): row by row, from side to side."""
    width = covered.shape[1] + 1
    begins, ends = [], []
    row = np.ceil(corners[:, :, 0].min(axis=1) - 0.5).astype(np.int64)
    last = np.floor(corners[:, :, 0].max(axis=1) - 0.5).astype(np.int64)
    while len(row := row[left := row <= last]):
        corners, last = corners[left], last[left]
        low, high = _side_to_side(corners, row + 0.5)
        first, past = np.ceil(low - 0.5), np.floor(high - 0.5) + 1.0
        wide = past > first
        begins.append((row * width + first)[wide])
        ends.append((row * width + past)[wide])
        row = row + 1
    if not begins:
        return
    size = covered.shape[0] * width
    begun, ended = (
        np.bincount(np.concatenate(one).astype(np.int64), minlength=size) for one in (begins, ends)
    )
    covered |= (np.cumsum(begun - ended).reshape(-1, width) > 0)[:, :-1]


def _side_to_side(corners: Floats, level: Floats) -> tuple[Floats, Floats]:
    """Return where lines at a level of the first axis enter and leave triangles, shape (k,) each."""
    low, high = np.full(len(level), np.inf), np.full(len(level), -np.inf)
    for start, end in ((0, 1), (1, 2), (2, 0)):
        (x, y), (u, v) = corners[:, start].T, corners[:, end].T
        meets = (x <= level) != (u <= level)
        rise = np.where(meets, u - x, 1.0)
        place = y + (level - x) / rise * (v - y)
        low = np.where(meets, np.minimum(low, place), low)
        high = np.where(meets, np.maximum(high, place), high)
    return low, high


def _boxes(covered: Mask) -> Floats:
    """Return boxes that cover the marked cells once: runs along the longer axis, in cells, (k, 4)."""
    turned = covered.shape[0] < covered.shape[1]
    rows = covered if turned else covered.T  # (short, long)
    edges = np.diff(np.pad(rows.astype(np.int8), ((0, 0), (1, 1))), axis=1)
    row, start = np.nonzero(edges == 1)
    end = np.nonzero(edges == -1)[1]
    box = np.column_stack([start, row, end, row + 1]).astype(float)
    return box[:, [1, 0, 3, 2]] if turned else box
