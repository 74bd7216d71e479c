"""A truck's front, fitted to finite-element runs at walls and bollards, and what it then computes of them.

    python tests/validation/fit_truck.py --save           # ten minutes
    python tests/validation/fit_truck.py --page --save    # from the numbers that were found, seconds

Thirteen numbers (truck_front.py) are fitted to five runs together, then each run is left out in turn. The
same is done with fewer numbers, and with a bed that slides: errors of runs left out say what they are worth.
Each fit starts from the middle of what is likely, whatever is left out. The page has the preset `cargo_truck`
beside, from what fit_truck_preset.py saved.

--save writes tests/data/finite_element/truck_fits.csv and fitted_truck.toml, and tests/validation/truck.md.
"""

from __future__ import annotations

import argparse
import csv
import sys
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import birm3d
import numpy as np
import numpy.typing as npt
from scipy.optimize import least_squares
from truck_front import NUMBERS, VARIANTS, Number, Variant, vehicle_with
from truck_residuals import smoothed
from truck_runs import DATA, FITTED, START, Run, runs
from truck_tables import cells, computed

Floats = npt.NDArray[np.float64]

FITS = DATA / "truck_fits.csv"
# Of the differences that derivatives are made of, in the logarithm: wide enough to see over small jumps.
STEP = 0.06
STEP_SCALE = 0.35  # of the logarithm


@dataclass(frozen=True)
class Fit:
    """Numbers that were found, by their names; run that was left out, or none; least cost."""

    variant: str
    left_out: str
    values: Mapping[str, float]
    cost: float

    @property
    def vehicle(self) -> birm3d.Vehicle:
        variant = next(one for one in VARIANTS if one.name == self.variant)
        return _built(variant, self.values)


def _built(variant: Variant, values: Mapping[str, float]) -> birm3d.Vehicle:
    vehicle = vehicle_with(values, birm3d.Vehicle.from_file(START))
    return vehicle.with_sliding_bed() if variant.sliding_bed else vehicle


@dataclass(frozen=True)
class Residuals:
    """Residuals of a variant; those of each run are kept, for fits that leave another one out."""

    variant: Variant
    known: dict[tuple[bytes, str], Floats] = field(default_factory=dict)

    @property
    def free(self) -> list[Number]:
        bound = (*self.variant.held, *self.variant.same)
        return [number for number in NUMBERS if number.name not in bound]

    def values(self, x: Floats) -> dict[str, float]:
        """All numbers by their names; x are logarithms of the free ones."""
        found = {n.name: float(v) for n, v in zip(self.free, np.exp(x), strict=True)}
        found.update(self.variant.held)
        found.update({name: found[other] for name, other in self.variant.same.items()})
        return found

    def of(self, x: Floats, run: Run) -> Floats:
        key = (x.tobytes(), run.name)
        if key not in self.known:
            self.known[key] = smoothed(_built(self.variant, self.values(x)), run)
        return self.known[key]

    def all(self, x: Floats, against: Sequence[Run]) -> Floats:
        """Those of what is likely, then of the runs."""
        likely = [(v - np.log(n.start)) / n.doubt for n, v in zip(self.free, x, strict=True)]
        return np.concatenate([likely, *(self.of(x, run) for run in against)])


def fit(residuals: Residuals, left_out: str, steps: int) -> Fit:
    """The numbers of least squares to all runs but one, from the middle of what is likely."""
    against = [run for name, run in runs().items() if name != left_out]
    found = least_squares(
        lambda x: residuals.all(x, against),
        np.log([number.start for number in residuals.free]),
        bounds=np.log([(number.lower, number.upper) for number in residuals.free]).T,
        diff_step=STEP,
        max_nfev=steps,
        x_scale=STEP_SCALE,
        ftol=3e-3,
        xtol=2e-3,
    )
    return Fit(residuals.variant.name, left_out, residuals.values(found.x), float(found.cost))


def all_fits(options: argparse.Namespace) -> list[Fit]:
    """Of each variant the fit to all runs, then those with each run left out; written as they are found."""
    found = []
    for variant in VARIANTS:
        residuals = Residuals(variant)
        for left_out in ("", *runs()):
            found.append(fit(residuals, left_out, options.steps))
            print(f"{variant.name}, without {left_out or 'none'}: cost {found[-1].cost:.1f}", flush=True)
            if options.save:
                write(found)
            judged = [runs()[left_out]] if left_out else None
            for row in computed(found[-1].vehicle, judged):
                print("   ", *cells(row), sep="  ", flush=True)
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
    parser.add_argument("--steps", type=int, default=10, help="of each fit")
    parser.add_argument("--page", action="store_true", help="fit nothing: the numbers of truck_fits.csv")
    parser.add_argument("--save", action="store_true", help="write numbers, vehicle and page")
    options = parser.parse_args(arguments)
    warnings.simplefilter("ignore", birm3d.CoreContactWarning)  # on the way; the page counts it

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
