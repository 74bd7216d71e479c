"""Springback: what covers come back by without force lessens the residual crush, and nothing else."""

from __future__ import annotations

import pytest
from birm3d import Barrier, Simulation, Vehicle, scenes

FRONT = ("engine", "bumper", "engine_bay")


def _car(springback: float | None) -> Vehicle:
    car = Vehicle.preset("passenger_car", mesh_density=0.3)
    for zone in FRONT:
        car = car.with_zone(zone, springback=springback)
    return car


def test_only_residual_crush_depends_on_it() -> None:
    hard, soft = (Simulation(_car(s), Barrier.rigid_wall(), 15.0) for s in (0.0, 0.05))
    before, after = hard.run().metrics, soft.run().metrics
    assert hard.state_hash() == soft.state_hash()
    # The front is the deepest, with and without: the difference is the springback itself.
    assert before["residual_crush"] - after["residual_crush"] == pytest.approx(0.05, abs=1e-12)
    for name in ("dynamic_crush", "max_displacement", "exit_speed", "peak_normal_force_cfc60"):
        assert before[name] == after[name]


def test_covers_do_not_come_back_past_where_they_were() -> None:
    assert Simulation(_car(0.3), Barrier.rigid_wall(), 1.0).run().metrics["residual_crush"] == 0.0


def test_it_stays_with_the_vehicle_that_is_still_at_the_barrier() -> None:
    crash = Simulation(_car(0.05), Barrier.rigid_wall(), 15.0, duration=0.06)
    metrics = crash.run().metrics
    # No separation yet: what is reported is the deflection of the loaded front.
    assert metrics["residual_crush"] > metrics["dynamic_crush"] - 0.01


def test_static_crush_of_the_tests_it_was_taken_from() -> None:
    for number, static in (("10146", 0.518), ("7460", 0.520)):
        # Chosen as 8 cm for both, which need 7.8 and 7.6 cm.
        crush = scenes.nhtsa_frontal(number).run().metrics["residual_crush"]
        assert crush == pytest.approx(static, abs=0.006)


def test_it_must_not_be_negative() -> None:
    with pytest.raises(ValueError, match=r"springback must be .*>= 0, got -0\.1"):
        Vehicle.preset("passenger_car", mesh_density=0.3).with_zone("bumper", springback=-0.1)
