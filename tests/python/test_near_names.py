"""Errors of names say which name was most likely meant."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import birm3d
import pytest
from birm3d import Barrier, Simulation, Vehicle
from birm3d.base.near_names import did_you_mean
from birm3d.cli.commands import _cli
from click.testing import CliRunner


def crash() -> Simulation:
    return Simulation(Vehicle.preset("passenger_car", mesh_density=0.1), Barrier.jersey(), 15.0, 20.0)


@pytest.mark.parametrize(
    ("make", "meant"),
    [
        (lambda: Vehicle.preset("sedan"), r"got 'sedan', did you mean 'sedan_1500'\?"),
        (lambda: Vehicle.preset("Passenger car"), r"did you mean 'passenger_car'\?"),
        (lambda: birm3d.rate(crash().run(), "IWA 14"), r"got 'IWA 14', did you mean 'IWA 14-1'\? Levels"),
        (lambda: birm3d.rate(crash().run(), "ASTM"), r"did you mean 'ASTM F2656' or 'ASTM F2656-07'\?"),
        (lambda: birm3d.rate(crash().run(), "xyz"), r"got 'xyz'\. Levels"),
        (lambda: birm3d.sweep(crash(), angle=[10.0]), r"\(near: impact_angle\)"),
        (
            lambda: birm3d.sweep(crash(), impact_angle=[10.0], progress=False).plot("angle", "delta_v"),
            r"got 'angle', did you mean 'impact_angle' or 'exit_angle'\?",
        ),
    ],
)
def test_an_error_says_what_was_meant(make: Callable[[], Any], meant: str) -> None:
    with pytest.raises(ValueError, match=meant):
        make()


@pytest.mark.parametrize(("name", "meant"), [("wall", "rigid_wall"), ("bollard", "bollards")])
def test_the_command_line_says_which_barrier_was_meant(name: str, meant: str) -> None:
    run = CliRunner().invoke(_cli, ["run", "--vehicle", "pickup", "--speed", "50mph", "--barrier", name])
    assert run.exit_code == 2
    assert f"Did you mean '{meant}'?" in " ".join(run.output.split())


def test_nothing_is_guessed_of_a_name_that_is_near_none() -> None:
    assert did_you_mean("xyz", ["pole", "jersey"]) == did_you_mean("", ["pole"]) == ""
