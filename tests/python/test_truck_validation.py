"""The truck of the finite-element runs: its mass, and what its fitted front computes of two of them."""

from __future__ import annotations

import dataclasses
import importlib
from pathlib import Path
from types import ModuleType

import birm3d
import numpy as np
import pytest

VALIDATION = Path(__file__).resolve().parents[1] / "validation"


@pytest.fixture
def truck(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    monkeypatch.syspath_prepend(str(VALIDATION))
    return importlib.import_module("truck_runs")


@pytest.fixture
def page(truck: ModuleType) -> ModuleType:
    return importlib.import_module("truck_tables")


def test_solids_meet_the_models_mass_properties(truck: ModuleType) -> None:
    vehicle = birm3d.Vehicle.from_file(truck.START)
    front = float(vehicle.nodes[:, 0].max())
    assert vehicle.mass == pytest.approx(truck.MASS["mass"], rel=1e-3)
    assert front == pytest.approx(truck.MASS["x"], rel=1e-3)
    assert vehicle.mass_center_height == pytest.approx(truck.MASS["z"], rel=1e-3)
    found = (*np.diag(vehicle.inertia), vehicle.inertia[0, 2])
    assert found == pytest.approx(tuple(truck.INERTIA.values()), rel=1e-3)


def test_impulses_of_the_runs_are_their_change_of_momentum(truck: ModuleType) -> None:
    """Signs and order of the posts: what they take is what the truck loses."""
    for run in truck.runs().values():
        if run.impact_angle == 90.0:
            lost = truck.MASS["mass"] * (run.speed - run.speed_at_end)
            assert run.impulse[:, 0].sum() == pytest.approx(lost, rel=1e-2)  # the runs close so far
        assert run.time[0] == 0.0
        assert run.displacement.max() == pytest.approx(run.travel, abs=1e-2)
    assert truck.runs()["bollards2_50_offset"].posts == (-0.8, 0.4)


# What one rigid body can not meet is said in truck.md. It is the last jam of the row of three, and the frame
# that bends between two posts.
@pytest.mark.parametrize(
    ("name", "marks"),
    [
        ("wall00_30", ("travel", "force", "pitch")),
        ("wall00_50", ("travel", "force", "pitch")),
        ("wall25_50", ("travel", "force", "pitch")),
        # Pitch is 5.5 and 5.3 deg less than the runs', for a mark of 5.
        ("bollards3_50", ("travel", "force", "sideways")),
        ("bollards2_50_offset", ("travel", "force")),
    ],
)
def test_the_fitted_truck_meets_the_runs(
    page: ModuleType, truck: ModuleType, name: str, marks: tuple[str, ...]
) -> None:
    fitted = birm3d.Vehicle.from_file(truck.FITTED)
    (row,) = page.computed(fitted, [truck.runs()[name]])
    for mark in marks:
        assert row.met[mark], row.errors
    assert not row.own.core_contact
    (preset,) = page.computed(birm3d.Vehicle.preset("cargo_truck"), [truck.runs()[name]])
    assert preset.met["force"]
    # Computed: 17.4 % short along the slanted wall.
    assert abs(preset.own.travel / truck.runs()[name].travel - 1.0) < 0.18


def test_either_front_wheels_or_friction_hold_the_nose_up(page: ModuleType, truck: ModuleType) -> None:
    """What the two numbers of the file are for: without either one no pitch of the runs head-on is met."""
    fitted = birm3d.Vehicle.from_file(truck.FITTED)
    front = [name for name, zone in fitted.zones.items() if zone.friction_share is not None]
    assert {fitted.zones[name].friction_share for name in front} == {0.15}
    rough = fitted.with_zones({n: dataclasses.replace(fitted.zones[n], friction_share=1.0) for n in front})
    held = fitted.with_zone("tire_front", breakaway=1e9)
    head_on = [run for run in truck.runs().values() if run.impact_angle == 90.0]
    for vehicle in (rough, held):
        assert not any(row.met["pitch"] for row in page.computed(vehicle, head_on))


def test_the_left_front_goes_ahead_at_the_slanted_wall(page: ModuleType, truck: ModuleType) -> None:
    fitted = birm3d.Vehicle.from_file(truck.FITTED)
    (row,) = page.computed(fitted, [truck.runs()["wall25_50"]])
    assert row.own.yaw < 0.0  # the nose is turned away from the wall, to the right
    assert row.own.impulse[0, 1] > 0.0


def test_a_post_passes_below_the_platform_beside_the_frame(truck: ModuleType) -> None:
    """It is lower than the platform: without indentations only the bumper's end and sheet are in its way."""
    fitted = birm3d.Vehicle.from_file(truck.FITTED).with_indentation_length(0.0)
    post = birm3d.Barrier.bollards(count=1, height=truck.POST_HEIGHT, origin=(0.0, 1.2, 0.0))
    result = birm3d.Simulation(fitted, post, "50 mph", duration=0.25).run()
    assert result.position[-1, 0] - result.position[0, 0] > 5.0
    assert truck.figures(result).impulse[0] == pytest.approx([0.0, 0.0], abs=1e3)


def test_the_saved_vehicle_has_the_numbers_that_were_found(truck: ModuleType) -> None:
    fit = importlib.import_module("fit_truck")
    first = fit.read()[0]
    assert (first.variant, first.left_out) == ("all numbers", "")
    assert first.vehicle == birm3d.Vehicle.from_file(truck.FITTED)


def test_the_fitted_truck_runs_at_other_masses_speeds_and_places(truck: ModuleType) -> None:
    fitted = birm3d.Vehicle.from_file(truck.FITTED)
    heavy, light = fitted.with_gvw(8000.0), fitted.with_gvw(6000.0)
    barrier = birm3d.Barrier.bollards(count=3, spacing=1.4, origin=(0.0, 0.3, 0.0))
    travel = []
    for vehicle in (light, heavy):
        result = birm3d.Simulation(vehicle, barrier, "40 mph", 80.0, 0.1).run()
        assert "time_of_zero_velocity" in result.metrics
        assert result.statistics.body_steps == 0
        travel.append(result.metrics["max_displacement"])
    assert travel[0] < travel[1]
