"""Warning of a path that leads past the end of the barrier."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..barrier.surfaces import barrier_axes, barrier_surfaces
from ..base.complaints import Complaint

if TYPE_CHECKING:
    from .. import _core
    from ..scene.scene import Scene
    from .stored import Stored

__all__ = ["MissedBarrierWarning", "missed_barrier"]


class MissedBarrierWarning(UserWarning):
    """The vehicle went past the end of the barrier and never touched it.

    The message has the clearance and the offsets at which the vehicle meets the barrier. A vehicle that goes
    between two posts, or over the top, is not warned of: that is what the barrier lets through.
    """


class _Path(NamedTuple):
    offset: float  # of the path along the barrier's line [m]
    clearance: float  # between vehicle and barrier, seen along the path [m]; below 0 they meet
    least: float  # offsets at which the vehicle meets the barrier, from here [m]
    most: float  # to here [m]


def missed_barrier(scene: Scene, event: _core.Event | Stored) -> Iterator[Complaint]:
    """Yield a complaint if the vehicle went past the end of the barrier untouched."""
    if scene.barrier is not None and event.manner == "beside" and event.time_of_separation is None:
        path = _path(scene)
        if path.clearance > 0.0:
            text = partial(_text, scene.vehicle.title, path)
            yield Complaint(MissedBarrierWarning, "impact_offset", path.clearance, text)


def _text(title: str, path: _Path) -> str:
    return (
        f"impact_offset must be above {path.least:.2f} m and below {path.most:.2f} m to lead the vehicle "
        f"({title}) to the barrier, got {path.offset:g} m: it missed the barrier by {path.clearance:.2f} m"
    )


def _path(scene: Scene) -> _Path:
    """Return clearance and offsets of the straight path that the first unit has at t = 0."""
    barrier = scene.barrier
    assert barrier is not None  # missed_barrier has asked
    path_angle = math.radians(barrier.heading + 90.0 - scene.impact_angle)
    to_left = np.array([-math.sin(path_angle), math.cos(path_angle), 0.0])
    origin = np.asarray(barrier.origin)
    points = np.concatenate([vertices for vertices, _ in barrier_surfaces(barrier, [origin])])
    across = (points - origin) @ to_left
    low, high = scene.vehicle.units[0].skin_bounds
    yaw = math.radians(scene.impact_yaw)
    corners = [x * math.sin(yaw) + y * math.cos(yaw) for x in (low[0], high[0]) for y in (low[1], high[1])]
    # On paths along the line the offset is counted across it.
    if math.sin(math.radians(scene.impact_angle)) > 1e-12:
        middle, slope = barrier.station(), float(barrier_axes(barrier)[0] @ to_left)
    else:
        middle, slope = 0.0, float(np.asarray(barrier._past) @ to_left)
    right, left = float(across.min() - max(corners)), float(across.max() - min(corners))
    offset = scene.path_offset
    place = (offset - middle) * slope
    ends = sorted((middle + right / slope, middle + left / slope))
    return _Path(offset, max(right - place, place - left), *ends)
