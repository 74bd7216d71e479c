"""Springs, dampers and loads at which wheels give way, for the C++ library.

The springs of a file are given by their compression under the weight, so that they follow the vehicle's mass.
How the weight is shared follows from statics, with loads that lie on a plane over the wheels' places.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from .. import units

if TYPE_CHECKING:
    from .vehicle_fields import VehicleFields
    from .zone import Zone

__all__ = ["PLAIN", "breakaway", "load_on_joint", "suspension", "tires", "wheel_loads"]

Floats = npt.NDArray[np.float64]

_HOLDS = (np.inf, 0.0)
_FIXED = (0.0, 0.0, 0.0, 0.0, 1.0)
_PLAIN_TIRE = (np.inf, 0.0, 0.0, 0.0)
PLAIN = (*_HOLDS, *_FIXED, *_PLAIN_TIRE)
"""Numbers of a wheel of which a file says nothing, in the order breakaway(), suspension(), tires()."""

_ON_ONE_AXLE = 1e-12
"""Sum of squared distances from the middle below which wheels stand on one line [m^2]."""


def breakaway(vehicle: VehicleFields) -> Floats:
    """Return load [N] and travel [m] of each wheel that gives way (w, 2), by its zone."""
    rows = _row_for_each_wheel(vehicle, _HOLDS)
    for wheel, zone in _zones_of_wheels(vehicle):
        rows[wheel] = zone.breakaway or np.inf, zone.breakaway_travel or 0.0
    return rows


def suspension(vehicle: VehicleFields, joint: tuple[Floats, float] | None = None) -> Floats:
    """Return spring, damper and bump stop of each wheel (w, 5), by its zone.

    Stiffness [N/m], 0 of a wheel that is fixed to the body; damping [N s/m]; compression at rest, and travel
    from there to the bump stop [m]; roll stiffness ratio. joint: as in :func:`wheel_loads`.
    """
    rows = _row_for_each_wheel(vehicle, _FIXED)
    loads: Floats | None = None
    for wheel, zone in _zones_of_wheels(vehicle):
        deflection = zone.static_deflection
        if deflection is None:
            continue
        assert zone.damping_ratio is not None  # zones have all three or none
        assert zone.bump_travel is not None
        loads = wheel_loads(vehicle, joint) if loads is None else loads
        stiffness = loads[wheel] / deflection
        damping = 2.0 * zone.damping_ratio * loads[wheel] / np.sqrt(units.g(deflection))
        ratio = zone.roll_stiffness_ratio or 1.0
        rows[wheel] = stiffness, damping, deflection, zone.bump_travel, ratio
    return rows


def tires(vehicle: VehicleFields) -> Floats:
    """Return how the tyre of each wheel steers, stands, leans and rolls (w, 4), by its zone.

    Steering time [s], radius of the tread's cross-section [m], camber ratio and rolling resistance per load.
    Wheels ahead of the mass centre steer, where their zone has a time; the others have inf.
    """
    rows = _row_for_each_wheel(vehicle, _PLAIN_TIRE)
    for wheel, zone in _zones_of_wheels(vehicle):
        if zone.steering_time is not None and vehicle.wheels[wheel, 0] > 0.0:
            rows[wheel, 0] = zone.steering_time
        rows[wheel, 1:] = zone.tread_radius or 0.0, zone.camber_ratio or 0.0, zone.rolling_resistance or 0.0
    return rows


def wheel_loads(vehicle: VehicleFields, joint: tuple[Floats, float] | None = None) -> Floats:
    """Return the load of each wheel at rest on a level road [N], shape (w,).

    Loads that balance the weight and the load on a joint; they vary linearly with the wheels' places. If one
    of these loads is not positive, all wheels share evenly.
    joint: its place from the mass centre, body axes (3,) [m], and what presses down on it [N].
    """
    weight = units.g(vehicle.mass)
    place, pressed = (np.zeros(3), 0.0) if joint is None else joint
    about_y, about_x = float(pressed * place[0]), float(pressed * place[1])
    x, y = vehicle.wheels[:, 0].tolist(), vehicle.wheels[:, 1].tolist()
    loads = _linear_loads(x, y, weight + pressed, about_y, about_x)
    if not (loads > 0.0).all():  # a trailer without its tractor does not stand on its wheels
        return np.full(len(vehicle.wheels), (weight + pressed) / len(vehicle.wheels))
    return np.asarray(loads, float)


def _linear_loads(x: list[float], y: list[float], force: float, about_y: float, about_x: float) -> Floats:
    """Return loads (w,) that vary linearly over the wheels and balance force and moments.

    force: sum of the loads [N]; about_y, about_x: sums of load times x and load times y [N m]. A moment about
    a single line of wheels is left out. The method is that of Gram and Schmidt. ``math.fsum`` rounds once: a
    linear solver gives other bits on other processors.
    """
    n = len(x)
    middle_x, middle_y = math.fsum(x) / n, math.fsum(y) / n
    first = [each - middle_x for each in x]
    second = [each - middle_y for each in y]
    rest_first, rest_second = about_y - middle_x * force, about_x - middle_y * force
    square_first = math.fsum(each * each for each in first)
    slope_first = slope_second = 0.0
    if square_first > _ON_ONE_AXLE:
        slope_first = rest_first / square_first
        share = math.fsum(a * b for a, b in zip(first, second, strict=True)) / square_first
        second = [b - share * a for a, b in zip(first, second, strict=True)]
        rest_second -= share * rest_first
    square_second = math.fsum(each * each for each in second)
    if square_second > _ON_ONE_AXLE:
        slope_second = rest_second / square_second
    pairs = zip(first, second, strict=True)
    return np.array([force / n + slope_first * a + slope_second * b for a, b in pairs])


def load_on_joint(trailing: VehicleFields, place: Floats) -> float:
    """Return what a trailing unit presses on its joint [N], at a place from its mass centre (3,) [m]."""
    if len(trailing.wheels) == 0:
        return units.g(trailing.mass)
    axle = trailing.wheels[:, 0].mean()
    return float(units.g(trailing.mass) * axle / (axle - place[0]))


def _row_for_each_wheel(vehicle: VehicleFields, row: tuple[float, ...]) -> Floats:
    return np.array([row] * len(vehicle.wheels), float).reshape(-1, len(row))


def _zones_of_wheels(vehicle: VehicleFields) -> Iterator[tuple[int, Zone]]:
    """Yield each wheel that has a zone, and the zone."""
    zones = list(vehicle.zones.values())
    for wheel, zone in enumerate(vehicle.zone_of_wheel.tolist()):
        if zone >= 0:
            yield wheel, zones[zone]
