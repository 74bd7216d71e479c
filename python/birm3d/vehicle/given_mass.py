"""Masses that users give a vehicle: read, and held against what its file and its class can have."""

from __future__ import annotations

from ..unit_check import Usual, warn_if_unusual
from ..units import Quantity, Stated, si
from .combination_recipe import CombinationRecipe
from .recipe import VehicleRecipe
from .zone import positive

__all__ = ["given_mass", "warn_of_mass"]

# A mass beyond these fractions of the file's is most likely in another unit.
_LEAST, _MOST = 0.05, 10.0


def given_mass(name: str, mass: Quantity, recipe: VehicleRecipe | CombinationRecipe) -> float:
    """Return a mass [kg] > 0, and warn if it is far from that of the recipe's file.

    For ``mass``, which scales the structure too, only a likely wrong unit is warned of.
    """
    number = positive(name, si(name, mass, "mass"))
    usual = recipe.file_mass
    if not isinstance(mass, (str, Stated)) and usual is not None:
        unit = Usual(usual * _LEAST, usual * _MOST, "kg", "t")
        if not unit.low <= number <= unit.high:
            warn_if_unusual(name, number, unit)
            return number
    of_class = recipe.usual_mass
    if name == "gvw" and of_class is not None:
        of_class.warn(name, number)
    return number


def warn_of_mass(gvw: Quantity | None, recipe: VehicleRecipe | CombinationRecipe) -> None:
    """Warn if the mass of a vehicle that was read is none that its class can have.

    gvw: what the caller asked for; ``None``: the mass is that of the file and of its block ``[changes]``.
    """
    if gvw is not None:
        given_mass("gvw", gvw, recipe)
    elif (usual := recipe.usual_mass) is not None:
        usual.warn("changes.gvw_kg", recipe.mass)  # without a block [changes] the mass is the file's
