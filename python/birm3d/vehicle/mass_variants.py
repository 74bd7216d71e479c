"""Changes of a vehicle's mass, of where it is and how far it is spread; each makes another recipe."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

from ..base.arguments import checked
from ..unit_check import given
from ..units import Quantity, si
from .built_fields import fields_of
from .given_mass import given_mass
from .inertia import INERTIAS
from .recipe import VehicleRecipe
from .vehicle_data import VehicleData

if TYPE_CHECKING:
    from typing_extensions import Self

    from .combination_recipe import CombinationRecipe

__all__ = ["MassVariants"]


@checked
class MassVariants(VehicleData):
    """How a :class:`birm3d.Vehicle` is changed, and the methods that change its mass properties."""

    @property
    def units(self) -> tuple[MassVariants, ...]:
        """The rigid bodies, each as a vehicle of its own; (self,) where there is one."""
        return (self,)

    @property
    def recipe(self) -> VehicleRecipe | CombinationRecipe:
        """What the vehicle is made of: :func:`birm3d.vehicle.build` makes it again.

        Raises
        ------
        ValueError
            If ``dataclasses.replace()`` was given arrays that do not follow from a file.
        """
        self._require_as_built()
        return self._description

    def _require_as_built(self) -> None:
        for unit in self.units:
            if unit.has_file and unit._own:
                raise ValueError(
                    f"{', '.join(unit._own)} of {unit.name!r} must be changed after what is made from its "
                    "file, or the change is lost: call with_gvw, with_payload, scaled_to, with_mesh_density "
                    "and with_mass_center_height first, dataclasses.replace() last"
                )

    def _changed(self, recipe: VehicleRecipe | CombinationRecipe) -> Self:
        """Return the vehicle of another recipe; what it shares with this one is not made again.

        Raises
        ------
        ValueError
            As :func:`birm3d.vehicle.build`; and if arrays that ``dataclasses.replace()`` was given would be
            lost.
        """
        now = self._description
        if recipe is now:
            return self
        # A change keeps the number of units; vehicles of two have a method of their own.
        assert isinstance(recipe, VehicleRecipe)
        assert isinstance(now, VehicleRecipe)
        if recipe.body == now.body:
            return dataclasses.replace(
                self,
                name=recipe.name,
                zones=recipe.zones,
                rate_sensitivity=recipe.rate_sensitivity,
                indentation_length=recipe.indentation_length,
            )
        if recipe.file is None:
            return type(self)(**fields_of(recipe))
        self._require_as_built()
        same_mesh = recipe.file is now.file and recipe.mesh_density == now.mesh_density
        return type(self)(**fields_of(recipe, self._shape if same_mesh else None))

    def _mass_given(self, name: str, mass: Quantity) -> float:
        """Return a mass [kg] > 0, and warn if it is far from that of the vehicle's file."""
        return given_mass(name, mass, self._description)

    def with_gvw(self, gvw: Quantity) -> Self:
        """Return the vehicle with another mass [kg]; every mass property follows.

        Payload is rescaled first: goods in a load space keep their density and stand higher, see
        :meth:`with_payload`; below the unladen mass the structure is rescaled, without payload.
        A height given by :meth:`with_mass_center_height` stays. A vehicle made from arrays keeps its mass
        centre and scales its inertia.

        Raises
        ------
        ValueError
            If the mass is not > 0, or a change by ``dataclasses.replace()`` would be lost.
        UnitWarning, MassWarning
            As warnings, if the mass is most likely in another unit, or no vehicle of the class can have it.
        """
        return self._changed(self._description.with_mass(self._mass_given("gvw", gvw)))

    def with_payload(
        self, payload: Quantity, *, density: Quantity | None = None, height: Quantity | None = None
    ) -> Self:
        """Return the vehicle with its structure as it is and another payload [kg], 0 for none.

        Goods in a load space (of a cargo truck) cover its floor and stand as high as mass and density say. So
        the mass centre rises as the load grows; in a full space they are packed denser. Other payload, as
        people on seats, gets heavier where it is.

        Parameters
        ----------
        payload
            All of it [kg], >= 0.
        density, height
            Of the goods [kg/m^3], or of their top above the floor [m], at most that of the space. Neither:
            the density stays. A later :meth:`with_gvw` keeps the density. Where
            :meth:`with_mass_center_height` has given the height of the mass centre, that one stays.

        Raises
        ------
        ValueError
            If the vehicle has no payload, or no load space for a density or a height, or if the goods do not
            fit.
        """
        payload = given("payload", payload)
        density = None if density is None else si("density", density, "density")
        height = None if height is None else si("height", height, "length")
        return self._changed(self._description.with_payload(payload, density, height))

    def with_mass_center_height(self, height: Quantity | None) -> Self:
        """Return the vehicle with its mass centre at another height above the ground [m].

        All parts of the mass keep their place in plan. Their heights above the ground are multiplied by the
        ratio of the new height to the old one. So the inertia about the mass centre follows
        (:mod:`birm3d.vehicle.mass_center`): vertical second moments grow with the square of the ratio, the
        yaw inertia stays. Skin, core and wheels stay where they are. The height holds for every later mass
        and payload, and for a vehicle of another mass (:meth:`scaled_to`).

        Parameters
        ----------
        height
            [m], > 0 and below the vehicle's top; ``None``: what the solids of its file give.

        Raises
        ------
        ValueError
            If the height is out of range, or the mass centre of a vehicle from arrays is on the ground.
        """
        number = None if height is None else si("mass_center_height", height, "length")
        return self._changed(self._description.with_mass_center_height(number))

    def with_inertia(
        self,
        *,
        roll_inertia: Quantity | None = None,
        pitch_inertia: Quantity | None = None,
        yaw_inertia: Quantity | None = None,
    ) -> Self:
        """Return the vehicle with other inertias about its mass centre, as they were measured.

        The parts of the mass stand further from the mass centre, or nearer to it, by one factor for each axis
        (:mod:`birm3d.vehicle.inertia`). So every inertia is one that a mass can have. The mass centre stays.
        The factors hold for a later mass, payload or size.

        Parameters
        ----------
        roll_inertia
            About the axis forward [kg m^2]. ``None``: it changes only with the parts that the others move.
        pitch_inertia, yaw_inertia
            About the axis to the left, and upwards [kg m^2]. Where one is ``None``, it follows from the
            other: both are mostly due to the mass along the vehicle. With a roll inertia alone they change by
            the parts that it moves.

        Raises
        ------
        ValueError
            If none is given, no mass could have them, the vehicle has two units, or a change by
            ``dataclasses.replace()`` would be lost.
        """
        values = zip(INERTIAS, (roll_inertia, pitch_inertia, yaw_inertia), strict=True)
        wanted = {name: si(name, value, "inertia") for name, value in values if value is not None}
        if not wanted:
            raise ValueError(f"with_inertia needs at least one of {', '.join(INERTIAS)}, got none")
        return self._changed(self._description.with_inertia(wanted))
