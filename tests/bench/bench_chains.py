"""Free-standing chains: what a run costs with the number of segments, and how well its balance closes.

    python tests/bench/bench_chains.py --save             # one minute
    python tests/bench/bench_chains.py --quick            # up to 20 segments, for a look

A pickup meets the middle of a Jersey barrier of segments of 3 m at 100 km/h and 25 degrees. Energy is the
greatest residual as a share of the kinetic energy at the start, `falls` the greatest fall of a dissipated
term, the same share. Times are those of the processor for a run with its histories, medians.
"""

from __future__ import annotations

import argparse
import csv
import statistics
import sys
import time
from collections.abc import Sequence
from dataclasses import astuple, dataclass, fields
from pathlib import Path

import numpy as np
from bench_birm3d import print_machine, write_machine
from birm3d import Barrier, FreeStanding, Result, Settings, Simulation, Vehicle, units

RESULTS = Path(__file__).parent / "results/chains"
SIZES = (1, 2, 5, 10, 20, 40, 80, 300)
MARKS = {40: 0.3, 300: 2.0}  # segments: s, pinned
DISSIPATED = ("barrier_ground_friction", "impacts", "barrier_friction", "tire_friction", "crushed")


@dataclass(frozen=True)
class Line:
    joint: str
    segments: int
    steps: int
    seconds: float
    ms_a_step: float
    simulated: float  # s
    energy: float
    falls: float
    deflection: float  # m, greatest
    left: float  # m, at the end


def scene(joint: str, segments: int, tolerance: float = 1e-3) -> Simulation:
    free = FreeStanding(joint=joint)
    barrier = Barrier.jersey(length=3.0 * segments, segments=segments, free_standing=free)
    vehicle = Vehicle.preset("pickup")
    return Simulation(
        vehicle, barrier, units.km_h(100), 25.0, settings=Settings(tolerance=tolerance, output_interval=1e-3)
    )


def greatest_fall(result: Result) -> float:
    start = result.energy["kinetic"][0]
    falls = [-np.diff(result.energy[name]).min() / start for name in DISSIPATED if name in result.energy]
    return max(0.0, *map(float, falls))


def bench(joint: str, segments: int, tolerance: float, repeats: int) -> Line:
    simulation = scene(joint, segments, tolerance)
    times = []
    for _ in range(repeats):
        start = time.process_time()
        result = simulation.run()
        times.append(time.process_time() - start)
    seconds = statistics.median(times)
    steps = result.statistics.steps
    return Line(
        joint, segments, steps, seconds, 1e3 * seconds / steps, float(result.time[-1]),
        result.metrics["energy_residual"], greatest_fall(result),
        result.metrics["barrier_deflection"], result.metrics["residual_barrier_deflection"],
    )  # fmt: skip


def shown(line: Line) -> str:
    return (
        f"{line.joint:8s}{line.segments:9d}{line.steps:8d}{line.seconds:9.3f}{line.ms_a_step:11.3f}"
        f"{line.simulated:8.2f}{line.energy:10.1e}{line.falls:10.1e}{line.deflection:11.4f}{line.left:9.4f}"
    )


def marks(lines: Sequence[Line]) -> list[tuple[str, bool]]:
    found = [
        (f"{line.segments} pinned segments in {line.seconds:.2f} s (mark: {MARKS[line.segments]} s)",
         line.seconds < MARKS[line.segments])
        for line in lines
        if line.joint == "pinned" and line.segments in MARKS
    ]  # fmt: skip
    worst = max(lines, key=lambda line: line.energy)
    text = f"energy within {worst.energy:.1e}, {worst.segments} {worst.joint} segments (mark: 1e-3)"
    return [*found, (text, worst.energy < 1e-3)]


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--repeats", type=int, default=3, help="timed runs of each line")
    parser.add_argument("--segments", type=int, nargs="+", help="other numbers of them")
    parser.add_argument("--tolerance", type=float, default=1e-3)
    parser.add_argument("--quick", action="store_true", help="few segments, once")
    parser.add_argument("--save", action="store_true", help="also write tests/bench/results/chains")
    options = parser.parse_args(arguments)
    if options.repeats < 1:
        parser.error(f"--repeats must be >= 1, got {options.repeats}")
    facts = print_machine()
    sizes = options.segments or (SIZES[:5] if options.quick else SIZES)
    print("joint    segments   steps        s  ms a step  of s      energy     falls  deflects     left")
    lines = []
    for joint in ("pinned", "loose"):
        for segments in sizes:
            lines.append(bench(joint, segments, options.tolerance, 1 if options.quick else options.repeats))
            print(shown(lines[-1]), flush=True)
    print()
    for text, holds in marks(lines):
        print(f"{'holds   ' if holds else 'MISSED  '}{text}")
    if options.save:
        RESULTS.mkdir(parents=True, exist_ok=True)
        with (RESULTS / "chains.csv").open("w", encoding="utf-8", newline="") as file:
            write_machine(file, facts)
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow([field.name for field in fields(Line)])
            for line in lines:
                writer.writerow([f"{v:.4g}" if isinstance(v, float) else v for v in astuple(line)])
        print(f"written: {RESULTS.relative_to(Path(__file__).parent).as_posix()}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
