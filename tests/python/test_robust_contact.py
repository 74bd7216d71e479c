"""Nothing ends a step inside a barrier, a wall in segments is the same wall, and gliding costs few steps."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from birm3d import Barrier, Simulation, Vehicle

# Depth in which a node may be left where three faces meet (m).
DEPTH = 5e-3


def deepest(simulation: Simulation) -> tuple[float, float]:
    """Run to the end; return how deep the deepest node and anchor were at the end of any step [m]."""
    node = anchor = 0.0
    while simulation.step():
        node = max(node, simulation._core.deepest_node)
        anchor = max(anchor, simulation._core.deepest_anchor)
    return node, anchor


def car(name: str = "passenger_car") -> Vehicle:
    return Vehicle.preset(name, mesh_density=0.3)


# Each once left nodes 5 to 215 mm inside: let go where they were pushed back to, changed over from one face
# to another beside an edge, or drawn out so far that the barrier was thought out of reach.
@pytest.mark.parametrize(
    ("name", "barrier", "speed", "angle", "limit"),
    [
        ("passenger_car", Barrier.rigid_wall(width=6.0, height=1.0), 25.0, 10.0, 1e-3),
        ("passenger_car", Barrier.rigid_wall(width=6.0, height=1.0), 40.0, 45.0, 1e-3),
        ("passenger_car", Barrier.bollards(), 40.0, 25.0, 1e-3),
        ("cargo_truck", Barrier.bollards(), 40.0, 10.0, 1e-3),
        ("paper_pickup", Barrier.jersey(length=30.0), 40.0, 45.0, DEPTH),
    ],
)
def test_no_node_ends_a_step_inside(
    name: str, barrier: Barrier, speed: float, angle: float, limit: float
) -> None:
    node, anchor = deepest(Simulation(car(name), barrier, speed, angle))
    assert node < limit
    assert anchor < 1e-4


@pytest.mark.parametrize(
    "barrier",
    [
        lambda segments: Barrier.rigid_wall(width=24.0, height=1.0, segments=segments),
        lambda segments: Barrier.jersey(length=30.0, segments=segments),
    ],
    ids=["wall", "jersey"],
)
def test_segments_are_the_same_wall(barrier: Callable[[int], Barrier]) -> None:
    """To rounding, which grows in 300 steps of a crash: 3e-11 m/s was measured."""
    whole = Simulation(car(), barrier(1), 26.7, 25.0).run()
    for segments in (2, 8):
        split = Simulation(car(), barrier(segments), 26.7, 25.0).run()
        assert split.statistics.steps == whole.statistics.steps
        assert split.end_reason == whole.end_reason
        np.testing.assert_allclose(split.velocity, whole.velocity, rtol=0.0, atol=1e-8)
        np.testing.assert_allclose(split.final_nodes(), whole.final_nodes(), rtol=0.0, atol=1e-9)
        np.testing.assert_allclose(split.barrier_force, whole.barrier_force, rtol=0.0, atol=1e-2)


def test_gliding_along_a_wall_costs_few_steps() -> None:
    """A car that has left a wall glides along it, millimetres away: steps may be long all the same."""
    endless = Simulation(car(), Barrier.rigid_wall(), 26.7, 25.0).run()
    finite = Simulation(car(), Barrier.rigid_wall(width=6.0, height=1.0), 26.7, 25.0).run()
    assert endless.statistics.steps < 250
    assert finite.statistics.steps < 1.5 * endless.statistics.steps
