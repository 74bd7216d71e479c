"""A row for each vehicle-barrier pair: error, steps and time beside those of the flat wall.

    python tests/bench/bench_pairs.py [--repeats 5] [--speed 20] [--vehicles NAME ...] [--save]
    python tests/bench/bench_pairs.py --quick

Vehicle presets x barriers: flat wall, finite wall and Jersey barrier at 25 deg, bollards and flat wall
head-on. Each is held against the flat wall at the same angle, vehicle and speed, over the same stretch of
time: until the vehicle has left the flat wall. With --whole every run goes on until its own outcome is
decided; some then tumble for seconds, where no small error can be had.

Every scene runs at several tolerances. Its error is the greatest of any metric (METRICS) against its own
answer at a tolerance of 1e-6; the time at a common error is interpolated over them. Times are those of
stepping, the least of the repeats; scenes and tolerances take turns. One core.
"""

from __future__ import annotations

import argparse
import csv
import math
import re
import sys
from collections.abc import Mapping, Sequence
from dataclasses import astuple, dataclass, fields
from pathlib import Path

from bench_birm3d import machine, use_one_core
from birm3d import Barrier, Result, Settings, Simulation, Vehicle
from birm3d.base.progress import progress_bar
from birm3d.study.verification.errors import relative_errors

RESULTS = Path(__file__).parent / "results/pairs"
PAIRS = {
    "wall": (Barrier.rigid_wall(), 25.0),
    "finite_wall": (Barrier.rigid_wall(width=6.0, height=1.0), 25.0),
    "jersey_32in": (Barrier.jersey(length=30.0), 25.0),
    "wall_head_on": (Barrier.rigid_wall(), 90.0),
    "bollards": (Barrier.bollards(), 90.0),
}
FLAT = {"finite_wall": "wall", "jersey_32in": "wall", "bollards": "wall_head_on"}
DEFAULT = 1e-3
TOLERANCES = (1.0, 3e-1, 1e-1, 3e-2, 1e-2, 3e-3, DEFAULT, 3e-4, 1e-4, 3e-5)
FINE = 1e-6
# What an engineer reads off a run -> below what their differences are judged by: m, N, m/s, deg. Errors of
# angles below 5 deg and of speeds below a tenth of the impact's are shares of those.
METRICS = {
    "dynamic_crush": 0.0,
    "peak_force_50ms": 0.0,
    "exit_speed": 2.0,
    "delta_v": 2.0,
    "max_roll": 5.0,
    "max_pitch": 5.0,
    "max_yaw": 5.0,
}
COMMON_ERROR = 0.01
# The mark: times of the flat wall at the same error.
MARK = 3.0
MARKED = ("jersey_32in", "bollards")


@dataclass(frozen=True)
class Sample:
    """One scene at one tolerance; time in s."""

    tolerance: float
    error: float
    worst: str
    steps: int
    redone: int
    node_evaluations: int
    time: float


@dataclass(frozen=True)
class Row:
    """One pair: the run at the default tolerance, and the time at the common error; ms.

    `times_flat` is over that of the flat wall at the same angle and error; None: no tolerance has that error.
    """

    vehicle: str
    barrier: str
    angle_deg: float
    simulated_s: float
    steps: int
    redone: int
    node_evaluations: int
    error: float
    of: str
    time_ms: float
    at_error: float
    time_at_error_ms: float | None
    times_flat: float | None


def greatest_error(result: Result, reference: Mapping[str, float]) -> tuple[float, str]:
    """Greatest relative error of METRICS, and the metric that has it."""
    judged = {name: reference[name] for name in METRICS if name in reference}
    errors = relative_errors(result.metrics, judged, METRICS)
    worst = max(errors, key=errors.__getitem__)
    return errors[worst], worst


def time_at(error: float, samples: Sequence[Sample]) -> float | None:
    """Time that an error costs [s], from samples of falling tolerance; None: none is that good.

    An error is had from the tolerance on whose own and all stricter ones' errors are below it: small ones
    before that are luck. Between two tolerances the time is interpolated, both on logarithmic scales.
    """
    held = [max(s.error for s in samples[i:]) for i in range(len(samples))]
    first = next((i for i, e in enumerate(held) if e <= error), None)
    if first is None:
        return None
    if first == 0 or held[first] == 0.0:
        return samples[first].time
    above, below = math.log(held[first - 1]), math.log(held[first])
    share = (above - math.log(error)) / (above - below)
    before, after = math.log(samples[first - 1].time), math.log(samples[first].time)
    return math.exp(before + share * (after - before))


def scenes_of(vehicle: Vehicle, speed: float, tolerance: float, ends: Mapping[str, float | None]) -> dict:
    settings = Settings(tolerance=tolerance)
    return {
        name: Simulation(vehicle, barrier, speed, angle, duration=ends.get(name), settings=settings)
        for name, (barrier, angle) in PAIRS.items()
    }


def ends_of(vehicle: Vehicle, speed: float) -> dict[str, float | None]:
    """When the vehicle has left the flat wall at each angle [s], for every pair."""
    runs = scenes_of(vehicle, speed, DEFAULT, {})
    flat = {name: float(runs[name].run().time[-1]) for name in dict.fromkeys(FLAT.values())}
    return {name: flat[FLAT.get(name, name)] for name in PAIRS}


def samples_of(
    vehicle: Vehicle, options: argparse.Namespace
) -> tuple[dict[str, list[Sample]], dict[str, float]]:
    """Return samples of every pair by falling tolerance, and the time that each simulates [s]."""
    ends: Mapping[str, float | None] = {} if options.whole else ends_of(vehicle, options.speed)
    fine = scenes_of(vehicle, options.speed, options.fine, ends)
    answers = {name: simulation.run() for name, simulation in fine.items()}
    runs = {
        (name, tolerance): simulation
        for tolerance in options.tolerances
        for name, simulation in scenes_of(vehicle, options.speed, tolerance, ends).items()
    }
    times = dict.fromkeys(runs, math.inf)
    for _ in range(options.repeats + 1):  # the first also warms up; the least does not mind
        for key, simulation in runs.items():
            times[key] = min(times[key], simulation.run().run_time)
    samples: dict[str, list[Sample]] = {name: [] for name in PAIRS}
    for (name, tolerance), simulation in runs.items():
        result = simulation.result()
        found = result.statistics
        error, worst = greatest_error(result, answers[name].metrics)
        counts = (found.steps, found.rejected, found.node_evaluations)
        samples[name].append(Sample(tolerance, error, worst, *counts, times[name, tolerance]))
    return samples, {name: float(answer.time[-1]) for name, answer in answers.items()}


def rows_of(
    vehicle: str, samples: Mapping[str, Sequence[Sample]], ends: Mapping[str, float], error: float
) -> list[Row]:
    at_error = {name: time_at(error, of) for name, of in samples.items()}
    rows = []
    for name, of in samples.items():
        own, flat = at_error[name], at_error[FLAT.get(name, name)]
        usual = next(sample for sample in of if sample.tolerance == DEFAULT)
        rows.append(
            Row(
                vehicle,
                name,
                PAIRS[name][1],
                ends[name],
                usual.steps,
                usual.redone,
                usual.node_evaluations,
                usual.error,
                usual.worst,
                1e3 * usual.time,
                error,
                None if own is None else 1e3 * own,
                None if own is None or flat is None else own / flat,
            )
        )
    return rows


def marks(rows: Sequence[Row]) -> list[tuple[str, bool]]:
    """Whether bollards and Jersey barriers cost at most MARK times the flat wall."""
    checks = []
    for name in MARKED:
        of = [row for row in rows if row.barrier == name]
        ratios = [row.times_flat for row in of if row.times_flat is not None]
        within = sum(ratio <= MARK for ratio in ratios)
        text = f"{name} within {MARK:g} times the flat wall at the same error: {within} of {len(of)} vehicles"
        if ratios:
            text += f", {min(ratios):.1f} to {max(ratios):.1f} times"
        if len(ratios) < len(of):
            text += f"; {len(of) - len(ratios)} without that error"
        checks.append((text, within == len(of)))
    return checks


def text_of(cell: object, form: str = ".3g", none: str = "") -> str:
    if cell is None:
        return none
    return f"{cell:{form}}" if isinstance(cell, float) else str(cell)


def print_table(rows: Sequence[Row]) -> None:
    print(
        f"{'vehicle':15s}{'barrier':13s}{'s':>6s}{'steps':>7s}{'redone':>7s}{'nodes':>10s}{'error':>9s}  "
        f"{'of':16s}{'ms':>9s}{'ms at error':>12s}{'x flat':>8s}"
    )
    for row in rows:
        print(
            f"{row.vehicle:15s}{row.barrier:13s}{row.simulated_s:6.2f}{row.steps:7d}{row.redone:7d}"
            f"{row.node_evaluations:10d}{row.error:9.1e}  {row.of:16s}{row.time_ms:9.2f}"
            f"{text_of(row.time_at_error_ms, '.2f', '-'):>12s}{text_of(row.times_flat, '.2f', '-'):>8s}"
        )


def write(path: Path, rows: Sequence[Row], facts: Mapping[str, str]) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", encoding="utf-8", newline="") as file:
        for key, value in facts.items():
            file.write(f"# {key}: {value}\n")
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow([field.name for field in fields(Row)])
        for row in rows:
            writer.writerow([text_of(cell) for cell in astuple(row)])


def write_samples(path: Path, samples: Mapping[str, Mapping[str, Sequence[Sample]]]) -> None:
    """Every point of the work-precision curves that the times at the common error come from."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["vehicle", "barrier", *(field.name for field in fields(Sample))])
        for vehicle, barriers in samples.items():
            for barrier, of in barriers.items():
                for sample in of:
                    writer.writerow([vehicle, barrier, *(text_of(cell) for cell in astuple(sample))])


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--repeats", type=int, default=5, help="timed runs of each line (default: %(default)s)"
    )
    parser.add_argument("--speed", type=float, default=20.0, help="m/s (default: %(default)s)")
    parser.add_argument(
        "--error", type=float, default=COMMON_ERROR, help="common error (default: %(default)s)"
    )
    parser.add_argument("--vehicles", nargs="+", choices=Vehicle.presets(), default=Vehicle.presets())
    parser.add_argument("--mesh-density", type=float, default=1.0, help="relative to the presets'")
    parser.add_argument("--whole", action="store_true", help="until the outcome of each is decided")
    parser.add_argument("--quick", action="store_true", help="a coarse passenger car, three tolerances, once")
    parser.add_argument("--csv", type=Path, help="also write the table there")
    parser.add_argument("--samples", type=Path, help="also write every tolerance's error and time there")
    parser.add_argument("--save", action="store_true", help="also write tests/bench/results/pairs/<cpu>.csv")
    options = parser.parse_args(arguments)
    if options.repeats < 1:
        parser.error(f"--repeats must be >= 1, got {options.repeats}")
    options.tolerances, options.fine = TOLERANCES, FINE
    if options.quick:
        options.vehicles, options.mesh_density, options.repeats = ["passenger_car"], 0.25, 1
        options.tolerances, options.fine = (1e-2, DEFAULT, 1e-4), 1e-5
    facts = machine(use_one_core())
    facts |= {"speed_m_s": f"{options.speed:g}", "repeats": f"{options.repeats}, least of them"}
    for key, value in facts.items():
        print(f"{key:10s}{value}")
    rows: list[Row] = []
    samples: dict[str, dict[str, list[Sample]]] = {}
    with progress_bar(None, "pairs", len(options.vehicles)) as advance:
        for name in options.vehicles:
            vehicle = Vehicle.preset(name, mesh_density=options.mesh_density)
            samples[name], ends = samples_of(vehicle, options)
            rows += rows_of(name, samples[name], ends, options.error)
            advance(1)
    print()
    print_table(rows)
    print(
        f"\nerror, ms: at the default tolerance; ms at error: where every stricter tolerance is within "
        f"{options.error:g} too; -: none is\n"
    )
    for text, holds in marks(rows):
        print(f"{'holds   ' if holds else 'MISSED  '}{text}")
    if options.csv:
        write(options.csv, rows, facts)
    if options.samples:
        write_samples(options.samples, samples)
    if options.save:
        cpu = re.sub(r"[^a-z0-9]+", "_", facts["cpu"].lower()).strip("_")
        write(RESULTS / f"{cpu}{'_whole' if options.whole else ''}.csv", rows, facts)
    return 0


if __name__ == "__main__":
    sys.exit(main())
