"""What a vehicle's class says of it: the recipe at mass and size of a mesh."""

from __future__ import annotations

import dataclasses
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ..from_facts import KINDS, recipe_of_facts, unit_of
from ..recipe import VehicleRecipe
from ..scaling import SIZES, PlaceMap, Scaling
from ..variants import VehicleVariants
from ..vehicle_file import VehicleFile
from .facts import MeshFacts
from .file_blocks import with_wheels
from .raw_mesh import RawMesh
from .tires import FoundWheel

__all__ = ["MeshShape", "expected_vehicle", "file_of", "recipe_of", "recipe_of_class"]

Floats = npt.NDArray[np.float64]


class MeshShape(NamedTuple):
    """The mesh in vehicle axes, front at x = 0, with what is known of its wheels."""

    mesh: RawMesh
    points: Floats
    length: float
    width: float
    height: float
    wheels: tuple[FoundWheel, ...]


def expected_vehicle(facts: MeshFacts) -> VehicleVariants:
    """Return the vehicle that this one is like, before its size is known."""
    if facts.like is not None:
        return facts.like
    assert facts.kind is not None  # see MeshFacts.given
    if facts.kind not in KINDS:
        raise ValueError(f"kind must be one of {', '.join(KINDS)}; got {facts.kind!r}")
    return unit_of(recipe_of_facts(facts.kind, facts.mass, dict.fromkeys(SIZES), None, 0.05))


def recipe_of(vehicle: VehicleVariants) -> VehicleRecipe:
    """Return the recipe of a vehicle of one unit."""
    recipe = vehicle._description
    assert isinstance(recipe, VehicleRecipe)  # of one unit
    return recipe


def file_of(recipe: VehicleRecipe) -> VehicleFile:
    """Return the file of a recipe that has one."""
    assert recipe.file is not None  # classes are presets, and MeshFacts.given asks `like` for a file
    return recipe.file


def recipe_of_class(shape: MeshShape, facts: MeshFacts, told: list[str]) -> VehicleRecipe:
    """Return the recipe of the class at mass and size of the mesh, first axle at x = 0."""
    sizes: dict[str, float | None] = {"length": shape.length, "width": shape.width, "height": shape.height}
    axles = sorted({round(wheel.x, 2) for wheel in shape.wheels})
    sizes["wheelbase"] = facts.wheelbase or (axles[-1] - axles[0] if axles else None)
    height = facts.mass_center_height
    if facts.like is None:
        assert facts.kind is not None  # see MeshFacts.given
        recipe = recipe_of_facts(facts.kind, facts.mass, sizes, height, 0.05)
    else:
        recipe = recipe_of(facts.like.scaled_to(facts.mass, **sizes, mass_center_height=height))
    overhang = facts.front_overhang or (-axles[-1] if axles else None)
    if overhang is None:
        told.append(f"front overhang {file_of(recipe).extent.front:.4g} m: that of the class")
    else:
        recipe = _with_overhang(recipe, overhang)
    if facts.wheelbase is None and axles:
        told.append(f"wheelbase {axles[-1] - axles[0]:.4g} m: that of the parts that are called tyres")
    wheels = tuple(wheel._replace(x=wheel.x - axles[-1]) for wheel in shape.wheels)
    return with_wheels(recipe, wheels, facts.wheel_radius, facts.track)


def _with_overhang(recipe: VehicleRecipe, overhang: float) -> VehicleRecipe:
    """Return the recipe with its front so far ahead of the first axle, its length and wheelbase as before."""
    file = file_of(recipe)
    extent = file.extent
    first, last = extent.axles or (0.0, 0.5 * extent.rear)
    if not 0.0 < overhang < extent.length - (first - last):
        limit = f"> 0 and below length less wheelbase, {extent.length - (first - last):.4g} m"
        raise ValueError(f"front_overhang must be {limit}; got {overhang:g}")
    old = (extent.rear, last, first, extent.front)
    new = (first + overhang - extent.length, last, first, first + overhang)
    scaling = Scaling(PlaceMap(old, new))
    laws = file.law_factors(file.zones_mass, scaling)
    zones = {name: zone.scaled(*laws[name]) for name, zone in recipe.zones.items()}
    scaled = file.scaled_to(file.zones_mass, scaling, file.gvw_kg)
    return dataclasses.replace(recipe, file=scaled, zones=zones)
