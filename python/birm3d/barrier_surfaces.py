"""Surfaces of barriers for pictures: the one place that knows how each kind of barrier looks."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from .barrier import Barrier

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
    """Return the closed surfaces of a barrier, one for each of its parts.

    Parameters
    ----------
    barrier
        ``None`` has no surfaces.
    around
        Points of the scene, shape (k, 3), world axes [m]: an endless wall is drawn as wide and high as they
        ask for, and a pole as high.
    """
    if barrier is None:
        return []
    points = np.asarray(around, float).reshape(-1, 3)
    origin = np.asarray(barrier.origin)
    top = max(_LEAST_HEIGHT, float((points - origin)[:, 2].max()) + _ABOVE)
    axes = barrier_axes(barrier)
    if barrier.diameter is not None:
        return [_cylinder(origin, 0.5 * barrier.diameter, top)]
    along = (points - origin) @ axes[0]
    low, high = float(along.min()) - _BEYOND, float(along.max()) + _BEYOND
    if np.isfinite(barrier.width):
        low, high = -0.5 * barrier.width, 0.5 * barrier.width
    if np.isfinite(barrier.height):
        top = barrier.height
    return [_box(origin, axes, (low, high), (-_WALL_DEPTH, 0.0), (0.0, top))]


def _box(origin: Floats, axes: Floats, *ranges: tuple[float, float]) -> Surface:
    """Return a box between two values along each of three axes that are right-handed."""
    corners = np.stack(np.meshgrid(*ranges, indexing="ij"), axis=-1).reshape(-1, 3)  # the last is the fastest
    quads = np.array(
        [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]], np.int64
    )
    return origin + corners @ axes, _triangles(quads)


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
