"""Vehicles of two rigid bodies: a tractor and its semi-trailer."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

from .. import _core
from ..base.arguments import checked
from ..unit_check import given
from ..units import Quantity, si
from .scaling import factors_of, sizes_given
from .vehicle import Vehicle
from .zone import Zone, positive

if TYPE_CHECKING:
    from .combination_file import CombinationFile

__all__ = ["ArticulatedVehicle", "Joint", "articulate"]

Floats = npt.NDArray[np.float64]
Place = tuple[float, float, float]

# Places of a joint on its two units may differ in height by this much [m]; the core's limit too.
_FIT = 1e-3


@checked
@dataclass(frozen=True)
class Joint:
    """How a trailing unit hangs on a leading one.

    Parameters
    ----------
    place_on_leading, place_on_trailing
        The joint on each unit in the axes of its own file, position of rest: x forward, y left, z above the
        ground [m]. Of a vehicle from arrays the origin is on the ground below its mass centre. The trailing
        unit stands where both places are one.
    kind
        ``"fifth_wheel"``: force in three directions; pitch and yaw are free, roll only within
        ``roll_limit``, beyond which the plates touch and carry a moment. ``"welded"``: all six are held.
    roll_limit
        Greatest relative roll of a fifth wheel to either side [deg], 0 to below 90. UN Regulation 55 speaks
        of up to 3 deg for a plate that does not oscillate; the default is an estimate within that.
    """

    place_on_leading: Place
    place_on_trailing: Place
    kind: Literal["fifth_wheel", "welded"] = "fifth_wheel"
    roll_limit: float = 2.0

    def __post_init__(self) -> None:
        for name in ("place_on_leading", "place_on_trailing"):
            place = np.asarray(getattr(self, name), float)
            if place.shape != (3,) or not np.isfinite(place).all():
                raise ValueError(f"{name} must be three finite numbers (m), got {getattr(self, name)}")
            object.__setattr__(self, name, tuple(place.tolist()))
        if self.kind not in ("fifth_wheel", "welded"):
            raise ValueError(f"kind must be 'fifth_wheel' or 'welded', got {self.kind!r}")
        if not 0.0 <= self.roll_limit < 90.0:
            raise ValueError(f"roll_limit must be >= 0 and < 90 deg, got {self.roll_limit}")
        apart = abs(self.place_on_leading[2] - self.place_on_trailing[2])
        if not apart <= _FIT:
            raise ValueError(
                f"height of the joint on the trailing unit must be that on the leading one "
                f"({self.place_on_leading[2]} m) within {_FIT} m, got {self.place_on_trailing[2]} m"
            )

    @property
    def shift(self) -> Floats:
        """From the origin of the leading unit's axes to that of the trailing one's, shape (3,) [m]."""
        return np.subtract(self.place_on_leading, self.place_on_trailing)


@checked
@dataclass(frozen=True, eq=False, repr=False)
class ArticulatedVehicle(Vehicle):
    """A vehicle of two units; make one with :meth:`Vehicle.articulated`. Immutable.

    It has all that a :class:`Vehicle` has, of the whole in the position of rest: mass, mass centre (in the
    leading unit's axes), inertia about it, nodes, anchors, quads, wheels and zones of both units, the leading
    one's first. ``units`` are the two, each with its own in its own axes; zones keep their names, which
    differ between the units.

    ``with_zone``, ``with_rate_sensitivity``, ``with_dent_reach`` and ``with_mesh_density`` go to the units
    that they concern; ``with_gvw`` loads or lightens the trailing unit; ``with_unit`` and ``with_joint``
    change a part. ``dataclasses.replace()`` changes the name only.
    """

    _units: tuple[Vehicle, ...] = ()
    _joint: Joint | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if self._own:
            raise ValueError(
                f"{', '.join(self._own)} of a vehicle of two units must be changed in its units, from which "
                f"all of it follows: by with_unit(), or another method of {self.name!r}"
            )

    @property
    def units(self) -> tuple[Vehicle, ...]:
        """The leading and the trailing unit, each a vehicle of its own."""
        return self._units

    @property
    def joint(self) -> Joint:
        """What joins the units."""
        assert self._joint is not None  # made together with the units
        return self._joint

    @cached_property
    def core(self) -> _core.Vehicle:
        """The same vehicle for the core; its reference point is the leading unit's mass centre."""
        joint = self.joint
        leading, trailing = self._units
        core_joint = _core.Joint(
            kind=_core.JointKind.__members__[joint.kind],
            leading=0,
            trailing=1,
            place_on_leading=joint.place_on_leading - leading.center_of_mass,
            place_on_trailing=joint.place_on_trailing - trailing.center_of_mass,
            roll_limit=math.radians(joint.roll_limit),
        )
        return _core.Vehicle(
            [leading._core_unit(np.zeros(3)), trailing._core_unit(self._trailing_offset())],
            [core_joint],
        )

    def _trailing_offset(self) -> Floats:
        """Return the trailing mass centre along the ground, from the leading one, shape (3,) [m]."""
        leading, trailing = self._units
        offset = trailing.center_of_mass + self.joint.shift - leading.center_of_mass
        offset[2] = 0.0
        return offset

    def _core_arguments(self) -> list[dict[str, Any]]:
        leading, trailing = self._units
        offsets = (np.zeros(3), self._trailing_offset())
        return [
            unit._arguments_of_unit(offset) for unit, offset in zip((leading, trailing), offsets, strict=True)
        ]

    def _with(self, units: Sequence[Vehicle]) -> ArticulatedVehicle:
        return articulate(units, self.joint, self.name)

    def with_unit(self, index: int, unit: Vehicle) -> ArticulatedVehicle:
        """Return the vehicle with another leading (0) or trailing (1) unit."""
        if index not in (0, 1):
            raise ValueError(f"index must be 0 (leading) or 1 (trailing), got {index}")
        units = list(self._units)
        units[index] = unit
        return self._with(units)

    def with_joint(self, joint: Joint | Literal["fifth_wheel", "welded"]) -> ArticulatedVehicle:
        """Return the vehicle with another joint, or with the present one of another kind."""
        if isinstance(joint, str):
            joint = dataclasses.replace(self.joint, kind=joint)
        return articulate(self._units, joint, self.name)

    def with_gvw(self, gvw: Quantity) -> ArticulatedVehicle:
        """Return the vehicle with another mass [kg]: the trailing unit is loaded or lightened.

        What :meth:`Vehicle.with_gvw` says holds for that unit. ``gvw`` must exceed the leading unit's mass.
        """
        return self._with_mass(self._mass_given("gvw", gvw))

    def _with_mass(self, gvw: float) -> ArticulatedVehicle:
        leading = self._units[0]
        if not gvw > leading.mass:
            raise ValueError(f"gvw must be above the leading unit's mass ({leading.mass:g} kg), got {gvw:g}")
        return self._with_trailing(lambda unit: unit._with_mass(gvw - leading.mass))

    def _with_trailing(self, change: Callable[[Vehicle], Vehicle]) -> ArticulatedVehicle:
        """Return the vehicle with a change of the trailing unit; a height that was asked for stays."""
        leading, trailing = self._units
        if any(unit._height is None for unit in self._units):
            return self._with([leading, change(trailing)])
        free = [unit.with_mass_center_height(None) if unit.has_file else unit for unit in self._units]
        return self._with([free[0], change(free[1])]).with_mass_center_height(self.mass_center_height)

    def with_payload(
        self, payload: Quantity, *, density: Quantity | None = None, height: Quantity | None = None
    ) -> ArticulatedVehicle:
        """Return the vehicle with another payload [kg]: :meth:`Vehicle.with_payload` of the trailing unit."""
        return self._with_trailing(lambda unit: unit.with_payload(payload, density=density, height=height))

    def scaled_to(
        self,
        mass: Quantity,
        *,
        length: Quantity | None = None,
        width: Quantity | None = None,
        height: Quantity | None = None,
        wheelbase: Quantity | None = None,
        mass_center_height: Quantity | None = None,
    ) -> ArticulatedVehicle:
        """Return a similar vehicle of another mass and size: :meth:`Vehicle.scaled_to` of both units.

        Masses of both go in proportion, and so do all places along it, across and upwards, those of the
        joint too; so `wheelbase` must be ``None``.
        """
        factor = self._mass_given("mass", mass) / self.mass
        if wheelbase is not None:
            raise ValueError(
                f"wheelbase must be None for {self.name!r}: it goes with the length of its two units; "
                f"got {wheelbase}"
            )
        wanted = sizes_given(length=length, width=width, height=height)
        ratio = factors_of(wanted, self._sizes, self.name)
        units = []
        for unit in self._units:
            new = {name: r * getattr(unit, name) for name, r in ratio.items()}
            units.append(unit.scaled_to(factor * unit.mass, **new))
        times = [ratio.get(name, 1.0) for name in ("length", "width", "height")]
        joint = dataclasses.replace(
            self.joint,
            place_on_leading=_product(times, self.joint.place_on_leading),
            place_on_trailing=_product(times, self.joint.place_on_trailing),
        )
        scaled = articulate(units, joint, self.name)
        return scaled if mass_center_height is None else scaled.with_mass_center_height(mass_center_height)

    def with_rate_sensitivity(self, rate_sensitivity: Quantity) -> ArticulatedVehicle:
        """Return the vehicle with :meth:`Vehicle.with_rate_sensitivity` of both units."""
        return self._with([unit.with_rate_sensitivity(rate_sensitivity) for unit in self._units])

    def with_dent_reach(self, dent_reach: Quantity) -> ArticulatedVehicle:
        """Return the vehicle with :meth:`Vehicle.with_dent_reach` of both units."""
        reach = si("dent_reach", dent_reach, "length") if self._draft else given("dent_reach", dent_reach)
        return self._with([dataclasses.replace(unit, dent_reach=reach) for unit in self._units])

    def without_tire_contact(self) -> ArticulatedVehicle:
        """Return the vehicle with :meth:`Vehicle.without_tire_contact` of both units."""
        return self._with([unit.without_tire_contact() for unit in self._units])

    def with_mesh_density(self, mesh_density: float) -> ArticulatedVehicle:
        """Return the vehicle with :meth:`Vehicle.with_mesh_density` of both units."""
        return self._with([unit.with_mesh_density(mesh_density) for unit in self._units])

    def with_mass_center_height(self, height: Quantity | None) -> ArticulatedVehicle:
        """Return the vehicle with its mass centre at another height [m].

        Both units' mass goes up or down by one ratio, see :meth:`Vehicle.with_mass_center_height`; a later
        mass or payload keeps the height of the whole.
        """
        if height is None:
            return self._with([unit.with_mass_center_height(None) for unit in self._units])
        height = positive("mass_center_height", si("mass_center_height", height, "length"))
        ratio = height / self.mass_center_height
        return self._with(
            [unit.with_mass_center_height(ratio * unit.mass_center_height) for unit in self._units]
        )

    def with_zones(self, zones: Mapping[str, Zone]) -> ArticulatedVehicle:
        """Return the vehicle with some of its zones replaced."""
        for name in zones:
            if name not in self.zones:
                raise ValueError(f"zone must be one of {', '.join(self.zones) or 'none'}; got {name!r}")
        return self._with(
            [
                unit.with_zones({name: zone for name, zone in zones.items() if name in unit.zones})
                for unit in self._units
            ]
        )

    def with_truss_law(self, **changes: float) -> Vehicle:
        """Refuse: give the unit that is meant another law, and the vehicle this unit by :meth:`with_unit`."""
        raise ValueError(f"truss law must be given to one of the units of {self.name!r}, got {changes}")

    def draft(self) -> ArticulatedVehicle:
        """Return the vehicle to be changed several times, see :meth:`Vehicle.draft`."""
        return self._with([unit.draft() for unit in self._units])

    def finished(self) -> ArticulatedVehicle:
        """Return a draft as a vehicle, checked."""
        return self._with([unit.finished() for unit in self._units])

    @property
    def truss_law(self) -> Mapping[str, float]:
        """Refused: it is asked of one of the units."""
        raise ValueError(f"truss law must be asked of one of the units, got {self.name!r} of two")

    @property
    def kind(self) -> str | None:
        """``"tractor_semitrailer"`` where its units are a tractor and a semi-trailer, else ``None``."""
        kinds = tuple(unit.kind for unit in self._units)
        return "tractor_semitrailer" if kinds == ("tractor", "semi_trailer") else None

    @property
    def points(self) -> Mapping[str, tuple[float, float, float]]:
        """Refused: each unit has points in its own axes."""
        raise ValueError(f"points must be asked of one of the units, got {self.name!r} of two")

    @property
    def has_file(self) -> bool:
        """Whether both units come from files, so that they can be meshed anew."""
        return all(unit.has_file for unit in self._units)

    @property
    def mesh_density(self) -> float:
        """Number of shell elements relative to the file of the leading unit."""
        return self._units[0].mesh_density

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Vehicle):
            return NotImplemented
        return (
            isinstance(other, ArticulatedVehicle)
            and self.name == other.name
            and self.joint == other.joint
            and all(a == b for a, b in zip(self._units, other._units, strict=True))
        )

    __hash__ = None

    def __reduce__(self) -> tuple[Any, ...]:
        return (articulate, (self._units, self.joint, self.name))

    def __repr__(self) -> str:
        leading, trailing = self._units
        return f"ArticulatedVehicle({self.name!r}, {leading!r}, {trailing!r}, {self.joint.kind})"


def _product(factors: Sequence[float], place: Place) -> Place:
    x, y, z = (factor * coordinate for factor, coordinate in zip(factors, place, strict=True))
    return (x, y, z)


def combine(units: Sequence[Vehicle], file: CombinationFile) -> ArticulatedVehicle:
    """Return the vehicle of a file of two units."""
    block = file.joint
    joint = Joint(block.place_on_leading_m, block.place_on_trailing_m, block.kind, block.roll_limit_deg)
    return articulate(units, joint, file.name)


def articulate(units: Sequence[Vehicle], joint: Joint, name: str | None) -> ArticulatedVehicle:
    """Return a vehicle of two units; see :meth:`Vehicle.articulated`."""
    if len(units) != 2:
        raise ValueError(f"units must be two, got {len(units)}")
    for i, unit in enumerate(units):
        if not isinstance(unit, Vehicle):
            raise TypeError(f"units[{i}] must be a birm3d.Vehicle, got {type(unit).__name__}")
        if len(unit.units) != 1:
            raise ValueError(f"units[{i}] must be a vehicle of one unit, got {unit.name!r} of two")
    if not isinstance(joint, Joint):
        raise TypeError(f"joint must be a birm3d.Joint, got {type(joint).__name__}")
    leading, trailing = units
    if leading._draft is not trailing._draft:
        raise ValueError("units must both be finished or both be drafts, got one of each")
    for zone in trailing.zones:
        if zone in leading.zones:
            raise ValueError(f"names of zones must differ between the units, got {zone!r} in both")

    mass = leading.mass + trailing.mass
    places = (leading.center_of_mass, trailing.center_of_mass + joint.shift)
    center = (leading.mass * places[0] + trailing.mass * places[1]) / mass
    inertia = np.zeros((3, 3))
    for unit, place in zip(units, places, strict=True):
        lever = place - center
        inertia += unit.inertia + unit.mass * (lever @ lever * np.eye(3) - np.outer(lever, lever))

    def of_both(points: str) -> Floats:
        shifted = []
        for unit, place in zip(units, places, strict=True):
            rows = getattr(unit, points).copy()
            rows[:, :3] += place - center
            shifted.append(rows)
        return np.concatenate(shifted)

    wheel_numbers = trailing.wheel_of_node + np.where(trailing.wheel_of_node >= 0, len(leading.wheels), 0)
    shell_numbers = trailing.along_of_node + np.where(trailing.along_of_node >= 0, len(leading.nodes), 0)
    zone_numbers = trailing.zone_of_node + np.where(trailing.zone_of_node >= 0, len(leading.zones), 0)
    return ArticulatedVehicle(
        name=name if name is not None else f"{leading.name} + {trailing.name}",
        mass=mass,
        center_of_mass=center,
        inertia=inertia,
        nodes=of_both("nodes"),
        anchors=of_both("anchors"),
        area=np.concatenate([leading.area, trailing.area]),
        zone_of_node=np.concatenate([leading.zone_of_node, zone_numbers]),
        wheel_of_node=np.concatenate([leading.wheel_of_node, wheel_numbers]),
        along_of_node=np.concatenate([leading.along_of_node, shell_numbers]),
        quads=np.concatenate([leading.quads, trailing.quads + len(leading.nodes)]),
        wheels=of_both("wheels"),
        mass_center_height=float(center[2]),
        zones={**leading.zones, **trailing.zones},
        rate_sensitivity=leading.rate_sensitivity,
        dent_reach=leading.dent_reach,
        _draft=leading._draft,
        _units=(leading, trailing),
        _joint=joint,
    )
