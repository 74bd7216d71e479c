"""Scenes at the extremes: what a study of stability runs."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from ...barrier.barrier import Barrier
from ...scene.settings import Settings
from ...simulation.parameters import varied
from ...simulation.simulation import Simulation
from ...vehicle.test_bodies import elastic_block, laboratory_block
from ...vehicle.vehicle import Vehicle

__all__ = ["AXES", "Case", "default_scenes", "laboratory_cases", "varied_cases"]

STIFFNESS = tuple(10.0**i for i in range(-3, 7))
STEPS = (1.0, 2.0, 4.0, 10.0, 30.0, 100.0, 300.0, 1000.0)
SPEEDS = (0.05, 0.2, 1.0, 5.0, 20.0, 60.0, 100.0)
MASSES = (0.01, 0.03, 0.1, 0.3, 3.0, 10.0, 30.0, 100.0)
ANGLES = (10.0, 5.0, 2.0, 1.0, 0.5, 0.2, 0.1, 0.05)
UNLOADING = (1e2, 1e4, 1e6)
THIN = 0.01  # m, diameter of posts
TURNS = 10.0
# The steps that the program advises are this share of the critical one.
ADVISED = 0.25

AXES = (
    *("stiffness", "fixed step", "speed", "mass", "grazing angle", "unloading", "thin posts", "rest"),
    *("contact at t = 0", "nodes", "rollover", "free-standing"),
)
"""What is taken to extremes."""


@dataclass(frozen=True)
class Case:
    """One extreme scene, made when it is run.

    ``touches``: its vehicle can not miss the barrier. ``behind``: how far the mass centre may get behind the
    barrier's line [m]. ``turns``: so often it must roll over. ``moves``: whether it may move at all.
    """

    axis: str
    scene: str
    value: str
    make: Callable[[], Simulation]
    touches: bool = False
    behind: float = math.inf
    turns: float = 0.0
    moves: bool = True


def default_scenes() -> dict[str, Simulation]:
    """Return what is varied where no scene is given: a car at 25 deg, at bollards, and a block head-on."""
    car = Vehicle.preset("passenger_car", mesh_density=0.25)
    block = laboratory_block(100, k_initial=3e6, knee=0.4, k_hardening=6e6, k_unloading=60e6)
    weightless = Settings(gravity=0.0, ground=False)
    return {
        "car, wall 25 deg": Simulation(car, Barrier.rigid_wall(), 15.0, 25.0),
        "car, bollards": Simulation(car, Barrier.bollards(), 15.0),
        "block, wall": Simulation(block, Barrier.rigid_wall(friction=0.0), 22.352, settings=weightless),
    }


def varied_cases(name: str, base: Simulation) -> list[Case]:
    """Return one scene with each of its numbers taken to extremes."""
    vehicle = base.scene.vehicle
    hits = base.scene.barrier is not None and base.scene.impact_speed > 0.0

    def case(axis: str, value: str, make: Callable[[], Simulation], touches: bool = hits) -> Case:
        return Case(axis, name, value, make, touches)

    def of(change: str, value: object) -> Callable[[], Simulation]:
        return partial(varied, base, {change: value})

    cases = [case("stiffness", f"x {factor:g}", partial(stiffer, base, factor)) for factor in STIFFNESS]
    if hits:
        cases += [case("fixed step", f"x {factor:g}", partial(stepped, base, factor)) for factor in STEPS]
    cases += [case("speed", f"{speed:g} m/s", of("impact_speed", speed)) for speed in SPEEDS]
    cases += [case("mass", f"x {factor:g}", of("vehicle.gvw", factor * vehicle.mass)) for factor in MASSES]
    if base.scene.barrier is not None:
        # A path nearly along a row of posts may miss them all.
        cases += [
            case("grazing angle", f"{angle:g} deg", of("impact_angle", angle), False) for angle in ANGLES
        ]
        cases += [
            case("unloading", f"slope x {factor:g}", partial(unloading, base, factor))
            for factor in (*UNLOADING, math.inf)
        ]
        cases.append(case("unloading", "fully elastic", partial(elastic, base)))
        cases += thin_posts(name, vehicle, base)
        cases.append(case("contact at t = 0", "no standoff", of("standoff", 0.0)))
        cases.append(case("contact at t = 0", "standoff 1e-12 m", of("standoff", 1e-12)))
        cases.append(case("contact at t = 0", "standoff -1 mm", of("standoff", -1e-3), False))
    rest = {"impact_speed": 0.0, "standoff": 0.0, "duration": 60.0}
    cases.append(
        Case("rest", name, "60 s", partial(varied, base, rest), moves=base.scene.settings.ground is False)
    )
    return cases


def thin_posts(name: str, vehicle: Vehicle, base: Simulation) -> list[Case]:
    """Return the vehicle head-on at posts of 10 mm: one at its middle, and a row."""
    pole = Barrier.pole(diameter=THIN)
    row = Barrier.bollards(count=9, diameter=THIN, spacing=0.3)
    settings = base.scene.settings
    return [
        Case(
            "thin posts",
            name,
            f"{kind}, {speed:g} m/s",
            partial(Simulation, vehicle, barrier, speed, settings=settings),
            touches=True,
            behind=0.0,
        )
        for kind, barrier in (("pole of 10 mm", pole), ("bollards of 10 mm", row))
        for speed in (2.0, 15.0, 40.0)
    ]


def laboratory_cases() -> list[Case]:
    """Return extremes that need vehicles of their own: one node, 100,000 nodes, ten turns."""
    # Longer than 60 lines: a list of cases.
    wall, weightless = Barrier.rigid_wall(), Settings(gravity=0.0, ground=False)
    law = {"k_initial": 3e6, "knee": 0.4, "k_hardening": 6e6, "k_unloading": 60e6}

    def one(side: float) -> Vehicle:
        return Vehicle.from_arrays(
            mass=1000.0,
            inertia=np.diag([500.0, 1500.0, 1600.0]),
            nodes=[[2.0, side, 0.0]],
            anchors=[[0.5, side, 0.0]],
            k_initial=1e6,
            k_unloading=1e7,
        )

    def lies(
        settings: Settings, make: Callable[[], Vehicle], angle: float = 90.0
    ) -> Callable[[], Simulation]:
        return lambda: Simulation(make(), wall, 15.0, angle, settings=settings)

    dense = partial(Vehicle.preset, "passenger_car", mesh_density=17.0)
    thrown = partial(Vehicle.preset, "paper_pickup", mesh_density=0.25)  # tyres without camber thrust
    kerb = Barrier.rigid_wall(height=0.65, width=60.0)
    return [
        Case("nodes", "one node", "head-on", lies(weightless, lambda: one(0.0)), True, 0.0),
        Case("nodes", "one node", "head-on, 0.8 m to the side", lies(weightless, lambda: one(0.8)), True),
        Case("nodes", "one node", "25 deg", lies(weightless, lambda: one(0.0), 25.0), True),
        Case("nodes", "one node", "25 deg, falling", lies(Settings(), lambda: one(0.0), 25.0), True),
        Case(
            *("nodes", "100,000 nodes", "block head-on"),
            lambda: Simulation(laboratory_block(100_000, **law), wall, 22.352, settings=weightless),
            True,
            0.0,
        ),
        Case(
            *("nodes", "103,667 nodes", "car at a pole"),
            lambda: Simulation(dense(), Barrier.pole(), 10.0),
            True,
            0.0,
        ),
        Case(
            *("unloading", "elastic block", "25 deg"),
            lambda: Simulation(elastic_block(100), wall, 22.352, 25.0, settings=weightless),
            True,
        ),
        # Sideways into a low wall: it rolls over and over on the ground behind.
        Case(
            *("rollover", "pickup thrown over a kerb", "100 m/s sideways"),
            lambda: Simulation(thrown(), kerb, 100.0, impact_yaw=90.0, duration=15.0),
            True,
            turns=TURNS,
        ),
        Case(
            *("free-standing", "pickup, Jersey barrier of ten segments", "20 m/s, 25 deg"),
            lambda: Simulation(
                Vehicle.preset("pickup", mesh_density=0.2),
                Barrier.jersey(length=30.0, segments=10, free_standing=True),
                20.0,
                25.0,
            ),
            True,
        ),
    ]


def stiffer(base: Simulation, factor: float) -> Simulation:
    """Return a scene whose vehicle has all stresses and slopes times a factor."""
    vehicle = base.scene.vehicle
    if vehicle.zones:
        zones = {name: zone.scaled(factor) for name, zone in vehicle.zones.items()}
        return varied(base, {"vehicle": vehicle.with_zones(zones)})
    law = {name: factor * value for name, value in vehicle.truss_law.items() if name != "knee"}
    return varied(base, {"vehicle": vehicle.with_truss_law(**law)})


def unloading(base: Simulation, factor: float) -> Simulation:
    """Return a scene with the slope of unloading times a factor: infinite, nothing springs back."""
    vehicle = base.scene.vehicle
    if vehicle.zones:
        zones = {n: replace(zone, k_unloading=factor * zone.k_unloading) for n, zone in vehicle.zones.items()}
        return varied(base, {"vehicle": vehicle.with_zones(zones)})
    law: Mapping[str, float] = vehicle.truss_law
    return varied(base, {"vehicle": vehicle.with_truss_law(k_unloading=factor * law["k_unloading"])})


def elastic(base: Simulation) -> Simulation:
    """Return a scene with the least slope of unloading there can be: the steepest of loading."""
    vehicle = base.scene.vehicle
    if vehicle.zones:
        zones = {n: replace(zone, k_unloading=max(zone.curve.slope)) for n, zone in vehicle.zones.items()}
        return varied(base, {"vehicle": vehicle.with_zones(zones)})
    law: Mapping[str, float] = vehicle.truss_law
    steepest = max(law["k_initial"], law["k_hardening"])
    return varied(base, {"vehicle": vehicle.with_truss_law(k_unloading=steepest)})


def stepped(base: Simulation, factor: float) -> Simulation:
    """Return a scene with a fixed step, relative to the one that the program advises for it."""
    adaptive = varied(base, {"settings.time_step": None})
    critical = adaptive.run().statistics.least_critical_step
    return varied(base, {"settings.time_step": factor * ADVISED * critical})
