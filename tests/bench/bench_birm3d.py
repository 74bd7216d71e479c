"""Error and time of BIRM3D together, never one without the other.

    python tests/bench/bench_birm3d.py [--json out.json] [--repeats 7] [--quick] [--save]

W2 (see birm3d.scenes) against the exact answer, beside the same law in NumPy (numpy_reference.py) at the same
error; then the sedan of NHTSA test 10146 against its own fine-step answer. One core; BIRM3D and NumPy take
turns (A B A B ...); medians.
"""

from __future__ import annotations

import argparse
import csv
import dataclasses
import json
import math
import os
import platform
import re
import statistics
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TextIO

# Before NumPy is loaded: one core, also for what NumPy would hand to threads of its own.
os.environ["OPENBLAS_NUM_THREADS"] = "1"
os.environ["OMP_NUM_THREADS"] = "1"

import birm3d
import numpy as np
from birm3d import Result, Settings, Simulation, scenes
from birm3d.study.verification.errors import relative_errors
from numpy_reference import Answer, Block, Run

SPEED = 22.352  # m/s
MASS = 6804.0  # kg
LAW = {"k_initial": 3e6, "knee": 0.4, "k_hardening": 6e6, "k_unloading": 60e6}  # all trusses, N/m and m
DEFAULT = "tolerance 1e-3 (default)"
STRICT = "tolerance 1e-4"
OURS = "BIRM3D"
COMPARED = ("dynamic_crush", "peak_normal_force", "exit_speed")

# The first marks.
SEDAN_TIME = 20e-3  # s
SEDAN_ERROR = 0.01
FASTER_THAN_NUMPY = 50.0

# Below these two values of a metric are the same: rounding of what is zero by symmetry (deg, m).
FLOORS = {"max_roll": 1e-6, "max_pitch": 1e-6, "max_yaw": 1e-6, "contact_overlap": 1e-9}
# Not part of the answer: how it was found, and two residuals that are errors themselves.
BOOKKEEPING = {"steps", "run_time", "end_time", "energy_residual", "momentum_residual"}


@dataclass(frozen=True)
class Row:
    """One line of the table; times are medians [s], `times_slower` is the time over that of ours."""

    case: str
    solver: str
    setting: str
    steps: int
    error: float
    worst: str
    time: float
    times_slower: float
    real_time: float
    state_hash: str


def exact_crush(law: Mapping[str, float], mass: float = MASS, speed: float = SPEED) -> dict[str, float]:
    """Two straight segments, then unloading: closed form from the energy."""
    knee_force = law["k_initial"] * law["knee"]
    rest = 0.5 * mass * speed**2 - 0.5 * knee_force * law["knee"]
    beyond = (math.sqrt(knee_force**2 + 2.0 * law["k_hardening"] * rest) - knee_force) / law["k_hardening"]
    peak = knee_force + law["k_hardening"] * beyond
    return {
        "dynamic_crush": law["knee"] + beyond,
        "peak_normal_force": peak,
        "exit_speed": peak / math.sqrt(law["k_unloading"] * mass),
    }


def exact_w2() -> dict[str, float]:
    return exact_crush(LAW)


def worst_error(values: Mapping[str, float], reference: Mapping[str, float]) -> tuple[float, str]:
    """Greatest relative error and the metric that has it."""
    errors = relative_errors(values, reference, FLOORS)
    for name, floor in FLOORS.items():
        if name in errors and abs(values.get(name, math.inf) - reference[name]) <= floor:
            errors[name] = 0.0
    worst = max(errors, key=errors.__getitem__)
    return errors[worst], worst


def numpy_answer(answer: Answer) -> dict[str, float]:
    return {name: getattr(answer, name) for name in COMPARED}


def numpy_block(simulation: Simulation) -> Block:
    vehicle = simulation.scene.vehicle
    n = vehicle.n_nodes
    each = {name: value if name == "knee" else value / n for name, value in LAW.items()}
    x, y, z = np.diag(vehicle.inertia).tolist()
    return Block(mass=vehicle.mass, inertia=(x, y, z), nodes=vehicle.nodes, anchors=vehicle.anchors, **each)


def numpy_step(error: float, exact: Mapping[str, float]) -> float:
    """Choose NumPy's step for an error that is no better than `error` but near it.

    Its error falls with the square of the step, but up and down, as peak and release fall on a step or beside
    one. The longest step is taken whose error lies between 1 and 1.5 times `error`, or else the one with the
    least error above. Few nodes do: the answer does not depend on their number.
    """
    block = numpy_block(scenes.w2(10))
    steps = [8e-3 * 2.0 ** (-i / 12.0) for i in range(85)]
    errors = [worst_error(numpy_answer(Run(block, SPEED, step).run()), exact)[0] for step in steps]
    near = [step for step, found in zip(steps, errors, strict=True) if error <= found <= 1.5 * error]
    return near[0] if near else min((e, s) for s, e in zip(steps, errors, strict=True) if e >= error)[1]


def take_turns(runs: Sequence[Callable[[], Result | Answer]], repeats: int) -> list[float]:
    """Median time of stepping of each of `runs` [s]; A B A B ... after one warm-up each."""
    for run in runs:
        run()
    times: list[list[float]] = [[] for _ in runs]
    for _ in range(repeats):
        for run, taken in zip(runs, times, strict=True):
            taken.append(run().run_time)
    return [statistics.median(taken) for taken in times]


def bench_w2(n: int, repeats: int) -> list[Row]:
    exact = exact_w2()
    rows = []
    for label, changes in {
        DEFAULT: {},
        STRICT: {"tolerance": 1e-4},
        "fixed 1 ms": {"time_step": 1e-3},
        "fixed 0.1 ms": {"time_step": 1e-4},
    }.items():
        ours = scenes.w2(n, Settings(gravity=0.0, ground=False, **changes))
        result = ours.run()
        error, worst = worst_error({name: result.metrics[name] for name in COMPARED}, exact)
        step = changes.get("time_step") or numpy_step(error, exact)
        rivals = {
            "NumPy": Run(numpy_block(ours), SPEED, step),
            "NumPy, lean": Run(numpy_block(ours), SPEED, step, lean=True),
        }
        our_time, *rival_times = take_turns([ours.run, *(rival.run for rival in rivals.values())], repeats)
        lines = [
            Row(
                case=f"W2, N = {n:,}",
                solver=OURS,
                setting=label,
                steps=result.statistics.steps,
                error=error,
                worst=worst,
                time=our_time,
                times_slower=1.0,
                real_time=float(result.time[-1]) / our_time,
                state_hash=f"{result.state_hash:016x}",
            )
        ]
        for (name, rival), rival_time in zip(rivals.items(), rival_times, strict=True):
            answer = rival.run()
            rival_error, rival_worst = worst_error(numpy_answer(answer), exact)
            lines.append(
                dataclasses.replace(
                    lines[0],
                    solver=name,
                    setting=f"fixed {step * 1e3:.4g} ms",
                    steps=answer.steps,
                    error=rival_error,
                    worst=rival_worst,
                    time=rival_time,
                    times_slower=rival_time / our_time,
                    real_time=answer.steps * step / rival_time,
                    state_hash="",
                )
            )
        rows += lines
    return rows


def bench_sedan(repeats: int, mesh_density: float) -> list[Row]:
    fine = scenes.nhtsa_10146(Settings(tolerance=1e-6), mesh_density).run()
    reference = {name: value for name, value in fine.metrics.items() if name not in BOOKKEEPING}
    simulations = {
        DEFAULT: scenes.nhtsa_10146(None, mesh_density),
        STRICT: scenes.nhtsa_10146(Settings(tolerance=1e-4), mesh_density),
    }
    times = take_turns([simulation.run for simulation in simulations.values()], repeats)
    rows = []
    for (label, simulation), run_time in zip(simulations.items(), times, strict=True):
        result = simulation.run()
        error, worst = worst_error(result.metrics, reference)
        vehicle = simulation.scene.vehicle
        rows.append(
            Row(
                case=f"NHTSA 10146, {vehicle.n_elements:,} elements",
                solver=OURS,
                setting=label,
                steps=result.statistics.steps,
                error=error,
                worst=worst,
                time=run_time,
                times_slower=1.0,
                real_time=float(result.time[-1]) / run_time,
                state_hash=f"{result.state_hash:016x}",
            )
        )
    return rows


def cpu_model() -> str:
    try:
        text = Path("/proc/cpuinfo").read_text(encoding="utf-8")
    except OSError:
        return platform.processor() or platform.machine()
    match = re.search(r"^model name\s*:\s*(.+)$", text, re.MULTILINE)
    return match[1].strip() if match else platform.machine()


def machine(core: str) -> dict[str, str]:
    return {
        "cpu": cpu_model(),
        "core": core,
        "system": f"{platform.system()} {platform.machine()}",
        "python": platform.python_version(),
        "numpy": np.__version__,
        "birm3d": birm3d.__version__,
    }


def print_machine() -> dict[str, str]:
    """Pin this process to one core, print the head of a table, and return what it says."""
    facts = machine(use_one_core())
    for key, value in facts.items():
        print(f"{key:8s}{value}")
    return facts


def write_machine(file: TextIO, facts: Mapping[str, str]) -> None:
    """Write the head of a table to a file, as comments."""
    for key, value in facts.items():
        file.write(f"# {key}: {value}\n")


def write_rows(file: TextIO, rows: Sequence[Any]) -> None:
    """Write rows of one dataclass to a file as a table, numbers with four digits."""
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow([field.name for field in dataclasses.fields(rows[0])])
    for row in rows:
        cells = dataclasses.astuple(row)
        writer.writerow([f"{cell:.4g}" if isinstance(cell, float) else cell for cell in cells])


def use_one_core() -> str:
    if not hasattr(os, "sched_setaffinity"):
        return "not pinned (this system can not)"
    # The last one: the first often serves interrupts.
    core = max(os.sched_getaffinity(0))
    os.sched_setaffinity(0, {core})
    return f"1, pinned to number {core}"


def marks(rows: Sequence[Row]) -> list[tuple[str, bool]]:
    """The first marks, and whether each holds in these rows; a mark whose case was not run is left out."""
    checks = []
    for i, row in enumerate(rows):
        if row.solver != OURS:
            continue
        if row.setting == DEFAULT and row.case.startswith("NHTSA"):
            text = f"sedan in less than {SEDAN_TIME * 1e3:g} ms on one core: {row.time * 1e3:.2f} ms"
            checks.append((text, row.time < SEDAN_TIME))
            text = f"sedan, every metric within {SEDAN_ERROR:.0%} of its fine-step answer: "
            checks.append((f"{text}{row.error:.1e} ({row.worst})", row.error <= SEDAN_ERROR))
        elif row.setting == STRICT and row.case.endswith("= 1,000"):
            # The gap hangs on the error: a coarse answer takes NumPy few steps, too.
            rival, lean = rows[i + 1].times_slower, rows[i + 2].times_slower
            default = next(k for k, r in enumerate(rows) if (r.case, r.setting) == (row.case, DEFAULT))
            text = (
                f"W2, N = 1,000, at least {FASTER_THAN_NUMPY:g} times faster than NumPy at an error of "
                f"{row.error:.1e}: {rival:.1f} times (lean: {lean:.1f}); at the default's "
                f"{rows[default].error:.1e}: {rows[default + 1].times_slower:.1f} times "
                f"(lean: {rows[default + 2].times_slower:.1f})"
            )
            checks.append((text, rival >= FASTER_THAN_NUMPY))
    return checks


def table(rows: Sequence[Row]) -> str:
    columns: dict[str, Callable[[Row], str]] = {
        "case": lambda row: row.case,
        "solver": lambda row: row.solver,
        "setting": lambda row: row.setting,
        "steps": lambda row: f"{row.steps}",
        "error": lambda row: f"{row.error:.1e}",
        "of": lambda row: row.worst,
        "time [ms]": lambda row: f"{row.time * 1e3:.3f}",
        "us/step": lambda row: f"{row.time / row.steps * 1e6:.2f}",
        "x ours": lambda row: f"{row.times_slower:.1f}",
        "x real time": lambda row: f"{row.real_time:.0f}",
        "state hash": lambda row: row.state_hash,
    }
    text = {"case", "solver", "setting", "of", "state hash"}
    shown = []
    for name, cell in columns.items():
        cells = [name, *(cell(row) for row in rows)]
        width = max(map(len, cells))
        shown.append([c.ljust(width) if name in text else c.rjust(width) for c in cells])
    lines = ["  ".join(line).rstrip() for line in zip(*shown, strict=True)]
    return "\n".join([lines[0], "-" * len(lines[0]), *lines[1:]])


def save(rows: Sequence[Row], facts: Mapping[str, str]) -> Path:
    """Write results/<cpu>.csv beside this program: small, without names or paths of this machine."""
    name = re.sub(r"[^a-z0-9]+", "_", facts["cpu"].lower()).strip("_")
    path = Path(__file__).parent / "results" / f"{name}.csv"
    path.parent.mkdir(exist_ok=True)
    with path.open("w", encoding="utf-8", newline="") as file:
        write_machine(file, facts)
        writer = csv.writer(file, lineterminator="\n")
        head = "case solver setting steps error of time_ms times_slower state_hash"
        writer.writerow(head.split())
        for row in rows:
            found = (
                row.steps,
                f"{row.error:.1e}",
                row.worst,
                f"{row.time * 1e3:.3g}",
                f"{row.times_slower:.3g}",
            )
            writer.writerow((row.case, row.solver, row.setting, *found, row.state_hash))
    return path


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--json", type=Path, metavar="FILE", help="also write the table and the marks to this file"
    )
    parser.add_argument(
        "--repeats", type=int, default=7, help="timed runs of each line (default: %(default)s)"
    )
    parser.add_argument("--quick", action="store_true", help="small cases only, for a look at the errors")
    parser.add_argument("--save", action="store_true", help="also write tests/bench/results/<cpu>.csv")
    options = parser.parse_args(arguments)
    if options.repeats < 1:
        parser.error(f"--repeats must be >= 1, got {options.repeats}")

    facts = print_machine()
    print(f"median of {options.repeats} runs in turn; stepping only, scenes are built beforehand\n")

    rows: list[Row] = []
    for n in (100,) if options.quick else (100, 1000, 10000):
        rows += bench_w2(n, options.repeats)
    rows += bench_sedan(options.repeats, 0.25 if options.quick else 1.0)
    print(table(rows))
    print("\nerror: greatest relative of any metric: crush, peak force, rebound against the exact answer")
    print("       (W2), all metrics against the answer at tolerance 1e-6 (NHTSA 10146)")
    print("x ours: time over that of the BIRM3D line above; NumPy has a fixed step with no better an error\n")
    checks = marks(rows)
    for text, holds in checks:
        print(f"{'holds   ' if holds else 'MISSED  '}{text}")

    if options.json:
        document = {
            "machine": facts,
            "rows": [dataclasses.asdict(row) for row in rows],
            "marks": [{"mark": text, "holds": holds} for text, holds in checks],
        }
        options.json.write_text(json.dumps(document, indent=1) + "\n", encoding="utf-8")
    if options.save:
        print(f"\nwritten: {save(rows, facts).relative_to(Path(__file__).parent).as_posix()}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
