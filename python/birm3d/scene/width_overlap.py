"""The share of a vehicle's width that meets a barrier: where the path lies then."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from ..barrier.surfaces import barrier_axes, barrier_surfaces

if TYPE_CHECKING:
    from ..barrier.barrier import Barrier
    from ..vehicle.vehicle import Vehicle

__all__ = ["SIDES", "offset_of_overlap"]

SIDES = ("left", "right")


def offset_of_overlap(
    vehicle: Vehicle, barrier: Barrier | None, overlap: float, side: str, angle: float
) -> float:
    """Return the ``impact_offset`` [m] at which a share of the vehicle's width meets the barrier.

    Seen along the path, the end of the barrier is inside the vehicle's width. A share ``overlap`` of the
    width, counted from ``side``, meets the barrier. The width is that of the skin (of the leading unit); the
    end of the barrier is its outermost place, of a rounded edge that of the arc.

    Parameters
    ----------
    overlap
        Above 0, at most 1.
    side
        Of the vehicle, "left" or "right".
    angle
        Between path and barrier's line [deg], above 0 and below 180.

    Raises
    ------
    ValueError
        If a value is out of range, there is no barrier, or it has no end on that side.
    """
    if not 0.0 < overlap <= 1.0:
        raise ValueError(f"overlap must be > 0 and <= 1 (a share of the vehicle's width), got {overlap}")
    if side not in SIDES:
        raise ValueError(f"overlap_side must be one of {', '.join(SIDES)}, got {side!r}")
    sine = math.sin(math.radians(angle))
    if barrier is None or not sine > 1e-12:
        state = "there is no barrier" if barrier is None else f"impact_angle is {angle:g} deg"
        raise ValueError(f"overlap must be None where {state}, got {overlap}")
    if math.isinf(getattr(barrier, "width", 0.0)) or math.isinf(getattr(barrier, "length", 0.0)):
        raise ValueError(f"overlap must be None for a barrier without end, got {overlap}; give it a width")
    yaw = math.radians(barrier.heading + 90.0 - angle)
    to_left = np.array([-math.sin(yaw), math.cos(yaw), 0.0])
    places = np.concatenate([points for points, _ in barrier_surfaces(barrier, [barrier.origin])])
    across = (places - np.asarray(barrier.origin)) @ to_left
    low, high = vehicle.units[0].skin_bounds
    overlap_width = overlap * float(high[1] - low[1])
    path = (
        float(across.min()) + overlap_width - float(high[1])
        if side == "left"
        else float(across.max()) - overlap_width - float(low[1])
    )
    # The path meets the line where it is this far along it from the barrier's origin.
    along = barrier_axes(barrier)[0]
    return barrier.station() + path / float(along @ to_left)
