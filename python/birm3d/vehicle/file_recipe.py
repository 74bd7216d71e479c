"""Recipes of vehicle files, and what a vehicle has that is not in the blocks of its file."""

from __future__ import annotations

from .recipe import VehicleRecipe
from .vehicle_changes import ChangedLaw, Changes
from .vehicle_fields import VehicleFields
from .vehicle_file import VehicleFile
from .zone_law import ZoneLaw

__all__ = ["changes_of", "recipe_of"]


def changes_of(vehicle: VehicleFields, file: VehicleFile) -> Changes:
    """Return how a vehicle of one unit differs from its file."""
    reach = 0.0 if file.indentation is None else file.indentation.length_m
    laws = file.laws
    treads = any("tire" in zone.panels for zone in file.zones)
    return Changes(
        name=vehicle.name if vehicle.name != file.name else None,
        gvw_kg=vehicle.mass if vehicle.mass != file.gvw_kg else None,
        load_density_kg_per_m3=vehicle._load_density,
        mesh_density=vehicle.mesh_density,
        mass_center_height_m=vehicle._height,
        mass_spread=vehicle._spread,
        rate_sensitivity_s_per_m=vehicle.rate_sensitivity,
        indentation_length_m=vehicle.indentation_length if vehicle.indentation_length != reach else None,
        tire_contact=not treads or bool((vehicle.wheel_of_node >= 0).any()),
        zone={
            name: ChangedLaw(**ZoneLaw.numbers_of(zone))
            for name, zone in vehicle.zones.items()
            if zone != laws[name]
        },
    )


def recipe_of(file: VehicleFile, gvw: float | None, mesh_density: float) -> VehicleRecipe:
    """Return the recipe of a file of one unit with the changes that the file has.

    Parameters
    ----------
    file
        As read.
    gvw
        Mass [kg] in place of that of the file; ``None``: the file's.
    mesh_density
        Number of elements relative to the file's choice.
    """
    reach = 0.0 if file.indentation is None else file.indentation.length_m
    changes = file.changes
    if changes is None:
        mass = file.gvw_kg if gvw is None else gvw
        return VehicleRecipe(
            file.name, mass, file.laws, file, mesh_density=mesh_density, indentation_length=reach
        )
    bare = file.changed({"changes": None})
    if gvw is None:
        gvw = file.gvw_kg if changes.gvw_kg is None else changes.gvw_kg
    return VehicleRecipe(
        name=file.name if changes.name is None else changes.name,
        mass=gvw,
        zones={**file.laws, **{name: law.law for name, law in changes.zone.items()}},
        file=bare,
        mesh_density=mesh_density * changes.mesh_density,
        load_density=changes.load_density_kg_per_m3,
        mass_center_height=changes.mass_center_height_m,
        spread=changes.mass_spread,
        tire_contact=changes.tire_contact,
        rate_sensitivity=changes.rate_sensitivity_s_per_m,
        indentation_length=reach if changes.indentation_length_m is None else changes.indentation_length_m,
    )
