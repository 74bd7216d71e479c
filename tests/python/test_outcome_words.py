"""The sentence on an outcome says where the vehicle is at the end, and speaks of posts as posts."""

from __future__ import annotations

import birm3d
import numpy as np
import pytest
from birm3d import Barrier, Result, Simulation, Vehicle

POLE = Barrier.pole(diameter=0.3)
POSTS = Barrier.bollards(count=3, spacing=1.3)

# The skin is coarse to be quick.
pytestmark = pytest.mark.filterwarnings(
    "ignore::birm3d.CoarseSkinWarning", "ignore::birm3d.CoreContactWarning"
)


def run(name: str, barrier: Barrier, speed: str, offset: float, **given: float) -> Result:
    vehicle = Vehicle.preset(name, mesh_density=0.6)
    return Simulation(vehicle, barrier, speed, given.pop("angle", 90.0), offset, **given).run()


def test_a_vehicle_that_came_back_before_the_line_says_so() -> None:
    """It turns about the pole, with its mass centre past the line, and leaves on the traffic side."""
    result = run("pickup", POLE, "100 km/h", 0.4, impact_yaw=135.0)
    before = -result.position[-1, 0]
    assert before > 5.0
    assert result.position[:, 0].max() > 0.05
    assert result.outcome_detail == (
        "it passed beside the pole, touching it, and came back: "
        f"its mass centre was {before:.1f} m before the barrier's line when the run ended"
    )


def test_a_vehicle_that_never_reached_the_line_says_so_wherever_the_barrier_stands() -> None:
    result = run("small_car", POSTS, "80 km/h", 1.0, impact_yaw=-135.0)
    assert result.position[-1, 0] < -5.0
    said = result.outcome_detail
    assert said == (
        "it left beside the barrier's end, touching it: "
        f"its mass centre was {-result.position[-1, 0]:.1f} m before the barrier's line when the run ended"
    )
    there = birm3d.Barrier.bollards(count=3, spacing=1.3, origin=(3.0, -2.0, 0.0), heading=30.0)
    placed = Vehicle.preset("small_car", mesh_density=0.6)
    again = Simulation(placed, there, "80 km/h", 90.0, there.station() + 1.0, impact_yaw=-135.0).run()
    assert again.outcome_detail == said


@pytest.mark.parametrize(("offset", "name"), [(0.8, "pole"), (-0.9, "bollard")])
def test_a_vehicle_past_a_single_post_passed_beside_it(offset: float, name: str) -> None:
    post = POLE if name == "pole" else Barrier.bollards(count=1, spacing=1.0)
    result = run("small_car", post, "80 km/h", offset)
    assert result.position[-1, 0] > 1.0
    assert result.outcome_detail == f"it passed beside the {name}, touching it"


def test_a_vehicle_past_a_row_passed_its_end() -> None:
    result = run("small_car", POSTS, "80 km/h", 2.1)
    assert result.outcome_detail == "it passed the barrier's end, touching it"


def test_nothing_slides_along_a_single_post() -> None:
    result = run("passenger_car", POLE, "80 km/h", 0.6, duration=1.0)
    assert result.outcome == "redirected"
    assert result.outcome_detail.startswith("it glanced off the pole and left beside it")


def test_nothing_slides_along_a_row_of_posts() -> None:
    result = run("small_car", POSTS, "80 km/h", 2.5, angle=30.0)
    assert result.outcome == "redirected"
    assert np.abs(result.position[-1, 1]) > 2.0
    assert result.outcome_detail == "it left along the barrier's line beyond the last post"
