"""What vehicles are made of: a frozen description, from which :func:`birm3d.vehicle.build` makes the vehicle.

Every change of a vehicle is a change of its recipe. What the change does not name stays as it is, and the
vehicle is built anew from all of it.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .. import _core
from ..base.deprecated import warn_renamed
from ..base.frozen_mapping import FrozenMapping
from .inertia import spread_factors, spread_inertia
from .mass_center import stretched_inertia
from .mass_check import UsualMass
from .old_keys import OLD_FIELDS
from .payload import check_load, solids_at, structure_mass
from .scaling import scaling_between
from .zone import TRUSS_LAW, Zone, positive

if TYPE_CHECKING:
    from .vehicle_file import VehicleFile

__all__ = ["VehicleArrays", "VehicleRecipe"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class VehicleArrays:
    """A vehicle that has no file: mass centre, inertia and trusses, as :class:`birm3d.Vehicle` has them.

    truss_laws: Fig. 3 of each truss, columns as in :data:`birm3d.vehicle.zone.TRUSS_LAW`, shape (n, 5);
    ``None`` where nodes have zones.
    """

    center_of_mass: Floats
    inertia: Floats
    nodes: Floats
    anchors: Floats
    area: Floats
    zone_of_node: Ints
    wheel_of_node: Ints
    along_of_node: Ints
    quads: Ints
    wheels: Floats
    zone_of_wheel: Ints
    truss_laws: Floats | None = None

    def raised(self, height: float) -> VehicleArrays:
        """Return the same with its mass centre at another height above the ground [m]."""
        old = float(self.center_of_mass[2])
        up = np.array([0.0, 0.0, height - old])
        wheels = self.wheels.copy()
        wheels[:, :3] -= up
        return dataclasses.replace(
            self,
            center_of_mass=np.array([*self.center_of_mass[:2], height]),
            inertia=stretched_inertia(self.inertia, height / old),
            nodes=self.nodes - up,
            anchors=self.anchors - up,
            wheels=wheels,
        )

    def without_tire_nodes(self) -> VehicleArrays:
        """Return the same without the nodes by which tyres meet barriers."""
        shell = self.wheel_of_node < 0
        columns = ("nodes", "anchors", "area", "zone_of_node", "wheel_of_node", "along_of_node")
        return dataclasses.replace(self, **{name: getattr(self, name)[shell] for name in columns})


@dataclass(frozen=True, eq=False)
class VehicleRecipe:
    """What a vehicle of one rigid unit is made of. Immutable.

    Attributes
    ----------
    name
        Of the vehicle.
    mass
        [kg].
    zones
        Laws by the names of the zones; all that the file has.
    file, arrays
        What it is made from: one of the two, the other is ``None``.
    mesh_density
        Number of shell elements relative to the file's choice.
    load_density
        Of the goods in the load space [kg/m^3]; ``None``: the file's.
    mass_center_height
        Above the ground, as it was asked for [m]; ``None``: that of the solids or arrays.
    spread
        Factors of the distances of the mass from its centre, along r, s and t; ``None``: no inertia was asked
        for.
    tire_contact
        Whether tyres meet barriers.
    rate_sensitivity, indentation_length
        Optional physics [s/m], [m]; 0: left out.
    """

    name: str
    mass: float
    zones: Mapping[str, Zone]
    file: VehicleFile | None = None
    arrays: VehicleArrays | None = None
    mesh_density: float = 1.0
    load_density: float | None = None
    mass_center_height: float | None = None
    spread: tuple[float, float, float] | None = None
    tire_contact: bool = True
    rate_sensitivity: float = 0.0
    indentation_length: float = 0.0

    def __post_init__(self) -> None:
        if (self.file is None) is (self.arrays is None):
            raise ValueError(
                f"file or arrays must be given, and not both, got {'none' if self.file is None else 'both'}"
            )
        object.__setattr__(self, "zones", FrozenMapping(self.zones))

    @property
    def body(self) -> tuple[Any, ...]:
        """What mesh and mass properties follow from: all but the name, the laws and the optional physics."""
        return (
            *(id(self.file), id(self.arrays), self.mass, self.mesh_density),
            *(self.load_density, self.mass_center_height, self.spread, self.tire_contact),
        )

    @property
    def file_mass(self) -> float | None:
        """Mass of the vehicle that the file describes [kg]; ``None`` where there is no file."""
        return None if self.file is None else self.file.gvw_kg

    @property
    def usual_mass(self) -> UsualMass | None:
        """Masses that the vehicle's class can have; ``None`` where there is no file."""
        if self.file is None:
            return None
        mass = self.file.gvw_kg
        return UsualMass.of(self.name, structure_mass(self.file) or mass, mass)

    def mass_properties(self) -> tuple[Floats, Floats]:
        """Return mass centre (3,), file axes [m], and inertia about it (3, 3) [kg m^2]."""
        if self.arrays is not None:
            return self.arrays.center_of_mass, self.arrays.inertia
        assert self.file is not None  # see __post_init__
        properties = _core.mass_properties(*solids_at(self.file, self.mass, self.load_density))
        center = np.array(properties.center_of_mass)
        inertia = np.array(properties.inertia)
        if self.mass_center_height is not None:
            inertia = stretched_inertia(inertia, self.mass_center_height / center[2])
            center[2] = self.mass_center_height
        return center, inertia if self.spread is None else spread_inertia(inertia, self.spread)

    # ---- changes: of a vehicle of two units each unit is given its own, see CombinationRecipe --------------

    def each(self, **changes: Any) -> VehicleRecipe:
        """Return the recipe with other numbers."""
        for old, new in OLD_FIELDS.items():
            if old in changes:
                warn_renamed(old, new)
                changes[new] = changes.pop(old)
        return dataclasses.replace(self, **changes)

    def with_mass(self, mass: float) -> VehicleRecipe:
        """Return the recipe with another mass [kg]; see :meth:`birm3d.Vehicle.with_gvw`."""
        mass = positive("gvw", mass)
        if self.arrays is None:
            return dataclasses.replace(self, mass=mass)
        heavier = dataclasses.replace(self.arrays, inertia=self.arrays.inertia * (mass / self.mass))
        return dataclasses.replace(self, mass=mass, arrays=heavier)

    def with_payload(self, payload: float, density: float | None, height: float | None) -> VehicleRecipe:
        """Return the recipe with another payload [kg]; see :meth:`birm3d.Vehicle.with_payload`."""
        if not (math.isfinite(payload) and payload >= 0.0):
            raise ValueError(f"payload must be finite and >= 0, got {payload}")
        if self.file is None or (structure := structure_mass(self.file)) == 0.0:
            raise ValueError(f"payload needs a vehicle whose file names one, got {self.name!r}")
        changed = check_load(self.file, payload, density, height)
        density = self.load_density if changed is None else changed
        return dataclasses.replace(self, mass=structure + payload, load_density=density)

    def with_mesh_density(self, mesh_density: float) -> VehicleRecipe:
        """Return the recipe with another number of elements, relative to the file's choice."""
        if self.file is None:
            raise ValueError(f"mesh_density needs a vehicle that has a file, got {self.name!r} from arrays")
        return dataclasses.replace(self, mesh_density=mesh_density)

    def with_mass_center_height(self, height: float | None) -> VehicleRecipe:
        """Return the recipe with another height [m]; see :meth:`birm3d.Vehicle.with_mass_center_height`."""
        if self.arrays is None:
            assert self.file is not None  # see __post_init__
            top = self.file.extent.top
            if height is not None and not positive("mass_center_height", height) < top:
                raise ValueError(
                    f"mass_center_height must be below the vehicle's top, {top:.4g} m; got {height:g}"
                )
            return dataclasses.replace(self, mass_center_height=height)
        if height is None:
            raise ValueError(f"mass_center_height must be given: {self.name!r} has no file with solids")
        height = positive("mass_center_height", height)
        if not self.arrays.center_of_mass[2] > 0.0:
            raise ValueError(
                f"mass_center_height must be above the ground to be changed, got {self.name!r} with "
                f"{float(self.arrays.center_of_mass[2])} m; from_arrays() takes another"
            )
        return dataclasses.replace(self, arrays=self.arrays.raised(height), mass_center_height=height)

    def with_inertia(self, wanted: Mapping[str, float]) -> VehicleRecipe:
        """Return the recipe with other inertias [kg m^2]; see :meth:`birm3d.Vehicle.with_inertia`."""
        inertia = self.mass_properties()[1]
        x, y, z = spread_factors(inertia, wanted)
        if self.arrays is not None:
            arrays = dataclasses.replace(self.arrays, inertia=spread_inertia(inertia, (x, y, z)))
            return dataclasses.replace(self, arrays=arrays)
        now = (1.0, 1.0, 1.0) if self.spread is None else self.spread
        return dataclasses.replace(self, spread=(x * now[0], y * now[1], z * now[2]))

    def without_tire_contact(self) -> VehicleRecipe:
        """Return the recipe with tyres that meet the ground only."""
        arrays = None if self.arrays is None else self.arrays.without_tire_nodes()
        return dataclasses.replace(self, tire_contact=False, arrays=arrays)

    def with_zones(self, zones: Mapping[str, Zone]) -> VehicleRecipe:
        """Return the recipe with other laws of some zones."""
        return dataclasses.replace(self, zones={**self.zones, **zones})

    def with_truss_law(self, **changes: float) -> VehicleRecipe:
        """Return the recipe with another law of all trusses; see :meth:`birm3d.Vehicle.with_truss_law`."""
        if self.arrays is None or self.arrays.truss_laws is None:
            raise ValueError(f"truss law needs a vehicle made from arrays, got {self.name!r} with zones")
        laws = self.arrays.truss_laws.copy()
        now = sums_of(laws)
        for name in changes:
            if name not in now:
                raise ValueError(f"truss law must be one of {', '.join(now)}; got {name!r}")
        for name, value in changes.items():
            column = laws[:, TRUSS_LAW.index(name)]
            if name == "knee" or not (math.isfinite(now[name]) and now[name] > 0.0):
                column[:] = value if name == "knee" else value / len(column)
            else:
                column *= value / now[name]
        return dataclasses.replace(self, arrays=dataclasses.replace(self.arrays, truss_laws=laws))

    def scaled_to(self, mass: float, factors: Mapping[str, float]) -> VehicleRecipe:
        """Return the recipe of another mass [kg], its dimensions times factors; see ``Vehicle.scaled_to``."""
        scaled = self._scaled(factors, mass, mass)
        height = self.mass_center_height
        if height is not None:
            height *= scaling_between(self._own_file.extent, factors).height(self._own_file.extent)
        return dataclasses.replace(scaled, mass=mass, mass_center_height=height)

    def resized(self, factors: Mapping[str, float]) -> VehicleRecipe:
        """Return the recipe of the same mass, structure and load, its dimensions times factors.

        A height of the mass centre that was asked for stays.
        """
        file = self._own_file
        return self._scaled(factors, file.zones_mass, file.gvw_kg)

    @property
    def _own_file(self) -> VehicleFile:
        if self.file is None:
            raise ValueError(f"scaled_to needs a vehicle that has a file, got {self.name!r} from arrays")
        return self.file

    def _scaled(self, factors: Mapping[str, float], at: float, solids: float) -> VehicleRecipe:
        """Return the recipe with its file at another size; `at`: mass that zones hold for, of solids [kg]."""
        file = self._own_file
        scaling = scaling_between(file.extent, factors)
        laws = file.law_factors(at, scaling)
        fuller = solids / file.gvw_kg / scaling.volume(file.extent)
        return dataclasses.replace(
            self,
            file=file.scaled_to(at, scaling, solids, known=factors),
            zones={name: zone.scaled(*laws[name]) for name, zone in self.zones.items()},
            load_density=None if self.load_density is None else self.load_density * fuller,
            indentation_length=scaling.indentation(file.extent) * self.indentation_length,
        )


def sums_of(truss_laws: Floats) -> dict[str, float]:
    """Return the sums of laws of trusses (n, 5) over the trusses [N/m, N], and the mean knee [m]."""
    total = truss_laws.sum(axis=0)
    total[TRUSS_LAW.index("knee")] /= len(truss_laws)
    return dict(zip(TRUSS_LAW, total.tolist(), strict=True))
