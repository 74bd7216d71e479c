"""Upright edges of blocks: their radius, and plans of blocks that have them."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise

import numpy as np
import numpy.typing as npt

__all__ = [
    "check_edge_radius",
    "cut_outline",
    "edges_text",
    "rounded_outline",
    "segment_outlines",
    "usual_edge_radius",
]

Floats = npt.NDArray[np.float64]

_USUAL_EDGE_RADIUS = 0.05  # of a block of concrete [m]


def usual_edge_radius(depth: float, length: float) -> float:
    """Return the radius of the upright edges of a block where nothing is said of it [m].

    A sharp edge passes between the nodes of the skin. From 0.03 to 0.1 m the radius changes the force of a
    car at a corner by less than 15 %.
    """
    return max(0.0, min(_USUAL_EDGE_RADIUS, 0.5 * depth, 0.5 * length))


def edges_text(radius: float, depth: float, length: float) -> str:
    """Return in words what is unusual about edges; "" where nothing is."""
    if radius == usual_edge_radius(depth, length):
        return ""
    return f", edges rounded by {radius:g} m" if radius > 0.0 else ", sharp edges"


def check_edge_radius(radius: float, sizes: Mapping[str, float]) -> None:
    """Refuse a radius that is not within 0 and half of the smaller of two sizes, given by name."""
    most = 0.5 * min(sizes.values())
    if not 0.0 <= radius <= most:
        raise ValueError(
            f"edge_radius must be >= 0 m and at most half of {' and '.join(sizes)} ({most:g} m), got {radius}"
        )


def rounded_outline(depth: float, length: float, radius: float, sides_of_quarter: int = 15) -> Floats:
    """Return the plan of a block with rounded upright edges: its corners, across and along, (n, 2) [m].

    The arcs are polygons with their corners on the arc. With 15 sides they lie within 0.0014 r of it, r the
    radius.
    """
    quarter = np.linspace(0.0, 0.5 * np.pi, sides_of_quarter + 1)
    arc = radius * np.stack([np.cos(quarter), np.sin(quarter)], axis=1)
    middle = np.array([0.5 * depth, 0.0])
    corner = np.array([middle[0], 0.5 * length]) - radius
    parts = []
    for c, s, sides in ((1, 0, (1, 1)), (0, 1, (-1, 1)), (-1, 0, (-1, -1)), (0, -1, (1, -1))):
        parts.append(middle + corner * sides + arc @ np.array([[c, s], [-s, c]]))
    ring = np.vstack(parts)
    # Where the radius is half of the block, arcs end where the next ones begin.
    apart = np.linalg.norm(ring - np.roll(ring, 1, axis=0), axis=1) > 1e-9
    return np.asarray(ring[apart])


def cut_outline(ring: Floats, side: int, inner: float) -> Floats:
    """Return the end of an outline on one side of its middle (-1, 1), from `inner` along the line on [m]."""
    outer = ring[side * ring[:, 1] > 0.0]
    return np.vstack([outer, [(outer[-1, 0], inner), (outer[0, 0], inner)]])


def segment_outlines(depth: float, length: float, radius: float, segments: int) -> list[Floats]:
    """Return the plans of the segments of a block with rounded edges, each (n, 2): across and along [m]."""
    ring = rounded_outline(depth, length, radius)
    if segments == 1:
        return [ring]
    ends = np.linspace(-0.5, 0.5, segments + 1) * length
    between = [
        np.array([(depth, low), (depth, high), (0.0, high), (0.0, low)]) for low, high in pairwise(ends[1:-1])
    ]
    return [cut_outline(ring, -1, float(ends[1])), *between, cut_outline(ring, 1, float(ends[-2]))]
