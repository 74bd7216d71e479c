"""What several kinds of barriers are made of: blocks along the line, numbered elements, checked sizes."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from .. import _core
from .base import Barrier
from .description import SeenPart

__all__ = ["FOOT", "along_line", "numbered", "positive", "positive_and_finite", "seen_block"]

Floats = npt.NDArray[np.float64]

FOOT = 1.0
"""Solids that stand on the ground go on below it, so that nothing is pushed out downwards [m]."""


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


def numbered(whole: str, part: str, count: int) -> tuple[str, ...]:
    """Return the name of the whole where it is one element, else the names of its parts."""
    return (whole,) if count == 1 else tuple(f"{part} {i + 1}" for i in range(count))


def seen_block(
    barrier: Barrier, angle: float, name: str, thickness: float, length: float, height: float
) -> SeenPart:
    """Return a block along the line as a path sees it that comes at an angle to the line [rad]."""
    width = thickness * abs(math.cos(angle)) + length * abs(math.sin(angle))
    return SeenPart(name, math.inf if math.isinf(length) else width, -math.inf, barrier.origin[2] + height)
