"""The kinds of barriers; make one through :class:`birm3d.Barrier`."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from types import MappingProxyType
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from .. import _core
from ..base.checks import MOST_ELEMENTS
from .base import Barrier
from .closed_mesh import check_closed
from .free_standing import FreeStanding

__all__ = ["PROFILES", "Bollards", "Jersey", "MeshBarrier", "Pole", "RigidWall", "drawn_up"]

Floats = npt.NDArray[np.float64]

# A wall of finite width without a top has it here, above anything that could come [m].
_HIGH = 100.0
# Solids that stand on the ground go on below it, so that nothing is pushed out downwards [m].
_FOOT = 1.0
# Of the polygon that an arc of 90 degrees is made of.
_SIDES_OF_QUARTER = 15


def _positive(name: str, value: float) -> None:
    if not value > 0.0:
        raise ValueError(f"{name} must be > 0 m, got {value}")


def _finite(name: str, value: float) -> None:
    if not 0.0 < value < math.inf:
        raise ValueError(f"{name} must be finite and > 0 m, got {value}")


@dataclass(frozen=True)
class RigidWall(Barrier):
    """A flat, rigid, vertical wall.

    Without end in width and height it is a half-space. Else it has a ``thickness``, with ends, a top and a
    back that can be met like the face. Its upright edges are sharp, or rounded by ``edge_radius``: then it is
    one closed mesh, see :meth:`outline`, whose faces go over into arcs without a seam.
    """

    width: float = math.inf
    height: float = math.inf
    thickness: float = 0.5
    segments: int = 1
    edge_radius: float = 0.0

    _counts: ClassVar = ("segments",)

    def elements(self) -> list[_core.Element]:
        """Return the segments, from low y to high y."""
        _positive("width", self.width)
        _positive("height", self.height)
        _finite("thickness", self.thickness)
        heading = math.radians(self.heading)
        self._check_edges()
        if self.edge_radius > 0.0:
            top = self.height if math.isfinite(self.height) else _HIGH
            vertices, faces = drawn_up(self.outline(), -_FOOT, top)
            return [
                _core.Element.mesh(
                    vertices=vertices,
                    faces=faces.tolist(),
                    position=self.from_origin(0.0, 0.0),
                    heading=heading,
                )
            ]
        if math.isinf(self.width) and self.segments > 1:
            raise ValueError(f"segments must be 1 for a wall of infinite width, got {self.segments}")
        if math.isinf(self.width) and math.isinf(self.height):
            return [_core.Element.plane(position=self.from_origin(0.0, 0.0), heading=heading)]
        top = self.height if math.isfinite(self.height) else _HIGH
        corners = [(0.0, -_FOOT), (self.thickness, -_FOOT), (self.thickness, top), (0.0, top)]
        return _along_line(self, np.array(corners), 0.0, self.width, self.segments)

    def outline(self) -> Floats:
        """Return the plan of a wall with rounded edges: across and along of its corners, shape (n, 2) [m].

        The arcs are polygons of 6 degrees a side with their corners on the arc. At the radius r they lie
        within 0.0014 r of it.
        """
        quarter = np.linspace(0.0, 0.5 * np.pi, _SIDES_OF_QUARTER + 1)
        arc = self.edge_radius * np.stack([np.cos(quarter), np.sin(quarter)], axis=1)
        middle = np.array([0.5 * self.thickness, 0.0])
        corner = np.array([middle[0], 0.5 * self.width]) - self.edge_radius
        parts = []
        for c, s, sides in ((1, 0, (1, 1)), (0, 1, (-1, 1)), (-1, 0, (-1, -1)), (0, -1, (1, -1))):
            parts.append(middle + corner * sides + arc @ np.array([[c, s], [-s, c]]))
        ring = np.vstack(parts)
        # Where the radius is half of the wall, arcs end where the next ones begin.
        apart = np.linalg.norm(ring - np.roll(ring, 1, axis=0), axis=1) > 1e-9
        return np.asarray(ring[apart])

    def _check_edges(self) -> None:
        radius = self.edge_radius
        most = 0.5 * min(self.thickness, self.width)
        if not 0.0 <= radius <= most:
            raise ValueError(
                f"edge_radius must be >= 0 m and at most half of thickness and width ({most:g} m), "
                f"got {radius}"
            )
        if radius > 0.0 and math.isinf(self.width):
            raise ValueError(f"edge_radius must be 0 m for a wall of infinite width, got {radius}")
        if radius > 0.0 and self.segments > 1:
            raise ValueError(f"edge_radius must be 0 m for a wall of several segments, got {radius}")

    @property
    def element_names(self) -> tuple[str, ...]:
        """``wall``, or its segments from low y to high y."""
        return _numbered("wall", "segment", self.segments)


@dataclass(frozen=True)
class Pole(Barrier):
    """One rigid, upright cylinder, taller than any vehicle; the barrier's line runs through its axis."""

    diameter: float = 0.3

    def elements(self) -> list[_core.Element]:
        """Return the pole."""
        _finite("diameter", self.diameter)
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


@dataclass(frozen=True)
class Bollards(Barrier):
    """Rigid bollards in rows.

    A bollard draws in the skin beside it, see :meth:`birm3d.Vehicle.with_dent_reach`.
    """

    count: int = 5
    diameter: float = 0.32
    height: float = 1.0
    spacing: float = 1.2
    rows: int = 1
    row_spacing: float = 1.2
    row_offset: float = 0.0

    _counts: ClassVar = ("count", "rows")

    def elements(self) -> list[_core.Element]:
        """Return the bollards, row by row from the front, each from low y to high y."""
        if self.count * self.rows > MOST_ELEMENTS:
            raise ValueError(
                f"count must make at most {MOST_ELEMENTS:,} bollards with {self.rows} rows, got {self.count}"
            )
        _finite("diameter", self.diameter)
        _positive("height", self.height)
        for name, number in (("spacing", self.count), ("row_spacing", self.rows)):
            value = getattr(self, name)
            if number > 1 and not (math.isfinite(value) and value > self.diameter):
                raise ValueError(
                    f"{name} must be finite and above the diameter ({self.diameter:g} m), got {value}"
                )
        if not math.isfinite(self.row_offset):
            raise ValueError(f"row_offset must be finite, got {self.row_offset}")
        return [
            _core.Element.post(
                radius=0.5 * self.diameter,
                height=self.height,
                position=self.from_origin(across, along),
                heading=math.radians(self.heading),
            )
            for across, along in self.places()
        ]

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
            return _numbered("bollard", "bollard", self.count)
        return tuple(f"row {r + 1}, bollard {i + 1}" for r in range(self.rows) for i in range(self.count))


# Half widths and heights of concrete barriers [in] with the slope of the upper face [deg]: 3 in vertical,
# 55 deg to the break, 84 deg above (FHWA; the break is at 13 in for New Jersey, at 10 in for the F-shape);
# Texas single slope 10.8 deg from the vertical, base 24 in.
_INCH = 0.0254
PROFILES = MappingProxyType(
    {
        "new_jersey": ((12.0, 0.0), (12.0, 3.0), (12.0 - 10.0 / math.tan(math.radians(55.0)), 13.0)),
        "f_shape": ((12.0, 0.0), (12.0, 3.0), (12.0 - 7.0 / math.tan(math.radians(55.0)), 10.0)),
        "single_slope": ((12.0, 0.0),),
    }
)
"""Lower points (half width, height) of the named profiles [in]; the upper face follows."""
_UPPER_SLOPE = {"new_jersey": 84.0, "f_shape": 84.0, "single_slope": 90.0 - 10.8}
_USUAL_HEIGHT = {"new_jersey": 32.0, "f_shape": 32.0, "single_slope": 42.0}


@dataclass(frozen=True)
class Jersey(Barrier):
    """A concrete barrier with sloped faces, the same on both sides; its line is the traffic face's foot."""

    profile: str | tuple[tuple[float, float], ...] = "new_jersey"
    height: float | None = None
    length: float = math.inf
    segments: int = 1
    free_standing: FreeStanding | None = None

    _counts: ClassVar = ("segments",)

    def half_profile(self) -> Floats:
        """Return half width and height of the face's corners from the foot to the top, shape (n, 2) [m]."""
        if not isinstance(self.profile, str):
            if self.height is not None:
                raise ValueError(f"height must be None for a profile of points, got {self.height}")
            points = np.array(self.profile, float)
            if points.ndim != 2 or points.shape[1] != 2 or len(points) < 2:
                raise ValueError(f"profile must have shape (n, 2) with n >= 2, got {points.shape}")
            if not np.isfinite(points).all():
                raise ValueError(f"profile must be finite, got {points.tolist()}")
            rises = points[0, 1] == 0.0 and (np.diff(points[:, 1]) > 0.0).all()
            if not (rises and (points[:, 0] > 0.0).all()):
                raise ValueError(
                    f"profile must begin at height 0, rise, and have half widths > 0, got {points.tolist()}"
                )
            return points
        if self.profile not in PROFILES:
            raise ValueError(f"profile must be one of {', '.join(PROFILES)}, or points; got {self.profile!r}")
        lower = np.array(PROFILES[self.profile]) * _INCH
        top = _USUAL_HEIGHT[self.profile] * _INCH if self.height is None else self.height
        slope = math.tan(math.radians(_UPPER_SLOPE[self.profile]))
        half, height = lower[-1]
        highest = height + half * slope
        if not height < top < highest:
            raise ValueError(f"height must be above {height:.3f} and below {highest:.3f} m, got {top}")
        return np.vstack([lower, [half - (top - height) / slope, top]])

    def elements(self) -> list[_core.Element]:
        """Return the segments, from low y to high y."""
        _positive("length", self.length)
        if math.isinf(self.length) and self.segments > 1:
            raise ValueError(f"segments must be 1 for a barrier of infinite length, got {self.segments}")
        half = self.half_profile()
        base = half[0, 0]
        left = half[::-1] * [-1.0, 1.0]
        corners = np.vstack([[-base, -_FOOT], [base, -_FOOT], half, left])
        # Segments that turn open gaps, into which their ends look.
        fixed = self.free_standing is None
        return _along_line(self, corners, base, self.length, self.segments, abutting=fixed)

    @property
    def is_pinned(self) -> bool:
        """Whether it has free-standing segments that are pinned to each other."""
        return self.free_standing is not None and self.free_standing.joint == "pinned"

    def stands_free(self) -> _core.FreeStanding | None:
        """Return how its segments stand free, for the core; ``None`` where they are fixed."""
        if self.free_standing is None:
            return None
        if math.isinf(self.length):
            raise ValueError(f"length must be finite where the barrier is free-standing, got {self.length}")
        if self.origin[2] != 0.0:
            raise ValueError(f"origin must be on the ground (z = 0 m) where free-standing, got {self.origin}")
        half, level = self.half_profile().T
        return self.free_standing.core(2.0 * float(np.trapezoid(half, level)))

    @property
    def element_names(self) -> tuple[str, ...]:
        """``barrier``, or its segments from low y to high y."""
        return _numbered("barrier", "segment", self.segments)


@dataclass(frozen=True, eq=False)
class MeshBarrier(Barrier):
    """A barrier of triangles that close a solid; it may be open where it stands on the ground."""

    vertices: Floats = field(default_factory=lambda: np.empty((0, 3)))
    faces: npt.NDArray[np.int64] = field(default_factory=lambda: np.empty((0, 3), np.int64))

    def __post_init__(self) -> None:
        if self.vertices.ndim != 2 or self.vertices.shape[1] != 3:
            raise ValueError(f"vertices must have shape (n, 3), got {self.vertices.shape}")
        if self.faces.ndim != 2 or self.faces.shape[1] != 3:
            raise ValueError(f"faces must have shape (m, 3), got {self.faces.shape}")
        if not np.issubdtype(self.faces.dtype, np.integer):
            raise ValueError(f"faces must be whole numbers, got {self.faces.dtype}")
        object.__setattr__(self, "faces", self.faces.astype(np.int64))
        for array in (self.vertices, self.faces):
            array.setflags(write=False)
        super().__post_init__()
        check_closed(self.vertices, self.faces, ground=1e-9 - self.origin[2])
        volume = self._volume()
        if volume < 0.0:
            raise ValueError(
                f"faces must be counter-clockwise seen from outside, around > 0 m^3, got {volume:.4g}"
            )

    def _volume(self) -> float:
        """Volume that the surface encloses [m^3], negative if it is inside out."""
        # From a point in the plane of the foot, which adds nothing where it is open.
        below = np.array([*self.vertices[0, :2], self.vertices[:, 2].min()])
        a, b, c = (self.vertices[self.faces[:, i]] - below for i in range(3))
        return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)

    @cached_property
    def parts(self) -> tuple[Floats, ...]:
        """Vertices of each part that stands by itself, shape (k, 3) [m]; parts that touch are one.

        Triangles belong together where they share a corner's place, and parts where the boxes around them
        meet, seen from above.
        """
        from scipy.sparse import coo_array
        from scipy.sparse.csgraph import connected_components

        places, which = np.unique(self.vertices, axis=0, return_inverse=True)
        faces = which.reshape(-1)[self.faces]
        ends = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]]]).T
        graph = coo_array((np.ones(ends.shape[1], bool), (ends[0], ends[1])), shape=(len(places),) * 2)
        _, label = connected_components(graph, directed=False)
        of_face = np.unique(label[faces[:, 0]])
        parts = [places[label == k] for k in of_face]
        low, high = (np.array([end(part[:, :2], axis=0) for part in parts]) for end in (np.min, np.max))
        meet = ((low[:, None] <= high) & (low <= high[:, None])).all(axis=2)
        _, group = connected_components(meet, directed=False)
        joined: dict[int, list[Floats]] = {}
        for part, k in zip(parts, group.tolist(), strict=True):
            joined.setdefault(k, []).append(part)
        return tuple(np.concatenate(those) for those in joined.values())

    def elements(self) -> list[_core.Element]:
        """Return the mesh."""
        return [
            _core.Element.mesh(
                vertices=self.vertices,
                faces=self.faces.tolist(),
                position=self.from_origin(0.0, 0.0),
                heading=math.radians(self.heading),
            )
        ]

    @property
    def element_names(self) -> tuple[str, ...]:
        """``mesh``."""
        return ("mesh",)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, MeshBarrier):
            return NotImplemented
        return (
            (self.friction, self.origin, self.heading) == (other.friction, other.origin, other.heading)
            and np.array_equal(self.vertices, other.vertices)
            and np.array_equal(self.faces, other.faces)
        )

    def __hash__(self) -> int:
        return hash((self.friction, self.origin, self.heading, self.vertices.tobytes()))

    def __repr__(self) -> str:
        return f"MeshBarrier({len(self.vertices)} vertices, {len(self.faces)} faces)"


def _along_line(
    barrier: Barrier, corners: Floats, across: float, length: float, segments: int, *, abutting: bool = True
) -> list[_core.Element]:
    """Extrude a profile along the line. Abutting ends are no surface."""
    ends = [-math.inf, math.inf] if math.isinf(length) else np.linspace(-0.5, 0.5, segments + 1) * length
    elements = []
    for i in range(segments):
        low, high = float(ends[i]), float(ends[i + 1])
        middle = 0.5 * (low + high) if math.isfinite(low) else 0.0
        elements.append(
            _core.Element.prism(
                profile=corners,
                y_low=low - middle,
                y_high=high - middle,
                covered_low_end=abutting and i > 0,
                covered_high_end=abutting and i < segments - 1,
                position=barrier.from_origin(across, middle),
                heading=math.radians(barrier.heading),
            )
        )
    return elements


def drawn_up(outline: Floats, low: float, high: float) -> tuple[Floats, npt.NDArray[np.int64]]:
    """Return vertices and triangles of a solid with a convex plan (n, 2), counter-clockwise from above."""
    n = len(outline)
    i = np.arange(n)
    j = (i + 1) % n
    fan = np.arange(1, n - 1)
    first = np.zeros_like(fan)
    faces = [
        np.stack([i, j, j + n], axis=1),
        np.stack([i, j + n, i + n], axis=1),
        np.stack([first, fan + 1, fan], axis=1),
        np.stack([first + n, fan + n, fan + 1 + n], axis=1),
    ]
    vertices = np.vstack([np.column_stack([outline, np.full(n, z)]) for z in (low, high)])
    return vertices, np.vstack(faces).astype(np.int64)


def _numbered(whole: str, part: str, count: int) -> tuple[str, ...]:
    return (whole,) if count == 1 else tuple(f"{part} {i + 1}" for i in range(count))
