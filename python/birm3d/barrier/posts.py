"""Poles and bollards: upright cylinders."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np
import numpy.typing as npt
from typing_extensions import override

from .. import _core
from ..base.checks import MOST_ELEMENTS, positive_and_finite
from .barrier_kind import BarrierKind, Surface
from .blocks import numbered, positive
from .description import SeenPart, Size, height_text
from .fronts import PostFront, axes_of
from .surfaces import cylinder
from .yielding import CONCRETE_STRENGTH, Foundation, Tube, Weaker, weaker_of

__all__ = ["BollardsKind", "PoleKind"]


@dataclass(frozen=True)
class PoleKind(BarrierKind):
    """One rigid, upright cylinder, taller than any vehicle; the barrier's line runs through its axis."""

    diameter: float = 0.3

    title: ClassVar = "pole"
    sizes: ClassVar = (Size("diameter"),)
    has_posts: ClassVar = True
    is_bottomless: ClassVar = True

    def elements(self) -> list[_core.Element]:
        """Return the pole."""
        positive_and_finite("diameter", self.diameter)
        return [
            _core.Element.post(
                radius=0.5 * self.diameter,
                height=math.inf,
                position=self.from_origin(0.0, 0.0),
                heading=math.radians(self.heading),
            )
        ]

    @property
    def element_names(self) -> tuple[str, ...]:
        """``pole``."""
        return ("pole",)

    @property
    def text(self) -> str:
        """Sizes in a few words."""
        return f"pole, Ø {self.diameter:g} m"

    def load_front(self) -> PostFront:
        """Return the post."""
        edges = np.array([-0.5, 0.5]) * self.diameter
        axes = axes_of(self.origin, self.heading)
        return PostFront(*axes, math.inf, np.zeros(1), -0.5 * self.diameter, edges)

    @override
    def surfaces(self, top: float, seen: tuple[float, float]) -> list[Surface]:
        """Return the pole, as high as is seen."""
        return [cylinder(np.asarray(self.origin), 0.5 * self.diameter, top)]

    @override
    def seen_parts(self, angle: float) -> Iterator[SeenPart]:
        """Yield the pole."""
        yield SeenPart("pole", self.diameter, -math.inf, math.inf)


@dataclass(frozen=True)
class BollardsKind(BarrierKind):
    """Bollards in rows: rigid, or steel tubes that yield.

    A bollard draws in the skin beside it, see :meth:`birm3d.Vehicle.with_indentation_length`.
    """

    count: int = 5
    diameter: float = 0.32
    height: float = 1.0
    spacing: float = 1.2
    rows: int = 1
    row_spacing: float = 1.2
    row_offset: float = 0.0
    wall_thickness: float | None = None
    yield_stress: float = 355e6
    filling: str | float | None = None
    foundation: Foundation | None = None

    _counts: ClassVar = ("count", "rows")
    title: ClassVar = "bollards"
    sizes: ClassVar = (
        Size("count", "count", "in each row"),
        Size("diameter"),
        Size("height"),
        Size("spacing", hint="axis to axis"),
        Size("rows", "count"),
        Size("row_spacing", hint="from row to row, axis to axis"),
        Size("row_offset", hint="shift of each row from the one before it"),
        Size("wall_thickness", hint="of a steel tube that yields; rigid without it"),
        Size("yield_stress", "pressure", "of the steel"),
        Size("filling", "choice", "of the tube", choices=("concrete",)),
        Size("foundation", "foundation", "what it resists"),
    )
    has_posts: ClassVar = True
    is_bottomless: ClassVar = True

    def elements(self) -> list[_core.Element]:
        """Return the bollards, row by row from the front, each from low y to high y."""
        if self.count * self.rows > MOST_ELEMENTS:
            raise ValueError(
                f"count must make at most {MOST_ELEMENTS:,} bollards with {self.rows} rows, got {self.count}"
            )
        positive_and_finite("diameter", self.diameter)
        positive("height", self.height)
        for name, number in (("spacing", self.count), ("row_spacing", self.rows)):
            value = getattr(self, name)
            if number > 1 and not (math.isfinite(value) and value > self.diameter):
                raise ValueError(
                    f"{name} must be finite and above the diameter ({self.diameter:g} m), got {value}"
                )
        if not math.isfinite(self.row_offset):
            raise ValueError(f"row_offset must be finite, got {self.row_offset}")
        depth = 0.0 if self.weaker is None else self.weaker.rotation_depth
        return [
            _core.Element.post(
                radius=0.5 * self.diameter,
                height=self.height + depth,
                position=self.from_origin(across, along) - np.array([0.0, 0.0, depth]),
                heading=math.radians(self.heading),
            )
            for across, along in self.places()
        ]

    @cached_property
    def tube(self) -> Tube | None:
        """The section of posts that yield; ``None`` of rigid ones."""
        if self.wall_thickness is None:
            return None
        if not 0.0 < self.wall_thickness <= 0.5 * self.diameter:
            raise ValueError(
                f"wall_thickness must be > 0 and at most half the diameter ({0.5 * self.diameter:g} m), "
                f"got {self.wall_thickness}"
            )
        positive_and_finite("yield_stress", self.yield_stress, "Pa")
        strength = 0.0
        if isinstance(self.filling, str):
            if self.filling != "concrete":
                raise ValueError(
                    f"filling must be 'concrete', its strength (Pa) or None, got {self.filling!r}"
                )
            strength = CONCRETE_STRENGTH
        elif self.filling is not None:
            strength = self.filling
            positive_and_finite("filling", strength, "Pa")
        return Tube(self.diameter, self.wall_thickness, self.yield_stress, strength)

    @cached_property
    def weaker(self) -> Weaker | None:
        """What gives way of posts that yield; ``None`` of rigid ones."""
        if self.tube is None:
            for name in ("filling", "foundation"):
                if getattr(self, name) is not None:
                    raise ValueError(
                        f"{name} must be None where no wall_thickness is given (the posts are rigid), "
                        f"got {getattr(self, name)!r}"
                    )
            return None
        if not math.isfinite(self.height):
            raise ValueError(f"height must be finite where posts yield, got {self.height}")
        return weaker_of(self.tube, self.height, self.foundation)

    def yields(self) -> _core.YieldingPosts | None:
        """Return what gives way of posts that yield."""
        return None if self.weaker is None else self.weaker.posts

    def rotation_centers(self) -> list[npt.NDArray[np.float64]]:
        """Return the centres of rotation of posts that yield."""
        if self.weaker is None:
            return []
        down = np.array([0.0, 0.0, self.weaker.rotation_depth])
        return [self.place(*place) - down for place in self.places()]

    def places(self) -> list[tuple[float, float]]:
        """Return the axes of the bollards across and along the line [m], see :meth:`Barrier.place`."""
        return [
            (
                row * self.row_spacing if row else 0.0,
                ((i - 0.5 * (self.count - 1)) * self.spacing if self.count > 1 else 0.0)
                + row * self.row_offset,
            )
            for row in range(self.rows)
            for i in range(self.count)
        ]

    @property
    def element_names(self) -> tuple[str, ...]:
        """``bollard 1``, ... from low y to high y, or ``row 1, bollard 1``, ..."""
        if self.rows == 1:
            return numbered("bollard", "bollard", self.count)
        return tuple(f"row {r + 1}, bollard {i + 1}" for r in range(self.rows) for i in range(self.count))

    @property
    def text(self) -> str:
        """Count and sizes in a few words."""
        many = self.count * self.rows > 1
        rows = f"{self.rows} rows of " if self.rows > 1 else ""
        text = f"{rows}{self.count} bollard{'s' if many else ''}, Ø {self.diameter:g} m"
        text += f", {height_text(self.height)}"
        if self.count > 1:
            text += f", {self.spacing:g} m between axes ({self.spacing - self.diameter:.3g} m clear)"
        if self.wall_thickness is not None and self.weaker is not None:
            text += f", steel {1e3 * self.wall_thickness:.3g} mm"
            text += "" if self.filling is None else " with concrete"
            turns, moment = self.weaker.foundation_turns, self.weaker.posts.plastic_moment
            what = (
                f"the foundation turns {self.weaker.rotation_depth:.2g} m below the ground"
                if turns
                else "yields"
            )
            text += f", {what} at {moment / 1e3:.3g} kN m"
        return text + (f", rows {self.row_spacing:g} m apart (axis to axis)" if self.rows > 1 else "")

    def load_front(self) -> PostFront:
        """Return the row of posts."""
        if self.rows > 1:
            raise ValueError(f"barrier must have one row of posts to have a load map, got {self.rows} rows")
        feet = np.array([along for _, along in self.places()])
        half = 0.5 * (self.spacing if self.count > 1 else self.diameter)
        edges = np.append(feet - half, feet[-1] + half)
        axes = axes_of(self.origin, self.heading)
        return PostFront(*axes, self.height, feet, -0.5 * self.diameter, edges)

    @override
    def surfaces(self, top: float, seen: tuple[float, float]) -> list[Surface]:
        """Return the bollards."""
        radius, height = 0.5 * self.diameter, min(self.height, top)
        return [cylinder(self.place(*place), radius, height) for place in self.places()]

    @override
    def seen_parts(self, angle: float) -> Iterator[SeenPart]:
        """Yield one for all: they are equal."""
        yield SeenPart("bollards", self.diameter, -math.inf, self.origin[2] + self.height)
