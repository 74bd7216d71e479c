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
    """Return the vehicle with wheels without free steering, round treads and camber thrust."""
    return tired(vehicle, steering_time=None, camber_ratio=None, tread_radius=None)


def quick_to_steer(vehicle: Vehicle) -> Vehicle:
    """Return the vehicle with front wheels that follow their travel in 0.08 s: trucks then fall late."""
    return tired(vehicle, steering_time=0.08)
