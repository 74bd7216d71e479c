"""What several kinds of barriers are made of: blocks along the line, numbered elements, checked sizes."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from .. import _core
from .base import Barrier
from .description import SeenPart
from .edges import rounded_outline

__all__ = [
    "FOOT",
    "along_line",
    "numbered",
    "positive",
    "positive_and_finite",
    "rounded_block",
    "seen_block",
]

Floats = npt.NDArray[np.float64]

FOOT = 1.0
"""Solids that stand on the ground go on below it, so that nothing is pushed out downwards [m]."""

# Of each of the two arcs away from the traffic. The outline then has 16 sides, which the core is quick with.
_SIDES_BEHIND = 5
# What is behind the face is set back by this share of the radius. So skin that follows an edge misses it.
_BEHIND_FACE = 0.03


def positive(name: str, value: float) -> None:
    """Refuse a length that is not > 0."""
    if not value > 0.0:
        raise ValueError(f"{name} must be > 0 m, got {value}")


def positive_and_finite(name: str, value: float) -> None:
    """Refuse a length that is not finite and > 0."""
    if not 0.0 < value < math.inf:
        raise ValueError(f"{name} must be finite and > 0 m, got {value}")


def along_line(
    barrier: Barrier, corners: Floats, across: float, length: float, segments: int, *, abutting: bool = True
) -> list[_core.Element]:
    """Extrude a profile along the line. Abutting ends are no surface."""
    ends = [-math.inf, math.inf] if math.isinf(length) else np.linspace(-0.5, 0.5, segments + 1) * length
    elements = []
    for i in range(segments):
        low, high = float(ends[i]), float(ends[i + 1])
        middle = 0.5 * (low + high) if math.isfinite(low) else 0.0
        elements.append(
            _core.Element.prism(
                profile=corners,
                y_low=low - middle,
                y_high=high - middle,
                covered_low_end=abutting and i > 0,
                covered_high_end=abutting and i < segments - 1,
                position=barrier.from_origin(across, middle),
                heading=math.radians(barrier.heading),
            )
        )
    return elements


def rounded_block(
    barrier: Barrier, depth: float, length: float, top: float, radius: float
) -> list[_core.Element]:
    """Return a block along the line with rounded upright edges: one element in several parts.

    The edges on the traffic's side are posts, which draw in the skin beside them. Between them stands the
    face, its ends hidden in the posts. Behind both is the block, with chords for the arcs that posts fill.
    """
    heading = math.radians(barrier.heading)
    beside = 0.5 * length - radius
    ring = rounded_outline(depth, length, radius, _SIDES_BEHIND)
    filled = (ring[:, 0] > 1e-9) & (ring[:, 0] < radius - 1e-9) & (np.abs(ring[:, 1]) > beside + 1e-9)
    plan = ring[~filled]
    plan[:, 0] = np.maximum(plan[:, 0], _BEHIND_FACE * radius)
    wide = beside > 1e-9
    behind = _core.Element.prism(
        profile=plan * (1.0, -1.0),
        y_low=-FOOT,
        y_high=top,
        covered_low_end=True,
        covered_high_end=False,
        position=barrier.from_origin(0.0, 0.0),
        heading=heading,
        continues=wide,
        upright=True,
    )
    edges = [
        _core.Element.post(
            radius=radius,
            height=top,
            position=barrier.from_origin(radius, along),
            heading=heading,
            continues=True,
            opens=math.copysign(0.75 * math.pi, along),
        )
        for along in (-beside, beside)
    ]
    if not wide:
        return [behind, *edges]
    reach = depth - radius  # into the block behind
    face = _core.Element.prism(
        profile=np.array([(0.0, -FOOT), (reach, -FOOT), (reach, top), (0.0, top)]),
        y_low=-beside,
        y_high=beside,
        covered_low_end=True,
        covered_high_end=True,
        position=barrier.from_origin(0.0, 0.0),
        heading=heading,
    )
    return [face, *edges, behind]


def numbered(whole: str, part: str, count: int) -> tuple[str, ...]:
    """Return the name of the whole where it is one element, else the names of its parts."""
    return (whole,) if count == 1 else tuple(f"{part} {i + 1}" for i in range(count))


def seen_block(
    barrier: Barrier, angle: float, name: str, thickness: float, length: float, height: float
) -> SeenPart:
    """Return a block along the line as a path sees it that comes at an angle to the line [rad]."""
    width = thickness * abs(math.cos(angle)) + length * abs(math.sin(angle))
    return SeenPart(name, math.inf if math.isinf(length) else width, -math.inf, barrier.origin[2] + height)
