"""Where the front of `cargo_truck` comes from: three stresses fitted to finite-element runs of a truck.

    python tests/validation/fit_truck_preset.py --save    # some minutes

No force of a real medium truck on a barrier was found. The runs are of a generic truck of the same weight
(truck_runs.py): walls and bollards. Fitted are the constant stress at which rails and engine crush, that of
the bumper's ends, and that of the sheet beside them. Travel and force over 50 ms of all five runs count
equally, and so does the pitch that film shows of a real truck at a wall. Each run is then left out in turn.
The preset's file stays as it is: what is found says how far its numbers can be trusted. What it resists
where the engine jams (zones bumper_middle and grille_middle, beyond 1.3 m) goes with the stress of rails and
engine.

--save writes tests/data/finite_element/truck_preset_fits.csv. `fit_truck.py --page --save` makes the page.
"""

from __future__ import annotations

import argparse
import csv
import dataclasses
import math
import warnings
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import birm3d
import numpy as np
import numpy.typing as npt
from birm3d import scenes
from birm3d.simulation.parameters import varied
from scipy.optimize import least_squares
from truck_runs import DATA, Run, runs
from truck_tables import MARKS, computed

Floats = npt.NDArray[np.float64]

FITS = DATA / "truck_preset_fits.csv"
# Each fitted number and the zones that it scales. The hood is not fitted.
NUMBERS: Mapping[str, tuple[str, ...]] = {
    "rails and engine": ("bumper", "bumper_middle", "grille", "grille_middle"),
    "ends of the bumper": ("bumper_end",),
    "sheet of the fenders": ("fender",),
}
FITTED = ("travel", "force")  # of truck_tables.MARKS
PITCH, MARK_OF_PITCH = 27.0, 3.0  # deg, on film, and how well it can be read
# Where the fit starts, of the file's stresses. For the ends of the bumper, 0.42 MPa were the first estimate.
FIRST = (1.0, 4.0, 1.0)
MOST = 4.0  # factor on that, either way: ends of a bumper and sheets bear something

# The stresses before any run was seen: those of a pickup's front (tests 7360 and 7582) at the same share of
# its length. All of the bumper has them; the grille 1.5 % of the force; the fender an order of magnitude.
RULE = (
    (0.0, 0.0),
    (0.172, 0.6609e6),
    (0.225, 0.6609e6),
    (0.462, 2.8767e6),
    (0.529, 2.8767e6),
    (1.097, 0.9485e6),
    (1.255, 0.9485e6),
    (1.454, 1.5550e6),
    (1.652, 3.6930e6),
)
RULE_TAIL = {"tail_depth": 1.586, "tail_slope": 26.48e6}
GRILLE = 0.0065  # of the bumper's stress
FENDER = 12.0  # of the file's stress of today


@dataclass(frozen=True)
class PresetFit:
    """Factors on the file's stresses, by the names of NUMBERS; run that was left out, or none."""

    left_out: str
    factors: tuple[float, ...]

    def vehicle(self, preset: birm3d.Vehicle) -> birm3d.Vehicle:
        return front(preset, self.factors)


def by_rule(vehicle: birm3d.Vehicle) -> birm3d.Vehicle:
    """The preset with the stresses that it had before the runs; recovery and friction as today."""
    zones, steep = vehicle.zones, vehicle.zones["bumper"].k_unloading
    law = {"envelope": RULE, "k_unloading": steep, **RULE_TAIL}
    bumper = {
        name: dataclasses.replace(zones[name], **law) for name in ("bumper_middle", "bumper", "bumper_end")
    }
    grille = dict.fromkeys(("grille_middle", "grille"), bumper["bumper"].scaled(GRILLE))
    return vehicle.with_zones({**bumper, **grille, "fender": zones["fender"].scaled(FENDER)})


def front(vehicle: birm3d.Vehicle, factors: Iterable[float]) -> birm3d.Vehicle:
    """The truck with its stresses times one factor for each of NUMBERS."""
    zones = {
        zone: vehicle.zones[zone].scaled(factor)
        for names, factor in zip(NUMBERS.values(), factors, strict=True)
        for zone in names
    }
    return vehicle.with_zones(zones)


def pitch_on_film(vehicle: birm3d.Vehicle) -> float:
    """Greatest pitch at a wall at 50 mph [deg]."""
    film = scenes.truck_at_wall()
    return varied(film, {"vehicle": vehicle}).run().metrics["max_pitch"]


def residuals(vehicle: birm3d.Vehicle, against: Iterable[Run]) -> Floats:
    """Errors over their marks."""
    rows = computed(vehicle, list(against))
    errors = [row.errors[name] / MARKS[name] for row in rows for name in FITTED]
    return np.array([*errors, (pitch_on_film(vehicle) - PITCH) / MARK_OF_PITCH])


def fit(vehicle: birm3d.Vehicle, left_out: str) -> PresetFit:
    """Factors of the stresses that meet all other runs best."""
    known = tuple(run for name, run in runs().items() if name != left_out)

    def of(logarithms: Floats) -> Floats:
        return residuals(front(vehicle, np.exp(logarithms)), known)

    start, most = np.log(FIRST), math.log(MOST)
    found = least_squares(of, start, bounds=(start - most, start + most), diff_step=0.03, max_nfev=25)
    return PresetFit(left_out, tuple(np.exp(found.x).tolist()))


def write(found: Sequence[PresetFit]) -> None:
    with FITS.open("w", encoding="utf-8", newline="") as file:
        file.write(
            "# What tests/validation/fit_truck_preset.py found: factors on the stresses of the file.\n"
        )
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("left_out", *NUMBERS))
        for one in found:
            writer.writerow((one.left_out, *(f"{factor:.6g}" for factor in one.factors)))


def read() -> list[PresetFit]:
    """What was found before: with all runs, then with each run left out."""
    with FITS.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    return [PresetFit(row["left_out"], tuple(float(row[name]) for name in NUMBERS)) for row in rows]


def stress(vehicle: birm3d.Vehicle, number: str) -> float:
    """Stress of a number's first zone up to a depth of 0.5 m, greatest [Pa]."""
    envelope = vehicle.zones[NUMBERS[number][0]].envelope
    assert envelope is not None  # of all zones of NUMBERS
    return max(value for depth, value in envelope if depth < 0.5)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--save", action="store_true", help="write what was found")
    options = parser.parse_args()
    warnings.simplefilter("ignore", birm3d.CoarseSkinWarning)

    preset = birm3d.Vehicle.preset("cargo_truck")
    found = []
    for left_out in ("", *runs()):
        found.append(fit(preset, left_out))
        known = {
            name: f"{1e-6 * stress(preset, name) * factor:.3f} MPa"
            for name, factor in zip(NUMBERS, found[-1].factors, strict=True)
        }
        print(f"without {left_out or 'none'}: {known}", flush=True)
    print(
        f"pitch at a wall at 50 mph: {pitch_on_film(found[0].vehicle(preset)):.1f} deg, on film {PITCH:.0f}"
    )
    if options.save:
        write(found)


if __name__ == "__main__":
    main()
