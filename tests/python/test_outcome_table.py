"""Studies of very many runs: outcomes in columns, scenes one at a time."""

from __future__ import annotations

import gc
import math
import tracemalloc
import weakref
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import pytest
from birm3d import Barrier, Simulation, Study, Vehicle, ensemble, monte_carlo, scenes
from birm3d.study import executors
from birm3d.study.float_rows import FloatRows
from birm3d.study.outcome_table import OutcomeTable
from birm3d.study.store import Outcome
from scipy import stats


def outcome(run: int) -> Outcome:
    if run % 7 == 3:
        return Outcome((math.nan, math.nan), error=f"ValueError: {run}")
    return Outcome(
        (float(run), -0.5 * run),
        ("duration", "separated")[run % 2],
        ("stopped", "passed")[run % 2],
        f"{run:016x}",
    )


def same(a: Outcome, b: Outcome) -> bool:
    return a[1:] == b[1:] and np.array_equal(a.metrics, b.metrics, equal_nan=True)


@pytest.mark.parametrize("known", [5000, None])
def test_it_is_the_dictionary_of_the_outcomes(known: int | None) -> None:
    table, expected = OutcomeTable(2, known), {}
    for run in np.random.default_rng(1).permutation(5000)[:4000].tolist():
        table.update([(run, outcome(run))])
        expected[run] = outcome(run)
    assert len(table) == len(expected)
    assert list(table) == sorted(expected)
    assert all(same(table[run], expected[run]) for run in expected)
    missing = next(run for run in range(5000) if run not in expected)
    assert missing not in table
    with pytest.raises(KeyError):
        table[missing]
    assert table.state_hashes() == [expected[run].state_hash for run in table]
    assert table.end_reasons() == [expected[run].end_reason for run in table]
    assert table.outcomes() == [expected[run].outcome for run in table]
    assert table.errors() == [expected[run].error for run in table]
    columns = np.array([expected[run].metrics for run in table]).T
    assert np.array_equal(table.metrics(), columns, equal_nan=True)
    again = sorted(expected)[0]
    table.update({again: outcome(again + 7000)})  # a run that comes twice is one
    assert len(table) == len(expected)
    assert same(table[again], outcome(again + 7000))


def test_a_run_takes_little_more_than_its_numbers() -> None:
    runs, metrics = 20_000, 30
    values = (1.5,) * metrics
    tracemalloc.start()
    before = tracemalloc.get_traced_memory()[0]
    table = OutcomeTable(metrics, runs)
    for run in range(runs):
        table.update([(run, Outcome(values, "separated", "stopped", f"{run:016x}"))])
    gc.collect()
    each = (tracemalloc.get_traced_memory()[0] - before) / runs
    rows = FloatRows(np.zeros((runs, 3)))
    study = Study._of(
        None,
        ("impact_speed", "vehicle.gvw", "barrier.friction"),
        rows,
        dict.fromkeys(map(str, range(metrics)), ""),
        table,
    )
    whole = (tracemalloc.get_traced_memory()[0] - before) / runs
    tracemalloc.stop()
    assert len(study) == runs
    assert study.metrics["3"].base is not None  # a view: the columns are there once
    assert each < 8 * metrics + 40
    assert whole < 8 * metrics + 300  # hashes as texts are most of it: a million runs are below 1 GB


def test_scenes_of_a_study_are_held_one_at_a_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """A vehicle of its own is megabytes: a chunk of runs does not hold them together."""
    made: list[weakref.ref[Vehicle]] = []
    most = 0
    usual = executors.varied_scene

    def watched(*arguments: Any) -> Any:
        nonlocal most
        scene = usual(*arguments)
        made.append(weakref.ref(scene.vehicle))
        most = max(most, sum(ref() is not None for ref in made))
        return scene

    monkeypatch.setattr(executors, "varied_scene", watched)
    base = Simulation(Vehicle.preset("pickup", mesh_density=0.05), Barrier.rigid_wall(), 15.0)
    with ThreadPoolExecutor(1) as pool:
        study = monte_carlo(base, {"vehicle.gvw": stats.uniform(2300.0, 300.0)}, 12, executor=pool)
    assert not study.failed
    assert len(made) == 12
    assert most <= 3


def test_any_number_of_scenes_is_taken() -> None:
    block = scenes.w2(4)
    study = ensemble((block for _ in range(1500)), metrics=["steps"])  # more than there is room for at first
    assert len(study) == 1500
    assert len(set(study.state_hash)) == 1
