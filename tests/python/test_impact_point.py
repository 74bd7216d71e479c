"""The critical impact point against a scene whose worst point is known."""

from __future__ import annotations

import math
from typing import Any

import birm3d
import numpy as np
import pytest
from birm3d import Barrier, Settings, Simulation, scenes

SEDAN = scenes.nhtsa_10146(mesh_density=0.1)


@pytest.fixture(scope="module")
def glancing() -> Simulation:
    """A body without size that slides along a frictionless wall: its normal speed is v sin(angle)."""
    vehicle = birm3d.Vehicle.from_arrays(
        mass=1000.0,
        inertia=1000.0 * np.eye(3),
        nodes=[[1e-3, 0.0, 0.0]],
        anchors=[[0.0, 0.0, 0.0]],
        k_initial=3e9,
        k_unloading=3e9,
    )
    settings = Settings(gravity=0.0, ground=False)
    return Simulation(vehicle, Barrier.rigid_wall(friction=0.0), 0.5, 60.0, settings=settings, duration=0.02)


def test_the_worst_angle_of_an_impulse_is_head_on(glancing: Simulation) -> None:
    """The change of velocity is greatest where v sin(angle) is: at 90 degrees, which is not on the grid."""
    worst = birm3d.critical_impact_point(glancing, "delta_v", {"impact_angle": (31.0, 161.0)}, points=7)
    assert worst.point["impact_angle"] == pytest.approx(90.0, abs=3.0)  # 1 - sin is 1e-3 there
    assert worst.value == pytest.approx(1.0, rel=2e-3)
    assert worst.at_bound == worst.no_effect == ()
    assert worst.value == max(worst.grid["delta_v"].max(), worst.refinement["delta_v"].max())
    assert worst.value > worst.grid["delta_v"].max()


def test_along_an_endless_wall_the_offset_has_no_effect() -> None:
    ranges = {"impact_offset": (-1.0, 2.0), "impact_angle": (30.0, 90.0)}
    worst = birm3d.critical_impact_point(SEDAN, "dynamic_crush", ranges, points=5)
    assert worst.no_effect == ("impact_offset",)
    assert worst.effect["impact_offset"] < worst.tolerance == SEDAN.scene.settings.tolerance
    assert worst.effect["impact_angle"] > 0.3
    assert worst.point["impact_offset"] == 0.0  # the scene's own
    assert "impact_offset = 0 m, no effect" in repr(worst)
    assert len(worst.grid) == 25
    again = birm3d.critical_impact_point(SEDAN, "dynamic_crush", ranges, points=5)
    assert (again.value, again.point) == (worst.value, worst.point)


def test_a_best_value_at_a_bound_is_told() -> None:
    worst = birm3d.critical_impact_point(SEDAN, "delta_v", {"impact_speed": (5.0, 9.0)}, points=3)
    assert worst.point == {"impact_speed": 9.0}
    assert worst.at_bound == ("impact_speed",)
    least = birm3d.critical_impact_point(
        SEDAN, "delta_v", {"impact_speed": (5.0, 9.0)}, points=3, minimize=True
    )
    assert least.point == {"impact_speed": 5.0}
    assert least.value < worst.value
    assert "at its bound" in repr(least)


def test_nothing_has_an_effect() -> None:
    offset = birm3d.critical_impact_point(SEDAN, "dynamic_crush", {"impact_offset": (1.0, 2.0)}, points=3)
    assert offset.no_effect == ("impact_offset",)
    assert offset.point == {"impact_offset": 1.0}  # the nearest to the scene's own
    assert offset.at_bound == ()


def test_runs_that_fail_are_never_the_best(glancing: Simulation) -> None:
    worst = birm3d.critical_impact_point(glancing, "delta_v", {"impact_angle": (60.0, 260.0)}, points=11)
    assert worst.grid.failed
    assert worst.point["impact_angle"] == pytest.approx(90.0, abs=3.0)
    assert worst.effect["impact_angle"] > 0.1


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"ranges": {}}, "ranges must name at least one"),
        ({"ranges": {"offset": (0.0, 1.0)}}, "got 'offset'"),
        ({"ranges": {"impact_offset": (1.0, 1.0)}}, r"ranges\['impact_offset'\] must be.*\(1.0, 1.0\)"),
        ({"ranges": {"impact_offset": (0.0, math.inf)}}, "finite and increasing"),
        ({"metric": "crush"}, "metrics must be among.*'crush'"),
        ({"points": 2}, "points must be an integer >= 3, got 2"),
        ({"max_runs": 0}, "max_runs must be an integer >= 1, got 0"),
        ({"tolerance": 0.0}, "tolerance must be between 0 and 1, got 0.0"),
        ({"ranges": {"impact_angle": (200.0, 210.0)}}, "'delta_v': ValueError: impact_angle"),
    ],
)
def test_bad_input_names_argument_and_value(arguments: dict[str, Any], words: str) -> None:
    given = {"metric": "delta_v", "ranges": {"impact_offset": (0.0, 1.0)}, "points": 3, **arguments}
    with pytest.raises(ValueError, match=words):
        birm3d.critical_impact_point(SEDAN, **given)
