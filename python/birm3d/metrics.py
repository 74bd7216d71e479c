"""Scalars of a run.

Forces and accelerations are taken from the interval means of the result. Filtered values use the channel
frequency class in their name (SAE J211-1). A scalar that a scene does not have (a crush without a barrier, an
exit angle of a vehicle that stands) is absent, never NaN.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from .element_loads import touched_elements
from .filters import cfc, moving_average
from .free_standing import lateral_movement

if TYPE_CHECKING:
    from .result import Result

__all__ = ["JOINT_METRICS", "METRIC_UNITS", "SEGMENT_METRICS", "compute_metrics"]

METRIC_UNITS: Mapping[str, str] = MappingProxyType(
    {
        "peak_deceleration": "m/s^2",
        "peak_deceleration_cfc60": "m/s^2",
        "peak_normal_force": "N",
        "peak_normal_force_cfc60": "N",
        "peak_force_50ms": "N",
        "peak_element_force": "N",
        "peak_element_force_50ms": "N",
        "peak_overturning_moment": "N m",
        "peak_overturning_moment_50ms": "N m",
        "dynamic_crush": "m",
        "residual_crush": "m",
        "max_displacement": "m",
        "vehicle_penetration": "m",
        "contact_overlap": "m",
        "barrier_deflection": "m",
        "residual_barrier_deflection": "m",
        "max_overturning_ratio": "",
        "time_of_zero_velocity": "s",
        "restitution": "",
        "delta_v": "m/s",
        "impact_severity": "J",
        "exit_speed": "m/s",
        "exit_angle": "deg",
        "max_roll": "deg",
        "max_pitch": "deg",
        "max_yaw": "deg",
        "wheel_climb": "m",
        "max_articulation_angle": "deg",
        "peak_joint_force": "N",
        "energy_residual": "",
        "momentum_residual": "",
        "steps": "",
        "run_time": "s",
        "end_time": "s",
    }
)
"""Every scalar that a run may have -> its unit; "" for a pure number."""

JOINT_METRICS = ("max_articulation_angle", "peak_joint_force")
"""Those that only a vehicle of two units has."""

SEGMENT_METRICS = ("barrier_deflection", "residual_barrier_deflection", "max_overturning_ratio")
"""Those that only a free-standing barrier has."""

# Below this speed a direction of travel means nothing, m/s.
_SLOWEST = 1e-3
# Below this sine of its angle a path runs along the barrier's line.
_ALONG = 1e-9
# Residuals of a vehicle that stands are judged against the energy it has at this speed, m/s.
_STANDSTILL = 0.1


def compute_metrics(result: Result, names: Collection[str] | None = None) -> dict[str, float]:
    """Return the scalars of a run, SI units and degrees; without those that take long and are not in `names`.

    Always: ``peak_deceleration`` (along r, unfiltered) [m/s^2], ``max_roll``, ``max_pitch``, ``max_yaw``
    (greatest magnitudes) [deg], ``exit_speed`` (of the mass centre along the ground, at the end) [m/s],
    ``energy_residual`` (greatest magnitude relative to the initial kinetic energy), ``momentum_residual``,
    ``steps``, ``run_time`` [s], ``end_time`` [s].

    With wheels and a ground: ``wheel_climb`` (greatest height of any wheel's lowest point above it) [m].

    With a barrier: ``peak_normal_force``, ``peak_force_50ms`` [N]; greatest of all its elements:
    ``peak_element_force``, ``peak_element_force_50ms`` [N], ``peak_overturning_moment`` and
    ``peak_overturning_moment_50ms`` [N m] (see :class:`birm3d.element_loads.ElementLoad`);
    ``dynamic_crush``, ``residual_crush`` (greatest truss shortening, also of tyres, during the run and at its
    end) [m],
    ``max_displacement`` (of the mass centre towards the barrier since t = 0 less the standoff; on a path
    along the barrier's line, towards its end) [m], ``contact_overlap`` (of the rigid body inside the barrier,
    what the steps leave) [m], ``impact_severity`` (1/2 m (v sin angle)^2) [J], ``delta_v`` (greatest change
    of velocity) [m/s]; where the motion towards the barrier ends: ``time_of_zero_velocity`` (since the first
    touch) [s], ``restitution`` (normal separation over approach speed); where the vehicle has left:
    ``exit_angle`` (of its path from the barrier's line) [deg].

    With a barrier that is not met along its line (angles 0 and 180): ``vehicle_penetration`` [m], how far
    the rigid body got past the barrier's line: the greatest distance of any anchor behind the line over the
    run, at the output instants, 0 if none passed it. The line is the foot of the traffic face of walls and
    Jersey barriers and runs through the axes of posts (of the first row). An anchor is where the rigid body
    begins behind the crush zone; crushed skin in front of it does not count. A body beside the end of a
    barrier counts like one that went through. ASTM F2656 counts otherwise: a stated point of the vehicle
    (of trucks the lower leading edge of the cargo bed) from the barrier's protected side.

    With a free-standing barrier: ``barrier_deflection`` and ``residual_barrier_deflection`` (how far the
    furthest corner of any segment's base moved square to the line, away from the traffic, during the run and
    at its end) [m]; where there is gravity ``max_overturning_ratio`` (greatest of
    :attr:`birm3d.Result.overturning_ratio`: above 1 a segment would begin to tip, which is left out).

    With two units: ``max_articulation_angle`` (greatest magnitude) [deg], ``peak_joint_force`` (greatest
    magnitude) [N]. Scalars of motion are those of the leading unit, crushes the greatest of both.

    At sampling rates that allow it: ``peak_deceleration_cfc60``, ``peak_normal_force_cfc60``.

    Raises
    ------
    ValueError
        If the run is shorter than the output interval.
    """
    scene, statistics = result.scene, result.statistics
    interval = scene.settings.output_interval
    if len(result.time) < 2:
        raise ValueError(f"output_interval must be shorter than the run for metrics, got {interval} s")
    deceleration = -result.acceleration[:, 0]
    energy = result.energy
    scale = max(float(energy["kinetic"][0]), 0.5 * scene.vehicle.mass * _STANDSTILL**2)
    metrics = {
        "peak_deceleration": float(deceleration.max()),
        "max_roll": float(np.abs(result.roll).max()),
        "max_pitch": float(np.abs(result.pitch).max()),
        "max_yaw": float(np.abs(result.yaw).max()),
        "exit_speed": float(np.hypot(*result.final_velocity[:2])),
        "energy_residual": float(np.abs(energy["residual"]).max() / scale),
        "momentum_residual": result.momentum_residual,
        "steps": float(statistics.steps),
        "run_time": result.run_time,
        "end_time": float(result.time[-1]),
    }
    if scene.settings.ground and len(scene.vehicle.wheels):
        metrics["wheel_climb"] = _wheel_climb(result)
    filtered = interval * 60.0 <= 0.1
    if filtered and (names is None or "peak_deceleration_cfc60" in names):
        metrics["peak_deceleration_cfc60"] = float(cfc(deceleration, 60, interval).max())
    if scene.vehicle.joint is not None:
        metrics["max_articulation_angle"] = float(np.abs(result.articulation_angle).max())
        metrics["peak_joint_force"] = float(np.linalg.norm(result.joint_force, axis=1).max())
    if scene.barrier is None:
        return metrics

    force = result.barrier_normal_force
    metrics["peak_normal_force"] = float(force.max())
    if filtered and (names is None or "peak_normal_force_cfc60" in names):
        metrics["peak_normal_force_cfc60"] = float(cfc(force, 60, interval).max())
    metrics["peak_force_50ms"] = float(moving_average(force, 0.05, interval).max())
    loads = touched_elements(result)
    for metric, value in (
        ("peak_element_force", "peak_force"),
        ("peak_element_force_50ms", "peak_force_50ms"),
        ("peak_overturning_moment", "peak_overturning_moment"),
        ("peak_overturning_moment_50ms", "peak_overturning_moment_50ms"),
    ):
        metrics[metric] = max((getattr(load, value) for load in loads), default=0.0)
    metrics["dynamic_crush"] = _greatest(result, "peak_deflection")
    metrics["residual_crush"] = max(0.0, _greatest(result, "deflection"))
    metrics["contact_overlap"] = statistics.deepest_point
    if scene.barrier.core.segments:
        movement = lateral_movement(result)
        metrics["barrier_deflection"] = float(movement.max())
        metrics["residual_barrier_deflection"] = float(movement[-1])
        if scene.settings.gravity > 0.0:
            metrics["max_overturning_ratio"] = float(result.overturning_ratio.max())
    past = -np.asarray(scene.barrier.core.normal)
    along = abs(math.sin(math.radians(scene.impact_angle))) < _ALONG
    if not along and (names is None or "vehicle_penetration" in names):
        metrics["vehicle_penetration"] = _penetration(result, past)
    path = result.velocity[0] / max(float(np.linalg.norm(result.velocity[0])), _SLOWEST)
    metrics.update(_motion(result, path if along else past, past))
    return metrics


def _wheel_climb(result: Result) -> float:
    """Greatest height of any wheel's lowest point above the ground at the output instants [m]."""
    greatest = 0.0
    for u, unit in enumerate(result.scene.vehicle.units):
        rows = result._history.unit(u)
        roll, pitch, _ = rows.roll_pitch_yaw.T
        # World up in body axes, the last row of R = Rz(yaw) Ry(pitch) Rx(roll).
        up = np.stack([-np.sin(pitch), np.cos(pitch) * np.sin(roll), np.cos(pitch) * np.cos(roll)])
        upright = np.sqrt(1.0 - up[1] ** 2)  # of the radius, as the axle turns out of the level
        for x, y, z, radius in unit.wheels:
            height = rows.position[:, 2] + np.array([x, y, z]) @ up - radius * upright
            greatest = max(greatest, float(height.max()))
    return greatest


def _penetration(result: Result, past: npt.NDArray[np.float64]) -> float:
    """Greatest distance of an anchor past the barrier's line [m], see compute_metrics()."""
    barrier, vehicle = result.scene.barrier, result.scene.vehicle
    assert barrier is not None  # asked for with a barrier only
    greatest = 0.0
    for u, unit in enumerate(vehicle.units):
        rows = result._history.unit(u)
        anchors = unit.anchors[unit.wheel_of_node < 0]
        center = (rows.position - np.asarray(barrier.origin)) @ past
        # No anchor is further past the line than this.
        near = np.flatnonzero(center + np.linalg.norm(anchors, axis=1).max() > greatest)
        roll, pitch, yaw = rows.roll_pitch_yaw[near].T
        # The direction in body axes: R^T past, with R = Rz(yaw) Ry(pitch) Rx(roll) and past level.
        ahead = np.cos(yaw) * past[0] + np.sin(yaw) * past[1]
        left = np.cos(yaw) * past[1] - np.sin(yaw) * past[0]
        up = np.sin(pitch) * ahead
        direction = np.stack(
            [
                np.cos(pitch) * ahead,
                np.cos(roll) * left + np.sin(roll) * up,
                np.cos(roll) * up - np.sin(roll) * left,
            ]
        )
        reach = center[near] + (anchors @ direction).max(axis=0)
        greatest = max(greatest, float(reach.max(initial=0.0)))
    return greatest


def _greatest(result: Result, name: str) -> float:
    """Greatest deflection of all units [m]."""
    units = range(len(result.scene.vehicle.units))
    return max(float(getattr(result.unit(u), name).max()) for u in units)


def _motion(
    result: Result, inward: npt.NDArray[np.float64], past: npt.NDArray[np.float64]
) -> dict[str, float]:
    """Scalars of the motion towards the barrier along `inward`; `past` is square to its line."""
    scene = result.scene
    approach = result.velocity @ inward
    travel = (result.position - result.position[0]) @ inward - scene.standoff
    velocity_change = np.linalg.norm(result.velocity - result.velocity[0], axis=1)
    angle = math.radians(scene.impact_angle)
    motion = {
        "max_displacement": float(travel.max()),
        "impact_severity": 0.5 * scene.vehicle.mass * (scene.impact_speed * math.sin(angle)) ** 2,
        "delta_v": float(velocity_change.max()),
    }
    touched = _greatest(result, "peak_deflection") > 0.0
    turned = np.flatnonzero(approach <= 0.0)
    if touched and len(turned) and turned[0] > 0:
        i = int(turned[0])
        share = approach[i - 1] / (approach[i - 1] - approach[i])
        first_touch = scene.standoff / approach[0]
        interval = result.time[i] - result.time[i - 1]
        motion["time_of_zero_velocity"] = float(result.time[i - 1] + share * interval - first_touch)
        motion["restitution"] = float(max(0.0, -(result.final_velocity @ inward)) / approach[0])
    horizontal = result.final_velocity[:2]
    speed = float(np.hypot(*horizontal))
    away = float(-(result.final_velocity @ past))
    if touched and speed > _SLOWEST and away > 0.0 and result.barrier_normal_force[-1] == 0.0:
        along = float(np.hypot(*(horizontal + away * past[:2])))
        motion["exit_angle"] = math.degrees(math.atan2(away, along))
    return motion
