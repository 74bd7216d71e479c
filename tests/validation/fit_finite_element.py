"""Fits the skins of the finite-element vehicles to all their given runs, and leaves each run out in turn.

    python tests/validation/fit_finite_element.py n    # writes fitted_n.toml, two tables in results
    python tests/validation/fit_finite_element.py s
    python tests/validation/page.py                    # finite_element.md from the results

Least squares over crush, CFC60 peak force, restitution (head-on), yaw at the end (of the others), lateral
impulse of a post off the centre line, and, with half their weight, the CFC60 force over time. A residual of
2 is an error as large as the mark (crush 10 %, force 15 % for N; 5 % and 10 % for S; yaw 5 degrees). What no
run tells stays near what finite_element_skin.py expects. Every fit starts from there, and from values drawn
about it: no fit knows of another one. The start that meets the runs of the fit best is kept.

"before" is the law of tests/bench/bench_finite_element.py: five stresses of one even front and the rate of
deflection, fitted to walls at 20 and 40 mph, with an indentation length of 0.5 m.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "bench"))

import bench_finite_element as bench
import birm3d
from comparison import write_rows
from finite_element import VEHICLES, Run, runs
from finite_element_fit import Fit, Prediction, fit, predicted
from finite_element_skin import DATA, SKINS, Skin, changed, vehicle_with

RESULTS = Path(__file__).parent / "results"
BEFORE_REACH = 0.5  # m


@dataclass(frozen=True)
class Row:
    """A run beside its prediction; what: "before", "fitted" or "left out"."""

    vehicle: str
    run: str
    what: str
    crush: float
    crush_measured: float
    peak_force: float
    peak_force_measured: float
    yaw: float
    yaw_measured: float
    lateral: float  # over the impulse along the normal
    lateral_measured: float
    restitution: float
    restitution_measured: float
    closed: float

    @classmethod
    def of(cls, run: Run, what: str, found: Prediction) -> Row:
        return cls(
            run.vehicle.key.upper(),
            run.name.split("_", 1)[1],
            what,
            found.crush,
            run.crush,
            found.peak_force,
            run.peak_force,
            found.yaw,
            run.yaw,
            found.lateral_impulse / run.normal_impulse,
            run.lateral_impulse / run.normal_impulse,
            found.restitution,
            run.restitution,
            found.closed,
        )


@dataclass(frozen=True)
class Number:
    """A number of a skin.

    value is by the fit to all runs, its standard deviation is in widths of what is expected. expected_low and
    expected_high are one width away. low and high are of all fits, with a run left out or not.
    """

    vehicle: str
    name: str
    unit: str
    expected: float
    expected_low: float
    expected_high: float
    value: float
    deviation: float
    low: float
    high: float


def before(key: str) -> birm3d.Vehicle:
    """The vehicle with the law that tests/bench fits."""
    options = argparse.Namespace(mesh_density=0.36, skin=None, starts=2, tolerance=1e-4, jobs=1)
    rate = next(variant for variant in bench.VARIANTS if variant.name == "rate")
    return bench.fit(VEHICLES[key], rate, options).vehicle.with_indentation_length(BEFORE_REACH)


def fit_text(numbers: Sequence[Number], known: Sequence[Run]) -> str:
    """What was fitted to what, and between which values a number goes when each run is left out in turn."""
    names = ", ".join(run.name.split("_", 1)[1] for run in known)
    values = "; ".join(f"{n.name} {n.value:.3g} ({n.low:.3g} to {n.high:.3g}) {n.unit}" for n in numbers)
    return (
        f"Fitted by tests/validation/fit_finite_element.py to the runs {names} together. In brackets: least "
        f"and greatest value with all runs, and when each run is left out in turn. {values}"
    )


def numbers_of(skin: Skin, found: Fit, without: Sequence[Fit]) -> list[Number]:
    """The numbers of a fit to all runs, beside those without a run."""
    value = skin.values(found.shares)
    each = [value, *(skin.values(other.shares) for other in without)]
    return [
        Number(
            skin.key.upper(),
            u.name,
            u.unit,
            u.expected,
            u.shift(-1.0),
            u.shift(1.0),
            value[u.name],
            float(found.deviation[i]),
            min(values[u.name] for values in each),
            max(values[u.name] for values in each),
        )
        for i, u in enumerate(skin.unknowns)
    ]


def known_runs(key: str) -> list[Run]:
    return [run for run in runs().values() if run.vehicle is VEHICLES[key]]


def fit_without(key: str, left_out: str | None, steps: int, starts: int) -> Fit:
    """The fit of a vehicle to all its runs but one."""
    known = [run for run in known_runs(key) if run.name != left_out]
    found = fit(SKINS[key], known, steps, starts)
    print(f"{key.upper()} without {left_out}: half of the sum of squares {found.cost:.2f}", flush=True)
    return found


def fitted(key: str, steps: int, starts: int, jobs: int) -> tuple[list[Row], list[Number]]:
    """Fit a vehicle, save it, and return the rows of its tables."""
    skin, known = SKINS[key], known_runs(key)
    names = [None, *(run.name for run in known)]
    with ProcessPoolExecutor(jobs) as pool:
        many = len(names)
        found, *without = pool.map(fit_without, [key] * many, names, [steps] * many, [starts] * many)
    numbers = numbers_of(skin, found, without)
    saved = vehicle_with(skin, skin.values(found.shares), fit_text(numbers, known))
    saved.save(DATA / f"fitted_{key}.toml")
    old = before(key)
    rows = [Row.of(run, "before", predicted(old, run)[0]) for run in known]
    rows += [Row.of(run, "fitted", predicted(saved, run)[0]) for run in known]
    for run, others in zip(known, without, strict=True):
        vehicle = changed(saved, skin, skin.values(others.shares))
        rows.append(Row.of(run, "left out", predicted(vehicle, run)[0]))
    return rows, numbers


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("vehicle", choices=sorted(SKINS), help="which")
    parser.add_argument("--steps", type=int, default=12, help="most of a fit")
    parser.add_argument("--starts", type=int, default=2, help="of a fit")
    parser.add_argument("--jobs", type=int, default=1, help="processes")
    options = parser.parse_args(arguments)
    rows, numbers = fitted(options.vehicle, options.steps, options.starts, options.jobs)
    write_rows(RESULTS / f"finite_element_{options.vehicle}.csv", rows)
    write_rows(RESULTS / f"finite_element_{options.vehicle}_numbers.csv", numbers)
    return 0


if __name__ == "__main__":
    sys.exit(main())
