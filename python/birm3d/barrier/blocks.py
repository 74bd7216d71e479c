"""What several kinds of barriers are made of: blocks along the line, numbered elements, checked sizes."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from .. import _core
from .barrier_kind import BarrierKind
from .description import SeenPart
from .edges import cut_outline, rounded_outline

__all__ = [
    "FOOT",
    "along_line",
    "block_profile",
    "numbered",
    "positive",
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


def along_line(
    barrier: BarrierKind,
    corners: Floats,
    across: float,
    length: float,
    segments: int,
    *,
    abutting: bool = True,
    rounded: float = 0.0,
    draws_in_above: bool = False,
    along: float = 0.0,
) -> list[_core.Element]:
    """Extrude a profile along the line. Abutting ends are no surface.

    At the ends of the line the profile is set back where rounded edges of that radius hide it [m].
    ``draws_in_above``: skin above the top edge of its vertical face is drawn in. ``along``: place of the
    middle [m].
    """
    ends = [-math.inf, math.inf] if math.isinf(length) else np.linspace(-0.5, 0.5, segments + 1) * length
    elements = []
    for i in range(segments):
        low, high = float(ends[i]), float(ends[i + 1])
        middle = 0.5 * (low + high) if math.isfinite(low) else 0.0
        first, last = i == 0, i == segments - 1
        elements.append(
            _core.Element.prism(
                profile=corners,
                y_low=low + (rounded if first else 0.0) - middle,
                y_high=high - (rounded if last else 0.0) - middle,
                covered_low_end=rounded > 0.0 if first else abutting,
                covered_high_end=rounded > 0.0 if last else abutting,
                position=barrier.from_origin(across, along + middle),
                heading=math.radians(barrier.heading),
                draws_in_above=draws_in_above,
            )
        )
    return elements


def block_profile(depth: float, top: float) -> Floats:
    """Return the corners of a block across the line, its traffic face at 0: across and up, (4, 2) [m]."""
    return np.array([(0.0, -FOOT), (depth, -FOOT), (depth, top), (0.0, top)])


def rounded_block(
    barrier: BarrierKind,
    depth: float,
    length: float,
    top: float,
    radius: float,
    segments: int = 1,
    *,
    draws_in_above: bool,
    along: float = 0.0,
    number: int = 0,
) -> list[_core.Element]:
    """Return a block along the line with rounded upright edges: its segments, then parts of the outer ones.

    ``along``: place of its middle [m]. ``number``: of its first segment among the barrier's elements.
    The edges are posts, which draw in the skin beside them. Between those on the traffic's side stands the
    face, its ends hidden in the posts. Behind them is the block, with chords for the arcs that posts fill.
    """
    half, last = 0.5 * length, segments - 1

    def faces(reach: float) -> list[_core.Element]:
        return along_line(
            barrier,
            block_profile(reach, top),
            0.0,
            length,
            segments,
            rounded=radius,
            draws_in_above=draws_in_above,
            along=along,
        )

    def upright(corners: Floats, whole: int | None) -> _core.Element:
        part_of = None if whole is None else number + whole
        return _upright(barrier, corners, along, top, part_of)

    # Where the ends are round as a whole, an edge on the traffic's side is that behind it, too.
    rows = [(radius, 0.75)] if depth - 2.0 * radius < 1e-9 else [(radius, 0.75), (depth - radius, 0.25)]
    edges = [
        _core.Element.post(
            radius=radius,
            height=top,
            position=barrier.from_origin(across, along + side * (half - radius)),
            heading=math.radians(barrier.heading),
            part_of=number + whole,
            opens=side * quarter * math.pi,
        )
        for across, quarter in rows
        for side, whole in ((-1.0, 0), (1.0, last))
    ]
    plan = _plan_behind(depth, length, radius)
    if segments > 1:
        # What is behind an edge reaches into the box of its segment, which is as deep as the block.
        inner = half - radius - 0.5 * min(depth, length / segments - radius)
        return [
            *faces(depth),
            *edges,
            upright(cut_outline(plan, -1, -inner), 0),
            upright(cut_outline(plan, 1, inner), last),
        ]
    if half - radius > 1e-9:
        return [*faces(depth - radius), *edges, upright(plan, 0)]
    return [upright(plan, None), *edges]


def _plan_behind(depth: float, length: float, radius: float) -> Floats:
    """Return the plan of a rounded block without what its posts fill, set back behind its face."""
    ring = rounded_outline(depth, length, radius, _SIDES_BEHIND)
    beside = 0.5 * length - radius
    from_side = np.minimum(ring[:, 0], depth - ring[:, 0])
    filled = (from_side > 1e-9) & (from_side < radius - 1e-9) & (np.abs(ring[:, 1]) > beside + 1e-9)
    plan = ring[~filled]
    plan[:, 0] = np.maximum(plan[:, 0], _BEHIND_FACE * radius)
    return np.asarray(plan)


def _upright(
    barrier: BarrierKind, plan: Floats, along: float, top: float, whole: int | None
) -> _core.Element:
    """Return a part of an element, drawn upwards from its plan: places across and along, (n, 2) [m].

    ``along``: place of the middle of the block that it is of [m].
    """
    return _core.Element.prism(
        profile=plan * (1.0, -1.0),  # own z points to lower y
        y_low=-FOOT,
        y_high=top,
        covered_low_end=True,
        covered_high_end=False,
        position=barrier.from_origin(0.0, along),
        heading=math.radians(barrier.heading),
        part_of=whole,
        upright=True,
    )


def numbered(whole: str, part: str, count: int) -> tuple[str, ...]:
    """Return the name of the whole where it is one element, else the names of its parts."""
    return (whole,) if count == 1 else tuple(f"{part} {i + 1}" for i in range(count))


def seen_block(
    barrier: BarrierKind, angle: float, name: str, thickness: float, length: float, height: float
) -> SeenPart:
    """Return a block along the line as a path sees it that comes at an angle to the line [rad]."""
    width = thickness * abs(math.cos(angle)) + length * abs(math.sin(angle))
    return SeenPart(name, math.inf if math.isinf(length) else width, -math.inf, barrier.origin[2] + height)
