"""Scalars of a run.

Each is made in one place, of the end of the run and of the extremes that the core finds in its histories.
So a run of which no histories are kept has the same scalars, bit for bit.

Forces and accelerations are taken from the interval means of the result. Filtered values use the channel
frequency class in their name (SAE J211-1). A scalar that a scene does not have (a crush without a barrier, an
exit angle of a vehicle that rests) is absent, never NaN.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from functools import cached_property, lru_cache, partial
from itertools import repeat
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .. import _core
from ..base.arguments import checked
from ..scene.scene import Scene
from .record import RunRecord
from .stored import Stored

__all__ = [
    "ALONG_LINE",
    "JOINT_METRICS",
    "METRIC_UNITS",
    "SEGMENT_METRICS",
    "compute_metrics",
    "energy_residual",
    "extremes_for",
    "values_of_outcome",
]

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
        "time_of_separation": "s",
        "restitution": "",
        "delta_v": "m/s",
        "impact_severity": "J",
        "exit_speed": "m/s",
        "exit_angle": "deg",
        "max_roll": "deg",
        "max_pitch": "deg",
        "max_yaw": "deg",
        "later_contacts": "",
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
_Vector = tuple[float, float, float]
_Function = Callable[["_Run"], float | None]  # None: the run does not have it

# Below this speed a direction of travel means nothing, m/s.
_SLOWEST = 1e-3
ALONG_LINE = _core.along_line
"""Below this sine of its angle a path runs along the barrier's line."""
# Residuals of a vehicle that stands are judged against the energy it has at this speed, m/s.
_STANDSTILL = 0.1


@checked
def compute_metrics(result: RunRecord, names: Collection[str] | None = None) -> dict[str, float]:
    """Return the scalars of a run, SI units and degrees: all that it has, or those among `names`.

    Always: ``peak_deceleration`` (along r, unfiltered) [m/s^2], ``max_roll``, ``max_pitch``, ``max_yaw``
    (greatest magnitudes, of yaw until separation) [deg],
    ``energy_residual`` (greatest magnitude relative to the initial kinetic energy), ``momentum_residual``,
    ``steps``, ``run_time`` [s], ``end_time`` [s].

    With wheels and a ground: ``wheel_climb`` (greatest height of any wheel's lowest point above it) [m].

    With a barrier: ``peak_normal_force``, and ``peak_force_50ms`` of its mean over 50 ms: component of the
    barrier's total force on the vehicle along the barrier's normal, compression positive [N] (see
    :attr:`birm3d.Result.barrier_normal_force`); greatest magnitude of the force vector on any element:
    ``peak_element_force``, ``peak_element_force_50ms`` [N], ``peak_overturning_moment`` and
    ``peak_overturning_moment_50ms`` [N m] (see :class:`birm3d.result.element_loads.ElementLoad`);
    ``dynamic_crush``, ``residual_crush`` (greatest truss shortening, also of tyres, during the run, and when
    the vehicle had left or else at the end) [m],
    ``max_displacement`` (of the mass centre towards the barrier since t = 0 less the standoff; on a path
    along the barrier's line, towards its end) [m], ``contact_overlap`` (by which the rigid body and the
    barrier overlapped, see :class:`birm3d.OverlapWarning`) [m], ``impact_severity`` (1/2 m (v sin angle)^2)
    [J], ``delta_v`` (greatest change of velocity, until separation) [m/s], ``later_contacts`` (number of
    contacts that began after the vehicle had left for good: a second event, which changes none of the values
    at separation); where the motion towards the barrier ends: ``time_of_zero_velocity`` (since the first
    touch) [s], and ``restitution`` (normal separation over approach speed; 0 of a vehicle that rests at the
    barrier).

    Where the vehicle leaves for good: ``time_of_separation`` (since t = 0), the last loss of contact before
    that, so a blow of the rear belongs to the event [s]; at that instant ``exit_speed`` (of the mass centre
    along the ground) [m/s], and of a vehicle that is contained ``exit_angle`` (of its path from the barrier's
    line, positive away from it) [deg]. These do not depend on the duration, once it is long enough.
    ``max_roll`` and ``max_pitch`` count over the whole run: a vehicle may roll over after it has left.

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

    A result that was read from a file has the scalars that it was saved with.

    Raises
    ------
    ValueError
        If the run is shorter than the output interval.
    """
    _require_rows(result.scene, len(result.time))
    if not isinstance(result._history, _core.History):
        saved = result.saved_metrics or {}
        return {name: saved[name] for name in saved if names is None or name in names}
    wanted = tuple(_METRICS) if names is None else names
    return _found(_Run(result.scene, _ResultOutcome(result, result._extremes(extremes_for(wanted)))), wanted)


def values_of_outcome(scene: Scene, outcome: _core.Outcome, names: tuple[str, ...]) -> tuple[float, ...]:
    """Return what :func:`compute_metrics` would, of a run without histories with :func:`extremes_for`.

    In the order of the names, and NaN where the run has none.

    Raises
    ------
    ArithmeticError
        If a metric is not a number.
    """
    _require_rows(scene, outcome.extremes.rows)
    found = _found(_Run(scene, outcome), names)
    if math.isnan(sum(found.values())):  # or infinite both ways
        for name, value in found.items():
            if math.isnan(value):
                raise ArithmeticError(f"{name} is not a number")
    return tuple(map(found.get, names, repeat(math.nan)))


def extremes_for(names: Collection[str]) -> _core.ExtremeGroups:
    """Return the groups of extremes that metrics are made of."""
    needs = {_METRICS[name].needs for name in names} - {"end"}
    return _core.ExtremeGroups(**dict.fromkeys(needs, True))


def _require_rows(scene: Scene, rows: int) -> None:
    if rows < 2:
        interval = scene.settings.output_interval
        raise ValueError(f"output_interval must be shorter than the run for metrics, got {interval} s")


def _found(run: _Run, names: Collection[str]) -> dict[str, float]:
    found = {}
    for name, value_of in _functions(tuple(names), run.barrier is not None):
        value = value_of(run)
        if value is not None:
            found[name] = value
    return found


@lru_cache(maxsize=16)
def _functions(names: tuple[str, ...], with_barrier: bool) -> tuple[tuple[str, _Function], ...]:
    wanted = ((name, _METRICS[name]) for name in names)
    return tuple((name, metric.of) for name, metric in wanted if with_barrier or not metric.of_barrier)


class _ResultOutcome:
    """What a result has in common with the outcome of a run without histories."""

    def __init__(self, result: RunRecord, extremes: _core.Extremes) -> None:
        self.extremes = extremes
        x, y, z = result.final_velocity.tolist()
        self.final_velocity: _Vector = (x, y, z)
        assert isinstance(result._event, _core.Event)
        self.event: _core.Event = result._event
        self.statistics: _core.StepStatistics | Stored = result.statistics
        self.run_time = result.run_time
        self._result = result

    @cached_property
    def deflection(self) -> float:
        return _greatest(self._result, "deflection")

    @cached_property
    def peak_deflection(self) -> float:
        return _greatest(self._result, "peak_deflection")


class _Run:
    """What several metrics of a run share. What the core has found is taken from it once, when asked for."""

    normal_force: _core.ExtremeNormalForce
    motion: _core.ExtremeMotion
    attitude: _core.ExtremeAttitude
    energy: _core.ExtremeEnergy
    filtered_force: _core.ExtremeFilteredForce
    element_loads: _core.ExtremeElementLoads

    def __init__(self, scene: Scene, outcome: _core.Outcome | _ResultOutcome) -> None:
        self.scene = scene
        self.outcome = outcome
        self.extremes = outcome.extremes
        self.event = outcome.event
        self.statistics = outcome.statistics
        self.barrier = scene.barrier

    def __getattr__(self, group: str) -> Any:
        found = getattr(self.extremes, group)
        setattr(self, group, found)
        return found

    @property
    def joined(self) -> bool:
        return self.scene.vehicle.joint is not None

    @cached_property
    def segments(self) -> bool:
        return self.barrier is not None and bool(self.barrier.core.segments)

    @property
    def along(self) -> bool:
        return abs(math.sin(math.radians(self.scene.impact_angle))) < ALONG_LINE

    @property
    def dynamic_crush(self) -> float:
        return self.outcome.peak_deflection

    @property
    def turn_time(self) -> float | None:
        """When the motion towards the barrier ends [s], if it began and anything was crushed."""
        began = self.dynamic_crush > 0.0 and self.motion.approach_speed > 0.0
        return self.motion.turn_time if began else None

    @property
    def residual_crush(self) -> float:
        """When the vehicle had left; of one that has not, at the end."""
        left = self.event.exit_deflection
        return max(0.0, self.outcome.deflection if left is None else left)


def energy_residual(scene: Scene, energy: _core.ExtremeEnergy) -> float:
    """Greatest residual of the energy ledger, relative to the initial kinetic energy."""
    return relative_to_start(scene, energy.residual, energy.start)


def relative_to_start(scene: Scene, energy: float, start: float) -> float:
    """Return an energy relative to that at the start, which counts as no less than that of a standstill."""
    return energy / max(start, 0.5 * scene.vehicle.mass * _STANDSTILL**2)


def _of_segments(metric: _Function) -> _Function:
    return lambda run: metric(run) if run.segments else None


def _of_joint(metric: _Function) -> _Function:
    return lambda run: metric(run) if run.joined else None


def _impact_severity(run: _Run) -> float:
    angle = math.radians(run.scene.impact_angle)
    return 0.5 * run.scene.vehicle.mass * (run.scene.impact_speed * math.sin(angle)) ** 2


def _dot(a: _Vector, b: _Vector) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _time_of_zero_velocity(run: _Run) -> float | None:
    if run.turn_time is None:
        return None
    return run.turn_time - run.scene.standoff / run.motion.approach_speed


def _restitution(run: _Run) -> float | None:
    if run.turn_time is None:
        return None
    velocity = run.event.exit_velocity
    if velocity is None:
        return 0.0 if run.event.manner == "rests" else None
    return max(0.0, -_dot(velocity, run.motion.towards)) / run.motion.approach_speed


def _exit_speed(run: _Run) -> float | None:
    velocity = run.event.exit_velocity
    return None if velocity is None else math.hypot(*velocity[:2])


def _exit_angle(run: _Run) -> float | None:
    assert run.barrier is not None
    velocity, past = run.event.exit_velocity, run.barrier._past
    contained = run.event.manner in ("rebounds", "leaves", "slides_to_end", "slides_on")
    if velocity is None or not contained or math.hypot(*velocity[:2]) < _SLOWEST:
        return None
    away = -_dot(velocity, past)
    along = math.hypot(velocity[0] + away * past[0], velocity[1] + away * past[1])
    return math.degrees(math.atan2(away, along))


def _contact_overlap(run: _Run) -> float:
    statistics = run.statistics
    return max(statistics.deepest_point, statistics.greatest_overlap)


def _max_overturning_ratio(run: _Run) -> float | None:
    gravity = run.scene.settings.gravity
    return run.extremes.segments.overturning / gravity if gravity > 0.0 else None


def _wheel_climb(run: _Run) -> float | None:
    """Greatest height of any wheel's lowest point above the ground at the output instants [m]."""
    if not run.scene.settings.ground or not len(run.scene.vehicle.wheels):
        return None
    return run.extremes.wheel_climb


def _vehicle_penetration(run: _Run) -> float | None:
    """Greatest distance of an anchor past the barrier's line [m], see compute_metrics()."""
    return None if run.along else run.extremes.penetration


def _greatest(result: RunRecord, name: str) -> float:
    """Greatest deflection of all units [m]."""
    units = range(len(result.scene.vehicle.units))
    return max(float(getattr(result.unit(u), name).max()) for u in units)


class _Metric(NamedTuple):
    needs: str  # the group of extremes that it is made of; "end": none
    of: _Function
    of_barrier: bool = False  # only a run with a barrier has it


def _all_metrics() -> dict[str, _Metric]:
    end, normal_force, motion, attitude, energy, filtered_force, filtered_deceleration = (
        partial(_Metric, needs)
        for needs in (
            *("end", "normal_force", "motion", "attitude", "energy"),
            *("filtered_force", "filtered_deceleration"),
        )
    )
    penetration, wheel_climb, element_loads, momentum, joint, segments = (
        partial(_Metric, needs)
        for needs in ("penetration", "wheel_climb", "element_loads", "momentum", "joint", "segments")
    )
    return {
        "peak_deceleration": motion(lambda run: run.motion.deceleration),
        "peak_deceleration_cfc60": filtered_deceleration(lambda run: run.extremes.filtered_deceleration),
        "peak_normal_force": normal_force(lambda run: run.normal_force.peak, of_barrier=True),
        "peak_normal_force_cfc60": filtered_force(lambda run: run.filtered_force.cfc60, of_barrier=True),
        "peak_force_50ms": filtered_force(lambda run: run.filtered_force.mean_50ms, of_barrier=True),
        "peak_element_force": element_loads(lambda run: run.element_loads.force, of_barrier=True),
        "peak_element_force_50ms": element_loads(lambda run: run.element_loads.force_50ms, of_barrier=True),
        "peak_overturning_moment": element_loads(lambda run: run.element_loads.moment, of_barrier=True),
        "peak_overturning_moment_50ms": element_loads(
            lambda run: run.element_loads.moment_50ms, of_barrier=True
        ),
        "dynamic_crush": end(lambda run: run.dynamic_crush, of_barrier=True),
        "residual_crush": end(lambda run: run.residual_crush, of_barrier=True),
        "max_displacement": motion(lambda run: run.motion.way - run.scene.standoff, of_barrier=True),
        "vehicle_penetration": penetration(_vehicle_penetration, of_barrier=True),
        "contact_overlap": end(_contact_overlap, of_barrier=True),
        "barrier_deflection": segments(_of_segments(lambda run: run.extremes.segments.deflection)),
        "residual_barrier_deflection": segments(
            _of_segments(lambda run: run.extremes.segments.residual_deflection)
        ),
        "max_overturning_ratio": segments(_of_segments(_max_overturning_ratio)),
        "time_of_zero_velocity": motion(_time_of_zero_velocity, of_barrier=True),
        "time_of_separation": end(lambda run: run.event.time_of_separation, of_barrier=True),
        "restitution": motion(_restitution, of_barrier=True),
        "delta_v": motion(lambda run: run.motion.velocity_change, of_barrier=True),
        "impact_severity": end(_impact_severity, of_barrier=True),
        "exit_speed": end(_exit_speed, of_barrier=True),
        "exit_angle": end(_exit_angle, of_barrier=True),
        "max_roll": attitude(lambda run: math.degrees(run.attitude.roll)),
        "max_pitch": attitude(lambda run: math.degrees(run.attitude.pitch)),
        "max_yaw": attitude(lambda run: math.degrees(run.attitude.yaw)),
        "later_contacts": end(lambda run: float(run.event.later_contacts), of_barrier=True),
        "wheel_climb": wheel_climb(_wheel_climb),
        "max_articulation_angle": joint(_of_joint(lambda run: math.degrees(run.extremes.joint.angle))),
        "peak_joint_force": joint(_of_joint(lambda run: run.extremes.joint.force)),
        "energy_residual": energy(lambda run: energy_residual(run.scene, run.energy)),
        "momentum_residual": momentum(lambda run: run.extremes.momentum_residual),
        "steps": end(lambda run: float(run.statistics.steps)),
        "run_time": end(lambda run: run.outcome.run_time),
        "end_time": end(lambda run: run.extremes.end_time),
    }


_METRICS = MappingProxyType(_all_metrics())
