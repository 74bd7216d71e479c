"""Rows of vehicle-barrier pairs: errors beside times. Nothing here depends on a time."""

from __future__ import annotations

import csv
import importlib
import math
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest

BENCH = Path(__file__).resolve().parents[1] / "bench"
PROGRAM = BENCH / "bench_pairs.py"


def read(path: Path) -> list[dict[str, str]]:
    lines = path.read_text(encoding="utf-8").splitlines()
    return list(csv.DictReader(line for line in lines if not line.startswith("#")))


@pytest.fixture(scope="module")
def quick(tmp_path_factory: pytest.TempPathFactory) -> tuple[str, list[dict[str, str]], list[dict[str, str]]]:
    folder = tmp_path_factory.mktemp("pairs")
    files = folder / "pairs.csv", folder / "samples.csv"
    done = subprocess.run(
        [sys.executable, "-W", "error", PROGRAM, "--quick", "--csv", files[0], "--samples", files[1]],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout, read(files[0]), read(files[1])


@pytest.fixture(scope="module")
def program() -> ModuleType:
    with pytest.MonkeyPatch.context() as patch:  # bench_birm3d keeps NumPy to one thread, by the environment
        patch.setenv("OPENBLAS_NUM_THREADS", "1")
        patch.setenv("OMP_NUM_THREADS", "1")
        patch.syspath_prepend(BENCH)
        return importlib.import_module("bench_pairs")


def test_a_row_for_each_pair(quick: tuple[str, list, list]) -> None:
    output, rows, _ = quick
    assert [row["barrier"] for row in rows] == [
        "wall",
        "finite_wall",
        "jersey_32in",
        "wall_head_on",
        "bollards",
    ]
    for row in rows:
        assert any(line.split()[:2] == [row["vehicle"], row["barrier"]] for line in output.splitlines())
        # The default tolerance of 1e-3 is held: 4.6e-3 at most when this was written (pitch head-on).
        assert float(row["error"]) < 0.01, row
        # A time at the common error, too, where the default tolerance has it.
        assert 0.0 < float(row["times_flat"]) < math.inf
    assert output.count("within 3 times the flat wall at the same error") == 2


def test_stricter_tolerances_cost_steps_and_bring_accuracy(quick: tuple[str, list, list]) -> None:
    """Over a hundredfold in tolerance the error of each pair falls to less than half, mostly to a tenth."""
    _, _, samples = quick
    for barrier in dict.fromkeys(sample["barrier"] for sample in samples):
        of = [sample for sample in samples if sample["barrier"] == barrier]
        assert [float(sample["tolerance"]) for sample in of] == [1e-2, 1e-3, 1e-4]
        assert float(of[-1]["error"]) < 0.5 * float(of[0]["error"])
        assert int(of[0]["steps"]) < int(of[-1]["steps"])


def sample(program: ModuleType, error: float, time: float) -> object:
    return program.Sample(1.0, error, "", 1, 0, 1, time)


def test_time_at_an_error_is_interpolated(program: ModuleType) -> None:
    """Half way between 0.1 and 0.001 on a logarithmic scale is 0.01, and 2 s between 1 and 4 s."""
    samples = [sample(program, 0.1, 1.0), sample(program, 0.001, 4.0)]
    assert program.time_at(0.01, samples) == pytest.approx(2.0, rel=1e-12)
    assert program.time_at(0.2, samples) == 1.0  # not less than was run
    assert program.time_at(1e-4, samples) is None  # nor more


def test_an_error_that_is_small_by_luck_does_not_count(program: ModuleType) -> None:
    samples = [sample(program, 0.001, 1.0), sample(program, 0.1, 2.0), sample(program, 0.001, 8.0)]
    assert program.time_at(0.01, samples) == pytest.approx(4.0, rel=1e-12)


@pytest.mark.parametrize("path", sorted((BENCH / "results/pairs").glob("*.csv")), ids=lambda path: path.stem)
def test_saved_rows_are_complete(path: Path, program: ModuleType) -> None:
    rows = read(path)
    pairs = {(row["vehicle"], row["barrier"]) for row in rows}
    assert len(pairs) == len(rows) == len(program.PAIRS) * len({row["vehicle"] for row in rows})
    for row in rows:
        assert float(row["time_ms"]) > 0.0
        if row["times_flat"]:
            assert float(row["times_flat"]) > 0.0
