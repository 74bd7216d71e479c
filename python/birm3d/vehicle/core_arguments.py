"""A vehicle's arguments for the core: its trusses, and its rigid body with wheels and core boxes."""

from __future__ import annotations

import statistics
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .. import _core
from .payload import core_ranges
from .wheel_arguments import breakaway, suspension, tires

if TYPE_CHECKING:
    from .vehicle_fields import VehicleFields

__all__ = ["core_unit", "is_shape", "own_settings", "unit_arguments"]

Floats = npt.NDArray[np.float64]

EDGE_FLANK_FACTOR = 1.25
"""Factor of the skin's sideways force on a wall's edge where neither settings nor vehicle have one.

Chosen to meet 150 tests of cars at 25 % overlap; no mechanism is derived for it.
"""

CORNERING_STIFFNESS = 10.0
"""Cornering stiffness of tyres where neither settings nor vehicle have one [1/rad].

Estimated for a car's tyres: published ones have 9.2 to 9.7 (0.16 to 0.17 of the load per degree; Calspan, as
quoted by McHenry Software). Band +-20 %.
"""


def core_unit(
    vehicle: VehicleFields, offset: Floats, joint: tuple[Floats, float] | None = None
) -> _core.Unit:
    """Return the rigid body for the core; offset of its mass centre along the ground (3,) [m].

    joint: what presses on it there, as in :func:`birm3d.vehicle.wheel_arguments.wheel_loads`.
    """
    shape = vehicle._shape
    if shape is not None and is_shape(vehicle):
        trusses = shape.trusses(vehicle.zones, vehicle.rate_sensitivity, vehicle.indentation_length)
        origin = vehicle.center_of_mass
    else:
        trusses, origin = _core.TrussMesh(**_truss_arguments(vehicle)), np.zeros(3)
    return _core.Unit(**_body_arguments(vehicle, offset, joint), trusses=trusses, origin=origin)


def unit_arguments(
    vehicle: VehicleFields, offset: Floats, joint: tuple[Floats, float] | None = None
) -> dict[str, Any]:
    """Return what :func:`core_unit` gives the core, with the arguments of its TrussMesh as "trusses"."""
    shape = vehicle._shape
    if shape is not None and is_shape(vehicle):
        laws = (vehicle.zones, vehicle.rate_sensitivity, vehicle.indentation_length)
        trusses, origin = shape.truss_arguments(*laws), vehicle.center_of_mass
    else:
        trusses, origin = _truss_arguments(vehicle), np.zeros(3)
    return {**_body_arguments(vehicle, offset, joint), "trusses": trusses, "origin": origin}


def own_settings(vehicle: VehicleFields, leading: VehicleFields) -> dict[str, float]:
    """Return the settings that are the vehicle's own where a scene asks for none.

    Of tyres the mean over the wheels: a wheel whose zone has no cornering stiffness, or that has no zone,
    counts with :data:`CORNERING_STIFFNESS`. The edge flank factor is the leading unit's.
    """
    zones = list(vehicle.zones.values())
    numbers = [zones[i].cornering_stiffness if i >= 0 else None for i in vehicle.zone_of_wheel]
    file = leading._file
    flank = None if file is None or file.indentation is None else file.indentation.edge_flank_factor
    return {
        "cornering_stiffness": statistics.fmean(
            CORNERING_STIFFNESS if one is None else one for one in numbers or [None]
        ),
        "edge_flank_factor": EDGE_FLANK_FACTOR if flank is None else flank,
    }


def is_shape(vehicle: VehicleFields) -> bool:
    """Whether the arrays are those of the shape, nodes and anchors seen from the mass centre."""
    shape = vehicle._shape
    if shape is None:
        return False
    names = ("area", "zone_of_node", "wheel_of_node", "along_of_node")
    pairs = [(getattr(vehicle, name), getattr(shape, name)) for name in names]
    seen = shape.seen_from(vehicle.center_of_mass)
    pairs += zip((vehicle.nodes, vehicle.anchors), seen, strict=True)
    return all(own is other or np.array_equal(own, other) for own, other in pairs)


def _body_arguments(
    vehicle: VehicleFields, offset: Floats, joint: tuple[Floats, float] | None
) -> dict[str, Any]:
    return {
        "mass": vehicle.mass,
        "inertia": vehicle.inertia,
        "wheels": vehicle.wheels,
        "breakaway": breakaway(vehicle),
        "suspension": suspension(vehicle, joint),
        "tires": tires(vehicle),
        "mass_center_height": vehicle.mass_center_height,
        "offset": offset,
        "core": _core_boxes(vehicle),
    }


def _truss_arguments(vehicle: VehicleFields) -> dict[str, Any]:
    """Return the trusses for the core, body axes."""
    if vehicle._truss_laws is not None:
        laws, which = vehicle._truss_laws[:1], np.zeros(vehicle.n_nodes, int)
        if not (vehicle._truss_laws == laws).all():  # sorting them takes longer than a short run
            laws, which = np.unique(vehicle._truss_laws, axis=0, return_inverse=True)
        curves = [
            _core.knee_curve(k_initial=a, knee=d, k_hardening=b, f_max=f, k_unloading=u)
            for a, d, b, f, u in laws.tolist()
        ]
        curve_of = which.reshape(-1)
    else:
        curves = [zone.curve for zone in vehicle.zones.values()]
        curve_of = vehicle.zone_of_node
    return {
        "nodes": vehicle.nodes,
        "anchors": vehicle.anchors,
        "curves": curves,
        "curve_of": curve_of,
        "scale": vehicle.area,
        "wheels": vehicle.wheels,
        "rate_sensitivity": vehicle.rate_sensitivity,
        "indentation_length": vehicle.indentation_length,
        "wheel_of": vehicle.wheel_of_node,
        "along_of": vehicle.along_of_node,
    }


def _core_boxes(vehicle: VehicleFields) -> Floats:
    """Return middles and half edges of the rigid body's boxes, body axes, shape (k, 6) [m]."""
    if vehicle._file is None:
        return np.empty((0, 6))
    low, high = core_ranges(vehicle._file).transpose(2, 0, 1) - vehicle.center_of_mass
    return np.hstack([0.5 * (low + high), 0.5 * (high - low)])
