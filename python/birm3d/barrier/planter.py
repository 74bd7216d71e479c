"""Planters: rigid blocks with a top that a vehicle may come over, one or several in a row."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from typing_extensions import override

from .. import _core
from ..base.checks import MOST_ELEMENTS, positive_and_finite
from .barrier_kind import Surface
from .blocks import numbered, seen_block
from .description import SeenPart, Size
from .fronts import FlatFront, axes_of
from .rounded_block import BlockPlan, RoundedBlock
from .surfaces import ends, extruded

__all__ = ["PlanterKind"]


@dataclass(frozen=True)
class PlanterKind(RoundedBlock):
    """Rigid, fixed, solid blocks of given footprint and height, in a row along their line.

    The line is the foot of their traffic faces.

    Its edges are those of a :class:`~birm3d.barrier.rounded_block.RoundedBlock`.
    """

    length: float = 2.0
    width: float = 1.0
    height: float = 1.0
    # None: the usual one. Files of earlier versions say nothing of a planter's edges: they were sharp.
    edge_radius: float | None = 0.0
    count: int = 1
    spacing: float = 3.2

    _counts: ClassVar = ("count",)
    title: ClassVar = "planter"
    sizes: ClassVar = (
        Size("length", hint="along the line"),
        Size("width", hint="square to the line"),
        Size("height"),
        Size("edge_radius"),
        Size("count", "count", "in the row"),
        Size("spacing", hint="middle to middle"),
    )

    def elements(self) -> list[_core.Element]:
        """Return the blocks from low y to high y, then their parts."""
        for name in ("length", "width", "height", "spacing"):
            positive_and_finite(name, getattr(self, name))
        if self.count > MOST_ELEMENTS:
            raise ValueError(f"count must be at most {MOST_ELEMENTS:,} planters, got {self.count}")
        if self.count > 1 and not self.spacing > self.length:
            raise ValueError(f"spacing must be above the length ({self.length:g} m), got {self.spacing}")
        self.check_edges()
        blocks = [self.block_elements(self.height, along, i) for i, along in enumerate(self.places())]
        return [block[0] for block in blocks] + [part for block in blocks for part in block[1:]]

    def places(self) -> list[float]:
        """Return the middles of the blocks along the line [m], from the origin."""
        return [(i - 0.5 * (self.count - 1)) * self.spacing for i in range(self.count)]

    @property
    def plan(self) -> BlockPlan:
        """Sizes seen from above."""
        return BlockPlan(self.width, self.length, ("width", "length"))

    @property
    def element_names(self) -> tuple[str, ...]:
        """``planter``, or ``planter 1``, ... from low y to high y."""
        return numbered("planter", "planter", self.count)

    @property
    def text(self) -> str:
        """Sizes in a few words."""
        size = f"{self.length:g} m long, {self.width:g} m wide, {self.height:g} m high"
        if self.count == 1:
            return f"planter, {size}{self.edges_text()}"
        apart = f"{self.spacing:g} m between middles ({self.spacing - self.length:.3g} m clear)"
        return f"{self.count} planters, {size}, {apart}{self.edges_text()}"

    def load_front(self) -> FlatFront:
        """Return the traffic face."""
        if self.count > 1:
            raise ValueError(f"barrier must be one planter to have a load map, got {self.count}")
        axes = axes_of(self.origin, self.heading)
        return FlatFront(*axes, self.height, np.zeros(1), half_width=0.5 * self.length, radius=self.rounding)

    @override
    def surfaces(self, top: float, seen: tuple[float, float]) -> list[Surface]:
        """Return the blocks."""
        if self.rounding > 0.0:
            return [one for along in self.places() for one in self.rounded_surfaces(self.height, along)]
        sides = (np.zeros(2), np.full(2, self.width), np.array([0.0, self.height]))
        outline = ends(self.length, 1, seen)
        return [one for along in self.places() for one in extruded(self, *sides, outline + along)]

    def seen_parts(self, angle: float) -> Iterator[SeenPart]:
        """Yield one for all: they are equal."""
        yield seen_block(self, angle, "planter", self.width, self.length, self.height)
