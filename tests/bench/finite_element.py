"""Finite-element runs of two vehicles, and the same crashes as scenes: what bench_finite_element.py and
tests/validation compare.

The runs were made for this project with OpenRadioss on two public training models;
tests/data/finite_element holds our own vehicle files and reduced curves. They are a finite-element code's
answer for a given structure, not what a real car does. Repeats with another shell element, a finer mesh
and a shift of 1 mm moved N by tens of per cent in crush and 12 % in peak force, S by 2 % and 1 %:
`crush_trust` and `force_trust` are what they can be judged to at best.
"""

from __future__ import annotations

import csv
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import MappingProxyType

import birm3d
import numpy as np
import numpy.typing as npt
from birm3d import units
from birm3d.calibration import CurveTarget, ScalarTarget, Target
from birm3d.filters import cfc

Floats = npt.NDArray[np.float64]

DATA = Path(__file__).resolve().parents[1] / "data/finite_element"
POLE_DIAMETER = 0.354  # m
# Before the touch, so that the filter sees the rise of the force from nothing.
STANDOFF = 0.1  # m


@dataclass(frozen=True)
class CheckVehicle:
    """A finite-element model: mass properties (kg, m, kg m2; x from the front), how far to trust its runs."""

    key: str
    mass: float
    x: float
    z: float
    inertia: Mapping[str, float]  # Ixz: integral of x z dm, as the models' own shells have its sign
    crush_trust: float
    force_trust: float


VEHICLES = {
    vehicle.key: vehicle
    for vehicle in (
        CheckVehicle(
            "n",
            4776.4,
            -2.3229,
            0.4858,
            MappingProxyType({"Ixx": 2514.0, "Iyy": 8644.0, "Izz": 8919.0, "Ixz": 257.0}),
            crush_trust=0.10,
            force_trust=0.15,
        ),
        CheckVehicle(
            "s",
            1173.0,
            -1.3226,
            0.4754,
            MappingProxyType({"Ixx": 413.4, "Iyy": 1443.1, "Izz": 1676.8, "Ixz": -42.8}),
            crush_trust=0.05,
            force_trust=0.10,
        ),
    )
}


@dataclass(frozen=True, eq=False)
class Run:
    """A finite-element run: scalars, and curves since the first touch (s, N, m), shape (n,)."""

    name: str
    barrier: str
    impact_angle: float  # beyond 90 deg the left front corner touches first
    impact_offset: float  # of a pole to the right of the centre line [m]
    speed: float
    crush: float
    time_of_zero_velocity: float
    peak_force: float
    mean_force: float
    restitution: float
    end: float  # since the first touch [s]; yaw and impulses are of then
    yaw: float  # positive nose to the left [deg]
    normal_impulse: float  # N s
    lateral_impulse: float  # on the vehicle, to the left [N s]
    time: Floats
    force: Floats
    displacement: Floats

    @property
    def vehicle(self) -> CheckVehicle:
        return VEHICLES[self.name[0]]


@dataclass(frozen=True)
class Figures:
    """What is compared.

    Travel of the mass centre along the barrier's normal [m], peak of the CFC60 force along it [N], mean of
    the force along it over the time to the greatest travel [N].
    """

    crush: float
    peak_force: float
    mean_force: float

    def errors(self, run: Run) -> tuple[float, float, float]:
        """Relative to the run; positive where computed is more."""
        return (
            self.crush / run.crush - 1.0,
            self.peak_force / run.peak_force - 1.0,
            self.mean_force / run.mean_force - 1.0,
        )


@cache
def runs() -> Mapping[str, Run]:
    """All runs by their names: vehicle, barrier with the angle from its normal, speed in mph."""
    lines = (DATA / "runs.csv").read_text(encoding="utf-8").splitlines()
    found = {}
    for row in csv.DictReader(line for line in lines if not line.startswith("#")):
        time, force, displacement = np.loadtxt(DATA / f"{row['run']}.csv", delimiter=",", skiprows=5).T
        found[row["run"]] = Run(
            name=row["run"],
            barrier=row["barrier"],
            impact_angle=float(row["impact_angle_deg"]),
            impact_offset=float(row["impact_offset_m"]),
            speed=units.mph(float(row["speed_mph"])),
            crush=float(row["crush_m"]),
            time_of_zero_velocity=float(row["time_of_zero_velocity_s"]),
            peak_force=float(row["peak_force_N"]),
            mean_force=float(row["mean_force_N"]),
            restitution=float(row["restitution"]),
            end=float(row["end_s"]),
            yaw=float(row["yaw_end_deg"]),
            normal_impulse=float(row["normal_impulse_Ns"]),
            lateral_impulse=float(row["lateral_impulse_Ns"]),
            time=time,
            force=force,
            displacement=displacement,
        )
    return MappingProxyType(found)


def check_vehicle(key: str, mesh_density: float = 1.0) -> birm3d.Vehicle:
    """Vehicle of a file in tests/data: no preset, as nobody drives it."""
    return birm3d.Vehicle.from_file(DATA / f"finite_element_{key}.toml", mesh_density=mesh_density)


def scene(vehicle: birm3d.Vehicle, run: Run) -> birm3d.Simulation:
    """The run as a scene: rigid ground and barrier without friction, as long as the run and its curve."""
    barrier = (
        birm3d.Barrier.pole(diameter=POLE_DIAMETER, friction=0.0)
        if run.barrier == "pole"
        else birm3d.Barrier.rigid_wall(friction=0.0)
    )
    return birm3d.Simulation(
        vehicle,
        barrier,
        run.speed,
        run.impact_angle,
        run.impact_offset,
        standoff=STANDOFF,
        duration=float(touch(run) + max(run.end, run.time[-1]) + 2e-3),
        settings=birm3d.Settings(mu_tire=0.0),
    )


def touch(run: Run) -> float:
    """When the vehicle of a scene meets the barrier [s]."""
    return float(STANDOFF / (run.speed * np.sin(np.radians(run.impact_angle))))


def targets(run: Run) -> tuple[Target, ...]:
    """What a fit is held against, with the uncertainty that the run's own repeats have."""
    crush, force = run.vehicle.crush_trust * run.crush, run.vehicle.force_trust * run.peak_force
    return (
        CurveTarget(run.time, run.force, sigma=force, cfc=60, filtered=True, name=run.name),
        ScalarTarget("max_displacement", run.crush, crush),
    )


def figures(result: birm3d.Result) -> Figures:
    """Figures of a computed crash."""
    scene = result.scene
    interval = scene.settings.output_interval
    travel = result.position[:, 0] - result.position[0, 0] - scene.standoff
    force = -result.barrier_force[:, 0]
    turn = int(np.argmax(travel))
    touch = STANDOFF / result.velocity[0, 0]
    mean = float(force[1 : turn + 1].sum() * interval / (result.time[turn] - touch))
    return Figures(float(travel[turn]), float(cfc(force, 60, interval).max()), mean)


def mass_mismatch(vehicle: birm3d.Vehicle, key: str) -> dict[str, float]:
    """Mass properties relative to the model's; the mass centre's as shares of its distances from front and
    ground."""
    wanted = VEHICLES[key]
    inertia = vehicle.inertia
    front = float(vehicle.nodes[:, 0].max())
    found = {
        "mass": vehicle.mass / wanted.mass,
        "x": front / -wanted.x,
        "z": vehicle.mass_center_height / wanted.z,
    }
    for name, value in zip(("Ixx", "Iyy", "Izz", "Ixz"), (*np.diag(inertia), -inertia[0, 2]), strict=True):
        found[name] = float(value) / wanted.inertia[name]
    return {name: ratio - 1.0 for name, ratio in found.items()}
