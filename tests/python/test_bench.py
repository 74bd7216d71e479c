"""The benchmark program shows error and time together. Nothing here depends on a time."""

from __future__ import annotations

import csv
import dataclasses
import importlib
import json
import math
import os
import subprocess
import sys
from pathlib import Path

import pytest

PROGRAM = Path(__file__).resolve().parents[1] / "bench/bench_birm3d.py"


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> tuple[str, dict]:
    file = tmp_path_factory.mktemp("bench") / "out.json"
    done = subprocess.run(
        [sys.executable, "-W", "error", PROGRAM, "--quick", "--repeats", "1", "--json", file],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout, json.loads(file.read_text(encoding="utf-8"))


def test_table_has_errors_beside_times(bench: tuple[str, dict]) -> None:
    output, document = bench
    head = next(line for line in output.splitlines() if line.startswith("case"))
    assert "error" in head
    assert "time [ms]" in head
    assert "state hash" in head
    assert len([line for line in output.splitlines() if line.startswith(("W2", "NHTSA"))]) == len(
        document["rows"]
    )


def test_errors_are_finite_and_small(bench: tuple[str, dict]) -> None:
    for row in bench[1]["rows"]:
        assert math.isfinite(row["error"])
        assert 0.0 < row["time"] < math.inf
        limit = {"tolerance 1e-3 (default)": 0.01, "tolerance 1e-4": 0.005}.get(row["setting"], 0.002)
        assert row["error"] < limit, row


def test_numpy_reference_computes_the_same_law(bench: tuple[str, dict]) -> None:
    """Its own scheme is leapfrog, second order: a tenth of the step leaves less than a tenth of the error."""
    rows = {(row["solver"], row["setting"]): row for row in bench[1]["rows"]}
    for solver in ("NumPy", "NumPy, lean"):
        coarse, fine = (rows[solver, setting]["error"] for setting in ("fixed 1 ms", "fixed 0.1 ms"))
        assert fine < 1e-4
        assert fine < 0.1 * coarse


def test_numpy_is_not_asked_for_a_smaller_error(bench: tuple[str, dict]) -> None:
    ours = None
    for row in bench[1]["rows"]:
        if row["solver"] == "BIRM3D":
            ours = row
        else:
            assert ours is not None
            assert row["case"] == ours["case"]
            if not row["setting"].startswith("fixed"):
                assert row["error"] >= 0.99 * ours["error"]


def test_marks_are_stated(bench: tuple[str, dict]) -> None:
    output, document = bench
    assert document["marks"]
    for mark in document["marks"]:
        assert mark["mark"] in output


@pytest.mark.parametrize(
    "path", sorted((PROGRAM.parent / "results").glob("*.csv")), ids=lambda path: path.stem
)
def test_committed_results_are_small_and_name_no_place(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    assert len(text) < 10_000
    assert os.sep + "home" not in text
    rows = list(csv.DictReader(line for line in text.splitlines() if not line.startswith("#")))
    assert {"case", "error", "time_ms"} <= set(rows[0])
    assert all(float(row["error"]) < 0.01 for row in rows)


def output_of(program: str, *arguments: str) -> str:
    done = subprocess.run(
        [sys.executable, "-W", "error", PROGRAM.parent / program, *arguments],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.mark.parametrize("program", ["bench_library.py", "bench_random_impacts.py"])
def test_quick_robustness(program: str) -> None:
    """No scene of the quick choice has a fault; the program would end with 1."""
    assert " 0 with a fault" in output_of(program, "--quick")


def test_quick_batch() -> None:
    """The program compares bits of every way to run a batch; it would end with an error if any differed."""
    output = output_of("bench_batch.py", "--quick")
    assert "same bits: 600 runs" in output
    assert "error" in output.splitlines()[1]


def test_an_indentation_draws_no_node_into_a_post_that_came_past_its_edge() -> None:
    """Seed 3576: nodes of the front that one post indents hopped through another that stands behind them."""
    output = output_of("bench_random_impacts.py", "--first", "3576", "--count", "1")
    assert "1 impacts, 0 with a fault" in output


def test_quick_simd() -> None:
    """The program runs; its full choice builds for each instruction set."""
    assert "1.00 times installed" in output_of("bench_simd.py", "--quick")


def test_random_scenes_are_summarised_by_kind(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.syspath_prepend(str(PROGRAM.parent))
    scenes = importlib.import_module("random_scenes")
    table, summary = tmp_path / "scenes.csv", tmp_path / "summary.csv"
    names = [field.name for field in dataclasses.fields(scenes.Row)]
    with table.open("w", newline="") as file:
        writer = csv.DictWriter(file, names)
        writer.writeheader()
        for seed, (energy, warned) in enumerate([(1e-5, False), (4e-3, False), (9e-3, True)]):
            told = {"fault": "", "refused": "duration must be at most" if seed == 2 else ""}
            row = dict.fromkeys(names, "0.0") | {"seed": seed, "kind": "pole", "energy": energy} | told
            writer.writerow(row | {"warned": warned, "finished": seed == 0, "steps": 10 * seed})
    scenes.write_summary(table, summary)
    with summary.open(newline="") as file:
        (row,) = csv.DictReader(file)
    counts = {name: row[name] for name in ("scenes", "warned", "unfinished", "refused", "faults")}
    assert counts == {"scenes": "3", "warned": "1", "unfinished": "1", "refused": "1", "faults": "0"}
    assert (float(row["energy_50"]), float(row["energy_worst_silent"])) == (4e-3, 4e-3)
    assert (float(row["energy_worst"]), row["steps_50"]) == (9e-3, "10")


class Failing:
    """Stands in for a simulation whose run ends with an error."""

    def __init__(self, message: str) -> None:
        self._core, self.message = self, message

    def __enter__(self) -> None: ...

    def __exit__(self, *_: object) -> None: ...

    def run(self, _tick: object) -> None:
        raise ValueError(self.message)


def test_a_limit_refuses_a_random_scene_without_a_fault(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(PROGRAM.parent))
    run = importlib.import_module("random_scenes")._run
    limit = "duration must be at most 0.66 s, where the 902080 steps end that a record holds, got 1"
    assert run(Failing(limit), 1e9) == (False, limit, "")
    assert run(Failing("gap must be finite"), 1e9) == (False, "", "ValueError: gap must be finite")


def test_what_holds_skin_between_post_and_ground_is_the_same_in_long_steps(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Once it hung on the length of the step, which then fell to 1e-6 s: 46,160 steps in place of 6,020."""
    monkeypatch.syspath_prepend(str(PROGRAM.parent))
    row = importlib.import_module("random_scenes").examine(4467)
    assert row.finished
    assert row.steps < 12_000
    assert row.energy < 1e-4
