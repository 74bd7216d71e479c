"""How long `birm3d.predict` takes from scene to scene, with the error of its band beside the time.

    python tests/bench/bench_predict.py [--repeats 3] [--draws 256] [--save]

Each scene is predicted with the default 32 draws, on all cores: the least time of the repeats, and the
processor time of that repeat. The error is that of the 80 % band: the greater distance of its ends from those
of many draws (``--draws``), over the width of the latter, of the travel and of the greatest 50-ms force.
"""

from __future__ import annotations

import argparse
import os
import time
import warnings
from dataclasses import dataclass
from pathlib import Path

os.environ["OPENBLAS_NUM_THREADS"] = "1"

import birm3d
from bench_birm3d import cpu_model, write_rows
from birm3d import Barrier, Simulation, Vehicle, units

RESULTS = Path(__file__).parent / "results/predictions/time.csv"
MEASURED = ("max_displacement", "peak_force_50ms")
SCENES = (
    ("passenger_car", "rigid wall", Barrier.rigid_wall(), units.km_h(56), 90.0),
    ("pickup", "Jersey barrier", Barrier.jersey(), units.km_h(100), 25.0),
    ("cargo_truck", "bollards", Barrier.bollards(), units.mph(50), 90.0),
    ("cabover_7200", "bollards", Barrier.bollards(), units.km_h(80), 90.0),
    ("mash_10000s", "Jersey barrier", Barrier.jersey(), units.km_h(90), 15.0),
    ("bus_13t", "Jersey barrier", Barrier.jersey(), units.km_h(70), 20.0),
    ("semi_truck", "Jersey barrier", Barrier.jersey(), units.km_h(80), 15.0),
)


@dataclass(frozen=True)
class Row:
    """A scene, predicted."""

    scene: str
    seconds: float
    cpu_seconds: float
    displacement_error: float
    force_error: float
    rolled_over: float  # share of the vehicles


def timed(simulation: Simulation) -> tuple[float, float]:
    """Return the time of a prediction and its processor time [s]."""
    clock, cpu = time.perf_counter(), time.process_time()
    birm3d.predict(simulation)
    return time.perf_counter() - clock, time.process_time() - cpu


def error(few: birm3d.Prediction, many: birm3d.Prediction, name: str) -> float:
    """Return the greater distance of the band's ends, over the width of the band of many draws."""
    ends = ((one.low[name], one.high[name]) for one in (few, many))
    (low, high), (least, most) = ends
    return max(abs(low - least), abs(high - most)) / (most - least)


def row(name: str, place: str, simulation: Simulation, repeats: int, draws: int) -> Row:
    """Predict one scene."""
    few, many = birm3d.predict(simulation), birm3d.predict(simulation, draws)
    seconds, cpu = min(timed(simulation) for _ in range(repeats))
    errors = [error(few, many, measured) for measured in MEASURED]
    return Row(f"{name}, {place}", seconds, cpu, *errors, many.outcomes.get("rolled_over", 0.0))


def main() -> None:
    """Print the table, and save it if asked to."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--draws", type=int, default=256)
    parser.add_argument("--save", action="store_true")
    arguments = parser.parse_args()
    warnings.simplefilter("ignore")
    print(f"{cpu_model()}, {os.cpu_count()} cores")
    print(f"{'scene':32}{'s':>7}{'CPU s':>8}{'travel':>9}{'force':>8}{'rolled over':>13}")
    rows = []
    for name, place, barrier, speed, angle in SCENES:
        found = row(
            name,
            place,
            Simulation(Vehicle.preset(name), barrier, speed, angle),
            arguments.repeats,
            arguments.draws,
        )
        rows.append(found)
        print(
            f"{found.scene:32}{found.seconds:7.2f}{found.cpu_seconds:8.2f}{found.displacement_error:9.0%}"
            f"{found.force_error:8.0%}{found.rolled_over:13.0%}",
            flush=True,
        )
    if arguments.save:
        with RESULTS.open("w", encoding="utf-8", newline="") as file:
            write_rows(file, rows)


if __name__ == "__main__":
    main()
