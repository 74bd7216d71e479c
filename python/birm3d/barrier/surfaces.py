"""Surfaces of barriers for pictures: the one place that knows how each kind of barrier looks."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
import numpy.typing as npt

from .kinds import Bollards, Jersey, MeshBarrier, Pole, RigidWall, drawn_up

if TYPE_CHECKING:
    from .base import Barrier

__all__ = ["Surface", "barrier_axes", "barrier_surfaces"]

Floats = npt.NDArray[np.float64]
Surface: TypeAlias = "tuple[Floats, npt.NDArray[np.int64]]"
"""Vertices (n, 3), world axes [m], and triangles (m, 3), counter-clockwise seen from outside."""

# What the model leaves open is drawn so, m.
_WALL_DEPTH = 0.4
_BEYOND = 1.0  # an endless wall, past what stands before it
_ABOVE = 0.3  # an endless wall or pole, above what stands before it
_LEAST_HEIGHT = 1.0
_POLE_SIDES = 48


def barrier_axes(barrier: Barrier | None) -> Floats:
    """Return unit vectors along the barrier's line, out of its traffic face and up, as rows, world axes.

    At heading 0 they are +y, -x and +z. Without a barrier the same.
    """
    out = np.array([-1.0, 0.0, 0.0]) if barrier is None else np.asarray(barrier.core.normal)
    up = np.array([0.0, 0.0, 1.0])
    return np.stack([np.cross(out, up), out, up])


def barrier_surfaces(barrier: Barrier | None, around: npt.ArrayLike) -> list[Surface]:
    """Return the closed surfaces of a barrier, one for each of its elements.

    Parameters
    ----------
    barrier
        ``None`` has no surfaces.
    around
        Points of the scene, shape (k, 3), world axes [m]: barriers without end are drawn as wide and high
        as they ask for.
    """
    if barrier is None:
        return []
    points = np.asarray(around, float).reshape(-1, 3)
    origin = np.asarray(barrier.origin)
    top = max(_LEAST_HEIGHT, float((points - origin)[:, 2].max()) + _ABOVE)
    along = (points - origin) @ barrier_axes(barrier)[0]
    seen = (float(along.min()) - _BEYOND, float(along.max()) + _BEYOND)
    if isinstance(barrier, Pole):
        return [_cylinder(origin, 0.5 * barrier.diameter, top)]
    if isinstance(barrier, Bollards):
        radius, height = 0.5 * barrier.diameter, min(barrier.height, top)
        return [_cylinder(barrier.place(*place), radius, height) for place in barrier.places()]
    if isinstance(barrier, RigidWall):
        endless = np.isinf(barrier.width) and np.isinf(barrier.height)
        if barrier.edge_radius > 0.0:
            return [_rounded_wall(barrier, min(barrier.height, top))]
        depth = _WALL_DEPTH if endless else barrier.thickness
        sides = (np.zeros(2), np.full(2, depth), np.array([0.0, min(barrier.height, top)]))
        return _extruded(barrier, *sides, _ends(barrier.width, barrier.segments, seen))
    if isinstance(barrier, Jersey):
        half, level = barrier.half_profile().T
        ends = _ends(barrier.length, barrier.segments, seen)
        return _extruded(barrier, half[0] - half, half[0] + half, level, ends)
    if isinstance(barrier, MeshBarrier):
        return [(_placed(barrier, barrier.vertices), barrier.faces)]
    raise TypeError(f"no surface of a {type(barrier).__name__}")


def _ends(length: float, segments: int, seen: tuple[float, float]) -> Floats:
    """Return where segments along the barrier's line begin and end; without end, where it is seen."""
    return np.array(seen) if np.isinf(length) else np.linspace(-0.5, 0.5, segments + 1) * length


def _placed(barrier: Barrier, points: Floats) -> Floats:
    """Return points (n, 3) in world axes from across, along and up of the barrier."""
    along, out, up = barrier_axes(barrier)
    return np.asarray(barrier.origin + points @ np.stack([-out, along, up]))


def _extruded(barrier: Barrier, front: Floats, back: Floats, height: Floats, ends: Floats) -> list[Surface]:
    """Return closed segments between `ends`; at heights (n,), foot first, they reach from front to back."""
    # Round the section, up the back and down the front: counter-clockwise seen from the low end.
    across, up = np.concatenate([back, front[::-1]]), np.concatenate([height, height[::-1]])
    n, k = len(across), np.arange(len(height) - 1)
    i = np.arange(n)
    j = (i + 1) % n
    low_end = _triangles(np.stack([k, k + 1, n - 2 - k, n - 1 - k], axis=1))
    faces = np.vstack([low_end, low_end[:, ::-1] + n, _triangles(np.stack([i, i + n, j + n, j], axis=1))])
    surfaces = []
    for low, high in itertools.pairwise(ends):
        sections = [np.stack([across, np.full(n, end), up], axis=1) for end in (low, high)]
        surfaces.append((_placed(barrier, np.vstack(sections)), faces))
    return surfaces


def _rounded_wall(barrier: RigidWall, height: float) -> Surface:
    """Return a wall with rounded upright edges."""
    vertices, faces = drawn_up(barrier.outline(), 0.0, height)
    return _placed(barrier, vertices), faces


def _cylinder(foot: Floats, radius: float, height: float) -> Surface:
    """Return an upright cylinder."""
    angle = np.linspace(0.0, 2.0 * np.pi, _POLE_SIDES, endpoint=False)
    ring = radius * np.stack([np.cos(angle), np.sin(angle), np.zeros_like(angle)], axis=1)
    up = np.array([0.0, 0.0, height])
    vertices = foot + np.vstack([ring, ring + up, [0.0 * up, up]])
    i = np.arange(_POLE_SIDES)
    j = (i + 1) % _POLE_SIDES
    n = _POLE_SIDES
    side = _triangles(np.stack([i, j, j + n, i + n], axis=1))
    foot_cap = np.stack([np.full(n, 2 * n), j, i], axis=1)
    top_cap = np.stack([np.full(n, 2 * n + 1), i + n, j + n], axis=1)
    return vertices, np.vstack([side, foot_cap, top_cap])


def _triangles(quads: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
    return np.vstack([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
