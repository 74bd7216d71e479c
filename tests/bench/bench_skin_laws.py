"""What the laws of the skin beyond the paper's cost: elastic recovery, tails, second trusses, indentations.

    python tests/bench/bench_skin_laws.py [--repeats 5] [--save]
    python tests/bench/bench_skin_laws.py --quick

Presets against walls and poles, beside the same vehicles with the paper's law. These have the same envelopes,
the one slope of unloading of its Fig. 3, no tail and all of the friction. They have no second trusses along
the panels, and posts and edges draw in no skin beside them. Compared is the time at equal error. It is
interpolated between tolerances of 1 to 1e-5, on logarithmic scales. The error is the greatest of any metric
below, against the scene's own answer at 1e-7. The mark is a ratio of 1.5.

Times are those of stepping, medians, one pinned core; the two vehicles take turns. --save writes
results/skin_laws/skin_laws.csv.
"""

from __future__ import annotations

import argparse
import re
import statistics
import sys
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from bench_birm3d import print_machine, use_one_core, write_rows
from birm3d import Barrier, Simulation, Vehicle, units
from birm3d.scene_parameters import varied
from birm3d.vehicle.vehicle_file import unit_paths

RESULTS = Path(__file__).parent / "results/skin_laws/skin_laws.csv"
MARK = 1.5
REFERENCE = 1e-7
TOLERANCES = tuple(10.0 ** (-0.5 * i) for i in range(11))
ERRORS = (1e-2, 1e-3)
METRICS = ("dynamic_crush", "max_displacement", "peak_force_50ms", "delta_v")
PRESETS = ("passenger_car", "minivan", "pickup", "cargo_truck")
BEYOND_FIG_3 = ("elastic_recovery_m", "tail_depth_m", "tail_slope_Pa_per_m", "friction_share")
CASES: Mapping[str, Callable[[Vehicle], Simulation]] = {
    "wall, head-on": lambda v: Simulation(v, Barrier.rigid_wall(), units.mph(35)),
    "wall, 25 deg": lambda v: Simulation(v, Barrier.rigid_wall(), units.mph(60), 25.0, duration=0.4),
    "pole, head-on": lambda v: Simulation(v, Barrier.pole(), units.mph(30), duration=0.3),
    "25 % of a wall": lambda v: Simulation(
        v, Barrier.rigid_wall(edge_radius=0.15, height=1.5), units.mph(40), overlap=0.25, duration=0.2
    ),
}


@dataclass(frozen=True)
class Row:
    """A crash with both laws; times in ms."""

    vehicle: str
    case: str
    error: float
    paper_ms: float
    ours_ms: float
    ratio: float


def with_the_papers_law(name: str, density: float) -> Vehicle:
    """Return a preset without what the paper's law does not have."""
    kept, second = [], False
    for line in unit_paths()[name].read_text(encoding="utf-8").splitlines():
        if line.startswith("["):
            second = line.startswith("[zone.") and line.endswith((".along]", ".across]"))
        if not second and line.split(" = ")[0] not in BEYOND_FIG_3:
            kept.append(re.sub(r', "\w+\.(along|across)"', "", line))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"{name}.toml"
        path.write_text("\n".join(kept), encoding="utf-8")
        return Vehicle.from_file(path, mesh_density=density).with_indentation_length(0.0)


def at(simulation: Simulation, tolerance: float) -> Simulation:
    """Return the scene at another tolerance."""
    return varied(simulation, {"settings.tolerance": tolerance})


def time_at(error: float, times: Sequence[float], errors: Sequence[float]) -> float:
    """Return the time [s] at an error, where stricter tolerances have no greater one."""
    worst = np.maximum.accumulate(np.array(errors)[::-1])[::-1]
    return float(np.exp(np.interp(-np.log(error), -np.log(worst), np.log(times))))


def compared(name: str, case: str, density: float, repeats: int) -> list[Row]:
    """Run both vehicles at every tolerance, in turn."""
    vehicles = {
        "paper": with_the_papers_law(name, density),
        "ours": Vehicle.preset(name, mesh_density=density),
    }
    scenes = {which: CASES[case](vehicle) for which, vehicle in vehicles.items()}
    exact = {which: at(scene, REFERENCE).run().metrics for which, scene in scenes.items()}
    times: dict[str, list[float]] = {which: [] for which in scenes}
    errors: dict[str, list[float]] = {which: [] for which in scenes}
    for scene in scenes.values():
        at(scene, TOLERANCES[0]).run()  # the first run of a scene fills caches
    for tolerance in TOLERANCES:
        taken: dict[str, list[float]] = {which: [] for which in scenes}
        for _ in range(repeats):
            for which, scene in scenes.items():
                result = at(scene, tolerance).run()
                taken[which].append(result.run_time)
                found = result.metrics
                if len(taken[which]) == 1:
                    of_each = [abs(found[m] / exact[which][m] - 1.0) for m in METRICS]
                    errors[which].append(max(1e-12, *of_each))
        for which in scenes:
            times[which].append(statistics.median(taken[which]))
    rows = []
    for error in ERRORS:
        paper, ours = (1e3 * time_at(error, times[which], errors[which]) for which in ("paper", "ours"))
        rows.append(Row(name, case, error, paper, ours, ours / paper))
    return rows


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--quick", action="store_true", help="a coarse car, one repeat")
    parser.add_argument("--save", action="store_true", help=f"also write {RESULTS.name}")
    asked = parser.parse_args(arguments)
    use_one_core()
    print_machine()
    rows: list[Row] = []
    print(f"{'vehicle':16s}{'case':18s}{'error':>8s}{'paper':>12s}{'ours':>12s}{'ratio':>8s}")
    for name in PRESETS[:1] if asked.quick else PRESETS:
        for case in CASES:
            new = compared(name, case, 0.2 if asked.quick else 1.0, 1 if asked.quick else asked.repeats)
            for row in new:
                print(
                    f"{row.vehicle:16s}{row.case:18s}{row.error:8.1%}{row.paper_ms:9.3f} ms"
                    f"{row.ours_ms:9.3f} ms{row.ratio:8.2f}"
                )
            rows += new
    ratios = [row.ratio for row in rows]
    print(f"ratio: median {statistics.median(ratios):.2f}, greatest {max(ratios):.2f}; mark {MARK:g}")
    if asked.save:
        RESULTS.parent.mkdir(parents=True, exist_ok=True)
        with RESULTS.open("w", encoding="utf-8", newline="") as file:
            write_rows(file, rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())
