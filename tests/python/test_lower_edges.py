"""Skin is drawn in above a post's or a wall's top only where the panel reaches down to it."""

from __future__ import annotations

import warnings

import birm3d
import numpy as np
import pytest
from birm3d import Barrier, Simulation, Vehicle, units

LOW, HIGH = 0.4, 1.2  # m: lower edge of the left and of the right half


def stepped_block() -> Vehicle:
    """A flat front of 2.4 m; its right half begins higher above the ground than its left half."""
    y, z = (grid.ravel() for grid in np.meshgrid(np.linspace(-1.2, 1.2, 25), np.linspace(LOW, 2.0, 17)))
    kept = (y > 0.0) | (z >= HIGH - 1e-9)
    n, height = int(kept.sum()), 1.0
    nodes = np.column_stack([np.full(n, 2.0), y[kept], z[kept] - height])
    return Vehicle.from_arrays(
        mass=5000.0,
        inertia=np.diag([3e3, 1e4, 1e4]),
        nodes=nodes,
        anchors=nodes - [1.5, 0.0, 0.0],
        k_initial=1e6 / n,
        knee=1.0,
        k_hardening=0.0,
        f_max=1e6 / n,
        k_unloading=1e7 / n,
        mass_center_height=height,
    ).with_indentation_length(0.65)


@pytest.mark.parametrize(
    "barrier",
    [
        Barrier.rigid_wall(width=0.5, height=0.8),
        Barrier.planter(length=0.5, width=0.6, height=0.8),
        Barrier.bollards(count=1, diameter=0.3, height=0.8),
    ],
)
def test_what_passes_below_the_lower_edge_draws_nothing_in(barrier: Barrier) -> None:
    """The box around the front reaches down to 0.4 m: once such a wall drew in the half above it."""
    block = stepped_block()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the rigid body is met later
        right = Simulation(block, barrier, 5.0, impact_offset=0.9, duration=0.15).run()
        left = Simulation(block, barrier, 5.0, impact_offset=-0.9, duration=0.15).run()
    assert abs(right.barrier_force).max() == 0.0
    assert abs(left.barrier_force).max() > 1e4


@pytest.mark.filterwarnings("ignore::birm3d.LowBarrierWarning")
@pytest.mark.parametrize("height", [0.76, 0.82, 0.88, 0.94])
def test_a_wall_below_a_trailer_leaves_its_sill(height: float) -> None:
    """The sill begins at 1.2 m. Once it was drawn in by 0.1 m while the wall was under the trailer."""
    vehicle = Vehicle.preset("mash_36000v")
    result = Simulation(vehicle, Barrier.rigid_wall(height=height), units.mph(50), 15).run()
    trailer, unit = vehicle.units[1], result.unit(1)
    sill = trailer.zone_of_node == list(trailer.zones).index("trailer_sill")
    assert unit.peak_deflection[sill].max() == 0.0


def test_the_force_of_a_trailer_differs_little_between_walls() -> None:
    """How far it rolls decides what bears on the top: 891 to 1,042 kN, the greatest at 0.94 m."""
    vehicle = Vehicle.preset("mash_36000v")
    forces = [
        Simulation(vehicle, Barrier.rigid_wall(height=h), units.mph(50), 15).run().metrics["peak_force_50ms"]
        for h in (0.82, 0.94, 1.06, 1.3)
    ]
    assert max(forces) < 1.2 * min(forces)
    assert forces[-1] > forces[0]


def test_energy_while_edges_come_down_on_a_wall() -> None:
    """A box whose lower edge rolls down in front of the wall, then is drawn in: it closes, and converges."""
    truck = Vehicle.preset("mash_10000s", mesh_density=0.4)
    left = []
    for tolerance in (1e-3, 1e-4):
        settings = birm3d.Settings(tolerance=tolerance)
        wall = Barrier.rigid_wall(height=0.82)
        result = Simulation(truck, wall, units.mph(56), 15.0, duration=1.5, settings=settings).run()
        left.append(abs(result.metrics["energy_residual"]))
    assert left[0] < 5e-4
    assert left[1] < 0.5 * left[0]
