"""Wheels on springs: rest, bounce, dive, bump stops, energy, roll at barriers, and what files say."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path

import numpy as np
import pytest
from birm3d import Barrier, Result, Settings, Simulation, Vehicle, Zone, scenes
from birm3d.vehicle.vehicle_file import preset_path
from birm3d.vehicle.wheel_arguments import wheel_loads
from scipy.constants import g

SPRINGS = ("static_deflection", "damping_ratio", "bump_travel")


def sprung(vehicle: Vehicle, **changes: float | None) -> Vehicle:
    """The vehicle with other springs under all its wheels."""
    zones = {n: zone for n, zone in vehicle.zones.items() if zone.static_deflection is not None}
    return vehicle.with_zones({n: dataclasses.replace(zone, **changes) for n, zone in zones.items()})


def rigid(vehicle: Vehicle) -> Vehicle:
    return sprung(vehicle, **dict.fromkeys(SPRINGS))


@pytest.fixture(scope="module")
def car() -> Vehicle:
    return Vehicle.preset("passenger_car", mesh_density=0.1)


def alone(vehicle: Vehicle, speed: float = 0.0, duration: float = 1.0, **settings: float) -> Result:
    return Simulation(vehicle, None, speed, duration=duration, settings=Settings(**settings)).run()


def heavier(vehicle: Vehicle, share: float, tolerance: float, duration: float, **law: float) -> Result:
    """The weight grows by a share at once: the car falls and bounces about a lower level."""
    return alone(
        sprung(vehicle, **law), duration=duration, gravity=(1.0 + share) * g, tolerance=tolerance, mu_tire=0.0
    )


@pytest.mark.parametrize("name", ["passenger_car", "cargo_truck", "bus_13t", "semi_truck", "mash_36000v"])
def test_a_vehicle_stands_still_on_its_springs(name: str) -> None:
    """In equilibrium from the start: nothing moves by more than a micrometre in two seconds."""
    result = alone(Vehicle.preset(name, mesh_density=0.1), duration=2.0)
    assert np.abs(result.position - result.position[0]).max() < 1e-6
    assert abs(result.energy["suspension"]).max() < 1e-3  # J
    assert not result.energy["impacts"].any()  # no bump stop was met


def test_a_load_off_the_middle_stands_still_on_beam_axles(tmp_path: Path) -> None:
    """Each end carries its own load at rest. When both carried half, the truck rolled by 2.6 deg."""
    text = preset_path("cargo_truck").read_text(encoding="utf-8")
    engine = "box_m = [[-0.35, 0.65], [-0.42, 0.42], [0.65, 1.35]]\nmass_kg = 720"
    assert engine in text
    file = tmp_path / "truck.toml"
    file.write_text(text.replace(engine, engine.replace("[-0.42, 0.42]", "[0.1, 0.94]")), encoding="utf-8")
    truck = Vehicle.from_file(file, mesh_density=0.1)
    loads = wheel_loads(truck)
    assert abs(loads[truck.wheels[:, 1] > 0.0].sum() / loads.sum() - 0.5) > 0.02
    result = alone(truck, duration=2.0)
    assert np.abs(result.position - result.position[0]).max() < 1e-6
    assert np.abs(result.roll).max() < 1e-4
    assert abs(result.energy["suspension"]).max() < 1e-3  # J


def test_loads_at_rest_follow_the_lever_rule(car: Vehicle) -> None:
    loads = wheel_loads(car)
    assert loads.sum() == pytest.approx(car.mass * g, rel=1e-12)
    np.testing.assert_allclose(loads @ car.wheels[:, :2], 0.0, atol=1e-9 * car.mass * g)
    np.testing.assert_allclose(wheel_loads(car.with_gvw(1.2 * car.mass)).sum(), 1.2 * car.mass * g)


def test_a_car_bounces_with_the_period_of_its_static_deflection(car: Vehicle) -> None:
    """z = delta share (cos(w t) - 1), w^2 = g/delta, as all wheels have one deflection: exact."""
    deflection, share = 0.13, 0.02
    result = heavier(car, share, 1e-6, 1.0, damping_ratio=0.0)
    omega = math.sqrt(g / deflection)
    exact = deflection * share * (np.cos(omega * result.time) - 1.0)
    moved = result.position[:, 2] - result.position[0, 2]
    # All springs have one deflection, so that the car does not pitch. Measured: 6e-7 of the amplitude.
    np.testing.assert_allclose(moved, exact, atol=1e-5 * deflection * share)
    assert abs(result.energy["residual"]).max() < 1e-4 * abs(result.energy["potential"]).max()


def test_a_damper_takes_what_the_bounce_has(car: Vehicle) -> None:
    """Amplitudes of a damped oscillator: exp(-2 pi zeta / sqrt(1 - zeta^2)) from one bounce to the next."""
    ratio = 0.1
    result = heavier(car, 0.02, 1e-6, 1.6, damping_ratio=ratio)
    moved = result.position[:, 2] - result.position[0, 2]
    level = -0.02 * 0.13
    lows = [moved[k] - level for k in range(1, len(moved) - 1) if moved[k - 1] > moved[k] <= moved[k + 1]]
    decay = math.exp(-2.0 * math.pi * ratio / math.sqrt(1.0 - ratio**2))
    assert lows[1] / lows[0] == pytest.approx(decay, rel=1e-4)  # rows of 0.1 ms; measured 1e-6


def test_springs_are_followed_to_second_order(car: Vehicle) -> None:
    """Fixed steps: half of the step leaves a quarter of the error."""
    vehicle = sprung(car, damping_ratio=0.2)

    def height(step: float) -> float:
        choice = Settings(time_step=step, gravity=1.05 * g, output_interval=0.01, mu_tire=0.0)
        return float(Simulation(vehicle, None, 0.0, duration=0.5, settings=choice).run().position[-1, 2])

    coarse, middle, fine = (height(step) for step in (8e-3, 4e-3, 2e-3))
    assert (coarse - middle) / (middle - fine) == pytest.approx(4.0, rel=0.1)  # measured 3.98


def test_a_braked_car_dives_by_the_moment_over_the_stiffness(car: Vehicle) -> None:
    """Steady dive: m a h = sum of k x^2 times the angle, less what the weight adds as the nose sinks."""
    braking, mu = 0.3, 0.8
    rolling = sprung(car, damping_ratio=1.0, rolling_resistance=None)
    result = alone(rolling, 30.0, 2.0, braking=braking, mu_tire=mu)
    loads, x = wheel_loads(car), car.wheels[:, 0]
    moment = car.mass * braking * mu * g * car.mass_center_height
    stiffness = (loads / 0.13 * x**2).sum() - car.mass * g * car.mass_center_height
    # Measured 1.3 %: the levers of the wheels change a little.
    assert result.pitch[-1] == pytest.approx(np.degrees(moment / stiffness), rel=0.02)


def test_a_wheel_goes_no_further_than_its_bump_stop(car: Vehicle) -> None:
    """Three times the weight presses all springs together; the stops are rigid."""
    result = alone(sprung(car, bump_travel=0.05, damping_ratio=0.3), duration=1.0, gravity=3.0 * g)
    sunk = result.position[0, 2] - result.position[:, 2].min()
    assert sunk == pytest.approx(0.05, abs=1e-6)
    assert result.energy["impacts"][-1] > 0.0
    assert result.tire_reaction[-1].sum() == pytest.approx(3.0 * car.mass * g, rel=1e-3)


@pytest.mark.parametrize("damping_ratio", [0.0, 0.3, 1.0])
def test_the_energy_balance_closes_at_a_jersey_barrier(damping_ratio: float) -> None:
    vehicle = sprung(Vehicle.preset("mash_2270p", mesh_density=0.3), damping_ratio=damping_ratio)
    result = Simulation(vehicle, Barrier.jersey(), 27.8, impact_angle=25.0).run()
    assert abs(result.energy["residual"]).max() < 1e-3 * result.energy["kinetic"][0]  # tolerance 1e-3


def test_on_springs_a_pickup_rolls_more_and_a_truck_more_at_a_lower_barrier() -> None:
    """Rigid wheels took back most of the roll, and a lower barrier did not rank below a taller one."""

    def roll(vehicle: Vehicle, height: float, speed: float, angle: float) -> float:
        run = Simulation(vehicle, Barrier.jersey(height=height), speed, impact_angle=angle).run()
        return float(run.metrics["max_roll"])

    pickup = Vehicle.preset("mash_2270p", mesh_density=0.5)
    assert roll(pickup, 0.81, 27.8, 25.0) > 2.0 * roll(rigid(pickup), 0.81, 27.8, 25.0)
    truck = Vehicle.preset("mash_10000s", mesh_density=0.5)
    assert roll(truck, 0.81, 25.0, 15.0) > 1.2 * roll(truck, 1.07, 25.0, 15.0)


def test_the_paper_has_no_springs() -> None:
    assert not Vehicle.preset("paper_pickup", mesh_density=0.1).has_springs
    assert not rigid(Vehicle.preset("pickup", mesh_density=0.1)).has_springs


def test_without_springs_there_is_no_such_term_of_energy(car: Vehicle) -> None:
    assert "suspension" not in alone(rigid(car), duration=0.1).energy
    assert "suspension" in alone(car, duration=0.1).energy


def test_springs_come_back_from_a_saved_file(car: Vehicle, tmp_path: Path) -> None:
    changed = sprung(car, static_deflection=0.2, damping_ratio=0.0, bump_travel=0.11)
    changed.save(tmp_path / "car.toml")
    again = Vehicle.from_file(tmp_path / "car.toml", mesh_density=0.1)
    assert again.zones["tire"].static_deflection == 0.2
    assert again.zones["tire"].damping_ratio == 0.0
    assert again.zones["tire"].scaled(2.0, 3.0).bump_travel == 0.11


def test_another_envelope_of_the_treads_leaves_the_springs(car: Vehicle) -> None:
    stiffer = car.with_zone("tire", envelope=((0.0, 0.0), (0.1, 1e6)), k_unloading=2e7)
    assert stiffer.zones["tire"].static_deflection == car.zones["tire"].static_deflection


@pytest.mark.parametrize(
    ("numbers", "message"),
    [
        ({"static_deflection": 0.1}, "damping_ratio must be given beside static_deflection, got None"),
        ({"bump_travel": 0.1}, "static_deflection must be given beside bump_travel, got None"),
        (
            {"static_deflection": 0.0, "damping_ratio": 0.3, "bump_travel": 0.1},
            r"static_deflection must be finite and > 0, got 0\.0",
        ),
        (
            {"static_deflection": 0.1, "damping_ratio": 1.5, "bump_travel": 0.1},
            r"damping_ratio must be in \[0, 1\], got 1\.5",
        ),
    ],
)
def test_springs_that_make_no_sense_are_refused(numbers: dict[str, float], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        Zone(envelope=((0.0, 0.0), (0.1, 1e6)), k_unloading=2e7, **numbers)


def test_springs_are_parameters_of_a_scene() -> None:
    """As any number of a zone: a sweep or a calibration may vary them."""
    from birm3d.scene_parameters import varied

    scene = varied(scenes.rolling(0.1), {"zone.tire.static_deflection": 0.2}).scene
    assert scene.vehicle.zones["tire"].static_deflection == 0.2
