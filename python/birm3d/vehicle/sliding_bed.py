"""A truck as two units: the chassis, and the load bed that slides on it once its fixings yield.

A vehicle file says in its block ``bed`` which solids, which block of the skin and which points belong to the
load bed. Zones of that block alone go with it, and the core boxes that these zones name.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from .combination_recipe import CombinationRecipe
from .file_schema import Bed, End, Upper, Zone
from .joint import Joint
from .payload import structure_mass
from .recipe import VehicleRecipe
from .vehicle_file import VehicleFile, laws_left

__all__ = ["with_sliding_bed"]

UNDERSIDE = "bed_underside"
"""Name of the zone of the bed's underside, which is bare once the bed is a unit of its own."""

Slide = Sequence[tuple[float, float]]


def with_sliding_bed(recipe: VehicleRecipe, slide: Slide | None) -> CombinationRecipe:
    """Return the recipe of a truck whose load bed can slide along its frame.

    Parameters
    ----------
    recipe
        Of a truck of one unit.
    slide
        Force that holds the bed [N] against its slip [m], see :class:`birm3d.Joint`; ``None``: the file's.
        Fixings are as strong whatever the load is.

    Raises
    ------
    ValueError
        If the vehicle's file names no bed, or the vehicle was given an inertia of its own.
    """
    if recipe.file is None or recipe.file.bed is None:
        raise ValueError(f"vehicle must have a file with a block 'bed', got {recipe.name!r} without one")
    if recipe.spread is not None:
        raise ValueError(
            f"vehicle must have the inertia of its solids before its bed can slide, got {recipe.name!r} "
            "after with_inertia(): give the units theirs"
        )
    bed = recipe.file.bed
    files = (_chassis(recipe.file, bed), _bed(recipe.file, bed))
    masses = _masses(recipe, *files)
    chassis, load = (
        _unit(recipe, file, mass, part)
        for file, mass, part in zip(files, masses, ("chassis", "bed"), strict=True)
    )
    center, _ = load.mass_properties()
    # The place is below the load's mass centre: then the chassis carries its weight there.
    place = (float(center[0]), 0.0, _base_height(recipe.file, bed))
    joint = Joint(place, place, "sliding", slide=bed.slide_m_N if slide is None else tuple(slide))
    combined = CombinationRecipe(recipe.name, chassis, load, joint)
    height = recipe.mass_center_height
    return combined if height is None else combined.with_mass_center_height(height)


def _unit(recipe: VehicleRecipe, file: VehicleFile, mass: float, part: str) -> VehicleRecipe:
    """Return the recipe of a part with the changed laws and numbers of the whole."""
    assert recipe.file is not None  # see with_sliding_bed
    assert recipe.file.bed is not None
    below = recipe.file.bed.underside
    return VehicleRecipe(
        name=f"{recipe.name}_{part}",
        mass=mass,
        zones={name: recipe.zones[below if name == UNDERSIDE else name] for name in file.law_names},
        file=file,
        mesh_density=recipe.mesh_density,
        load_density=recipe.load_density if part == "bed" else None,
        tire_contact=recipe.tire_contact,
        rate_sensitivity=recipe.rate_sensitivity,
        indentation_length=recipe.indentation_length,
    )


def _masses(recipe: VehicleRecipe, chassis: VehicleFile, bed: VehicleFile) -> tuple[float, float]:
    """Return the masses of chassis and bed [kg]: of bed and load, what exceeds the structure.

    Below the mass of the structure both parts are lighter in proportion.
    """
    assert recipe.file is not None  # see with_sliding_bed
    structure = structure_mass(recipe.file)
    if structure and recipe.mass > structure:
        return chassis.gvw_kg, recipe.mass - chassis.gvw_kg
    share = recipe.mass / (structure or recipe.file.gvw_kg)
    on_bed = structure_mass(bed) or bed.gvw_kg
    return share * chassis.gvw_kg, share * on_bed


def _chassis(file: VehicleFile, bed: Bed) -> VehicleFile:
    """Return the file without what belongs to the bed."""
    zones = tuple(
        zone.changed({"blocks": tuple(name for name in zone.blocks if name != bed.block)})
        for zone in file.zones
        if zone.blocks != (bed.block,)
    )
    boxes = {name for zone in zones for name in zone.core} or {box.name for box in file.core}
    return _part(
        file,
        core=tuple(box for box in file.core if box.name in boxes),
        solids=tuple(solid for solid in file.solids if solid.name not in bed.solids),
        points=tuple(point for point in file.points if point.name not in bed.points),
        exterior=file.exterior.changed(
            {"upper": tuple(upper for upper in file.exterior.upper if upper.name != bed.block)}
        ),
        zones=zones,
    )


def _bed(file: VehicleFile, bed: Bed) -> VehicleFile:
    """Return the file of the bed: its block of the skin stands alone, and has an underside."""
    own = [zone for zone in file.zones if zone.blocks == (bed.block,)]
    core = bed.core or tuple(box for box in file.core if any(box.name in zone.core for zone in own))
    boxes = tuple(box.name for box in core)
    # Of the bed's own skin, which is the body of its file.
    sides = [zone.changed({"blocks": (), "core": boxes if bed.core else zone.core}) for zone in own]
    upper = _block_of(file, bed)
    base = _base_height(file, bed)
    return _part(
        file,
        solids=tuple(solid for solid in file.solids if solid.name in bed.solids),
        wheels=(),
        points=tuple(point for point in file.points if point.name in bed.points),
        exterior=file.exterior.changed(
            {
                "stations_m": tuple((x, half, base, top) for x, half, top in upper.roof_m),
                "front": End(),
                "rear": End(),
                "upper": (),
            }
        ),
        overhang=None,
        core=core,
        zones=(*sides, _underside(file, bed, boxes)),
    )


def _underside(file: VehicleFile, bed: Bed, boxes: tuple[str, ...]) -> Zone:
    """Return the zone of all of the bed's underside, with the law that the file names for it."""
    like = next(zone for zone in file.zones if zone.name == bed.underside)
    everywhere = {"blocks": (), "x_m": None, "y_m": None, "z_m": None}
    return like.changed(
        {
            "name": UNDERSIDE,
            "panels": ("bottom",),
            "core": boxes,
            "along": None,
            "across": None,
            **everywhere,
        }
    )


def _block_of(file: VehicleFile, bed: Bed) -> Upper:
    """Return the block of the skin that is the bed's."""
    return next(upper for upper in file.exterior.upper if upper.name == bed.block)


def _base_height(file: VehicleFile, bed: Bed) -> float:
    """Return the height at which the bed stands on the body [m], by the body's upper edge at its two ends."""
    upper = _block_of(file, bed)
    x, _, _, top = np.array(file.exterior.stations_m)[::-1].T
    return float(np.interp(upper.base_x_m, x, top).max())


def _part(file: VehicleFile, **changes: Any) -> VehicleFile:
    """Return the file of one part, without what it needs no more."""
    zones = {zone.name for zone in changes["zones"]}
    return file.changed(
        {
            **changes,
            "gvw_kg": sum(solid.mass for solid in changes["solids"]),
            "zones_at_kg": file.zones_mass,
            "targets": (),
            "scatter": tuple(
                one.changed({"zones": left})
                for one in file.scatter
                if (left := laws_left(one.zones, zones)) is not None
            ),
            "bed": None,
        }
    )
