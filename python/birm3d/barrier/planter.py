"""A planter: a rigid block with a top that a vehicle may come over."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from typing_extensions import override

from .. import _core
from ..base.checks import positive_and_finite
from .barrier_kind import Surface
from .blocks import seen_block
from .description import SeenPart, Size
from .fronts import FlatFront, axes_of
from .rounded_block import BlockPlan, RoundedBlock
from .surfaces import ends, extruded

__all__ = ["PlanterKind"]


@dataclass(frozen=True)
class PlanterKind(RoundedBlock):
    """A rigid, fixed, solid block of given footprint and height; its line is the foot of its traffic face.

    Its edges are those of a :class:`~birm3d.barrier.rounded_block.RoundedBlock`.
    """

    length: float = 2.0
    width: float = 1.0
    height: float = 1.0
    # None: the usual one. Files of earlier versions say nothing of a planter's edges: they were sharp.
    edge_radius: float | None = 0.0

    title: ClassVar = "planter"
    sizes: ClassVar = (
        Size("length", hint="along the line"),
        Size("width", hint="square to the line"),
        Size("height"),
        Size("edge_radius"),
    )

    def elements(self) -> list[_core.Element]:
        """Return the block."""
        for name in ("length", "width", "height"):
            positive_and_finite(name, getattr(self, name))
        self.check_edges()
        return self.block_elements(self.height)

    @property
    def plan(self) -> BlockPlan:
        """Sizes seen from above."""
        return BlockPlan(self.width, self.length, ("width", "length"))

    @property
    def element_names(self) -> tuple[str, ...]:
        """``planter``."""
        return ("planter",)

    @property
    def text(self) -> str:
        """Sizes in a few words."""
        size = f"{self.length:g} m long, {self.width:g} m wide, {self.height:g} m high"
        return f"planter, {size}{self.edges_text()}"

    def load_front(self) -> FlatFront:
        """Return the traffic face."""
        axes = axes_of(self.origin, self.heading)
        return FlatFront(*axes, self.height, np.zeros(1), half_width=0.5 * self.length, radius=self.rounding)

    @override
    def surfaces(self, top: float, seen: tuple[float, float]) -> list[Surface]:
        """Return the block."""
        if self.rounding > 0.0:
            return self.rounded_surfaces(self.height)
        sides = (np.zeros(2), np.full(2, self.width), np.array([0.0, self.height]))
        return extruded(self, *sides, ends(self.length, 1, seen))

    def seen_parts(self, angle: float) -> Iterator[SeenPart]:
        """Yield the block."""
        yield seen_block(self, angle, "planter", self.width, self.length, self.height)
