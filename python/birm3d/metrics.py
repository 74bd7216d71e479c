"""Scalars of a run.

Forces and accelerations are taken from the interval means of the result. Filtered values use the channel
frequency class in their name (SAE J211-1). A scalar that a scene does not have (a crush without a barrier, an
exit angle of a vehicle that stands) is absent, never NaN.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from .element_loads import ElementLoad, touched_elements
from .filters import cfc, moving_average
from .free_standing import lateral_movement

if TYPE_CHECKING:
    from .result import Result

__all__ = ["JOINT_METRICS", "METRIC_UNITS", "SEGMENT_METRICS", "compute_metrics", "energy_residual"]

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

Floats = npt.NDArray[np.float64]
_Metric = Callable[["_Run"], float | None]  # None: the run does not have it

# Below this speed a direction of travel means nothing, m/s.
_SLOWEST = 1e-3
# Below this sine of its angle a path runs along the barrier's line.
_ALONG = 1e-9
# Residuals of a vehicle that stands are judged against the energy it has at this speed, m/s.
_STANDSTILL = 0.1


def compute_metrics(result: Result, names: Collection[str] | None = None) -> dict[str, float]:
    """Return the scalars of a run, SI units and degrees: all that it has, or those among `names`.

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
    interval = result.scene.settings.output_interval
    if len(result.time) < 2:
        raise ValueError(f"output_interval must be shorter than the run for metrics, got {interval} s")
    run = _Run(result)
    found = {name: metric(run) for name, metric in _METRICS.items() if names is None or name in names}
    return {name: value for name, value in found.items() if value is not None}


class _Run:
    """What several metrics of a result share, each computed when it is first asked for."""

    def __init__(self, result: Result) -> None:
        self.result = result
        self.scene = result.scene
        self.interval = result.scene.settings.output_interval
        self.barrier = result.scene.barrier
        self.joined = result.scene.vehicle.joint is not None
        self.segments = self.barrier is not None and bool(self.barrier.core.segments)
        self.filtered = self.interval * 60.0 <= 0.1
        self.along = abs(math.sin(math.radians(self.scene.impact_angle))) < _ALONG

    @property
    def deceleration(self) -> Floats:
        """Along r [m/s^2]."""
        return -self.result.acceleration[:, 0]

    @property
    def past(self) -> Floats:
        """Square to the barrier's line, into it."""
        assert self.barrier is not None
        return -np.asarray(self.barrier.core.normal)

    @property
    def inward(self) -> Floats:
        """The direction towards the barrier; of a path along its line that of the path."""
        if not self.along:
            return self.past
        start = self.result.velocity[0]
        return np.asarray(start / max(float(np.linalg.norm(start)), _SLOWEST))

    @cached_property
    def loads(self) -> list[ElementLoad]:
        return list(touched_elements(self.result))

    @cached_property
    def dynamic_crush(self) -> float:
        return _greatest(self.result, "peak_deflection")

    @cached_property
    def turn(self) -> tuple[int, float, float] | None:
        """Where the motion towards the barrier ends: row before, share of the interval, speed of approach."""
        approach = self.result.velocity @ self.inward
        turned = np.flatnonzero(approach <= 0.0)
        if not self.dynamic_crush > 0.0 or not len(turned) or turned[0] == 0:
            return None
        i = int(turned[0])
        return i - 1, float(approach[i - 1] / (approach[i - 1] - approach[i])), float(approach[0])

    @cached_property
    def movement(self) -> Floats:
        return lateral_movement(self.result)

    def greatest_load(self, name: str) -> float | None:
        if self.barrier is None:
            return None
        return max((getattr(load, name) for load in self.loads), default=0.0)


def energy_residual(result: Result) -> float:
    """Greatest residual of the energy ledger, relative to the initial kinetic energy."""
    energy = result.energy
    scale = max(float(energy["kinetic"][0]), 0.5 * result.scene.vehicle.mass * _STANDSTILL**2)
    return float(np.abs(energy["residual"]).max() / scale)


def _cfc60(run: _Run, values: Floats) -> float | None:
    return float(cfc(values, 60, run.interval).max()) if run.filtered else None


def _of_force(metric: Callable[[_Run, Floats], float | None]) -> _Metric:
    """Of the history of the normal force."""
    return lambda run: None if run.barrier is None else metric(run, run.result.barrier_normal_force)


def _of_barrier(metric: _Metric) -> _Metric:
    return lambda run: None if run.barrier is None else metric(run)


def _of_segments(metric: _Metric) -> _Metric:
    return lambda run: metric(run) if run.segments else None


def _of_joint(metric: _Metric) -> _Metric:
    return lambda run: metric(run) if run.joined else None


def _max_displacement(run: _Run) -> float:
    position = run.result.position
    return float(((position - position[0]) @ run.inward - run.scene.standoff).max())


def _impact_severity(run: _Run) -> float:
    angle = math.radians(run.scene.impact_angle)
    return 0.5 * run.scene.vehicle.mass * (run.scene.impact_speed * math.sin(angle)) ** 2


def _delta_v(run: _Run) -> float:
    return float(np.linalg.norm(run.result.velocity - run.result.velocity[0], axis=1).max())


def _time_of_zero_velocity(run: _Run) -> float | None:
    if run.turn is None:
        return None
    row, share, approach = run.turn
    time = run.result.time
    return float(time[row] + share * (time[row + 1] - time[row]) - run.scene.standoff / approach)


def _restitution(run: _Run) -> float | None:
    if run.turn is None:
        return None
    return max(0.0, -float(run.result.final_velocity @ run.inward)) / run.turn[2]


def _exit_angle(run: _Run) -> float | None:
    velocity, past = run.result.final_velocity, run.past
    speed, away = float(np.hypot(*velocity[:2])), float(-(velocity @ past))
    left = speed > _SLOWEST and away > 0.0 and run.result.barrier_normal_force[-1] == 0.0
    if not left or not run.dynamic_crush > 0.0:
        return None
    along = float(np.hypot(*(velocity[:2] + away * past[:2])))
    return math.degrees(math.atan2(away, along))


def _max_overturning_ratio(run: _Run) -> float | None:
    return float(run.result.overturning_ratio.max()) if run.scene.settings.gravity > 0.0 else None


def _wheel_climb(run: _Run) -> float | None:
    """Greatest height of any wheel's lowest point above the ground at the output instants [m]."""
    if not run.scene.settings.ground or not len(run.scene.vehicle.wheels):
        return None
    greatest = 0.0
    for u, unit in enumerate(run.scene.vehicle.units):
        rows = run.result._history.unit(u)
        roll, pitch, _ = rows.roll_pitch_yaw.T
        # World up in body axes, the last row of R = Rz(yaw) Ry(pitch) Rx(roll).
        up = np.stack([-np.sin(pitch), np.cos(pitch) * np.sin(roll), np.cos(pitch) * np.cos(roll)])
        upright = np.sqrt(1.0 - up[1] ** 2)  # of the radius, as the axle turns out of the level
        for x, y, z, radius in unit.wheels:
            height = rows.position[:, 2] + np.array([x, y, z]) @ up - radius * upright
            greatest = max(greatest, float(height.max()))
    return greatest


def _vehicle_penetration(run: _Run) -> float | None:
    """Greatest distance of an anchor past the barrier's line [m], see compute_metrics()."""
    if run.barrier is None or run.along:
        return None
    result, past, origin = run.result, run.past, np.asarray(run.barrier.origin)
    greatest = 0.0
    for u, unit in enumerate(run.scene.vehicle.units):
        rows = result._history.unit(u)
        anchors = unit.anchors[unit.wheel_of_node < 0]
        center = (rows.position - origin) @ past
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


def _all_metrics() -> dict[str, _Metric]:
    return {
        "peak_deceleration": lambda run: float(run.deceleration.max()),
        "peak_deceleration_cfc60": lambda run: _cfc60(run, run.deceleration),
        "peak_normal_force": _of_force(lambda run, force: float(force.max())),
        "peak_normal_force_cfc60": _of_force(_cfc60),
        "peak_force_50ms": _of_force(
            lambda run, force: float(moving_average(force, 0.05, run.interval).max())
        ),
        "peak_element_force": lambda run: run.greatest_load("peak_force"),
        "peak_element_force_50ms": lambda run: run.greatest_load("peak_force_50ms"),
        "peak_overturning_moment": lambda run: run.greatest_load("peak_overturning_moment"),
        "peak_overturning_moment_50ms": lambda run: run.greatest_load("peak_overturning_moment_50ms"),
        "dynamic_crush": _of_barrier(lambda run: run.dynamic_crush),
        "residual_crush": _of_barrier(lambda run: max(0.0, _greatest(run.result, "deflection"))),
        "max_displacement": _of_barrier(_max_displacement),
        "vehicle_penetration": _vehicle_penetration,
        "contact_overlap": _of_barrier(lambda run: run.result.statistics.deepest_point),
        "barrier_deflection": _of_segments(lambda run: float(run.movement.max())),
        "residual_barrier_deflection": _of_segments(lambda run: float(run.movement[-1])),
        "max_overturning_ratio": _of_segments(_max_overturning_ratio),
        "time_of_zero_velocity": _of_barrier(_time_of_zero_velocity),
        "restitution": _of_barrier(_restitution),
        "delta_v": _of_barrier(_delta_v),
        "impact_severity": _of_barrier(_impact_severity),
        "exit_speed": lambda run: float(np.hypot(*run.result.final_velocity[:2])),
        "exit_angle": _of_barrier(_exit_angle),
        "max_roll": lambda run: float(np.abs(run.result.roll).max()),
        "max_pitch": lambda run: float(np.abs(run.result.pitch).max()),
        "max_yaw": lambda run: float(np.abs(run.result.yaw).max()),
        "wheel_climb": _wheel_climb,
        "max_articulation_angle": _of_joint(lambda run: float(np.abs(run.result.articulation_angle).max())),
        "peak_joint_force": _of_joint(
            lambda run: float(np.linalg.norm(run.result.joint_force, axis=1).max())
        ),
        "energy_residual": lambda run: energy_residual(run.result),
        "momentum_residual": lambda run: run.result.momentum_residual,
        "steps": lambda run: float(run.result.statistics.steps),
        "run_time": lambda run: run.result.run_time,
        "end_time": lambda run: float(run.result.time[-1]),
    }


_METRICS = MappingProxyType(_all_metrics())
