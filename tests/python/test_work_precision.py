"""Errors against run time: against exact answers, and by their own laws. Nothing here depends on a time."""

from __future__ import annotations

import csv
import math
import pickle
import subprocess
import sys
from pathlib import Path

import birm3d
import numpy as np
import pytest
from birm3d import Barrier, Settings, Simulation, Vehicle, scenes
from birm3d.study import PrecisionRow, WorkPrecision, WorkPrecisionInterrupted, work_precision
from birm3d.study.verification.convergence import Limit, limit_of, order_of, richardson
from birm3d.study.verification.errors import BALANCES, BOOKKEEPING, least_scales, relative_errors
from birm3d.study.verification.precision_runs import PrecisionRun, run_at
from birm3d.study.verification.triangulated import triangulated

PROGRAM = Path(__file__).resolve().parents[1] / "bench/bench_accuracy.py"
QUICK = {"tolerances": (1e-1, 1e-3, 1e-5), "references": (1e-6, 1e-7), "repeats": 1}


def exact_w2() -> dict[str, float]:
    """Two straight segments, then unloading, from the energy: 0.9256 m and 6.814 m/s."""
    mass, speed, k1, knee, k2, k3 = 6804.0, 22.352, 3e6, 0.4, 6e6, 60e6
    rest = 0.5 * mass * speed**2 - 0.5 * k1 * knee**2
    beyond = (math.sqrt((k1 * knee) ** 2 + 2.0 * k2 * rest) - k1 * knee) / k2
    return {
        "dynamic_crush": knee + beyond,
        "exit_speed": (k1 * knee + k2 * beyond) / math.sqrt(k3 * mass),
    }


@pytest.fixture(scope="module")
def w2() -> WorkPrecision:
    return work_precision(scenes.w2(24), time_steps=(1e-3, 1e-4, 0.9), mesh_densities=(), **QUICK)


@pytest.fixture(scope="module")
def oblique() -> WorkPrecision:
    car = Vehicle.preset("passenger_car", mesh_density=0.1)
    scene = Simulation(car, Barrier.rigid_wall(), 15.0, 24.0)
    return work_precision(scene, time_steps=(1e-3,), mesh_densities=(0.1, 0.2, 0.4), **QUICK)


# ---- limits ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("order", [0.3, 0.5, 1.0, 2.0, 3.3])
@pytest.mark.parametrize("ratio", [2.0, 10.0])
def test_limit_of_a_power_law_is_exact(order: float, ratio: float) -> None:
    h = ratio ** -np.arange(4.0)
    value = 3.0 + 5.0 * h**order
    found = limit_of(h, value, 3.0)
    if ratio**order < 1.25:  # falls too slowly to extrapolate
        assert found.order is None
    else:
        assert found.value == pytest.approx(3.0, rel=1e-9)
        assert found.order == pytest.approx(order, rel=1e-6)
    assert abs(found.value - 3.0) <= found.uncertainty * (1.0 + 1e-9)
    assert order_of(h[:-1], np.diff(value)) == pytest.approx(order, rel=1e-9)
    assert richardson(value[0], value[1], ratio, order) == pytest.approx(3.0, rel=1e-9)


@pytest.mark.parametrize(("noise", "least"), [(0.3, 0.95), (1.0, 0.7), (3.0, 0.8), (1e3, 0.9)])
def test_uncertainty_covers_noise(noise: float, least: float) -> None:
    """A power law with noise beside its last change: in how many draws the true limit is covered.

    Found: 1.00, 0.79, 0.82, 0.94; worst where the noise is just as large as the last change.
    """
    rng = np.random.default_rng(1)
    h = 10.0 ** -np.arange(4.0)
    law = 1.0 + 0.1 * h**0.5
    draws = law + noise * (law[-2] - law[-1]) * rng.uniform(-1.0, 1.0, (1000, 4))
    limits = [limit_of(h, draw, 1.0) for draw in draws]
    assert np.mean([abs(found.value - 1.0) <= found.uncertainty for found in limits]) >= least


def test_limit_of_what_does_not_change_is_that() -> None:
    assert limit_of([3.0, 2.0, 1.0], [7.0, 7.0, 7.0], 7.0) == Limit(7.0, 7e-12, None)


@pytest.mark.parametrize(
    ("h", "values", "message"),
    [
        ([2.0, 1.0], [1.0, 1.0], "three answers"),
        ([1.0, 2.0, 3.0], [1.0, 1.0, 1.0], r"h must .* fall"),
        ([3.0, 2.0, 0.0], [1.0, 1.0, 1.0], r"h must be > 0"),
    ],
)
def test_bad_sequences_are_named(h: list[float], values: list[float], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        limit_of(h, values, 1.0)


# ---- errors ------------------------------------------------------------------------------------------------


def test_errors_near_zero_are_judged_by_a_scale() -> None:
    least = least_scales(scenes.w2(24).scene)
    assert least["max_pitch"] == 5.0
    assert least["exit_speed"] == pytest.approx(2.2352)
    assert least["peak_normal_force"] == pytest.approx(6804.0 * 0.980665)
    found = relative_errors(
        {"max_pitch": 0.1, "exit_speed": 10.0}, {"max_pitch": 0.0, "exit_speed": 8.0}, least
    )
    assert found == pytest.approx({"max_pitch": 0.02, "exit_speed": 0.25})
    assert relative_errors({}, {"max_pitch": 1.0}, least)["max_pitch"] == math.inf
    assert least_scales(scenes.w2(24).scene, {"max_pitch": 1.0})["max_pitch"] == 1.0


def test_every_metric_has_an_error(w2: WorkPrecision) -> None:
    metrics = set(scenes.w2(24).run().metrics) - BOOKKEEPING - BALANCES
    assert set(w2.converged) == set(w2.default.errors) == metrics


def test_converged_values_are_the_exact_ones(w2: WorkPrecision) -> None:
    for name, exact in exact_w2().items():
        limit = w2.converged[name]
        assert abs(limit.value - exact) <= limit.uncertainty + 1e-9 * exact, name
        assert w2.uncertainty[name] < 1e-5


def test_errors_fall_with_the_tolerance(w2: WorkPrecision) -> None:
    rows = w2.of(kind="tolerance")
    assert [row.value for row in rows] == [1e-1, 1e-3, 1e-5]
    exact = exact_w2()
    for row in rows:
        for name, value in exact.items():
            true = abs(row.values[name] - value) / value
            assert row.errors[name] == pytest.approx(true, abs=1e-6)
    assert rows[0].error > 3.0 * rows[1].error > 9.0 * rows[2].error
    assert rows[0].energy_residual > 10.0 * rows[1].energy_residual > 100.0 * rows[2].energy_residual
    assert rows[0].force_evaluations < rows[1].force_evaluations < rows[2].force_evaluations


def test_a_refused_step_is_a_row(w2: WorkPrecision) -> None:
    too_long, coarse, fine = w2.of(kind="time_step")
    assert too_long.value == 0.9
    assert too_long.refused.startswith("UnstableError: time_step must be")
    assert too_long.error == math.inf
    assert fine.error < coarse.error < 0.01


def test_representations_of_a_flat_wall_agree(w2: WorkPrecision) -> None:
    assert max(map(abs, w2.departures("triangulated barrier").values())) < 1e-9


def test_the_papers_rule_is_another_model(w2: WorkPrecision, oblique: WorkPrecision) -> None:
    """Truss and normal are parallel head-on, so that both rules are one; at 24 deg they are not."""
    assert max(map(abs, w2.departures("contact model along_truss").values())) < 1e-9
    assert max(map(abs, oblique.departures("contact model along_truss").values())) > 0.1
    with pytest.raises(ValueError, match=r"variant must be one of as given, .*got 'none'"):
        oblique.departures("none")


def test_meshes_tend_to_a_limit(oblique: WorkPrecision) -> None:
    rows = oblique.of("mesh")
    assert [row.value for row in rows] == [0.1, 0.2, 0.4]
    assert rows[0].force_evaluations < rows[2].force_evaluations
    assert all(row.errors["exit_speed"] < 0.02 for row in rows)


def test_bollards_in_triangles_have_no_loads_of_elements() -> None:
    car = Vehicle.preset("passenger_car", mesh_density=0.1)
    found = work_precision(
        Simulation(car, Barrier.bollards(count=2), 10.0, duration=0.05),
        contact_models=False,
        mesh_densities=(),
        time_steps=(1e-3,),
        **QUICK,
    )
    row = found.of("triangulated barrier", "tolerance")[0]
    assert "dynamic_crush" in row.errors
    assert "peak_element_force" not in row.errors
    assert triangulated(None) is None
    assert triangulated(Barrier.jersey(length=10.0, segments=2, free_standing=True)) is None


def test_scene_without_a_barrier(tmp_path: Path) -> None:
    """Rolling has no forces of nodes: figures on logarithmic scales draw it too."""
    found = work_precision(scenes.rolling(0.3), mesh_densities=(), **QUICK)
    assert {row.variant for row in found.rows} == {"as given"}
    assert found.default.error < 1e-5  # the pitch by rolling resistance; computed: 7e-7
    assert "peak_deceleration" in found.converged
    found.plot().savefig(tmp_path / "plot.png")
    found.requested_vs_achieved().savefig(tmp_path / "requested.png")


def test_fixed_step_of_the_scene_is_the_default() -> None:
    settings = Settings(gravity=0.0, ground=False, time_step=5e-4)
    found = work_precision(scenes.w2(24, settings), time_steps=(1e-3,), mesh_densities=(), **QUICK)
    assert found.default.kind == "time_step"
    assert found.default.value == 5e-4
    assert found.default in found.rows


# ---- what it is for ----------------------------------------------------------------------------------------


def made(rows: list[tuple[str, float, float, float]], uncertainty: float = 0.0) -> WorkPrecision:
    """A study from rows of kind, value, error and time."""
    made_rows = [
        PrecisionRow("as given", kind, value, Settings(), {"x": 0.0}, {"x": error}, run_time=time)
        for kind, value, error, time in rows
    ]
    limits = {"as given": {"x": Limit(1.0, uncertainty, None)}}
    return WorkPrecision(title="", rows=made_rows, of_variant=limits, scales={"x": 1.0}, default=made_rows[0])


def test_the_cheapest_setting_is_recommended() -> None:
    rows = [
        ("tolerance", 1e-1, 0.005, 1.0),  # by luck: the next has more
        ("tolerance", 1e-2, 0.03, 2.0),
        ("tolerance", 1e-3, 0.008, 4.0),
        ("tolerance", 1e-4, 0.001, 8.0),
        ("time_step", 1e-2, 0.02, 1.0),
        ("time_step", 1e-3, 0.009, 3.0),
    ]
    assert made(rows).recommend(0.01).row.setting == "time step 0.001 s"
    assert made(rows[:4]).recommend(0.01).row.setting == "tolerance 0.001"
    assert made(rows).recommend(0.05).row.setting == "tolerance 0.1"
    assert made(rows).recommend(0.002).row.setting == "tolerance 0.0001"
    # What is not known of the converged value counts.
    assert made(rows, uncertainty=5e-3).recommend(0.01).row.setting == "tolerance 0.0001"
    with pytest.raises(ValueError, match=r"error must be at least 0\.021, .* got 0\.01"):
        made(rows, uncertainty=0.02).recommend(0.01)


def test_a_recommendation_can_be_run(oblique: WorkPrecision) -> None:
    best = oblique.recommend(0.02)
    assert best.error <= 0.02
    assert str(best) == best.text
    assert best.row.setting in best.text
    car = Vehicle.preset("passenger_car", mesh_density=0.1)
    metrics = Simulation(car, Barrier.rigid_wall(), 15.0, 24.0, settings=best.settings).run().metrics
    assert {name: metrics[name] for name in best.row.values} == dict(best.row.values)


def test_report_table_and_figures(oblique: WorkPrecision, tmp_path: Path) -> None:
    report = oblique.report(0.05)
    for text in ("for an error of 5 % in every metric", "along_truss", "triangulated", "density 0.2"):
        assert text in report
    assert "no setting for an error of 1e-07 %" in oblique.report(1e-9)
    table = oblique.to_dataframe()
    assert len(table) == len(oblique.rows) == len(oblique.table["error"])
    assert table.attrs["units"]["max_yaw"] == "deg"
    oblique.save(tmp_path / "table.csv")
    with (tmp_path / "table.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["value"]) for row in rows] == pytest.approx(table["value"].tolist(), rel=1e-5)
    left, right = oblique.plot().axes
    assert left.get_xscale() == left.get_yscale() == right.get_xscale() == "log"
    achieved = oblique.requested_vs_achieved(["max_yaw"]).axes[0]
    assert "max_yaw" in [line.get_label() for line in achieved.lines]


# ---- bad input ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"tolerances": (1e-2, 0.0)}, r"tolerances: tolerance must .*got 0"),
        ({"time_steps": (-1e-3,)}, r"time_steps: time_step must .*got -0\.001"),
        ({"time_steps": ()}, "time_steps must be one number or more, got none"),
        ({"references": (1e-6,)}, "references must be two tolerances or more, all below 1e-05"),
        ({"references": (1e-4, 1e-6)}, "references must be two tolerances or more, all below 1e-05"),
        ({"references": (1e-7, 1e-12)}, r"references: tolerance must .*got 1e-12"),
        ({"repeats": 0}, "repeats must be an integer >= 1, got 0"),
        ({"most_steps": 0}, "most_steps must be an integer >= 1, got 0"),
        ({"mesh_densities": (1.0, 2.0, 4.0)}, "mesh_densities must .* of a vehicle that has a file"),
        ({"metrics": ("exit_angel",)}, r"metrics must be among .*got 'exit_angel'"),
        ({"metrics": ()}, "metrics must name at least one"),
        ({"scales": {"steps": 1.0}}, r"scales must name metrics .*got 'steps'"),
        ({"scales": {"max_yaw": 0.0}}, r"scales\['max_yaw'\] must be finite and > 0, got 0"),
    ],
)
def test_bad_input_is_named(arguments: dict, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        work_precision(scenes.w2(4), **{**QUICK, **arguments})


def test_bad_wishes_are_named(w2: WorkPrecision) -> None:
    with pytest.raises(ValueError, match="error must be finite and > 0, got 0"):
        w2.recommend(0.0)
    with pytest.raises(ValueError, match=r"metrics must be among .*got 'crush'"):
        w2.recommend(0.01, ["crush"])


def test_the_package_has_it() -> None:
    assert birm3d.study.work_precision is work_precision
    assert birm3d.study.Study is birm3d.Study


# ---- the page ----------------------------------------------------------------------------------------------


def test_one_command_writes_the_page(tmp_path: Path) -> None:
    done = subprocess.run(
        [
            *(sys.executable, "-W", "error", PROGRAM),
            *("--quick", "--cases", "w2", "--repeats", "1", "--folder", tmp_path),
        ],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    page = (tmp_path / "README.md").read_text(encoding="utf-8")
    assert "# How accurate, how fast" in page
    for file in ("work_precision.png", "requested.png", "w2.png"):
        assert f"({file})" in page
        assert (tmp_path / file).stat().st_size > 1000
    with (tmp_path / "claims.csv").open(encoding="utf-8", newline="") as file:
        claims = list(csv.DictReader(file))
    assert [claim["holds"] for claim in claims] == ["yes"] * 3
    assert "holds  default tolerance within 1 %" in done.stdout


# ---- what takes long ---------------------------------------------------------------------------------------


def test_a_model_that_takes_too_many_steps_is_refused_and_not_run_stricter() -> None:
    """At the default, along_truss took more than a million steps at a planter, two minutes a run."""
    car = Vehicle.preset("passenger_car", mesh_density=0.1)
    scene = Simulation(car, Barrier.rigid_wall(), 15.0, 24.0)
    found = work_precision(scene, time_steps=(1e-3,), mesh_densities=(), most_steps=400, **QUICK)
    other = "contact model along_truss"
    assert [bool(row.refused) for row in found.of(other)] == [False, False, True, True, True]
    said, *later = [row.refused for row in found.of(other) if row.refused]
    assert said.startswith(
        "TooManyStepsError: most_steps must be at least what the run takes, got 400, taken by"
    )
    assert later == ["not run: tolerance 1e-05 takes too many steps"] * 2
    assert found.departures(other) == {}
    assert max(row.steps for row in found.of()) > 400  # the scene as given has no such limit
    assert found.report().count(f"{other}: refused") == 2
    found.plot()


def test_a_run_of_more_than_a_second_is_not_repeated() -> None:
    run = run_at(scenes.w2(4), "as given", "tolerance", 1e-2)
    run.once()
    run.once()
    assert len(run.times) == 2
    run.times[0] = 1.5
    run.once()
    assert len(run.times) == 2


@pytest.mark.parametrize(("stop_at", "known"), [(3, False), (7, True)])
def test_ctrl_c_keeps_what_is_done(monkeypatch: pytest.MonkeyPatch, stop_at: int, known: bool) -> None:
    """The scene as given comes first, with its converged values: from then on there are errors."""
    taken = []
    once = PrecisionRun.once

    def interrupted(run: PrecisionRun) -> None:
        taken.append(run)
        if len(taken) > stop_at + 1:  # the first is the warm-up
            raise KeyboardInterrupt
        once(run)

    monkeypatch.setattr(PrecisionRun, "once", interrupted)
    with pytest.raises(WorkPrecisionInterrupted, match=rf"stopped after {stop_at} of 16 runs") as stopped:
        work_precision(scenes.w2(24), time_steps=(1e-3,), mesh_densities=(), **QUICK)
    found = stopped.value.work_precision
    assert (found is not None) == known
    assert isinstance(stopped.value, KeyboardInterrupt)
    assert pickle.loads(pickle.dumps(stopped.value)).args == stopped.value.args
    if found is not None:
        assert found.recommend(0.01).row.variant == "as given"
        missing = {row.refused for row in found.rows if row.variant != "as given"}
        assert missing == {"", "not run: interrupted before it"}
        assert all(row.errors for row in found.of())
