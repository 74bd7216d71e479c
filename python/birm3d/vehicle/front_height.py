"""How high the structure of a vehicle's front stands above the ground."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from .zone import Zone

if TYPE_CHECKING:
    from .vehicle_fields import VehicleFields
    from .vehicle_shape import VehicleShape

__all__ = ["strong_height", "strong_height_of_shape"]

_CRUSH = 0.3  # m: of bumper beam and rail ends, before an engine is met
_POINTS = 61
_SHARE = 2.0 / 3.0  # with a third above it, a front is bent or rides over; chosen by hand


def strong_height(vehicle: VehicleFields) -> float | None:
    """Return the height above the ground below which two thirds of the front's resistance stand [m].

    What resists is the work that the front takes up in its first 0.3 m. ``None`` if the vehicle has no front,
    or was made from arrays.
    """
    shape = vehicle._shape
    return None if shape is None else shape.strong_height(vehicle.zones)


def strong_height_of_shape(shape: VehicleShape, zones: Mapping[str, Zone]) -> float | None:
    """Return :func:`strong_height` for a shape whose zones have these laws; z counts from the ground."""
    inwards = shape.anchors - shape.nodes
    skin = (shape.wheel_of_node < 0) & (shape.along_of_node < 0)
    front = skin & (-inwards[:, 0] >= np.abs(inwards[:, 1:]).max(axis=1))
    depth = np.linspace(0.0, _CRUSH, _POINTS)
    each = [np.trapezoid([zone.curve.envelope(d) for d in depth.tolist()], depth) for zone in zones.values()]
    work = np.array(each)[shape.zone_of_node[front]] * shape.area[front]
    if not work.sum() > 0.0:
        return None
    rows, row_of_node = np.unique(shape.nodes[front, 2].round(3), return_inverse=True)
    of_row = np.bincount(row_of_node.reshape(-1), weights=work)
    below = np.cumsum(of_row) - 0.5 * of_row  # a row's elements reach half way to its neighbours
    return float(np.interp(_SHARE * of_row.sum(), below, rows))
