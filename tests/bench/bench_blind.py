"""What the presets predict of crash tests that their zones have never seen.

    python tests/bench/bench_blind.py [--mesh-density 0.25] [--save] [--csv FILE]

Every full-width rigid-wall test of NHTSA marked EXTRA whose pulse can be used (quality A or B) is computed
with the preset of its class (birm3d.scenes.preset_for) at the mass and the speed of the test, and the
greatest displacement of the mass centre is compared with that of the compartment. Zones are fitted to the
CALIBRATE rows only (examples/fit_sedan_front.py, fit_fronts.py). Three rules for a vehicle of another mass
are compared, of which the first is the package's own, Vehicle.scaled_to:

- similar: stiffness in proportion to mass. The four CALIBRATE rows have m v^2 / X^2 of 458 to 610 N/m a kg.
- same front: the zones stay, the mass changes (Vehicle.with_gvw).
- in between: stiffness in proportion to 506 m + 113,000 N/m, a line through 51 such tests. The EXTRA rows
  are among them: no blind prediction, for comparison only.

All but one of the tests ran at 56 km/h, and fronts are made to stop in the same way there: what is tested is
the level of the zones and the rule for mass, and the scatter of the errors is that of the vehicles. In test
10146, whose wall forces the passenger car is fitted to, the compartment went 0.741 m, the momentum centre,
which a vehicle of one rigid body owns, 0.677 m.
"""

from __future__ import annotations

import argparse
import csv
import statistics
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from birm3d import Barrier, Simulation, Vehicle, scenes
from birm3d.reference import NhtsaTest, nhtsa_tests

RESULTS = Path(__file__).parent / "results/predictions/nhtsa_frontal.csv"
LIMIT = 0.10  # of the median of the magnitudes


def between(mass: float) -> float:
    """Stiffness of a line through 51 tests [N/m]."""
    return 506.0 * mass + 113_000.0


def on_the_line(vehicle: Vehicle, mass: float) -> Vehicle:
    assert vehicle._file is not None  # a preset has one
    fitted = vehicle._file.zones_mass
    factor = between(mass) / between(fitted) * fitted / mass
    similar = vehicle.scaled_to(mass)
    return similar.with_zones({name: zone.scaled(factor) for name, zone in similar.zones.items()})


RULES: dict[str, Callable[[Vehicle, float], Vehicle]] = {
    "similar": Vehicle.scaled_to,
    "same front": Vehicle.with_gvw,
    "in between": on_the_line,
}


@dataclass(frozen=True)
class Row:
    """A test and its predictions."""

    test: NhtsaTest
    preset: str
    predicted: dict[str, float]

    def error(self, rule: str) -> float:
        """Relative to the test; positive where computed is more."""
        assert self.test.dynamic_displacement is not None  # see chosen
        return self.predicted[rule] / self.test.dynamic_displacement - 1.0


def chosen(split: str = "EXTRA") -> list[NhtsaTest]:
    return [
        test
        for test in nhtsa_tests().values()
        if test.kind == "frontal"
        and test.split == split
        and test.quality in ("A", "B")
        and test.dynamic_displacement is not None
    ]


def predict(
    tests: Sequence[NhtsaTest], mesh_density: float, rules: Sequence[str] = tuple(RULES)
) -> list[Row]:
    presets = {
        name: Vehicle.preset(name, mesh_density=mesh_density) for name in map(scenes.preset_for, tests)
    }
    rows = []
    for test in tests:
        name = scenes.preset_for(test)
        found = {}
        for rule in rules:
            vehicle = RULES[rule](presets[name], test.mass)
            run = Simulation(vehicle, Barrier.rigid_wall(), test.speed).run()
            found[rule] = run.metrics["max_displacement"]
        rows.append(Row(test, name, found))
    return rows


def median_error(rows: Sequence[Row], rule: str) -> float:
    """Median of the magnitudes."""
    return statistics.median(abs(row.error(rule)) for row in rows)


def print_table(rows: Sequence[Row]) -> None:
    print(f"{'test':6s}{'':30s}{'mass':>6s}{'speed':>7s}{'preset':>15s}{'measured':>10s}", end="")
    print("".join(f"{rule:>20s}" for rule in RULES))
    for row in rows:
        test = row.test
        what = f"{test.make} {test.model} {test.year}".title()
        print(f"{test.test:6s}{what:30.29s}{test.mass:6.0f}{test.speed:7.2f}{row.preset:>15s}", end="")
        print(f"{test.dynamic_displacement:8.3f} m", end="")
        print("".join(f"{row.predicted[r]:10.3f} m{100 * row.error(r):+7.1f}%" for r in RULES))


def print_summary(rows: Sequence[Row]) -> None:
    print(f"\n{'median of |error|, and mean error':40s}{'tests':>6s}" + "".join(f"{r:>20s}" for r in RULES))
    classes = sorted({row.test.vehicle_class for row in rows})
    for name in [*classes, "all"]:
        of = [row for row in rows if name in (row.test.vehicle_class, "all")]
        means = {rule: statistics.fmean(row.error(rule) for row in of) for rule in RULES}
        cells = "".join(f"{100 * median_error(of, r):12.1f}%{100 * means[r]:+6.1f}%" for r in RULES)
        print(f"{name:40s}{len(of):6d}{cells}")


def write(path: Path, rows: Sequence[Row]) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    head = ("test", "vehicle_class", "preset", "mass_kg", "speed_m_s", "measured_m")
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow([*head, *(f"{rule.replace(' ', '_')}_m" for rule in RULES)])
        for row in rows:
            test = row.test
            told = [test.test, test.vehicle_class, row.preset, test.mass, test.speed]
            found = [f"{row.predicted[rule]:.4f}" for rule in RULES]
            writer.writerow([*told, test.dynamic_displacement, *found])


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--mesh-density", type=float, default=1.0, help="relative to the presets'")
    parser.add_argument("--csv", type=Path, help="also write the table there")
    parser.add_argument("--save", action="store_true", help="also write tests/bench/results/predictions")
    options = parser.parse_args(arguments)
    rows = predict(chosen(), options.mesh_density)
    print_table(rows)
    print_summary(rows)
    for path in [options.csv] * bool(options.csv) + [RESULTS] * options.save:
        write(path, rows)
    return 0 if median_error(rows, "similar") < LIMIT else 1


if __name__ == "__main__":
    sys.exit(main())
