"""Posts that lean: how a vehicle climbs them, and that one which they throw up is warned of."""

from __future__ import annotations

import warnings

import birm3d
import numpy as np
import pytest
from birm3d import Barrier, LeaningPostWarning, Result, Simulation, Vehicle

TUBES = {"count": 7, "diameter": 0.273, "height": 0.7}


def van_at(posts: Barrier) -> Result:
    return Simulation(Vehicle.preset("van_3500", mesh_density=0.3), posts, 22.35).run()


def test_a_van_that_leaning_posts_throw_up_is_warned_of() -> None:
    with pytest.warns(LeaningPostWarning, match="got 4"):
        result = van_at(Barrier.bollards(**TUBES, wall_thickness=0.016))
    assert result.statistics.fastest_rise == pytest.approx(result.velocity[:, 2].max(), rel=0.02)
    sentence = "Leaning posts throw the vehicle up at 4"
    assert sentence in result.report()
    assert sentence in birm3d.rate(result, "IWA 14-1").caution
    with pytest.warns(LeaningPostWarning, match="16 in 16 runs"):  # its vehicles of the class
        assert sentence in birm3d.design_load(result, natural_period=0.05).caution


@pytest.mark.filterwarnings("ignore::birm3d.LeaningPostWarning")
def test_higher_posts_that_lean_stop_a_van_that_lower_ones_stop() -> None:
    """As ramps without a limit they threw it over: 0.7 m stopped it, 0.8 m and 1 m did not."""
    for height in (0.7, 0.8, 1.0):
        result = van_at(Barrier.bollards(**TUBES | {"height": height}, wall_thickness=0.016))
        assert result.outcome == "stopped"
        assert result.post_tilt.max() > 30.0
        up, forward = (abs(np.trapezoid(result.barrier_force[:, k], result.time)) for k in (2, 0))
        assert up < 0.35 * forward


@pytest.mark.filterwarnings("ignore::birm3d.CoreContactWarning")
def test_posts_that_hold_a_vehicle_though_they_lie_low_are_warned_of() -> None:
    """At 30 mph the posts lean by 48 degrees, and the truck does not rise fast."""
    truck = Vehicle.preset("cargo_truck", mesh_density=0.3)
    with pytest.warns(LeaningPostWarning, match=r"post_tilt must be at most 45 deg .* got 4\d deg"):
        result = Simulation(truck, Barrier.bollards(diameter=0.273, wall_thickness=0.016), 13.4).run()
    assert result.outcome == "stopped"
    assert result.statistics.fastest_rise < 3.0
    assert np.degrees(result.statistics.greatest_tilt) == pytest.approx(result.metrics["post_tilt"], rel=1e-3)
    assert "Posts lean by 4" in birm3d.rate(result, "ASTM F2656").caution


@pytest.mark.filterwarnings("ignore::birm3d.CoreContactWarning")
def test_a_rating_of_a_truck_that_came_to_rest_behind_leaning_posts_has_the_doubt() -> None:
    """It went over them, and its penetration has a class: the run itself warns of it."""
    posts = Barrier.bollards(count=3, wall_thickness=0.007)
    with pytest.warns(LeaningPostWarning, match=r"got 6\d deg"):
        result = Simulation(Vehicle.preset("cargo_truck"), posts, 13.41).run()
    rating = birm3d.rate(result, "ASTM F2656")
    assert (result.outcome, rating.verdict) == ("overridden", "M30-P2")
    assert "Posts lean by 6" in rating.caution


@pytest.mark.filterwarnings("ignore::birm3d.CoreContactWarning")
def test_trucks_go_over_posts_that_lie_on_the_ground() -> None:
    """With the flank's 0.35 alone a truck at 40 mph was held by posts that leaned by 63 degrees."""
    truck = Vehicle.preset("cargo_truck")
    with pytest.warns(LeaningPostWarning):
        result = Simulation(truck, Barrier.bollards(diameter=0.273, wall_thickness=0.016), 17.88).run()
    assert result.outcome == "overridden"
    assert result.post_tilt.max() > 55.0


@pytest.mark.filterwarnings("ignore::birm3d.LowBarrierWarning", "ignore::birm3d.CoreContactWarning")
def test_no_warning_at_rigid_posts() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error", LeaningPostWarning)
        assert van_at(Barrier.bollards(**TUBES)).statistics.fastest_rise < 3.0  # the van pitches


@pytest.mark.filterwarnings("ignore::birm3d.LeaningPostWarning", "ignore::birm3d.CoreContactWarning")
def test_several_runs_at_leaning_posts_have_one_sentence_with_the_greatest_number() -> None:
    posts = Barrier.bollards(**TUBES, wall_thickness=0.016)
    van = Vehicle.preset("van_3500", mesh_density=0.3)
    runs = [Simulation(van, posts, speed).run() for speed in (22.35, 21.5)]
    speeds = [run.statistics.fastest_rise for run in runs]
    assert min(speeds) > 3.0
    assert f"{speeds[0]:.1f}" != f"{speeds[1]:.1f}"
    caution = birm3d.design_load(runs, draws=0).caution
    assert caution.count("throw the vehicle up") == 1
    assert f"throw the vehicle up at {max(speeds):.1f} m/s" in caution
