"""A truck's front, fitted to finite-element runs at walls and bollards, and what it then computes of them.

    python tests/validation/fit_truck.py --save           # some minutes
    python tests/validation/fit_truck.py --page --save    # from the numbers that were found, seconds

Eleven numbers (truck_front.py) are fitted to five runs together, then each run is left out in turn. The same
is done with fewer numbers: the errors of the runs left out say what they are worth. The table has the preset
`cargo_truck` beside, three of whose numbers are fitted to these runs (fit_truck_preset.py).

--save writes tests/data/finite_element/truck_fits.csv and fitted_truck.toml, and tests/validation/truck.md.
"""

from __future__ import annotations

import argparse
import csv
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import birm3d
import numpy as np
import numpy.typing as npt
from birm3d.filters import cfc
from scipy.optimize import least_squares
from truck_front import NUMBERS, VARIANTS, Variant, vehicle_with
from truck_runs import DATA, FITTED, STANDOFF, START, Run, figures, runs, scene, with_loaded_posts

Floats = npt.NDArray[np.float64]

FITS = DATA / "truck_fits.csv"
# What the runs' own repeats moved by (shares), and what the load on a post should be met to (N s).
# Sideways it comes from a frame that bends between two posts, which one rigid body does not have.
TRAVEL, FORCE, SIDEWAYS, FORWARD = 0.04, 0.05, 20e3, 15e3
# Force curves count little: they have spikes of an engine that one rigid body can not follow. Of the peak.
CURVE, POINTS = 0.25, 8.0
# Where an indentation just reaches a stiff part of the front, loads on a post jump. The place of the jump is
# not to be believed: residuals at posts are means over these factors on the reach.
REACHES = (0.95, 1.05)
# Of the differences that derivatives are made of, in the logarithm: wide enough to see over small jumps.
STEP = 0.06
SPREAD = 0.35  # of the logarithm, of further starts about the first
# What is thought before the fit: the starts, each to a factor of two. A number that no run tells stays there.
DOUBT = 0.7  # of the logarithm


@dataclass(frozen=True)
class Fit:
    """Numbers that were found, by their names; run that was left out, or none; least cost."""

    variant: str
    left_out: str
    values: Mapping[str, float]
    cost: float

    @property
    def vehicle(self) -> birm3d.Vehicle:
        return vehicle_with(self.values, birm3d.Vehicle.from_file(START))


def residuals(vehicle: birm3d.Vehicle, run: Run) -> Floats:
    """Computed less the run's, each over its standard deviation."""
    result = scene(vehicle, run).run()
    own = figures(result)
    scalars = [(own.travel / run.travel - 1.0) / TRAVEL, (own.force_50ms / run.force_50ms - 1.0) / FORCE]
    posts = (own.impulse - run.impulse) / [FORWARD, SIDEWAYS] if run.posts else np.empty((0, 2))
    time = result.time - STANDOFF / result.velocity[0, 0]
    filtered = cfc(result.barrier_normal_force, 60, result.scene.settings.output_interval)
    force = np.interp(run.time, time, filtered, right=0.0)
    curve = (force - run.force) / (CURVE * run.peak_force) * np.sqrt(POINTS / len(run.time))
    return np.concatenate([scalars, posts.ravel(), curve])


def smoothed(vehicle: birm3d.Vehicle, run: Run) -> Floats:
    """Residuals, at posts as means over REACHES, with all posts and with those alone that took a load."""
    if not run.posts:
        return residuals(vehicle, run)
    several = [
        residuals(vehicle.with_indentation_length(vehicle.indentation_length * factor), same)
        for same in dict.fromkeys((run, with_loaded_posts(run)))
        for factor in REACHES
    ]
    return np.asarray(np.concatenate(several) / np.sqrt(len(several)))


def fit(variant: Variant, left_out: str, starts: int, steps: int) -> Fit:
    """The numbers of least squares to all runs but one, the best of several starts."""
    base = birm3d.Vehicle.from_file(START)
    known = [run for name, run in runs().items() if name != left_out]
    free = [n for n in NUMBERS if n.name not in variant.held and n.name not in variant.same]
    low, high = (np.log([getattr(n, bound) for n in free]) for bound in ("lower", "upper"))
    first = np.log([n.start for n in free])

    def values(x: Floats) -> dict[str, float]:
        found = {n.name: float(v) for n, v in zip(free, np.exp(x), strict=True)}
        found.update(variant.held)
        found.update({name: found[other] for name, other in variant.same.items()})
        return found

    def rows(x: Floats) -> Floats:
        vehicle = vehicle_with(values(x), base)
        return np.concatenate([(x - first) / DOUBT, *(smoothed(vehicle, run) for run in known)])

    draw = np.random.default_rng(0)
    found = []
    for start in range(starts):
        x = first if start == 0 else first + draw.normal(0.0, SPREAD, len(free))
        x = np.clip(x, low + 1e-3, high - 1e-3)
        found.append(
            least_squares(rows, x, bounds=(low, high), diff_step=STEP, max_nfev=steps, x_scale=SPREAD)
        )
    best = min(found, key=lambda one: float(one.cost))
    return Fit(variant.name, left_out, values(best.x), float(best.cost))


def all_fits(options: argparse.Namespace) -> list[Fit]:
    """The fit to all runs, then those of each variant with each run left out."""
    found = [fit(VARIANTS[0], "", options.starts, options.steps)]
    for variant in VARIANTS:
        for name in runs():
            found.append(fit(variant, name, options.left_out_starts, options.steps))
            print(f"{variant.name}, without {name}: cost {found[-1].cost:.1f}", flush=True)
    return found


def write(found: Sequence[Fit]) -> None:
    with FITS.open("w", encoding="utf-8", newline="") as file:
        file.write("# What tests/validation/fit_truck.py found, SI: with all runs, and with one left out.\n")
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("variant", "left_out", "cost", *(number.name for number in NUMBERS)))
        for one in found:
            values = (f"{one.values[number.name]:.6g}" for number in NUMBERS)
            writer.writerow((one.variant, one.left_out, f"{one.cost:.3f}", *values))


def read() -> list[Fit]:
    """What was found before."""
    with FITS.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    names = [number.name for number in NUMBERS]
    return [
        Fit(row["variant"], row["left_out"], {n: float(row[n]) for n in names}, float(row["cost"]))
        for row in rows
    ]


def main(arguments: Sequence[str] | None = None) -> int:
    import truck_page

    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--starts", type=int, default=4, help="of the fit to all runs")
    parser.add_argument("--left-out-starts", type=int, default=1, help="of those with a run left out")
    parser.add_argument("--steps", type=int, default=10, help="of each start")
    parser.add_argument("--page", action="store_true", help="fit nothing: the numbers of truck_fits.csv")
    parser.add_argument("--save", action="store_true", help="write numbers, vehicle and page")
    options = parser.parse_args(arguments)

    found = read() if options.page else all_fits(options)
    if options.save:
        write(found)
        found = read()  # as many digits as are kept
    page = truck_page.page(found)
    print(page)
    if options.save:
        found[0].vehicle.save(FITTED)
        truck_page.PAGE.write_text(page, encoding="utf-8", newline="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
