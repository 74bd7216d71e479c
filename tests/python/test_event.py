"""What became of the vehicle, and the instant to which exit speeds and angles belong."""

from __future__ import annotations

import math
import pickle
from functools import cache
from pathlib import Path
from types import SimpleNamespace

import birm3d
import numpy as np
import pytest
from birm3d import Barrier, Result, Settings, Simulation, Vehicle
from birm3d.result.event import OUTCOMES, outcome_detail
from tires import held_straight, quick_to_steer

OLD = Path(__file__).parents[1] / "data" / "results" / "bollards_0_1_0.npz"
AT_SEPARATION = (
    *(
        "time_of_separation",
        "exit_speed",
        "exit_angle",
        "restitution",
        "delta_v",
        "max_yaw",
        "residual_crush",
    ),
)

MISSES = pytest.mark.filterwarnings("ignore::birm3d.MissedBarrierWarning")


@cache
def car(gvw: float = 900.0) -> Vehicle:
    return Vehicle.preset("passenger_car", gvw=gvw, mesh_density=0.3)


def scene(name: str, duration: float | None = None) -> Simulation:
    barrier, speed, angle, offset = {
        "wall": (Barrier.rigid_wall(), 22.0, 20.0, 0.0),
        "bollards": (Barrier.bollards(count=5, spacing=1.2), 13.0, 70.0, 0.3),
        "jersey": (Barrier.jersey(length=40.0), 25.0, 25.0, 0.0),
        "head_on": (Barrier.rigid_wall(), 15.0, 90.0, 0.0),
        "gap": (Barrier.bollards(count=2, spacing=3.0), 15.0, 90.0, 0.0),
        "end": (Barrier.rigid_wall(width=4.0, height=1.2, thickness=0.4), 15.0, 30.0, 4.5),
        "curb": (Barrier.rigid_wall(width=8.0, height=0.12, thickness=0.2), 20.0, 90.0, 0.0),
        "pole_beside": (Barrier.pole(diameter=0.3), 13.4, 90.0, 0.6),
        "low_posts": (Barrier.bollards(height=0.15), 15.0, 90.0, 0.0),
    }[name]
    return Simulation(car(), barrier, speed, angle, offset, duration=duration)


@cache
def run(name: str, duration: float | None = None) -> Result:
    return scene(name, duration).run()


@pytest.mark.parametrize("name", ["wall", "bollards", "jersey", "head_on"])
def test_values_at_separation_do_not_depend_on_the_duration(name: str) -> None:
    ended = run(name)
    found = {metric: ended.metrics[metric] for metric in AT_SEPARATION if metric in ended.metrics}
    assert {"time_of_separation", "exit_speed", "restitution"} <= set(found)
    for longer in (0.1, 0.5):
        other = run(name, round(ended.time[-1] + longer, 3))
        assert {metric: other.metrics[metric] for metric in found} == found
        assert (other.outcome, other.outcome_detail) == (ended.outcome, ended.outcome_detail)


def test_a_truck_beyond_a_post_is_not_stopped() -> None:
    """It meets the post with a front corner, turns about it, and rolls on slowly behind the line."""
    truck = quick_to_steer(Vehicle.preset("mash_10000s"))
    post = Barrier.bollards(count=1, diameter=0.3, height=1.0, origin=(0.0, 0.5 * truck.width / 2.0, 0.0))
    result = Simulation(truck, post, "40 mph").run()
    assert result.position[-1, 0] > 1.0
    assert not result.barrier_force[-100:].any()
    assert result.outcome == "passed"


def test_a_run_ends_at_rest_though_wedged_skin_stores_energy() -> None:
    """Skin on both sides of a post can press on it for ever; the truck stands still."""
    result = Simulation(Vehicle.preset("cargo_truck"), Barrier.bollards(count=5), "50 mph").run()
    at_rest = 1e-6 * result.energy["kinetic"][0]
    assert result.end_reason == "stopped"
    assert result.outcome == "stopped"
    assert result.energy["stored"][-1] > 10.0 * at_rest
    end = result.metrics["end_time"]
    assert np.all(result.energy["kinetic"][result.time > end - 0.25] <= at_rest)
    assert end < 4.0


@pytest.mark.parametrize("name", ["wall", "bollards", "jersey", "head_on"])
def test_the_instant_is_the_last_loss_of_contact(name: str) -> None:
    result = run(name)
    separation = result.metrics["time_of_separation"]
    interval = result.scene.settings.output_interval
    last = result.time[np.flatnonzero(result.sum_of_contact_forces)[-1]]
    # A row is the mean of the interval that ends there. The last load fades out: rows are differences of sums
    # over the run, zero below a millionth of a newton. At the bollards that is 0.7 ms before the end.
    assert abs(separation - last) <= 8.0 * interval
    row = int(separation / interval)
    speed = math.hypot(*result.velocity[row, :2])
    assert result.metrics["exit_speed"] == pytest.approx(speed, rel=1e-3)
    assert result.metrics["later_contacts"] == 0.0
    change = np.linalg.norm(result.velocity[: row + 1] - result.velocity[0], axis=1).max()
    assert result.metrics["delta_v"] == pytest.approx(change, rel=1e-3)
    assert result.metrics["max_yaw"] == pytest.approx(np.abs(result.yaw[: row + 1]).max(), abs=1e-9)
    assert np.abs(result.yaw).max() >= result.metrics["max_yaw"]


@pytest.mark.parametrize(
    ("name", "outcome", "detail"),
    [
        ("wall", "redirected", "along the barrier"),
        ("jersey", "redirected", "along the barrier"),
        ("head_on", "stopped", "rebounded"),
        ("pole_beside", "stopped", "rebounded"),  # it turns about the pole on its way back
        ("gap", "passed", "between two elements of the barrier, untouched"),
        pytest.param("end", "passed", "the barrier's end", marks=MISSES),
        ("curb", "overridden", "over the top"),
        ("low_posts", "overridden", "over the top"),
    ],
)
def test_outcomes(name: str, outcome: str, detail: str) -> None:
    result = run(name)
    assert (result.outcome, result.end_reason) == (outcome, "separated")
    assert detail in result.outcome_detail
    assert result.metrics["outcome"] == outcome
    assert "outcome" not in dict(result.metrics)
    assert result.time[-1] < 2.0  # it ends when nothing can change any more
    assert result.report().startswith(f"{outcome}: ")
    assert repr(result).startswith(f"Result({outcome}, ")


def test_a_vehicle_over_a_barrier_that_it_does_not_touch_says_so() -> None:
    low = Simulation(Vehicle.preset("cargo_truck", mesh_density=0.2), Barrier.rigid_wall(height=0.3), 20.0)
    result = low.run()
    assert result.outcome_detail == (
        "it went over the top of the barrier untouched: wheels meet nothing ahead of them in this model"
    )


def test_a_bus_that_goes_on_does_not_stand_still() -> None:
    """Its rear may swing back faster than it leaves: that is no rest."""
    result = Simulation(Vehicle.preset("bus_13t"), Barrier.jersey(), 70.0 / 3.6, 20.0).run()
    assert result.outcome == "redirected"
    assert result.end_reason != "stopped"
    assert np.linalg.norm(result.velocity[-1]) > 10.0


def test_a_car_between_two_posts_ends_when_it_has_passed() -> None:
    result = run("gap")
    assert result.metrics["dynamic_crush"] == 0.0
    assert result.position[-1, 0] < 5.0
    assert "time_of_separation" not in result.metrics
    with pytest.raises(KeyError, match=r"exit_speed: the vehicle did not separate .* untouched"):
        result.metrics["exit_speed"]


def test_a_run_that_ends_before_is_undecided() -> None:
    result = run("head_on", 0.03)
    assert result.outcome == "undecided"
    assert "still moving when the run ended, in contact with the barrier" in result.outcome_detail
    with pytest.raises(KeyError, match=r"exit_angle: the vehicle did not separate"):
        result.metrics["exit_angle"]
    with pytest.raises(KeyError, match=r"metric must be one of .*; got 'exit_agle'"):
        result.metrics["exit_agle"]
    assert result.metrics.get("exit_angle") is None
    assert "exit_angle" not in result.metrics


def test_a_truck_that_its_tires_press_on_a_long_barrier_is_redirected() -> None:
    """Its wheels do not steer: they press it on the barrier as long as it moves. Once that was undecided."""
    truck = held_straight(Vehicle.preset("cargo_truck", mesh_density=0.3))
    result = Simulation(truck, Barrier.jersey(length=200.0), 18.0, 15.0).run()
    assert (result.outcome, result.outcome_detail) == ("redirected", "it slides on along the barrier")
    assert "time_of_separation" not in result.metrics


@pytest.mark.filterwarnings("ignore::birm3d.LowBarrierWarning", "ignore::birm3d.CoreContactWarning")
def test_who_nears_the_barrier_at_the_last_contact_is_said_to() -> None:
    truck = Vehicle.preset("mash_10000s", mesh_density=0.3)
    result = Simulation(truck, Barrier.jersey(profile="single_slope"), 9.3, 34.0).run()
    angle = result.metrics["exit_angle"]
    assert angle < -3.0
    assert result.outcome_detail.endswith(f"still neared the barrier, at {-angle:.1f} degrees")
    assert "neared" not in run("wall").outcome_detail


@MISSES
def test_no_angle_of_what_passed_and_none_without_a_barrier() -> None:
    with pytest.raises(KeyError, match=r"does not leave on the traffic side|did not separate"):
        run("end").metrics["exit_angle"]
    alone = Simulation(car(), None, 10.0, duration=0.05).run()
    assert (alone.outcome, alone.outcome_detail) == ("undecided", "there is no barrier")
    with pytest.raises(KeyError, match=r"exit_speed: there is no barrier"):
        alone.metrics["exit_speed"]


def test_rolling_over() -> None:
    """A body on its own in the air, without gravity, turns over."""
    lab = Vehicle.from_arrays(
        mass=1000.0,
        inertia=1000.0 * np.eye(3),
        nodes=[[1.0, 0.0, 0.5]],
        anchors=[[0.0, 0.0, 0.5]],
        k_initial=1e6,
        k_unloading=1e6,
        mass_center_height=2.0,
    )
    free = Settings(gravity=0.0, ground=False)
    result = Simulation(lab, Barrier.rigid_wall(), 10.0, settings=free, duration=1.0).run()
    assert result.pose(result.time)[1][:, 2, 2].min() < 0.0  # its up axis looks down
    assert result.outcome == "rolled_over"
    assert "rolled over" in result.outcome_detail
    short = Simulation(lab, Barrier.rigid_wall(), 10.0, settings=free, duration=0.1).run()
    assert short.pose(short.time)[1][:, 2, 2].min() > 0.0
    assert short.outcome != "rolled_over"


@pytest.mark.parametrize("name", ["wall", "gap", "bollards"])
def test_a_study_has_the_outcome_without_histories(name: str) -> None:
    result = run(name)
    metrics = ["exit_speed", "exit_angle", "time_of_separation", "later_contacts", "residual_crush"]
    study = birm3d.ensemble([scene(name)] * 2, metrics=metrics, progress=False)
    assert list(study.outcome) == [result.outcome] * 2 == list(study["outcome"])
    assert study.outcomes == {result.outcome: 2}
    for metric in metrics:
        value = result.metrics.get(metric, math.nan)
        assert study[metric][0] == value or (math.isnan(value) and math.isnan(study[metric][0]))
    assert "outcome" not in study.summary()
    assert list(study.columns()["outcome"]) == list(study.outcome)


def test_studies_keep_it_in_files(tmp_path: Path) -> None:
    sim = scene("head_on")
    study = birm3d.sweep(sim, impact_speed=[10.0, 15.0], metrics=["exit_speed"], store=tmp_path / "s.db")
    assert study.outcome == ("stopped", "stopped")
    study.save(tmp_path / "study.csv")
    assert birm3d.study.Study.load(tmp_path / "study.csv").outcome == study.outcome
    again = birm3d.sweep(sim, impact_speed=[10.0, 15.0], metrics=["exit_speed"], store=tmp_path / "s.db")
    assert again.outcome == study.outcome


def test_snapshots_pickles_and_files_keep_the_event(tmp_path: Path) -> None:
    result = run("wall")
    simulation = scene("wall")
    while simulation.time < result.metrics["time_of_separation"] - 0.01:
        simulation.step()
    snapshot = simulation.snapshot()
    other = scene("wall")
    other.restore(snapshot)
    restored = other.run()
    result.save(tmp_path / "crash.npz")
    for twin in (restored, birm3d.load(tmp_path / "crash.npz"), pickle.loads(pickle.dumps(result))):
        assert (twin.outcome, twin.outcome_detail) == (result.outcome, result.outcome_detail)
        for metric in AT_SEPARATION:
            assert twin.metrics[metric] == result.metrics[metric]
        assert twin.metrics["outcome"] == result.outcome


def test_a_file_of_version_0_1_0_says_that_it_has_none() -> None:
    loaded = birm3d.load(OLD)
    assert loaded.outcome == "undecided"
    assert "did not find the outcome: run its scene again" in loaded.outcome_detail
    assert loaded.outcome in OUTCOMES


@pytest.mark.parametrize(
    ("name", "barrier", "speed"),
    [
        ("mash_36000v", Barrier.rigid_wall(height=0.39), 22.22),
        ("mash_36000v", Barrier.rigid_wall(height=0.32), 22.22),
        ("mash_10000s", Barrier.jersey(height=0.45, profile="f_shape"), 25.0),
    ],
)
def test_who_rolls_over_and_lies_behind_the_barrier_has_got_over_it(
    name: str, barrier: Barrier, speed: float
) -> None:
    """Once such a vehicle had `rolled_over`, which ratings and searches take for contained."""
    vehicle = quick_to_steer(Vehicle.preset(name))
    result = Simulation(vehicle, barrier, speed, 15.0).run()
    assert result.position[-1, 0] > 1.4, "behind the barrier"
    assert result.outcome == "overridden"
    assert result.outcome_detail == "it went over the top of the barrier and rolled over"
    rating = birm3d.rate(result, "MASH")
    assert not rating.contained
    assert "fail" in rating.designation


def test_who_rolls_over_on_the_traffic_side_is_contained() -> None:
    truck = quick_to_steer(Vehicle.preset("mash_10000s"))
    result = Simulation(truck, Barrier.rigid_wall(height=0.82), 25.0, 15.0).run()
    assert result.outcome == "rolled_over"
    assert result.position[-1, 0] < 0.0


@pytest.mark.filterwarnings("ignore::birm3d.CoreContactWarning")  # it lies on the barrier
@pytest.mark.parametrize("height", [0.66, 0.7])
def test_a_pickup_far_beyond_its_tipping_angle_does_not_stand_up_again(height: float) -> None:
    """It tips at 50 degrees. Once camber thrust of tyres on their side walls set it down from 74 degrees."""
    pickup = Vehicle.preset("mash_2270p")
    result = Simulation(pickup, Barrier.jersey(height=height), 27.78, 25.0).run()
    assert result.outcome == "rolled_over"
    assert abs(result.roll[-1]) > 60.0


def test_a_metric_that_the_scene_can_not_have_says_why() -> None:
    car = Vehicle.preset("passenger_car", mesh_density=0.1)
    metrics = Simulation(car, Barrier.rigid_wall(width=3.0), "10 m/s", impact_angle=0).run().metrics
    for name, reason in (
        ("vehicle_penetration", r"the path runs along the barrier's line \(impact_angle 0\)"),
        ("post_tilt", "no posts yield"),
        ("barrier_deflection", "nothing of the barrier moves"),
        ("max_overturning_ratio", "no segments stand free"),
        ("bed_slip", "no load bed that slides"),
        ("max_articulation_angle", "the vehicle is one unit"),
    ):
        with pytest.raises(KeyError, match=f"{name}: .*{reason}"):
            metrics[name]


@pytest.mark.parametrize(("touching", "where"), [(True, "in contact with"), (False, "clear of")])
def test_a_slow_vehicle_is_at_the_barrier_only_if_it_touches_it(
    monkeypatch: pytest.MonkeyPatch, touching: bool, where: str
) -> None:
    monkeypatch.setattr("birm3d.result.event._nearing", lambda *_: "")
    ended = SimpleNamespace(
        _event=SimpleNamespace(manner="slow", touching=touching, rolled_over=False),
        _history=SimpleNamespace(elements=[1]),
        scene=SimpleNamespace(barrier=None),
    )
    told = f"it was slower than a tenth of its impact speed when the run ended, {where} the barrier"
    assert outcome_detail(ended) == told  # type: ignore[arg-type]


@pytest.mark.parametrize("duration", [None, 10.0])
@pytest.mark.parametrize(
    ("share", "outcome"), [(0.86, "stopped"), (0.9, "redirected"), (0.95, "redirected"), (1.0, "redirected")]
)
def test_a_vehicle_that_turns_away_before_the_line_has_not_passed(
    share: float, outcome: str, duration: float | None
) -> None:
    """A car beside a pole still nears the line as it leaves, by 3 to 8 degrees. Its tyres turn it away.

    Its mass centre stays 0.58 m from the line, at any tolerance. From 0.9 of its half width on it was called
    "passed".
    """
    car = Vehicle.preset("passenger_car")
    result = Simulation(car, Barrier.pole(diameter=0.6), 14.0, 90.0, 0.9 * share, duration=duration).run()
    assert result.position[:, 0].max() < -0.5
    assert result.velocity[-1, 0] < 0.0
    assert result.outcome == outcome
