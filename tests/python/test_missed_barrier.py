"""The word about a vehicle that goes past the end of the barrier and touches nothing."""

from __future__ import annotations

import re
import warnings

import numpy as np
import pytest
from birm3d import Barrier, MissedBarrierWarning, Simulation, Vehicle, sweep

CAR = Vehicle.preset("passenger_car", mesh_density=0.2)
POSTS = Barrier.bollards()


def message_of(simulation: Simulation) -> str:
    with pytest.warns(MissedBarrierWarning) as told:
        assert simulation.run().outcome == "passed"
    assert len(told) == 1
    assert told[0].filename == __file__
    return str(told[0].message)


@pytest.mark.parametrize("angle", [90.0, 60.0, 130.0])
@pytest.mark.parametrize("heading", [0.0, 200.0])
def test_message_has_the_offsets_that_lead_to_the_barrier(angle: float, heading: float) -> None:
    posts = Barrier.bollards(origin=(3.0, 2.0, 0.0), heading=heading)
    text = message_of(Simulation(CAR, posts, 15.0, angle, posts.station() + 7.0))
    found = re.search(r"above (-?[\d.]+) m and below (-?[\d.]+) m", text)
    assert found is not None
    for end, inward in ((float(found[1]), 1.0), (float(found[2]), -1.0)):
        with warnings.catch_warnings():
            warnings.simplefilter("error", MissedBarrierWarning)
            Simulation(CAR, posts, 15.0, angle, end + 0.2 * inward, duration=1.5).run()
        message_of(Simulation(CAR, posts, 15.0, angle, end - 0.02 * inward))


def test_message_has_the_clearance() -> None:
    low, high = CAR.skin_bounds
    row = 4 * 1.2 + 0.32
    text = message_of(Simulation(CAR, POSTS, 15.0, impact_offset=8.0))
    assert f"missed the barrier by {8.0 + low[1] - 0.5 * row:.2f} m" in text
    assert "got 8 m" in text
    assert np.isclose(high[1], -low[1])


def test_a_path_along_the_line_has_its_offsets_across_it() -> None:
    wall = Barrier.rigid_wall(width=6.0, thickness=0.5)
    text = message_of(Simulation(CAR, wall, 15.0, 180.0, -2.0))
    half = float(CAR.skin_bounds[1][1])
    assert f"above {-half:.2f} m and below {0.5 + half:.2f} m" in text


@pytest.mark.filterwarnings("error")
def test_between_posts_and_at_a_barrier_there_is_no_word() -> None:
    wide = Barrier.bollards(count=2, spacing=4.0)
    assert "between" in Simulation(CAR, wide, 15.0).run().outcome_detail
    Simulation(CAR, POSTS, 10.0).run()
    Simulation(CAR, POSTS, 10.0, impact_offset=8.0, duration=0.01).run()  # it is not there yet
    Simulation(CAR, None, 10.0, duration=0.01).run()


def test_a_study_says_it_once() -> None:
    with pytest.warns(MissedBarrierWarning, match=r"the worst of 2 in 3 runs: rows 1 to 2") as told:
        sweep(Simulation(CAR, POSTS, 15.0), impact_offset=[0.0, 6.0, 8.0], metrics=["dynamic_crush"])
    assert len(told) == 1
