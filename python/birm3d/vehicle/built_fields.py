"""The fields of a vehicle, from its recipe or from its two units."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .combination_recipe import joined_center
from .joint import Joint
from .recipe import VehicleRecipe

if TYPE_CHECKING:
    from .vehicle_fields import VehicleFields
    from .vehicle_shape import VehicleShape

__all__ = ["fields_of", "joined_fields"]

Floats = npt.NDArray[np.float64]


def fields_of(recipe: VehicleRecipe, shape: VehicleShape | None = None) -> dict[str, Any]:
    """Return the arguments of the vehicle of a recipe of one unit; `shape`: of its file, where known.

    Equal recipes give equal fields, to the last bit; those of one file and mesh density share their mesh.

    Raises
    ------
    ValueError
        If a number is out of range; the message names it, the limit and the value.
    """
    return _of_arrays(recipe) if recipe.file is None else _of_file(recipe, shape)


def _of_file(recipe: VehicleRecipe, shape: VehicleShape | None) -> dict[str, Any]:
    """Return the fields of the vehicle of a file, whose shape may be known."""
    file = recipe.file
    assert file is not None  # see fields_of
    if shape is None:
        from .vehicle_shape import shape_of  # pydantic takes long to load

        shape = shape_of(file, float(recipe.mesh_density))
    if not recipe.tire_contact and (shape.wheel_of_node >= 0).any():
        shape = shape.without_tire_nodes
    center, inertia = recipe.mass_properties()
    wheels = shape.wheels.copy()
    wheels[:, :3] -= center
    nodes, anchors = shape.seen_from(center)
    return dict(
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
        _spread=recipe.spread,
        _load_density=recipe.load_density,
    )


def _of_arrays(recipe: VehicleRecipe) -> dict[str, Any]:
    arrays = recipe.arrays
    assert arrays is not None  # see VehicleRecipe.__post_init__
    return dict(
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


def joined_fields(units: Sequence[VehicleFields], joint: Joint, name: str | None) -> dict[str, Any]:
    """Return the fields of a vehicle of two units, in its position of rest."""
    leading, trailing = units
    mass = leading.mass + trailing.mass
    places = (leading.center_of_mass, trailing.center_of_mass + joint.shift)
    center = joined_center(
        (leading.mass, trailing.mass), (leading.center_of_mass, trailing.center_of_mass), joint
    )
    inertia = np.zeros((3, 3))
    for unit, place in zip(units, places, strict=True):
        lever = place - center
        inertia += unit.inertia + unit.mass * ((lever**2).sum() * np.eye(3) - np.outer(lever, lever))

    def of_both(points: str) -> Floats:
        shifted = []
        for unit, place in zip(units, places, strict=True):
            rows = getattr(unit, points).copy()
            rows[:, :3] += place - center
            shifted.append(rows)
        return np.concatenate(shifted)

    wheel_numbers = trailing.wheel_of_node + np.where(trailing.wheel_of_node >= 0, len(leading.wheels), 0)
    wheel_zones = trailing.zone_of_wheel + np.where(trailing.zone_of_wheel >= 0, len(leading.zones), 0)
    shell_numbers = trailing.along_of_node + np.where(trailing.along_of_node >= 0, len(leading.nodes), 0)
    zone_numbers = trailing.zone_of_node + np.where(trailing.zone_of_node >= 0, len(leading.zones), 0)
    return dict(
        name=name if name is not None else f"{leading.name} + {trailing.name}",
        mass=mass,
        center_of_mass=center,
        inertia=inertia,
        nodes=of_both("nodes"),
        anchors=of_both("anchors"),
        area=np.concatenate([leading.area, trailing.area]),
        zone_of_node=np.concatenate([leading.zone_of_node, zone_numbers]),
        wheel_of_node=np.concatenate([leading.wheel_of_node, wheel_numbers]),
        along_of_node=np.concatenate([leading.along_of_node, shell_numbers]),
        quads=np.concatenate([leading.quads, trailing.quads + len(leading.nodes)]),
        wheels=of_both("wheels"),
        zone_of_wheel=np.concatenate([leading.zone_of_wheel, wheel_zones]),
        mass_center_height=float(center[2]),
        zones={**leading.zones, **trailing.zones},
        rate_sensitivity=leading.rate_sensitivity,
        indentation_length=leading.indentation_length,
    )
