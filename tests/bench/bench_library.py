"""Every vehicle against every barrier, watched step by step.

    python tests/bench/bench_library.py [--mesh-density 1.0] [--save] [--csv FILE]
    python tests/bench/bench_library.py --quick

Vehicle presets x barriers (endless and finite wall, five bollards, Jersey barrier of 32 in) x angles 10, 25,
45, 90 deg x speeds 5, 15, 25, 40 m/s. A row each: outcome, steps, time of stepping, greatest crush, vehicle
penetration, how deep nodes and anchors were inside at the end of any step, residuals of energy (below 0.5 %)
and momentum (below 1e-9). Ends with 1 if any row has a fault. Times include looking at every step.
"""

from __future__ import annotations

import argparse
import csv
import sys
from collections.abc import Sequence
from dataclasses import asdict
from itertools import product
from pathlib import Path

from birm3d import Barrier, Simulation, Vehicle
from birm3d.base.progress import progress_bar
from birm3d.study.verification.watched import LIMITS, Watched, text, watch

RESULTS = Path(__file__).parent / "results/robustness/library.csv"
BARRIERS = {
    "wall": Barrier.rigid_wall(),
    "finite_wall": Barrier.rigid_wall(width=6.0, height=1.0),
    "bollards": Barrier.bollards(),
    "jersey_32in": Barrier.jersey(length=30.0),
}
ANGLES = (10.0, 25.0, 45.0, 90.0)
SPEEDS = (5.0, 15.0, 25.0, 40.0)
HEAD = ("vehicle", "barrier", "angle_deg", "speed_m_s")

Row = tuple[tuple[str, str, float, float], Watched]


def run(
    vehicles: Sequence[str],
    angles: Sequence[float],
    speeds: Sequence[float],
    density: float,
) -> list[Row]:
    rows: list[Row] = []
    cases = list(product(BARRIERS, angles, speeds))
    with progress_bar(None, "library", len(vehicles) * len(cases)) as advance:
        for name in vehicles:
            vehicle = Vehicle.preset(name, mesh_density=density)
            for barrier, angle, speed in cases:
                rows.append(
                    (
                        (name, barrier, angle, speed),
                        watch(Simulation(vehicle, BARRIERS[barrier], speed, angle)),
                    )
                )
                advance(1)
    return rows


def write(path: Path, rows: Sequence[Row]) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow([*HEAD, *Watched.names()])
        for scene, watched in rows:
            writer.writerow(
                [*(text(cell) for cell in scene), *(text(cell) for cell in asdict(watched).values())]
            )


def print_summary(rows: Sequence[Row]) -> None:
    head = (
        f"{'vehicle':15s}{'barrier':12s}{'runs':>5s}{'steps':>12s}{'crush':>8s}{'node':>10s}{'anchor':>10s}"
    )
    print(head + f"{'energy':>10s}{'momentum':>10s}{'faults':>8s}")
    for name, barrier in dict.fromkeys(scene[:2] for scene, _ in rows):
        of = [watched for scene, watched in rows if scene[:2] == (name, barrier)]

        def worst(what: str, of: Sequence[Watched] = of) -> float:
            return max(getattr(watched, what) for watched in of)

        steps = f"{min(w.steps for w in of)}-{max(w.steps for w in of)}"
        print(f"{name:15s}{barrier:12s}{len(of):5d}{steps:>12s}{worst('crush'):6.2f} m", end="")
        print(f"{1e3 * worst('node_depth'):7.2f} mm{1e3 * worst('anchor_depth'):7.3f} mm", end="")
        print(f"{worst('energy_residual'):10.1e}{worst('momentum_residual'):10.1e}", end="")
        print(f"{sum(bool(w.fault) for w in of):8d}")
    faults = [(scene, watched.fault) for scene, watched in rows if watched.fault]
    for scene, fault in faults:
        print("FAULT", *(text(cell) for cell in scene), fault)
    print(
        f"{len(rows)} scenes, {len(faults)} with a fault; limits of depth: nodes "
        f"{1e3 * LIMITS.node_depth:g} mm, anchors {1e3 * LIMITS.anchor_depth:g} mm"
    )


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--mesh-density", type=float, default=1.0, help="relative to the presets'")
    parser.add_argument("--quick", action="store_true", help="two vehicles, coarse, four scenes a barrier")
    parser.add_argument("--csv", type=Path, help="also write the table there")
    parser.add_argument("--save", action="store_true", help="also write tests/bench/results/robustness")
    asked = parser.parse_args(arguments)
    try:
        if asked.quick:
            rows = run(("passenger_car", "cargo_truck"), (25.0, 90.0), (15.0, 36.0), 0.25)
        else:
            rows = run(Vehicle.presets(), ANGLES, SPEEDS, asked.mesh_density)
    except KeyboardInterrupt:
        print("stopped", file=sys.stderr)
        return 130
    print_summary(rows)
    if asked.csv:
        write(asked.csv, rows)
    if asked.save:
        write(RESULTS, rows)
    return 1 if any(watched.fault for _, watched in rows) else 0


if __name__ == "__main__":
    sys.exit(main())
