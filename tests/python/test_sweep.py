"""Sweeps: the same rows on every executor, failing rows, stores that survive a kill, tables and files."""

from __future__ import annotations

import copy
import itertools
import math
import os
import pickle
import signal
import sqlite3
import subprocess
import sys
import threading
import time
import warnings
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import contextmanager
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import birm3d
import numpy as np
import pytest
from birm3d import Barrier, Simulation, Study, Vehicle, scenes, sweep, units
from birm3d.base.fingerprint import fingerprint
from birm3d.study.runner import run_study

SEDAN = scenes.nhtsa_10146(mesh_density=0.1)
GRID: dict[str, Any] = {"impact_speed": [8, 12.0], "impact_angle": [30.0, 90.0, 190.0]}
MORE = {"zone.bumper.scale": [0.9, 1.1]}


def grid(**options: Any) -> Study:
    return birm3d.sweep(SEDAN, parameters=MORE, **GRID, **options)


@pytest.fixture(scope="module")
def study() -> Study:
    return grid()


def assert_same(a: Study, b: Study) -> None:
    """Every value the same, bit for bit."""
    assert list(a.columns()) == list(b.columns())
    for name, values in a.columns().items():
        if values.dtype == object:
            assert values.tolist() == b.columns()[name].tolist(), name
        else:
            assert values.tobytes() == b.columns()[name].tobytes(), name


# ---- executors --------------------------------------------------------------------------------------------


class Serial(Executor):
    """Runs what it is given at once, in this thread."""

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        future: Future[Any] = Future()
        future.set_result(fn(*args, **kwargs))
        return future


@contextmanager
def dask_client() -> Iterator[Any]:
    with warnings.catch_warnings():
        # distributed closes its sockets when it is collected, and uses what newer Pythons deprecate.
        warnings.simplefilter("ignore", ResourceWarning)
        warnings.simplefilter("ignore", DeprecationWarning)
        from distributed import Client, LocalCluster

        with (
            LocalCluster(
                n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0"
            ) as cluster,
            Client(cluster) as client,
        ):
            yield client


EXECUTORS: dict[str, Callable[[], Any]] = {
    "serial": Serial,
    "one thread": lambda: ThreadPoolExecutor(1),
    "four threads": lambda: ThreadPoolExecutor(4),
    "two processes": lambda: ProcessPoolExecutor(2, mp_context=get_context("spawn")),
    "dask": dask_client,
}


@pytest.mark.parametrize("kind", EXECUTORS)
def test_executors_give_the_same_bits(kind: str, study: Study) -> None:
    with EXECUTORS[kind]() as executor:
        assert_same(grid(executor=executor), study)
        if kind == "dask":  # a client; its executor is welcome too, and the same study at once again
            for _ in range(4):
                assert_same(grid(executor=executor.get_executor()), study)


def test_rows_are_runs_of_their_own(study: Study) -> None:
    """The table says what a run by hand says."""
    row = 2 * 3 * 1 + 2 * 1 + 0
    assert (study["impact_speed"][row], study["impact_angle"][row]) == (12.0, 90.0)
    car = SEDAN.scene.vehicle
    car = car.with_zones({"bumper": car.zones["bumper"].scaled(0.9)})
    result = birm3d.Simulation(car, SEDAN.scene.barrier, 12.0).run()
    for name, values in study.metrics.items():
        assert values[row] == result.metrics.get(name, values[row]), name
    assert study.state_hash[row] == f"{result.state_hash:016x}"
    assert study.end_reason[row] == result.end_reason
    assert set(study.metrics) == set(result.metrics) - {"run_time"} | {"exit_angle"}


def test_a_run_that_fails_is_a_row_with_its_reason(study: Study) -> None:
    bad = np.flatnonzero(study["impact_angle"] == 190.0)
    assert list(study.failed) == bad.tolist()
    for row in bad:
        assert study.error[row] == "ValueError: impact_angle must be within 0 and 180 deg, got 190"
        assert all(math.isnan(values[row]) for values in study.metrics.values())
        assert study.state_hash[row] == study.end_reason[row] == ""
    good = np.flatnonzero(study["impact_angle"] != 190.0)
    assert np.isfinite(study["dynamic_crush"][good]).all()
    assert "4 failed" in repr(study)


def test_unstable_runs_and_missing_metrics_are_rows() -> None:
    study = birm3d.sweep(
        SEDAN,
        parameters={"settings.time_step": [None, 0.2], "settings.output_interval": [1e-4, 10.0]},
        impact_speed=[5.0],
        duration=[0.05],
    )
    assert study.error[0] == ""
    assert study.error[1].startswith("ValueError: output_interval must be shorter than the run")
    assert study.error[2].startswith("UnstableError: time_step must be")
    assert math.isnan(study["exit_angle"][0])  # it has not left within 0.05 s


def test_only_the_metrics_asked_for() -> None:
    study = birm3d.sweep(SEDAN, impact_speed=[8.0], metrics=["dynamic_crush", "peak_normal_force_cfc60"])
    assert list(study.metrics) == ["dynamic_crush", "peak_normal_force_cfc60"]
    assert study.units["peak_normal_force_cfc60"] == "N"


def test_vehicles_can_be_swept() -> None:
    study = birm3d.sweep(
        SEDAN,
        parameters={"vehicle.mesh_density": [0.1]},
        vehicle=["passenger_car", "pickup"],
        metrics=["impact_severity"],
    )
    expected = [
        0.5 * birm3d.Vehicle.preset(name).mass * SEDAN.scene.impact_speed**2 for name in study["vehicle"]
    ]
    assert study["vehicle"].tolist() == ["passenger_car", "pickup"]
    assert study["impact_severity"] == pytest.approx(expected, rel=1e-12)


def test_lists_side_by_side() -> None:
    study = birm3d.sweep(SEDAN, mode="list", impact_speed=[8.0, 9.0], impact_angle=[90.0, 60.0])
    assert study["impact_speed"].tolist() == [8.0, 9.0]
    assert study["impact_angle"].tolist() == [90.0, 60.0]
    assert study.grid is None


# ---- tables and files -------------------------------------------------------------------------------------


def test_dataframe(study: Study) -> None:
    table = study.to_dataframe()
    assert table.index.name == "run"
    assert table.attrs["units"]["impact_speed"] == "m/s"
    crush = table[table.error == ""].groupby("impact_speed").dynamic_crush.mean()
    assert crush[12.0] > crush[8.0]


def test_xarray(study: Study) -> None:
    data = study.to_xarray()
    assert dict(data.sizes) == {"impact_speed": 2, "impact_angle": 3, "zone.bumper.scale": 2}
    crush = data.dynamic_crush.sel({"impact_speed": 12.0, "impact_angle": 90.0, "zone.bumper.scale": 0.9})
    assert float(crush) == study["dynamic_crush"][8]
    assert data.dynamic_crush.attrs["units"] == data["impact_speed"].attrs["units"].split("/")[0] == "m"
    assert "grid" not in data.attrs
    listed = birm3d.sweep(SEDAN, mode="list", impact_speed=[8.0, 9.0]).to_xarray()
    assert dict(listed.sizes) == {"run": 2}


def test_file_keeps_every_bit(study: Study, tmp_path: Path) -> None:
    path = tmp_path / "study.csv"
    study.save(path)
    loaded = Study.load(path)
    assert_same(loaded, study)
    assert loaded.units == study.units
    assert loaded.grid == study.grid
    assert loaded.to_xarray().equals(study.to_xarray())
    import pandas as pd

    table = pd.read_csv(path, comment="#")  # open: any reader of CSV files
    assert table.dynamic_crush[0] == study["dynamic_crush"][0]
    path.write_text("a,b\n1,2\n")
    with pytest.raises(ValueError, match="must be a study"):
        Study.load(path)


def test_plot(study: Study) -> None:
    figure = study.plot("impact_speed", "dynamic_crush", by="impact_angle")
    axes = figure.axes[0]
    assert axes.get_xlabel() == "impact speed [m/s]"
    assert axes.get_ylabel() == "dynamic crush (greatest of the skin) [m]"
    assert sum(len(line.get_xdata()) for line in axes.get_lines()) == 8  # the others have failed
    with pytest.raises(ValueError, match=r"y must be one of .*; got 'dynamic_crash'"):
        study.plot("impact_speed", "dynamic_crash")


def test_axes_have_words_and_units_of_practice() -> None:
    base = Simulation(scenes.elastic_block(30), Barrier.rigid_wall(), 5.0)
    kept = ["peak_deceleration_cfc60", "peak_normal_force_cfc60", "peak_overturning_moment"]
    found = sweep(base, {"vehicle.gvw": [7000.0, 7100.0]}, metrics=kept)
    axes = found.plot("vehicle.gvw", kept[0]).axes[0]
    assert axes.get_xlabel() == "vehicle mass [kg]"
    assert axes.get_ylabel() == "peak deceleration along the vehicle, CFC 60\n[g]"
    assert axes.get_lines()[0].get_ydata() == pytest.approx(found[kept[0]] / units.g(1.0))
    axes = found.plot("vehicle.gvw", kept[1], by="outcome").axes[0]
    assert axes.get_ylabel() == "peak barrier force along the normal, CFC 60\n[kN]"
    # The unit is not broken, and the columns themselves stay SI.
    assert (
        found.plot(kept[2], kept[0]).axes[0].get_xlabel().splitlines()[-1].endswith("[kN\N{NO-BREAK SPACE}m]")
    )
    assert found.units[kept[0]] == "m/s^2"
    assert found.to_dataframe()[kept[0]].tolist() == found[kept[0]].tolist()


def test_summary(study: Study) -> None:
    crush = study["dynamic_crush"][np.isfinite(study["dynamic_crush"])]
    summary = study.summary()["dynamic_crush"]
    assert summary.n == 8
    assert summary.mean == pytest.approx(crush.mean(), rel=1e-14)
    assert summary.standard_error == pytest.approx(crush.std(ddof=1) / math.sqrt(8), rel=1e-14)
    assert summary.p05 < summary.median < summary.p95


# ---- stores -----------------------------------------------------------------------------------------------


def test_store_keeps_every_bit_and_runs_nothing_twice(study: Study, tmp_path: Path) -> None:
    path = tmp_path / "runs.db"
    assert_same(grid(store=path), study)
    assert_same(grid(store=path, executor=Refusing()), study)
    rows = (
        sqlite3.connect(path).execute("SELECT run, impact_speed, dynamic_crush, error FROM runs").fetchall()
    )
    assert [row[0] for row in rows] == list(range(12))
    assert rows[0][1:] == (8.0, study["dynamic_crush"][0], "")
    assert rows[4][2] is None
    assert "190" in rows[4][3]


class Refusing(Executor):
    """Has nothing to do when all runs are kept."""

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        raise AssertionError("a finished run was asked for again")


def test_store_grows_with_the_study(tmp_path: Path) -> None:
    path = tmp_path / "runs.db"
    one = partial(birm3d.sweep, SEDAN, metrics=["dynamic_crush"], store=path)
    one(impact_speed=[8.0])
    counting = Counting()
    both = one(impact_speed=[8.0, 9.0], executor=counting)
    assert counting.runs == 1
    assert_same(both, birm3d.sweep(SEDAN, metrics=["dynamic_crush"], impact_speed=[8.0, 9.0]))


class Counting(Serial):
    runs = 0

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        self.runs += len(args[-1])
        return super().submit(fn, *args, **kwargs)


@pytest.mark.parametrize(
    ("other", "words"),
    [
        ({"impact_speed": [8.5]}, "run 0 has other parameter values"),
        ({"impact_angle": [90.0]}, "another study"),
        ({"impact_speed": [8.0], "metrics": ["delta_v"]}, "another study"),
        ({"impact_speed": [8.0], "simulation": scenes.nhtsa_10146(mesh_density=0.2)}, "another study"),
    ],
)
def test_store_of_another_study_is_refused(tmp_path: Path, other: dict[str, Any], words: str) -> None:
    path = tmp_path / "runs.db"
    shared = {"simulation": SEDAN, "metrics": ["dynamic_crush"], "store": path}
    birm3d.sweep(**shared, impact_speed=[8.0])
    before = path.read_bytes()
    with pytest.raises(ValueError, match=words):
        birm3d.sweep(**{**shared, **other})
    assert path.read_bytes() == before


def test_store_that_is_none(tmp_path: Path) -> None:
    text = tmp_path / "notes.txt"
    text.write_text("not a database, but long enough to look like one " * 40)
    with pytest.raises(ValueError, match=r"notes\.txt: store must be a file of runs"):
        birm3d.sweep(SEDAN, impact_speed=[8.0], store=text)
    assert text.read_text().startswith("not a database")
    database = tmp_path / "contacts.db"
    sqlite3.connect(database).execute("CREATE TABLE contacts (name)").connection.close()
    before = database.read_bytes()
    with pytest.raises(ValueError, match=r"got a database of {'contacts'}"):
        birm3d.sweep(SEDAN, impact_speed=[8.0], store=database)
    assert database.read_bytes() == before
    with pytest.raises(ValueError, match="store must be in a folder that exists"):
        birm3d.sweep(SEDAN, impact_speed=[8.0], store=tmp_path / "missing" / "runs.db")


def test_store_that_another_process_writes(tmp_path: Path) -> None:
    path = tmp_path / "runs.db"
    other = sqlite3.connect(path)
    other.execute("BEGIN EXCLUSIVE")
    with pytest.raises(ValueError, match=r"store .*runs\.db' can not be opened or is in use"):
        birm3d.sweep(SEDAN, impact_speed=[8.0], store=path)
    other.close()
    assert len(birm3d.sweep(SEDAN, impact_speed=[8.0], store=path)) == 1


def test_fingerprints_are_those_of_content() -> None:
    again = scenes.nhtsa_10146(mesh_density=0.1)
    assert fingerprint(again.scene) == fingerprint(SEDAN.scene)
    other = birm3d.scene_parameters.varied(SEDAN, {"zone.bumper.scale": 1.0 + 1e-15})
    assert fingerprint(other.scene) != fingerprint(SEDAN.scene)
    assert fingerprint(("a", "b")) != fingerprint(("ab",)) != fingerprint("ab")
    with pytest.raises(TypeError, match="object"):
        fingerprint(object())


ENDLESS = """
import sys, birm3d
from birm3d import scenes
speeds = [8.0 + 0.01 * i for i in range(400)]
birm3d.sweep(scenes.nhtsa_10146(mesh_density=0.1), impact_speed=speeds, store=sys.argv[1], progress=False)
"""


@pytest.mark.parametrize("signal_number", [signal.SIGKILL, signal.SIGINT], ids=["kill -9", "Ctrl-C"])
def test_a_study_that_was_stopped_goes_on(
    tmp_path: Path, finished_runs: Callable[[Path], int], signal_number: signal.Signals
) -> None:
    path = tmp_path / "runs.db"
    process = subprocess.Popen(
        [sys.executable, "-c", ENDLESS, path], stderr=subprocess.PIPE, stdin=subprocess.DEVNULL, text=True
    )
    with process:
        while finished_runs(path) < 10:
            assert process.poll() is None, process.stderr and process.stderr.read()
            time.sleep(0.02)
        stopped = time.monotonic()
        process.send_signal(signal_number)
        assert process.stderr is not None
        message = process.stderr.read()
        process.wait()
    if signal_number == signal.SIGINT:
        assert time.monotonic() - stopped < 5.0
        assert "StudyInterrupted: stopped: " in message
    kept = sqlite3.connect(path).execute("SELECT run, state_hash FROM runs").fetchall()
    assert 10 <= len(kept) < 400
    assert len({run for run, _ in kept}) == len(kept)

    speeds = [8.0 + 0.01 * i for i in range(400)]
    counting = Counting()
    study = birm3d.sweep(SEDAN, impact_speed=speeds, store=path, executor=counting)
    assert counting.runs == 400 - len(kept)
    assert {run: study.state_hash[run] for run, _ in kept} == dict(kept)
    assert study.run.tolist() == list(range(400))
    assert not study.failed
    straight = run_study(SEDAN, ["impact_speed"], [[speed] for speed in speeds])
    assert_same(study, straight)


# ---- executors that die, and Ctrl-C -----------------------------------------------------------------------


def die(*_: Any) -> None:
    os.kill(os.getpid(), signal.SIGKILL)


class Dying(ProcessPoolExecutor):
    """One of its workers is killed after a few chunks."""

    submitted = 0

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        self.submitted += 1
        return super().submit(die if self.submitted == 8 else fn, *args, **kwargs)


@pytest.mark.parametrize("stored", [True, False])
def test_an_executor_that_dies_loses_nothing_that_was_finished(tmp_path: Path, stored: bool) -> None:
    path = tmp_path / "runs.db" if stored else None
    speeds = [8.0 + 0.05 * i for i in range(200)]
    with (
        Dying(2, mp_context=get_context("spawn")) as executor,
        pytest.raises(
            birm3d.StudyStoppedError, match=r"BrokenProcessPool.* of 200 runs are finished"
        ) as stopped,
    ):
        birm3d.sweep(SEDAN, impact_speed=speeds, executor=executor, store=path)
    part = stopped.value.study
    assert 0 < len(part) < 200
    assert f"{len(part)} of 200" in str(stopped.value)
    whole = birm3d.sweep(SEDAN, impact_speed=speeds, store=path)
    assert [whole.state_hash[run] for run in part.run] == list(part.state_hash)
    if path is not None:
        assert sqlite3.connect(path).execute("SELECT count(*) FROM runs").fetchone() == (200,)


def test_an_executor_that_is_shut_down() -> None:
    executor = ThreadPoolExecutor(1)
    executor.shutdown()
    with pytest.raises(
        birm3d.StudyStoppedError, match=r"RuntimeError.*0 of 1 runs are finished and kept in the"
    ):
        birm3d.sweep(SEDAN, impact_speed=[8.0], executor=executor)


def test_ctrl_c_keeps_what_is_finished(tmp_path: Path, interrupt_once_stored: Callable[[Path], None]) -> None:
    path = tmp_path / "runs.db"
    speeds = [8.0 + 0.001 * i for i in range(9000)]
    interrupt_once_stored(path)
    with pytest.raises(KeyboardInterrupt) as stopped:
        birm3d.sweep(SEDAN, impact_speed=speeds, store=path)
    assert isinstance(stopped.value, birm3d.StudyInterrupted)
    part = stopped.value.study
    assert 0 < len(part) < 9000
    with sqlite3.connect(path) as connection:
        assert connection.execute("SELECT count(*) FROM runs").fetchone() == (len(part),)
    assert not part.failed
    assert part.state_hash[0] == birm3d.sweep(SEDAN, impact_speed=speeds[:1]).state_hash[0]


def test_what_a_stopped_study_has_is_kept_and_gone_on_from(tmp_path: Path) -> None:
    """Without a store: ``keep`` writes one, and the same call with it runs the rest."""
    speeds = [8.0 + 0.001 * i for i in range(3000)]
    timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(birm3d.StudyInterrupted) as stopped:
        birm3d.sweep(SEDAN, {"impact_speed": speeds})
    timer.join()
    part = stopped.value.study
    assert 0 < len(part) < 3000
    stopped.value.keep(tmp_path / "runs.db")
    counting = Counting()
    few = birm3d.sweep(
        SEDAN, {"impact_speed": speeds[: len(part)]}, store=tmp_path / "runs.db", executor=counting
    )
    assert counting.runs == len(set(range(len(part))) - set(part.run.tolist()))
    assert set(part.state_hash) <= set(few.state_hash) | {
        part.state_hash[i] for i in np.flatnonzero(part.run >= len(part))
    }
    with pytest.raises(ValueError, match="has just stopped"):
        pickle.loads(pickle.dumps(stopped.value)).keep(tmp_path / "other.db")


def test_a_row_is_reopened(tmp_path: Path) -> None:
    """Its simulation ends in the hash that the row has, whatever was varied; also of a file."""
    van = Vehicle.preset("minivan", mesh_density=0.1)
    study = birm3d.sweep(
        SEDAN,
        {
            "vehicle": [van, SEDAN.scene.vehicle],
            "impact_speed": [9.0, 12.0],
            "settings.contact_model": ["projected", "along_truss"],
            "settings.time_step": [None, 1e-4],
        },
    )
    for row in (0, 5, 10, 15):
        again = study.simulation(row)
        assert again.time == 0.0
        assert again.scene.impact_speed == study["impact_speed"][row]
        assert f"{again.run().state_hash:016x}" == study.state_hash[row]
    assert study.simulation(5).scene.vehicle is van
    assert f"{copy.deepcopy(study).simulation(7).run().state_hash:016x}" == study.state_hash[7]
    numbers = birm3d.sweep(SEDAN, {"impact_speed": [9.0], "settings.time_step": [None, 1e-4]})
    numbers.save(tmp_path / "runs.csv")
    loaded = Study.load(tmp_path / "runs.csv")
    for row in (0, 1):
        assert f"{loaded.simulation(row, SEDAN).run().state_hash:016x}" == numbers.state_hash[row]
    with pytest.raises(ValueError, match="base must be the simulation that was varied"):
        loaded.simulation(0)
    with pytest.raises(ValueError, match=r"base must be a birm3d\.Simulation, got int"):
        loaded.simulation(0, 3)
    with pytest.raises(ValueError, match="row must be a whole number from 0 to 15, got 16"):
        study.simulation(16)
    with pytest.raises(ValueError, match="ensemble"):
        birm3d.ensemble([SEDAN], metrics=["delta_v"]).simulation(0)


def test_parameters_in_a_mapping_are_the_same_as_keywords() -> None:
    by_mapping = birm3d.sweep(
        SEDAN, {"impact_speed": [9.0, 10.0], "impact_angle": [80.0]}, metrics=["delta_v"]
    )
    by_name = birm3d.sweep(SEDAN, impact_speed=[9.0, 10.0], impact_angle=[80.0], metrics=["delta_v"])
    assert by_mapping.state_hash == by_name.state_hash
    assert by_mapping.parameters.keys() == by_name.parameters.keys()


def test_a_grid_that_can_not_be_held_is_refused() -> None:
    many = [1e-3 * i for i in range(10_000)]
    with pytest.raises(
        ValueError, match=r"at most 5,000,000 runs, got 100,000,000 in a grid of 10000 x 10000"
    ):
        birm3d.sweep(SEDAN, {"impact_speed": many, "barrier.friction": many})
    with pytest.raises(ValueError, match="at most 5,000,000 runs, got 5,000,001"):
        birm3d.sweep(SEDAN, {"impact_speed": itertools.count(5, 0)})
    # Counted before any of them is read, which takes 3 us each.
    with pytest.raises(ValueError, match="impact_speed must make at most 5,000,000 runs"):
        birm3d.sweep(SEDAN, {"impact_speed": itertools.repeat("fast")})
    with pytest.raises(ValueError, match="parameters must be a mapping of names to lists of values, got 5"):
        birm3d.sweep(SEDAN, 5)


def test_progress_goes_to_stderr(capsys: pytest.CaptureFixture[str]) -> None:
    birm3d.sweep(SEDAN, impact_speed=[8.0, 9.0], progress=True)
    out, err = capsys.readouterr()
    assert out == ""
    assert "2/2" in err
    birm3d.sweep(SEDAN, impact_speed=[8.0, 9.0])  # no terminal
    assert capsys.readouterr().err == ""


# ---- bad input --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({}, "parameters must name at least one"),
        ({"impact_speed": []}, "impact_speed must have at least one value, got an empty list"),
        ({"impact_speed": 5.0}, "impact_speed must be a list of values, got 5.0"),
        ({"vehicle": "pickup"}, "vehicle must be a list of values, got 'pickup'"),
        ({"impact_sped": [5.0]}, "impact_speed.*got 'impact_sped'"),
        ({"impact_speed": [5.0, math.nan]}, "impact_speed must be a number, got nan in run 1"),
        ({"vehicle": ["pikcup"]}, "pickup"),
        ({"impact_speed": [5.0], "parameters": {"impact_speed": [6.0]}}, "impact_speed must be given once"),
        (
            {"impact_speed": [5.0], "impact_angle": [1.0, 2.0], "mode": "list"},
            "equal lengths.*'impact_angle': 2",
        ),
        ({"impact_speed": [5.0], "mode": "random"}, "mode must be 'grid' or 'list', got 'random'"),
        ({"impact_speed": [5.0], "metrics": ["crush"]}, "metrics must be among .*got 'crush'"),
        ({"impact_speed": [5.0], "metrics": []}, "metrics must name at least one"),
    ],
)
def test_bad_input_names_argument_and_value(arguments: dict[str, Any], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        birm3d.sweep(SEDAN, **arguments)


def test_an_executor_that_is_none() -> None:
    with pytest.raises(TypeError, match=r"executor must be a concurrent.futures.Executor.*got int"):
        birm3d.sweep(SEDAN, impact_speed=[8.0], executor=4)


def test_what_studies_need_is_loaded_by_the_first_one() -> None:
    heavy = "{'scipy', 'pandas', 'xarray', 'SALib', 'distributed', 'rich', 'sqlite3', 'multiprocessing'}"
    code = f"import sys, birm3d; print(*sorted({heavy} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == ""


@pytest.mark.parametrize(("package", "method"), [("pandas", "to_dataframe"), ("xarray", "to_xarray")])
def test_missing_extras_are_named(
    monkeypatch: pytest.MonkeyPatch, study: Study, package: str, method: str
) -> None:
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(ImportError, match=r"pip install 'birm3d\["):
        getattr(study, method)()
