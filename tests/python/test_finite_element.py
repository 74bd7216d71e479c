"""Vehicles built after finite-element models: mass properties, and what a fit predicts of another speed."""

from __future__ import annotations

import csv
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from birm3d import Vehicle
from birm3d.vehicle.vehicle_file import read_vehicle_file

TESTS = Path(__file__).resolve().parents[1]
DATA = TESTS / "data/finite_element"
PROGRAM = TESTS / "bench/bench_finite_element.py"
SAVED = TESTS / "bench/results/predictions/finite_element.csv"

# Of the finite-element models: kg, m from the front and the ground, kg m2. Ixz is the integral of x z dm.
TABLE = {
    "n": {
        "mass": 4776.4,
        "x": 2.3229,
        "z": 0.4858,
        "Ixx": 2514.0,
        "Iyy": 8644.0,
        "Izz": 8919.0,
        "Ixz": 257.0,
    },
    "s": {"mass": 1173.0, "x": 1.3226, "z": 0.4754, "Ixx": 413.4, "Iyy": 1443.1, "Izz": 1676.8, "Ixz": -42.8},
}


@pytest.mark.parametrize("key", TABLE)
def test_mass_properties(key: str) -> None:
    """0.02 %: the boxes' masses are written to 10 g."""
    vehicle = Vehicle.from_file(DATA / f"finite_element_{key}.toml", mesh_density=0.1)
    inertia = vehicle.inertia
    found = {
        "mass": vehicle.mass,
        "x": float(vehicle.nodes[:, 0].max()),
        "z": vehicle.mass_center_height,
        **dict(zip(("Ixx", "Iyy", "Izz"), np.diag(inertia).tolist(), strict=True)),
        "Ixz": -float(inertia[0, 2]),
    }
    assert found == {name: pytest.approx(value, rel=2e-4) for name, value in TABLE[key].items()}


@pytest.mark.parametrize("key", TABLE)
def test_check_vehicles_are_no_presets(key: str) -> None:
    """Models of structures, not of cars: nobody should pick one from a list."""
    file = read_vehicle_file(DATA / f"finite_element_{key}.toml")
    assert file.name not in Vehicle.presets()
    assert "not a car" in file.description


@pytest.mark.parametrize("run", sorted(DATA.glob("[ns]_*_*.csv")), ids=lambda path: path.stem)
def test_reduced_curves_agree_with_their_scalars(run: Path) -> None:
    """A row a millisecond keeps the peaks: in half of one a 100-Hz oscillation falls by 5 %, most by less."""
    with (DATA / "runs.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    scalars = next(row for row in rows if row["run"] == run.stem)
    _, force, displacement = np.loadtxt(run, delimiter=",", skiprows=5).T
    assert displacement.max() == pytest.approx(float(scalars["crush_m"]), rel=2e-3)
    assert force.max() == pytest.approx(float(scalars["peak_force_N"]), rel=2e-2)


# What the law with the rate of deflection may miss the wall at 30 mph by: travel of the mass centre and
# CFC60 peak force. N: as far as its runs can be believed. S: they can be believed to 0.05 and 0.10, and
# one body does not reach that: at 20 mph its rear stops after 23 ms, its momentum centre, with the
# engine, after 40, and even this fitted run is 0.05 off. 0.15 is what the law reaches.
LIMITS = {"N": (0.10, 0.15), "S": (0.15, 0.15)}

Rows = dict[tuple[str, str, str], dict[str, str]]


@pytest.fixture(scope="module")
def predictions(tmp_path_factory: pytest.TempPathFactory) -> Rows:
    """Rows of the quick program by vehicle, variant and run."""
    file = tmp_path_factory.mktemp("predictions") / "table.csv"
    done = subprocess.run(
        [sys.executable, "-W", "error", PROGRAM, "--quick", "--csv", file],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    assert "Verdict" in done.stdout
    return table(file)


def table(file: Path) -> Rows:
    with file.open(encoding="utf-8") as lines:
        return {(row["vehicle"], row["variant"], row["run"]): row for row in csv.DictReader(lines)}


@pytest.mark.parametrize("vehicle", LIMITS)
def test_prediction_of_another_speed(vehicle: str, predictions: Rows) -> None:
    row = predictions[vehicle, "rate", "wall00_30"]
    assert row["fitted"] == "no"
    crush, force = LIMITS[vehicle]
    assert abs(float(row["crush_error"])) < crush
    assert abs(float(row["peak_force_error"])) < force


@pytest.mark.parametrize("vehicle", LIMITS)
@pytest.mark.parametrize("error", ["crush_error", "peak_force_error", "mean_force_error"])
def test_rate_of_deflection_helps(vehicle: str, error: str, predictions: Rows) -> None:
    base, rate = (
        abs(float(predictions[vehicle, variant, "wall00_30"][error])) for variant in ("base", "rate")
    )
    assert rate < base


def test_committed_table_is_what_the_program_says(predictions: Rows) -> None:
    """A finer mesh and steps: 2 % of head-on travel, 3 % of peak force."""
    saved = table(SAVED)
    for key, row in predictions.items():
        if key[2] != "wall25_30":
            assert float(row["crush_m"]) == pytest.approx(float(saved[key]["crush_m"]), rel=0.02)
            assert float(row["peak_force_N"]) == pytest.approx(float(saved[key]["peak_force_N"]), rel=0.03)
