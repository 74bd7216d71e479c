"""A planter: a rigid block with a top that a vehicle may come over."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from .. import _core
from .base import Barrier, Surface
from .blocks import FOOT, along_line, positive_and_finite, seen_block
from .description import SeenPart, Size
from .fronts import FlatFront, axes_of
from .surfaces import ends, extruded

__all__ = ["Planter"]


@dataclass(frozen=True)
class Planter(Barrier):
    """A rigid, fixed, solid block of given footprint and height; its line is the foot of its traffic face."""

    length: float = 2.0
    width: float = 1.0
    height: float = 1.0

    title: ClassVar = "planter"
    sizes: ClassVar = (
        Size("length", hint="along the line"),
        Size("width", hint="square to the line"),
        Size("height"),
    )

    def elements(self) -> list[_core.Element]:
        """Return the block."""
        for size in self.sizes:
            positive_and_finite(size.name, getattr(self, size.name))
        width, top = self.width, self.height
        corners = [(0.0, -FOOT), (width, -FOOT), (width, top), (0.0, top)]
        return along_line(self, np.array(corners), 0.0, self.length, 1)

    @property
    def element_names(self) -> tuple[str, ...]:
        """``planter``."""
        return ("planter",)

    @property
    def text(self) -> str:
        """Sizes in a few words."""
        return f"planter, {self.length:g} m long, {self.width:g} m wide, {self.height:g} m high"

    def load_front(self) -> FlatFront:
        """Return the traffic face."""
        axes = axes_of(self.origin, self.heading)
        return FlatFront(*axes, self.height, np.zeros(1), half_width=0.5 * self.length)

    def surfaces(self, top: float, seen: tuple[float, float]) -> list[Surface]:
        """Return the block."""
        sides = (np.zeros(2), np.full(2, self.width), np.array([0.0, self.height]))
        return extruded(self, *sides, ends(self.length, 1, seen))

    def seen_parts(self, angle: float) -> Iterator[SeenPart]:
        """Yield the block."""
        yield seen_block(self, angle, "planter", self.width, self.length, self.height)
