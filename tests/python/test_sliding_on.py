"""A truck whose straight wheels press it on a barrier slides on, until nothing can change any more."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from birm3d import Barrier, Result, Settings, Simulation, Vehicle
from tires import held_straight

SPEED, ANGLE = 10.0, 8.0  # m/s, degrees


@cache
def at(barrier: Barrier, duration: float | None = None, speed: float = SPEED) -> Result:
    truck = held_straight(Vehicle.preset("cargo_truck", mesh_density=0.3))
    return Simulation(truck, barrier, speed, ANGLE, duration=duration).run()


def test_a_pressed_truck_that_is_at_rest_sideways_ends_the_run() -> None:
    """Its skin stores energy as long as it moves. Once such runs took 5 s."""
    result, long = at(Barrier.rigid_wall()), at(Barrier.rigid_wall(), 5.0)
    assert result.end_reason == "sliding"
    assert result.metrics["end_time"] < 2.5, "measured: 1.8 s"
    assert result.energy["stored"][-1] > 10.0 * 1e-6 * result.energy["kinetic"][0]
    assert (result.outcome, result.outcome_detail) == ("redirected", "it slides on along the barrier")
    assert (long.outcome, long.outcome_detail) == (result.outcome, result.outcome_detail)
    for metric in ("exit_speed", "exit_angle", "time_of_separation"):
        assert metric not in result.metrics
        assert metric not in long.metrics
    for metric in ("dynamic_crush", "max_yaw", "max_roll", "peak_force_50ms", "later_contacts"):
        assert result.metrics[metric] == pytest.approx(long.metrics[metric], rel=1e-3)
    after = long.time > result.metrics["end_time"]
    assert np.abs(long.velocity[after, 0]).max() < 1e-2, "m/s; nothing changed afterwards"


@pytest.mark.parametrize(
    ("width", "end_reason", "outcome"), [(30.0, "longest", "passed"), (58.0, "longest", "redirected")]
)
def test_a_truck_that_reaches_the_end_of_its_wall_goes_on_to_it(
    width: float, end_reason: str, outcome: str
) -> None:
    """It is at rest sideways before, and its straight wheels lead it past the line there."""
    result = at(Barrier.rigid_wall(width=width, height=2.0, thickness=0.5))
    assert (result.end_reason, result.outcome) == (end_reason, outcome)
    assert result.position[-1, 1] > 0.5 * width


@pytest.mark.parametrize("width", [90.0, 200.0])
def test_a_long_wall_ends_the_run_as_an_endless_one_does(width: float) -> None:
    """Its rounded ends are out of reach."""
    wall = at(Barrier.rigid_wall(width=width, height=5.0, thickness=0.5))
    assert wall.end_reason == "sliding"
    assert wall.metrics["end_time"] == pytest.approx(at(Barrier.rigid_wall()).metrics["end_time"], rel=0.05)


def test_a_run_of_long_duration_still_sees_the_truck_turn_behind_the_wall() -> None:
    """After 5 s it is beside the wall. At the end of the wall its straight wheels lead it past the line."""
    result = at(Barrier.rigid_wall(width=110.0, height=2.0, thickness=0.5), 12.0)
    assert (result.outcome, result.end_reason) == ("passed", "duration")
    assert result.metrics["time_of_separation"] > 5.0


def test_a_truck_that_friction_will_stop_is_not_redirected() -> None:
    truck = held_straight(Vehicle.preset("cargo_truck", mesh_density=0.3))
    settings = Settings(braking=0.3)
    result = Simulation(truck, Barrier.rigid_wall(), SPEED, ANGLE, settings=settings).run()
    assert result.outcome == "stopped"
