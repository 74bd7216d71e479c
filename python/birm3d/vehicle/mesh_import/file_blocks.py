"""Blocks of a vehicle file that a user of a mesh gives: wheels, zones, boxes of the core."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from ...io.toml import frozen, plain
from ..file_schema import CoreBox, Wheel, Zone
from ..recipe import VehicleRecipe
from .tires import FoundWheel

__all__ = ["with_core", "with_wheels", "with_zones"]

Model = TypeVar("Model", bound=BaseModel)
Blocks = Mapping[str, Mapping[str, Any]]

_ORIGIN = {"source": ("given",), "status": "estimated"}


def with_wheels(
    recipe: VehicleRecipe, found: Sequence[FoundWheel], radius: float | None, track: float | None
) -> VehicleRecipe:
    """Return the recipe with the wheels that were found, if any, and with a radius and a track [m]."""
    file = recipe.file
    assert file is not None  # classes have files
    wheels = list(file.wheels)
    if found:
        wheels = [
            Wheel(
                name=f"axle_{number // 2 + 1}_{'right' if number % 2 else 'left'}",
                center_m=(wheel.x, wheel.y, wheel.radius),
                radius_m=wheel.radius,
                width_m=wheel.width,
                source=("mesh",),
                status="published",
            )
            for number, wheel in enumerate(found)
        ]
    changed = []
    for wheel in wheels:
        x, y, _ = wheel.center_m
        r = wheel.radius_m if radius is None else radius
        side = y if track is None else (0.5 * track if y > 0.0 else -0.5 * track)
        changed.append(wheel.changed({"center_m": (x, side, r), "radius_m": r}))
    return dataclasses.replace(recipe, file=file.changed({"wheels": tuple(changed)}))


def with_core(recipe: VehicleRecipe, core: Blocks) -> VehicleRecipe:
    """Return the recipe with boxes of the core in the place of those of the same name, or added."""
    if not core:
        return recipe
    file = recipe.file
    assert file is not None  # classes have files
    boxes = {box.name: box for box in file.core}
    for name, given in core.items():
        boxes[name] = _block(CoreBox, "core", name, given, boxes.get(name))
    return dataclasses.replace(recipe, file=file.changed({"core": tuple(boxes.values())}))


def with_zones(recipe: VehicleRecipe, zones: Blocks) -> VehicleRecipe:
    """Return the recipe with zones in the place of those of the same name; new ones are matched first."""
    if not zones:
        return recipe
    file = recipe.file
    assert file is not None  # classes have files
    known = {zone.name: zone for zone in file.zones}
    made = {name: _block(Zone, "zones", name, given, known.get(name)) for name, given in zones.items()}
    new = {name: zone for name, zone in made.items() if name not in known}
    file = file.changed({"zones": tuple({**new, **known, **made}.values())})
    named = {key for name, zone in made.items() for key in (name, *zone.second_laws)}
    laws = {name: law if name in named else recipe.zones.get(name, law) for name, law in file.laws.items()}
    return dataclasses.replace(recipe, file=file, zones=laws)


def _block(
    kind: type[Model], argument: str, name: str, given: Mapping[str, Any], known: Zone | CoreBox | None
) -> Model:
    """Return a block of a file from what a user gives; what is left out is that of the block it replaces."""
    if not isinstance(given, Mapping):
        raise ValueError(f"{argument} must be blocks by their names, got {given!r} for {name!r}")
    base = {} if known is None else plain(known)
    try:
        return kind.model_validate(frozen({**base, **_ORIGIN, **given, "name": name}))
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        context = first.get("ctx", {})
        key = ".".join(str(part) for part in first["loc"]) or context.get("key", "")
        raise ValueError(f"{argument}[{name!r}].{key}: {context.get('message', first['msg'])}") from error
