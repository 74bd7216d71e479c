"""Vehicles: rigid body, crushable skin, wheels; their files, their mesh and their payload."""

from __future__ import annotations

from .combination_recipe import CombinationRecipe
from .joint import Joint
from .recipe import VehicleArrays, VehicleRecipe
from .vehicle import ArticulatedVehicle, Vehicle, build
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
