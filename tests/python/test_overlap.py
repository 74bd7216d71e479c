"""How far the rigid body got into a barrier is measured on the body, whatever the mesh."""

from __future__ import annotations

import re

import pytest
from birm3d import Barrier, CoarseSkinWarning, OverlapWarning, Simulation, Vehicle
from birm3d.result.overlap import OVERLAP_LIMIT


def test_a_pole_that_passes_between_nodes_is_warned_of() -> None:
    """Trusses hold the body at their anchors only; here a pole finds room between them."""
    coarse = Vehicle.preset("cargo_truck", mesh_density=0.02).with_indentation_length(0.0)
    with pytest.warns(CoarseSkinWarning, match="width of the pole"):
        simulation = Simulation(
            coarse,
            Barrier.pole(diameter=0.24),
            15.0,
            43.5,
            -0.3,
            impact_roll=90.0,
            impact_yaw=71.6,
            duration=1.0,
        )
    with pytest.warns(OverlapWarning, match=re.escape("inside 'pole'; a finer mesh")):
        result = simulation.run()
    assert result.metrics["contact_overlap"] > 0.2  # through the middle of the load, 0.35 m half wide
    assert result.statistics.deepest_point < 1e-3  # no anchor met it
    assert 0.0 < result.statistics.greatest_overlap_time < result.time[-1]


def test_a_body_on_its_side_in_a_pole_is_warned_of() -> None:
    pickup = Vehicle.preset("pickup", mesh_density=0.05)
    simulation = Simulation(
        pickup, Barrier.pole(), 15.0, 31.5643, 0.072017, impact_roll=-90.0, impact_yaw=111.48609, duration=1.0
    )
    with pytest.warns(OverlapWarning):
        simulation.run()


@pytest.mark.parametrize("angle", [90.0, 25.0])
@pytest.mark.parametrize("barrier", [Barrier.rigid_wall(), Barrier.bollards(), Barrier.pole()], ids=str)
def test_usual_crashes_keep_the_body_out(barrier: Barrier, angle: float) -> None:
    """Edges between anchors may enter by a few centimetres; a warning would be an error here."""
    result = Simulation(Vehicle.preset("pickup", mesh_density=0.3), barrier, 20.0, angle).run()
    assert result.metrics["contact_overlap"] < 0.5 * OVERLAP_LIMIT
