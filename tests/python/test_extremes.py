"""Scalars that the core finds without looking at every row are those of the rows."""

from __future__ import annotations

import math

import numpy as np
import pytest
from birm3d import Barrier, Result, Settings, Simulation, Vehicle, monte_carlo, sweep
from scipy import stats

WINDOW = 0.05  # s, of the means


@pytest.fixture(scope="module")
def pickup() -> Vehicle:
    return Vehicle.preset("pickup", mesh_density=0.1)


def crash(vehicle: Vehicle, barrier: Barrier, angle: float = 90.0, **others: float) -> Result:
    interval = {"settings": Settings(output_interval=5e-4)}
    return Simulation(vehicle, barrier, 17.0, angle, **interval, **others).run()  # type: ignore[arg-type]


def greatest(angle: np.ndarray) -> float:
    return float(np.abs(np.degrees(np.unwrap(np.radians(angle)))).max())


@pytest.mark.parametrize(
    ("barrier", "angle", "others"),
    [
        (Barrier.rigid_wall(), 90.0, {}),  # does not turn
        (Barrier.rigid_wall(), 30.0, {}),  # turns by less than a quarter
        (Barrier.rigid_wall(heading=150.0), 30.0, {}),  # the same, seen from other axes
        (Barrier.pole(diameter=0.3), 90.0, {"impact_offset": 0.6, "duration": 2.5}),  # spins
        (Barrier.rigid_wall(), 60.0, {"impact_roll": 80.0, "duration": 0.5}),  # lies nearly on its side
    ],
)
def test_greatest_angles_are_those_of_the_rows(
    pickup: Vehicle, barrier: Barrier, angle: float, others: dict[str, float]
) -> None:
    result = crash(pickup, barrier, angle, **others)
    metrics = result.metrics
    assert metrics["max_roll"] == pytest.approx(greatest(result.roll), rel=1e-12, abs=1e-12)
    assert metrics["max_pitch"] == pytest.approx(greatest(result.pitch), rel=1e-12, abs=1e-12)
    turned = np.degrees(np.unwrap(np.radians(result.yaw - result.yaw[0])))
    rows = result.time <= metrics.get("time_of_separation", math.inf)
    assert metrics["max_yaw"] == pytest.approx(np.abs(turned[rows]).max(), rel=1e-9, abs=1e-12)


def test_moments_of_posts_are_the_greatest_of_any_row_and_any_mean(pickup: Vehicle) -> None:
    result = crash(pickup, Barrier.bollards(count=3), impact_offset=0.2)
    rows = round(WINDOW / float(result.time[1]))
    at_once, means = [], []
    for load in result.element_loads:
        moment = load.moment[:, :2]
        at_once.append(np.hypot(*moment.T).max())
        sums = np.cumsum(np.vstack([np.zeros((rows, 2)), moment]), axis=0)
        means.append((np.hypot(*(sums[rows:] - sums[:-rows]).T) / rows).max())
    assert result.metrics["peak_overturning_moment"] == pytest.approx(max(at_once), rel=1e-12)
    assert result.metrics["peak_overturning_moment_50ms"] == pytest.approx(max(means), rel=1e-12)


def test_balances_of_the_rows_are_those_of_the_metrics(pickup: Vehicle) -> None:
    result = crash(pickup, Barrier.rigid_wall(), 40.0)
    residual = np.abs(result.energy["residual"]).max() / result.energy["kinetic"][0]
    assert result.metrics["energy_residual"] == pytest.approx(residual, rel=1e-9, abs=1e-15)
    assert 0.0 < result.metrics["momentum_residual"] < 1e-9


def test_studies_have_the_scalars_of_single_runs_bit_for_bit(pickup: Vehicle) -> None:
    base = Simulation(pickup, Barrier.rigid_wall(), 17.0)
    inputs = {"vehicle.gvw": stats.uniform(2300.0, 300.0), "barrier.friction": stats.uniform(0.1, 0.2)}
    study = monte_carlo(base, inputs, 4, seed=2)
    for row in range(len(study)):
        gvw, friction = (float(study.parameters[name][row]) for name in inputs)
        vehicle = pickup.with_gvw(gvw)
        alone = Simulation(vehicle, Barrier.rigid_wall(friction=friction), 17.0).run().metrics
        for name in study.metrics:
            if name != "run_time":
                assert study[name][row] == pytest.approx(alone.get(name, math.nan), rel=0.0, nan_ok=True), (
                    name
                )


def test_a_mass_out_of_range_is_the_reason_of_its_run(pickup: Vehicle) -> None:
    base = Simulation(pickup, Barrier.rigid_wall(), 17.0)
    study = sweep(base, {"vehicle.gvw": [-1.0, 2300.0]})
    assert list(study.failed) == [0]
    assert "gvw must be finite and > 0" in study.failed[0]
