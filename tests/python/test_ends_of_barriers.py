"""Vehicles at an end of a wall or a planter: left is as right, and who turns back past the end has passed."""

from __future__ import annotations

import pytest
from birm3d import Barrier, Result, Settings, Simulation, Vehicle, rate, units


@pytest.fixture(scope="module")
def sedan() -> Vehicle:
    return Vehicle.preset("sedan_1500")


@pytest.mark.parametrize(
    "barrier",
    [Barrier.rigid_wall(width=4.0), Barrier.planter(length=1.0, width=1.0, height=1.2)],
    ids=["wall without a top", "planter higher than half its length"],
)
def test_runs_at_the_left_and_the_right_end_are_mirror_images(barrier: Barrier) -> None:
    """Once the height of such a block counted as its length on one side: the runs ended at other times."""
    car = Vehicle.preset("passenger_car", mesh_density=0.5)
    left, right = (
        Simulation(car, barrier, units.km_h(56.0), overlap=0.2, overlap_side=side).run()
        for side in ("left", "right")
    )
    assert (left.outcome, left.outcome_detail) == (right.outcome, right.outcome_detail)
    # Blows between rigid bodies make rounding grow: a millisecond and a millimetre are far above it.
    assert left.time[-1] == pytest.approx(right.time[-1], abs=1e-3)
    for name in ("max_displacement", "vehicle_penetration"):
        assert left.metrics[name] == pytest.approx(right.metrics[name], abs=1e-3)


def at_a_planter(sedan: Vehicle, duration: float | None) -> Result:
    """Return a run in which the car bounces off the corner, skids round and rolls past the planter's end."""
    return Simulation(sedan, Barrier.planter(), units.km_h(64.0), 90.0, 1.4, duration=duration).run()


def test_a_car_that_turns_back_past_the_end_has_passed(sedan: Vehicle) -> None:
    """Rebounding at 0.55 s it was rated to stop within 0.3 m; it then rolled 7 m past the planter."""
    result = at_a_planter(sedan, None)
    assert result.outcome == "passed"
    assert result.final_velocity[0] > 0.5
    rating = rate(result, "IWA 14-1")
    assert rating.designation == "no rating: the vehicle goes on past the barrier"
    assert not rating.contained
    late = at_a_planter(sedan, 5.0)
    assert late.outcome == "passed"
    assert late.metrics["exit_speed"] == pytest.approx(result.metrics["exit_speed"], abs=1e-6)


def test_a_run_that_ends_while_the_car_turns_back_is_not_rated(sedan: Vehicle) -> None:
    with pytest.raises(ValueError, match=r"result must have run until .* got one that ends at 2 s"):
        rate(at_a_planter(sedan, 2.0), "IWA 14-1")


def test_a_skid_far_from_the_ends_does_not_lengthen_the_run() -> None:
    car = Vehicle.preset("passenger_car", mesh_density=0.5)
    long, endless = (
        Simulation(car, Barrier.jersey(length=length), 25.0, 20.0).run() for length in (60.0, float("inf"))
    )
    assert long.outcome == endless.outcome == "redirected"
    assert long.time[-1] == pytest.approx(endless.time[-1], abs=0.01)


def test_the_sentence_says_which_unit_rolled_over() -> None:
    """The trailer rolls by 98 degrees, and the greatest roll, of the tractor, is 6.5."""
    truck = Vehicle.preset("mash_36000v")
    result = Simulation(truck, Barrier.jersey(length=20.0), 12.0, 75.0).run()
    assert result.outcome == "rolled_over"
    assert result.metrics["max_roll"] < 60.0
    assert abs(result.unit(1).roll).max() > 90.0
    assert result.outcome_detail.endswith("and its trailing unit rolled over")


def test_an_undecided_run_of_the_longest_duration_asks_for_a_longer_one() -> None:
    """It asked for duration=None, which the run had."""
    car = Vehicle.preset("mash_1100c", mesh_density=0.3)
    # It meets the wall at 29.97 s.
    result = Simulation(car, Barrier.rigid_wall(), 6.0, 90.0, standoff=113.74).run()
    assert (result.outcome, result.end_reason) == ("undecided", "longest")
    with pytest.raises(ValueError, match=r"\(a duration above 30 s\), got one that ends at 30 s"):
        rate(result, "ASTM F2656")


@pytest.mark.parametrize(
    ("barrier", "offset"),
    [(Barrier.rigid_wall(width=3.0, height=1.0), 1.8), (Barrier.planter(length=2.0), 1.4)],
)
def test_a_car_that_rolls_on_past_an_end_has_passed(barrier: Barrier, offset: float) -> None:
    """One that moved at less than a tenth of its impact speed was "stopped", and rated by 0.2 m."""
    sedan = Vehicle.preset("sedan_1500")
    whole = Simulation(sedan, barrier, 22.35, 90.0, offset).run()
    longer = Simulation(sedan, barrier, 22.35, 90.0, offset, duration=6.0).run()
    assert (whole.outcome, longer.outcome) == ("passed", "passed")
    assert whole.metrics["vehicle_penetration"] > 0.9


def test_a_longer_run_does_not_know_less() -> None:
    """A truck that rolls back from a planter was stopped without a duration, and undecided with 5 s."""
    semi, planter = Vehicle.preset("semi_truck"), Barrier.planter(length=1.5, width=1.43, height=0.92)
    outcomes = {
        Simulation(semi, planter, 20.65, 13.1, 1.54, duration=duration).run().outcome
        for duration in (None, 5.0, 7.0)
    }
    assert len(outcomes) == 1
    assert "undecided" not in outcomes


@pytest.mark.parametrize("offset", [0.51, 0.54, 0.6])
def test_a_truck_that_creeps_beside_a_pole_is_followed_until_it_rests(offset: float) -> None:
    """Without rolling resistance it was stopped after 5 s, and had passed after 10 s."""
    truck = Vehicle.preset("mash_10000s")
    whole, long = (
        Simulation(truck, Barrier.pole(), 13.4, 90.0, offset, duration=duration).run()
        for duration in (None, 20.0)
    )
    assert whole.outcome == long.outcome == "stopped"
    for name in ("max_displacement", "vehicle_penetration"):
        # At rest a run ends. What the springs still hold can move the truck by 4 mm later.
        assert whole.metrics[name] == pytest.approx(long.metrics[name], abs=5e-3)


@pytest.mark.parametrize("duration", [None, 8.0])
@pytest.mark.parametrize(
    ("name", "barrier", "speed", "angle", "offset"),
    [
        ("sedan_1500", Barrier.planter(length=2.0, width=1.0, height=0.9), 64.0, 75.0, 1.2),
        ("sedan_1500", Barrier.bollards(count=9, spacing=1.2), 64.0, 20.0, 0.0),
        ("small_car", Barrier.bollards(count=7, diameter=0.273, spacing=1.373), 64.0, 30.0, 0.0),
        ("small_car", Barrier.bollards(count=9, diameter=0.273, spacing=1.373), 64.0, 30.0, 0.0),
    ],
)
def test_a_car_that_is_thrown_back_has_not_passed_where_it_rolls_later(
    name: str, barrier: Barrier, speed: float, angle: float, offset: float, duration: float | None
) -> None:
    """Unbraked, it rolls in a wide circle: past the end of the line, metres in front, it had passed."""
    vehicle = Vehicle.preset(name)
    result = Simulation(vehicle, barrier, units.km_h(speed), angle, offset, duration=duration).run()
    assert result.metrics["exit_angle"] > 0.0
    assert result.outcome in ("stopped", "redirected")


@pytest.mark.filterwarnings("ignore::birm3d.TippingWarning")
def test_a_segment_that_has_turned_does_not_shift_the_line_beyond_it() -> None:
    """Far beyond the chain's end, before the line, the vehicle counted as past the turned last segment."""
    chain = Barrier.jersey(length=24.0, segments=4, free_standing=True)
    pickup = Vehicle.preset("mash_2270p", mesh_density=0.3)
    result = Simulation(pickup, chain, units.km_h(100.0), 25.0, 3.0).run()
    assert result.position[-1, 1] > 12.0
    assert result.position[:, 0].max() < 0.0
    assert result.outcome == "redirected"


@pytest.mark.parametrize("braking", [0.05, 0.3, 1.0])
def test_a_truck_that_brakes_to_rest_before_a_wall_did_not_rebound(braking: float) -> None:
    truck = Vehicle.preset("cargo_truck", mesh_density=0.3)
    settings = Settings(braking=braking)
    result = Simulation(truck, Barrier.rigid_wall(height=0.5), 5.0, standoff=40.0, settings=settings).run()
    assert result.outcome_detail == "it came to rest before it reached the barrier"
    assert not any("front's resistance" in line for line in result.report().splitlines())


def test_posts_that_are_never_touched_do_not_change_the_word() -> None:
    """What a vehicle does is judged as it loses contact, as its exit angle: 53 deg, so it rebounds."""
    found = []
    for count in (7, 13, 21):
        posts = Barrier.bollards(count=count, height=0.98, spacing=1.21)
        result = Simulation(Vehicle.preset("mash_1100c"), posts, 24.27, 45.5, 1.06).run()
        assert result.metrics["exit_angle"] > 45.0
        found.append(result.outcome_detail)
    assert found == ["it rebounded from the barrier"] * 3
