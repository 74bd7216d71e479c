"""Searches for limits of a barrier and for the worst offset: exact cases, brackets, what is refused."""

from __future__ import annotations

import json
import math
import pickle
import re
from concurrent.futures import ThreadPoolExecutor

import birm3d
import numpy as np
import pytest
from birm3d import (
    Barrier,
    FreeStanding,
    Limit,
    NotInRangeError,
    Settings,
    Simulation,
    StudyInterrupted,
    Vehicle,
)
from birm3d.simulation.parameters import varied
from birm3d.study import limit_search
from one_truss import one_truss

FREE = Settings(gravity=0.0, ground=False)


def car() -> Vehicle:
    return Vehicle.preset("passenger_car", mesh_density=0.3)


@pytest.fixture(scope="module")
def height() -> Limit:
    wall = Barrier.rigid_wall(width=6.0, height=1.0, friction=0.0)
    simulation = Simulation(one_truss(0.637), wall, 5.0, settings=FREE)
    return birm3d.least_height(simulation, (0.2, 1.2), resolution=0.002)


def test_least_height_is_that_of_the_node(height: Limit) -> None:
    """Exact: without gravity a body of one node is stopped by every wall above its line, by none below."""
    assert height.fails_at is not None
    assert height.fails_at <= 0.637 <= height.value
    assert height.value - height.fails_at <= height.resolution == 0.002
    assert height.monotonic
    assert not height.at_bound
    assert height.exceptions == ()
    assert all(run.holds == (run.value > 0.637) for run in height.runs)


def test_least_height_of_other_barriers() -> None:
    """A planter and a row of posts of the same height stop the same body."""
    for barrier in (Barrier.planter(friction=0.0), Barrier.bollards(count=3, friction=0.0)):
        simulation = Simulation(one_truss(0.637), barrier, 5.0, settings=FREE)
        found = birm3d.least_height(simulation, (0.2, 1.2), resolution=0.02, points=3, offsets=[0.0])
        assert found.fails_at is not None
        assert found.fails_at <= 0.637 <= found.value


def test_usual_heights_are_those_that_the_barrier_can_have() -> None:
    simulation = Simulation(one_truss(1.0), Barrier.jersey(), 5.0, settings=FREE)
    found = birm3d.least_height(simulation, points=2, resolution=0.5)
    assert found.runs[0].value == pytest.approx(13 * 0.0254 + 0.02)
    assert found.runs[-1].value == 1.3


def test_what_a_limit_says(height: Limit) -> None:
    text = height.summary()
    assert text.startswith("least height: ")
    assert "m holds, " in text
    assert re.match(r"least height: 0\.6\d{3} m holds, 0\.6\d{3} m fails$", height.headline)
    shown = [float(number) for number in re.findall(r"0\.\d+", height.headline)]
    assert shown[1] <= 0.637 <= shown[0]
    assert "Monotonic at the values tried" in text
    assert "Caution: " in text
    assert text.splitlines()[1] == height.study.scene_title, "an answer is that of one vehicle at one speed"
    assert height.band in height.plot().axes[0].get_title()
    assert len(height.study) == len(height.runs) == len(height.to_dataframe())
    values = [run.value for run in height.runs]
    assert values == sorted(values)
    assert "<img" in height._repr_html_()
    assert json.loads(json.dumps(height.to_dict()))["value"] == height.value
    assert pickle.loads(pickle.dumps(height)).summary() == text
    assert height.plot().axes[0].get_xlabel() == "height [m]"


def test_a_limit_holds_its_question(height: Limit) -> None:
    """It is no copy of it, nothing changes it afterwards, and it goes to another process with the limit."""
    question = pickle.loads(pickle.dumps(height)).question
    assert question.rows(0.5) == height.question.rows(0.5) == [(0.5, 0.0)]
    for name in ("name", "unit", "greatest", "criterion", "measure", "most", "caution"):
        assert getattr(height, name) == getattr(question, name)
        with pytest.raises(AttributeError):
            setattr(height, name, None)


def test_texts_of_a_question_have_the_unit_of_its_measure(height: Limit) -> None:
    force = height.question._replace(measure="peak_force_50ms", most=3e5)
    assert force.criterion.endswith(", peak force 50ms <= 300000 N")
    assert force.measure_label == "peak force 50ms [N]"
    ratio = height.question._replace(measure="max_overturning_ratio", most=1.0)
    assert ratio.criterion.endswith(", max overturning ratio <= 1")
    assert ratio.measure_label == "max overturning ratio"


def test_a_limit_says_how_far_the_vehicle_gets_past_the_line() -> None:
    """A car that stops wedged between two posts is held, but behind their line."""
    simulation = Simulation(
        Vehicle.preset("small_car", mesh_density=0.2), Barrier.bollards(count=7), "30 mph"
    )
    found = birm3d.greatest_gap(simulation, (0.9, 3.3), points=5, resolution=0.1, draws=0)
    past = max(run.measure for run in found.runs if run.value == found.value)
    told = f"the rigid body gets up to {past:.2f} m past the barrier's line, or behind its end."
    assert (told in found.summary()) == (past > 0.0)
    assert past > 0.0


def test_a_limit_says_for_how_many_vehicles_of_the_class_it_holds() -> None:
    """Each drawn vehicle is run anew at the limit and at safer values: all offsets have to hold."""
    simulation = Simulation(
        Vehicle.preset("passenger_car", mesh_density=0.1), Barrier.bollards(count=4), 20.0
    )
    shares = (0.0, 0.5)
    found = birm3d.greatest_gap(
        simulation, (0.6, 2.6), points=6, resolution=0.2, offset_shares=shares, draws=8
    )
    assert found.draws == 8
    assert next(iter(found.class_shares)) == found.value
    values = list(found.class_shares)
    assert values == sorted(values, reverse=True)
    assert all(share < 1.0 for share in list(found.class_shares.values())[:-1])
    for value, share in list(found.class_shares.items())[:2]:
        spacing = value + 0.32
        held = np.ones(8, dtype=bool)
        for offset in shares:
            scene = varied(simulation, {"barrier.spacing": spacing, "impact_offset": offset * spacing})
            outcomes = birm3d.predict(scene, 8).study.outcome
            held &= [outcome in ("stopped", "redirected", "rolled_over") for outcome in outcomes]
        assert share == held.mean()
    assert f"Of 8 vehicles of the class it holds for {found.class_shares[found.value]:.0%}" in found.summary()
    assert json.loads(json.dumps(found.to_dict()))["class_shares"][0][0] == found.value


def test_a_limit_of_one_vehicle_says_so(height: Limit) -> None:
    assert height.draws == 0
    assert "No band: the answer is that of this one vehicle." in height.summary()
    wall = Barrier.rigid_wall(width=6.0, height=1.0, friction=0.0)
    simulation = Simulation(one_truss(0.637), wall, 5.0, settings=FREE)
    with pytest.raises(ValueError, match=r"how its class scatters \(\[\[scatter\]\]\)"):
        birm3d.least_height(simulation, (0.2, 1.2), draws=8)


def test_all_of_the_range_holds(height: Limit) -> None:
    wall = Barrier.rigid_wall(width=6.0, height=1.0, friction=0.0)
    simulation = Simulation(one_truss(0.2), wall, 5.0, settings=FREE)
    found = birm3d.least_height(simulation, (0.3, 1.0), points=3)
    assert (found.value, found.fails_at, found.at_bound) == (0.3, None, True)
    assert found.headline == "least height: at most 0.300 m, the end of the range"
    assert len(found.runs) == 3


def test_nothing_of_the_range_holds() -> None:
    wall = Barrier.rigid_wall(width=6.0, height=1.0, friction=0.0)
    simulation = Simulation(one_truss(1.4), wall, 5.0, settings=FREE)
    with pytest.raises(
        NotInRangeError, match=r"heights must have a greatest value that holds .* got 1 m: "
    ) as no:
        birm3d.least_height(simulation, (0.3, 1.0), points=3)
    assert len(no.value.runs) == len(no.value.study) == 3
    again = pickle.loads(pickle.dumps(no.value))
    assert (str(again), again.runs) == (str(no.value), no.value.runs)


@pytest.fixture(scope="module")
def gap() -> Limit:
    simulation = Simulation(car(), Barrier.bollards(count=5, diameter=0.3), 10.0)
    with ThreadPoolExecutor(2) as executor:
        return birm3d.greatest_gap(simulation, (0.8, 2.6), points=7, resolution=0.05, executor=executor)


def test_greatest_gap(gap: Limit) -> None:
    """A gap that is wider than the car stops nothing at its middle; one of half the width stops the car."""
    assert gap.fails_at is not None
    assert 0.5 * 1.837 < gap.value < gap.fails_at < 1.837 + 0.15
    assert gap.fails_at - gap.value <= 0.05
    base = Simulation(car(), Barrier.bollards(count=5, diameter=0.3), 10.0)
    for value, stops in ((gap.value, True), (gap.fails_at, False)):
        spacing = value + 0.3
        outcomes = [
            varied(base, {"barrier.spacing": spacing, "impact_offset": share * spacing}).run().outcome
            for share in (-0.25, 0.0, 0.25, 0.5)
        ]
        assert all(outcome in ("stopped", "redirected") for outcome in outcomes) == stops
    assert len(gap.plot().axes) == 2
    assert "4 of 4" in gap.summary()


def test_gap_counts_from_the_row_wherever_it_stands(gap: Limit) -> None:
    barrier = Barrier.bollards(count=5, diameter=0.3, origin=(3.0, -5.0, 0.0), heading=40.0)
    simulation = Simulation(car(), barrier, 10.0, 90.0, barrier.station())
    found = birm3d.greatest_gap(simulation, (0.8, 2.6), points=7, resolution=0.05)
    assert found.value == pytest.approx(gap.value, abs=0.051)


def test_penetration_is_a_limit_too() -> None:
    simulation = Simulation(car(), Barrier.bollards(count=5), 8.0)
    found = birm3d.greatest_gap(
        simulation, (0.8, 1.2), points=2, penetration="0.4 m", offset_shares=[0.0, 0.5]
    )
    assert found.most == 0.4
    assert "vehicle penetration <= 0.4 m" in found.criterion
    assert all(run.measure <= 0.4 for run in found.runs if run.holds)


@pytest.mark.filterwarnings("ignore::birm3d.TippingWarning")
def test_least_segment_mass() -> None:
    """The mass that the search gives keeps the deflection; the next one tried does not."""
    barrier = Barrier.jersey(length=40.0, segments=10, free_standing=FreeStanding(ground_friction=0.6))
    simulation = Simulation(car(), barrier, 15.0, 25.0)
    found = birm3d.least_segment_mass(
        simulation, (500.0, 6000.0), deflection="40 cm", points=4, resolution=400
    )
    assert found.fails_at is not None
    assert 0.0 < found.value - found.fails_at <= 400.0
    for mass, holds in ((found.value, True), (found.fails_at, False)):
        free = FreeStanding(mass_per_length=mass / 4.0, ground_friction=0.6)
        heavier = Barrier.jersey(length=40.0, segments=10, free_standing=free)
        metrics = Simulation(car(), heavier, 15.0, 25.0).run().metrics
        assert (metrics["barrier_deflection"] <= 0.4) == holds
        ratio = f"At {mass:,.0f} kg max_overturning_ratio is {metrics['max_overturning_ratio']:.3g}"
        assert (ratio in found.summary()) == holds
        assert (f"{ratio}: a segment would begin to tip" in found.caution) == holds
    assert found.monotonic
    deflections = [run.measure for run in found.runs]
    assert deflections == sorted(deflections, reverse=True)


def test_a_vehicle_that_passes_the_end_is_said() -> None:
    """Whether it reaches the end says nothing of the mass that the deflection asks for."""
    limits = []
    for length, segments in ((24.0, 6), (60.0, 15)):
        barrier = Barrier.jersey(length=length, segments=segments, free_standing=True)
        found = birm3d.least_segment_mass(
            Simulation(car(), barrier, 15.0, 25.0), (1000.0, 7000.0), deflection=0.4, points=4, resolution=600
        )
        ends = sum(run.holds and run.outcome == "passed" for run in found.runs)
        assert ("passes the barrier's end" in found.summary()) == (ends > 0)
        limits.append(found.value)
    assert limits[0] == pytest.approx(limits[1], rel=0.4)


def test_an_answer_that_is_not_monotonic(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where a value beyond the first failure holds again, the answer stays before it and that is said."""
    real = limit_search._judged

    def judged(question, row, study, run):  # type: ignore[no-untyped-def]
        found = real(question, row, study, run)
        return found._replace(holds=found.value < 1.0 or 1.4 < found.value < 1.7)

    monkeypatch.setattr(limit_search, "_judged", judged)
    simulation = Simulation(car(), Barrier.bollards(count=5), 8.0, duration=0.01)
    found = birm3d.greatest_gap(simulation, (0.5, 2.5), points=9, offset_shares=[0.0], resolution=0.01)
    assert found.value < 1.0 <= found.fails_at <= found.value + 0.01
    assert not found.monotonic
    assert found.exceptions == (1.5,)
    assert "Not monotonic: 1.5 m holds again" in found.summary()
    assert "not monotonic" in found.plot().axes[0].get_title()
    with pytest.raises(NotInRangeError, match=r"1.5 m hold, which is not monotonic"):
        birm3d.greatest_gap(simulation, (1.0, 2.5), points=7, offset_shares=[0.0])


@pytest.fixture(scope="module")
def worst() -> birm3d.WorstOffset:
    simulation = Simulation(car(), Barrier.bollards(count=6), 10.0)
    return birm3d.worst_offset(simulation, [1.0, 1.4], metric="peak_element_force_50ms", points=5, max_runs=8)


def test_worst_offset_of_each_spacing(worst: birm3d.WorstOffset) -> None:
    assert worst.spacing.tolist() == [1.0, 1.4]
    for row in worst.rows:
        base = Simulation(car(), Barrier.bollards(count=6, spacing=row.spacing), 10.0)
        run = varied(base, {"impact_offset": row.offset}).run()
        assert row.value == pytest.approx(run.metrics["peak_element_force_50ms"], rel=1e-9)
        assert row.outcome == run.outcome
        assert row.value == max(
            np.nanmax(study["peak_element_force_50ms"]) for study in (row.search.grid, row.search.refinement)
        )
        assert abs(row.offset) <= 0.5 * row.spacing
        # Six posts: a gap is in the middle, posts are half a spacing from it.
        assert row.share == pytest.approx(0.5 - abs(row.offset) / row.spacing, abs=1e-12)
    assert worst.resolution == (0.25, 0.35)
    assert worst.worst.value == worst.value.max()


def test_what_a_worst_offset_says(worst: birm3d.WorstOffset) -> None:
    head, labels, *_ = worst.summary().splitlines()
    assert head.startswith(
        "Scene of the greatest value: Passenger car, 1,814 kg, 10.00 m/s (22.4 mph) at 90°"
    )
    assert "peak 50-ms force (vector) on one element [kN]" in labels
    assert f"= {1e-3 * worst.worst.value:.4g} kN at spacing" in repr(worst)
    assert "Scanned every 0.35 m or finer" in worst.summary()
    assert list(worst.to_dataframe()["peak_element_force_50ms"]) == worst.value.tolist()
    assert len(worst.plot().axes) == 2
    assert "<img" in worst._repr_html_()
    assert json.loads(json.dumps(worst.to_dict()))["spacings"][0]["spacing"] == 1.0


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda sim: birm3d.greatest_gap(sim, (2.0, 1.0)), "gaps must be .*increasing; got"),
        (lambda sim: birm3d.greatest_gap(sim, (1.0, math.nan)), "gaps must be"),
        (lambda sim: birm3d.greatest_gap(sim, (-1.0, 2.0)), "gaps must"),
        (lambda sim: birm3d.greatest_gap(sim, (0.01, 2.0)), "gaps must leave a row wider than the vehicle"),
        (lambda sim: birm3d.greatest_gap(sim, points=1), "points must be an integer >= 2, got 1"),
        (lambda sim: birm3d.greatest_gap(sim, resolution=0.0), "resolution must be finite and > 0 m, got 0"),
        (lambda sim: birm3d.greatest_gap(sim, offset_shares=[]), "offset_shares must be at least one"),
        (
            lambda sim: birm3d.greatest_gap(sim, offset_shares=[math.nan]),
            "offset_shares must be finite, got nan",
        ),
        (lambda sim: birm3d.least_height(sim, offsets=[]), "offsets must be at least one"),
        (lambda sim: birm3d.least_height(sim, offsets=["1 kg"]), "offsets"),
        (lambda sim: birm3d.greatest_gap(sim, penetration=-1.0), "penetration must be >= 0 m, got -1"),
        (lambda sim: birm3d.greatest_gap(sim, ("1 kg", "2 m")), "gaps"),
        (lambda sim: birm3d.least_height(sim, (0.0, 1.0)), "heights must be"),
        (
            lambda sim: birm3d.least_segment_mass(sim, deflection=0.5),
            "must have a free-standing Jersey barrier",
        ),
        (lambda sim: birm3d.worst_offset(sim, []), "spacings must be at least one"),
        (lambda sim: birm3d.worst_offset(sim, ["wide"]), "^spacings must be a number in m, or text with one"),
        (lambda sim: birm3d.worst_offset(sim, [0.1]), "spacings must be finite and above the diameter"),
        (lambda sim: birm3d.worst_offset(sim, metric="beauty"), "metric must be one of"),
        (lambda sim: birm3d.worst_offset(sim, points=2), "points must be"),
    ],
)
def test_refused(call, message) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(ValueError, match=message):
        call(Simulation(car(), Barrier.bollards(), 10.0))


def test_refused_barriers() -> None:
    wall = Simulation(car(), Barrier.rigid_wall(), 10.0)
    jersey = Simulation(car(), Barrier.jersey(), 10.0, 25.0)
    for search in (birm3d.greatest_gap, birm3d.worst_offset):
        with pytest.raises(ValueError, match="must have a row of at least two bollards"):
            search(wall)
    with pytest.raises(ValueError, match=r"must have a barrier with a height, .* got Pole"):
        birm3d.least_height(Simulation(car(), Barrier.pole(), 10.0))
    with pytest.raises(
        ValueError, match=r"heights must be values that can be run, got 0.2 m: .*height must be"
    ):
        birm3d.least_height(jersey, (0.2, 0.8), points=2)
    with pytest.raises(ValueError, match="must have a barrier, got none"):
        birm3d.least_height(Simulation(car(), None, 10.0, duration=0.1))


def test_interrupted(monkeypatch: pytest.MonkeyPatch) -> None:
    """Ctrl-C in the bisection: the runs of the scan are not lost."""
    real, calls = limit_search.run_study, []

    def run_study(*arguments, **options):  # type: ignore[no-untyped-def]
        study = real(*arguments, **options)
        calls.append(study)
        if len(calls) == 2:
            raise StudyInterrupted("stopped: 1 of 1 runs are finished", study)
        return study

    monkeypatch.setattr(limit_search, "run_study", run_study)
    wall = Barrier.rigid_wall(width=6.0, height=1.0, friction=0.0)
    simulation = Simulation(one_truss(0.637), wall, 5.0, settings=FREE)
    with pytest.raises(StudyInterrupted) as stopped:
        birm3d.least_height(simulation, (0.2, 1.2), points=5)
    assert len(stopped.value.study) == 6


def test_command_line(command, capsys, tmp_path) -> None:
    scene = ["--vehicle", "passenger_car", "--mesh-density", "0.3", "--speed", "10m/s"]
    row = [*scene, "--barrier", "bollards"]
    figure = tmp_path / "height.png"
    search = ["search", "height", *row, "--range", "0.2:100cm", "--points", "4"]
    assert command(*search, "--plot", str(figure)) == 0
    out, err = capsys.readouterr()
    assert out.startswith("least height: ")
    assert f"figure: {figure}" in err
    assert command("search", "gap", *row, "--range", "0.8:2.4", "--points", "3", "--json") == 0
    assert json.loads(capsys.readouterr().out)["name"] == "clear gap"
    assert command("search", "offset", *row, "--spacings", "1.2,1.4", "--json") == 0
    assert [r["spacing"] for r in json.loads(capsys.readouterr().out)["spacings"]] == [1.2, 1.4]
    free = [*scene, "--barrier", "jersey", "--length", "40", "--segments", "10", "--free-standing"]
    arguments = [*free, "--angle", "25", "--deflection", "0.5", "--points", "3", "--range", "1t:6t"]
    assert command("search", "segment-mass", *arguments) == 0
    assert "segment mass" in capsys.readouterr().out
    assert command("search", "height", *scene, "--barrier", "planter", "--points", "2") == 0
    assert capsys.readouterr().out.startswith("least height: ")
    assert command("search", "gap", *row, "--range", "1") == 2
    assert "--range must be LEAST:GREATEST, got '1'" in capsys.readouterr().err


@pytest.mark.filterwarnings("ignore::birm3d.LowBarrierWarning", "ignore::birm3d.CoreContactWarning")
def test_the_line_on_the_class_is_not_cut_in_the_figure(monkeypatch: pytest.MonkeyPatch) -> None:
    truck = Vehicle.preset("cargo_truck", mesh_density=0.1)
    crash = Simulation(truck, Barrier.bollards(count=1), 13.4)
    found = birm3d.least_height(crash, (0.2, 1.0), points=3, resolution=0.2, offsets=[0.0], draws=0)
    monkeypatch.setattr(found, "class_shares", {0.2 + 0.1 * i: 0.5 + 0.05 * i for i in range(9)})
    figure = found.plot()
    figure.canvas.draw()
    title = figure.axes[0].title
    assert " ".join(title.get_text().split()).endswith("90% at 1.00 m.")
    box = title.get_window_extent()
    assert 0.0 <= box.x0 < box.x1 <= figure.bbox.x1
