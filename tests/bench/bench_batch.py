"""Runs a second of many small crashes, with the error beside them; same bits; memory that does not grow.

    python tests/bench/bench_batch.py [--quick] [--runs 4000] [--repeats 5] [--save]

W2 (see birm3d.scenes) at speeds that all differ, at several tolerances: one scene with a list of speeds
(birm3d.sweep) and scenes made one by one (birm3d.ensemble), on one thread and on two, in turns; medians. The
error is the greatest relative one of crush, peak force and rebound of any run against the exact answer.
"CPU" is what a run takes of a core's time, which other programs on the machine disturb less than the rates.
Then the bits of one thread, of two, of backwards and of Simulation.run(); and the memory beside the number of
runs.
"""

from __future__ import annotations

import argparse
import csv
import os
import statistics
import subprocess
import sys
import time
import warnings
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

os.environ["OPENBLAS_NUM_THREADS"] = "1"

import birm3d
import numpy as np
from bench_birm3d import COMPARED, LAW, MASS, cpu_model, exact_crush, write_rows
from birm3d import Settings, Simulation, Study, scenes
from birm3d.study.runner import checked_metrics
from birm3d.study.verification.errors import relative_errors

RESULTS = Path(__file__).parent / "results/batch"
MARK = 10_000.0  # W2 runs a second on two cores, N = 1,000
NODES = 1000
TOLERANCES = (1e-3, 0.01, 0.4)  # the last two: the cheapest whose errors are below 0.1 % and 1 %
WITHIN = 0.01
SPEEDS = (18.0, 26.0)  # m/s; below 17.8 the block turns before the knee
ALL = checked_metrics(None, ())
ALL_LABEL = f"all {len(ALL)} metrics"
MARK_ALL = 8_000.0  # the same with all metrics


@dataclass(frozen=True)
class Row:
    """A way to run many crashes."""

    way: str
    metrics: str
    tolerance: float
    steps: float  # mean of all runs
    error: float  # greatest of any run
    one_thread: float  # runs a second
    two_threads: float
    cpu: float  # of a core for a run, one thread [s]
    load: float  # of the machine by all that runs on it, when the row was done


def scene(tolerance: float) -> Simulation:
    return scenes.w2(NODES, Settings(gravity=0.0, ground=False, tolerance=tolerance))


def speeds(count: int) -> list[float]:
    return np.linspace(*SPEEDS, count).tolist()


def swept(base: Simulation, count: int, metrics: Sequence[str], threads: int) -> Study:
    with ThreadPoolExecutor(threads) as pool:
        return birm3d.sweep(base, impact_speed=speeds(count), metrics=metrics, executor=pool)


def one_by_one(base: Simulation, count: int, metrics: Sequence[str], threads: int) -> Study:
    given = base.scene

    def made() -> Iterator[Simulation]:
        for speed in speeds(count):
            yield Simulation(given.vehicle, given.barrier, speed, settings=given.settings)

    with ThreadPoolExecutor(threads) as pool:
        return birm3d.ensemble(made(), metrics=metrics, executor=pool)


def greatest_error(study: Study) -> float:
    if study.failed:
        raise AssertionError(f"{len(study.failed)} runs failed: {next(iter(study.failed.values()))}")
    count = len(study)
    worst = 0.0
    for i, speed in enumerate(speeds(count)):
        found = {name: float(study[name][i]) for name in COMPARED}
        worst = max(worst, *relative_errors(found, exact_crush(LAW, MASS, speed), {}).values())
    return worst


Way = Callable[[Simulation, int, Sequence[str], int], Study]


def measured(
    name: str, way: Way, tolerance: float, metrics: Sequence[str], label: str, count: int, repeats: int
) -> Row:
    base = scene(tolerance)
    told = way(base, min(count, 2000), (*COMPARED, "steps"), 2)
    rates: dict[int, list[float]] = {1: [], 2: []}
    cpu = []
    for _ in range(repeats):
        for threads, found in rates.items():
            start, used = time.perf_counter(), time.process_time()
            way(base, count, metrics, threads)
            found.append(count / (time.perf_counter() - start))
            if threads == 1:
                cpu.append((time.process_time() - used) / count)
    steps, error = float(np.mean(told["steps"])), greatest_error(told)
    one, two = (statistics.median(found) for found in rates.values())
    load = os.getloadavg()[0] if hasattr(os, "getloadavg") else float("nan")
    return Row(name, label, tolerance, steps, error, one, two, statistics.median(cpu), load)


def check_bits(count: int) -> int:
    """Compare hashes and metrics with those of Simulation.run(); return how many runs were compared."""
    compared = 0
    for tolerance in TOLERANCES:
        base = scene(tolerance)
        one = swept(base, count, ALL, 1)
        for other in (swept(base, count, ALL, 2), one_by_one(base, count, ALL, 2)):
            if other.state_hash != one.state_hash:
                raise AssertionError("the last states differ")
            for name in ALL:
                if not np.array_equal(other[name], one[name], equal_nan=True):
                    raise AssertionError(f"{name} differs")
        backwards = birm3d.sweep(base, impact_speed=speeds(count)[::-1], metrics=ALL)
        if backwards.state_hash[::-1] != one.state_hash:
            raise AssertionError("the last states depend on the order")
        for i, speed in enumerate(speeds(count)):
            alone = Simulation(base.scene.vehicle, base.scene.barrier, speed, settings=base.scene.settings)
            metrics = alone.run().metrics
            for name in ALL:
                if not np.array_equal(one[name][i], metrics.get(name, np.nan), equal_nan=True):
                    raise AssertionError(f"{name} is not that of Simulation.run()")
        compared += 4 * count
    return compared


MEMORY = """
import re, sys
from pathlib import Path
sys.path.insert(0, sys.argv[1])
from bench_batch import COMPARED, one_by_one, scene, swept
way = {"sweep": swept, "ensemble": one_by_one}[sys.argv[2]]
base = scene(0.1)
def most(count):
    way(base, count, COMPARED, 2)
    return re.search(r"VmHWM:\\s+(\\d+) kB", Path("/proc/self/status").read_text())[1]
print(most(int(sys.argv[3]) // 20), most(int(sys.argv[3])))
"""


def memory(way: str, runs: int) -> tuple[float, float]:
    """Peak resident memory of a process of its own at a twentieth of so many runs and at all of them [MB]."""
    done = subprocess.run(
        [sys.executable, "-c", MEMORY, str(Path(__file__).parent), way, str(runs)],
        check=True,
        capture_output=True,
        text=True,
    )
    before, after = (float(text) / 1024.0 for text in done.stdout.split())
    return before, after


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="few runs, for a look")
    parser.add_argument("--runs", type=int, default=4000, help="of each row (default: %(default)s)")
    parser.add_argument("--repeats", type=int, default=5, help="of each row (default: %(default)s)")
    parser.add_argument("--save", action="store_true", help="also write tests/bench/results/batch")
    options = parser.parse_args()
    warnings.simplefilter("ignore", birm3d.BalanceWarning)  # the error is in the table
    runs, repeats = (1000, 1) if options.quick else (options.runs, options.repeats)
    most = 2000 if options.quick else 100_000

    print(
        f"{cpu_model()}, {os.cpu_count()} cores; W2, N = {NODES:,}; {runs:,} runs a row, median of {repeats}"
    )
    plan: list[tuple[str, Way, float, Sequence[str], str]] = [
        *(("sweep", swept, tolerance, COMPARED, "crush, peak force, rebound") for tolerance in TOLERANCES),
        *(("sweep", swept, tolerance, ALL, ALL_LABEL) for tolerance in TOLERANCES),
        ("ensemble", one_by_one, WITHIN, COMPARED, "crush, peak force, rebound"),
    ]
    rows = []
    print(f"{'way':9s} {'metrics':27s}   tol.  steps    error  1 thread  2 threads  CPU [us]  load")
    for name, way, tolerance, metrics, label in plan:
        row = measured(name, way, tolerance, metrics, label, runs, repeats)
        rows.append(row)
        print(
            f"{row.way:9s} {row.metrics:27s} {row.tolerance:6g} {row.steps:6.1f} {row.error:8.1e} "
            f"{row.one_thread:9,.0f} {row.two_threads:10,.0f} {row.cpu * 1e6:9.0f} {row.load:5.1f}"
        )
    for limit, mark, label in ((1e-3, MARK, ""), (1e-2, MARK, ""), (1e-2, MARK_ALL, ALL_LABEL)):
        within = [row for row in rows if row.error <= limit and (not label or row.metrics == label)]
        best = max(row.two_threads for row in within)
        alone = 2.0 / min(row.cpu for row in within)
        told = "holds   " if best >= mark else "MISSED  "
        print(
            f"{told}at least {mark:,.0f} W2 runs a second on two cores at N = 1,000, error <= {limit:.1%}"
            f"{f', {label}' if label else ''}: "
            f"{best:,.0f}; by the CPU times, had two cores nothing else to do: {alone:,.0f}"
        )
    print(
        f"same bits: {check_bits(50 if options.quick else 500):,} runs compared with Simulation.run(), others"
    )
    grown = []
    for way in ("sweep", "ensemble"):
        before, after = memory(way, most)
        grown.append((way, most, before, after))
        each = (after - before) * 1024.0**2 / (0.95 * most)
        print(f"memory, {way}: {before:.1f} MB, at 20 times the runs {after:.1f} MB: {each:.0f} bytes a run")
    if options.save:
        RESULTS.mkdir(exist_ok=True)
        with (RESULTS / "batch.csv").open("w", encoding="utf-8", newline="") as file:
            file.write(f"# {cpu_model()}; W2, N = {NODES}; {runs} runs a row, median of {repeats}\n")
            write_rows(file, rows)
            file.write("# peak resident memory [MB] at a twentieth of the runs and at all of them\n")
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(["way", "runs", "before", "after"])
            for way, count, before, after in grown:
                writer.writerow([way, count, f"{before:.1f}", f"{after:.1f}"])
    return 0


if __name__ == "__main__":
    sys.exit(main())
