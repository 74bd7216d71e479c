"""Oblique impacts on walls and concrete barriers: tests, and nominal ones of MASH, NCHRP 350, EN 1317."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import birm3d
import numpy as np
from birm3d import units
from birm3d.barrier.lateral_load import NORMAL_IMPULSE, normal_momentum
from comparison import Row, about, facts
from stand_in import name_of, stand_in

NAME = "redirection"
TITLE = "Oblique impact on walls and concrete barriers"
TEXT = """Vehicles: the stand-in of the class with the test's mass. Barriers: rigid, fixed, friction 0.2.
Roll was read in a source for three tests, exit angle for two of them. "No rolling" of TB11 is taken as 0
degrees; the exit angle of TB51 is published as at most 1 degree. By the roll of 2214NJ-2 a number of the
10-t truck was chosen. The two others are on the slipform STEP barrier (SWOV R-95-66). Its profile is not
known: a New Jersey of 0.9 m stands for it. Marks: 2 degrees of exit angle and 5 of roll. By so much two more
tests, with the same vehicles on a steel barrier of that shape (SWOV R-96-26), differ from these. No measured
exit speed was found. Forces as commonly reported, whose sources are not at hand, are printed apart.

What can be checked, too: the change of momentum across the barrier when the vehicle has left it, or at the
end of the run, over the momentum towards it, m v sin(angle). It is 1 + e. No test of the table gives it. A
restitution e from 0 to 0.3 is taken to be right, so the column "measured" has 1.15, which is expected and
not measured. The wall's own impulse is in the table of computed figures: tyres that press a vehicle on the
wall add to it.

Whether the vehicle is contained and stays upright (1: yes, 0: no) was read in a source for three tests. Of
the others it is commonly reported, or required of the nominal conditions, and not judged.

What the model can not do here: rear tyres of trucks turn them away from the barrier while they stand on two
wheels. So the barrier's own impulse can be less than the change of momentum. A near-side tread that climbs
a sloped face lifts the body, not its own wheel, and stays on. The load of a trailer does not shift. The
10-t truck has no camber thrust, and leans on the barrier for more than a second."""


EXIT_ANGLE, ROLL = 2.0, 5.0  # deg
AT_MOST = "at most "  # before a limit, where no value was published


def tasks() -> Sequence[str]:
    """Names of the tests."""
    return [fact["test"] for fact in facts("redirections")]


def barrier(kind: str, height: float) -> birm3d.Barrier:
    """The barrier of a row."""
    if kind == "wall":
        return birm3d.Barrier.rigid_wall(height=height)
    return birm3d.Barrier.jersey(profile=kind, height=height)


def simulation(fact: Mapping[str, str]) -> birm3d.Simulation:
    """The impact of a row."""
    vehicle = stand_in(fact["vehicle"], float(fact["mass_kg"]))
    wall = (
        barrier(fact["barrier"], float(fact["height_m"])) if fact["height_m"] else birm3d.Barrier.rigid_wall()
    )
    return birm3d.Simulation(vehicle, wall, units.km_h(float(fact["speed_km_h"])), float(fact["angle_deg"]))


def rows(task: str) -> list[Row]:
    """What one task is compared in."""
    (fact,) = (fact for fact in facts("redirections") if fact["test"] == task)
    result = simulation(fact).run()
    scene, metrics = result.scene, result.metrics
    who = name_of(scene.vehicle)
    # The barriers stand along y; units of a combination count by their masses.
    across = float(
        np.sum([unit.mass * _velocity(result, k)[0] for k, unit in enumerate(scene.vehicle.units)])
    )
    towards = normal_momentum(scene.vehicle.mass, scene.impact_speed, scene.impact_angle)
    change = 1.0 - across / towards
    upright = float(fact["upright"])
    contained = float(result.outcome in ("redirected", "stopped", "undecided"))
    middle = 0.5 * sum(NORMAL_IMPULSE)
    read, role = fact["upright_read"] == "yes", _role(fact)
    found = [
        Row(
            task, who, "change of momentum across / m v sin a", "-", middle, *NORMAL_IMPULSE, change, "check"
        ),
        Row(task, who, "contained and upright", "-", *[upright] * 3, contained, role, judged=read),
    ]
    found += _measured(fact, who, metrics)
    if fact["force_50ms_kN"]:
        force = 1e3 * float(fact["force_50ms_kN"])
        own = float(metrics["peak_force_50ms"])
        found.append(Row(task, who, "force over 50 ms", "N", force, *about(force, 0.25), own, judged=False))
    return found


def _measured(fact: Mapping[str, str], who: str, metrics: Mapping[str, float]) -> list[Row]:
    """Rows of exit angle and roll, where they were published."""
    role = _role(fact)
    found = []
    for column, quantity, metric, mark in (
        ("exit_angle_deg", "exit angle", "exit_angle", EXIT_ANGLE),
        ("roll_deg", "greatest roll", "max_roll", ROLL),
    ):
        if fact[column]:
            told = fact[column]
            value = float(told.removeprefix(AT_MOST))
            what = f"{quantity}, limit" if told.startswith(AT_MOST) else quantity
            own = float(metrics[metric])
            found.append(Row(fact["test"], who, what, "deg", value, value - mark, value + mark, own, role))
    return found


def _role(fact: Mapping[str, str]) -> str:
    return "fitted" if fact["fitted"] == "yes" else "predicted"


def _velocity(result: birm3d.Result, unit: int) -> np.ndarray:
    """Of a unit's mass centre when the vehicle has left the barrier, or at the end, world axes [m/s]."""
    left = float(result.metrics.get("time_of_separation", result.time[-1]))
    row = min(int(np.searchsorted(result.time, left)), len(result.time) - 1)
    return np.asarray(result.unit(unit).velocity[row])


def computed(task: str) -> tuple[str, ...]:
    """Figures of which few were measured, as text: outcome, exit speed and angle, roll, pitch, ASI."""
    (fact,) = (fact for fact in facts("redirections") if fact["test"] == task)
    result = simulation(fact).run()
    metrics = result.metrics
    scene = result.scene
    single = scene.vehicle.joint is None
    impulse = float(result.barrier_normal_force[1:].sum()) * scene.settings.output_interval
    towards = normal_momentum(scene.vehicle.mass, scene.impact_speed, scene.impact_angle)
    return (
        task,
        name_of(scene.vehicle),
        result.outcome,
        *(
            f"{float(metrics[name]):.1f}" if name in metrics else ""
            for name in ("exit_speed", "exit_angle", "max_roll", "max_pitch")
        ),
        f"{impulse / towards:.2f}",
        f"{1e-3 * float(metrics['peak_force_50ms']):.0f}",
        f"{birm3d.occupant_risk(result).asi:.2f}" if single else "",
    )
