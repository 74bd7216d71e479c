"""A vehicle that has stopped ends its run, though skin and tyres keep it creeping. It is not redirected."""

from __future__ import annotations

import pytest
from birm3d import Barrier, Result, Settings, Simulation, Vehicle
from tires import held_straight

# Preset, barrier, speed (m/s), angle (deg), braking. Each is above a thousandth of its speed for 5 s.
CREEPING = {
    "rubs along a wall": ("cargo_truck", Barrier.rigid_wall(friction=0.3), 1.0, 2.0, 0.0),
    "leans on a pole": ("passenger_car", Barrier.pole(diameter=0.3, friction=0.8), 0.5, 8.0, 0.1),
    "climbs a Jersey barrier": ("pickup", Barrier.jersey(length=10.0, friction=0.0), 1.0, 25.0, 0.1),
    "brakes at a planter": ("semi_truck", Barrier.planter(friction=0.3), 0.5, 2.0, 0.3),
}

# Each stands still beside the wall as its skin and its tyres let go of it.
STANDING = {
    "car, light brakes": ("passenger_car", Barrier.rigid_wall(friction=0.0), 3.0, 8.0, 0.3),
    "pickup, locked wheels": ("pickup", Barrier.rigid_wall(friction=0.3), 13.0, 1.0, 1.0),
    "minivan, fast": ("minivan", Barrier.rigid_wall(friction=0.3), 20.0, 1.0, 1.0),
}


def run(case: tuple[str, Barrier, float, float, float], duration: float | None = None) -> Result:
    preset, barrier, speed, angle, braking = case
    vehicle = Vehicle.preset(preset, mesh_density=0.3)
    if preset == "cargo_truck":
        vehicle = held_straight(vehicle)
    settings = Settings(braking=braking)
    return Simulation(vehicle, barrier, speed, angle, settings=settings, duration=duration).run()


@pytest.mark.parametrize("name", CREEPING)
def test_a_vehicle_that_creeps_ends_its_run(name: str) -> None:
    result, long = run(CREEPING[name]), run(CREEPING[name], 5.0)
    assert (result.outcome, result.end_reason) == ("stopped", "stopped")
    assert result.metrics["end_time"] < 4.0
    assert (long.outcome, long.outcome_detail) == (result.outcome, result.outcome_detail)
    assert result.metrics.keys() == long.metrics.keys()
    for metric in ("peak_normal_force", "peak_force_50ms", "dynamic_crush"):
        assert result.metrics[metric] == pytest.approx(long.metrics[metric], rel=1e-9)
    for metric in (
        "max_roll",
        "max_pitch",
    ):  # the truck leans by 0.04 deg, and a little more while it settles
        assert result.metrics[metric] == pytest.approx(long.metrics[metric], rel=1e-3)
    moved = long.position[-1] - result.position[-1]
    assert (moved**2).sum() ** 0.5 < 0.03, "m; measured: 2 cm at the most"


@pytest.mark.parametrize("name", STANDING)
def test_a_vehicle_that_stands_still_beside_a_wall_is_not_redirected(name: str) -> None:
    result = run(STANDING[name])
    assert (result.outcome, result.end_reason) == ("stopped", "stopped")
    assert result.outcome_detail == "it came to rest at the barrier"
    assert "exit_speed" not in result.metrics


def test_a_vehicle_at_rest_that_its_skin_pushes_away_has_not_separated() -> None:
    """Its mass centre moves away by a millimetre a second while skin still touches the planter."""
    result = run(("minivan", Barrier.planter(friction=0.8), 2.0, 8.0, 1.0))
    assert (result.outcome, result.end_reason) == ("stopped", "stopped")
    assert abs(result.barrier_force[-1]).max() > 0.0
    assert "time_of_separation" not in result.metrics


def test_unbraked_wheels_still_slide_on() -> None:
    result = run(("cargo_truck", Barrier.rigid_wall(friction=0.0), 20.0, 1.0, 0.0))
    assert (result.outcome, result.end_reason) == ("redirected", "sliding")
