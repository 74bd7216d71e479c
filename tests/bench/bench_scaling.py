"""Cost against the size of a problem: nodes touched and untouched, posts, tolerance, duration.

    python tests/bench/bench_scaling.py --save            # about three minutes
    python tests/bench/bench_scaling.py --quick           # small sizes, for a look

Each axis is a row of scenes that differ in one size; they run in turn on one pinned core, medians of the time
of stepping, with the error of each beside it. The exponent p is that of time ~ size^p, by least squares on
logarithmic scales over the upper half of the sizes, where what does not grow weighs less.

touched    W2, all nodes on the wall; error against the closed form
untouched  W2 with 1,000 nodes in front and m more on the rear, which meets nothing; the same closed form
mesh       the same with a vehicle: a passenger car of 2,000 to 50,000 elements, head-on at a pole; error
           against the finest tolerance with the same mesh
posts      a passenger car head-on at one bollard of a row, spaced so that it meets no other; error: greatest
           difference of any metric from the run with one bollard
tolerance  W2, N = 1,000
duration   W2 that goes on after the impact; a pickup that rolls (error: tyre reactions less weight)
"""

from __future__ import annotations

import argparse
import csv
import math
import statistics
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from bench_birm3d import BOOKKEEPING, COMPARED, exact_w2, print_machine, worst_error, write_machine
from birm3d import Barrier, Result, Settings, Simulation, Vehicle, scenes

RESULTS = Path(__file__).parent / "results/scaling"
MARK = 0.10
FREE = {"gravity": 0.0, "ground": False}


@dataclass(frozen=True)
class Axis:
    name: str
    size: str  # what is counted
    sizes: tuple[float, ...]
    scene: Callable[[float], Simulation]
    error: Callable[[Result, float], tuple[float, str]]
    # From which size to which a mark is put, and in what words.
    compared: tuple[float, float, str] | None = None


@dataclass(frozen=True)
class Line:
    axis: str
    size: float
    time: float  # s, stepping only
    steps: int
    evaluations: int
    error: float
    worst: str


def against_w2(result: Result, _: float) -> tuple[float, str]:
    return worst_error({name: result.metrics[name] for name in COMPARED}, exact_w2())


def with_rear(m: int) -> Simulation:
    """W2 with `m` more nodes on a rear face."""
    front = scenes.w2(1000).scene.vehicle
    law = {"k_initial": 3e3, "knee": 0.4, "k_hardening": 6e3, "k_unloading": 60e3}
    nodes, anchors = front.nodes, front.anchors
    if m > 0:
        rear = scenes.laboratory_block(m, **law).nodes * [-1.0, 1.0, 1.0]
        nodes = np.concatenate([nodes, rear])
        anchors = np.concatenate([anchors, rear + np.array([2.0, 0.0, 0.0])])
    vehicle = Vehicle.from_arrays(
        name="laboratory_block", mass=front.mass, inertia=front.inertia, nodes=nodes, anchors=anchors, **law
    )
    wall = Barrier.rigid_wall(friction=0.0)
    return Simulation(vehicle, wall, 22.352, settings=Settings(**FREE))


def car_at_pole(elements: float, tolerance: float = 1e-3) -> Simulation:
    usual = Vehicle.preset("passenger_car")
    density = elements / usual.n_elements
    vehicle = Vehicle.preset("passenger_car", mesh_density=density)
    pole = Barrier.pole(diameter=0.3)
    return Simulation(vehicle, pole, 10.0, duration=0.2, settings=Settings(tolerance=tolerance))


def car_at_posts(count: float) -> Simulation:
    row = Barrier.bollards(count=int(count), diameter=0.3, height=1.0, spacing=4.0)
    vehicle = Vehicle.preset("passenger_car")
    # An even row has its middle between two posts.
    offset = 0.0 if count % 2 else 2.0
    return Simulation(vehicle, row, 10.0, impact_offset=offset, duration=0.3)


def rolling(duration: float) -> Simulation:
    return scenes.rolling(duration)


def weight_error(result: Result, _: float) -> tuple[float, str]:
    scene = result.scene
    weight = scene.vehicle.mass * scene.settings.gravity
    late = result.time > 0.5 * result.time[-1]
    carried = float(result.tire_reaction[late].sum(axis=1).mean())
    return abs(carried / weight - 1.0), "tyre reactions"


def compared_with(reference: Callable[[float], Simulation]) -> Callable[[Result, float], tuple[float, str]]:
    found: dict[float, dict[str, float]] = {}

    def error(result: Result, size: float) -> tuple[float, str]:
        if size not in found:
            metrics = reference(size).run().metrics
            found[size] = {name: value for name, value in metrics.items() if name not in BOOKKEEPING}
        scale = {"max_roll": 1.0, "max_pitch": 1.0, "max_yaw": 1.0, "contact_overlap": 1e-3}
        errors = {
            name: abs(result.metrics.get(name, math.nan) - value) / max(abs(value), scale.get(name, 1e-9))
            for name, value in found[size].items()
        }
        worst = max(errors, key=lambda name: errors[name])
        return errors[worst], worst

    return error


def axes(quick: bool) -> list[Axis]:
    def some(*sizes: float) -> tuple[float, ...]:
        return sizes[:3] if quick else sizes

    return [
        Axis(
            "touched", "nodes", some(100, 316, 1000, 3162, 10000, 31623, 100000),
            lambda n: scenes.w2(int(n), Settings(**FREE)), against_w2,
        ),
        Axis(
            "untouched", "nodes at the rear", some(0, 1000, 10000, 3162, 31623, 100000),
            lambda m: with_rear(int(m)), against_w2,
            (1000, 10000, "ten times the untouched nodes (1,000 to 10,000; 1,000 are touched)"),
        ),
        Axis(
            "mesh", "elements", some(2000, 6000, 20000, 60000),
            car_at_pole, compared_with(lambda n: car_at_pole(n, 1e-6)),
        ),
        Axis(
            "posts", "bollards", some(1, 11, 1001, 101),
            car_at_posts, compared_with(lambda _: car_at_posts(1)),
            (1, 1001, "a thousand untouched bollards"),
        ),
        Axis(
            "tolerance", "1 / tolerance", some(10, 100, 1e3, 1e4, 1e5, 1e6, 1e7),
            lambda t: scenes.w2(1000, Settings(tolerance=1.0 / t, **FREE)), against_w2,
        ),
        Axis(
            "duration, W2", "s", some(0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0),
            lambda t: longer(scenes.w2(1000, Settings(**FREE)), t), against_w2,
        ),
        Axis("duration, rolling", "s", some(1.0, 2.0, 5.0, 10.0, 20.0, 60.0), rolling, weight_error),
    ]  # fmt: skip


def longer(simulation: Simulation, duration: float) -> Simulation:
    scene = simulation.scene
    return Simulation(
        scene.vehicle, scene.barrier, scene.impact_speed, duration=duration, settings=scene.settings
    )


def bench(axis: Axis, repeats: int) -> list[Line]:
    sizes = sorted(axis.sizes)
    simulations = [axis.scene(size) for size in sizes]
    results = [simulation.run() for simulation in simulations]
    times: list[list[float]] = [[] for _ in sizes]
    for _ in range(repeats):
        for simulation, taken in zip(simulations, times, strict=True):
            taken.append(simulation.run().run_time)
    lines = []
    for size, result, taken in zip(sizes, results, times, strict=True):
        error, worst = axis.error(result, size)
        found = result.statistics
        middle = statistics.median(taken)
        lines.append(Line(axis.name, size, middle, found.steps, found.node_evaluations, error, worst))
    return lines


def exponent(lines: Sequence[Line]) -> float:
    """Slope of log time over log size, upper half of the sizes."""
    upper = [line for line in lines if line.size > 0.0]
    upper = upper[-max(2, (len(upper) + 1) // 2) :]
    slope, _ = np.polyfit(np.log([line.size for line in upper]), np.log([line.time for line in upper]), 1)
    return float(slope)


def shown(axis: Axis, lines: Sequence[Line]) -> str:
    text = [f"\n{axis.name}: time ~ {axis.size}^{exponent(lines):.2f}"]
    text.append(
        f"{axis.size:>20s}{'ms':>10s}{'steps':>8s}{'us/step':>9s}{'node evals':>12s}{'error':>10s}  of"
    )
    for line in lines:
        text.append(
            f"{line.size:20,.4g}{1e3 * line.time:10.3f}{line.steps:8d}{1e6 * line.time / line.steps:9.2f}"
            f"{line.evaluations:12d}{line.error:10.1e}  {line.worst}"
        )
    return "\n".join(text)


def mark(axis: Axis, lines: Sequence[Line]) -> tuple[str, bool] | None:
    if axis.compared is None:
        return None
    by_size = {line.size: line for line in lines}
    low, high, words = axis.compared
    if low not in by_size or high not in by_size:
        return None
    a, b = by_size[low], by_size[high]
    more = b.time / a.time - 1.0
    text = f"{words}: {more:+.1%} time (errors {a.error:.1e} and {b.error:.1e}; mark: 10 %)"
    return text, more < MARK


def plot(path: Path, all_lines: dict[str, list[Line]], sizes: dict[str, str]) -> None:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11.0, 6.5), layout="constrained")
    for place, (name, lines) in enumerate(all_lines.items()):
        panel = figure.add_subplot(2, 4, place + 1)
        own = [line for line in lines if line.size > 0.0]
        panel.loglog([line.size for line in own], [1e3 * line.time for line in own], "o-")
        panel.set_title(f"{name}, p = {exponent(lines):.2f}", fontsize="medium")
        panel.set_xlabel(sizes[name])
        panel.set_ylabel("time [ms]")
        panel.grid(which="both", alpha=0.3)
        panel.set_ylim(bottom=0.3 * min(1e3 * line.time for line in own))
    figure.savefig(path, dpi=110)


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--repeats", type=int, default=7, help="timed runs of each line")
    parser.add_argument("--quick", action="store_true", help="small sizes, three timed runs")
    parser.add_argument("--axes", nargs="+", help="some of them, by name")
    parser.add_argument("--save", action="store_true", help="also write tests/bench/results/scaling")
    options = parser.parse_args(arguments)
    if options.repeats < 1:
        parser.error(f"--repeats must be >= 1, got {options.repeats}")
    facts = print_machine()
    known = axes(options.quick)
    wanted = [axis for axis in known if options.axes is None or axis.name in options.axes]
    if not wanted:
        parser.error(f"--axes must be among {', '.join(axis.name for axis in known)}, got {options.axes}")
    found: dict[str, list[Line]] = {}
    checks = []
    for axis in wanted:
        found[axis.name] = bench(axis, 3 if options.quick else options.repeats)
        print(shown(axis, found[axis.name]), flush=True)
        checked = mark(axis, found[axis.name])
        if checked is not None:
            checks.append(checked)
    print()
    for text, holds in checks:
        print(f"{'holds   ' if holds else 'MISSED  '}{text}")
    if options.save:
        RESULTS.mkdir(parents=True, exist_ok=True)
        with (RESULTS / "scaling.csv").open("w", encoding="utf-8", newline="") as file:
            write_machine(file, facts)
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(
                ["axis", "size", "time_ms", "steps", "node_evaluations", "error", "of", "exponent"]
            )
            for lines in found.values():
                for line in lines:
                    writer.writerow(
                        (line.axis, f"{line.size:g}", f"{1e3 * line.time:.4g}", line.steps, line.evaluations,
                         f"{line.error:.1e}", line.worst, f"{exponent(lines):.2f}")
                    )  # fmt: skip
        plot(RESULTS / "scaling.png", found, {axis.name: axis.size for axis in wanted})
        print(f"written: {RESULTS.relative_to(Path(__file__).parent).as_posix()}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
