"""The scalars of runs, one row each: name, units, meaning, what it is made of, and how tables show it.

Reports, tables, studies, error measures, the command line and the documentation take all of it from here.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Literal, NamedTuple, get_args

from .. import units
from . import metric_functions as made
from .run_values import RunValues, energy_residual

__all__ = ["GROUPS", "METRICS", "Metric", "Shown"]

# Longer than 300 lines: one table, a row for each metric.

Group = Literal[
    "crush", "barrier", "turn", "load", "motion", "departure", "attitude", "later", "check", "joint", "run"
]
GROUPS: tuple[Group, ...] = get_args(Group)
"""Groups of metrics in the order in which tables show them."""


class Shown(NamedTuple):
    """How tables show a metric: its label; divided by ``size`` it is in ``unit``; ``form`` is its format."""

    label: str
    form: str
    unit: str = ""
    size: float = 1.0
    headline: bool = False  # whether a run or a study is judged by it first
    listed: bool = True  # whether the tables of a run list it; others show it where it is asked for
    counted: str = ""  # of a count: what tables of several runs call a run in which it is above 0


class Metric(NamedTuple):
    """One scalar of a run.

    Attributes
    ----------
    unit
        SI or deg; "" for a pure number.
    group
        One of :data:`GROUPS`.
    meaning
        What it is, for the documentation.
    needs
        Group of extremes that the core finds for it; "end": none.
    value
        Makes it of a run; ``None``: the run does not have it.
    of
        What a run must have: nothing ("run"), a "barrier", or one of
        :data:`birm3d.result.run_values.PARTS`.
    error
        "answer": it has an error; "balance": it is one itself; "effort": it says how an answer was found.
    shown
        ``None``: tables show it by its name only, where it is asked for.
    """

    unit: str
    group: Group
    meaning: str
    needs: str
    value: Callable[[RunValues], float | None]
    of: Literal["run", "barrier", "segments", "posts", "moving", "joint", "sliding"] = "barrier"
    error: Literal["answer", "balance", "effort"] = "answer"
    shown: Shown | None = None


def _kilo(label: str, unit: str, headline: bool = False) -> Shown:
    return Shown(label, ".0f", f"k{unit}", 1e3, headline)


def _metres(label: str, headline: bool = False) -> Shown:
    return Shown(label, ".3f", "m", headline=headline)


def _asked(label: str, unit: str, size: float = 1.0) -> Shown:
    return Shown(label, ".4g", unit, size, listed=False)


METRICS: Mapping[str, Metric] = MappingProxyType(
    {
        "peak_deceleration": Metric(
            *("m/s^2", "motion", "greatest deceleration along r, unfiltered", "motion"),
            *(lambda run: run.motion.deceleration, "run"),
            shown=_asked("peak deceleration along the vehicle, unfiltered", "g", units.g),
        ),
        "peak_deceleration_cfc60": Metric(
            *("m/s^2", "motion", "the same after CFC 60", "filtered_deceleration"),
            *(lambda run: run.extremes.filtered_deceleration, "run"),
            shown=Shown("peak deceleration along the vehicle, CFC 60", ".1f", "g", units.g, headline=True),
        ),
        "peak_normal_force": Metric(
            "N",
            "load",
            "component of the barrier's total force on the vehicle along the barrier's normal, compression "
            "positive, see Result.barrier_normal_force",
            "normal_force",
            lambda run: run.normal_force.peak,
            shown=_asked("peak barrier force along the normal, unfiltered", "kN", 1e3),
        ),
        "peak_normal_force_cfc60": Metric(
            *("N", "load", "the same after CFC 60", "filtered_force", lambda run: run.filtered_force.cfc60),
            shown=_kilo("peak barrier force along the normal, CFC 60", "N", headline=True),
        ),
        "peak_force_50ms": Metric(
            *("N", "load", "of its mean over 50 ms", "filtered_force"),
            lambda run: run.filtered_force.mean_50ms,
            shown=_kilo("peak 50-ms mean of the force along the normal", "N", headline=True),
        ),
        "peak_element_force": Metric(
            *("N", "load", "greatest magnitude of the force vector on any element", "element_loads"),
            lambda run: run.element_loads.force,
            shown=_asked("peak force (vector) on one element, unfiltered", "kN", 1e3),
        ),
        "peak_element_force_50ms": Metric(
            *("N", "load", "of its mean over 50 ms", "element_loads"),
            lambda run: run.element_loads.force_50ms,
            shown=_kilo("peak 50-ms force (vector) on one element", "N", headline=True),
        ),
        "peak_overturning_moment": Metric(
            *("N m", "load", "greatest overturning moment of any element, see ElementLoad", "element_loads"),
            lambda run: run.element_loads.moment,
            shown=_asked("peak overturning moment of one element, unfiltered", "kN m", 1e3),
        ),
        "peak_overturning_moment_50ms": Metric(
            *("N m", "load", "of its mean over 50 ms", "element_loads"),
            lambda run: run.element_loads.moment_50ms,
            shown=_kilo("peak 50-ms overturning moment of one element", "N m"),
        ),
        "dynamic_crush": Metric(
            *("m", "crush", "greatest shortening of a truss of the skin during the run", "end"),
            lambda run: run.dynamic_crush,
            shown=_metres("dynamic crush (greatest of the skin)", headline=True),
        ),
        "residual_crush": Metric(
            *(
                "m",
                "crush",
                "the same when the vehicle had left and its covers had sprung back, or else at the end",
                "end",
            ),
            lambda run: run.residual_crush,
            shown=_metres("residual crush"),
        ),
        "max_displacement": Metric(
            "m",
            "crush",
            "of the mass centre towards the barrier since t = 0, less the standoff; on a path along the "
            "barrier's line, towards its end",
            "motion",
            lambda run: run.motion.travel - run.scene.standoff,
            shown=_metres("travel of the mass centre towards the barrier", headline=True),
        ),
        "vehicle_penetration": Metric(
            "m",
            "crush",
            "how far the rigid body got past the barrier's line: the greatest distance of any anchor behind "
            "it over the run, 0 if none passed it, absent on a path along the line. The line is the foot of "
            "the traffic face, or runs through the axes of posts (of the first row). Crushed skin does not "
            "count; a body beside the end of a barrier does. ASTM F2656 measures a stated point of the "
            "vehicle from the protected side",
            "penetration",
            made.vehicle_penetration,
            shown=_metres("rigid body past the barrier's line", headline=True),
        ),
        "contact_overlap": Metric(
            "m",
            "crush",
            "by which the rigid body and the barrier overlapped, see OverlapWarning",
            "end",
            made.contact_overlap,
            error="balance",
            shown=_asked("overlap of rigid body and barrier", "m"),
        ),
        "core_contact_force": Metric(
            "N",
            "crush",
            "greatest mean over 50 ms of the barrier's force on the rigid core; 0 if the core was not met, "
            "see CoreContactWarning",
            "end",
            lambda run: run.statistics.core_contact_force,
            shown=_kilo("50-ms force on the rigid core", "N"),
        ),
        "barrier_deflection": Metric(
            "m",
            "barrier",
            "how far the furthest corner of any segment's base, or the top of any post that yields, moved "
            "square to the line, away from traffic",
            "segments",
            lambda run: run.extremes.segments.deflection,
            "moving",
            shown=_metres("deflection of the barrier", headline=True),
        ),
        "residual_barrier_deflection": Metric(
            *("m", "barrier", "the same at the end of the run", "segments"),
            *(lambda run: run.extremes.segments.residual_deflection, "moving"),
            shown=_metres("deflection of the barrier that stays"),
        ),
        "post_tilt": Metric(
            *("deg", "barrier", "greatest tilt of any post that yields, from the vertical", "segments"),
            *(lambda run: math.degrees(run.extremes.segments.tilt), "posts"),
            shown=Shown("tilt of a post", ".1f", "deg"),
        ),
        "residual_post_tilt": Metric(
            *("deg", "barrier", "the same at the end of the run", "segments"),
            *(lambda run: math.degrees(run.extremes.segments.residual_tilt), "posts"),
            shown=Shown("tilt of a post that stays", ".1f", "deg"),
        ),
        "max_overturning_ratio": Metric(
            "",
            "barrier",
            "greatest of Result.overturning_ratio; above 1 a segment would begin to tip, which is left out; "
            "absent without gravity",
            "segments",
            made.max_overturning_ratio,
            "segments",
            shown=Shown("overturning / restoring moment of a segment", ".2f"),
        ),
        "time_of_zero_velocity": Metric(
            "s",
            "turn",
            "when the motion towards the barrier ends, since the first touch",
            "motion",
            made.time_of_zero_velocity,
            shown=Shown("time of zero normal velocity", ".1f", "ms", 1e-3),
        ),
        "time_of_separation": Metric(
            "s",
            "departure",
            "since t = 0, of a vehicle that leaves for good: the last loss of contact before that, so that a "
            "blow of the rear belongs to the event",
            "end",
            lambda run: run.event.time_of_separation,
            shown=Shown("time of separation", ".1f", "ms", 1e-3),
        ),
        "restitution": Metric(
            "",
            "departure",
            "normal separation over approach speed; 0 of a vehicle that rests at the barrier",
            "motion",
            made.restitution,
            shown=Shown("restitution along the normal", ".2f"),
        ),
        "delta_v": Metric(
            *("m/s", "motion", "greatest change of velocity, until separation", "motion"),
            lambda run: run.motion.velocity_change,
            shown=Shown("greatest change of velocity", ".2f", "m/s", headline=True),
        ),
        "impact_severity": Metric(
            *("J", "motion", "1/2 m (v sin angle)^2", "end", made.impact_severity),
            shown=_asked("impact severity, m (v sin angle)² / 2", "kJ", 1e3),
        ),
        "exit_speed": Metric(
            *("m/s", "departure", "of the mass centre along the ground at separation", "end"),
            made.exit_speed,
            shown=Shown("exit speed", ".2f", "m/s", headline=True),
        ),
        "exit_angle": Metric(
            "deg",
            "departure",
            "of the path of a vehicle that is contained, from the barrier's line, positive away from it, at "
            "separation",
            "end",
            made.exit_angle,
            shown=Shown("exit angle from the barrier's line", ".1f", "deg", headline=True),
        ),
        "max_roll": Metric(
            "deg",
            "attitude",
            "greatest magnitude over the whole run: a vehicle may roll over after it has left",
            "attitude",
            lambda run: math.degrees(run.attitude.roll),
            "run",
            shown=Shown("greatest roll", ".1f", "deg", headline=True),
        ),
        "max_pitch": Metric(
            *("deg", "attitude", "greatest magnitude over the whole run", "attitude"),
            *(lambda run: math.degrees(run.attitude.pitch), "run"),
            shown=Shown("greatest pitch", ".1f", "deg"),
        ),
        "max_yaw": Metric(
            *("deg", "attitude", "greatest magnitude until separation", "attitude"),
            *(lambda run: math.degrees(run.attitude.yaw), "run"),
            shown=Shown("greatest yaw", ".1f", "deg"),
        ),
        "later_contacts": Metric(
            "",
            "later",
            "how often the vehicle touched the barrier again after the values at separation were taken: "
            "these contacts change none of them",
            "end",
            lambda run: float(run.event.later_contacts),
            shown=Shown(
                "later contacts, which count for nothing above",
                ".0f",
                counted="a later contact, which counts for nothing here",
            ),
        ),
        "wheel_climb": Metric(
            "m",
            "attitude",
            "greatest height of any wheel's lowest point above the ground; sprung wheels count as extended",
            "wheel_climb",
            made.wheel_climb,
            "run",
            shown=_asked("greatest height of a wheel above the ground", "m"),
        ),
        "max_articulation_angle": Metric(
            *("deg", "joint", "greatest magnitude of the angle between two units", "joint"),
            *(lambda run: math.degrees(run.extremes.joint.angle), "joint"),
            shown=_asked("greatest angle between the units", "deg"),
        ),
        "peak_joint_force_50ms": Metric(
            *(
                "N",
                "joint",
                "greatest magnitude of the mean over 50 ms of the force between two units",
                "joint",
            ),
            *(lambda run: run.extremes.joint.force_50ms, "joint"),
            shown=_asked("peak 50-ms force of the joint", "kN", 1e3),
        ),
        "bed_slip": Metric(
            *("m", "joint", "greatest distance that a load bed slid along its frame", "joint"),
            *(lambda run: run.extremes.joint.slip, "sliding"),
            shown=_metres("greatest slip of the load bed", headline=True),
        ),
        "energy_residual": Metric(
            "",
            "check",
            "greatest residual of the energy balance, relative to the initial kinetic energy",
            "energy",
            lambda run: energy_residual(run.scene, run.energy),
            "run",
            "balance",
            Shown("energy residual / initial kinetic energy", ".1e"),
        ),
        "momentum_residual": Metric(
            "",
            "check",
            "greatest residual of the momentum balance, relative to the greatest force",
            "momentum",
            lambda run: run.extremes.momentum_residual,
            "run",
            "balance",
            Shown("momentum residual / greatest force", ".1e"),
        ),
        "steps": Metric(
            *("", "run", "accepted time steps", "end"),
            *(lambda run: float(run.statistics.steps), "run", "effort"),
        ),
        "run_time": Metric(
            *("s", "run", "computing time", "end", lambda run: run.outcome.run_time, "run", "effort"),
        ),
        "end_time": Metric(
            *("s", "run", "time at the end of the run", "end", lambda run: run.extremes.end_time),
            *("run", "effort"),
        ),
    }
)
"""Every scalar that a run may have; scalars of motion are those of the leading unit, crushes of both."""
