"""Recipes of vehicle files and of presets."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache, partial
from pathlib import Path
from typing import TYPE_CHECKING

from ..units import Quantity, si
from .combination_recipe import CombinationRecipe
from .joint import Joint
from .recipe import VehicleRecipe
from .zone import positive

if TYPE_CHECKING:
    from .combination_file import Combination
    from .vehicle_file import VehicleFile

__all__ = ["read", "read_preset"]


def read(path: str | Path, gvw: Quantity | None, mesh_density: float) -> VehicleRecipe | CombinationRecipe:
    """Return the recipe of a file of one unit or of two; see :meth:`birm3d.Vehicle.from_file`."""
    return _recipe(partial(_parsed, Path(path)), gvw, mesh_density)


def read_preset(name: str, gvw: Quantity | None, mesh_density: float) -> VehicleRecipe | CombinationRecipe:
    """Return the recipe of a preset; see :meth:`birm3d.Vehicle.preset`. Changed files are read anew."""
    from .vehicle_file import data_state, preset_path

    return _recipe(partial(_parsed_once, preset_path(name), data_state()), gvw, mesh_density)


def _parsed(path: Path) -> Combination | VehicleFile:
    from .combination_file import read_combination
    from .vehicle_file import read_vehicle_file

    return read_combination(path) or read_vehicle_file(path)


@lru_cache(maxsize=64)
def _parsed_once(path: Path, state: object) -> Combination | VehicleFile:
    """Return what a file holds, immutable; `state` is that of all files which it may extend."""
    return _parsed(path)


def _recipe(
    parsed: Callable[[], Combination | VehicleFile], gvw: Quantity | None, mesh_density: float
) -> VehicleRecipe | CombinationRecipe:
    from .combination_file import Combination
    from .file_recipe import recipe_of

    mass = None if gvw is None else positive("gvw", si("gvw", gvw, "mass"))
    file = parsed()
    if not isinstance(file, Combination):
        return recipe_of(file, mass, mesh_density)
    recipe = _recipe_of_two(file, mesh_density)
    return recipe if mass is None else recipe.with_mass(mass)


def _recipe_of_two(combination: Combination, mesh_density: float) -> CombinationRecipe:
    from .file_recipe import recipe_of

    leading, trailing = (recipe_of(unit, None, mesh_density) for unit in combination.units)
    block = combination.file.joint
    joint = Joint(
        block.place_on_leading_m,
        block.place_on_trailing_m,
        block.kind,
        0.0 if block.roll_limit_deg is None else block.roll_limit_deg,
        block.slide_m_N,
    )
    return CombinationRecipe(combination.file.name, leading, trailing, joint)
