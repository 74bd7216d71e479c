"""Nodes on the treads of a vehicle's tyres, by which they meet barriers.

A tyre is represented by the outer edge of its tread, the circle that first meets a barrier beside the
vehicle. Each node carries the stress of the file's zone for tyres times its part of the tread. That part is
its length of the circle times the width of the wheel. Its truss runs across the vehicle, level at the height
of the axle and up to 60 degrees steep below and above. So a wheel resists a wall beside it and what it goes
over. No truss runs lengthways, for what a wheel resists in a crash head-on is already in the zones of the
front. Trusses are long, so that they hardly rotate while they are pressed; their anchors are no points of the
vehicle. Nodes near the ground are left out: there the wheel stands on it. A tread moves with the
body, not with the spring of its wheel, and does not steer.

Friction between treads and a barrier has its own coefficient (:attr:`birm3d.Settings.mu_tire_barrier`). A
wheel that is not locked has the angular velocity at which that friction has no torque about its axle. So a
barrier which meets it below and ahead of the axle pushes it up and back.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .vehicle_file import VehicleFile, Wheel

__all__ = ["Tread", "build_tread", "zones_of_wheels"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

_CLEARANCE = 0.05  # m, height above the ground of the lowest nodes at rest
_FEWEST = 6  # nodes of one tread
_LENGTH = 3.0  # m, of the trusses
_STEEPEST = math.radians(60.0)  # from the level, of the trusses right below and above the axle


@dataclass(frozen=True, eq=False)
class Tread:
    """Nodes on treads and their trusses: SI units, file axes (x forward, y left, z up).

    Attributes
    ----------
    nodes, anchors
        Ends of the trusses, shape (n, 3) [m].
    area
        Part of the tread that each node stands for, shape (n,) [m^2].
    zone
        Index of the zone with its law, shape (n,).
    wheel
        Index of its wheel, shape (n,).
    """

    nodes: Floats
    anchors: Floats
    area: Floats
    zone: Ints
    wheel: Ints


def build_tread(vehicle_file: VehicleFile, density: float = 1.0) -> Tread:
    """Return the nodes on the treads of all wheels that a zone of the panel ``tire`` holds for; maybe none.

    Parameters
    ----------
    vehicle_file
        The vehicle, as read from its file.
    density
        As of :func:`birm3d.vehicle.mesher.build_mesh`.

    Raises
    ------
    ValueError
        If such a wheel reaches to both sides of the vehicle's middle, or is lower than the nodes' clearance.
    """
    size = vehicle_file.exterior.element_size_m / math.sqrt(density)
    parts: list[tuple[Floats, Floats, float, int, int]] = []
    zones = zones_of_wheels(vehicle_file).tolist()
    for index, (wheel, zone) in enumerate(zip(vehicle_file.wheels, zones, strict=True)):
        if zone >= 0:
            parts.append((*_ring(wheel, size), zone, index))
    counts = [len(part[0]) for part in parts]
    empty = [np.empty((0, 3))]
    return Tread(
        nodes=np.concatenate([part[0] for part in parts] or empty),
        anchors=np.concatenate([part[1] for part in parts] or empty),
        area=np.repeat([part[2] for part in parts], counts),
        zone=np.repeat(np.array([part[3] for part in parts], np.int64), counts),
        wheel=np.repeat(np.array([part[4] for part in parts], np.int64), counts),
    )


def zones_of_wheels(vehicle_file: VehicleFile) -> Ints:
    """Return the index of each wheel's zone (w,): of the panel ``tire``; -1 where there is none."""
    return np.array([_zone_of(vehicle_file, wheel) for wheel in vehicle_file.wheels], np.int64)


def _zone_of(vehicle: VehicleFile, wheel: Wheel) -> int:
    """Index of the first zone for tyres whose ranges hold the middle of the wheel; -1 without one."""
    for index, zone in enumerate(vehicle.zones):
        x, y, z = wheel.center_m
        ranges = ((x, zone.x_m), (abs(y), zone.y_m), (z, zone.z_m))
        inside = all(r is None or r[0] <= place <= r[1] for place, r in ranges)
        if "tire" in zone.panels and inside:
            return index
    return -1


def _ring(wheel: Wheel, size: float) -> tuple[Floats, Floats, float]:
    """Nodes and anchors (n, 3) [m] of one wheel, evenly along the circle, and the area of each [m^2]."""
    x, y, z = wheel.center_m
    if not abs(y) >= 0.5 * wheel.width_m:
        limit = f">= {0.5 * wheel.width_m:g} m, half its width, to be on one side of the vehicle"
        raise ValueError(f"wheel.{wheel.name}.center_m: distance from the middle must be {limit}, got {y:g}")
    if not 2.0 * wheel.radius_m > _CLEARANCE:
        limit = f"> {0.5 * _CLEARANCE:g} m, where its tread meets barriers"
        raise ValueError(f"wheel.{wheel.name}.radius_m must be {limit}, got {wheel.radius_m:g}")
    lowest = math.acos(1.0 - _CLEARANCE / wheel.radius_m)
    arc = 2.0 * math.pi - 2.0 * lowest
    n = max(_FEWEST, round(arc * wheel.radius_m / size))
    # Each node in the middle of its part, the angle from the top; front and rear are exact mirror images.
    share = (np.arange(n) + 0.5) / n
    angle = 0.5 * arc * (share - share[::-1])
    forward, up = wheel.radius_m * np.sin(angle), wheel.radius_m * np.cos(angle)
    outer = math.copysign(abs(y) + 0.5 * wheel.width_m, y)
    nodes = np.column_stack([x + forward, np.full(n, outer), z + up])
    # Across at the height of the axle, the more upwards or downwards the further from it.
    tilt = -_STEEPEST * up / wheel.radius_m
    inward = -math.copysign(1.0, y)
    anchors = nodes + _LENGTH * np.column_stack([np.zeros(n), inward * np.cos(tilt), np.sin(tilt)])
    return nodes, anchors, arc * wheel.radius_m * wheel.width_m / n
