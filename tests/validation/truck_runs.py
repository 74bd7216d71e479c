"""Finite-element runs of a truck, and the same crashes as scenes: what fit_truck.py fits and compares.

The runs were made for this project with OpenRadioss on a generic truck; tests/data/finite_element holds our
own vehicle file of it and reduced curves. Repeats with another time step, another tyre layer, a shift of 2 mm
moved single peaks by 10 to 20 %, means over 50 ms and travel by 5 %: closer they can not be judged.
"""

from __future__ import annotations

import csv
import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import MappingProxyType

import birm3d
import numpy as np
import numpy.typing as npt
from birm3d import units
from birm3d.filters import moving_average

Floats = npt.NDArray[np.float64]

DATA = Path(__file__).resolve().parents[1] / "data/finite_element"
START = DATA / "finite_element_truck.toml"
FITTED = DATA / "fitted_truck.toml"
FRICTION = 0.2  # of the barrier, for tyres too
POST_DIAMETER, POST_HEIGHT = 0.32, 1.0  # m
# Before the touch, so that a filter sees the rise of the force from nothing.
STANDOFF = 0.1  # m
MASS = {"mass": 6809.9, "x": 3.952, "z": 1.144}  # kg, m behind the bumper, m
INERTIA = {"Ixx": 3908.0, "Iyy": 22400.0, "Izz": 23235.0, "Ixz": 712.0}  # kg m2; Ixz the tensor's element


@dataclass(frozen=True, eq=False)
class Run:
    """A finite-element run: scalars, and curves since the first touch (s, N, m, deg), shape (n,).

    ``moment``: greatest 50-ms mean of the overturning moment about the foot of a post or the wall [N m];
    ``None`` where its height is not to be believed. ``roll``: greatest magnitude.
    Impulses are on the posts from low to high y, or on the wall: along the path and to its left, (p, 2).
    Of parts that one rigid body does not have, see truck_runs.csv: momentum that the engine lacks and that
    the bed has beyond the frame's [N s], slip of the bed, way of the front axle [m]; impulses up on the
    vehicle [N s] and height of the barrier's force [m]; energy in all contacts, of the first kinetic energy.
    """

    name: str
    posts: tuple[float, ...]
    impact_angle: float
    speed: float
    duration: float
    travel: float
    force_50ms: float
    peak_force: float
    moment: float | None
    pitch: float
    yaw: float
    roll: float
    time_of_zero_velocity: float | None
    speed_at_end: float
    impulse: Floats
    engine_lags: float
    bed_leads: float
    bed_slip: float
    axle_back: float
    barrier_up: float
    ground_up: float
    action_height: float
    contact_share: float
    time: Floats
    force: Floats
    displacement: Floats


@dataclass(frozen=True)
class Figures:
    """What is compared: travel of the whole, force over 50 ms, greatest pitch and yaw, impulses; SI, deg.

    ``moment``: greatest 50-ms mean of the overturning moment about the foot of a post or the wall [N m].
    ``up``: impulse of the barrier on the vehicle, upwards [N s]. ``friction``: energy lost by it at the
    barrier, of the kinetic energy at first. ``core_contact``: whether the rigid core met the barrier.
    ``slip``: greatest of a bed that slides [m]. ``chassis_travel``: of the first unit's mass centre [m].
    """

    travel: float
    force_50ms: float
    moment: float
    pitch: float
    yaw: float
    roll: float
    impulse: Floats
    up: float
    friction: float
    core_contact: bool
    slip: float
    chassis_travel: float


def _numbers(text: str) -> tuple[float, ...]:
    return tuple(float(number) for number in text.split(";") if number)


@cache
def runs() -> Mapping[str, Run]:
    """All runs by their names: barrier with its angle from head-on, speed in mph."""
    lines = (DATA / "truck_runs.csv").read_text(encoding="utf-8").splitlines()
    found = {}
    for row in csv.DictReader(line for line in lines if not line.startswith("#")):
        curves = np.loadtxt(DATA / f"{row['run']}.csv", delimiter=",", skiprows=5)
        stop = row["time_of_zero_velocity_s"]
        name = row["run"].removeprefix("truck_")
        found[name] = Run(
            name=name,
            posts=_numbers(row["posts_y_m"]),
            impact_angle=float(row["impact_angle_deg"]),
            speed=units.mph(float(row["speed_mph"])),
            duration=float(row["duration_s"]),
            travel=float(row["travel_m"]),
            force_50ms=float(row["force_50ms_N"]),
            peak_force=float(row["peak_force_N"]),
            moment=float(row["moment_50ms_N_m"]) if row["moment_50ms_N_m"] else None,
            pitch=float(row["pitch_deg"]),
            yaw=float(row["yaw_deg"]),
            roll=float(row["roll_deg"]),
            time_of_zero_velocity=float(stop) if stop else None,
            speed_at_end=float(row["normal_speed_at_end_m_s"]),
            impulse=np.array([_numbers(row["impulse_forward_N_s"]), _numbers(row["impulse_left_N_s"])]).T,
            engine_lags=float(row["engine_lags_N_s"]),
            bed_leads=float(row["bed_leads_N_s"]),
            bed_slip=float(row["bed_slip_m"]),
            axle_back=float(row["axle_back_m"]),
            barrier_up=float(row["barrier_up_N_s"]),
            ground_up=float(row["ground_up_N_s"]),
            action_height=float(row["action_height_m"]),
            contact_share=float(row["contact_share"]),
            time=curves[:, 0],
            force=curves[:, 1],
            displacement=curves[:, 2],
        )
    return MappingProxyType(found)


def with_loaded_posts(run: Run) -> Run:
    """The run as one of those posts that took a hundredth of the impulse: the others might not be there."""
    taken = np.linalg.norm(run.impulse, axis=1)
    loaded = taken >= 0.01 * taken.sum()
    if loaded.all():
        return run
    posts = tuple(post for post, is_loaded in zip(run.posts, loaded, strict=True) if is_loaded)
    return dataclasses.replace(run, posts=posts, impulse=run.impulse[loaded])


def barrier_of(run: Run, friction: float, diameter: float) -> birm3d.Barrier:
    """The run's barrier: posts in a row of even spacing, or a wall."""
    if not run.posts:
        return birm3d.Barrier.rigid_wall(friction=friction)
    spacing = float(np.diff(run.posts)[0]) if len(run.posts) > 1 else 1.2
    return birm3d.Barrier.bollards(
        count=len(run.posts),
        diameter=diameter,
        height=POST_HEIGHT,
        spacing=spacing,
        origin=(0.0, float(np.mean(run.posts)), 0.0),
        friction=friction,
    )


def scene(
    vehicle: birm3d.Vehicle, run: Run, friction: float = FRICTION, diameter: float = POST_DIAMETER
) -> birm3d.Simulation:
    """The run as a scene, as long as it was; the left side goes ahead at a wall that is not met head-on."""
    approach = run.speed * np.sin(np.radians(run.impact_angle))
    return birm3d.Simulation(
        vehicle,
        barrier_of(run, friction, diameter),
        run.speed,
        180.0 - run.impact_angle,
        standoff=STANDOFF,
        duration=float(STANDOFF / approach + run.duration),
        settings=birm3d.Settings(mu_tire=0.0, mu_body=0.0, mu_tire_barrier=friction),
    )


def whole_position(result: birm3d.Result) -> Floats:
    """Place of the mass centre of all units along the barrier's normal, shape (n,) [m]."""
    parts = [unit.mass * result.unit(i).position[:, 0] for i, unit in enumerate(result.scene.vehicle.units)]
    return np.asarray(np.sum(parts, axis=0) / result.scene.vehicle.mass)


def figures(result: birm3d.Result) -> Figures:
    """Figures of a computed crash."""
    crash = result.scene
    interval = crash.settings.output_interval
    angle = np.radians(crash.impact_angle)
    along = np.array([np.sin(angle), np.cos(angle), 0.0])  # of the path; the barrier's line is y
    left = np.array([-along[1], along[0], 0.0])
    impulse = [
        (float(load.force[1:].sum(0) @ along) * interval, float(load.force[1:].sum(0) @ left) * interval)
        for load in result.element_loads
    ]
    force = result.barrier_normal_force
    travel = whole_position(result) - whole_position(result)[0] - crash.standoff
    place = result.unit(0).position[:, 0]
    return Figures(
        travel=float(travel.max()),
        force_50ms=float(moving_average(force[:, None], 0.05, interval).max()),
        moment=float(result.metrics["peak_overturning_moment_50ms"]),
        pitch=float(result.pitch.max()),
        yaw=float(result.yaw[np.argmax(np.abs(result.yaw))]),
        roll=float(np.abs(result.roll).max()),
        impulse=np.array(impulse),
        up=float(result.barrier_force[1:, 2].sum()) * interval,
        friction=float(result.energy["barrier_friction"][-1] / result.energy["kinetic"][0]),
        core_contact=result.statistics.body_steps > 0,
        slip=result.metrics.get("bed_slip", 0.0),
        chassis_travel=float((place - place[0]).max() - crash.standoff),
    )
