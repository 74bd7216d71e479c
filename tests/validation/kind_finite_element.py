"""Finite-element runs of two vehicles, N and S: walls head-on and at 25 degrees, poles."""

from __future__ import annotations

from collections.abc import Sequence

import birm3d
from comparison import RESULTS, Row, about
from finite_element import DATA, VEHICLES, Run, runs
from finite_element_fit import predicted
from page import YAW_MARK, rows_of

NAME = "finite_element"
TITLE = "Finite-element vehicles N and S: walls, oblique walls, poles"
TEXT = """Vehicles: `tests/data/finite_element/fitted_n.toml` and `fitted_s.toml`, fitted to all runs
together; rows "left out" are fits without the run of the row, as [their page](finite_element.md) has them.
A run's name says the vehicle (n or s), the barrier, its angle and the speed in mph: `n_wall25_30` is a wall
at 25 degrees from head-on, `n_pole350_30` a pole 0.35 m right of the middle.
Marks: crush 10 % (N) or 5 % (S), force 15 % or 10 %, yaw 5 degrees, what repeats of a run differ by.

What the model can not do here: a truss has no force from its neighbours. So the far half of a bumper answers
a wall at 25 degrees with the peak of one that is met flush, and N turns too far. Buckling that
chooses a side (wall at 40 mph) has no counterpart."""


def tasks() -> Sequence[str]:
    """Names of the runs, then the fits with a run left out."""
    return [*runs(), *(f"left out {key}" for key in VEHICLES)]


def rows(task: str) -> list[Row]:
    """What one task is compared in."""
    if task.startswith("left out"):
        return _left_out(task.split()[-1])
    run = runs()[task]
    vehicle = birm3d.Vehicle.from_file(DATA / f"fitted_{task[0]}.toml")
    found, _ = predicted(vehicle, run)
    return _rows(run, found.crush, found.peak_force, found.yaw, "fitted")


def _left_out(key: str) -> list[Row]:
    assert RESULTS.exists()
    found = []
    for row in rows_of(key):
        if row["what"] == "left out":
            run = runs()[f"{key}_{row['run']}"]
            crush, force, yaw = (float(row[name]) for name in ("crush", "peak_force", "yaw"))
            found += _rows(run, crush, force, yaw, "left out")
    return found


def _rows(run: Run, crush: float, force: float, yaw: float, role: str) -> list[Row]:
    vehicle = run.vehicle
    told, who = run.name, f"fitted_{vehicle.key}"
    return [
        Row(told, who, "travel", "m", run.crush, *about(run.crush, vehicle.crush_trust), crush, role),
        Row(
            told,
            who,
            "peak force CFC60",
            "N",
            run.peak_force,
            *about(run.peak_force, vehicle.force_trust),
            force,
            role,
        ),
        Row(told, who, "yaw", "deg", run.yaw, run.yaw - YAW_MARK, run.yaw + YAW_MARK, yaw, role),
    ]
