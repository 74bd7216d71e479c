"""Vehicles: rigid body, crushable skin, wheels; their files, their mesh and their payload."""

from __future__ import annotations

from .articulated import ArticulatedVehicle, Joint
from .vehicle import Vehicle
from .zone import Zone

__all__ = ["ArticulatedVehicle", "Joint", "Vehicle", "Zone"]
