"""Wheels of a finite-element vehicle, found by the titles of the parts that are tyres."""

from __future__ import annotations

import re
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .raw_mesh import RawMesh

__all__ = ["FoundWheel", "find_wheels", "tire_parts"]

Floats = npt.NDArray[np.float64]

_TITLE = re.compile(r"tire|tyre|(?<![a-z])wheel(?!\s*(house|well|arch))", re.IGNORECASE)
_TIRE = re.compile(r"tire|tyre", re.IGNORECASE)
_APART = 0.25  # m along the vehicle, between points of two wheels
_ROUND = 0.15  # share by which a wheel's length and height may differ
_STANDS = 0.25  # share of the radius that a wheel may be above the ground


class FoundWheel(NamedTuple):
    """A wheel: places [m] in the axes of the points, radius and width [m]."""

    x: float
    y: float
    radius: float
    width: float


def tire_parts(mesh: RawMesh) -> set[int]:
    """Return the numbers of the parts whose titles say that they are tyres or wheels."""
    return {int(n) for n in np.unique(mesh.part) if _TITLE.search(mesh.titles.get(int(n), ""))}


def find_wheels(mesh: RawMesh, points: Floats) -> tuple[FoundWheel, ...]:
    """Return the wheels that stand on the ground, axle by axle from the front, left first; maybe none.

    Parameters
    ----------
    mesh
        With titles of parts.
    points
        Its points in vehicle axes, lowest at z = 0, shape (n, 3) [m].
    """
    parts = tire_parts(mesh)
    tires = {n for n in parts if _TIRE.search(mesh.titles[n])} or parts
    if not tires:
        return ()
    at = points[np.unique(mesh.triangles[np.isin(mesh.part, sorted(tires))])]
    found = []
    for side in (1.0, -1.0):
        mine = at[side * at[:, 1] > 0.0]
        mine = mine[np.argsort(mine[:, 0])]
        for group in np.split(mine, np.flatnonzero(np.diff(mine[:, 0]) > _APART) + 1) if len(mine) else ():
            low, high = group.min(axis=0), group.max(axis=0)
            length, width, height = (high - low).tolist()
            if height > 0.0 and abs(length / height - 1.0) < _ROUND and low[2] < _STANDS * 0.5 * height:
                found.append(FoundWheel(0.5 * (low[0] + high[0]), side, 0.5 * height, width))
                found[-1] = found[-1]._replace(y=float(0.5 * (low[1] + high[1])))
    found.sort(key=lambda wheel: (-round(wheel.x, 1), -wheel.y))
    return tuple(found) if _in_pairs(found) else ()


def _in_pairs(wheels: list[FoundWheel]) -> bool:
    """Return whether there are two axles or more, each with a wheel to either side."""
    if len(wheels) < 4 or len(wheels) % 2:
        return False
    pairs = zip(wheels[::2], wheels[1::2], strict=True)
    return all(abs(a.x - b.x) < _APART and a.y > 0.0 > b.y for a, b in pairs)
