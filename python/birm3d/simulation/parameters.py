"""Names for everything a scene has, so that sweeps, studies and calibrations can vary it.

==============================  =======================================================================
name                            value
==============================  =======================================================================
``impact_speed`` ...            an argument of :class:`birm3d.Simulation` (``impact_angle``,
                                ``impact_offset``, ``standoff``, ``duration``, ``overlap``,
                                ``vehicle``, ``barrier``, ``settings``)
``barrier.<field>``             a field of the barrier, as ``barrier.friction`` or ``barrier.spacing``
``settings.<field>``            a field of :class:`birm3d.Settings`, as ``settings.tolerance``
``vehicle.gvw``                 mass [kg], see :meth:`birm3d.Vehicle.with_gvw`
``vehicle.mass_center_height``  above the ground at rest [m]
``vehicle.length`` ...          sizes as :meth:`birm3d.Vehicle.scaled_to` has them (``width``,
                                ``height``, ``wheelbase``), at the same mass [m]; a height of the mass
                                centre that was asked for stays
``vehicle.yaw_inertia`` ...     see :meth:`birm3d.Vehicle.with_inertia` (``roll_inertia``,
                                ``pitch_inertia``) [kg m^2]
``vehicle.mesh_density``        relative number of shell elements
``vehicle.rate_sensitivity``    [s/m], see :meth:`birm3d.Vehicle.with_rate_sensitivity`
``vehicle.indentation_length``  see :meth:`birm3d.Vehicle.with_indentation_length`
``vehicle.bed_fixings``         factor on the force that holds a load bed that slides (now 1)
``zone.<zone>.<number>``        a number of :class:`birm3d.Zone` that the zone has, as ``k_initial``
``zone.<zone>.stress[i]``       stress of point i of the zone's envelope [N per m^2]
``zone.<zone>.deflection[i]``   its deflection [m]
``zone.<zone>.scale``           factor on all stresses and slopes of the zone (now 1)
``scatter.<quantity>``          factor on all stresses and slopes of the zones that ``[[scatter]]`` in the
                                vehicle's file names: ``front``, ``side``, ``corner`` or ``tires``; on the
                                stiffness of wheels' springs: ``springs`` (now 1)
``truss.<number>``              the same five numbers of a vehicle made from arrays: sums over all trusses
                                [N/m, N], shared as they are now
==============================  =======================================================================
"""

# Longer than 300 lines: names, units and values of all numbers of a scene.
from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from functools import lru_cache
from typing import Any

from ..barrier.kinds import KINDS
from ..base.arguments import checked
from ..base.deprecated import warn_renamed
from ..base.near_names import near_names
from ..scene.scene import APPROACH, Scene
from ..scene.settings import Settings
from ..units import quantity_in, si
from ..vehicle.class_scatter import joined
from ..vehicle.vehicle import TRUSS_LAW, Vehicle
from .simulation import Simulation
from .vehicle_numbers import NUMBERS, numbers_of, resized, vehicle_value, with_numbers
from .zone_numbers import PER_AREA, changed_zone, unit_of_number, zone_numbers, zone_value

__all__ = [
    "in_si",
    "parameter_names",
    "quantity_of",
    "unit_of",
    "value_of",
    "varied",
    "varied_scene",
]

_UNITS: dict[str, str] = {
    "impact_speed": "m/s",
    "impact_angle": "deg",
    "impact_offset": "m",
    "standoff": "m",
    "impact_yaw": "deg",
    "impact_roll": "deg",
    "duration": "s",
    "barrier.origin": "m",
    "barrier.heading": "deg",
    **{
        f"barrier.{size.name}": size.unit
        for kind in KINDS.values()
        for size in kind.sizes
        if size.unit == "m"
    },
    **{
        f"settings.{field.name}": field.metadata["unit"]
        for field in dataclasses.fields(Settings)
        if "unit" in field.metadata
    },
    **{f"vehicle.{name}": number.unit for name, number in NUMBERS.items() if number.unit},
}


_OF_THE_VEHICLE = ("mu_tire_barrier", "cornering_stiffness", "edge_flank_factor")
"""Settings for which the scene takes the vehicle's number where none is asked for."""

_OLD = {"vehicle.dent_reach": "vehicle.indentation_length"}
"""Old name -> name of today."""


def _todays(name: str) -> str:
    """Return the name of today, and warn of an old one."""
    if name in _OLD:
        warn_renamed(name, _OLD[name])
    return _OLD.get(name, name)


@checked
def parameter_names(simulation: Simulation) -> tuple[str, ...]:
    """Return the names of all numbers that the scene has; see the table above."""
    return _names(simulation.scene)


@checked
def unit_of(name: str) -> str:
    """Return the unit of a parameter, ``""`` for one that is a pure number or none."""
    group = name.partition(".")[0]
    if group in ("zone", "truss"):
        return unit_of_number(name.rpartition(".")[2], of_zone=group == "zone")
    return _UNITS.get(_OLD.get(name, name), "")


@checked
def in_si(name: str, value: Any) -> Any:
    """Return the value of a parameter with text such as ``"30 mph"`` as a number in SI (angles: deg).

    Raises
    ------
    ValueError
        If the parameter has a unit and the text is no number with a unit of the same quantity.
    """
    if isinstance(value, str) or name in APPROACH:
        quantity = quantity_of(name)
        if quantity is not None:
            return si(name, value, quantity)
    return value


@checked
def quantity_of(name: str) -> str | None:
    """Return the quantity of a parameter, as "speed"; ``None`` for a pure number."""
    unit = unit_of(name)
    return PER_AREA.get(unit) or quantity_in(unit)


def _names(scene: Scene) -> tuple[str, ...]:
    no_numbers = {"vehicle", "barrier", "settings", "overlap_side"}
    if scene.overlap is None:
        no_numbers.add("overlap")
    names = [f.name for f in dataclasses.fields(Scene) if f.name not in no_numbers]
    if scene.barrier is not None:
        # A wall without end has no edges.
        edgeless = math.isinf(getattr(scene.barrier, "width", 0.0))
        fields = (f.name for f in dataclasses.fields(scene.barrier))
        names += [f"barrier.{name}" for name in fields if not (edgeless and name == "edge_radius")]
    names += [f"settings.{f.name}" for f in dataclasses.fields(Settings)]
    vehicle = scene.vehicle
    names += [f"vehicle.{name}" for name in numbers_of(vehicle)]
    if not vehicle.zones and vehicle.joint is None:
        names += [f"truss.{name}" for name in TRUSS_LAW]
    for zone in vehicle.zones_met:
        names += [f"zone.{zone}.{number}" for number in zone_numbers(vehicle.zones[zone])]
    names += [f"scatter.{name}" for name in _scattered(vehicle)]
    return tuple(names)


def _scattered(vehicle: Vehicle) -> dict[str, tuple[str, ...]]:
    """Zones of each quantity of the class that is a factor on zones."""
    return {
        name: one.zones
        for name, one in joined([unit.scatter for unit in vehicle.units], vehicle.zones_met).items()
        if one.zones
    }


@checked
def value_of(simulation: Simulation, name: str) -> Any:
    """Return the present value of a parameter.

    Raises
    ------
    ValueError
        If the scene has no such parameter; the message names those it has.
    """
    scene = simulation.scene
    name = _todays(name)
    group, _, rest = name.partition(".")
    if not rest and name in (field.name for field in dataclasses.fields(Scene)):
        return getattr(scene, name)
    if name not in parameter_names(simulation):
        raise _unknown(scene, name)
    if group == "barrier":
        return getattr(scene.barrier, "rounding" if rest == "edge_radius" else rest)
    if group == "settings":
        return getattr(scene if rest in _OF_THE_VEHICLE else scene.settings, rest)
    if group == "truss":
        return scene.vehicle.truss_law[rest]
    if group == "scatter":
        return 1.0
    if group == "vehicle":
        return vehicle_value(scene.vehicle, rest)
    zone, number = rest.rsplit(".", 1)
    return zone_value(scene.vehicle.zones[zone], number)


@checked
def varied(simulation: Simulation, changes: Mapping[str, Any]) -> Simulation:
    """Return a new simulation of the same scene with some parameters changed.

    Raises
    ------
    ValueError
        If a name is unknown or a value is out of range; the message names it.
    MassWarning
        As a warning, if the vehicle's class can not have the ``vehicle.gvw`` given.
    """
    scene = varied_scene(simulation.scene, changes)
    usual = scene.vehicle._description.usual_mass
    if "vehicle.gvw" in changes and usual is not None:
        usual.warn("vehicle.gvw", scene.vehicle.mass)
    return Simulation.from_scene(scene)


@checked
def varied_scene(base: Scene, changes: Mapping[str, Any]) -> Scene:
    """Return a scene with some parameters changed, for :meth:`Simulation.from_scene` or a runner.

    Raises
    ------
    ValueError
        If a name is unknown or a part can not be made; numbers of the scene itself are not checked yet.
    """
    changes = {_todays(name): in_si(name, value) for name, value in changes.items()}
    given = {field.name: getattr(base, field.name) for field in dataclasses.fields(Scene)}
    whole = {name: value for name, value in changes.items() if name in given}
    given.update(whole)
    if isinstance(given["vehicle"], str):
        given["vehicle"] = _preset(given["vehicle"])
    scene = Scene(**given)
    if len(whole) == len(changes):
        return scene
    if not whole.keys().isdisjoint(("vehicle", "barrier", "settings")):
        scene.core_scene()  # refuses other types before it reads their parts
        known = frozenset(_names(scene))
    else:
        known = _known(base)
    groups: dict[str, dict[str, Any]] = {}
    for name, value in changes.items():
        if name in whole:
            continue
        if name not in known:
            raise _unknown(scene, name)
        group, rest = name.split(".", 1)
        groups.setdefault(group, {})[rest] = value
    if "barrier" in groups:
        given["barrier"] = dataclasses.replace(given["barrier"], **groups["barrier"])
    if "settings" in groups:
        given["settings"] = dataclasses.replace(given["settings"], **groups["settings"])
    given["vehicle"] = _varied_vehicle(given["vehicle"], groups)
    return Scene(**given)


_last_known: list[tuple[Scene, frozenset[str]]] = []


def _known(base: Scene) -> frozenset[str]:
    """Names of the scene's numbers; those of the last scene are remembered, as a study asks for every run."""
    for scene, names in _last_known[:1]:
        if scene is base:
            return names
    names = frozenset(_names(base))
    _last_known[:1] = [(base, names)]
    return names


# Reading and meshing a file takes longer than many a run; vehicles are immutable.
_preset = lru_cache(maxsize=16)(Vehicle.preset)


def _varied_vehicle(vehicle: Vehicle, groups: Mapping[str, Mapping[str, Any]]) -> Vehicle:
    if groups.keys().isdisjoint(("zone", "scatter", "truss", "vehicle")):
        return vehicle
    numbers = groups.get("vehicle", {})
    recipe = resized(vehicle, numbers)  # first, as laws go with the size
    zones: dict[str, dict[str, Any]] = {}
    for rest, value in groups.get("zone", {}).items():
        zone, number = rest.rsplit(".", 1)
        zones.setdefault(zone, {})[number] = value
    changed = {name: changed_zone(recipe.zones[name], new) for name, new in zones.items()}
    for name, factor in groups.get("scatter", {}).items():
        for zone in _scattered(vehicle)[name]:
            now = changed.get(zone, recipe.zones[zone])
            changed[zone] = now.with_springs(factor) if name == "springs" else now.scaled(factor)
    if changed:
        recipe = recipe.with_zones(changed)
    if "truss" in groups:
        recipe = recipe.with_truss_law(**groups["truss"])
    return vehicle._changed(with_numbers(recipe, numbers))


def _unknown(scene: Scene, name: str) -> ValueError:
    known = _names(scene)
    group, _, rest = name.partition(".")
    zone = rest.rpartition(".")[0]
    if group == "zone" and zone in scene.vehicle.zones and zone not in scene.vehicle.zones_met:
        return ValueError(
            f"parameter must be of a zone that trusses belong to ({', '.join(scene.vehicle.zones_met)}), "
            f"or it has no effect; got {name!r}"
        )
    near = near_names(name, known) or [known_ for known_ in known if not known_.startswith("zone.")]
    return ValueError(
        f"parameter must be one of the {len(known)} that birm3d.scene_parameters.parameter_names() lists "
        f"(near: {', '.join(near)}); got {name!r}"
    )
