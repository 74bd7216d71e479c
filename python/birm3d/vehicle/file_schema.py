"""Blocks of a vehicle file: what may stand in it, and the limits of every number.

SI, file axes: x forward, y left, z up, origin on the ground below the middle of the front axle.
"""

# Longer than 300 lines: the blocks of one file format, which refer to each other.
from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import cached_property
from itertools import pairwise
from typing import Annotated, Literal, TypeAlias

from pydantic import AfterValidator, Field, model_validator

from ..io.toml import Strict, reject
from .class_scatter import STIFFNESSES, Z_80, ScatterName
from .scaling import SIZES, Extent, Factors, PlaceMap, Scaling, factors_of, scaling_between
from .skin_mesh import SkinMesh
from .zone_law import OF_WHEELS, NonNegative, Positive, ZoneLaw

__all__ = [
    "Assumption",
    "Block",
    "CoreBox",
    "Dimensions",
    "End",
    "Exterior",
    "Indentation",
    "Kind",
    "Name",
    "NamedPoint",
    "Overhang",
    "Panel",
    "Point",
    "Positive",
    "Range",
    "Scaled",
    "Scatter",
    "Solid",
    "Source",
    "Target",
    "Text",
    "Upper",
    "Wheel",
    "Zone",
    "check_known",
    "check_unique",
]

Point: TypeAlias = tuple[float, float, float]
Range: TypeAlias = tuple[float, float]
Name: TypeAlias = Annotated[str, Field(pattern=r"^[a-z][a-z0-9_]*$")]
LawName: TypeAlias = Annotated[str, Field(pattern=r"^[a-z][a-z0-9_]*(\.(along|across))?$")]
Panel: TypeAlias = Literal["front", "rear", "side", "top", "bottom", "tire"]
# Text that may be broken over several lines of the file.
Text: TypeAlias = Annotated[str, Field(min_length=1), AfterValidator(lambda text: " ".join(text.split()))]
# How far a number can be trusted; docs/pages/how-to/vehicle.md says what each word means.
Status: TypeAlias = Literal["measured", "published", "calibrated", "estimated"]
# What standards of testing tell apart; a cab-over truck has its cab above the front axle.
Kind: TypeAlias = Literal[
    "car",
    "minivan",
    "pickup",
    "van",
    "bus",
    "truck",
    "cab_over_truck",
    "tractor",
    "semi_trailer",
    "test_body",
]

# Relative slack of comparisons that decimal numbers typed by hand can miss by rounding only.
_ROUNDING = 1e-9
# A face of a solid counts as plane (paper §4.2) when its fourth corner is within this share of its size.
_PLANE = 1e-6
# Fig. 4: an 8-node solid as six tetrahedra around the diagonal 0-6.
_TETRAHEDRA = ((0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6))
_FACES = ((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))


def _check_order(key: str, values: Sequence[float], rule: str, sign: float = 1.0) -> None:
    """Require values that increase (sign 1) or decrease (sign -1)."""
    for a, b in pairwise(values):
        if not sign * a < sign * b:
            reject(key, f"{rule}, got {a:g} followed by {b:g}")


def check_slide(rows: Sequence[tuple[float, float]]) -> None:
    """Require slips that increase from 0, in rows of slip and force under the key slide_m_N."""
    if rows[0][0] != 0.0:
        reject("slide_m_N", f"must start at a slip of 0, got {rows[0][0]}")
    _check_order("slide_m_N", [slip for slip, _ in rows], "slips must increase")


def check_unique(key: str, names: list[str]) -> None:
    """Require names that differ."""
    for i, name in enumerate(names):
        if name in names[:i]:
            reject(key, f"names must differ, got '{name}' twice")


def check_known(key: str, names: tuple[str, ...], known: set[str]) -> None:
    """Require every name to be a known one."""
    for name in names:
        if name not in known:
            reject(key, f"must be one of {', '.join(sorted(known))}; got '{name}'")


def _minus(a: Point, b: Point) -> Point:
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def _triple(a: Point, b: Point, c: Point) -> float:
    """Return a . (b x c)."""
    return (
        a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
    )


class Block(Strict):
    """A block of numbers with the sources they come from."""

    source: Annotated[tuple[str, ...], Field(min_length=1)]
    status: Status


class Source(Strict):
    """One source of numbers: where it is published and how far it can be trusted."""

    id: Annotated[str, Field(min_length=1)]
    text: Text
    status: Status


class Dimensions(Block):
    """Overall dimensions in m, for information and for checking the exterior."""

    length_m: Positive
    width_m: Positive
    height_m: Positive
    wheelbase_m: Positive
    front_overhang_m: Positive


class Target(Block):
    """A measured or estimated mass property that the solids have to meet; it is checked, never used."""

    quantity: Literal[
        "mass_kg", "cg_behind_front_axle_m", "cg_height_m", "Ixx_kg_m2", "Iyy_kg_m2", "Izz_kg_m2"
    ]
    at_gvw_kg: Positive
    value: float
    tolerance: Positive


class Solid(Block):
    """An 8-node solid of uniform density: a box, or eight corners.

    Corners in m, file axes: 0-3 counter-clockwise seen from above, 4-7 above them. Faces are plane.

    payload: what is loaded; a change of weight goes there first. fills_to_m: the payload is a box of goods on
    a floor. It keeps its density and grows upwards with its mass, to this height at most.
    """

    name: Name
    box_m: tuple[Range, Range, Range] | None = None
    corners_m: Annotated[tuple[Point, ...], Field(min_length=8, max_length=8)] | None = None
    mass_kg: Positive | None = None
    density_kg_per_m3: Positive | None = None
    payload: bool = False
    fills_to_m: Positive | None = None

    @model_validator(mode="after")
    def _check(self) -> Solid:
        if (self.box_m is None) == (self.corners_m is None):
            reject("name", f"solid '{self.name}' must have either box_m or corners_m")
        if (self.mass_kg is None) == (self.density_kg_per_m3 is None):
            reject("name", f"solid '{self.name}' must have either mass_kg or density_kg_per_m3")
        for low, high in self.box_m or ():
            if not low < high:
                reject("box_m", f"each range must be increasing, got [{low}, {high}]")
        if self.fills_to_m is not None:
            if not (self.payload and self.box_m is not None):
                reject("fills_to_m", f"solid '{self.name}' must be payload with box_m to fill a space")
            if not self.fills_to_m >= self.box_m[2][1]:
                message = f"must be at least the top of box_m, {self.box_m[2][1]}, got {self.fills_to_m}"
                reject("fills_to_m", message)
        self._check_shape()
        return self

    def _check_shape(self) -> None:
        corners = self.corners
        for face in _FACES:
            a, b, c, d = (corners[i] for i in face)
            u, v, w = _minus(b, a), _minus(c, a), _minus(d, a)
            size = max(abs(x) for x in (*u, *v, *w))
            if abs(_triple(u, v, w)) > _PLANE * size**3:
                reject("corners_m", f"corners {face} must lie in one plane")
        for i, j, k, m in _TETRAHEDRA:
            o = corners[i]
            if _triple(*(_minus(corners[n], o) for n in (j, k, m))) <= 0.0:
                message = "corners must go counter-clockwise seen from above, upper four last, and be convex"
                reject("corners_m", f"{message}; the part {i}, {j}, {k}, {m} has no positive volume")

    @cached_property
    def corners(self) -> tuple[Point, ...]:
        """Eight corners in m, file axes."""
        if self.corners_m is not None:
            return self.corners_m
        assert self.box_m is not None  # one of the two is given, see _check
        (x0, x1), (y0, y1), (z0, z1) = self.box_m
        base = ((x0, y0), (x1, y0), (x1, y1), (x0, y1))
        return tuple((x, y, z) for z in (z0, z1) for x, y in base)

    @cached_property
    def volume(self) -> float:
        """Volume in m^3 (Eq. 3, six tetrahedra)."""
        total = 0.0
        for i, j, k, m in _TETRAHEDRA:
            o = self.corners[i]
            total += _triple(*(_minus(self.corners[n], o) for n in (j, k, m))) / 6.0
        return total

    @property
    def density(self) -> float:
        """Density in kg/m^3."""
        if self.density_kg_per_m3 is not None:
            return self.density_kg_per_m3
        return self.mass / self.volume

    @property
    def mass(self) -> float:
        """Mass in kg."""
        if self.mass_kg is not None:
            return self.mass_kg
        assert self.density_kg_per_m3 is not None  # one of the two is given, see _check
        return self.density_kg_per_m3 * self.volume


class Wheel(Block):
    """A wheel: centre in m (file axes), rolling radius and width in m. It stands on the ground at rest."""

    name: Name
    center_m: Point
    radius_m: Positive
    width_m: Positive

    @model_validator(mode="after")
    def _check(self) -> Wheel:
        if abs(self.center_m[2] - self.radius_m) > 1e-6:
            reject("center_m", f"height must equal radius_m = {self.radius_m}, got {self.center_m[2]}")
        return self


class End(Strict):
    """Plan and side shape of the front or rear end of the body.

    bow_m: how much further back the corners are than the centre line, a parabola in y.
    profile_m: setback over height, rows [z, setback]; setback 0 is the outermost line.
    blend_m: length over which both fade out along the body.
    depth_m: of the structure before the compartment or the load; deflections are scaled with it. Without it,
    up to the rigid core.
    """

    bow_m: NonNegative = 0.0
    profile_m: tuple[tuple[float, NonNegative], ...] = ()
    blend_m: Positive = 1.0
    depth_m: Positive | None = None

    @model_validator(mode="after")
    def _check(self) -> End:
        _check_order("profile_m", [row[0] for row in self.profile_m], "z must increase")
        setback = self.bow_m + max((row[1] for row in self.profile_m), default=0.0)
        if setback > 0.75 * self.blend_m:  # columns of the mesh would fold over each other
            limit = setback / 0.75
            reject("blend_m", f"must be at least {limit:g}, (bow + profile) / 0.75, got {self.blend_m}")
        return self


# At mesh density 1; the presets have 6,000.
_MOST_ELEMENTS = 300_000


class Upper(Strict):
    """A block standing on the body: greenhouse, cab, cargo box.

    base_x_m: front and rear end of its base on the body's upper edge.
    roof_m: rows [x, half width, z] from front to rear.
    """

    name: Name
    base_x_m: Range
    roof_m: Annotated[tuple[tuple[float, Positive, Positive], ...], Field(min_length=2)]

    @model_validator(mode="after")
    def _check(self) -> Upper:
        if not self.base_x_m[0] > self.base_x_m[1]:
            reject("base_x_m", f"must go from front to rear (falling x), got {list(self.base_x_m)}")
        _check_order("roof_m", [row[0] for row in self.roof_m], "x must fall from front to rear", -1.0)
        return self


class Exterior(Block):
    """The exterior shell: a body lofted through stations, with upper blocks on it.

    element_size_m: edge length of a shell element at mesh density 1.
    stations_m: rows [x, half width, z of underside, z of upper edge] from front to rear.
    mesh: the skin as triangles. Stations and roofs are then the outline of the vehicle that it was placed by:
    elements follow the mesh alone.
    """

    element_size_m: Annotated[float, Field(ge=0.01, le=1.0)]
    stations_m: Annotated[tuple[tuple[float, Positive, NonNegative, Positive], ...], Field(min_length=2)]
    front: End = End()
    rear: End = End()
    upper: tuple[Upper, ...] = ()
    mesh: SkinMesh | None = None

    @model_validator(mode="after")
    def _check(self) -> Exterior:
        x = [row[0] for row in self.stations_m]
        _check_order("stations_m", x, "x must fall from front to rear", -1.0)
        for i, (_, _, bottom, top) in enumerate(self.stations_m):
            if not bottom < top:
                reject(f"stations_m.{i}", f"underside must be below upper edge, got {bottom} and {top}")
        self._check_size()
        limit = x[0]
        for i, upper in enumerate(self.upper):
            front, rear = upper.base_x_m
            if not (front <= limit and rear >= x[-1]):
                key = f"upper.{i}.base_x_m"
                reject(key, f"must lie on the body, between {limit} and {x[-1]}, got [{front}, {rear}]")
            limit = rear
        check_unique("upper", [upper.name for upper in self.upper])
        if any(upper.name == "body" for upper in self.upper):
            reject("upper", "the name 'body' is taken by the lofted body itself")
        if self.mesh is not None:
            check_known("mesh.triangles", tuple(sorted(set(self.mesh.rows[:, 4].tolist()))), set(self.blocks))
        return self

    @property
    def blocks(self) -> tuple[str, ...]:
        """Names of body and upper blocks."""
        return ("body", *(upper.name for upper in self.upper))

    def _check_size(self) -> None:
        rows = [*self.stations_m, *((x, half, 0.0, z) for upper in self.upper for x, half, z in upper.roof_m)]
        length = max(row[0] for row in rows) - min(row[0] for row in rows)
        width, height = 2.0 * max(row[1] for row in rows), max(row[3] for row in rows)
        count = 2.0 * (length * width + width * height + height * length) / self.element_size_m**2
        if not count <= _MOST_ELEMENTS:
            limit = f"for at most {_MOST_ELEMENTS:,} elements"
            box = f"{length:g} m by {width:g} m by {height:g} m"
            reject("element_size_m", f"must be {limit}, got {self.element_size_m} on a box of {box}")


class Scatter(Block):
    """How vehicles of the class differ from this one, see :class:`birm3d.vehicle.class_scatter.ClassScatter`.

    Of forces (front, side, corner, tires) and of springs the zones say which ones; of the other quantities
    there are none.
    """

    name: ScatterName
    zones: tuple[LawName, ...] = ()
    median: Positive = 1.0
    log_sd: Annotated[float, Field(gt=0.0, le=2.0)]

    @model_validator(mode="after")
    def _check(self) -> Scatter:
        if bool(self.zones) is not (self.name in STIFFNESSES):
            must = "must name zones" if self.name in STIFFNESSES else "must not be given"
            reject("zones", f"{must} for {self.name}, got {', '.join(self.zones) or 'none'}")
        return self


class Assumption(Strict):
    """What was assumed of a vehicle of which some facts are known, see :meth:`birm3d.Vehicle.from_facts`.

    low, high: band of 80 %; without a value the assumption is the text alone.
    """

    quantity: Annotated[str, Field(min_length=1)]
    text: Text
    value: float | None = None
    low: float | None = None
    high: float | None = None
    unit: str = ""

    @property
    def name(self) -> str:
        """What scene parameters and :class:`Scatter` call the quantity, as "yaw_inertia"."""
        _, inertia, axis = self.quantity.partition("inertia in ")
        return f"{axis}_inertia" if inertia else self.quantity

    @property
    def log_sd(self) -> float | None:
        """Standard deviation of the logarithm that the band says; ``None``: it has no band."""
        if self.low is None or self.high is None:
            return None
        return round(math.log(self.high / self.low) / (2.0 * Z_80), 9)

    def __str__(self) -> str:
        return self.text


class Scaled(Block):
    """Mass and size that the vehicle extended is scaled to, before the file's own blocks replace its blocks.

    The numbers are those of :meth:`birm3d.Vehicle.scaled_to`. In place of length_m and wheelbase_m, x_m may
    have rows [place of the vehicle extended, place here]. So may z_m in place of height_m. Places between are
    interpolated. Zones hold at mass_kg; solids weigh solids_kg where that is given. element_size_m: of the
    shell, see Exterior. without: what is left out of the vehicle extended. It has names of solids, wheels,
    points and core boxes, and of zones as "zone.hood". Solids, wheels, points and core boxes of the file take
    the place of those of the same name, others are added.
    """

    mass_kg: Positive
    solids_kg: Positive | None = None
    length_m: Positive | None = None
    width_m: Positive | None = None
    height_m: Positive | None = None
    wheelbase_m: Positive | None = None
    x_m: Annotated[tuple[Range, ...], Field(min_length=2)] | None = None
    z_m: Annotated[tuple[Range, ...], Field(min_length=2)] | None = None
    element_size_m: Annotated[float, Field(ge=0.01, le=1.0)] | None = None
    without: tuple[Annotated[str, Field(pattern=r"^(zone\.)?[a-z][a-z0-9_]*$")], ...] = ()

    @model_validator(mode="after")
    def _check(self) -> Scaled:
        for key, others in (("x_m", ("length_m", "wheelbase_m")), ("z_m", ("height_m",))):
            rows = getattr(self, key)
            if rows is None:
                continue
            for other in others:
                if getattr(self, other) is not None:
                    reject(other, f"must not be given together with {key}, got {getattr(self, other)}")
            for column in (0, 1):
                _check_order(key, [row[column] for row in rows], "places must increase")
        return self

    def scaling_of(self, extent: Extent, name: str) -> Scaling:
        """Return where places of the vehicle extended go."""
        wanted = {size: getattr(self, f"{size}_m") for size in SIZES}
        scaling = scaling_between(extent, factors_of(wanted, extent.sizes, name))
        x = scaling.x if self.x_m is None else _map(self.x_m)
        return Scaling(x, scaling.y, scaling.z if self.z_m is None else _map(self.z_m))


def _map(rows: tuple[Range, ...]) -> PlaceMap:
    return PlaceMap(tuple(row[0] for row in rows), tuple(row[1] for row in rows))


class NamedPoint(Block):
    """A point of the rigid body that sensors and standards ask for by name; m, file axes.

    Usual names: "a_pillar_base", "load_bed_leading_edge" (its lower leading edge, at the outer end),
    "driver_head". "mass_center" follows from the solids and can not be given.
    """

    name: Name
    at_m: Point

    @model_validator(mode="after")
    def _check(self) -> NamedPoint:
        if self.name == "mass_center":
            reject("name", "must be another one: the mass centre follows from the solids, got 'mass_center'")
        return self


class Indentation(Block):
    """How a post or a wall's edge draws in the skin beside itself.

    length_m: see :meth:`birm3d.Vehicle.with_indentation_length`. edge_flank_factor: see
    :attr:`birm3d.simulation.Scene.edge_flank_factor`.
    """

    length_m: Positive
    edge_flank_factor: Annotated[float, Field(ge=0.0)] | None = None


class Overhang(Block):
    """What reaches out over the frame, as the floor of a cargo box: behind it the body is stepped.

    Within x_m, and further than beyond_y_m from the middle plane, z_m is the height of the underside in place
    of the stations'. A low barrier passes below it, or it bears on the barrier's top.
    """

    x_m: Range
    beyond_y_m: Positive
    z_m: Positive

    @model_validator(mode="after")
    def _check(self) -> Overhang:
        _check_order("x_m", self.x_m, "must increase")
        return self


class CoreBox(Block):
    """A box of the rigid core, symmetric about y = 0; trusses run from it to the exterior.

    gives_way: the box itself is no obstacle. Walls meet the inner ends of its trusses. Posts meet them once a
    truss has at most 10 % of its depth left. Such a box is no part of the rigid body whose overlap with the
    barrier is measured.
    """

    name: Name
    x_m: Range
    half_width_m: Positive
    z_m: Range
    gives_way: bool = False

    @model_validator(mode="after")
    def _check(self) -> CoreBox:
        _check_order("x_m", self.x_m, "must increase")
        _check_order("z_m", self.z_m, "must increase")
        return self


class Bed(Block):
    """Load bed that can slide along the frame, see :meth:`birm3d.Vehicle.with_sliding_bed`.

    solids, points: names of those that go with the bed, its load included. block: upper block that is its
    skin. underside: zone whose law the bed's underside has. slide_m_N: rows of slip and greatest holding
    force. core: core boxes of the bed; if there are none, the boxes that the zones of `block` name.
    """

    solids: Annotated[tuple[Name, ...], Field(min_length=1)]
    points: tuple[Name, ...] = ()
    block: Name
    underside: Name
    slide_m_N: Annotated[  # noqa: N815 - units in the key
        tuple[tuple[NonNegative, NonNegative], ...], Field(min_length=1)
    ]
    core: tuple[CoreBox, ...] = ()

    @model_validator(mode="after")
    def _check(self) -> Bed:
        check_slide(self.slide_m_N)
        return self


class SecondLaw(Block, ZoneLaw):
    """What a panel resists along or across the vehicle, beside its own law, per unit of the panel's area."""

    @model_validator(mode="after")
    def _check(self) -> SecondLaw:
        self.require_law()
        return self


class Zone(Block, ZoneLaw):
    """Stiffness of the exterior per unit of area, and the part of the exterior it holds for.

    The part: panels, and optionally blocks ("body" or the name of an upper block). Ranges of x and z bound
    the element's middle (m, file axes), a range of y its distance from the vehicle's middle plane. Zones are
    tried in the order of the file; the first match wins. Trusses start from the nearest point of the named
    core boxes, or of all.

    The panel "tire", alone in its zone, is the treads of the wheels: ranges are of a wheel's middle, and the
    area is the tread's. Without such a zone tyres meet the ground only.

    The law: see ZoneLaw. A second one, ``along``, is what a panel that does not look forward or backward
    resists along the vehicle; another, ``across``, what a side resists across it
    (:mod:`birm3d.vehicle.second_trusses`).
    """

    name: Name
    panels: Annotated[tuple[Panel, ...], Field(min_length=1)]
    blocks: tuple[Name, ...] = ()
    x_m: Range | None = None
    y_m: Range | None = None
    z_m: Range | None = None
    core: tuple[Name, ...] = ()
    along: SecondLaw | None = None
    across: SecondLaw | None = None

    @model_validator(mode="after")
    def _check(self) -> Zone:
        if self.along is not None and (other := set(self.panels) - {"side", "top", "bottom"}):
            reject("along", f"must be in a zone of the panels side, top and bottom, got {min(other)}")
        if self.across is not None and "side" not in self.panels:
            reject("across", f"must be in a zone of the panel side, got {', '.join(self.panels)}")
        if "tire" in self.panels:
            for key, value in (("blocks", self.blocks), ("core", self.core), ("panels", self.panels[1:])):
                if value:
                    reject(key, f"must not go with the panel 'tire', got {', '.join(value)}")
        self._check_tire_numbers()
        if self.y_m is not None and self.y_m[0] < 0.0:
            reject("y_m", f"must be a range of distances >= 0 from the middle plane, got {list(self.y_m)}")
        for key, limits in (("x_m", self.x_m), ("y_m", self.y_m), ("z_m", self.z_m)):
            if limits is not None:
                _check_order(key, limits, "must increase")
        self._check_law()
        self.require_law()
        return self

    def _check_tire_numbers(self) -> None:
        tires = "tire" in self.panels
        for key in OF_WHEELS:
            value = getattr(self, key)
            if not tires and value is not None:
                reject(key, f"must be in a zone of the panel 'tire', got {value:g}")
        for key, number in (("friction_share", self.friction_share), ("springback_m", self.springback_m)):
            if tires and number is not None:
                reject(key, f"must not go with the panel 'tire', got {number:g}")

    def _check_law(self) -> None:
        segments = {
            "k_initial_Pa_per_m": self.k_initial_Pa_per_m,
            "knee_m": self.knee_m,
            "k_hardening_Pa_per_m": self.k_hardening_Pa_per_m,
            "f_max_Pa": self.f_max_Pa,
        }
        if self.envelope_m_Pa is not None:
            for key, value in segments.items():
                if value is not None:
                    reject(key, f"must not be given together with envelope_m_Pa, got {value:g}")
            if self.envelope_m_Pa[0] != (0.0, 0.0):
                reject("envelope_m_Pa", f"must start at [0, 0], got {list(self.envelope_m_Pa[0])}")
            _check_order("envelope_m_Pa", [row[0] for row in self.envelope_m_Pa], "deflections must increase")
            return
        for key, value in segments.items():
            if value is None:
                reject(key, f"{key} is missing: give all of {', '.join(segments)}, or envelope_m_Pa")
        assert self.k_initial_Pa_per_m is not None
        assert self.knee_m is not None
        assert self.f_max_Pa is not None
        at_knee = self.k_initial_Pa_per_m * self.knee_m
        if self.f_max_Pa < at_knee * (1.0 - _ROUNDING):
            message = f"must be at least the stress at the knee, {at_knee:g}, got {self.f_max_Pa:g}"
            reject("f_max_Pa", message)

    def scaled(self, factors: Mapping[str, Factors]) -> Zone:
        """Return the zone with stresses and deflections times the factors of each law, by the laws' names."""
        changes = ZoneLaw.numbers_of(self.law.scaled(*factors[self.name]))
        for name, second in self.second_laws.items():
            numbers = ZoneLaw.numbers_of(second.law.scaled(*factors[name]))
            changes[name.removeprefix(f"{self.name}.")] = second.changed(numbers)
        return self.changed(changes)

    @property
    def second_laws(self) -> dict[str, SecondLaw]:
        """Laws along and across the vehicle, where given, by their names: ``door.along``."""
        laws = {self.along_name: self.along, self.across_name: self.across}
        return {name: law for name, law in laws.items() if law is not None}

    @property
    def along_name(self) -> str:
        """Name of the law along the vehicle."""
        return f"{self.name}.along"

    @property
    def across_name(self) -> str:
        """Name of the law across the vehicle."""
        return f"{self.name}.across"

    @property
    def envelope(self) -> tuple[tuple[float, float], ...]:
        """Loading envelope, rows (deflection in m, stress in Pa), starting at (0, 0)."""
        points: tuple[tuple[float, float], ...] | None = self.envelope_m_Pa
        if points is not None:
            return points
        assert self.k_initial_Pa_per_m is not None
        assert self.knee_m is not None
        assert self.k_hardening_Pa_per_m is not None
        assert self.f_max_Pa is not None
        at_knee = self.k_initial_Pa_per_m * self.knee_m
        points = ((0.0, 0.0), (self.knee_m, at_knee))
        if self.k_hardening_Pa_per_m == 0.0 or self.f_max_Pa <= at_knee * (1.0 + _ROUNDING):
            return points
        crushed = self.knee_m + (self.f_max_Pa - at_knee) / self.k_hardening_Pa_per_m
        return (*points, (crushed, self.f_max_Pa))
