"""What a few numbers fitted to two crashes predict of others: finite-element runs of two vehicles.

    python tests/bench/bench_finite_element.py [--quick] [--vehicles n,s] [--save] [--csv FILE]

Vehicles N (4.8 t, soft) and S (1.2 t, stiff) are finite-element models, run for this project;
finite_element.py says how far their runs can be believed. The front's envelope, five stresses at set depths,
is fitted to the wall at 20 and 40 mph together; wall 30 and the wall at 25 degrees from head-on are
predicted, and the pole with skins whose indentations are of different lengths, each also with
4 times the elements. Then the same with the rate of deflection in the envelope. Rows that were fitted are
marked. Errors are of the mass centre's travel along the barrier's normal, of the CFC60 peak force, and of the
mean force up to the greatest travel.
"""

from __future__ import annotations

import argparse
import csv
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import birm3d
from birm3d.calibration import CalibrationResult, Parameter
from finite_element import (
    VEHICLES,
    CheckVehicle,
    Run,
    check_vehicle,
    figures,
    mass_mismatch,
    runs,
    scene,
    targets,
)

RESULTS = Path(__file__).parent / "results/predictions/finite_element.csv"
STRESS = (0.02e6, 4e6)  # Pa
RATE = Parameter("vehicle.rate_sensitivity", 0.0, 0.2, start=0.03)
WALLS = ("wall00_20", "wall00_40")
# tests/validation fits and leaves out these and the others.
COMPARED = ("pole000_30", "wall00_20", "wall00_30", "wall00_40", "wall25_30")
FINER = 4.0
REACHES = (0.0, 0.5, 0.65, 0.8)  # m
ERRORS = ("crush_error", "peak_force_error", "mean_force_error")


@dataclass(frozen=True)
class Variant:
    """A law of the skin: what is fitted beside the front's stresses, and to which runs."""

    name: str
    extra: tuple[Parameter, ...]
    fitted: tuple[str, ...]


VARIANTS = (
    Variant("base", (), WALLS),
    Variant("rate", (RATE,), WALLS),
)


@dataclass(frozen=True)
class Row:
    """One run computed with one variant; errors relative to the finite-element run."""

    vehicle: str
    variant: str
    run: str
    fitted: bool
    crush: float
    peak_force: float
    mean_force: float
    crush_error: float
    peak_force_error: float
    mean_force_error: float


def runs_of(vehicle: CheckVehicle) -> list[Run]:
    own = (run for run in runs().values() if run.vehicle is vehicle)
    return [run for run in own if run.name.split("_", 1)[1] in COMPARED]


def fit(vehicle: CheckVehicle, variant: Variant, options: argparse.Namespace) -> CalibrationResult:
    start = check_vehicle(vehicle.key, options.mesh_density)
    if options.skin is not None:
        knee = start.zones["skin"].knee
        assert knee is not None  # the file has one
        start = start.with_zone("skin", k_initial=options.skin / knee, f_max=options.skin)
    envelope = start.zones["front"].envelope
    assert envelope is not None
    unknowns = [
        Parameter(f"zone.front.stress[{i}]", *STRESS, log=True, name=f"stress at {depth:.3f} m [Pa]")
        for i, (depth, _) in enumerate(envelope)
        if i
    ]
    known = [runs()[f"{vehicle.key}_{name}"] for name in variant.fitted]
    return birm3d.calibrate(
        [scene(start, run) for run in known],
        [targets(run) for run in known],
        [*unknowns, *variant.extra],
        starts=options.starts,
        tolerance=options.tolerance,
        jobs=options.jobs,
    )


def predicted(
    vehicle: CheckVehicle, variant: Variant, fitted: birm3d.Vehicle, chosen: Sequence[Run]
) -> list[Row]:
    """Rows of all runs; of the pole with several indentation lengths, each with FINER times the elements."""
    rows = []
    for run in chosen:
        name = run.name.split("_", 1)[1]
        if run.barrier != "pole":
            rows.append(compared(vehicle, variant, fitted, run, name, name in variant.fitted))
            continue
        for reach in REACHES:
            indented = fitted.with_indentation_length(reach)
            finer = indented.with_mesh_density(FINER * fitted.mesh_density)
            rows.append(compared(vehicle, variant, indented, run, f"{name}, reach {reach:g}", False))
            rows.append(compared(vehicle, variant, finer, run, f"{name}, reach {reach:g}, fine", False))
    return rows


def compared(
    vehicle: CheckVehicle, variant: Variant, fitted: birm3d.Vehicle, run: Run, name: str, known: bool
) -> Row:
    own = figures(scene(fitted, run).run())
    numbers = (own.crush, own.peak_force, own.mean_force, *own.errors(run))
    return Row(vehicle.key.upper(), variant.name, name, known, *numbers)


def print_mass(vehicle: CheckVehicle) -> None:
    mismatch = mass_mismatch(check_vehicle(vehicle.key, 0.1), vehicle.key)
    print(f"\nvehicle {vehicle.key.upper()}: solids against the model's mass properties")
    print("  " + ", ".join(f"{name} {100 * value:+.4f} %" for name, value in mismatch.items()))
    print(
        f"  its runs can be believed to {100 * vehicle.crush_trust:g} % in crush and "
        f"{100 * vehicle.force_trust:g} % in peak force"
    )


def print_table(rows: Sequence[Row]) -> None:
    head = ("vehicle", "law", "run", "", "crush", "error", "peak force", "error", "mean force", "error")
    widths = (9, 8, 30, 8, 9, 9, 12, 9, 12, 9)
    print(
        "".join(
            f"{cell:<{w}}" if i < 4 else f"{cell:>{w}}"
            for i, (cell, w) in enumerate(zip(head, widths, strict=True))
        )
    )
    for row in rows:
        print(
            f"{row.vehicle:9s}{row.variant:8s}{row.run:30s}{'fitted' if row.fitted else '':8s}"
            f"{row.crush:7.3f} m{100 * row.crush_error:+8.1f}%{1e-3 * row.peak_force:9.0f} kN"
            f"{100 * row.peak_force_error:+8.1f}%{1e-3 * row.mean_force:9.0f} kN"
            f"{100 * row.mean_force_error:+8.1f}%"
        )


def write(path: Path, rows: Sequence[Row]) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(
            ("vehicle", "variant", "run", "fitted", "crush_m", "peak_force_N", "mean_force_N", *ERRORS)
        )
        for row in rows:
            told = [row.vehicle, row.variant, row.run, "yes" if row.fitted else "no"]
            values = [f"{row.crush:.4f}", f"{row.peak_force:.0f}", f"{row.mean_force:.0f}"]
            errors = [f"{e:.3f}" for e in (row.crush_error, row.peak_force_error, row.mean_force_error)]
            writer.writerow([*told, *values, *errors])


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--quick", action="store_true", help="without poles; one start, coarse mesh")
    parser.add_argument("--vehicles", default="n,s", help="which, by their letters")
    parser.add_argument("--variants", help="which, by their names, with semicolons between")
    parser.add_argument("--starts", type=int, default=2)
    parser.add_argument("--mesh-density", type=float, default=0.36, help="relative to the vehicle files'")
    parser.add_argument("--skin", type=float, help="another stress of the panels beside the front [Pa]")
    parser.add_argument("--tolerance", type=float, default=1e-4, help="of the steps while fitting")
    parser.add_argument("--jobs", type=int, help="threads; one a processor unless given")
    parser.add_argument("--csv", type=Path, help="also write the table there")
    parser.add_argument("--save", action="store_true", help="also write tests/bench/results/predictions")
    options = parser.parse_args(arguments)
    if options.quick:
        options.starts, options.mesh_density, options.tolerance = 1, 0.1, 1e-3
    variants = VARIANTS
    if options.variants:
        variants = tuple(variant for variant in VARIANTS if variant.name in options.variants.split(";"))
    if not variants:
        known = "; ".join(variant.name for variant in VARIANTS)
        parser.error(f"--variants must be some of {known}; got {options.variants!r}")
    keys = options.vehicles.split(",")
    if not set(keys) <= set(VEHICLES):
        parser.error(f"--vehicles must be some of {','.join(VEHICLES)}; got {options.vehicles!r}")

    table = []
    for key in keys:
        vehicle = VEHICLES[key]
        print_mass(vehicle)
        for variant in variants:
            start = time.perf_counter()
            found = fit(vehicle, variant, options)
            seconds = time.perf_counter() - start
            print(f"\n{key.upper()}, {variant.name}: fitted to {', '.join(variant.fitted)}, {seconds:.1f} s")
            print(found.summary())
            chosen = [run for run in runs_of(vehicle) if not (options.quick and run.barrier == "pole")]
            table += predicted(vehicle, variant, found.vehicle, chosen)
    print()
    print_table(table)
    for path in [options.csv] * bool(options.csv) + [RESULTS] * options.save:
        write(path, table)
    return 0


if __name__ == "__main__":
    sys.exit(main())
