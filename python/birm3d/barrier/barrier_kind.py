"""What every kind of barrier has: its place, its friction, and how it describes itself."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from typing import ClassVar, TypeAlias

import numpy as np
import numpy.typing as npt

from .. import _core
from ..base.arguments import check_fields, checked
from ..base.checks import MOST_ELEMENTS, whole_number
from ..unit_check import USUAL, given
from ..units import Quantity, si
from .description import SeenPart, Size
from .fronts import Front

__all__ = ["BarrierKind", "Point", "Surface", "point_of"]

Point: TypeAlias = "tuple[float, float, float]"
"""World axes [m]."""

Surface: TypeAlias = "tuple[npt.NDArray[np.float64], npt.NDArray[np.int64]]"
"""Vertices (n, 3), world axes [m], and triangles (m, 3), counter-clockwise seen from outside."""


@checked
@dataclass(frozen=True)
class BarrierKind:
    """What a kind of barrier derives from; :class:`birm3d.Barrier` explains the fields and makes barriers."""

    friction: float = 0.2
    origin: Point = (0.0, 0.0, 0.0)
    heading: float = 0.0

    _counts: ClassVar[tuple[str, ...]] = ()  # fields that are whole numbers

    title: ClassVar[str] = "barrier"
    """What help texts call this kind."""
    sizes: ClassVar[tuple[Size, ...]] = ()
    """Its arguments: scene files, the command line and names of parameters are made of them."""
    is_straight: ClassVar[bool] = False
    """Whether its face is straight along the line: it redirects, and moments are about the line."""
    has_posts: ClassVar[bool] = False
    """Whether it is made of posts, which indent the skin beside them."""
    why_no_indentation: ClassVar[str] = "the barrier has no posts"
    """Why the skin beside it is not indented, for the report of what a run left out."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "origin", point_of(self.origin))
        for name, value in vars(self).items():  # a changed copy is given text too
            if isinstance(value, str) and name in USUAL:
                object.__setattr__(self, name, given(name, value))
        for name in self._counts:
            count = whole_number(name, getattr(self, name), most=MOST_ELEMENTS)
            object.__setattr__(self, name, count)  # a sweep gives 3.0
        check_fields(self)
        if not math.isfinite(self.heading):
            raise ValueError(f"heading must be finite, got {self.heading}")
        _ = self.core

    # ---- what the core needs ------------------------------------------------------------------------------

    def elements(self) -> list[_core.Element]:
        """Return the elements for the core; a kind of barrier says which."""
        raise NotImplementedError

    @property
    def draws_in_skin(self) -> bool:
        """Whether the skin beside it is drawn in, as beside a post."""
        return self.has_posts

    @property
    def cuts_skin(self) -> bool:
        """Whether it has sharp upright edges that could be rounded."""
        return False

    @property
    def element_names(self) -> tuple[str, ...]:
        """What the elements are called in tables and plots, in their order."""
        return tuple(f"element {i + 1}" for i in range(len(self.elements())))

    @cached_property
    def core(self) -> _core.Barrier:
        """The same barrier for the core."""
        free, posts = self.stands_free(), self.yields()
        return _core.Barrier(
            elements=self.elements(),
            friction=self.friction,
            origin=np.asarray(self.origin, float),
            heading=math.radians(self.heading),
            free_standing=[] if free is None else [free],
            yielding=[] if posts is None else [posts],
        )

    @cached_property
    def _top(self) -> float:
        """Greatest height above the ground [m]; 100 m or infinite where it has no end."""
        return self.core.top

    @cached_property
    def _past(self) -> tuple[float, float, float]:
        """Unit vector square to the line, into the barrier, world axes."""
        x, y, z = (-np.asarray(self.core.normal)).tolist()
        return x, y, z

    def stands_free(self) -> _core.FreeStanding | None:
        """Return how its elements stand free, for the core; ``None`` where they are fixed."""
        return None

    def yields(self) -> _core.YieldingPosts | None:
        """Return how its posts yield, for the core; ``None`` where they are rigid."""
        return None

    def rotation_centers(self) -> list[npt.NDArray[np.float64]]:
        """Return the points about which its posts turn if they yield, world axes, each (3,) [m]."""
        return []

    def load_front(self) -> Front | None:
        """Return the front on which a load map of the barrier stands; ``None`` where it has none."""
        return None

    # ---- how a kind describes itself ----------------------------------------------------------------------

    @property
    def text(self) -> str:
        """Kind, count and sizes in a few words, for titles."""
        return type(self).__name__

    @property
    def is_bottomless(self) -> bool:
        """Whether it goes on below the ground without end."""
        return False

    def surfaces(self, top: float, seen: tuple[float, float]) -> list[Surface]:
        """Return the closed surfaces that pictures show, one for each element.

        Endlessly high ones are drawn up to ``top``, endlessly long ones between the places ``seen`` [m].
        """
        raise NotImplementedError(f"no surface of a {type(self).__name__}")

    def seen_parts(self, angle: float) -> Iterator[SeenPart]:
        """Yield the parts that a path at an angle to the line meets [rad]: how wide each is."""
        raise NotImplementedError(f"no parts of a {type(self).__name__}")

    @property
    def is_pinned(self) -> bool:
        """Whether it has free-standing segments that are pinned to each other."""
        return False

    def place(self, across: float, along: float) -> npt.NDArray[np.float64]:
        """Return a point at the foot of the barrier, world axes, shape (3,) [m].

        ``across`` is counted from the line, away from the traffic, ``along`` from the origin.
        """
        return np.asarray(np.asarray(self.origin) + self.from_origin(across, along))

    def from_origin(self, across: float, along: float) -> npt.NDArray[np.float64]:
        """Return the same point from the origin, along the world's axes, shape (3,) [m]."""
        angle = math.radians(self.heading)
        c, s = math.cos(angle), math.sin(angle)
        return np.array([c * across - s * along, s * across + c * along, 0.0])

    def station(self, point: Sequence[Quantity] | None = None) -> float:
        """Return how far along the barrier's line a point is [m], counted as ``impact_offset`` is.

        That is from the point of the line nearest to the world's origin: ``point . (-sin h, cos h)`` at the
        heading h. ``impact_offset=barrier.station()`` is a path through the barrier's origin.

        Parameters
        ----------
        point
            World axes, shape (2,) or (3,) [m]; ``None``: the barrier's ``origin``.

        Raises
        ------
        ValueError
            If the point is none.
        """
        place = [si("point", value, "length") for value in (self.origin if point is None else point)]
        if len(place) not in (2, 3) or not all(math.isfinite(value) for value in place):
            raise ValueError(f"point must be two or three finite numbers (m), got {point}")
        angle = math.radians(self.heading)
        return float(place[1] * math.cos(angle) - place[0] * math.sin(angle))

    def __getstate__(self) -> dict[str, object]:
        return {field.name: getattr(self, field.name) for field in fields(self)}


def point_of(origin: Sequence[Quantity]) -> Point:
    """Return a place in world axes [m], given as numbers or text with a unit."""
    if np.shape(origin) != (3,):
        raise ValueError(f"origin must have shape (3,), got {np.shape(origin)}")
    x, y, z = (si("origin", value, "length") for value in origin)
    return x, y, z
