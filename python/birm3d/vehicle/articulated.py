"""Vehicles of two rigid bodies: a tractor and its semi-trailer."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from .. import _core
from ..base.arguments import checked
from .combination_recipe import CombinationRecipe, joined_center
from .core_arguments import core_unit, unit_arguments
from .joint import Joint
from .recipe import VehicleRecipe
from .vehicle import Vehicle
from .wheel_arguments import load_on_joint

__all__ = ["ArticulatedVehicle", "Joint", "articulate"]

Floats = npt.NDArray[np.float64]


@checked
@dataclass(frozen=True, eq=False, repr=False)
class ArticulatedVehicle(Vehicle):
    """A vehicle of two units; make one with :meth:`Vehicle.articulated`. Immutable.

    It has all that a :class:`Vehicle` has, of the whole in the position of rest. Mass, mass centre (in the
    leading unit's axes) and inertia about it are those of both units. So are nodes, anchors, quads, wheels
    and zones, the leading unit's first. ``units`` are the two, each with its own in its own axes; zones keep
    their names, which differ between the units.

    ``with_zone``, ``with_rate_sensitivity``, ``with_indentation_length``, ``with_mesh_density`` and
    ``without_tire_contact`` go to the units that they concern. ``with_gvw`` and ``with_payload`` load or
    lighten the trailing unit; the mass must exceed that of the leading one. ``with_mass_center_height``
    raises the mass of both by one ratio, and a later mass keeps the height of the whole. ``scaled_to``
    scales both in proportion, and the places of the joint with them, so that ``wheelbase`` must be ``None``.
    ``with_unit`` and ``with_joint`` change a part. ``dataclasses.replace()`` changes the name only.
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
    def _description(self) -> CombinationRecipe:
        leading, trailing = (unit._description for unit in self._units)
        assert isinstance(leading, VehicleRecipe)  # units are of one body, see articulate
        assert isinstance(trailing, VehicleRecipe)
        return CombinationRecipe(self.name, leading, trailing, self.joint)

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
        return _core.Vehicle([core_unit(*unit) for unit in self._placed_units()], [core_joint])

    def _placed_units(self) -> list[tuple[Vehicle, Floats, tuple[Floats, float]]]:
        """Return each unit, where its mass centre is, and what presses on it at the joint."""
        leading, trailing = self._units
        on_trailing = self.joint.place_on_trailing - trailing.center_of_mass
        load = load_on_joint(trailing, on_trailing)
        on_leading = self.joint.place_on_leading - leading.center_of_mass
        return [
            (leading, np.zeros(3), (on_leading, load)),
            (trailing, self._trailing_offset(), (on_trailing, -load)),
        ]

    def _trailing_offset(self) -> Floats:
        """Return the trailing mass centre along the ground, from the leading one, shape (3,) [m]."""
        leading, trailing = self._units
        offset = trailing.center_of_mass + self.joint.shift - leading.center_of_mass
        offset[2] = 0.0
        return offset

    def _core_arguments(self) -> list[dict[str, Any]]:
        return [unit_arguments(*unit) for unit in self._placed_units()]

    def with_unit(self, index: int, unit: Vehicle) -> ArticulatedVehicle:
        """Return the vehicle with another leading (0) or trailing (1) unit."""
        if index not in (0, 1):
            raise ValueError(f"index must be 0 (leading) or 1 (trailing), got {index}")
        units = list(self._units)
        units[index] = unit
        return articulate(units, self.joint, self.name)

    def with_joint(self, joint: Joint | Literal["fifth_wheel", "welded"]) -> ArticulatedVehicle:
        """Return the vehicle with another joint, or with the present one of another kind."""
        if isinstance(joint, str):
            joint = dataclasses.replace(self.joint, kind=joint)
        return articulate(self._units, joint, self.name)

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

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> tuple[Any, ...]:
        return (articulate, (self._units, self.joint, self.name))

    def __repr__(self) -> str:
        leading, trailing = self._units
        return f"ArticulatedVehicle({self.name!r}, {leading!r}, {trailing!r}, {self.joint.kind})"


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
    for zone in trailing.zones:
        if zone in leading.zones:
            raise ValueError(f"names of zones must differ between the units, got {zone!r} in both")

    mass = leading.mass + trailing.mass
    places = (leading.center_of_mass, trailing.center_of_mass + joint.shift)
    center = joined_center(
        (leading.mass, trailing.mass), (leading.center_of_mass, trailing.center_of_mass), joint
    )
    inertia = np.zeros((3, 3))
    for unit, place in zip(units, places, strict=True):
        lever = place - center
        inertia += unit.inertia + unit.mass * ((lever**2).sum() * np.eye(3) - np.outer(lever, lever))

    def of_both(points: str) -> Floats:
        shifted = []
        for unit, place in zip(units, places, strict=True):
            rows = getattr(unit, points).copy()
            rows[:, :3] += place - center
            shifted.append(rows)
        return np.concatenate(shifted)

    wheel_numbers = trailing.wheel_of_node + np.where(trailing.wheel_of_node >= 0, len(leading.wheels), 0)
    wheel_zones = trailing.zone_of_wheel + np.where(trailing.zone_of_wheel >= 0, len(leading.zones), 0)
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
        zone_of_wheel=np.concatenate([leading.zone_of_wheel, wheel_zones]),
        mass_center_height=float(center[2]),
        zones={**leading.zones, **trailing.zones},
        rate_sensitivity=leading.rate_sensitivity,
        indentation_length=leading.indentation_length,
        _units=(leading, trailing),
        _joint=joint,
    )
