"""Distinguishes changes of a vehicle's arrays from changes that its recipe can hold."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from .vehicle_fields import VehicleFields

__all__ = ["as_built", "changed_by_hand", "check_parts"]

_DERIVED = (
    *("mass", "center_of_mass", "inertia", "nodes", "anchors", "area", "zone_of_node", "quads", "wheels"),
    *("mass_center_height", "wheel_of_node", "along_of_node", "zone_of_wheel"),
)
# In a vehicle of two units, all fields but the name follow from the units.
_OF_UNITS = (*_DERIVED, "zones", "rate_sensitivity", "indentation_length")


def as_built(vehicle: VehicleFields) -> Mapping[str, Any]:
    """Return the fields that follow from a vehicle's file, or from its units."""
    return {name: getattr(vehicle, name) for name in _OF_UNITS}


def changed_by_hand(vehicle: VehicleFields, built: Mapping[str, Any]) -> tuple[str, ...]:
    """Names of the fields that are not as they were built: ``dataclasses.replace()`` was given others.

    Raises
    ------
    ValueError
        If the zones have other names: nodes know their zone by its place among them.
    """
    may_have_any = vehicle.joint is None and not vehicle.has_file and vehicle._truss_laws is None
    if list(vehicle.zones) != list(built["zones"]) and not may_have_any:
        raise ValueError(
            f"zones must keep their names and order, {', '.join(built['zones']) or 'none'}; "
            f"got {', '.join(vehicle.zones) or 'none'}"
        )
    names = _DERIVED if vehicle.joint is None else _OF_UNITS
    return tuple(name for name in names if not _same(getattr(vehicle, name), built[name]))


def check_parts(vehicle: VehicleFields) -> None:
    """Refuse fields of a vehicle that contradict each other.

    Raises
    ------
    ValueError
        Naming the field, and what it must agree with.
    """
    height, center = vehicle.mass_center_height, float(vehicle.center_of_mass[2])
    if math.isfinite(height) and not abs(height - center) <= 1e-9 * max(1.0, abs(center)):
        raise ValueError(
            f"mass_center_height must be that of center_of_mass, {center:g} m, got {height}; "
            "with_mass_center_height() changes both"
        )
    if vehicle._truss_laws is not None and vehicle.zones:
        raise ValueError(
            f"zones must be empty for a vehicle made from arrays, whose trusses have laws of their own; "
            f"got {', '.join(vehicle.zones)}"
        )


def _same(a: Any, b: Any) -> bool:
    if a is b:
        return True
    if isinstance(a, Mapping) and isinstance(b, Mapping):
        return list(a.items()) == list(b.items())
    return bool(np.array_equal(a, b))
