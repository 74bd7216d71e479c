"""Metrics that are more than one number of the core; ``None`` where a run does not have one."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from .run_values import RunValues, Vector

if TYPE_CHECKING:
    from .. import _core
    from ..barrier.barrier import Barrier
    from .stored import Stored

__all__ = [
    "angle_of_exit",
    "contact_overlap",
    "exit_angle",
    "exit_speed",
    "impact_severity",
    "max_overturning_ratio",
    "restitution",
    "time_of_zero_velocity",
    "vehicle_penetration",
    "wheel_climb",
]

# Below this speed a direction of travel means nothing, m/s.
_SLOWEST = 1e-3


def impact_severity(run: RunValues) -> float:
    """1/2 m (v sin angle)^2 [J]."""
    angle = math.radians(run.scene.impact_angle)
    return 0.5 * run.scene.vehicle.mass * (run.scene.impact_speed * math.sin(angle)) ** 2


def _dot(a: Vector, b: Vector) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def time_of_zero_velocity(run: RunValues) -> float | None:
    """When the motion towards the barrier ends, since the first touch [s]."""
    if run.reversal_time is None:
        return None
    return run.reversal_time - run.scene.standoff / run.motion.approach_speed


def restitution(run: RunValues) -> float | None:
    """Return normal separation over approach speed; 0 of a vehicle that rests."""
    if run.reversal_time is None:
        return None
    velocity = run.event.exit_velocity
    if velocity is None:
        return 0.0 if run.event.manner == "rests" else None
    return max(0.0, -_dot(velocity, run.motion.towards)) / run.motion.approach_speed


def exit_speed(run: RunValues) -> float | None:
    """Of the mass centre along the ground at separation [m/s]."""
    velocity = run.event.exit_velocity
    return None if velocity is None else math.hypot(*velocity[:2])


def exit_angle(run: RunValues) -> float | None:
    """Of the path of a contained vehicle from the line, positive away from it [deg]."""
    assert run.barrier is not None
    return angle_of_exit(run.event, run.barrier)


def angle_of_exit(event: _core.Event | Stored, barrier: Barrier) -> float | None:
    """Return that angle [deg]; ``None`` of a vehicle that does not leave on the traffic side."""
    velocity, past = event.exit_velocity, barrier._past
    contained = event.manner in ("rebounds", "leaves", "slides_to_end", "slides_on")
    if velocity is None or not contained or math.hypot(*velocity[:2]) < _SLOWEST:
        return None
    away = -_dot(velocity, past)
    along = math.hypot(velocity[0] + away * past[0], velocity[1] + away * past[1])
    return math.degrees(math.atan2(away, along))


def contact_overlap(run: RunValues) -> float:
    """By which rigid body and barrier overlapped [m]."""
    statistics = run.statistics
    return max(statistics.deepest_point, statistics.greatest_overlap)


def max_overturning_ratio(run: RunValues) -> float | None:
    """Greatest ratio of overturning to restoring moment; above 1 a segment would tip."""
    gravity = run.scene.settings.gravity
    return run.extremes.segments.overturning / gravity if gravity > 0.0 else None


def wheel_climb(run: RunValues) -> float | None:
    """Greatest height of any wheel's lowest point above the ground at the output instants [m]."""
    if not run.scene.settings.ground or not len(run.scene.vehicle.wheels):
        return None
    return run.extremes.wheel_climb


def vehicle_penetration(run: RunValues) -> float | None:
    """Greatest distance of an anchor past the barrier's line [m], at the output instants."""
    return None if run.along else run.extremes.penetration
