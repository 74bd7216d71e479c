"""Fields of a vehicle are arrays and numbers of the shapes that its class promises."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ..base import checks
from .zone import Zone

if TYPE_CHECKING:
    from .vehicle_fields import VehicleFields

__all__ = ["check_fields"]

Ints = npt.NDArray[np.int64]
_Shape = tuple[int | str, ...]

_FLOATS: Mapping[str, _Shape] = {
    "center_of_mass": (3,),
    "inertia": (3, 3),
    "nodes": ("n", 3),
    "anchors": ("n", 3),
    "area": ("n",),
    "wheels": ("w", 4),
}
_INTS: Mapping[str, _Shape] = {
    "zone_of_node": ("n",),
    "quads": ("q", 4),
    "wheel_of_node": ("n",),
    "along_of_node": ("n",),
    "zone_of_wheel": ("w",),
}
_NUMBERS = ("mass", "mass_center_height", "rate_sensitivity", "indentation_length")


def check_fields(vehicle: VehicleFields) -> None:
    """Make arrays of what is none, and refuse what can not be the field of a vehicle.

    Raises
    ------
    ValueError
        Naming the field, what it must be and what it was given.
    """
    if not isinstance(vehicle.name, str):
        raise ValueError(f"name must be a text, got {checks.shown(vehicle.name)}")
    for name in _NUMBERS:
        checks.number(name, getattr(vehicle, name))
    for names, kind, made in ((_FLOATS, np.float64, checks.array), (_INTS, np.int64, _whole_numbers)):
        for name, shape in names.items():
            value = getattr(vehicle, name)
            if not _is_array(value, kind, shape):
                object.__setattr__(vehicle, name, made(name, value, *shape))
    zones = vehicle.zones
    if not (isinstance(zones, Mapping) and all(isinstance(zone, Zone) for zone in zones.values())):
        raise ValueError(f"zones must be a mapping of names to zones, got {checks.shown(zones)}")
    _check_zones_of_wheels(vehicle)


def _is_array(value: Any, kind: type, shape: _Shape) -> bool:
    if type(value) is not np.ndarray or value.dtype != kind or value.ndim != len(shape):
        return False
    return all(wanted.__class__ is str or wanted == n for wanted, n in zip(shape, value.shape, strict=True))


def _whole_numbers(name: str, value: Any, *shape: int | str) -> Ints:
    found = checks.array(name, value, *shape)
    if not (found == np.floor(found)).all() or (np.abs(found) > 2.0**53).any():
        raise ValueError(f"{name} must be an array of whole numbers, got {checks.shown(value)}")
    return found.astype(np.int64)


def _check_zones_of_wheels(vehicle: VehicleFields) -> None:
    """Refuse zones of wheels that are not there; where no wheel has a zone, their number does not matter."""
    zones, wheels = vehicle.zone_of_wheel, len(vehicle.wheels)
    last = zones.max(initial=-1)
    if len(zones) != wheels:
        if last >= 0:
            raise ValueError(
                f"zone_of_wheel must have a number for each of the wheels, {wheels}; got {len(zones)}"
            )
        object.__setattr__(vehicle, "zone_of_wheel", np.full(wheels, -1, np.int64))
    elif last >= len(vehicle.zones):
        raise ValueError(f"zone_of_wheel must be < {len(vehicle.zones)}, the number of zones; got {last}")
