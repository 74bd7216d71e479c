"""Surfaces of barriers for pictures, and what the kinds make them of."""

from __future__ import annotations

import itertools

import numpy as np
import numpy.typing as npt

from .barrier_kind import BarrierKind, Surface

__all__ = [
    "Surface",
    "barrier_axes",
    "barrier_surfaces",
    "cylinder",
    "drawn_up",
    "ends",
    "extruded",
    "placed",
]

Floats = npt.NDArray[np.float64]

# What the model leaves open is drawn so, m.
_BEYOND = 1.0  # an endless wall, past what stands before it
_ABOVE = 0.3  # an endless wall or pole, above what stands before it
_LEAST_HEIGHT = 1.0
_POLE_SIDES = 48


def barrier_axes(barrier: BarrierKind | None) -> Floats:
    """Return unit vectors along the barrier's line, out of its traffic face and up, as rows, world axes.

    At heading 0 they are +y, -x and +z. Without a barrier the same.
    """
    out = np.array([-1.0, 0.0, 0.0]) if barrier is None else np.asarray(barrier.core.normal)
    up = np.array([0.0, 0.0, 1.0])
    return np.stack([np.cross(out, up), out, up])


def barrier_surfaces(barrier: BarrierKind | None, around: npt.ArrayLike) -> list[Surface]:
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
    return barrier.surfaces(top, seen)


def ends(length: float, segments: int, seen: tuple[float, float]) -> Floats:
    """Return where segments along the barrier's line begin and end; without end, where it is seen."""
    return np.array(seen) if np.isinf(length) else np.linspace(-0.5, 0.5, segments + 1) * length


def placed(barrier: BarrierKind, points: Floats) -> Floats:
    """Return points (n, 3) in world axes from across, along and up of the barrier."""
    along, out, up = barrier_axes(barrier)
    return np.asarray(barrier.origin + points @ np.stack([-out, along, up]))


def extruded(
    barrier: BarrierKind, front: Floats, back: Floats, height: Floats, ends: Floats
) -> list[Surface]:
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
        surfaces.append((placed(barrier, np.vstack(sections)), faces))
    return surfaces


def drawn_up(outline: Floats, low: float, high: float) -> Surface:
    """Return vertices and triangles of a solid with a convex plan (n, 2), counter-clockwise from above."""
    n = len(outline)
    i = np.arange(n)
    j = (i + 1) % n
    fan = np.arange(1, n - 1)
    first = np.zeros_like(fan)
    faces = [
        np.stack([i, j, j + n], axis=1),
        np.stack([i, j + n, i + n], axis=1),
        np.stack([first, fan + 1, fan], axis=1),
        np.stack([first + n, fan + n, fan + 1 + n], axis=1),
    ]
    vertices = np.vstack([np.column_stack([outline, np.full(n, z)]) for z in (low, high)])
    return vertices, np.vstack(faces).astype(np.int64)


def cylinder(foot: Floats, radius: float, height: float) -> Surface:
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
