"""A flat, rigid wall."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from .. import _core
from ..base.checks import positive_and_finite
from .barrier_kind import Surface
from .blocks import numbered, positive, seen_block
from .description import SeenPart, Size, height_text, length_text, segments_text
from .fronts import FlatFront, axes_of, feet_of
from .rounded_block import BlockPlan, RoundedBlock
from .surfaces import ends, extruded

__all__ = ["RigidWallKind"]

Floats = npt.NDArray[np.float64]

# A wall of finite width without a top has it here, above anything that could come [m].
_HIGH = 100.0
# A wall without end, which is a half-space, is drawn so deep [m].
_DRAWN_DEPTH = 0.4


@dataclass(frozen=True)
class RigidWallKind(RoundedBlock):
    """A flat, rigid, vertical wall.

    Without end in width and height it is a half-space. Else it has a ``thickness``, with ends, a top and a
    back that can be met like the face. Its edges are those of a
    :class:`~birm3d.barrier.rounded_block.RoundedBlock`. The wall's load has theirs.
    """

    width: float = math.inf
    height: float = math.inf
    thickness: float = 0.5
    segments: int = 1
    edge_radius: float | None = 0.0  # None: the usual one, as rigid_wall() asks for

    _counts: ClassVar = ("segments",)
    title: ClassVar = "wall"
    sizes: ClassVar = (
        Size("width", hint="[default: without end]"),
        Size("height"),
        Size("thickness", hint="where it has an end or a top"),
        Size("segments", "count", "where it has ends"),
        Size("edge_radius", hint="of the upright edges [default: 0.05 where it ends]"),
    )
    is_straight: ClassVar = True

    def elements(self) -> list[_core.Element]:
        """Return the segments, from low y to high y."""
        positive("width", self.width)
        positive("height", self.height)
        positive_and_finite("thickness", self.thickness)
        self.check_edges()
        if math.isinf(self.width) and self.segments > 1:
            raise ValueError(f"segments must be 1 for a wall of infinite width, got {self.segments}")
        if self.is_endless:
            heading = math.radians(self.heading)
            return [_core.Element.plane(position=self.from_origin(0.0, 0.0), heading=heading)]
        return self.block_elements(self.height if math.isfinite(self.height) else _HIGH)

    @property
    def plan(self) -> BlockPlan:
        """Sizes seen from above."""
        name = "width" if self.segments == 1 else "the width of a segment"
        return BlockPlan(self.thickness, self.width, ("thickness", name))

    @property
    def element_names(self) -> tuple[str, ...]:
        """``wall``, or its segments from low y to high y."""
        return numbered("wall", "segment", self.segments)

    @property
    def is_endless(self) -> bool:
        """Whether it has neither ends nor a top."""
        return math.isinf(self.width) and math.isinf(self.height)

    @property
    def is_bottomless(self) -> bool:
        """Whether it goes on below the ground without end."""
        return self.is_endless or super().is_bottomless

    @property
    def text(self) -> str:
        """Sizes in a few words."""
        if self.is_endless:
            return "rigid wall without end"
        length = f"{length_text(self.width)}{segments_text(self.segments)}"
        size = f"{length}, {height_text(self.height)}, {self.thickness:g} m thick"
        return f"rigid wall {size}{self.edges_text()}"

    def load_front(self) -> FlatFront:
        """Return the traffic face with its rounded edges."""
        axes, feet = axes_of(self.origin, self.heading), feet_of(self.width, self.segments)
        return FlatFront(*axes, self.height, feet, half_width=0.5 * self.width, radius=self.rounding)

    def surfaces(self, top: float, seen: tuple[float, float]) -> list[Surface]:
        """Return closed segments."""
        height = min(self.height, top)
        if self.rounding > 0.0:
            return self.rounded_surfaces(height)
        depth = _DRAWN_DEPTH if self.is_endless else self.thickness
        sides = (np.zeros(2), np.full(2, depth), np.array([0.0, height]))
        return extruded(self, *sides, ends(self.width, self.segments, seen))

    def seen_parts(self, angle: float) -> Iterator[SeenPart]:
        """Yield the wall as one part."""
        yield seen_block(self, angle, "wall", self.thickness, self.width, self.height)
