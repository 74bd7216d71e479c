"""Outline of a vehicle's unit as seen from above."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from .unit_shapes import UnitShape

__all__ = ["silhouette"]

Floats = npt.NDArray[np.float64]


def silhouette(shape: UnitShape, nodes: Floats, center: Floats, turn: Floats, rays: int = 720) -> Floats:
    """Return the outline seen from above as a polygon, shape (m, 2), world x and y [m], m <= `rays`.

    Where rays from the middle of the skin leave it: exact there for an outline that each ray crosses once. A
    unit without a skin has the convex hull of its nodes and anchors.

    Parameters
    ----------
    shape
        The unit.
    nodes
        Its shell nodes now, body axes, shape (n, 3) [m].
    center, turn
        Mass centre (3,) [m] and rotation body to world (3, 3).
    rays
        Their number, evenly spread.
    """
    if len(shape.quads) == 0:
        return _hull((center + np.vstack([nodes, shape.anchors]) @ turn.T)[:, :2])
    plan = (center + nodes @ turn.T)[:, :2]
    used = plan[np.unique(shape.quads)]
    middle = 0.5 * (used.min(axis=0) + used.max(axis=0))
    pairs = np.sort(np.stack([shape.quads, np.roll(shape.quads, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
    return np.asarray(middle + _farthest(plan[np.unique(pairs, axis=0)] - middle, rays))


def _farthest(edges: Floats, rays: int) -> Floats:
    """Return where rays from the origin last cross edges (k, 2, 2); rays that cross none are left out."""
    step = 2.0 * np.pi / rays
    a, b = edges[:, 0], edges[:, 1]
    start = np.arctan2(a[:, 1], a[:, 0])
    # Signed angle that the edge spans, less than half a turn.
    cross = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    span = np.arctan2(cross, np.einsum("ij,ij->i", a, b))
    first = np.ceil(np.minimum(start, start + span) / step).astype(int)
    last = np.floor(np.maximum(start, start + span) / step).astype(int)
    crossed = np.maximum(0, last - first + 1)
    edge = np.repeat(np.arange(len(edges)), crossed)
    ray = np.arange(len(edge)) - np.repeat(np.cumsum(crossed) - crossed, crossed) + first[edge]
    direction = np.stack([np.cos(ray * step), np.sin(ray * step)], axis=1)
    along = (b - a)[edge]
    # direction * radius = a + share * along, crossed with `along`
    below = direction[:, 0] * along[:, 1] - direction[:, 1] * along[:, 0]
    with np.errstate(
        divide="ignore", invalid="ignore"
    ):  # an edge along its ray: its ends are other edges' too
        radius = np.where(below != 0.0, cross[edge] / below, 0.0)
    outline = np.zeros(rays)
    np.maximum.at(outline, ray % rays, radius)
    hit = np.flatnonzero(outline > 0.0)
    return np.asarray(outline[hit, None] * np.stack([np.cos(hit * step), np.sin(hit * step)], axis=1))


def _hull(points: Floats) -> Floats:
    from scipy.spatial import ConvexHull

    points = np.unique(points, axis=0)
    spread = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    if len(points) < 3 or spread[1] < 1e-9 * spread[0]:
        return points  # nothing that has an area
    return np.asarray(points[ConvexHull(points).vertices])
