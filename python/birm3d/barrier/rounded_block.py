"""What walls and planters share: upright edges, rounded or sharp, and how the block draws in skin."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import numpy.typing as npt

from .barrier_kind import BarrierKind, Surface
from .blocks import along_line, block_profile, rounded_block
from .edges import check_edge_radius, edges_text, rounded_outline, segment_outlines, usual_edge_radius
from .surfaces import drawn_up, placed

if TYPE_CHECKING:
    from .. import _core

__all__ = ["BlockPlan", "RoundedBlock"]

Floats = npt.NDArray[np.float64]


class BlockPlan(NamedTuple):
    """A block seen from above: sizes across and along the line [m], and users' words for a segment's."""

    depth: float
    length: float
    names: tuple[str, str]


class RoundedBlock(BarrierKind):
    """A solid block along the line. Its upright edges are sharp, or rounded by :attr:`rounding`.

    Sharp edges pass between nodes of the skin. Rounded edges on the traffic's side are posts: like bollards
    they draw in the skin beside them. So does the top of the traffic face with the skin above it.
    """

    segments = 1  # of equal length along the line
    height: float
    edge_radius: float | None  # None: the usual one; 0: sharp edges, as in files of earlier versions

    @property
    def plan(self) -> BlockPlan:
        """Sizes seen from above."""
        raise NotImplementedError

    @property
    def rounding(self) -> float:
        """Radius of the upright edges [m]; 0: sharp."""
        if self.edge_radius is not None:
            return self.edge_radius
        depth, length, _ = self.plan
        return usual_edge_radius(depth, length / self.segments) if math.isfinite(length) else 0.0

    @property
    def draws_in_above(self) -> bool:
        """Whether it draws in the skin above its top as a bollard does. With sharp edges it does not."""
        return math.isfinite(self.height) and self.edge_radius != 0.0

    @property
    def draws_in_skin(self) -> bool:
        """Whether it draws in skin, beside rounded edges or above its top."""
        return self.rounding > 0.0 or self.draws_in_above

    @property
    def cuts_skin(self) -> bool:
        """Whether it has upright edges, and they are sharp."""
        return math.isfinite(self.plan.length) and self.rounding == 0.0

    @property
    def is_bottomless(self) -> bool:
        """Whether it goes on below the ground without end."""
        return self.rounding > 0.0

    def check_edges(self) -> None:
        """Refuse a radius of the edges that does not fit."""
        depth, length, names = self.plan
        check_edge_radius(self.rounding, dict(zip(names, (depth, length / self.segments), strict=True)))
        if self.rounding > 0.0 and math.isinf(length):
            raise ValueError(f"edge_radius must be 0 m for a wall of infinite width, got {self.rounding}")

    def edges_text(self) -> str:
        """Return in words what is unusual about the edges; "" where nothing is."""
        depth, length, _ = self.plan
        return edges_text(self.rounding, depth, length / self.segments) if math.isfinite(length) else ""

    def block_elements(self, top: float, along: float = 0.0, number: int = 0) -> list[_core.Element]:
        """Return the elements of the block up to a height [m]: its segments, then their parts.

        ``along``: place of its middle [m]. ``number``: of its first segment among the barrier's elements.
        """
        depth, length, _ = self.plan
        draws_in = self.draws_in_above
        if self.rounding > 0.0:
            sizes = (depth, length, top, self.rounding, self.segments)
            return rounded_block(self, *sizes, draws_in_above=draws_in, along=along, number=number)
        profile = block_profile(depth, top)
        return along_line(self, profile, 0.0, length, self.segments, draws_in_above=draws_in, along=along)

    def outline(self) -> Floats:
        """Return the plan of the block with rounded edges: across and along of its corners, (n, 2) [m]."""
        depth, length, _ = self.plan
        return rounded_outline(depth, length, self.rounding)

    def rounded_surfaces(self, height: float, along: float = 0.0) -> list[Surface]:
        """Return closed segments of a block with rounded edges; `along`: place of its middle [m]."""
        depth, length, _ = self.plan
        outlines = segment_outlines(depth, length, self.rounding, self.segments)
        plans = [np.add(plan, (0.0, along)) for plan in outlines]
        drawn = [drawn_up(plan, 0.0, height) for plan in plans]
        return [(placed(self, vertices), faces) for vertices, faces in drawn]
