"""When an impact ends: what a barrier takes later is not of it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from .. import _core

if TYPE_CHECKING:
    from ..result import Result

__all__ = ["AT_REST", "end_of_impact"]

AT_REST = _core.coasting_speed
"""Speed below which a vehicle counts as at rest [m/s], as in ratings."""


def end_of_impact(result: Result) -> float:
    """Return when the impact ends [s]: as the vehicle separates from the barrier for good, or comes to rest.

    It is at rest from the instant on after which the mass centre of every unit is slower than 0.25 m/s, along
    the ground. Infinite where the run ends before.
    """
    separation = result.metrics.get("time_of_separation")
    if separation is not None:
        return float(separation)
    units = range(len(result.scene.vehicle.units))
    speeds = [np.hypot(*result.unit(u).velocity[:, :2].T) for u in units]
    moves = np.flatnonzero(np.max(speeds, axis=0) >= AT_REST)
    rests = int(moves[-1]) + 1 if len(moves) else 0
    return float(result.time[rests]) if rests < len(result.time) else math.inf
