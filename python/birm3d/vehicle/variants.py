"""Vehicles changed in one thing: each method makes another recipe, of which the vehicle is built."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ..base.arguments import checked
from ..unit_check import given
from ..units import Quantity, si
from .mass_variants import MassVariants
from .scaling import factors_of, sizes_given
from .zone import KNEE, LAW_QUANTITIES, OF_ENVELOPE, OPTIONAL, Zone

if TYPE_CHECKING:
    from typing_extensions import Self

__all__ = ["VehicleVariants"]


@checked
class VehicleVariants(MassVariants):
    """The methods of a :class:`birm3d.Vehicle` that return another one; the vehicle itself stays as it is."""

    def scaled_to(
        self,
        mass: Quantity,
        *,
        length: Quantity | None = None,
        width: Quantity | None = None,
        height: Quantity | None = None,
        wheelbase: Quantity | None = None,
        mass_center_height: Quantity | None = None,
    ) -> Self:
        """Return another vehicle of the same class: this one as its file loads it, of another mass and size.

        The masses of all solids and the forces of all zones change in proportion. So a vehicle of the same
        size has the same deceleration and the same crush in the same crash. Presets scaled in this way
        predict the crush of 37 other vehicles with a median error of 7 % (``tests/bench/bench_blind.py``).
        No :class:`birm3d.MassWarning` is given: it warns of a mass to which the stiffness does not fit. For
        a load in this vehicle see :meth:`with_gvw` and :meth:`with_payload`, which leave the zones alone.

        Shape, solids, wheels, core, zones and named points are scaled together. So the inertia follows: each
        radius of gyration scales with the dimensions across its axis. What is crushed is stretched with the
        structure, and forces follow from mass over depth: :mod:`birm3d.vehicle.scaling`.

        Parameters
        ----------
        mass
            [kg]; the zones hold at the mass that the file says, as a rule that of a tested vehicle.
        length, width, height
            [m], overall; ``None``: stays. A quarter to four times the present one.
        wheelbase
            From the first to the last axle [m]; ``None``: in proportion to the length. What lies between the
            axles goes with it, overhangs with what is left of the length; the first axle stays in place.
        mass_center_height
            Above the ground [m], as :meth:`with_mass_center_height` has it; ``None``: in proportion to the
            height.

        Raises
        ------
        ValueError
            If a number is out of range, the vehicle has no file, or a change by ``dataclasses.replace()``
            would be lost.
        UnitWarning
            As a warning, if the mass is most likely in another unit.
        """
        mass = self._mass_given("mass", mass)
        if wheelbase is not None and self.joint is not None:
            raise ValueError(
                f"wheelbase must be None for {self.name!r}: it goes with the length of its two units; "
                f"got {wheelbase}"
            )
        wanted = sizes_given(length=length, width=width, height=height, wheelbase=wheelbase)
        recipe = self._description.scaled_to(mass, factors_of(wanted, self._sizes, self.name))
        if mass_center_height is not None:
            recipe = recipe.with_mass_center_height(si("mass_center_height", mass_center_height, "length"))
        return self._changed(recipe)

    def with_rate_sensitivity(self, rate_sensitivity: Quantity) -> Self:
        """Return the vehicle with loading envelopes that grow with speed; at 0 that is left out.

        What is crushed has inertia and rate strength, which the paper's massless trusses lack. Therefore an
        envelope is multiplied by 1 + (rate_sensitivity * rate of deflection)^2 while it is loaded;
        rate_sensitivity [s/m] >= 0. Finite-element vehicles were met with 0.05 to 0.07 s/m
        (``tests/bench/README.md``).
        """
        rate = si("rate_sensitivity", rate_sensitivity, "time per length")
        return self._changed(self._description.each(rate_sensitivity=rate))

    def with_indentation_length(self, indentation_length: Quantity) -> Self:
        """Return the vehicle with a skin that a post draws in beside itself; at 0 that is left out.

        A post (bollard, pole) at the depth d in a front, side or rear draws in the skin beside it.
        The slope of this indentation is about d / indentation_length, at first touch 0.25. So it extends
        about indentation_length [m] beyond the post, as far as the beams and panels there carry; ``>= 0``.
        The paper's trusses are independent of each other, so that a narrow post passes between them to the
        rigid core.
        Rounded edges of walls draw in the skin beside them. Tops of walls and posts draw in skin up to 0.2 m
        above them. Meshes do not.
        """
        length = given("indentation_length", indentation_length)
        return self._changed(self._description.each(indentation_length=length))

    def without_tire_contact(self) -> Self:
        """Return the vehicle with tyres that meet the ground only; see :mod:`birm3d.vehicle.tire_nodes`."""
        if (self.wheel_of_node < 0).all():
            return self
        return self._changed(self._description.without_tire_contact())

    def with_mesh_density(self, mesh_density: float) -> Self:
        """Return the vehicle with another number of shell elements, relative to its file's choice."""
        return self._changed(self._description.with_mesh_density(mesh_density))

    def with_zone(self, name: str, **changes: Any) -> Self:
        """Return the vehicle with other stiffness numbers in one zone (see :class:`Zone`).

        Text with a unit is taken too, as ``knee="20 cm"``. First ``scale`` multiplies all stresses of it.
        ``k_initial``, ``knee`` and ``k_hardening`` replace an envelope, and ``envelope`` replaces a knee. The
        old recovery and tail are then dropped, and where all of Fig. 3 but ``f_max`` is given.
        """
        if name not in self.zones:
            known = ", ".join(self.zones) or "none: the vehicle was made from arrays"
            raise ValueError(f"zone must be one of {known}; got {name!r}")
        zone = self.zones[name]
        if "scale" in changes:
            zone = zone.scaled(changes.pop("scale"))
        known = ", ".join((*KNEE, "k_unloading", "envelope", *OPTIONAL, "scale"))
        for key in changes:
            if key not in known.split(", "):
                raise ValueError(f"zone parameter must be one of {known}; got {key!r}")
        if "envelope" in changes:
            changes = {**dict.fromkeys((*KNEE, *OF_ENVELOPE)), **changes}
        elif self.zones[name].envelope is not None and any(key in changes for key in KNEE):
            missing = [key for key in KNEE[:3] if key not in changes]
            if missing:
                raise ValueError(
                    f"{missing[0]} must be given too: zone {name!r} has an envelope, "
                    f"which needs {', '.join(KNEE[:3])} to take its place; got {', '.join(changes)}"
                )
            changes = {"envelope": None, **dict.fromkeys(OF_ENVELOPE), **changes}
        elif {*KNEE[:3], "k_unloading"} <= changes.keys():
            changes = {**dict.fromkeys(OF_ENVELOPE), **changes}
        for key, quantity in LAW_QUANTITIES.items():
            if isinstance(changes.get(key), str):
                changes[key] = si(key, changes[key], quantity)
        return self.with_zones({name: dataclasses.replace(zone, **changes)})

    def with_zones(self, zones: Mapping[str, Zone]) -> Self:
        """Return the vehicle with some of its zones replaced."""
        for name in zones:
            if name not in self.zones:
                raise ValueError(f"zone must be one of {', '.join(self.zones) or 'none'}; got {name!r}")
            if zones[name] != self.zones[name] and name not in self.zones_met:
                raise ValueError(
                    f"zone must be one that trusses belong to ({', '.join(self.zones_met)}), or its change "
                    f"has no effect; got {name!r}"
                )
        return self._changed(self._description.with_zones(zones))

    def with_truss_law(self, **changes: float) -> Self:
        """Return a vehicle made from arrays with another law, given for all trusses together.

        Stiffnesses and forces [N/m, N] are sums over the trusses and are shared as the present ones are; a
        knee [m] goes to every truss.
        """
        return self._changed(self._description.with_truss_law(**changes))
