"""A truck's front, fitted to finite-element runs at walls and bollards, and what it then computes of them.

    python tests/validation/fit_truck.py --variants --save

Eleven numbers are fitted to five runs together, then each run is left out in turn. The table has the preset
`cargo_truck` beside: its front and its law know nothing of these runs. --variants does the same with fewer
numbers (no rate sensitivity, a front that is even across): the errors of the runs left out say what they are
worth.

--save writes tests/data/finite_element/fitted_truck.toml and tests/validation/truck.md.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType

import birm3d
import numpy as np
import numpy.typing as npt
from birm3d.filters import cfc
from birm3d.scene_parameters import varied
from scipy.optimize import least_squares
from truck_runs import FITTED, STANDOFF, START, Run, figures, runs, scene, with_loaded_posts

Floats = npt.NDArray[np.float64]

# What the runs' own repeats moved by (shares), and what the load on a post should be met to (N s).
TRAVEL, FORCE, SIDEWAYS, FORWARD = 0.04, 0.05, 8e3, 15e3
# Force curves count little: they have spikes of an engine that one rigid body can not follow. Of the peak.
CURVE, POINTS = 0.25, 8.0
# Where a dent just reaches a stiff part of the front, loads on a post jump. The place of the jump is not to
# be believed: residuals at posts are means over these factors on the reach.
REACHES = (0.95, 1.05)
# Of the differences that derivatives are made of, in the logarithm: wide enough to see over small jumps.
STEP = 0.06
SPREAD = 0.35  # of the logarithm, of further starts about the first
# What is thought before the fit: the starts, each to a factor of two. A number that no run tells stays there.
DOUBT = 0.7  # of the logarithm
LEAST_RATE = 0.003  # s/m; fitted as a logarithm too


@dataclass(frozen=True)
class Number:
    """What is fitted: numbers of the scene that share one value; start and bounds, SI."""

    name: str
    unit: str
    names: tuple[str, ...]
    start: float
    lower: float
    upper: float
    why: str


def stresses(*zones: str, points: Sequence[int]) -> tuple[str, ...]:
    return tuple(f"zone.{zone}.stress[{i}]" for zone in zones for i in points)


_FRONT = ("rails", "bumper_middle", "bumper_end", "engine", "hood")
_SHEET = (
    *stresses("bumper_end", "hood", "fender", points=(1, 2)),
    *stresses("engine", points=(1, 2)),
)
NUMBERS = (
    Number(
        "brackets",
        "Pa",
        stresses("rails", points=(1, 2)),
        1.5e6,
        0.2e6,
        5e6,
        "plates that bend before the rails",
    ),
    Number(
        "rails, squashed",
        "Pa",
        stresses("rails", points=(3, 4)),
        8e6,
        2e6,
        20e6,
        "two sections of 2.7e-3 m2 at 450 to 650 MPa on 0.18 m2: 14 to 20 MPa; less if they buckle first",
    ),
    Number(
        "rails, folding",
        "Pa",
        stresses("rails", points=(5, 6)),
        1e6,
        0.3e6,
        7e6,
        "a twentieth to a third of that",
    ),
    Number(
        "bumper between the rails",
        "Pa",
        stresses("bumper_middle", points=(1, 2)),
        0.3e6,
        0.1e6,
        2e6,
        "a channel of 6 mm that bends",
    ),
    Number(
        "engine",
        "Pa",
        stresses("bumper_middle", "engine", points=(3, 4)),
        1e6,
        0.3e6,
        8e6,
        "accessories of the engine yield at 2 MPa, on a part of the area",
    ),
    Number(
        "behind the engine",
        "Pa",
        stresses("bumper_middle", "engine", points=(5, 6)),
        0.3e6,
        0.1e6,
        4e6,
        "mounts, cross members, cab; less than the engine",
    ),
    Number("sheet", "Pa", _SHEET, 20e3, 10e3, 300e3, "sheet of 1 mm in bending: ten to some hundred kPa"),
    Number(
        "tail",
        "Pa/m",
        tuple(f"zone.{zone}.tail_slope" for zone in _FRONT),
        3e6,
        0.3e6,
        50e6,
        "megapascals within 0.2 to 0.5 m",
    ),
    Number(
        "rate sensitivity",
        "s/m",
        ("vehicle.rate_sensitivity",),
        0.045,
        LEAST_RATE,
        0.08,
        "other finite-element vehicles: 0.05 to 0.07",
    ),
    Number(
        "reach of dents", "m", ("vehicle.dent_reach",), 0.36, 0.15, 1.0, "half to three diameters of a post"
    ),
    Number("tyres", "", ("zone.tire.scale",), 2.5, 0.5, 6.0, "rims and hangers of 75 kN beside the rubber"),
)


@dataclass(frozen=True)
class Variant:
    """A front with fewer numbers: some held, or driven by another one."""

    name: str
    held: Mapping[str, float] = field(default_factory=dict)
    same: Mapping[str, str] = field(default_factory=dict)


VARIANTS = (
    Variant("all numbers"),
    Variant("no rate sensitivity", held=MappingProxyType({"rate sensitivity": 0.0})),
    Variant(
        "front even across",
        same=MappingProxyType(
            {
                "bumper between the rails": "brackets",
                "engine": "rails, squashed",
                "behind the engine": "rails, folding",
            }
        ),
    ),
)


@dataclass(frozen=True)
class Fit:
    """Numbers that were found, by their names, the least cost, and the vehicle."""

    values: Mapping[str, float]
    cost: float
    vehicle: birm3d.Vehicle


def vehicle_with(values: Mapping[str, float], base: birm3d.Vehicle) -> birm3d.Vehicle:
    """The vehicle with the numbers' values, by their names."""
    given = {name: values[number.name] for number in NUMBERS for name in number.names}
    any_scene = scene(base, next(iter(runs().values())))
    return varied(any_scene, given).scene.vehicle


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
        residuals(vehicle.with_dent_reach(vehicle.dent_reach * factor), same)
        for same in dict.fromkeys((run, with_loaded_posts(run)))
        for factor in REACHES
    ]
    return np.asarray(np.concatenate(several) / np.sqrt(len(several)))


def fit(known: Sequence[Run], variant: Variant, starts: int, steps: int, base: birm3d.Vehicle) -> Fit:
    """The numbers of least squares to some runs, the best of several starts."""
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
    return Fit(values(best.x), float(best.cost), vehicle_with(values(best.x), base))


def main(arguments: Sequence[str] | None = None) -> int:
    import truck_page

    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--starts", type=int, default=6, help="of the fit to all runs")
    parser.add_argument(
        "--left-out-starts", type=int, default=2, help="of those with a run left out; 0: none"
    )
    parser.add_argument("--steps", type=int, default=12, help="of each start")
    parser.add_argument("--variants", action="store_true", help="also those with fewer numbers")
    parser.add_argument("--save", action="store_true", help="write the vehicle and the page")
    options = parser.parse_args(arguments)

    base = birm3d.Vehicle.from_file(START)
    every = list(runs().values())
    found = fit(every, VARIANTS[0], options.starts, options.steps, base)
    tables = {"before": truck_page.computed(birm3d.Vehicle.preset("cargo_truck"))}
    tables["after"] = truck_page.computed(found.vehicle)
    left_out: dict[str, list[tuple[Fit, truck_page.Row]]] = {}
    for variant in VARIANTS[: None if options.variants else 1] if options.left_out_starts else ():
        left_out[variant.name] = []
        for run in every:
            others = [other for other in every if other is not run]
            without = fit(others, variant, options.left_out_starts, options.steps, base)
            (row,) = truck_page.computed(without.vehicle, [run])
            left_out[variant.name].append((without, row))
    pitched = truck_page.pitches(lambda bare: vehicle_with(found.values, bare))
    page = truck_page.page(found, NUMBERS, tables, left_out, pitched)
    print(page)
    if options.save:
        found.vehicle.save(FITTED)
        truck_page.PAGE.write_text(page, encoding="utf-8", newline="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
