"""The scalars of runs, one row each: name, units, meaning, what it is made of, and how tables show it.

Reports, tables, studies, error measures, the command line and the documentation take all of it from here.
Rows of loads and of crush stand in files of their own.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType

from . import metric_functions as made
from .crush_metrics import CRUSH_METRICS
from .load_metrics import LOAD_METRICS
from .metric import GROUPS, Metric, Shown, asked, metres
from .run_values import energy_residual

__all__ = ["GROUPS", "METRICS", "Metric", "Shown"]

_MOTION_METRICS: Mapping[str, Metric] = {
    "time_of_zero_velocity": Metric(
        unit="s",
        group="turn",
        meaning="when the motion towards the barrier ends, since the first touch",
        needs="motion",
        value=made.time_of_zero_velocity,
        shown=Shown("time of zero normal velocity", ".1f", "ms", 1e-3),
    ),
    "time_of_separation": Metric(
        unit="s",
        group="departure",
        meaning="when a vehicle that leaves for good loses contact for the last time before that, since "
        "t = 0; so a blow of the rear belongs to the event",
        needs="end",
        value=lambda run: run.event.time_of_separation,
        shown=Shown("time of separation", ".1f", "ms", 1e-3),
    ),
    "restitution": Metric(
        unit="",
        group="departure",
        meaning="normal separation over approach speed; 0 of a vehicle that rests at the barrier",
        needs="motion",
        value=made.restitution,
        shown=Shown("restitution along the normal", ".2f"),
    ),
    "delta_v": Metric(
        unit="m/s",
        group="motion",
        meaning="greatest change of velocity, until separation",
        needs="motion",
        value=lambda run: run.motion.velocity_change,
        shown=Shown("greatest change of velocity", ".2f", "m/s", headline=True),
    ),
    "impact_severity": Metric(
        unit="J",
        group="motion",
        meaning="1/2 m (v sin angle)^2",
        needs="end",
        value=made.impact_severity,
        shown=asked("impact severity, m (v sin angle)² / 2", "kJ", 1e3),
    ),
    "exit_speed": Metric(
        unit="m/s",
        group="departure",
        meaning="speed of the mass centre along the ground at separation",
        needs="end",
        value=made.exit_speed,
        shown=Shown("exit speed", ".2f", "m/s", headline=True),
    ),
    "exit_angle": Metric(
        unit="deg",
        group="departure",
        meaning="angle of the path of a vehicle that is contained, from the barrier's line, positive away "
        "from it, at separation; negative where the mass centre still nears the line then, and tyres turn it "
        "away later",
        needs="end",
        value=made.exit_angle,
        shown=Shown("exit angle from the barrier's line", ".1f", "deg", headline=True),
    ),
    "max_roll": Metric(
        unit="deg",
        group="attitude",
        meaning="greatest magnitude of roll over the whole run: a vehicle may roll over after it has left",
        needs="attitude",
        value=lambda run: math.degrees(run.attitude.roll),
        of="run",
        shown=Shown("greatest roll", ".1f", "deg", headline=True),
    ),
    "max_pitch": Metric(
        unit="deg",
        group="attitude",
        meaning="greatest magnitude of pitch over the whole run",
        needs="attitude",
        value=lambda run: math.degrees(run.attitude.pitch),
        of="run",
        shown=Shown("greatest pitch", ".1f", "deg"),
    ),
    "max_yaw": Metric(
        unit="deg",
        group="attitude",
        meaning="greatest magnitude of yaw until separation",
        needs="attitude",
        value=lambda run: math.degrees(run.attitude.yaw),
        of="run",
        shown=Shown("greatest yaw", ".1f", "deg"),
    ),
    "later_contacts": Metric(
        unit="",
        group="later",
        meaning="how often the vehicle touched the barrier again after the values at separation were taken: "
        "these contacts change none of them",
        needs="end",
        value=lambda run: float(run.event.later_contacts),
        shown=Shown(
            "contacts after the values at separation",
            ".0f",
            counted="a contact after the values at separation",
        ),
    ),
    "wheel_climb": Metric(
        unit="m",
        group="attitude",
        meaning="greatest height of any wheel's lowest point above the ground; sprung wheels count as "
        "extended",
        needs="wheel_climb",
        value=made.wheel_climb,
        of="run",
        shown=asked("greatest height of a wheel above the ground", "m"),
    ),
    "max_articulation_angle": Metric(
        unit="deg",
        group="joint",
        meaning="greatest magnitude of the angle between two units",
        needs="joint",
        value=lambda run: math.degrees(run.extremes.joint.angle),
        of="joint",
        shown=asked("greatest angle between the units", "deg"),
    ),
    "peak_joint_force_50ms": Metric(
        unit="N",
        group="joint",
        meaning="greatest magnitude of the mean over 50 ms of the force between two units",
        needs="joint",
        value=lambda run: run.extremes.joint.force_50ms,
        of="joint",
        shown=asked("peak 50-ms force of the joint", "kN", 1e3),
    ),
    "bed_slip": Metric(
        unit="m",
        group="joint",
        meaning="greatest distance that a load bed slid along its frame",
        needs="joint",
        value=lambda run: run.extremes.joint.slip,
        of="sliding",
        shown=metres("greatest slip of the load bed", headline=True),
    ),
}

_RUN_METRICS: Mapping[str, Metric] = {
    "energy_residual": Metric(
        unit="",
        group="check",
        meaning="greatest residual of the energy balance, relative to the initial kinetic energy",
        needs="energy",
        value=lambda run: energy_residual(run.scene, run.energy),
        of="run",
        error="balance",
        shown=Shown("energy residual / initial kinetic energy", ".1e"),
    ),
    "momentum_residual": Metric(
        unit="",
        group="check",
        meaning="greatest residual of the momentum balance, relative to the greatest force",
        needs="momentum",
        value=lambda run: run.extremes.momentum_residual,
        of="run",
        error="balance",
        shown=Shown("momentum residual / greatest force", ".1e"),
    ),
    "steps": Metric(
        unit="",
        group="run",
        meaning="accepted time steps",
        needs="end",
        value=lambda run: float(run.statistics.steps),
        of="run",
        error="effort",
    ),
    "run_time": Metric(
        unit="s",
        group="run",
        meaning="computing time",
        needs="end",
        value=lambda run: run.outcome.run_time,
        of="run",
        error="effort",
    ),
    "end_time": Metric(
        unit="s",
        group="run",
        meaning="time at the end of the run",
        needs="end",
        value=lambda run: run.extremes.end_time,
        of="run",
        error="effort",
    ),
}

METRICS: Mapping[str, Metric] = MappingProxyType(
    {**LOAD_METRICS, **CRUSH_METRICS, **_MOTION_METRICS, **_RUN_METRICS}
)
"""Every scalar that a run may have; scalars of motion are those of the leading unit, crushes of both."""
