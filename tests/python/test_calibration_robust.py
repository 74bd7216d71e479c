"""Calibration: executors, interruptions, failing runs, files, and input that can not be used."""

from __future__ import annotations

import dataclasses
import json
import multiprocessing
import os
import pickle
import signal
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from birm3d import Settings, Simulation, calibrate, scenes
from birm3d.calibration import (
    CalibrationError,
    CalibrationInterruptedError,
    CalibrationResult,
    CurveTarget,
    Parameter,
    ScalarTarget,
    load,
)
from birm3d.calibration.fit import start_point
from birm3d.scene_parameters import varied

TIME = np.arange(0.0, 0.1, 1e-3)
FORCE = scenes.w2_force(TIME)
KNEE = Parameter("truss.knee", 0.1, 0.9, start=0.5)
STIFFNESS = Parameter("truss.k_initial", 1e6, 9e6, start=4e6, log=True)


def block() -> Simulation:
    return scenes.w2(6)


def force(**options: object) -> CurveTarget:
    return CurveTarget(TIME, FORCE, **{"sigma": 2e4, **options})


def dies_elsewhere(simulation: Simulation, value: float) -> Simulation:
    """A worker that is killed, as by a machine that runs out of memory."""
    if multiprocessing.parent_process() is not None and value != 0.5:
        os._exit(1)
    return varied(simulation, {"truss.knee": value})


def fails_above(simulation: Simulation, value: float) -> Simulation:
    if value > 0.45:
        raise ValueError(f"knee must be < 0.45 here, got {value}")
    return varied(simulation, {"truss.knee": value})


def fails_but_at_the_start(simulation: Simulation, value: float) -> Simulation:
    if value != 0.5:
        raise ValueError("nothing but the start will do")
    return simulation


def wrong_program(simulation: Simulation, value: float) -> Simulation:
    if value != 0.5:
        raise KeyError("a fault in a program, not in a scene")
    return simulation


def knee_by(function: Callable[[Simulation, float], Simulation]) -> Parameter:
    return Parameter(apply=function, lower=0.1, upper=0.9, start=0.5, name="knee")


@pytest.fixture(scope="module")
def fit() -> CalibrationResult:
    noise = np.random.default_rng(0).normal(0.0, 5e4, len(TIME))
    target = CurveTarget(TIME, FORCE + noise, sigma=5e4)
    crush = ScalarTarget("max_displacement", 0.926, 0.005)
    return calibrate(block(), [target, crush], [STIFFNESS, KNEE], starts=2, intervals="profile")


class TestExecutors:
    def test_results_do_not_depend_on_the_executor(self) -> None:
        results = [calibrate(block(), force(), [STIFFNESS, KNEE], jobs=1)]
        with ThreadPoolExecutor(3) as threads:
            results.append(calibrate(block(), force(), [STIFFNESS, KNEE], executor=threads))
        with ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("spawn")) as processes:
            results.append(calibrate(block(), force(), [STIFFNESS, KNEE], executor=processes))
        first = results[0]
        for other in results[1:]:
            assert other.values == first.values
            assert other.intervals == first.intervals
            assert other.history == first.history
            assert other.summary() == first.summary()

    def test_start_number_i_depends_on_seed_and_i_only(self) -> None:
        few, many = (calibrate(block(), force(), [STIFFNESS, KNEE], starts=n, seed=7) for n in (2, 4))
        assert [s["start"] for s in many.starts[:2]] == [s["start"] for s in few.starts]
        assert not np.array_equal(start_point(7, 1, 2), start_point(8, 1, 2))
        assert not np.array_equal(start_point(7, 1, 2), start_point(7, 2, 2))

    def test_an_executor_that_dies(self) -> None:
        # One process: Python 3.11 itself fails where it starts a second one while it counts those that broke.
        with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as processes:
            with pytest.raises(CalibrationError, match=r"ProcessPoolExecutor failed after .* runs") as caught:
                calibrate(block(), force(), knee_by(dies_elsewhere), executor=processes, starts=1)
            assert [run.values for run in caught.value.history] == [(0.5,)]
            assert caught.value.best_values == (0.5,)

    def test_an_executor_that_was_closed(self) -> None:
        threads = ThreadPoolExecutor(1)
        threads.shutdown()
        with pytest.raises(
            CalibrationError, match=r"ThreadPoolExecutor failed after 0 runs.*shutdown"
        ) as caught:
            calibrate(block(), force(), KNEE, executor=threads)
        assert caught.value.history == ()
        assert caught.value.best_values is None

    def test_control_c_keeps_what_is_finished(self) -> None:
        def press(count: int, best: float | None) -> None:
            if count >= 10 and not pressed:
                pressed.append(count)
                os.kill(os.getpid(), signal.SIGINT)

        pressed: list[int] = []
        with pytest.raises(KeyboardInterrupt) as caught:
            calibrate(block(), force(), [STIFFNESS, KNEE], starts=8, progress=press)
        assert isinstance(caught.value, CalibrationInterruptedError)
        assert len(caught.value.history) >= 10
        assert caught.value.best_values is not None

    def test_progress_counts_every_run_once(self) -> None:
        seen: list[tuple[int, float | None]] = []
        result = calibrate(block(), force(), KNEE, starts=2, progress=lambda *now: seen.append(now))
        assert [count for count, _ in seen] == sorted(count for count, _ in seen)
        assert seen[-1][0] == len(result.history)
        assert min(e.cost for e in result.history if e.cost is not None) == pytest.approx(seen[-1][1])


class TestFailingRuns:
    def test_are_avoided_and_counted(self) -> None:
        parameter = dataclasses.replace(knee_by(fails_above), start=0.3)
        result = calibrate(block(), force(), parameter, starts=6)
        assert result.values["knee"] == pytest.approx(0.4, rel=1e-3)
        assert result.failed_runs > 0
        assert all("knee must be < 0.45" in e.failure for e in result.history if e.cost is None)
        assert f"{result.failed_runs} failed" in result.summary()
        assert any(start["chi_square"] is None for start in result.starts)

    def test_beside_the_optimum_leave_a_one_sided_difference(self) -> None:
        parameter = Parameter(apply=fails_above, lower=0.1, upper=0.9, start=0.44, name="knee")
        target = CurveTarget(TIME, scenes.w2_force(TIME, knee=0.4495), sigma=2e4)
        result = calibrate(block(), target, parameter, starts=1)
        assert result.values["knee"] == pytest.approx(0.4495, abs=2e-3)
        assert result.failed_runs > 0

    def test_that_hold_the_fit_are_the_reason(self) -> None:
        """The truth, 0.5, is beyond what runs."""
        parameter = Parameter(apply=fails_above, lower=0.1, upper=0.9, start=0.4, name="knee")
        target = CurveTarget(TIME, scenes.w2_force(TIME, knee=0.5), sigma=2e4)
        result = calibrate(block(), target, parameter, starts=1)
        assert 0.44 < result.values["knee"] < 0.45
        assert result.intervals["knee"] is None
        assert result["knee"].reason.startswith(
            "held where runs fail: the data would go on above, but ValueError"
        )

    def test_no_run_at_all(self) -> None:
        with pytest.raises(
            CalibrationError, match=r"no run succeed.* nothing but the start will do"
        ) as caught:
            calibrate(block(), force(), knee_by(fails_but_at_the_start), starts=3)
        assert len(caught.value.history) > 3

    def test_a_first_run_that_fails_says_why(self) -> None:
        with pytest.raises(ValueError, match=r"knee must be < 0\.45"):
            calibrate(block(), force(), knee_by(fails_above))

    def test_a_fault_in_a_function_is_not_taken_for_a_failing_run(self) -> None:
        with pytest.raises(KeyError, match="a fault in a program"):
            calibrate(block(), force(), knee_by(wrong_program))


class TestKeeping:
    def test_round_trip(self, fit: CalibrationResult, tmp_path: Path) -> None:
        path = tmp_path / "fit.json"
        fit.save(path)
        back = load(path)
        assert back.summary() == fit.summary()
        assert back.parameters == fit.parameters
        assert back.history == fit.history
        assert back.spread == fit.spread
        np.testing.assert_array_equal(back.covariance, fit.covariance)
        for ours, theirs in zip(back.targets, fit.targets, strict=True):
            np.testing.assert_array_equal(ours.computed, theirs.computed)
        np.testing.assert_array_equal(back.profiles["truss.knee"].rise, fit.profiles["truss.knee"].rise)
        assert [p.name for p in tmp_path.iterdir()] == ["fit.json"]
        assert back.applied_to(block()).scene.vehicle == fit.vehicle
        for what in ("simulation", "vehicle"):
            with pytest.raises(ValueError, match="read from a file"):
                getattr(back, what)
        assert back.profile("truss.knee").lower == fit.intervals["truss.knee"][0]
        assert "NaN" not in path.read_text()

    def test_pickle(self, fit: CalibrationResult) -> None:
        back = pickle.loads(pickle.dumps(fit))
        assert back.summary() == fit.summary()
        assert back.vehicle == fit.vehicle

    def test_figures(self, fit: CalibrationResult, tmp_path: Path) -> None:
        for name in ("plot_fit", "plot_residuals", "plot_profiles"):
            figure = getattr(fit, name)()
            assert len([axes for axes in figure.axes if axes.get_visible()]) == 2
            figure.savefig(tmp_path / f"{name}.png")
        labels = [line.get_label() for line in fit.plot_fit().axes[0].get_lines()]
        assert labels == ["measured", "computed at the start", "computed, fitted"]

    def test_repr_and_unknown_parameter(self, fit: CalibrationResult) -> None:
        assert "2 of 2 identified" in repr(fit)
        with pytest.raises(KeyError, match=r"truss.k_initial, truss.knee; got 'knee'"):
            fit["knee"]

    @pytest.mark.parametrize(
        ("text", "message"),
        [
            ("{", "must be JSON"),
            ("[]", "format must be 'birm3d calibration', got 'list'"),
            ('{"format": "other"}', "format must be 'birm3d calibration', got 'other'"),
            (json.dumps({"format": "birm3d calibration", "format_version": 99}), "must be 1 or 2, got 99"),
        ],
    )
    def test_other_files(self, tmp_path: Path, text: str, message: str) -> None:
        path = tmp_path / "other.json"
        path.write_text(text)
        with pytest.raises(ValueError, match=message):
            load(path)
        with pytest.raises(ValueError, match="can not be read"):
            load(tmp_path / "missing.json")


NAN = np.where(np.arange(100) == 7, np.nan, FORCE)
BACK = np.where(np.arange(100) == 7, 0.0, TIME)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: CurveTarget(TIME, NAN), "y must be finite, got nan at point 7"),
        (
            lambda: CurveTarget(np.where(TIME == 0.003, np.nan, TIME), FORCE),
            "x must be finite, got nan at point 3",
        ),
        (lambda: CurveTarget(BACK, FORCE), r"x must increase, got 0.006 and then 0 \(points 6 and 7\)"),
        (lambda: CurveTarget(TIME, FORCE[1:]), "y must have the length of x, 100; got 99"),
        (lambda: CurveTarget(TIME, FORCE.reshape(2, 50)), r"y must have shape \(n,\), got \(2, 50\)"),
        (lambda: CurveTarget([0.0], [0.0]), "x must have at least 2 points, got 1"),
        (lambda: force(quantity="force"), "quantity must be one of normal_force, .*; got 'force'"),
        (lambda: force(against="way"), "against must be 'time' or 'displacement', got 'way'"),
        (lambda: force(sigma=0.0), "sigma must be finite and > 0, got 0.0"),
        (lambda: force(sigma=[1.0, 2.0]), "sigma must be one number or have the length of x, 100; got 2"),
        (lambda: force(weight=-1.0), "weight must be finite and > 0, got -1.0"),
        (lambda: force(cfc=600), "interval must be > 0 and at most"),
        (lambda: CurveTarget(TIME**2, FORCE, cfc=60), "x must be evenly spaced where a filter is asked for"),
        (lambda: force(cfc=60, against="displacement"), "filtered must be True against displacement"),
        (lambda: force(independent_points=0.5), "independent_points must be 'all' or 1 to 100, got 0.5"),
        (lambda: force(window=(0.2, 0.1)), r"window must be first < last, got \(0.2, 0.1\)"),
        (lambda: force(window=(0.2, 0.3)), "window must leave at least 2 points"),
        (lambda: ScalarTarget("max_pitch", float("nan"), 1.0), "value of max_pitch must be finite, got nan"),
        (lambda: ScalarTarget("max_pitch", 1.0, 0.0), "sigma of max_pitch must be finite and > 0, got 0.0"),
        (lambda: Parameter("truss.knee"), "lower of truss.knee must be finite, got nan"),
        (
            lambda: Parameter("truss.knee", 0.9, 0.1),
            "lower of truss.knee must be below upper, got 0.9 and 0.1",
        ),
        (
            lambda: Parameter("truss.knee", 0.0, 0.1, log=True),
            "lower of truss.knee must be > 0 with log, got 0",
        ),
        (
            lambda: Parameter("truss.knee", 0.1, 0.9, start=1.0),
            "start of truss.knee must be within its bounds 0.1 to 0.9, got 1",
        ),
        (lambda: Parameter(lower=0.0, upper=1.0), "names must be given, or apply"),
        (
            lambda: Parameter(lower=0.0, upper=1.0, apply=fails_above),
            "name and start must be given with apply",
        ),
        (lambda: Parameter("truss.knee", 0.1, 0.9, prior=(0.4, 0.0)), "prior sigma of truss.knee must be"),
        (lambda: Parameter("truss.knee", 0.1, 0.9, log=True, prior=(0.0, 0.1)), "prior mean of truss.knee"),
    ],
)
def test_bad_targets_and_parameters(make: Callable[[], object], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        make()


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        (
            {"targets": CurveTarget(TIME, -FORCE, sigma=2e4)},
            "normal_force: y must be positive where it pushes .*turn its sign",
        ),
        (
            {"targets": CurveTarget(TIME + 1.0, FORCE, sigma=2e4)},
            "x must lie within the computed run, which ends at",
        ),
        ({"targets": []}, "targets must hold at least one target, got none"),
        ({"targets": ScalarTarget("max_rol", 1.0, 1.0)}, r"metric must be one the run has \(near: max_roll"),
        (
            {"targets": ScalarTarget("delta_v", -29.0, 1.0)},
            "value of delta_v must have the sign of the computed",
        ),
        ({"targets": CurveTarget(TIME, 0.0 * TIME)}, "sigma of normal_force must be given"),
        ({"parameters": []}, "parameters must hold at least one Parameter, got none"),
        ({"parameters": Parameter("truss.kne", 0.1, 0.9)}, r"near: truss.knee.*got 'truss.kne'"),
        (
            {"parameters": Parameter("settings.ground", 0.0, 1.0)},
            "parameter settings.ground must be a number",
        ),
        ({"parameters": Parameter("truss.knee", 0.5, 0.9)}, "start of truss.knee must be within .*, got 0.4"),
        ({"parameters": [KNEE, KNEE]}, "name of a parameter must be its own, got 'truss.knee' twice"),
        (
            {"parameters": [KNEE, dataclasses.replace(KNEE, name="other")]},
            "truss.knee must be driven by one parameter, got truss.knee and other",
        ),
        (
            {"parameters": dataclasses.replace(KNEE, simulations=[1])},
            "simulations of truss.knee must be 0 to 0, got 1",
        ),
        ({"simulations": []}, "simulations must hold at least one Simulation, got none"),
        ({"simulations": [block(), block()]}, "targets must be one sequence for each of 2 simulations"),
        ({"targets": [[force()], [force()]]}, "as many sequences as simulations, 1; got 2"),
        ({"method": "both"}, "method must be one of local, global; got 'both'"),
        ({"intervals": "wide"}, "intervals must be one of covariance, profile; got 'wide'"),
        ({"uncertainty": "none"}, "uncertainty must be one of larger, given, scatter; got 'none'"),
        ({"starts": 0}, "starts must be a whole number >= 1, got 0"),
        ({"seed": -1}, "seed must be a whole number >= 0, got -1"),
        ({"confidence": 95}, "confidence must be between 0 and 1, got 95"),
        ({"tolerance": 2.0}, "tolerance must be 1e-9 to 1, got 2.0"),
        ({"jobs": 0}, "jobs must be >= 1, got 0"),
    ],
)
def test_bad_arguments(changes: dict[str, object], message: str) -> None:
    arguments = {"simulations": block(), "targets": force(), "parameters": KNEE, **changes}
    with pytest.raises(ValueError, match=message):
        calibrate(**arguments)


@pytest.mark.parametrize(
    "changes",
    [{"simulations": "w2"}, {"targets": ["force"], "simulations": block()}, {"parameters": ["knee"]}],
)
def test_wrong_types(changes: dict[str, object]) -> None:
    arguments = {"simulations": block(), "targets": force(), "parameters": KNEE, **changes}
    with pytest.raises(TypeError, match="must be"):
        calibrate(**arguments)


def test_a_unit_that_can_not_be_right_is_noted() -> None:
    kilonewton = CurveTarget(TIME, FORCE / 1e3, sigma=20.0)
    result = calibrate(block(), kilonewton, KNEE, starts=1)
    assert any("0.001 times the computed ones: check the unit" in note for note in result.notes)


def test_a_record_beyond_a_run_of_given_duration_is_refused() -> None:
    short = varied(block(), {"duration": 0.05})
    with pytest.raises(
        ValueError, match=r"ends at 0.05 s .*\(duration\); got 0 to 0.099 s: give the simulation"
    ):
        calibrate(short, force(), KNEE)
    assert calibrate(short, force(window=(0.0, 0.05)), KNEE).values["truss.knee"] == pytest.approx(
        0.4, rel=1e-3
    )


def test_a_record_beyond_the_event_is_held_against_what_follows() -> None:
    """After separation there is no force; the record may go on as long as it likes."""
    time = np.arange(0.0, 0.3, 1e-3)
    result = calibrate(block(), CurveTarget(time, scenes.w2_force(time), sigma=2e4), KNEE, starts=1)
    assert result.values["truss.knee"] == pytest.approx(0.4, rel=1e-4)
    assert (result.targets[0].computed[150:] == 0.0).all()


def test_fixed_steps_stay_fixed() -> None:
    fixed = scenes.w2(6, Settings(gravity=0.0, ground=False, time_step=2e-4))
    result = calibrate(fixed, force(), KNEE, starts=1)
    assert result.simulation.scene.settings.time_step == 2e-4
    assert result.values["truss.knee"] == pytest.approx(0.4, rel=0.01)
