"""The force along the barrier's normal is a resultant: a component of the total force, in every number."""

from __future__ import annotations

import re
from pathlib import Path

import birm3d
import numpy as np
import pytest
from birm3d import Barrier, Result, Simulation, Vehicle
from birm3d.base.shown_numbers import kilo_number
from birm3d.filters import cfc, moving_average
from birm3d.result.summary import ELEMENT_COLUMNS, element_rows

OLD = Path(__file__).parents[1] / "data" / "results" / "bollards_0_1_0.npz"


@pytest.fixture(scope="module")
def truck() -> Result:
    """Three bollards three metres apart, of which the truck meets the middle one."""
    posts = Barrier.bollards(count=3, spacing=3.0, friction=0.2)
    return Simulation(Vehicle.preset("cargo_truck", mesh_density=0.3), posts, 13.4, 90.0, 0.3).run()


def test_one_post_feels_what_the_headline_says(truck: Result) -> None:
    (load,) = (load for load in truck.element_loads if load.touched)
    interval = truck.scene.settings.output_interval
    component = load.force[:, 0]  # heading 0: into the barrier is +x
    metrics, rounding = truck.metrics, 1e-9 * component.max()
    assert truck.barrier_normal_force == pytest.approx(component, abs=rounding)
    assert metrics["peak_normal_force"] == pytest.approx(component.max(), rel=1e-9)
    assert metrics["peak_normal_force_cfc60"] == pytest.approx(cfc(component, 60, interval).max(), rel=1e-9)
    mean = moving_average(component, 0.05, interval)
    assert metrics["peak_force_50ms"] == pytest.approx(mean.max(), rel=1e-9)
    # The vector has the sideways and the vertical part on top.
    assert metrics["peak_force_50ms"] <= metrics["peak_element_force_50ms"] < 1.1 * metrics["peak_force_50ms"]
    assert metrics["peak_element_force"] == np.linalg.norm(load.force, axis=1).max()
    # The skin leans a little on both flanks of the post: the sum of magnitudes is no load.
    assert truck.sum_of_contact_forces.max() > 1.01 * component.max()


@pytest.mark.parametrize("name", ["truck", "jersey", "semi"])
def test_newton_along_the_normal(name: str, truck: Result) -> None:
    """The change of momentum along the normal is the force's and the ground's, in every interval."""
    result = truck
    if name == "jersey":
        car = Vehicle.preset("passenger_car", mesh_density=0.3)
        result = Simulation(car, Barrier.jersey(heading=30.0, friction=0.4), 20.0, 25.0).run()
    elif name == "semi":
        semi = Vehicle.preset("semi_truck", mesh_density=0.2)
        result = Simulation(semi, Barrier.rigid_wall(), 10.0, 40.0, duration=0.2).run()
    assert result.scene.barrier is not None
    towards = -np.asarray(result.scene.barrier.core.normal)
    dt = result.scene.settings.output_interval
    units = range(len(result.scene.vehicle.units))
    momentum = sum(result.scene.vehicle.units[u].mass * result.unit(u).velocity @ towards for u in units)
    ground = (result.tire_friction_force + result.ground_force) @ towards
    missed = np.diff(momentum) / dt + (result.barrier_normal_force - ground)[1:]
    assert np.abs(missed).max() < 1e-6 * result.barrier_normal_force.max()


def test_a_flat_wall_has_nothing_that_opposes_itself() -> None:
    car = Vehicle.preset("passenger_car", mesh_density=0.3)
    result = Simulation(car, Barrier.rigid_wall(heading=20.0), 15.0).run()
    largest = result.sum_of_contact_forces.max()
    assert np.abs(result.barrier_normal_force - result.sum_of_contact_forces).max() < 1e-9 * largest


@pytest.mark.parametrize(("angle", "sign"), [(0.0, 1.0), (180.0, -1.0)])
def test_along_the_line_it_is_the_force_along_the_path(angle: float, sign: float) -> None:
    car = Vehicle.preset("passenger_car", mesh_density=0.3)
    wall = Barrier.rigid_wall(width=6.0, height=1.2, thickness=0.5)
    result = Simulation(car, wall, 12.0, angle, 0.25, duration=0.15).run()
    force = -sign * result.barrier_force[:, 1]
    assert result.metrics["peak_normal_force"] == pytest.approx(force.max(), rel=1e-9)
    assert force.max() > 1e5
    assert result.metrics["max_displacement"] > 0.2


def test_the_same_bits_without_histories(truck: Result) -> None:
    sim = Simulation.from_scene(truck.scene)
    study = birm3d.ensemble([sim], metrics=["peak_normal_force"], progress=False)
    assert study["peak_normal_force"][0] == truck.metrics["peak_normal_force"]
    assert truck.metrics["peak_normal_force"] == truck.barrier_normal_force.max()


def test_a_file_of_version_0_1_0_gets_the_component() -> None:
    loaded = birm3d.load(OLD)
    touched = sum(load.force for load in loaded.element_loads)
    component = touched[:, 0]
    assert loaded.barrier_normal_force == pytest.approx(component, abs=1e-9 * component.max())
    assert loaded.sum_of_contact_forces.max() > 1.4 * component.max()
    # Its metrics are as they were then, when the name stood for the sum.
    assert loaded.metrics["peak_normal_force"] == pytest.approx(2.904e6, rel=1e-3)


def test_reports_say_which_force_they_show() -> None:
    """A truck along a sloped face: the whole force is greater than its part across the line."""
    truck = Vehicle.preset("cargo_truck", mesh_density=0.3)
    result = Simulation(truck, Barrier.jersey(), "60 km/h", 15.0).run()
    (load,) = result.element_loads
    whole, lateral = load.peak_force_50ms, load.peak_lateral_force_50ms
    assert lateral == pytest.approx(result.metrics["peak_force_50ms"], rel=1e-9)
    assert lateral == pytest.approx(birm3d.design_load(result, draws=0).governing.force_50ms, rel=1e-9)
    assert whole > 1.02 * lateral
    told = f"of the whole force {whole / 1e3:,.0f} kN at {load.height_at_peak:.2f} m, of its part across the "
    assert told + f"line {lateral / 1e3:,.0f} kN" in result.report()
    assert not re.search(r"\de\+\d", result.report())
    row = dict(zip(ELEMENT_COLUMNS, *element_rows(result), strict=True))
    assert row["whole force, 50-ms mean [kN]"] == f"{whole / 1e3:.0f}"
    assert row["lateral force, 50-ms mean [kN]"] == f"{lateral / 1e3:.0f}"


def test_a_post_has_the_horizontal_part(truck: Result) -> None:
    (load,) = (load for load in truck.element_loads if load.touched)
    mean = moving_average(load.force, 0.05, load.interval)
    assert load.peak_lateral_force_50ms == pytest.approx(np.hypot(mean[:, 0], mean[:, 1]).max(), rel=1e-12)
    assert "of its horizontal part" in truck.report()


def test_loads_have_no_power_of_ten() -> None:
    assert [kilo_number(value) for value in (1.0383e6, 9.96e4, 7.4, 0.0)] == ["1,038", "99.6", "0.0074", "0"]
