"""How high the structure of a vehicle's front stands above the ground."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from .zone import Zone

if TYPE_CHECKING:
    from .vehicle_fields import VehicleFields
    from .vehicle_shape import VehicleShape

__all__ = ["middle_of_front", "middle_of_shape"]

_CRUSH = 0.3  # m: of bumper beam and rail ends, before an engine is met
_POINTS = 61


def middle_of_front(vehicle: VehicleFields) -> float | None:
    """Return the height above the ground below which half of the front resists [m].

    What resists is the work that the front takes up in its first 0.3 m. ``None`` if the vehicle has no front,
    or was made from arrays.
    """
    shape = vehicle._shape
    return None if shape is None else shape.middle_of_front(vehicle.zones)


def middle_of_shape(shape: VehicleShape, zones: Mapping[str, Zone]) -> float | None:
    """Return :func:`middle_of_front` for a shape whose zones have these laws; z counts from the ground."""
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
    return float(np.interp(0.5 * of_row.sum(), below, rows))
