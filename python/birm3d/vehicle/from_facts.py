"""A vehicle of which six facts are known: the nearest preset of its class, scaled, with what was assumed."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from ..units import Quantity, si
from .built_fields import fields_of
from .class_scatter import QUANTITIES, Z_80
from .file_schema import Assumption, Scatter, Source
from .read_recipe import read_preset
from .recipe import VehicleRecipe
from .scaling import sizes_given
from .variants import VehicleVariants
from .vehicle_file import VehicleFile
from .zone import positive

__all__ = ["KINDS", "recipe_of_facts", "unit_of"]

KINDS: Mapping[str, tuple[tuple[str, float], ...]] = {
    "car": (("small_car", 900.0), ("mash_1100c", 1100.0), ("sedan_1500", 1500.0), ("passenger_car", 1814.0)),
    "minivan": (("minivan", 2268.0),),
    "pickup": (
        *(("mash_2270p", 2270.0), ("pickup_4x4_2500", 2500.0)),
        *(("heavy_pickup", 2910.0), ("pickup", 3402.0)),
    ),
    "van": (("van_3500", 3500.0),),
    "truck": (("cargo_truck", 6804.0), ("mash_10000s", 10_000.0), ("heavy_truck_29500", 29_500.0)),
    "cab_over_truck": (("cabover_7200", 7200.0), ("cabover_7500", 7500.0)),
    "bus": (("bus_13t", 13_000.0),),
}
"""Kinds of vehicles, and the presets of each with their masses [kg]."""

_LOADED = ("truck", "cab_over_truck", "bus")
"""Kinds whose mass includes a load: their size does not follow from it."""


class _Law(NamedTuple):
    """A dimension goes with the mass to a power; log_sd: scatter of its logarithm."""

    power: float
    log_sd: float


# Lines through ln(dimension) over ln(mass) of the NHTSA tests: 38 cars (length 0.37 +-0.043, width 0.21
# +-0.018), 22 pickups (0.29 +-0.032, 0.25 +-0.041). Wheelbase: in proportion to the length, sd 0.04. Height
# and heavy vehicles: estimates.
_LIGHT = {"length": _Law(0.36, 0.043), "width": _Law(0.22, 0.03), "height": _Law(0.0, 0.06)}
_HEAVY = {"length": _Law(0.0, 0.10), "width": _Law(0.0, 0.03), "height": _Law(0.0, 0.08)}
_WHEELBASE = 0.04
_HEIGHT_OF_MASS = {False: 0.05, True: 0.10}  # of a mass centre that is not known, by whether it is loaded
_KNOWN = 0.01  # of one that is given
_INERTIA = 0.12
_LARGE = 1000.0  # from here on whole numbers are shown


def unit_of(recipe: VehicleRecipe) -> VehicleVariants:
    """Return a vehicle of one unit: its dimensions, mass properties and the methods that change it."""
    return VehicleVariants(**fields_of(recipe))


def recipe_of_facts(
    kind: str,
    mass: Quantity,
    sizes: Mapping[str, Quantity | None],
    height: Quantity | None,
    mesh_density: float,
) -> VehicleRecipe:
    """Return the recipe of a vehicle of a kind by its facts; see :meth:`birm3d.Vehicle.from_facts`."""
    if kind not in KINDS:
        raise ValueError(f"kind must be one of {', '.join(KINDS)}; got {kind!r}")
    kilograms = positive("mass", si("mass", mass, "mass"))
    base = min(KINDS[kind], key=lambda one: abs(math.log(one[1] / kilograms)))[0]
    of_preset = read_preset(base, None, mesh_density)
    assert isinstance(of_preset, VehicleRecipe)  # all presets of KINDS have one unit
    preset = unit_of(of_preset)
    given = sizes_given(**sizes)
    center = sizes_given(mass_center_height=height)["mass_center_height"]
    loaded = kind in _LOADED
    told = [
        Assumption(
            quantity="class",
            text=f"Layout, stiffness and shares of mass are those of the preset {base}, a {kind}, scaled",
        )
    ]
    wanted = dict(given)
    ratio = kilograms / preset.mass
    for name, law in (_HEAVY if loaded else _LIGHT).items():
        if given[name] is None:
            wanted[name] = getattr(preset, name) * ratio**law.power
            power = f" times the mass ratio to the power {law.power:g}" if law.power else ""
            why = f"that of {base}{power}"
            told.append(_assumed(name, wanted[name], law.log_sd, why))
    if given["wheelbase"] is None and preset.wheelbase is not None:
        assert wanted["length"] is not None  # see above
        value = preset.wheelbase * wanted["length"] / preset.length
        told.append(_assumed("wheelbase", value, _WHEELBASE, f"the same share of the length as of {base}"))
    scaled = _scaled(preset, kilograms, wanted, loaded)
    if center is not None:
        scaled = scaled.with_mass_center_height(center)
    spread = _KNOWN if center is not None else _HEIGHT_OF_MASS[loaded]
    if center is None:
        value, why = scaled.mass_center_height, f"the same share of the height as of {base}"
        told.append(_assumed("mass_center_height", value, spread, why))
    inertia = scaled.inertia.diagonal()
    for axis, value in zip(("roll", "pitch", "yaw"), inertia.tolist(), strict=True):
        why = "by mass and lengths from the solids of the preset"
        told.append(_assumed(f"inertia in {axis}", value, _INERTIA, why, "kg m^2"))
    return _finished(scaled, kind, base, tuple(told), spread)


def _scaled(
    preset: VehicleVariants, mass: float, sizes: Mapping[str, float | None], loaded: bool
) -> VehicleVariants:
    """Return the preset at another size and mass: a similar vehicle, or its structure with another load."""
    if not loaded:
        return preset.scaled_to(mass, **sizes)
    structure = preset._description.file_mass
    assert structure is not None  # presets have files
    scaled = preset.scaled_to(structure, **sizes)
    recipe = scaled._description
    if recipe.usual_mass is not None:
        recipe.usual_mass.warn("mass", mass)
    return scaled._changed(recipe.with_mass(mass))


def _assumed(name: str, value: float | None, log_sd: float, why: str, unit: str = "m") -> Assumption:
    assert value is not None
    low, high = value * math.exp(-Z_80 * log_sd), value * math.exp(Z_80 * log_sd)
    form = ",.0f" if value >= _LARGE else ".4g"
    text = f"{name} {value:{form}} {unit}, 80 % from {low:{form}} to {high:{form}}: {why}"
    return Assumption(quantity=name, value=value, low=low, high=high, unit=unit, text=text)


def _finished(
    scaled: VehicleVariants, kind: str, base: str, told: tuple[Assumption, ...], spread: float
) -> VehicleRecipe:
    """Return the recipe with a file of its own, which says what was assumed."""
    recipe = scaled._description
    assert isinstance(recipe, VehicleRecipe)  # all presets of KINDS have one unit
    file = recipe.file
    assert file is not None
    name = f"{kind}_from_facts"
    source = Source(
        id="facts",
        text=f"Known facts of one vehicle; what is not known from the preset {base}, see the assumptions",
        status="estimated",
    )
    changes = {
        "name": name,
        "title": f"{kind.replace('_', ' ').capitalize()} of {recipe.mass:,.0f} kg",
        "description": f"Made from known facts, on the base of the preset {base}.",
        "sources": (source, *file.sources),
        "assumptions": told,
        "scatter": tuple(_scatter(file, told, spread)),
    }
    return dataclasses.replace(recipe, name=name, file=file.changed(changes))


def _scatter(file: VehicleFile, told: Sequence[Assumption], height: float) -> Iterator[Scatter]:
    """Yield the scatter of the class, and that of what was assumed in place of a fact.

    Parameters
    ----------
    told
        What was assumed.
    height
        Standard deviation of the logarithm of the mass centre's height, drawn where it is known, too.
    """
    assumed = {one.name: one.log_sd for one in told if one.name in QUANTITIES}
    spreads = {**assumed, "mass_center_height": height}
    yield from (one for one in file.scatter if one.name not in spreads)
    for name in QUANTITIES:
        if name in spreads:
            yield Scatter.model_validate(
                {"name": name, "log_sd": spreads[name], "source": ("facts",), "status": "estimated"}
            )
