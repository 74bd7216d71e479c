"""The rivals' benchmark: exact answers, NumPy row, choice of equal error. No rival need be installed."""

from __future__ import annotations

import csv
import math
import subprocess
import sys
from pathlib import Path

import pytest

BENCH = Path(__file__).resolve().parents[1] / "bench"


@pytest.fixture(autouse=True)
def _programs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(BENCH))


def test_closed_forms() -> None:
    from rivals.definition import MASS, SPEED, W1, W2

    assert W1.exact == pytest.approx(
        {
            "dynamic_crush": SPEED * math.sqrt(MASS / 3e6),
            "peak_normal_force": SPEED * math.sqrt(MASS * 3e6),
            "exit_speed": SPEED,
        },
        rel=1e-12,
    )
    crush, peak, rebound = W2.exact.values()
    assert (crush, peak, rebound) == pytest.approx((0.9256, 4353.8e3, 6.814), rel=6e-5)  # as published
    # Energy: what comes in is under the two segments, what goes out under the unloading line.
    loading = 0.5 * 1.2e6 * 0.4 + 0.5 * (1.2e6 + peak) * (crush - 0.4)
    assert loading == pytest.approx(0.5 * MASS * SPEED**2, rel=1e-12)
    assert 0.5 * peak**2 / 60e6 == pytest.approx(0.5 * MASS * rebound**2, rel=1e-12)


@pytest.mark.parametrize("name", ["W1", "W2"])
def test_numpy_row_meets_the_closed_form(name: str) -> None:
    """Second order: a quarter of the step, or less, leaves a tenth of the error or less."""
    from rivals.definition import CASES
    from rivals.numpy_rows import RIVALS

    case = CASES[name]
    for rival in RIVALS:
        run = rival.build(case, 20)
        coarse, fine = (case.error(run(step))[0] for step in (2e-3, 2e-4))
        assert fine < 2e-5
        assert fine < 0.1 * coarse


def test_oblique_answer_is_confirmed_by_an_independent_integrator() -> None:
    """Twelve nodes: two columns press, the truss law goes through all its parts."""
    from rivals import numpy_rows, oblique
    from rivals.definition import COMPARED, W3

    ours = oblique.with_answer(W3, 12)
    found = oblique.independent(W3, 12)
    assert found == pytest.approx(dict(ours.exact), rel=2e-5)
    numpy = numpy_rows.RIVALS[0].build(W3, 12)(1e-4)
    assert {name: getattr(numpy, name) for name in COMPARED} == pytest.approx(found, rel=5e-5)


def test_equal_error_is_not_luck() -> None:
    """An error that is small at one setting and greater at a finer one does not count."""
    from rivals.precision import Point, setting_for

    errors = {8.0: 2e-4, 4.0: 5e-3, 2.0: 8e-4, 1.0: 5e-5, 0.5: 2e-5}
    points = [Point(setting, error, "", 1, 0.0) for setting, error in errors.items()]
    assert [setting_for(points, target) for target in (1e-2, 1e-3, 1e-4, 1e-5)] == [8.0, 2.0, 1.0, None]


def test_wrong_answer_is_not_timed() -> None:
    from rivals import precision
    from rivals.definition import W1, Answer, Case, Run

    class Soft:
        name, setup, does_more = "soft", "", ""
        settings = (1e-2, 1e-3, 1e-4)
        wrong: dict[str, str] = {}  # noqa: RUF012

        def build(self, case: Case, n: int) -> Run:
            values = [0.98 * value for value in case.exact.values()]
            return lambda setting: Answer(*values, 1, 1e-6)

    entries = precision.enter([Soft()], W1, 10)
    (judged,) = precision.judge(entries, precision.sweep(W1, entries, 1))
    assert judged.run is None
    assert "off by 2.0%" in judged.reason


@pytest.mark.parametrize("module", ["mujoco_callback", "mujoco_contact", "bullet", "exudyn_rows", "opensees"])
def test_absent_rivals_are_listed(module: str, monkeypatch: pytest.MonkeyPatch) -> None:
    import importlib

    from rivals import mujoco_callback, precision
    from rivals.definition import W1

    for package in ("mujoco", "pybullet", "exudyn", "openseespy", "openseespy.opensees"):
        monkeypatch.setitem(sys.modules, package, None)
    mujoco_callback.compiled.cache_clear()
    rivals = importlib.import_module(f"rivals.{module}").RIVALS
    for entry in precision.enter(rivals, W1, 10):
        assert entry.run is None
        assert "not installed" in entry.reason or "wrong physics" in entry.reason


def test_runner_writes_a_table(tmp_path: Path) -> None:
    """With what the project itself needs: BIRM3D and NumPy."""
    done = subprocess.run(
        [
            sys.executable, "-W", "error", BENCH / "bench_rivals.py", "--quick",
            "--only", "ours", "numpy_rows", "--cases", "W1", "W2", "--save", "--folder", tmp_path,
        ],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    text = (tmp_path / "work_precision.csv").read_text(encoding="utf-8")
    rows = list(csv.DictReader(line for line in text.splitlines() if not line.startswith("#")))
    assert {row["rival"] for row in rows} == {"BIRM3D", "BIRM3D, fixed step", "NumPy", "NumPy, lean"}
    for row in rows:
        assert float(row["error"]) <= float(row["target"])
        assert 0.0 < float(row["time_ms"]) < math.inf
    assert "**W2, N = 100**" in (tmp_path / "table.md").read_text(encoding="utf-8")
    assert (tmp_path / "work_precision_w2.png").stat().st_size > 10_000


def test_scaling_tells_cost_and_error() -> None:
    done = subprocess.run(
        [
            sys.executable,
            "-W",
            "error",
            BENCH / "bench_scaling.py",
            "--quick",
            "--axes",
            "touched",
            "untouched",
        ],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    assert "touched: time ~ nodes^" in done.stdout
    assert "ten times the untouched nodes" in done.stdout
    errors = [float(line.split()[5]) for line in done.stdout.splitlines() if line.endswith("exit_speed")]
    assert len(errors) == 6
    assert max(errors) < 1e-3


def test_what_laws_beyond_the_papers_cost() -> None:
    done = subprocess.run(
        [sys.executable, "-W", "error", BENCH / "bench_skin_laws.py", "--quick"],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    rows = [line.split() for line in done.stdout.splitlines() if line.startswith("passenger_car")]
    assert len(rows) == 8
    for row in rows:  # ..., paper, ms, ours, ms, ratio
        assert float(row[-5]) > 0.0
        assert float(row[-1]) == pytest.approx(float(row[-3]) / float(row[-5]), abs=0.02)
    assert "mark 1.5" in done.stdout
