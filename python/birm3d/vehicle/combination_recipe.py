"""What vehicles of two units are made of, and which unit a change goes to."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from ..base.frozen_mapping import FrozenMapping
from .joint import Joint
from .mass_check import UsualMass
from .recipe import VehicleRecipe
from .zone import Zone, positive

__all__ = ["CombinationRecipe", "joined_center"]

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class CombinationRecipe:
    """What a vehicle of two units is made of: the recipe of each, and their joint. Immutable."""

    name: str
    leading: VehicleRecipe
    trailing: VehicleRecipe
    joint: Joint

    @property
    def units(self) -> tuple[VehicleRecipe, VehicleRecipe]:
        """The leading and the trailing unit."""
        return (self.leading, self.trailing)

    @property
    def mass(self) -> float:
        """[kg]."""
        return self.leading.mass + self.trailing.mass

    @property
    def file_mass(self) -> float | None:
        """Sum of the masses in the units' files [kg]; ``None`` where one has no file."""
        masses = [unit.file_mass for unit in self.units]
        return sum(mass for mass in masses if mass is not None) if None not in masses else None

    @property
    def usual_mass(self) -> UsualMass | None:
        """Masses that both units together can have [kg]; ``None`` where one has no file."""
        first, second = (unit.usual_mass for unit in self.units)
        if first is None or second is None:
            return None
        return UsualMass(self.name, first.low + second.low, first.high + second.high)

    @property
    def zones(self) -> Mapping[str, Zone]:
        """Laws of both by the names of the zones."""
        return FrozenMapping({**self.leading.zones, **self.trailing.zones})

    @property
    def mass_center(self) -> Floats:
        """Of the whole in the axes of the leading unit's file, shape (3,) [m]."""
        centers = [unit.mass_properties()[0] for unit in self.units]
        return joined_center((self.leading.mass, self.trailing.mass), (centers[0], centers[1]), self.joint)

    # ---- changes -------------------------------------------------------------------------------------------

    def each(self, **changes: Any) -> CombinationRecipe:
        """Return the recipe with other numbers of both units."""
        return self._of_units(lambda unit: unit.each(**changes))

    def with_mass(self, mass: float) -> CombinationRecipe:
        """Return the recipe with another mass [kg]: the trailing unit is loaded or lightened."""
        if not mass > self.leading.mass:
            raise ValueError(
                f"gvw must be above the leading unit's mass ({self.leading.mass:g} kg), got {mass:g}"
            )
        return self._loaded(lambda unit: unit.with_mass(mass - self.leading.mass))

    def with_payload(self, payload: float, density: float | None, height: float | None) -> CombinationRecipe:
        """Return the recipe with another payload [kg] of the trailing unit."""
        return self._loaded(lambda unit: unit.with_payload(payload, density, height))

    def with_mesh_density(self, mesh_density: float) -> CombinationRecipe:
        """Return the recipe with another number of elements of both units."""
        return self._of_units(lambda unit: unit.with_mesh_density(mesh_density))

    def with_mass_center_height(self, height: float | None) -> CombinationRecipe:
        """Return the recipe with the mass of both units higher or lower by one ratio [m]."""
        if height is None:
            return self._of_units(lambda unit: unit.with_mass_center_height(None))
        ratio = positive("mass_center_height", height) / float(self.mass_center[2])
        return self._of_units(
            lambda unit: unit.with_mass_center_height(ratio * float(unit.mass_properties()[0][2]))
        )

    def with_inertia(self, wanted: Mapping[str, float]) -> CombinationRecipe:
        """Refuse: give the unit that is meant another inertia, and the vehicle this unit."""
        raise ValueError(f"inertia must be given to one of the units of {self.name!r}, got {dict(wanted)}")

    def without_tire_contact(self) -> CombinationRecipe:
        """Return the recipe with tyres that meet the ground only."""
        return self._of_units(lambda unit: unit.without_tire_contact())

    def with_zones(self, zones: Mapping[str, Zone]) -> CombinationRecipe:
        """Return the recipe with other laws of some zones, in the unit that has them."""
        return self._of_units(
            lambda unit: unit.with_zones({name: zone for name, zone in zones.items() if name in unit.zones})
        )

    def with_truss_law(self, **changes: float) -> CombinationRecipe:
        """Refuse: give the unit that is meant another law, and the vehicle this unit."""
        raise ValueError(f"truss law must be given to one of the units of {self.name!r}, got {changes}")

    def with_fixings(self, factor: float) -> CombinationRecipe:
        """Return the recipe with the force that holds the sliding bed multiplied by a factor."""
        return dataclasses.replace(self, joint=self.joint.with_fixings(positive("bed_fixings", factor)))

    def scaled_to(self, mass: float, factors: Mapping[str, float]) -> CombinationRecipe:
        """Return the recipe of another mass [kg]: masses and places of both units go in proportion."""
        factor = mass / self.mass
        return self._scaled(factors, lambda unit: unit.scaled_to(factor * unit.mass, factors))

    def resized(self, factors: Mapping[str, float]) -> CombinationRecipe:
        """Return the recipe of the same masses, the dimensions of both units times factors."""
        return self._scaled(factors, lambda unit: unit.resized(factors))

    def _scaled(
        self, factors: Mapping[str, float], change: Callable[[VehicleRecipe], VehicleRecipe]
    ) -> CombinationRecipe:
        """Return the recipe with a change of size of both units, and the joint at its new places."""
        times = [factors.get(name, 1.0) for name in ("length", "width", "height")]
        return dataclasses.replace(self._of_units(change), joint=self.joint.scaled(times))

    def _of_units(self, change: Callable[[VehicleRecipe], VehicleRecipe]) -> CombinationRecipe:
        return dataclasses.replace(self, leading=change(self.leading), trailing=change(self.trailing))

    def _loaded(self, change: Callable[[VehicleRecipe], VehicleRecipe]) -> CombinationRecipe:
        """Return the recipe with a change of the trailing unit; a height asked for of the whole stays."""
        if any(unit.mass_center_height is None for unit in self.units):
            return dataclasses.replace(self, trailing=change(self.trailing))
        height = float(self.mass_center[2])
        free = self._of_units(
            lambda unit: unit.with_mass_center_height(None) if unit.arrays is None else unit
        )
        return dataclasses.replace(free, trailing=change(free.trailing)).with_mass_center_height(height)


def joined_center(masses: tuple[float, float], centers: tuple[Floats, Floats], joint: Joint) -> Floats:
    """Return the mass centre of two units in the axes of the leading one's file, shape (3,) [m]."""
    leading, trailing = masses
    place = centers[1] + joint.shift
    center: Floats = (leading * centers[0] + trailing * place) / (leading + trailing)
    return center
