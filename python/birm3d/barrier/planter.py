"""A planter: a rigid block with a top that a vehicle may come over."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from .. import _core
from .base import Barrier, Surface
from .blocks import (
    FOOT,
    along_line,
    positive_and_finite,
    rounded_block,
    seen_block,
)
from .description import SeenPart, Size
from .edges import check_edge_radius, edges_text, rounded_outline, usual_edge_radius
from .fronts import FlatFront, axes_of
from .surfaces import drawn_up, ends, extruded, placed

__all__ = ["Planter"]


@dataclass(frozen=True)
class Planter(Barrier):
    """A rigid, fixed, solid block of given footprint and height; its line is the foot of its traffic face.

    Its upright edges are sharp, or rounded as those of a wall.
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
        check_edge_radius(self.rounding, {"length": self.length, "width": self.width})
        width, top = self.width, self.height
        if self.rounding > 0.0:
            return rounded_block(self, width, self.length, top, self.rounding)
        corners = [(0.0, -FOOT), (width, -FOOT), (width, top), (0.0, top)]
        return along_line(self, np.array(corners), 0.0, self.length, 1)

    @property
    def rounding(self) -> float:
        """Radius of the upright edges [m]; 0: sharp."""
        return usual_edge_radius(self.width, self.length) if self.edge_radius is None else self.edge_radius

    @property
    def draws_in_skin(self) -> bool:
        """Whether its edges are rounded."""
        return self.rounding > 0.0

    @property
    def cuts_skin(self) -> bool:
        """Whether its edges are sharp."""
        return not self.draws_in_skin

    @property
    def is_bottomless(self) -> bool:
        """Whether it goes on below the ground without end."""
        return self.draws_in_skin

    @property
    def element_names(self) -> tuple[str, ...]:
        """``planter``."""
        return ("planter",)

    @property
    def text(self) -> str:
        """Sizes in a few words."""
        edges = edges_text(self.rounding, self.width, self.length)
        return f"planter, {self.length:g} m long, {self.width:g} m wide, {self.height:g} m high{edges}"

    def load_front(self) -> FlatFront:
        """Return the traffic face."""
        axes = axes_of(self.origin, self.heading)
        return FlatFront(*axes, self.height, np.zeros(1), half_width=0.5 * self.length, radius=self.rounding)

    def surfaces(self, top: float, seen: tuple[float, float]) -> list[Surface]:
        """Return the block."""
        if self.rounding > 0.0:
            vertices, faces = drawn_up(
                rounded_outline(self.width, self.length, self.rounding), 0.0, self.height
            )
            return [(placed(self, vertices), faces)]
        sides = (np.zeros(2), np.full(2, self.width), np.array([0.0, self.height]))
        return extruded(self, *sides, ends(self.length, 1, seen))

    def seen_parts(self, angle: float) -> Iterator[SeenPart]:
        """Yield the block."""
        yield seen_block(self, angle, "planter", self.width, self.length, self.height)
