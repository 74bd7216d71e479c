"""Barriers: what a vehicle runs into. ``Barrier.rigid_wall()``, ``Barrier.pole()``, ... make them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from .. import _core, pictures
from ..base.arguments import checked
from ..unit_check import USUAL, given, warn_if_mesh_unusual, warn_if_unusual
from ..units import Quantity, si
from .barrier_kind import BarrierKind, Point, point_of
from .free_standing import FreeStanding
from .jersey import JerseyKind
from .mesh import MeshKind
from .planter import PlanterKind
from .posts import BollardsKind, PoleKind
from .rigid_wall import RigidWallKind
from .yielding import Foundation

__all__ = ["Barrier", "Bollards", "Jersey", "MeshBarrier", "Planter", "Pole", "RigidWall"]

# Longer than 300 lines: what users read of all kinds of barriers, side by side.


@checked
class Barrier(BarrierKind):
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

    _of_text: ClassVar[str] = "Barrier.bollards() and others like it return one"

    def elements(self) -> list[_core.Element]:
        """Refuse: only kinds of barriers have elements."""
        makers = [name for name, made in vars(Barrier).items() if isinstance(made, staticmethod)]
        raise TypeError(f"a Barrier is made with {', '.join(makers[:-1])} or {makers[-1]}")

    def _repr_html_(self) -> str:
        return pictures.barrier_html(self)

    @staticmethod
    def rigid_wall(
        *,
        width: Quantity | None = None,
        height: Quantity | None = None,
        thickness: Quantity = 0.5,
        segments: int = 1,
        edge_radius: Quantity | None = None,
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
            Of the upright edges at the wall's ends [m], at most half of the thickness and of the width of a
            segment. The width is counted from the outermost place of one arc to that of the other. ``None``:
            0.05 m where the wall has ends, or half of what is thinner. 0: sharp edges, which pass between
            nodes. Edges on the traffic's side draw in the skin beside them, those behind do not. The
            top of the traffic face draws in the skin above it, unless this is 0.
        friction, origin, heading
            See :class:`Barrier`.

        Raises
        ------
        ValueError
            If a number is out of range; the message names argument, limit and value.
        """
        radius = None if edge_radius is None else given("edge_radius", edge_radius)
        rounded = radius is not None and radius > 0.0
        return RigidWall(
            *_common(friction, origin, heading),
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
        return Pole(
            *_common(friction, origin, heading),
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
        wall_thickness: Quantity | None = None,
        yield_stress: Quantity = 355e6,
        filling: str | float | None = None,
        foundation: Foundation | None = None,
        friction: float = 0.2,
        origin: Sequence[Quantity] = (0.0, 0.0, 0.0),
        heading: Quantity = 0.0,
    ) -> Bollards:
        """Return bollards in one or more rows along the barrier's line: rigid, or steel tubes that yield.

        A tube that yields stands still until the moment at its foot exceeds the plastic one of its section.
        Then it tilts about its foot, and the moment resists at any tilt (rigid, perfectly plastic). It does
        not spring back, buckle or tear.

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
        wall_thickness
            Of a steel tube that yields [m]; half of the diameter is a solid bar. ``None``: rigid posts.
        yield_stress
            Of the steel [Pa]. The default is the nominal one of S355. Delivered steel, strain hardening and
            the rate of an impact make it 1.5 to 2 times as strong, an estimate. Run a lower and an upper one.
        filling
            Of the tube: ``"concrete"`` (30 MPa), a compressive strength [Pa], or ``None``: it is empty. A
            slender tube may buckle at its foot before it has its plastic moment; design loads caution of it.
        foundation
            What holds the tube in the ground, see :class:`birm3d.Foundation`. The weaker of the two gives
            way, judged by a load 0.6 m above the ground. ``None``: the ground does not yield.
        friction, origin, heading
            See :class:`Barrier`.

        Raises
        ------
        ValueError
            If a number is out of range; the message names argument, limit and value.
        """
        return Bollards(
            *_common(friction, origin, heading),
            count=count,
            diameter=given("diameter", diameter),
            height=given("height", height),
            spacing=given("spacing", spacing),
            rows=rows,
            row_spacing=given("row_spacing", row_spacing),
            row_offset=given("row_offset", row_offset),
            wall_thickness=None if wall_thickness is None else given("wall_thickness", wall_thickness),
            yield_stress=given("yield_stress", yield_stress),
            filling=_filling(filling),
            foundation=foundation,
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
            *_common(friction, origin, heading),
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
        edge_radius: Quantity | None = None,
        count: int = 1,
        spacing: Quantity = 3.2,
        friction: float = 0.2,
        origin: Sequence[Quantity] = (0.0, 0.0, 0.0),
        heading: Quantity = 0.0,
    ) -> Planter:
        """Return planters in a row: rigid, fixed, solid blocks; the row's middle is at the origin.

        Parameters
        ----------
        length
            Along the line [m], > 0.
        width
            Square to the line, away from the traffic [m], > 0.
        height
            [m], > 0.
        edge_radius
            Of the upright edges [m], at most half of length and width. ``None``: 0.05 m, or half of what is
            thinner. 0: sharp edges, which pass between nodes. They do not draw in skin, nor does the top.
        count
            Number of planters.
        spacing
            From the middle of one planter to that of the next [m], above the length. The clear gap is the
            spacing less the length.
        friction, origin, heading
            See :class:`Barrier`.

        Raises
        ------
        ValueError
            If a number is out of range; the message names argument, limit and value.
        """
        return Planter(
            *_common(friction, origin, heading),
            length=given("length", length),
            width=given("width", width),
            height=given("height", height),
            edge_radius=None if edge_radius is None else given("edge_radius", edge_radius),
            count=count,
            spacing=given("spacing", spacing),
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

        Triangles draw in no skin beside them. For what is narrower than the vehicle take :meth:`bollards`,
        :meth:`pole` or :meth:`planter`, or it is driven in to the rigid core: see
        :class:`birm3d.CoreContactWarning`.

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
        points = np.array(vertices, float)
        if points.ndim == 2 and points.shape[0] > 0 and points.shape[1] == 3:
            warn_if_mesh_unusual(float(np.ptp(points[:, 2])))
        return MeshBarrier(
            *_common(friction, origin, heading),
            vertices=points,
            faces=np.array(faces),
        )


# Makers return these classes, and each of them is a Barrier. So they stand in one module with it: else two
# modules would import each other. What a kind is stands in the class that it derives from first.


class RigidWall(RigidWallKind, Barrier):
    """See :class:`~birm3d.barrier.rigid_wall.RigidWallKind`."""


class Pole(PoleKind, Barrier):
    """See :class:`~birm3d.barrier.posts.PoleKind`."""


class Bollards(BollardsKind, Barrier):
    """See :class:`~birm3d.barrier.posts.BollardsKind`."""


class Jersey(JerseyKind, Barrier):
    """See :class:`~birm3d.barrier.jersey.JerseyKind`."""


class Planter(PlanterKind, Barrier):
    """See :class:`~birm3d.barrier.planter.PlanterKind`."""


class MeshBarrier(MeshKind, Barrier):
    """See :class:`~birm3d.barrier.mesh.MeshKind`."""


def _filling(filling: str | float | None) -> str | float | None:
    """Return the filling of a tube; text with a unit as a strength [Pa]."""
    if filling is None or (isinstance(filling, str) and filling == "concrete"):
        return filling
    strength = si("filling", filling, "pressure")
    if not isinstance(filling, str):
        warn_if_unusual("filling", strength, USUAL["concrete_strength"])
    return strength


def _common(friction: float, origin: Sequence[Quantity], heading: Quantity) -> tuple[float, Point, float]:
    """Return the numbers that every kind of barrier has, SI and degrees."""
    return float(friction), point_of(origin), given("heading", heading)
