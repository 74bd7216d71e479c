"""Rate sensitivity and the pole: exact cases, balances, and nothing where the parameter is zero."""

from __future__ import annotations

import math

import numpy as np
import pytest
from birm3d import Barrier, Settings, Simulation, Vehicle, scenes
from birm3d.scene_parameters import value_of, varied

FREE = Settings(gravity=0.0, ground=False)
FINE = Settings(gravity=0.0, ground=False, tolerance=1e-5)


def heavy_block(mass: float = 1e9) -> Vehicle:
    """W2's front on a body so heavy that nothing slows it."""
    return scenes.laboratory_block(100, k_initial=3e6, knee=0.4, k_hardening=6e6, k_unloading=60e6).with_gvw(
        mass
    )


def test_rate_sensitivity_at_constant_speed() -> None:
    """A front that is crushed at a constant speed v has F(d) * (1 + (r v)^2)."""
    speed, r = 12.0, 0.05
    still = Simulation(heavy_block(), Barrier.rigid_wall(friction=0.0), speed, duration=0.03, settings=FREE)
    quick = varied(still, {"vehicle.rate_sensitivity": r})
    a, b = still.run(), quick.run()
    late = a.time > 0.002  # interval means: the first rows straddle the first touch
    factor = 1.0 + (r * speed) ** 2
    # The parabolas within the step that holds the knee are not its corner: 1.1e-6.
    assert b.barrier_normal_force[late] == pytest.approx(factor * a.barrier_normal_force[late], rel=5e-6)


@pytest.mark.parametrize("rate", [0.0, 0.05])
@pytest.mark.parametrize("angle", [90.0, 60.0])
def test_balances_close_at_walls_and_poles(rate: float, angle: float) -> None:
    car = Vehicle.preset("passenger_car", mesh_density=0.3).with_rate_sensitivity(rate)
    for barrier in (Barrier.rigid_wall(friction=0.2), Barrier.pole(diameter=0.35, friction=0.2)):
        metrics = Simulation(car, barrier, 14.0, angle).run().metrics
        assert metrics["energy_residual"] < 1e-3
        assert metrics["momentum_residual"] < 1e-9


def test_what_slows_down_returns_to_the_plain_law() -> None:
    """W2 with rate sensitivity: crush between that of the plain law and of the law at full speed."""
    plain = scenes.w2(100)
    r = 0.03
    factor = 1.0 + (r * 22.352) ** 2
    law = ("k_initial", "k_hardening", "k_unloading")
    stiff = varied(plain, {f"truss.{n}": factor * value_of(plain, f"truss.{n}") for n in law})
    crush = [
        s.run().metrics["dynamic_crush"]
        for s in (stiff, varied(plain, {"vehicle.rate_sensitivity": r}), plain)
    ]
    assert crush[0] < crush[1] < crush[2]


def test_rate_sensitivity_against_an_independent_integration() -> None:
    from scipy.integrate import solve_ivp

    r, mass, speed = 0.04, 6804.0, 22.352

    def envelope(d: float) -> float:
        return 3e6 * min(d, 0.4) + 6e6 * max(d - 0.4, 0.0)

    def stop(_: float, y: np.ndarray) -> float:
        return float(y[1])

    stop.terminal = True  # type: ignore[attr-defined]
    way = solve_ivp(
        lambda _, y: [y[1], -envelope(y[0]) * (1.0 + (r * y[1]) ** 2) / mass],
        (0.0, 1.0),
        [0.0, speed],
        events=stop,
        rtol=1e-10,
        atol=1e-12,
        max_step=1e-3,
    )
    result = varied(scenes.w2(100, FINE), {"vehicle.rate_sensitivity": r}).run()
    assert result.metrics["dynamic_crush"] == pytest.approx(way.y[0, -1], rel=1e-4)


def test_zero_costs_and_changes_nothing() -> None:
    plain = scenes.nhtsa_10146(mesh_density=0.3)
    off = varied(plain, {"vehicle.rate_sensitivity": 0.0})
    a, b = plain.run(), off.run()
    assert a.state_hash == b.state_hash
    assert a.statistics.node_evaluations == b.statistics.node_evaluations


# ---- the pole ---------------------------------------------------------------------------------------------


def test_a_pole_leaves_a_round_indentation_and_nothing_passes() -> None:
    car = Vehicle.preset("passenger_car")
    result = Simulation(car, Barrier.pole(diameter=0.3), 15.0).run()
    place = result.nodes + result.position[-1]
    assert abs(result.yaw).max() < 1e-6  # symmetric
    assert result.metrics["dynamic_crush"] > 0.3
    during = Simulation(car, Barrier.pole(diameter=0.3), 15.0, duration=0.03).run()
    place = during.nodes @ np.eye(3) + during.position[-1]
    gap = np.linalg.norm(place[:, :2], axis=1) - 0.15
    # Pitch is below 0.1 deg here: 0.1 deg over 4 m is 7 mm.
    assert gap.min() > -0.01
    assert (np.abs(gap) < 0.01).sum() > 20


@pytest.mark.parametrize("indentation_length", [0.0, 0.65])
def test_offset_poles_turn_the_vehicle_and_mirror(indentation_length: float) -> None:
    car = Vehicle.preset("passenger_car", mesh_density=0.5).with_indentation_length(indentation_length)
    left = Simulation(car, Barrier.pole(diameter=0.3), 12.0, 90.0, 0.5, duration=0.3).run()
    right = Simulation(car, Barrier.pole(diameter=0.3), 12.0, 90.0, -0.5, duration=0.3).run()
    assert abs(left.yaw[-1]) > 5.0
    assert left.yaw[-1] == pytest.approx(-right.yaw[-1], rel=1e-6)
    assert left.metrics["dynamic_crush"] == pytest.approx(right.metrics["dynamic_crush"], rel=1e-6)


@pytest.mark.filterwarnings("ignore::birm3d.MissedBarrierWarning")
def test_a_pole_that_is_passed_by_is_not_touched() -> None:
    car = Vehicle.preset("passenger_car", mesh_density=0.2)
    result = Simulation(car, Barrier.pole(diameter=0.3), 12.0, 90.0, 2.0, duration=0.8).run()
    assert result.barrier_normal_force.max() == 0.0


def test_standoff_of_a_pole() -> None:
    car = Vehicle.preset("passenger_car", mesh_density=0.2)
    for offset in (0.0, 0.6):
        result = Simulation(
            car, Barrier.pole(diameter=0.3), 12.0, 90.0, offset, standoff=0.05, duration=1e-3
        ).run()
        start = car.nodes + result.position[0]
        gap = np.linalg.norm(start[:, :2], axis=1) - 0.15
        assert gap.min() == pytest.approx(0.05, abs=1e-6)


@pytest.mark.parametrize(
    ("make", "naming"),
    [
        (lambda: Barrier.pole(diameter=0.0), "diameter must be finite and > 0 m, got 0.0"),
        (lambda: Barrier.pole(diameter=math.nan), "diameter"),
        (lambda: Barrier.pole(friction=-0.1), "friction"),
        (lambda: Barrier.pole(origin=(0.0, 0.0)), "origin"),  # type: ignore[arg-type]
        (lambda: heavy_block().with_rate_sensitivity(-1.0), "rate_sensitivity"),
        (lambda: heavy_block().with_rate_sensitivity(math.inf), "rate_sensitivity"),
    ],
)
def test_bad_input(make, naming: str) -> None:
    with pytest.raises(ValueError, match=naming):
        make()
