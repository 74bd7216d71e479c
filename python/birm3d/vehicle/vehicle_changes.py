"""What a vehicle has that is not in the blocks of its file, and how both are written as one file.

A saved file has all blocks of the file that the vehicle comes from, with their sources, and a block
``[changes]`` that says how the vehicle differs. The same vehicle comes back from it, bit for bit.
"""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Annotated, Any, TypeAlias

from pydantic import ConfigDict, Field, model_validator

from ..io.toml import Strict
from .file_schema import Positive
from .zone_law import ZoneLaw

if TYPE_CHECKING:
    from .vehicle import Vehicle
    from .vehicle_file import VehicleFile

__all__ = ["ChangedLaw", "Changes", "changes_of", "vehicle_of"]


LawName: TypeAlias = Annotated[str, Field(pattern=r"^[a-z][a-z0-9_]*(\.along)?$")]


class ChangedLaw(ZoneLaw):
    """The law of a zone in place of the file's."""

    model_config = ConfigDict(allow_inf_nan=True)  # a knee may be infinitely far

    @model_validator(mode="after")
    def _check(self) -> ChangedLaw:
        self.require_law()
        return self


class Changes(Strict):
    """How a vehicle differs from the one that the other blocks of its file describe.

    gvw_kg: see :meth:`birm3d.Vehicle.with_gvw`; load_density_kg_per_m3: of its goods. mesh_density: number of
    elements relative to element_size_m. mass_center_height_m: in place of that of the solids, see
    :meth:`birm3d.Vehicle.with_mass_center_height`. tire_contact: whether
    tyres meet barriers. zone: laws in place of those of the file.
    """

    name: Annotated[str, Field(min_length=1)] | None = None
    gvw_kg: Positive | None = None
    load_density_kg_per_m3: Positive | None = None
    mesh_density: Positive = 1.0
    mass_center_height_m: Positive | None = None
    rate_sensitivity_s_per_m: Annotated[float, Field(ge=0.0)] = 0.0
    dent_reach_m: Annotated[float, Field(ge=0.0)] | None = None
    tire_contact: bool = True
    zone: dict[LawName, ChangedLaw] = Field(default_factory=dict)


def changes_of(vehicle: Vehicle, file: VehicleFile) -> Changes:
    """Return how a vehicle of one unit differs from its file."""
    reach = 0.0 if file.dents is None else file.dents.reach_m
    laws = file.laws
    treads = any("tire" in zone.panels for zone in file.zones)
    return Changes(
        name=vehicle.name if vehicle.name != file.name else None,
        gvw_kg=vehicle.mass if vehicle.mass != file.gvw_kg else None,
        load_density_kg_per_m3=vehicle._load_density,
        mesh_density=vehicle.mesh_density,
        mass_center_height_m=vehicle._height,
        rate_sensitivity_s_per_m=vehicle.rate_sensitivity,
        dent_reach_m=vehicle.dent_reach if vehicle.dent_reach != reach else None,
        tire_contact=not treads or bool((vehicle.wheel_of_node >= 0).any()),
        zone={
            name: ChangedLaw(**ZoneLaw.numbers_of(zone))
            for name, zone in vehicle.zones.items()
            if zone != laws[name]
        },
    )


def vehicle_of(file: VehicleFile, gvw: float | None, mesh_density: float) -> Vehicle:
    """Return the vehicle of a file of one unit with the changes that the file has.

    Parameters
    ----------
    file
        As read.
    gvw
        Mass [kg] in place of that of the file; ``None``: the file's.
    mesh_density
        Number of elements relative to the file's choice.
    """
    from .vehicle import _from_file

    changes = file.changes
    if changes is None:
        return _from_file(file, gvw, mesh_density, None)
    bare = file.model_copy(update={"changes": None})
    zones = file.laws
    vehicle = _from_file(
        bare,
        changes.gvw_kg if gvw is None else gvw,
        mesh_density * changes.mesh_density,
        {**zones, **{name: law.law for name, law in changes.zone.items()}},
        changes.mass_center_height_m,
        load_density=changes.load_density_kg_per_m3,
    )
    if not changes.tire_contact:
        vehicle = vehicle.without_tire_contact()
    others: dict[str, Any] = {"rate_sensitivity": changes.rate_sensitivity_s_per_m}
    if changes.dent_reach_m is not None:
        others["dent_reach"] = changes.dent_reach_m
    if changes.name is not None:
        others["name"] = changes.name
    return dataclasses.replace(vehicle, **others)
