"""Makes vehicles of their recipes, and recipes of vehicle files."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from functools import lru_cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar, cast

from ..units import Quantity, si
from .articulated import articulate
from .combination_recipe import CombinationRecipe
from .joint import Joint
from .recipe import VehicleRecipe
from .vehicle import Vehicle
from .zone import positive

if TYPE_CHECKING:
    from .combination_file import Combination
    from .variants import VehicleVariants
    from .vehicle_file import VehicleFile
    from .vehicle_shape import VehicleShape

__all__ = ["build", "read", "read_preset", "rebuilt"]

Kind = TypeVar("Kind", bound="VehicleVariants")


def build(recipe: VehicleRecipe | CombinationRecipe) -> Vehicle:
    """Return the vehicle of a recipe.

    Equal recipes give equal vehicles, to the last bit; those of one file and mesh density share their mesh.

    Raises
    ------
    ValueError
        If a number is out of range; the message names it, the limit and the value.
    """
    if isinstance(recipe, CombinationRecipe):
        return articulate([build(unit) for unit in recipe.units], recipe.joint, recipe.name)
    return _of_arrays(recipe) if recipe.file is None else _of_file(recipe, None)


def rebuilt(vehicle: Kind, recipe: VehicleRecipe | CombinationRecipe) -> Kind:
    """Return the vehicle of a changed recipe, with what it has in common with the present vehicle.

    Raises
    ------
    ValueError
        As :func:`build`; and if arrays that ``dataclasses.replace()`` was given would be lost.
    """
    now = vehicle._description
    if recipe is now:
        return vehicle
    if isinstance(recipe, CombinationRecipe):
        units = [rebuilt(unit, new) for unit, new in zip(vehicle.units, recipe.units, strict=True)]
        return cast("Kind", articulate(cast("list[Vehicle]", units), recipe.joint, recipe.name))
    assert isinstance(now, VehicleRecipe)  # a change keeps the number of units
    if recipe.body == now.body:
        return dataclasses.replace(
            vehicle,
            name=recipe.name,
            zones=recipe.zones,
            rate_sensitivity=recipe.rate_sensitivity,
            indentation_length=recipe.indentation_length,
        )
    if recipe.file is None:
        return cast("Kind", _of_arrays(recipe))
    vehicle._require_as_built()
    shape = None
    if recipe.file is now.file and recipe.mesh_density == now.mesh_density:
        shape = vehicle._shape
    return cast("Kind", _of_file(recipe, shape))


def _of_file(recipe: VehicleRecipe, shape: VehicleShape | None) -> Vehicle:
    """Return the vehicle of a file, whose shape may be known."""
    file = recipe.file
    assert file is not None  # see build and rebuilt
    if shape is None:
        from .vehicle_shape import shape_of  # pydantic takes long to load

        shape = shape_of(file, float(recipe.mesh_density))
    if not recipe.tire_contact and (shape.wheel_of_node >= 0).any():
        shape = shape.without_tire_nodes
    center, inertia = recipe.mass_properties()
    wheels = shape.wheels.copy()
    wheels[:, :3] -= center
    nodes, anchors = shape.seen_from(center)
    return Vehicle(
        name=recipe.name,
        mass=recipe.mass,  # the solids' up to rounding, which would grow with every change
        center_of_mass=center,
        inertia=inertia,
        nodes=nodes,
        anchors=anchors,
        area=shape.area,
        zone_of_node=shape.zone_of_node,
        wheel_of_node=shape.wheel_of_node,
        along_of_node=shape.along_of_node,
        quads=shape.quads,
        wheels=wheels,
        zone_of_wheel=shape.zone_of_wheel,
        mass_center_height=float(center[2]),
        zones=recipe.zones,
        rate_sensitivity=recipe.rate_sensitivity,
        indentation_length=recipe.indentation_length,
        _file=file,
        _shape=shape,
        _mesh_density=recipe.mesh_density,
        _height=recipe.mass_center_height,
        _load_density=recipe.load_density,
    )


def _of_arrays(recipe: VehicleRecipe) -> Vehicle:
    arrays = recipe.arrays
    assert arrays is not None  # see VehicleRecipe.__post_init__
    return Vehicle(
        name=recipe.name,
        mass=recipe.mass,
        center_of_mass=arrays.center_of_mass,
        inertia=arrays.inertia,
        nodes=arrays.nodes,
        anchors=arrays.anchors,
        area=arrays.area,
        zone_of_node=arrays.zone_of_node,
        wheel_of_node=arrays.wheel_of_node,
        along_of_node=arrays.along_of_node,
        quads=arrays.quads,
        wheels=arrays.wheels,
        zone_of_wheel=arrays.zone_of_wheel,
        mass_center_height=float(arrays.center_of_mass[2]),
        zones=recipe.zones,
        rate_sensitivity=recipe.rate_sensitivity,
        indentation_length=recipe.indentation_length,
        _truss_laws=arrays.truss_laws,
        _mesh_density=recipe.mesh_density,
        _height=recipe.mass_center_height,
        _load_density=recipe.load_density,
    )


def read(path: str | Path, gvw: Quantity | None, mesh_density: float) -> Vehicle:
    """Return the vehicle of a file of one unit or of two; see :meth:`birm3d.Vehicle.from_file`."""
    return _made(partial(_parsed, Path(path)), gvw, mesh_density)


def read_preset(name: str, gvw: Quantity | None, mesh_density: float) -> Vehicle:
    """Return a preset; see :meth:`birm3d.Vehicle.preset`. A file is read anew only after a change."""
    from .vehicle_file import data_state, preset_path

    return _made(partial(_parsed_once, preset_path(name), data_state()), gvw, mesh_density)


def _parsed(path: Path) -> Combination | VehicleFile:
    from .combination_file import read_combination
    from .vehicle_file import read_vehicle_file

    return read_combination(path) or read_vehicle_file(path)


@lru_cache(maxsize=64)
def _parsed_once(path: Path, state: object) -> Combination | VehicleFile:
    """Return what a file holds, immutable; `state` is that of all files which it may extend."""
    return _parsed(path)


def _made(
    parsed: Callable[[], Combination | VehicleFile], gvw: Quantity | None, mesh_density: float
) -> Vehicle:
    from .combination_file import Combination
    from .file_recipe import recipe_of

    mass = None if gvw is None else positive("gvw", si("gvw", gvw, "mass"))
    file = parsed()
    if isinstance(file, Combination):
        recipe = _recipe_of_two(file, mesh_density)
        vehicle = build(recipe if mass is None else recipe.with_mass(mass))
    else:
        vehicle = build(recipe_of(file, mass, mesh_density))
    if gvw is not None:
        vehicle._mass_given("gvw", gvw)
    elif (usual := vehicle._description.usual_mass) is not None:
        usual.warn("changes.gvw_kg", vehicle.mass)  # without a block [changes] the mass is the file's
    return vehicle


def _recipe_of_two(combination: Combination, mesh_density: float) -> CombinationRecipe:
    from .file_recipe import recipe_of

    leading, trailing = (recipe_of(unit, None, mesh_density) for unit in combination.units)
    block = combination.file.joint
    joint = Joint(block.place_on_leading_m, block.place_on_trailing_m, block.kind, block.roll_limit_deg)
    return CombinationRecipe(combination.file.name, leading, trailing, joint)
