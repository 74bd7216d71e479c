"""Mesh refinement: crush, force, speed and yaw at half to four times the elements, and the order seen.

    python tests/bench/bench_mesh.py [--vehicles NAME ...] [--members 9] [--save]
    python tests/bench/bench_mesh.py --quick

A laboratory block with staggered nodes, and presets, against a wall, a pole and a Jersey barrier. Where nodes
fall beside an edge or a post is chance, so every scene is a group of runs that differ by up to 1 deg in
angle, or by up to 60 mm in where the pole meets; a change from mesh to mesh is the root mean square over the
group. Changes go with h^p, h = elements^-1/2; p is the slope through all of them on logarithmic scales (of
one pair of changes: 2 log2 of their ratio). The extrapolated value is Richardson's, of the group's mean with
that p; it needs p >= 0.5. Steps are kept to a tolerance of 1e-5, so that the mesh is what changes.
"""

from __future__ import annotations

import argparse
import csv
import math
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
import numpy.typing as npt
from birm3d import Barrier, Result, Settings, Simulation, Vehicle, scenes
from birm3d.base.progress import progress_bar
from birm3d.study.verification.convergence import order_of, richardson

RESULTS = Path(__file__).parent / "results/convergence/mesh.csv"
BARRIERS = ("wall", "pole", "jersey")
DENSITIES = (0.5, 1.0, 2.0, 4.0)
ANGLES = 1.0  # deg
OFFSETS = 0.06  # m
LEAST_ORDER = 0.5
# Scalars of the table: unit, and by what they are printed.
METRICS = {
    "dynamic_crush": ("m", 1.0),
    "peak_normal_force_cfc60": ("kN", 1e-3),
    "peak_force_50ms": ("kN", 1e-3),
    "end_speed": ("m/s", 1.0),
    "max_yaw": ("deg", 1.0),
}
SHORT = ("crush", "peak CFC60", "peak 50 ms", "end speed", "yaw")

Floats = npt.NDArray[np.float64]
# From the density and the place in the group, -1 to 1.
Scene = Callable[[float, float], Simulation]


def block(density: float, place: float) -> Simulation:
    """Return the block at 66 deg, frictionless: 6 k^2 nodes, k = 14 at density 1."""
    n = 6 * round(14.0 * math.sqrt(density)) ** 2
    law = {"k_initial": 3e6, "knee": 0.4, "k_hardening": 6e6, "k_unloading": 60e6}
    vehicle = scenes.laboratory_block(n, stagger=0.2, **law)
    settings = Settings(gravity=0.0, ground=False, tolerance=1e-5)
    wall = Barrier.rigid_wall(friction=0.0)
    return Simulation(vehicle, wall, 22.352, 66.0 + ANGLES * place, duration=0.3, settings=settings)


def preset(name: str, barrier: str) -> Scene:
    def scene(density: float, place: float) -> Simulation:
        vehicle = Vehicle.preset(name, mesh_density=density)
        settings = Settings(tolerance=1e-5)
        if barrier == "pole":
            pole = Barrier.pole(diameter=0.3)
            return Simulation(
                vehicle, pole, 10.0, impact_offset=OFFSETS * place, duration=0.2, settings=settings
            )
        shape = Barrier.rigid_wall() if barrier == "wall" else Barrier.jersey(length=30.0)
        return Simulation(vehicle, shape, 20.0, 25.0 + ANGLES * place, duration=0.3, settings=settings)

    return scene


@dataclass(frozen=True)
class Refinement:
    """One scene at rising densities; g runs in the group, n densities, m of METRICS."""

    name: str
    densities: tuple[float, ...]
    elements: tuple[int, ...]
    values: Floats  # (n, g, m)
    velocity_change: Floats  # (n - 1,): of the velocity over the run, relative to the impact speed

    @property
    def means(self) -> Floats:
        """Of the group, (n, m)."""
        return self.values.mean(axis=1)

    @property
    def changes(self) -> Floats:
        """From each mesh to the next, root mean square over the group, (n - 1, m)."""
        return np.sqrt(np.mean(np.diff(self.values, axis=0) ** 2, axis=1))

    def order(self, changes: Floats) -> float | None:
        """Slope p of changes over h; None: a change is nil, as of yaw in a crash that has none."""
        return order_of(np.array(self.elements[:-1], float) ** -0.5, changes)

    def extrapolated(self, metric: int) -> float | None:
        """Value at h -> 0 by Richardson; None: the order is not fit for it."""
        p = self.order(self.changes[:, metric])
        if p is None or p < LEAST_ORDER:
            return None
        coarse, fine = self.means[-2:, metric].tolist()
        return richardson(coarse, fine, math.sqrt(self.elements[-1] / self.elements[-2]), p)


def _value(run: Result, metric: str) -> float:
    """Return a metric, or the speed along the ground at the end, which runs without a separation have too."""
    return float(np.hypot(*run.velocity[-1, :2])) if metric == "end_speed" else run.metrics[metric]


def refine(name: str, scene: Scene, densities: Sequence[float], members: int) -> Refinement:
    elements, values, velocities = [], [], []
    for density in densities:
        runs = [scene(density, float(place)).run() for place in np.linspace(-1.0, 1.0, members)]
        vehicle = runs[0].scene.vehicle
        elements.append(vehicle.n_elements or vehicle.n_nodes)  # those of arrays have nodes only
        values.append([[_value(run, metric) for metric in METRICS] for run in runs])
        velocities.append(np.array([run.velocity for run in runs]))
        speed = runs[0].scene.impact_speed
    changes = [np.sqrt(np.mean(np.sum((b - a) ** 2, axis=-1))) / speed for a, b in pairwise(velocities)]
    return Refinement(name, tuple(densities), tuple(elements), np.array(values), np.array(changes))


def cell(value: float | None, form: str) -> str:
    return "-" if value is None else f"{value:{form}}"


def print_table(found: Refinement) -> None:
    scales = [scale for _, scale in METRICS.values()]
    columns = range(len(scales))

    def line(title: str, elements: str, cells: Sequence[str]) -> None:
        print(f"{title:20s}{elements:>9s}" + "".join(f"{text:>12s}" for text in cells))

    print(f"\n{found.name}")
    line("density", "elements", [*SHORT, "velocity"])
    line("", "", [*(unit for unit, _ in METRICS.values()), "change"])
    for i, density in enumerate(found.densities):
        cells = [f"{found.means[i, j] * scales[j]:.5g}" for j in columns]
        line(
            f"{density:g}",
            f"{found.elements[i]}",
            [*cells, f"{found.velocity_change[i - 1]:.1e}" if i else ""],
        )
    for i, (coarse, fine) in enumerate(pairwise(found.densities)):
        cells = [f"{change * scale:.2g}" for change, scale in zip(found.changes[i], scales, strict=True)]
        line(f"change {coarse:g} to {fine:g}", "", cells)
    orders = [cell(found.order(found.changes[:, j]), ".2f") for j in columns]
    line("order", "", [*orders, cell(found.order(found.velocity_change), ".2f")])
    limits = [found.extrapolated(j) for j in columns]
    told = [None if limit is None else limit * scale for limit, scale in zip(limits, scales, strict=True)]
    line("extrapolated", "", [cell(value, ".5g") for value in told])
    line("error of density 1", "", [cell(error_of(found, j), "+.2%") for j in columns])


def error_of(found: Refinement, metric: int, density: float = 1.0) -> float | None:
    """Relative error of the mean at a density against the extrapolated value; None: there is none."""
    limit = found.extrapolated(metric)
    if limit is None or limit == 0.0 or density not in found.densities:
        return None
    return float(found.means[found.densities.index(density), metric]) / limit - 1.0


def write(path: Path, refinements: Sequence[Refinement]) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(
            ["scene", "metric", "unit", *(f"at_{d:g}" for d in refinements[0].densities)]
            + [f"change_{a:g}_{b:g}" for a, b in pairwise(refinements[0].densities)]
            + ["order", "extrapolated", "error_of_density_1"]
        )
        for found in refinements:
            for j, (metric, (unit, scale)) in enumerate(METRICS.items()):
                limit = found.extrapolated(j)
                writer.writerow(
                    [found.name, metric, unit]
                    + [f"{value:.5g}" for value in scale * found.means[:, j]]
                    + [f"{change:.2g}" for change in scale * found.changes[:, j]]
                    + [
                        cell(found.order(found.changes[:, j]), ".2f"),
                        cell(None if limit is None else limit * scale, ".5g"),
                        cell(error_of(found, j), ".1e"),
                    ]
                )
            changes = [f"{change:.2g}" for change in found.velocity_change]
            order = cell(found.order(found.velocity_change), ".2f")
            blank = [""] * len(found.densities)
            writer.writerow([found.name, "velocity over the run", "", *blank, *changes, order, "", ""])


def all_scenes(vehicles: Sequence[str], barriers: Sequence[str]) -> Mapping[str, Scene]:
    found: dict[str, Scene] = {"laboratory_block, wall": block}
    for name in vehicles:
        for barrier in barriers:
            found[f"{name}, {barrier}"] = preset(name, barrier)
    return found


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    usual = ["passenger_car", "pickup", "cargo_truck"]
    parser.add_argument("--vehicles", nargs="*", choices=Vehicle.presets(), default=usual)
    parser.add_argument("--barriers", nargs="+", choices=BARRIERS, default=list(BARRIERS))
    parser.add_argument("--densities", nargs="+", type=float, default=list(DENSITIES), help="rising")
    parser.add_argument("--members", type=int, default=9, help="runs of a group (default: %(default)s)")
    parser.add_argument("--quick", action="store_true", help="block and passenger car, groups of three")
    parser.add_argument("--save", action="store_true", help="also write tests/bench/results/convergence")
    options = parser.parse_args(arguments)
    if options.members < 1:
        parser.error(f"--members must be >= 1, got {options.members}")
    if len(options.densities) < 2 or not all(0.0 < a < b for a, b in pairwise(options.densities)):
        parser.error(f"--densities must be two or more, > 0 and rising, got {options.densities}")
    if options.quick:
        options.vehicles, options.members = ["passenger_car"], 3
    chosen = all_scenes(options.vehicles, options.barriers)
    refinements = []
    with progress_bar(None, "mesh", len(chosen)) as advance:
        for name, scene in chosen.items():
            refinements.append(refine(name, scene, options.densities, options.members))
            advance(1)
    print(f"groups of {options.members}; velocity: its change from the mesh above, over the run, relative")
    for found in refinements:
        print_table(found)
    if options.save:
        write(RESULTS, refinements)
    return 0


if __name__ == "__main__":
    sys.exit(main())
