"""Vehicles with other tyres under all their wheels."""

from __future__ import annotations

import dataclasses

from birm3d import Vehicle

__all__ = ["held_straight", "quick_to_steer", "tired"]


def tired(vehicle: Vehicle, **changes: float | None) -> Vehicle:
    """Return the vehicle with some numbers of its tyres changed."""
    zones = {n: zone for n, zone in vehicle.zones.items() if zone.static_deflection is not None}
    return vehicle.with_zones({n: dataclasses.replace(zone, **changes) for n, zone in zones.items()})


def held_straight(vehicle: Vehicle) -> Vehicle:
    """Return the vehicle with springs at the wheels, no free steering, round treads or camber thrust."""
    plain = dict.fromkeys(("steering_time", "camber_ratio", "tread_radius", "roll_stiffness_ratio"))
    return tired(vehicle, **plain)


def quick_to_steer(vehicle: Vehicle) -> Vehicle:
    """Return a truck that falls late: front wheels that follow in 0.08 s, springs at the wheels."""
    return tired(vehicle, steering_time=0.08, roll_stiffness_ratio=None)
