"""The grid of cells over the face of a wall."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np
import numpy.typing as npt

from ..base.checks import array
from .face_loads import SPREAD, FaceStep
from .record import RunRecord
from .unit_result import read_only

__all__ = ["USUAL_CELL", "cells_of", "edges_of_cells", "face_grid", "forces_of_cells"]

Floats = npt.NDArray[np.float64]

USUAL_CELL = 0.25
"""Side of a cell [m]."""
_MOST_NUMBERS = 30_000_000


def face_grid(
    result: RunRecord,
    steps: list[FaceStep],
    lateral: npt.ArrayLike | None,
    height: npt.ArrayLike | None,
    side: float,
    top: float,
    *,
    doubled: bool,
) -> tuple[Floats, Floats]:
    """Return the edges of the cells along the line and up; of larger ones where they may be doubled."""
    most = _MOST_NUMBERS // len(result.time)
    while True:
        y = _edges("lateral", lateral, side, [step.along for step in steps], from_foot=False)
        z = _edges("height", height, side, [step.height for step in steps], from_foot=True)
        if height is None:
            z = read_only(np.append(z[z < top], top) if z[-1] > top else z)
        count = (len(y) - 1) * (len(z) - 1)
        if count <= most:
            return y, z
        if not doubled or (lateral is not None and height is not None):
            raise ValueError(
                f"cell must give at most {most:,} cells for {len(result.time):,} rows, "
                f"got {count:,} of {side:g} m"
            )
        side *= 2.0


def edges_of_cells(name: str, given: npt.ArrayLike) -> Floats:
    """Return edges of cells as a read-only array (n,).

    Raises
    ------
    ValueError
        If there are fewer than two, or they do not increase.
    """
    edges = array(name, given, "n")
    if len(edges) < 2 or not (np.diff(edges) > 0.0).all():
        raise ValueError(f"{name} must have at least 2 edges that increase, got {edges.tolist()}")
    return read_only(edges)


def _edges(
    name: str, given: npt.ArrayLike | None, side: float, places: list[Floats], *, from_foot: bool
) -> Floats:
    """Return the edges that were given, else those of as many cells as hold all places."""
    if given is not None:
        return edges_of_cells(name, given)
    all_ = np.concatenate(places)
    low, high = (float(all_.min()) - SPREAD, float(all_.max()) + SPREAD) if len(all_) else (0.0, side)
    if from_foot and low >= -SPREAD:
        low = 0.0
    first = math.floor(low / side)
    last = max(math.floor(high / side) + 1, first + 1)
    return read_only(side * np.arange(first, last + 1))


def forces_of_cells(
    step: FaceStep,
    quarters: Iterable[tuple[float, float]],
    edges: tuple[Floats, Floats],
    top: float,
    count: int,
) -> Floats:
    """Return the forces of cells at the end of a step, each node's force in four quarters."""
    cells = np.zeros(count)
    for aside, up in quarters:
        # No part of a load above the foot is below it, and none is above the top.
        height = np.where(step.height >= 0.0, np.maximum(step.height + up, 0.0), step.height + up)
        height = np.minimum(height, np.nextafter(top, 0.0))
        cells += np.bincount(cells_of(step.along + aside, height, edges), 0.25 * step.force, minlength=count)
    return cells


def cells_of(along: Floats, height: Floats, edges: tuple[Floats, Floats]) -> npt.NDArray[np.intp]:
    """Return the flat index of the cell of each place; the last index is that outside all cells."""
    y, z = edges
    column, row = (np.searchsorted(e, p, side="right") - 1 for e, p in ((y, along), (z, height)))
    inside = (column >= 0) & (column < len(y) - 1) & (row >= 0) & (row < len(z) - 1)
    return np.where(inside, row * (len(y) - 1) + column, (len(y) - 1) * (len(z) - 1))
