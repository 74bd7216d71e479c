"""Barriers: what a vehicle runs into."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, TypeAlias

import numpy as np
import numpy.typing as npt

from .. import _core
from ..base.arguments import check_fields, checked
from ..base.checks import MOST_ELEMENTS, whole_number
from ..unit_check import USUAL, given, warn_if_mesh_unusual
from ..units import Quantity, si
from .description import SeenPart, Size

if TYPE_CHECKING:
    from .free_standing import FreeStanding
    from .kinds import Bollards, Jersey, MeshBarrier, Planter, Pole, RigidWall

__all__ = ["Barrier", "Surface"]

Point = tuple[float, float, float]
Surface: TypeAlias = "tuple[npt.NDArray[np.float64], npt.NDArray[np.int64]]"
"""Vertices (n, 3), world axes [m], and triangles (m, 3), counter-clockwise seen from outside."""


@checked
@dataclass(frozen=True)
class Barrier:
    """A barrier that stands on the ground; immutable. Make one with :meth:`rigid_wall`, :meth:`bollards`, ...

    Its line runs along +y at heading 0 and its traffic face looks to -x; the vehicle comes from there. It has
    one or more elements (a post, a segment of a wall): loads are reported element by element, see
    :attr:`birm3d.Result.element_loads`.

    Parameters
    ----------
    friction
        Coulomb coefficient between vehicle and barrier; 0.15 to 0.20 for steel on concrete (paper 5.4).
        Tyres have one of their own, :attr:`birm3d.Settings.mu_tire_barrier`; at 0 they slide without
        friction too, unless the settings give them a number.
    origin
        The middle of the barrier on its line, at the foot of its traffic face, of posts of their axes; world
        axes, shape (3,) [m]. Moved along its line the barrier is met at another place: the vehicle keeps its
        path, see ``impact_offset`` of :class:`birm3d.Simulation` and :meth:`station`.
    heading
        Turn of the barrier's line about the vertical [deg].
    """

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
    """Whether it is made of posts, which dent the skin beside them."""
    why_no_dents: ClassVar[str] = "the barrier has no posts"

    def __post_init__(self) -> None:
        object.__setattr__(self, "origin", _point(self.origin))
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

    # ---- making barriers ----------------------------------------------------------------------------------

    @staticmethod
    def rigid_wall(
        *,
        width: Quantity | None = None,
        height: Quantity | None = None,
        thickness: Quantity = 0.5,
        segments: int = 1,
        edge_radius: Quantity = 0.0,
        friction: float = 0.2,
        origin: Sequence[Quantity] = (0.0, 0.0, 0.0),
        heading: Quantity = 0.0,
    ) -> RigidWall:
        """Return a flat, rigid, vertical wall; see :class:`birm3d.barrier.kinds.RigidWall`.

        Parameters
        ----------
        width, height
            Of the wall, its middle at the origin [m]; ``None``: without end, but a wall with rounded edges is
            then 4 m wide.
        thickness
            Of a wall that has an end or a top [m].
        segments
            Elements of equal width that a wall of finite width is made of.
        edge_radius
            Of the upright edges [m], at most half of thickness and width; 0: sharp. The width is counted from
            the outermost place of one arc to that of the other.
        friction, origin, heading
            See :class:`Barrier`.

        Raises
        ------
        ValueError
            If a number is out of range; the message names argument, limit and value.
        """
        from .kinds import RigidWall

        radius = given("edge_radius", edge_radius)
        rounded = radius > 0.0
        return RigidWall(
            float(friction),
            _point(origin),
            given("heading", heading),
            width=(4.0 if rounded else math.inf) if width is None else given("width", width),
            height=math.inf if height is None else given("height", height),
            thickness=given("thickness", thickness),
            segments=segments,
            edge_radius=radius,
        )

    @staticmethod
    def pole(
        *,
        diameter: Quantity = 0.3,
        friction: float = 0.2,
        origin: Sequence[Quantity] = (0.0, 0.0, 0.0),
        heading: Quantity = 0.0,
    ) -> Pole:
        """Return one rigid, upright cylinder, taller than any vehicle.

        Parameters
        ----------
        diameter
            [m], > 0.
        friction, origin, heading
            See :class:`Barrier`.

        Raises
        ------
        ValueError
            If a number is out of range; the message names argument, limit and value.
        """
        from .kinds import Pole

        return Pole(
            float(friction),
            _point(origin),
            given("heading", heading),
            diameter=given("diameter", diameter),
        )

    @staticmethod
    def bollards(
        *,
        count: int = 5,
        diameter: Quantity = 0.32,
        height: Quantity = 1.0,
        spacing: Quantity = 1.2,
        rows: int = 1,
        row_spacing: Quantity = 1.2,
        row_offset: Quantity = 0.0,
        friction: float = 0.2,
        origin: Sequence[Quantity] = (0.0, 0.0, 0.0),
        heading: Quantity = 0.0,
    ) -> Bollards:
        """Return rigid bollards in one or more rows along the barrier's line.

        Parameters
        ----------
        count
            In each row; the row's middle is at the origin.
        diameter, height
            [m], > 0.
        spacing
            Of neighbours in a row, centre to centre [m]; more than the diameter.
        rows, row_spacing
            Further rows stand behind the first, this far from axis to axis [m]; more than the diameter.
        row_offset
            By which each row is shifted along the line from the one before it [m].
        friction, origin, heading
            See :class:`Barrier`.

        Raises
        ------
        ValueError
            If a number is out of range; the message names argument, limit and value.
        """
        from .kinds import Bollards

        return Bollards(
            float(friction),
            _point(origin),
            given("heading", heading),
            count=count,
            diameter=given("diameter", diameter),
            height=given("height", height),
            spacing=given("spacing", spacing),
            rows=rows,
            row_spacing=given("row_spacing", row_spacing),
            row_offset=given("row_offset", row_offset),
        )

    @staticmethod
    def jersey(
        *,
        profile: str | Sequence[Sequence[float]] = "new_jersey",
        height: Quantity | None = None,
        length: Quantity | None = None,
        segments: int = 1,
        free_standing: bool | FreeStanding = False,
        density: Quantity | None = None,
        friction: float = 0.2,
        origin: Sequence[Quantity] = (0.0, 0.0, 0.0),
        heading: Quantity = 0.0,
    ) -> Jersey:
        """Return a concrete barrier with sloped faces; see :class:`birm3d.barrier.kinds.Jersey`.

        Parameters
        ----------
        profile
            ``"new_jersey"``, ``"f_shape"``, ``"single_slope"``, or points (half width, height) [m] from the
            foot to the top, shape (n, 2).
        height
            The named profiles' upper face is cut or drawn out to it [m]; ``None``: 0.81 m (32 in), of the
            single slope 1.07 m (42 in).
        length
            Along the line, its middle at the origin [m]; ``None``: without end.
        segments
            Elements of equal length that a barrier of finite length is made of.
        free_standing
            Whether the segments only stand on the ground, pinned end to end, and slide when they are hit; a
            :class:`birm3d.FreeStanding` says more. Fixed barriers do not move.
        density
            Of a free-standing barrier [kg/m^3]; ``None``: concrete, 2400. A fixed one has no use for it.
        friction, origin, heading
            See :class:`Barrier`.

        Raises
        ------
        ValueError
            If a number is out of range; the message names argument, limit and value.
        """
        from .free_standing import FreeStanding
        from .kinds import Jersey

        if isinstance(free_standing, FreeStanding):
            if density is not None:
                raise ValueError(
                    f"density must be given in free_standing where that says more, got {density}"
                )
            free: FreeStanding | None = free_standing
        else:
            if density is not None:
                density = given("density", density)
            stands = FreeStanding(density=density)  # refuses a density that is none
            free = stands if free_standing else None

        points: Any = profile
        if not isinstance(profile, str):
            if np.ndim(profile) != 2 or np.shape(profile)[1] != 2:
                raise ValueError(f"profile must have shape (n, 2), got {np.shape(profile)}")
            points = tuple((float(x), float(z)) for x, z in profile)
        return Jersey(
            float(friction),
            _point(origin),
            given("heading", heading),
            profile=points,
            height=None if height is None else given("height", height),
            length=math.inf if length is None else given("length", length),
            segments=segments,
            free_standing=free,
        )

    @staticmethod
    def planter(
        *,
        length: Quantity = 2.0,
        width: Quantity = 1.0,
        height: Quantity = 1.0,
        friction: float = 0.2,
        origin: Sequence[Quantity] = (0.0, 0.0, 0.0),
        heading: Quantity = 0.0,
    ) -> Planter:
        """Return a planter: a rigid, fixed, solid block; its middle along the line is at the origin.

        Parameters
        ----------
        length
            Along the line [m], > 0.
        width
            Square to the line, away from the traffic [m], > 0.
        height
            [m], > 0.
        friction, origin, heading
            See :class:`Barrier`.

        Raises
        ------
        ValueError
            If a number is out of range; the message names argument, limit and value.
        """
        from .kinds import Planter

        return Planter(
            float(friction),
            _point(origin),
            given("heading", heading),
            length=given("length", length),
            width=given("width", width),
            height=given("height", height),
        )

    @staticmethod
    def from_mesh(
        vertices: npt.ArrayLike,
        faces: npt.ArrayLike,
        *,
        friction: float = 0.2,
        origin: Sequence[Quantity] = (0.0, 0.0, 0.0),
        heading: Quantity = 0.0,
    ) -> MeshBarrier:
        """Return a barrier of triangles, met by the paper's vertex-to-face algorithm (Eq. 8-15).

        Parameters
        ----------
        vertices
            Shape (n, 3), in axes that stand at ``origin``, turned by ``heading``, z up [m].
        faces
            Shape (m, 3), indices into the vertices, counter-clockwise seen from outside. They close a solid,
            or one that is open only where it stands on the ground: a hole has no inside.
        friction, origin, heading
            See :class:`Barrier`.

        Raises
        ------
        ValueError
            If shapes or indices are wrong, the triangles have a hole, or the solid is inside out;
            the message names the culprit.
        """
        from .kinds import MeshBarrier

        points = np.array(vertices, float)
        if points.ndim == 2 and points.shape[0] > 0 and points.shape[1] == 3:
            warn_if_mesh_unusual(float(np.ptp(points[:, 2])))
        return MeshBarrier(
            float(friction),
            _point(origin),
            given("heading", heading),
            vertices=points,
            faces=np.array(faces),
        )

    # ---- for the core -------------------------------------------------------------------------------------

    def elements(self) -> list[_core.Element]:
        """Return the elements for the core; a kind of barrier says which."""
        raise TypeError("a Barrier is made with rigid_wall, pole, bollards, jersey, planter or from_mesh")

    @property
    def element_names(self) -> tuple[str, ...]:
        """What the elements are called in tables and plots, in their order."""
        return tuple(f"element {i + 1}" for i in range(len(self.elements())))

    @cached_property
    def core(self) -> _core.Barrier:
        """The same barrier for the core."""
        free = self.stands_free()
        return _core.Barrier(
            elements=self.elements(),
            friction=self.friction,
            origin=np.asarray(self.origin, float),
            heading=math.radians(self.heading),
            free_standing=[] if free is None else [free],
        )

    @cached_property
    def _past(self) -> tuple[float, float, float]:
        """Unit vector square to the line, into the barrier, world axes."""
        x, y, z = (-np.asarray(self.core.normal)).tolist()
        return x, y, z

    def stands_free(self) -> _core.FreeStanding | None:
        """Return how its elements stand free, for the core; ``None`` where they are fixed."""
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

        What has no top is drawn up to ``top``, what has no end between the marks ``seen`` of the line [m].
        """
        raise TypeError(f"no surface of a {type(self).__name__}")

    def seen_parts(self, angle: float) -> Iterator[SeenPart]:
        """Yield the parts that a path at an angle to the line meets [rad]: how wide each is."""
        raise TypeError(f"no parts of a {type(self).__name__}")

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
        turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
        return np.array([*(turn @ [across, along]), 0.0])

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


def _point(origin: Sequence[Quantity]) -> Point:
    if np.shape(origin) != (3,):
        raise ValueError(f"origin must have shape (3,), got {np.shape(origin)}")
    x, y, z = (si("origin", value, "length") for value in origin)
    return x, y, z
