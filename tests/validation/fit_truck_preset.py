"""Where the front of `cargo_truck` comes from: three stresses fitted to finite-element runs of a truck.

    python tests/validation/fit_truck_preset.py [--mesh-density 0.5]

No force of a real medium truck on a barrier was found. The runs are of a generic truck of the same weight
(truck_runs.py): walls and bollards. Fitted are the constant stress at which rails and engine crush, that of
the bumper's ends, and that of the sheet beside them. Travel and force over 50 ms of all five runs count
equally, and so does the pitch that film shows of a real truck at a wall. Each run is then left out in turn.
"""

from __future__ import annotations

import argparse
import math
import warnings
from collections.abc import Iterable, Mapping

import birm3d
import numpy as np
import numpy.typing as npt
from birm3d import scenes
from birm3d.scene_parameters import varied
from scipy.optimize import least_squares
from truck_page import MARKS, computed
from truck_runs import Run, runs

Floats = npt.NDArray[np.float64]

# Each fitted number and the zones that it scales. The hood is not fitted.
NUMBERS: Mapping[str, tuple[str, ...]] = {
    "rails and engine": ("bumper", "grille"),
    "ends of the bumper": ("bumper_end",),
    "sheet of the fenders": ("fender",),
}
FITTED = ("travel", "force")  # of truck_page.MARKS
PITCH, MARK_OF_PITCH = 27.0, 3.0  # deg, on film, and how well it can be read
MOST = 4.0  # factor on a stress, either way: ends of a bumper and sheets bear something


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


def fit(vehicle: birm3d.Vehicle, against: Iterable[Run]) -> Floats:
    """Factors of the stresses that meet the runs best."""
    chosen = tuple(against)

    def of(logarithms: Floats) -> Floats:
        return residuals(front(vehicle, np.exp(logarithms)), chosen)

    start, most = np.zeros(len(NUMBERS)), math.log(MOST)
    return np.exp(least_squares(of, start, bounds=(-most, most), diff_step=0.03, max_nfev=25).x)


def line(name: str, vehicle: birm3d.Vehicle, run: Run) -> str:
    """One line of a table: what is computed (and what the run has)."""
    (row,) = computed(vehicle, [run])
    travel, force = (row.errors[what] for what in FITTED)
    return (
        f"{name:22s}{row.own.travel:6.2f} ({run.travel:.2f}) {travel:+5.0%}"
        f"{1e-3 * row.own.force_50ms:7.0f} ({1e-3 * run.force_50ms:.0f}) {force:+5.0%}"
        f"{row.own.pitch:7.1f} ({run.pitch:.1f})"
    )


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--mesh-density", type=float, default=0.5, help="relative to the preset's")
    density = parser.parse_args().mesh_density
    warnings.simplefilter("ignore", birm3d.CoarseSkinWarning)

    truck = birm3d.Vehicle.preset("cargo_truck", mesh_density=density)
    every = runs()
    found = fit(truck, every.values())
    print("run                   travel [m]         force over 50 ms [kN]  pitch [deg]")
    print("in the file")
    for name, run in every.items():
        print(line(name, truck, run))
    print("fitted")
    for name, run in every.items():
        print(line(name, front(truck, found), run))
    print("each run left out in turn")
    spread = []
    for name, run in every.items():
        spread.append(fit(truck, [other for key, other in every.items() if key != name]))
        print(line(name, front(truck, spread[-1]), run))

    print("\nstress [MPa]           in the file  fitted  with a run left out")
    for (what, zones), factor, others in zip(NUMBERS.items(), found, np.array(spread).T, strict=True):
        stress = 1e-6 * max(value for depth, value in truck.zones[zones[0]].envelope if depth < 0.5)
        low, high = stress * others.min(), stress * others.max()
        print(f"{what:22s}{stress:12.3f}{stress * factor:8.3f}  {low:.3f} to {high:.3f}")

    pitch = pitch_on_film(front(truck, found))
    print(f"\npitch at a wall at 50 mph: {pitch:.1f} deg, on film {PITCH:.0f}")


if __name__ == "__main__":
    main()
