"""Random impacts of the presets: no error, no NaN, balances that close."""

from __future__ import annotations

import numpy as np
import pytest
from birm3d import Barrier, Simulation, Vehicle

CARS = [Vehicle.preset(name, mesh_density=0.2) for name in ("passenger_car", "pickup", "paper_pickup")]


@pytest.mark.filterwarnings("ignore::birm3d.MissedBarrierWarning")  # some go past the pole
# Of a coarse mesh a pole can enter the side of the core between anchors: that is warned of.
@pytest.mark.filterwarnings("ignore::birm3d.OverlapWarning")
@pytest.mark.parametrize("seed", range(40))
def test_random_impact(seed: int) -> None:
    random = np.random.default_rng(seed)
    car = CARS[random.integers(3)].with_rate_sensitivity(0.06 if seed % 5 == 0 else 0.0)
    friction = random.uniform(0.0, 0.4)
    wall = seed % 2 == 0
    barrier = (
        Barrier.rigid_wall(friction=friction)
        if wall
        else Barrier.pole(diameter=random.uniform(0.1, 0.6), friction=friction)
    )
    speed, angle = random.uniform(1.0, 45.0), random.uniform(5.0, 90.0)
    offset = 0.0 if wall else random.uniform(-1.2, 1.2)
    result = Simulation(car, barrier, speed, angle, offset, duration=0.5).run()
    assert np.isfinite(result.position).all()
    # The default tolerance; of 600 such impacts the worst left 4.5e-4.
    assert result.metrics["energy_residual"] < 1e-3
    assert result.metrics["momentum_residual"] < 1e-9
