"""Numbers of a vehicle by their names in ``vehicle.<number>``: which it has, their units, and other ones."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from ..base import checks
from ..units import si
from ..vehicle.combination_recipe import CombinationRecipe
from ..vehicle.inertia import INERTIAS, UNIT
from ..vehicle.recipe import VehicleRecipe
from ..vehicle.scaling import SIZES, factors_of
from ..vehicle.vehicle import Vehicle
from ..vehicle.zone import positive

__all__ = ["NUMBERS", "numbers_of", "resized", "vehicle_value", "with_numbers"]

Recipe = VehicleRecipe | CombinationRecipe


class VehicleNumber(NamedTuple):
    """A number of a vehicle.

    unit: ``""`` for a pure number. is_of: whether a vehicle has it. changed: returns a recipe with another
    one; ``None``: it is changed together with others, see :func:`resized` and :func:`with_numbers`.
    """

    unit: str
    is_of: Callable[[Vehicle], bool]
    changed: Callable[[Recipe, Any], Recipe] | None = None


def _always(_vehicle: Vehicle) -> bool:
    return True


def _has_file(vehicle: Vehicle) -> bool:
    return vehicle.has_file


def _is_one_unit(vehicle: Vehicle) -> bool:
    return vehicle.joint is None


def _has_two_axles(vehicle: Vehicle) -> bool:
    return vehicle.has_file and vehicle.joint is None and vehicle.wheelbase is not None


def _with_fixings(recipe: Recipe, factor: Any) -> Recipe:
    assert isinstance(recipe, CombinationRecipe)  # the number is of vehicles that slide
    return recipe.with_fixings(checks.number("bed_fixings", factor))


NUMBERS: Mapping[str, VehicleNumber] = {
    "gvw": VehicleNumber(
        "kg", _always, lambda recipe, value: recipe.with_mass(positive("gvw", si("gvw", value, "mass")))
    ),
    "mass_center_height": VehicleNumber(
        "m",
        lambda vehicle: vehicle.mass_center_height > 0.0,  # no ratio leads away from the ground
        lambda recipe, value: recipe.with_mass_center_height(
            None if value is None else si("mass_center_height", value, "length")
        ),
    ),
    "mesh_density": VehicleNumber(
        "",
        _has_file,
        lambda recipe, value: recipe.with_mesh_density(checks.number("mesh_density", value)),
    ),
    "rate_sensitivity": VehicleNumber(
        "s/m",
        _always,
        lambda recipe, value: recipe.each(rate_sensitivity=si("rate_sensitivity", value, "time per length")),
    ),
    "indentation_length": VehicleNumber(
        "m",
        _always,
        lambda recipe, value: recipe.each(indentation_length=si("indentation_length", value, "length")),
    ),
    "bed_fixings": VehicleNumber("", lambda vehicle: vehicle.slides, _with_fixings),
    **{name: VehicleNumber("m", _has_file) for name in SIZES[:3]},
    "wheelbase": VehicleNumber("m", _has_two_axles),
    **{name: VehicleNumber(UNIT, _is_one_unit) for name in INERTIAS},
}
"""Name -> what it is. Other numbers of a vehicle are changed in this order."""


def numbers_of(vehicle: Vehicle) -> tuple[str, ...]:
    """Return the names of the numbers that a vehicle has."""
    return tuple(name for name, number in NUMBERS.items() if number.is_of(vehicle))


def vehicle_value(vehicle: Vehicle, name: str) -> Any:
    """Return the present number; of fixings 1, as theirs is a factor."""
    if name == "bed_fixings":
        return 1.0
    return vehicle.mass if name == "gvw" else getattr(vehicle, name)


def resized(vehicle: Vehicle, numbers: Mapping[str, Any]) -> Recipe:
    """Return the recipe of a vehicle with other sizes, as far as the numbers name them; its mass stays.

    Raises
    ------
    ValueError
        If a size is out of range.
    """
    recipe = vehicle._description
    sizes = {name: positive(name, si(name, numbers[name], "length")) for name in SIZES if name in numbers}
    return recipe.resized(factors_of(sizes, vehicle._sizes, vehicle.name)) if sizes else recipe


def with_numbers(recipe: Recipe, numbers: Mapping[str, Any]) -> Recipe:
    """Return the recipe with other numbers but sizes; inertias come last, as they follow from the others.

    Raises
    ------
    ValueError
        If a number is out of range.
    """
    for name, number in NUMBERS.items():
        if name in numbers and number.changed is not None:
            recipe = number.changed(recipe, numbers[name])
    wanted = {name: si(name, numbers[name], "inertia") for name in INERTIAS if name in numbers}
    return recipe.with_inertia(wanted) if wanted else recipe
