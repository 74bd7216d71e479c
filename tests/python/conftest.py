"""Scenes that several files look at, run once."""

from __future__ import annotations

import os
import signal
import sqlite3
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from functools import cache
from pathlib import Path
from types import MappingProxyType
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest
from birm3d import Barrier, Result, Settings, Simulation, Vehicle, scenes
from hypothesis import settings
from scipy.spatial.transform import Rotation

mpl.use("Agg")

# The same examples in every run: a test-suite that fails now and then is not trusted.
settings.register_profile("birm3d", derandomize=True, deadline=None)
settings.load_profile("birm3d")

# Every scene of birm3d.scenes, and a soft vehicle whose rigid body ends up at the wall.
SCENES: Mapping[str, Callable[[], Simulation]] = MappingProxyType(
    {
        "w1": scenes.w1,
        "w2": scenes.w2,
        **{f"table_2_{mph}_mph": lambda mph=mph: scenes.paper_table_2(mph) for mph in scenes.TABLE_2},
        "nhtsa_10146": scenes.nhtsa_10146,
        "oblique_car": scenes.oblique_car,
        "truck_at_bollards": scenes.truck_at_bollards,
        **{f"oblique_{angle}": lambda angle=angle: scenes.oblique(angle) for angle in (10, 24, 45, 66)},
        **{f"oblique_{a}_friction": lambda a=a: scenes.oblique(a, friction=0.2) for a in (10, 24, 45, 66)},
        "rolling": scenes.rolling,
        "parked": scenes.parked,
        "soft": lambda: soft_scene(),
    }
)


def soft_scene(angle: float = 90.0, settings: Settings | None = None) -> Simulation:
    """The block of W1 at 30 m/s with a front that yields at 100 kN: its trusses of 2 m close."""
    block = scenes.laboratory_block(100, k_initial=5e5, knee=0.2, k_unloading=5e6, stagger=0.05)
    wall = Barrier.rigid_wall(friction=0.0)
    return Simulation(block, wall, 30.0, angle, settings=settings or Settings(gravity=0.0, ground=False))


@cache
def _result(name: str) -> Result:
    return SCENES[name]().run()


@pytest.fixture(params=SCENES)
def scene_result(request: pytest.FixtureRequest) -> Result:
    """The result of every scene in turn, default settings."""
    return _result(request.param)


@pytest.fixture(scope="session")
def result_of() -> Callable[[str], Result]:
    """Result of a scene by its name in ``SCENES``."""
    return _result


@pytest.fixture(scope="session")
def make_soft_scene() -> Callable[..., Simulation]:
    return soft_scene


@pytest.fixture(scope="session")
def body_to_world() -> Callable[[Result], Rotation]:
    """Orientations of all rows, from the angles a user sees (ISO 8855: yaw, pitch, roll in turn)."""

    def orientation(result: Result) -> Rotation:
        scene = result.scene
        barrier_heading = scene.barrier.heading if scene.barrier else 0.0
        yaw = result.yaw + barrier_heading + 90.0 - scene.impact_angle
        return Rotation.from_euler("ZYX", np.column_stack([yaw, result.pitch, result.roll]), degrees=True)

    return orientation


def count_finished_runs(path: Path) -> int:
    """Committed runs of a study that may still be running, read from a copy as a crash would leave it."""
    copy = path.with_name("copy.db")
    for suffix in ("", "-journal"):
        with suppress(FileNotFoundError):  # a journal goes when its change is done
            Path(f"{copy}{suffix}").write_bytes(Path(f"{path}{suffix}").read_bytes())
    try:
        with sqlite3.connect(copy) as connection:
            return int(connection.execute("SELECT count(*) FROM runs").fetchone()[0])
    except sqlite3.DatabaseError:
        return 0  # copied in the midst of a change
    finally:
        for suffix in ("", "-journal"):
            Path(f"{copy}{suffix}").unlink(missing_ok=True)


@pytest.fixture
def finished_runs() -> Callable[[Path], int]:
    return count_finished_runs


@pytest.fixture
def interrupt_once_stored() -> Iterator[Callable[[Path], None]]:
    """Ctrl-C for this process, once a study has stored its first runs."""
    threads = []

    def interrupt(store: Path) -> None:
        while count_finished_runs(store) == 0:
            time.sleep(0.01)
        os.kill(os.getpid(), signal.SIGINT)

    def start(store: Path) -> None:
        threads.append(threading.Thread(target=interrupt, args=(store,), daemon=True))
        threads[0].start()

    yield start
    threads[0].join(timeout=60.0)


@pytest.fixture(scope="session")
def spring_body() -> Callable[..., Vehicle]:
    """A body on one spring through its mass centre (elastic unless told), `length` long."""

    def make(mass: float, k: float, length: float, **law: float) -> Vehicle:
        return Vehicle.from_arrays(
            mass=mass,
            inertia=mass * np.eye(3),
            nodes=[[length, 0.0, 0.0]],
            anchors=[[0.0, 0.0, 0.0]],
            **{"k_initial": k, "k_unloading": k, **law},
        )

    return make


@pytest.fixture
def command(monkeypatch: pytest.MonkeyPatch) -> Callable[..., int]:
    """The command line in this process: ``command("run", ...)`` returns the exit code."""
    from birm3d.cli import main

    def run(*arguments: object) -> int:
        monkeypatch.setattr("sys.argv", ["birm3d", *map(str, arguments)])
        try:
            main()
        except SystemExit as stop:
            return int(stop.code or 0)
        return 0

    return run


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """With ``-n`` alone each process takes files in a row, so that most fixtures of a file are made once."""
    from xdist.scheduler import WorkStealingScheduling

    return WorkStealingScheduling(config, log) if config.getoption("dist") == "load" else None


STRIKE_THE_CORE = frozenset(
    f"test_{name}.py"
    for name in (
        *("api", "articulated", "bad_input", "balance_check", "balances", "bands"),
        *("coarse_skin", "corners", "crush_physics", "design_load", "dissipation", "element_loads"),
        *("ensemble", "extremes", "file_readers", "free_standing", "omitted", "overlap"),
        *("plotting", "random_impacts", "readable_figures", "rigid_contact", "state_hashes", "tire_barrier"),
        *("unit_check",),
    )
)
"""Files with scenes that are meant to strike the rigid core. Elsewhere a CoreContactWarning fails a test."""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark the functions of ``slow_tests.txt``, those that use a fixture of it, and what strikes the core."""
    names = set((Path(__file__).parent / "slow_tests.txt").read_text(encoding="utf-8").split())
    for item in items:
        function = item.nodeid.partition("[")[0].rpartition("/")[2]
        fixtures = {f"{item.path.name}::{name}" for name in getattr(item, "fixturenames", ())}
        if function in names or not fixtures.isdisjoint(names):
            item.add_marker(pytest.mark.slow)
        if item.path.name in STRIKE_THE_CORE:
            item.add_marker(pytest.mark.filterwarnings("ignore::birm3d.CoreContactWarning"))
