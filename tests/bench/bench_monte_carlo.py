"""Sobol indices of eight uncertain inputs: time, same bits on every executor, killed and resumed.

A pickup of 6,495 nodes at 30 mph into a rigid wall, about head-on; 1,024 base samples make 10,240 runs.

    python tests/bench/bench_monte_carlo.py            # some minutes
    python tests/bench/bench_monte_carlo.py --quick    # a coarse pickup, 640 runs
"""

from __future__ import annotations

import argparse
import csv
import hashlib
import os
import platform
import re
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import birm3d
import numpy as np
from bench_birm3d import cpu_model
from birm3d import Barrier, Simulation, Study, Vehicle, units
from birm3d.study.sobol import SobolIndices
from scipy import stats

# Spreads as an analyst may put them; they are no statistics of a fleet.
INPUTS: dict[str, Any] = {
    "impact_speed": stats.norm(units.mph(30), units.mph(1)),
    "impact_angle": stats.truncnorm(-3.0, 3.0, 90.0, 3.0),
    "vehicle.gvw": stats.uniform(2700.0, 700.0),
    "vehicle.mass_center_height": stats.norm(0.756, 0.02),
    "barrier.friction": stats.uniform(0.1, 0.2),
    "settings.mu_tire": stats.uniform(0.5, 0.4),
    "zone.bumper.scale": stats.lognorm(0.1),
    "zone.engine_bay.scale": stats.lognorm(0.1),
}
SHOWN = ("dynamic_crush", "peak_normal_force_cfc60", "exit_speed", "max_pitch", "max_yaw")
SEED = 1


@dataclass(frozen=True)
class Row:
    """A way to run the study, how long it took, and whether its numbers are those of one thread."""

    setting: str
    time: float  # s
    error: float  # greatest difference of any metric of any run from that of one thread
    digest: str  # of all bits of all columns


def scene(quick: bool) -> Simulation:
    vehicle = Vehicle.preset("pickup", mesh_density=0.1 if quick else 1.0)
    return Simulation(vehicle, Barrier.rigid_wall(), units.mph(30))


def study(quick: bool, **options: Any) -> SobolIndices:
    return birm3d.sobol(scene(quick), INPUTS, n=64 if quick else 1024, seed=SEED, **options)


def digest(runs: Study) -> str:
    """Hash of every bit of every column."""
    hashed = hashlib.blake2b(digest_size=8)
    for name, values in runs.columns().items():
        hashed.update(name.encode())
        hashed.update("\n".join(values).encode() if values.dtype == object else values.tobytes())
    return hashed.hexdigest()


def difference(runs: Study, reference: Study) -> float:
    """Greatest difference of any metric, relative to its greatest magnitude."""
    worst = 0.0
    for name, values in reference.metrics.items():
        if not np.array_equal(np.isnan(values), np.isnan(runs[name])):
            return float("inf")
        size = np.nanmax(np.abs(values), initial=0.0) or 1.0
        worst = max(worst, float(np.nanmax(np.abs(runs[name] - values), initial=0.0)) / size)
    return worst


@contextmanager
def dask_client() -> Iterator[Any]:
    from distributed import Client, LocalCluster

    with (
        LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0") as cluster,
        Client(cluster) as client,
    ):
        yield client


EXECUTORS: dict[str, Callable[[], Any]] = {
    "1 thread": partial(ThreadPoolExecutor, 1),
    "2 threads": partial(ThreadPoolExecutor, 2),
    "2 processes": lambda: ProcessPoolExecutor(2, mp_context=get_context("spawn")),
    "dask, 2 worker processes": dask_client,
}


def finished(store: Path) -> int:
    """Runs in a store that another process is writing: those of a copy, as a crash would leave it."""
    with tempfile.TemporaryDirectory() as folder:
        for path in (store, store.with_name(store.name + "-journal")):
            if path.exists():
                Path(folder, path.name).write_bytes(path.read_bytes())
        try:
            with sqlite3.connect(Path(folder, store.name)) as connection:
                return int(connection.execute("SELECT count(*) FROM runs").fetchone()[0])
        except sqlite3.DatabaseError:
            return 0  # copied in the midst of a change


def killed_and_resumed(quick: bool, total: int) -> tuple[SobolIndices, float]:
    """Kill a study with SIGKILL when half of it is done, and let it go on; return it and its time."""
    with tempfile.TemporaryDirectory() as folder:
        store = Path(folder) / "runs.db"
        start = time.perf_counter()
        child = subprocess.Popen(
            [sys.executable, __file__, "--child", store, *(["--quick"] if quick else [])]
        )
        while finished(store) < total // 2:
            if child.poll() is not None:
                raise RuntimeError("the study ended before it could be killed")
            time.sleep(0.01 if quick else 0.5)
        child.send_signal(signal.SIGKILL)
        child.wait()
        with sqlite3.connect(store) as connection:
            kept = dict(connection.execute("SELECT run, state_hash FROM runs"))
        print(f"killed with {len(kept)} of {total} runs in the store")
        resumed = study(quick, executor=ThreadPoolExecutor(2), store=store)
        wall = time.perf_counter() - start
        with sqlite3.connect(store) as connection:
            rows = connection.execute("SELECT run, state_hash FROM runs ORDER BY run").fetchall()
    if [run for run, _ in rows] != list(range(total)):
        raise AssertionError("a run was lost or doubled")
    if any(dict(rows)[run] != found for run, found in kept.items()):
        raise AssertionError("a finished run was run again and came out otherwise")
    print(f"resumed: {total} runs in the store, none lost, none doubled")
    return resumed, wall


def run(quick: bool) -> tuple[list[Row], SobolIndices]:
    rows: list[Row] = []
    reference: SobolIndices | None = None

    def note(setting: str, wall: float, found: SobolIndices) -> None:
        nonlocal reference
        reference = reference or found
        row = Row(setting, wall, difference(found.study, reference.study), digest(found.study))
        rows.append(row)
        per_run = row.time / len(found.study) * 1e3
        print(f"{setting:30s}{row.time:9.1f} s{per_run:9.2f} ms a run   error {row.error:.0e}   {row.digest}")

    study(True)  # loads what is loaded once
    for setting, make in EXECUTORS.items():
        with make() as executor:
            start = time.perf_counter()
            found = study(quick, executor=executor)
            note(setting, time.perf_counter() - start, found)
    assert reference is not None
    resumed, wall = killed_and_resumed(quick, len(reference.study))
    note("2 threads, killed and resumed", wall, resumed)
    if len({row.digest for row in rows}) != 1:
        raise AssertionError("the numbers depend on the executor")
    print("same bits in all of them")
    return rows, reference


def print_indices(found: SobolIndices) -> None:
    print(f"\ntotal indices (95 % half width) of {len(found.study)} runs, first order below")
    print(" " * 28 + "".join(f"{name:>25s}" for name in SHOWN if name in found.metrics))
    for i, parameter in enumerate(found.parameters):
        for kind, label in (("total", parameter), ("first", "")):
            cells = (
                f"{getattr(index, kind)[i]:.3f} ({getattr(index, kind + '_confidence')[i]:.3f})"
                for index in (found.metrics[name] for name in SHOWN if name in found.metrics)
            )
            print(f"{label:28s}" + "".join(f"{cell:>25s}" for cell in cells))
    for name, reason in found.omitted.items():
        print(f"{name}: no indices, {reason}")


def save(rows: Sequence[Row], runs: int) -> Path:
    """Write results/monte_carlo_<cpu>.csv beside this program."""
    name = re.sub(r"[^a-z0-9]+", "_", cpu_model().lower()).strip("_")
    path = Path(__file__).parent / "results" / f"monte_carlo_{name}.csv"
    with path.open("w", encoding="utf-8", newline="") as file:
        file.write(
            f"# cpu: {cpu_model()}\n# cores: {os.cpu_count()}\n# python: {platform.python_version()}\n"
        )
        file.write(f"# birm3d: {birm3d.__version__}\n")
        # Above the number of cores: other work had its share, and the times are upper bounds.
        file.write(f"# load average: {os.getloadavg()[1]:.1f}\n")
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("case", "setting", "runs", "error", "time_ms", "time_ms_a_run", "digest"))
        for row in rows:
            ms = row.time * 1e3
            found = (f"{row.error:.1e}", f"{ms:.0f}", f"{ms / runs:.2f}", row.digest)
            writer.writerow(("pickup, 8 inputs", row.setting, runs, *found))
    return path


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--quick", action="store_true", help="a coarse pickup, few runs")
    parser.add_argument("--save", action="store_true", help="write results/monte_carlo_<cpu>.csv")
    parser.add_argument("--child", type=Path, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.child:
        study(options.quick, executor=ThreadPoolExecutor(2), store=options.child)
        return
    rows, found = run(options.quick)
    print_indices(found)
    if options.save:
        print(f"\nwritten: {save(rows, len(found.study)).name}")


if __name__ == "__main__":
    main()
