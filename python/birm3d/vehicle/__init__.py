"""Vehicles: rigid body, crushable skin, wheels; their files, their mesh and their payload."""

from __future__ import annotations

from .articulated import ArticulatedVehicle, Joint
from .builder import build
from .combination_recipe import CombinationRecipe
from .recipe import VehicleArrays, VehicleRecipe
from .vehicle import Vehicle
from .zone import Zone

__all__ = [
    "ArticulatedVehicle",
    "CombinationRecipe",
    "Joint",
    "Vehicle",
    "VehicleArrays",
    "VehicleRecipe",
    "Zone",
    "build",
]
