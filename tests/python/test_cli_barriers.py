"""Barriers on the command line: sizes, loads on elements, and what is refused."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import pytest
from birm3d import Barrier, Foundation, Simulation, Vehicle, units

CAR = ("run", "--vehicle", "passenger_car", "--mesh-density", "0.1", "--speed", "30mph")


@pytest.mark.parametrize(
    ("options", "barrier"),
    [
        (
            "--barrier bollards --count 3 --spacing 1100mm --diameter 12in --height 3ft --rows 2 "
            "--row-spacing 1.5 --row-offset 550mm",
            Barrier.bollards(
                count=3, spacing=1.1, diameter=12 * units.inch, height=3 * units.ft, rows=2, row_spacing=1.5,
                row_offset=0.55,
            ),
        ),
        (
            "--barrier jersey --profile f_shape --height 42in --length 6m --segments 2",
            Barrier.jersey(profile="f_shape", height=42 * units.inch, length=6.0, segments=2),
        ),
        (
            "--barrier jersey --length 6m --segments 2 --free-standing --density 2300",
            Barrier.jersey(length=6.0, segments=2, free_standing=True, density=2300.0),
        ),
        (
            "--barrier rigid_wall --width 4 --height 1.5 --thickness 0.3 --segments 2 --friction 0.1",
            Barrier.rigid_wall(width=4.0, height=1.5, thickness=0.3, segments=2, friction=0.1),
        ),
        (
            "--barrier planter --length 1.5 --width 80cm --height 36in",
            Barrier.planter(length=1.5, width=0.8, height=36 * units.inch),
        ),
        (
            "--barrier bollards --count 3 --wall-thickness 16mm --foundation-moment 60kNm "
            "--foundation-rotation-depth 40cm --foundation-mass 0.5t",
            Barrier.bollards(
                count=3,
                wall_thickness=0.016,
                foundation=Foundation(moment=60e3, rotation_depth=0.4, mass=500.0),
            ),
        ),
    ],
)  # fmt: skip
@pytest.mark.filterwarnings("ignore::birm3d.LeaningPostWarning")
@pytest.mark.filterwarnings("ignore::birm3d.TippingWarning")
def test_the_options_are_the_scene(
    command: Callable[..., int], capsys: pytest.CaptureFixture[str], options: str, barrier: Barrier
) -> None:
    assert command(*CAR, *options.split(), "--angle", "60", "--json") == 0
    outcome: dict[str, Any] = json.loads(capsys.readouterr().out)
    car = Vehicle.preset("passenger_car", mesh_density=0.1)
    result = Simulation(car, barrier, 30 * units.mph, 60.0).run()
    assert outcome["state_hash"] == f"{result.state_hash:016x}"
    touched = [load for load in result.element_loads if load.touched]
    assert [one["name"] for one in outcome["elements"]] == [load.name for load in touched] != []
    for one, load in zip(outcome["elements"], touched, strict=True):
        assert one["peak_force_50ms"] == load.peak_force_50ms
        assert one["peak_overturning_moment_50ms"] == load.peak_overturning_moment_50ms
        assert one["height_at_peak"] == load.height_at_peak


def test_the_table_has_the_posts_that_were_touched(
    command: Callable[..., int], capsys: pytest.CaptureFixture[str]
) -> None:
    assert command(*CAR, "--barrier", "bollards", "--count", "3") == 0
    out = capsys.readouterr().out
    assert "elements of the barrier that were touched" in out
    assert "bollard 2" in out
    assert "whole force" in out
    assert "lateral" in out
    assert command(*CAR) == 0
    assert "elements of the barrier" not in capsys.readouterr().out


def test_yaw_and_roll(command: Callable[..., int], capsys: pytest.CaptureFixture[str]) -> None:
    turned = ("--yaw", "90deg", "--roll", "5", "--barrier", "pole", "--duration", "0.05", "--json")
    assert command(*CAR, *turned) == 0
    outcome = json.loads(capsys.readouterr().out)
    car = Vehicle.preset("passenger_car", mesh_density=0.1)
    result = Simulation(
        car, Barrier.pole(), 30 * units.mph, impact_yaw=90.0, impact_roll=5.0, duration=0.05
    ).run()
    assert outcome["state_hash"] == f"{result.state_hash:016x}"
    assert (outcome["impact_yaw"], outcome["impact_roll"], outcome["overlap"]) == (90.0, 5.0, None)


def test_json_has_the_overlap(command: Callable[..., int], capsys: pytest.CaptureFixture[str]) -> None:
    met = ("--overlap", "0.3", "--overlap-side", "right", "--barrier", "pole", "--duration", "0.05", "--json")
    assert command(*CAR, *met) == 0
    outcome = json.loads(capsys.readouterr().out)
    assert (outcome["overlap"], outcome["overlap_side"]) == (0.3, "right")


@pytest.mark.parametrize(
    ("options", "parts"),
    [
        ("--barrier pole --height 1", ["--height", "rigid_wall", "bollards", "jersey", "not of pole"]),
        ("--barrier jersey --row-offset 1", ["--row-offset", "bollards", "not of jersey"]),
        ("--barrier none --width 3", ["--width", "not of none"]),
        ("--barrier bollards --spacing 0.2", ["spacing", "above the diameter", "0.2"]),
        ("--barrier bollards --count 0", ["count", ">= 1"]),
        ("--barrier jersey --height 5", ["height", "below", "5"]),
        ("--barrier rigid_wall --segments 2", ["segments", "infinite width"]),
        ("--barrier fence", ["--barrier", "fence"]),
        ("--angle 0", ["impact_angle", "no end", "0"]),
        ("--angle 180", ["impact_angle", "no end", "180"]),
    ],
)
def test_what_can_not_be(
    command: Callable[..., int], capsys: pytest.CaptureFixture[str], options: str, parts: list[str]
) -> None:
    assert command(*CAR, *options.split()) == 2
    out, err = capsys.readouterr()
    assert out == ""
    for part in parts:
        assert part in err


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (
            ["--barrier", "jersey", "--foundation-moment", "60 kN m"],
            "--foundation-moment: of bollards",
        ),
        (["--barrier", "bollards", "--foundation-mass", "1t"], "--foundation-moment is missing"),
        (
            ["--barrier", "bollards", "--foundation-moment", "60 kN m"],
            "foundation must be None where",
        ),
        (["--barrier", "bollards", "--foundation-moment", "60 kg"], "moment must be a number with one of"),
    ],
)
def test_foundations_that_can_not_be_are_refused(
    command: Callable[..., int], capsys: pytest.CaptureFixture[str], options: list[str], message: str
) -> None:
    assert command(*CAR, *options) == 2
    assert message in capsys.readouterr().err
