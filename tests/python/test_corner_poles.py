"""Poles that meet the rounded corner of a front obliquely, between what the front and the side have there."""

import warnings
from itertools import pairwise

import numpy as np
import pytest
from birm3d import (
    Barrier,
    CoreContactWarning,
    MissedBarrierWarning,
    OverlapWarning,
    Result,
    Settings,
    Simulation,
    Vehicle,
)

SPEED = 14.0  # m/s


def crash(
    preset: str, offset: float, yaw: float, *, diameter: float = 0.3, tolerance: float = 1e-3
) -> Result:
    pole = Barrier.pole(diameter=diameter)
    settings = Settings(tolerance=tolerance)
    scene = Simulation(
        Vehicle.preset(preset), pole, SPEED, impact_offset=offset, impact_yaw=yaw, settings=settings
    )
    with warnings.catch_warnings():
        for expected in (CoreContactWarning, MissedBarrierWarning, OverlapWarning):
            warnings.simplefilter("ignore", expected)
        return scene.run()


def share_of_rigid_impulse(result: Result, offset: float) -> float:
    """Impulse of the pole over that on a rigid body which does not rebound."""
    vehicle = result.scene.vehicle
    inertia = vehicle.inertia[2, 2]
    rigid = inertia / (inertia + vehicle.mass * offset**2) * vehicle.mass * SPEED
    return float(-result.barrier_force[:, 0].sum() * result.scene.settings.output_interval / rigid)


@pytest.mark.parametrize("preset", ["sedan_1500", "pickup", "mash_1100c", "cargo_truck"])
@pytest.mark.parametrize("yaw", [35.0, 50.0, 65.0])
@pytest.mark.parametrize("diameter", [0.1, 0.3])
def test_no_pole_passes_through_a_corner(preset: str, yaw: float, diameter: float) -> None:
    """Poles that came past the edges of both panels were held by neither: 0.01 of a rigid body's impulse."""
    vehicle = Vehicle.preset(preset)
    half = 0.5 * (vehicle.length * np.sin(np.radians(yaw)) + vehicle.width * np.cos(np.radians(yaw)))
    shares = []
    for offset in np.arange(-half, 0.0, 0.05):
        result = crash(preset, offset, yaw, diameter=diameter)
        shares.append(share_of_rigid_impulse(result, offset))
        assert result.metrics["energy_residual"] < 5e-3, "where a run warns; a smaller tolerance mends it"
    begins = next(i for i, share in enumerate(shares) if share > 0.3)
    assert begins < 0.7 * len(shares)
    assert min(shares[begins:]) > 0.25


def test_a_pole_at_a_corner_is_held_as_one_beside_it() -> None:
    offsets = (-0.64, -0.60, -0.56, -0.54, -0.50, -0.48)
    shares = [share_of_rigid_impulse(crash("sedan_1500", offset, 40.0), offset) for offset in offsets]
    assert min(shares) > 1.0
    assert all(abs(one - other) < 0.25 for one, other in pairwise(shares))


@pytest.mark.parametrize(
    ("preset", "offset", "yaw"), [("sedan_1500", -1.28, 60.0), ("sedan_1500", -0.98, 50.0)]
)
def test_energy_is_balanced_the_better_the_smaller_the_tolerance(
    preset: str, offset: float, yaw: float
) -> None:
    """The indentation stays behind the pole. Were the force at the wrong place, this would not converge."""
    coarse, fine = (
        crash(preset, offset, yaw, tolerance=tolerance).metrics["energy_residual"]
        for tolerance in (1e-3, 1e-5)
    )
    assert coarse < 1e-3
    assert fine < 2e-5


def test_corners_of_both_sides_are_alike() -> None:
    right, left = (crash("sedan_1500", side * -0.56, side * 40.0) for side in (1.0, -1.0))
    rows = 400
    np.testing.assert_allclose(
        left.barrier_force[:rows],
        right.barrier_force[:rows] * [1.0, -1.0, 1.0],
        atol=2e-2 * np.abs(right.barrier_force).max(),
    )
