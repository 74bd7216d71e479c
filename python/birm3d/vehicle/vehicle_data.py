"""What follows from the fields of a vehicle: dimensions, the vehicle of the core, its recipe."""

from __future__ import annotations

import dataclasses
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .. import _core
from .core_arguments import core_unit, is_shape, own_settings, unit_arguments
from .dimensions import Dimensions, dimensions
from .field_checks import check_fields
from .recipe import VehicleArrays, VehicleRecipe
from .scaling import SIZES
from .vehicle_fields import VehicleFields
from .vehicle_guard import as_built, changed_by_hand, check_parts

if TYPE_CHECKING:
    from .combination_recipe import CombinationRecipe
    from .vehicle_file import VehicleFile
    from .vehicle_shape import VehicleShape

__all__ = ["VehicleData"]

Floats = npt.NDArray[np.float64]


class VehicleData(VehicleFields):
    """A vehicle's fields, checked, and what follows from them."""

    def __post_init__(self) -> None:
        check_fields(self)
        super().__post_init__()
        if self._built is not None:
            changed = changed_by_hand(self, self._built)
            object.__setattr__(self, "_own", tuple(dict.fromkeys((*self._own, *changed))))
        object.__setattr__(self, "_built", as_built(self))
        check_parts(self)
        if self._file is not None and self._shape is None:  # a file of a result has the arrays only
            object.__setattr__(self, "_shape", self._shape_of_file(self._file))
        _ = self.core  # the core checks every number

    def _shape_of_file(self, file: VehicleFile) -> VehicleShape:
        """Return what all vehicles of the file and mesh density share."""
        from .vehicle_shape import shape_of

        shape = shape_of(file, self._mesh_density)
        return shape if (self.wheel_of_node >= 0).any() else shape.without_tire_nodes

    @cached_property
    def _description(self) -> VehicleRecipe | CombinationRecipe:
        """What the vehicle is made of; without arrays that dataclasses.replace() was given."""
        arrays = None
        if self._file is None:
            names = [field.name for field in dataclasses.fields(VehicleArrays)]
            given = {name: getattr(self, name) for name in names if name != "truss_laws"}
            arrays = VehicleArrays(**given, truss_laws=self._truss_laws)
        return VehicleRecipe(
            name=self.name,
            mass=self.mass,
            zones=self.zones,
            file=self._file,
            arrays=arrays,
            mesh_density=self._mesh_density,
            load_density=self._load_density,
            mass_center_height=self._height,
            spread=self._spread,
            tire_contact=bool((self.wheel_of_node >= 0).any()),
            rate_sensitivity=self.rate_sensitivity,
            indentation_length=self.indentation_length,
        )

    # ---- what it is ---------------------------------------------------------------------------------------

    @cached_property
    def _dimensions(self) -> Dimensions:
        found = dimensions(self.nodes, self.wheels, self.mass_center_height)
        if self._file is None or not is_shape(self):
            return found
        extent = self._file.extent  # exact; a mesh falls short by hundredths of 1 %
        return found._replace(length=extent.length, width=extent.width, height=extent.top)

    @property
    def _sizes(self) -> dict[str, float | None]:
        return {name: getattr(self, name) for name in SIZES}

    @property
    def length(self) -> float:
        """Overall length of the uncrushed vehicle, wheels included [m]: of its file, or of its nodes."""
        return self._dimensions.length

    @property
    def width(self) -> float:
        """Overall width, tyres included, mirrors not [m]."""
        return self._dimensions.width

    @property
    def height(self) -> float:
        """Of its highest point above the ground, at rest [m]."""
        return self._dimensions.height

    @property
    def wheelbase(self) -> float | None:
        """From the first axle to the last one [m]; ``None`` where there are not two."""
        return self._dimensions.wheelbase

    @property
    def track(self) -> float | None:
        """Between the middles of the first axle's outermost wheels [m]; ``None`` where it has not two."""
        return self._dimensions.track

    @property
    def roll_inertia(self) -> float:
        """About the axis r (forward) through the mass centre [kg m^2]."""
        return float(self.inertia[0, 0])

    @property
    def pitch_inertia(self) -> float:
        """About the axis s (to the left) through the mass centre [kg m^2]."""
        return float(self.inertia[1, 1])

    @property
    def yaw_inertia(self) -> float:
        """About the axis t (up) through the mass centre [kg m^2]."""
        return float(self.inertia[2, 2])

    @cached_property
    def zones_met(self) -> tuple[str, ...]:
        """Names of the zones that hold trusses; a zone without any, as of tyres left out, has no effect."""
        count = np.bincount(self.zone_of_node[self.zone_of_node >= 0], minlength=len(self.zones))
        return tuple(name for name, n in zip(self.zones, count, strict=True) if n > 0)

    @cached_property
    def skin_bounds(self) -> tuple[Floats, Floats]:
        """Lowest and highest coordinates of the skin's nodes, body axes, shape (3,) each [m]."""
        skin = self.nodes[self.is_skin]
        return skin.min(axis=0), skin.max(axis=0)

    @cached_property
    def node_spacing(self) -> float:
        """Distance between neighbours of the skin [m]: the median, see :mod:`birm3d.vehicle.node_spacing`."""
        from .node_spacing import node_spacing

        if self._shape is not None and is_shape(self):
            return self._shape.node_spacing
        return node_spacing(self.nodes[self.is_skin])

    @property
    def has_springs(self) -> bool:
        """Whether any wheel has a spring, see :class:`birm3d.Zone`."""
        return any(zone.static_deflection is not None for zone in self.zones.values())

    @cached_property
    def core(self) -> _core.Vehicle:
        """The same vehicle for the core."""
        return _core.Vehicle([core_unit(self, np.zeros(3))], [], **self._own_settings())

    def _own_settings(self) -> dict[str, float]:
        """Return the settings of runs that ask for none, see :func:`own_settings`."""
        return own_settings(self, self)

    def _core_arguments(self) -> list[dict[str, Any]]:
        """Return what the core is made of, unit by unit: arguments of its Unit and of its TrussMesh."""
        return [unit_arguments(self, np.zeros(3))]

    def _is_shape(self) -> bool:
        """Whether the arrays are those of the shape, nodes and anchors seen from the mass centre."""
        return is_shape(self)
