"""Named scenes that tests, benchmarks, examples and notebooks share.

Each returns a :class:`birm3d.Simulation` that is ready to run; its docstring gives source and exact answers.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from .. import units
from ..barrier.barrier import Barrier
from ..base.arguments import checked
from ..scene.settings import Settings
from ..signals.reference import NhtsaTest, nhtsa_tests
from ..units import Quantity
from ..vehicle.test_bodies import elastic_block, laboratory_block, laboratory_semi
from ..vehicle.vehicle import Vehicle
from ..vehicle.zone import positive
from .simulation import Simulation

__all__ = [
    "TABLE_2",
    "elastic_block",
    "laboratory_block",
    "laboratory_semi",
    "nhtsa_10146",
    "nhtsa_frontal",
    "oblique",
    "oblique_car",
    "paper_table_2",
    "parked",
    "pickup_at_bollards",
    "preset_for",
    "rolling",
    "truck_at_bollards",
    "truck_at_wall",
    "w1",
    "w2",
    "w2_force",
]

TABLE_2 = {20: 51.2121, 30: 80.1521, 40: 100.9540, 50: 109.1120, 60: 110.9010}
"""Paper, Table 2: impact speed [mph] -> peak deceleration along r [g]."""


def _laboratory(vehicle: Vehicle, settings: Settings | None) -> Simulation:
    settings = settings or Settings(gravity=0.0, ground=False)
    return Simulation(vehicle, Barrier.rigid_wall(friction=0.0), 22.352, settings=settings)


@checked
def w1(n: int = 1000, settings: Settings | None = None) -> Simulation:
    """Elastic impact at 50 mph. Exact: crush v sqrt(m/k) = 1.0645 m, peak 47.9 g, rebound -22.352 m/s."""
    return _laboratory(elastic_block(n), settings)


@checked
def w2(n: int = 1000, settings: Settings | None = None) -> Simulation:
    """Crush with a knee at 50 mph. Exact: crush 0.9256 m, peak 4,353.8 kN, rebound -6.814 m/s."""
    block = laboratory_block(n, k_initial=3e6, knee=0.4, k_hardening=6e6, k_unloading=60e6)
    return _laboratory(block, settings)


@checked
def w2_force(
    time: npt.ArrayLike,
    *,
    k_initial: float = 3e6,
    k_hardening: float = 6e6,
    knee: float = 0.4,
    k_unloading: float = 60e6,
) -> npt.NDArray[np.float64]:
    """Return the exact wall force of W2 [N] at times since the first touch [s], same shape.

    The block is one mass on one spring, w = sqrt(k / m), in three phases. These are to the knee, to the
    greatest crush, and along the unloading slope until the force is zero. Stiffnesses in N/m; the greatest
    crush must exceed the knee [m].
    """
    for name, value in (("k_initial", k_initial), ("k_hardening", k_hardening), ("k_unloading", k_unloading)):
        positive(name, value)
    t = np.asarray(time, float)
    mass, speed = 6804.0, 22.352
    w1, w2, w3 = (math.sqrt(k / mass) for k in (k_initial, k_hardening, k_unloading))
    if not knee * w1 < speed:
        raise ValueError(f"knee must be < {speed / w1:g} m, where the block turns before it; got {knee}")
    at_knee = math.asin(knee * w1 / speed) / w1
    knee_force = k_initial * knee
    rise = speed * math.cos(w1 * at_knee) * k_hardening / w2
    reversal = at_knee + math.atan2(rise, knee_force) / w2
    crushing = knee_force * np.cos(w2 * (t - at_knee)) + rise * np.sin(w2 * (t - at_knee))
    return np.select(
        [t < 0.0, t < at_knee, t < reversal, t < reversal + 0.5 * math.pi / w3],
        [
            np.zeros_like(t),
            k_initial * speed / w1 * np.sin(w1 * t),
            crushing,
            math.hypot(knee_force, rise) * np.cos(w3 * (t - reversal)),
        ],
        0.0,
    )


@checked
def paper_table_2(speed_mph: float, settings: Settings | None = None) -> Simulation:
    """Paper, case 2: its pickup head-on into a rigid wall; see :data:`TABLE_2`."""
    vehicle = Vehicle.preset("paper_pickup")
    return Simulation(vehicle, Barrier.rigid_wall(), units.mph(speed_mph), settings=settings)


@checked
def nhtsa_10146(settings: Settings | None = None, mesh_density: float = 1.0) -> Simulation:
    """NHTSA test 10146: a 1,719 kg sedan at 57.09 km/h into a rigid load-cell wall.

    Measured: peak CFC60 wall force 678 kN, greatest displacement of the momentum centre 0.677 m, zero
    velocity after 73 ms, restitution of the wall impulse 0.20.
    """
    vehicle = Vehicle.preset("passenger_car", gvw=1719.0, mesh_density=mesh_density)
    return Simulation(vehicle, Barrier.rigid_wall(), units.km_h(57.09), settings=settings)


@checked
def preset_for(test: NhtsaTest) -> str:
    """Name of the preset that stands for the vehicle of a test.

    The one of its class. A class that has none takes a front that was fitted to the same kind of structure (a
    unit body), that of the test vehicle nearest in mass. So a sport utility vehicle below 1,996 kg is a
    passenger car, above it a minivan.
    """
    if test.vehicle_class.startswith("pickup"):
        return "pickup"
    if test.vehicle_class == "car":
        return "passenger_car"
    if test.vehicle_class == "minivan":
        return "minivan"
    fitted = {"passenger_car": 1719.0, "minivan": 2273.0}
    return min(fitted, key=lambda name: abs(fitted[name] - test.mass))


@checked
def nhtsa_frontal(number: str, settings: Settings | None = None, mesh_density: float = 1.0) -> Simulation:
    """Return a full-width rigid-wall test of NHTSA, by its number in :func:`birm3d.reference.nhtsa_tests`.

    The preset of :func:`preset_for`, scaled to the mass of the vehicle tested.
    """
    tests = nhtsa_tests()
    if number not in tests or tests[number].kind != "frontal":
        known = ", ".join(name for name, test in tests.items() if test.kind == "frontal")
        raise ValueError(f"number must be one of {known}; got {number!r}")
    test = tests[number]
    vehicle = Vehicle.preset(preset_for(test), mesh_density=mesh_density).scaled_to(test.mass)
    return Simulation(vehicle, Barrier.rigid_wall(), test.speed, settings=settings)


@checked
def truck_at_wall(settings: Settings | None = None, mesh_density: float = 1.0) -> Simulation:
    """Paper, case 4: a 15,000-lb truck at 50 mph head-on into a rigid wall.

    Film of a test of the Texas Transportation Institute showed a greatest pitch of 27 deg, which the front
    of the preset is fitted to. The rear wheels are in the air for more than a second.
    """
    truck = Vehicle.preset("cargo_truck", mesh_density=mesh_density)
    return Simulation(truck, Barrier.rigid_wall(), units.mph(50.0), duration=1.5, settings=settings)


@checked
def truck_at_bollards(
    settings: Settings | None = None,
    mesh_density: float = 1.0,
    *,
    diameter: float = 0.32,
    height: float = 1.0,
    spacing: float = 1.2,
    offset: float = 0.0,
) -> Simulation:
    """Paper, case 4: the truck of :func:`truck_at_wall` head-on into five bollards; nothing is fitted to it.

    Film showed a greatest pitch of 23 deg, the paper computed 22. The sizes of the tested array were not
    found published: these are common ones, the middle bollard meets the middle of the truck. `diameter`,
    `height`, `spacing` centre to centre and `offset` of the truck along the row in m.
    """
    truck = Vehicle.preset("cargo_truck", mesh_density=mesh_density)
    row = Barrier.bollards(count=5, diameter=diameter, height=height, spacing=spacing)
    return Simulation(truck, row, units.mph(50.0), 90.0, offset, duration=1.5, settings=settings)


@checked
def pickup_at_bollards(
    clear_spacing: float,
    offset: float = 0.0,
    settings: Settings | None = None,
    mesh_density: float = 1.0,
    *,
    diameter: float = 0.22,
    height: float = 0.9,
) -> Simulation:
    """Pickup at 30 mph head-on into a long row of rigid bollards; a designer's question, no test.

    `clear_spacing` between neighbours, `offset` of the pickup's middle from that of a bollard along the row,
    `diameter` and `height` in m. The row has as many bollards as the pickup can meet.
    """
    pickup = Vehicle.preset("pickup", mesh_density=mesh_density)
    row = Barrier.bollards(count=7, diameter=diameter, height=height, spacing=clear_spacing + diameter)
    return Simulation(pickup, row, units.mph(30.0), 90.0, offset, duration=1.0, settings=settings)


@checked
def oblique(angle: float, friction: float = 0.0, settings: Settings | None = None) -> Simulation:
    """Passenger car of 4,500 lb at 59.8 mph (paper, case 3, at 24 deg) against a rigid wall."""
    vehicle = Vehicle.preset("passenger_car", gvw=units.lb(4500))
    return Simulation(
        vehicle, Barrier.rigid_wall(friction=friction), units.mph(59.8), angle, settings=settings
    )


@checked
def oblique_car(
    friction: float = 0.175, settings: Settings | None = None, mesh_density: float = 1.0
) -> Simulation:
    """Paper, case 3: a 4,500-lb car at 59.8 mph and 24 deg into an instrumented rigid wall.

    The test (1975 Plymouth Fury, Texas Transportation Institute) is known by its conditions only: the angles
    that the paper compares are a figure without numbers. Friction of 0.15 to 0.20 is the paper's range.
    """
    vehicle = Vehicle.preset("passenger_car", gvw=units.lb(4500), mesh_density=mesh_density)
    wall = Barrier.rigid_wall(friction=friction)
    return Simulation(vehicle, wall, units.mph(59.8), 24.0, settings=settings)


@checked
def rolling(duration: Quantity = 2.0, settings: Settings | None = None) -> Simulation:
    """Paper, case 1: a pickup that rolls at 30 mph; the tyre reactions sum to its weight."""
    return Simulation(Vehicle.preset("pickup"), None, units.mph(30.0), duration=duration, settings=settings)


@checked
def parked(duration: Quantity = 10.0, settings: Settings | None = None) -> Simulation:
    """Pickup that stands still."""
    return Simulation(Vehicle.preset("pickup"), None, 0.0, duration=duration, settings=settings)
