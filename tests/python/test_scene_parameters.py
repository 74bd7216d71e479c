"""Names for everything a scene has: each can be read, set and put back."""

from __future__ import annotations

import math
from typing import Any

import birm3d
import numpy as np
import pytest
from birm3d import scenes
from birm3d.metrics import METRIC_UNITS
from birm3d.scene_parameters import parameter_names, unit_of, value_of, varied

SEDAN = scenes.nhtsa_10146(mesh_density=0.1)
BLOCK = scenes.w2(100)

# Fields that no factor of 1.01 can change.
SPECIAL: dict[str, Any] = {
    "impact_offset": 0.1,
    "standoff": 0.2,
    "duration": 0.1,
    "barrier.origin": (0.0, 1.0, 0.0),
    "barrier.heading": 5.0,
    "barrier.friction": 0.25,
    "barrier.width": 9.0,
    "barrier.height": 9.0,
    "barrier.segments": 1,
    "settings.time_step": 1e-4,
    "settings.mu_tire_barrier": 0.5,
    "settings.cornering_stiffness": 8.0,
    "settings.ground": False,
    "settings.gravity": 9.5,
    "settings.braking": 0.5,
    "settings.contact_model": "along_truss",
    "settings.tire_model": "skid",
    "truss.f_max": 3e6,
    "vehicle.rate_sensitivity": 0.01,
}


@pytest.mark.parametrize("simulation", [SEDAN, BLOCK], ids=["sedan", "block"])
def test_every_parameter_can_be_set_and_read(simulation: birm3d.Simulation) -> None:
    for name in parameter_names(simulation):
        before = value_of(simulation, name)
        value = SPECIAL.get(name)
        if value is None:
            # Infinite numbers stay so; a steeper slope needs no steeper unloading at 0.1 %.
            value = before * 1.001 if math.isfinite(before) and before > 0.0 else 1e9
        changed = varied(simulation, {name: value})
        after = value_of(changed, name)
        if name.endswith(".scale"):
            assert after == 1.0  # relative to the present curve
            zone = name.removeprefix("zone.").removesuffix(".scale")
            law = changed.scene.vehicle.zones[zone]
            assert law["k_unloading"] == value * simulation.scene.vehicle.zones[zone]["k_unloading"]
        elif name.startswith("scatter."):
            assert after == 1.0  # relative to the present curves
        elif isinstance(value, float):
            assert after == pytest.approx(value, rel=1e-12)
        else:
            assert after == value
        assert value_of(simulation, name) == before  # the old one is left alone


def test_several_at_once_reach_the_kernel() -> None:
    changed = varied(
        SEDAN,
        {
            "impact_speed": 12.0,
            "barrier.friction": 0.3,
            "vehicle.gvw": 1900.0,
            "vehicle.mass_center_height": 0.6,
            "zone.bumper.scale": 1.2,
            "settings.tolerance": 1e-4,
        },
    )
    scene = changed.scene
    assert scene.impact_speed == 12.0
    assert scene.barrier is not None
    assert scene.barrier.friction == 0.3
    assert scene.vehicle.mass == pytest.approx(1900.0, rel=1e-12)
    assert scene.vehicle.mass_center_height == pytest.approx(0.6, rel=1e-12)
    assert scene.settings.tolerance == 1e-4
    result = changed.run()
    assert result.velocity[0, 0] == pytest.approx(12.0)
    assert result.metrics["dynamic_crush"] < SEDAN.run().metrics["dynamic_crush"]


def test_nothing_changed_is_the_same_scene() -> None:
    assert varied(SEDAN, {}).run().state_hash == SEDAN.run().state_hash


def test_a_factor_on_every_zone_is_a_factor_on_every_force() -> None:
    """Stiffness and mass times the same factor: the same motion, forces times the factor."""
    factor = 1.7
    law = {
        name: factor * value_of(BLOCK, f"truss.{name}")
        for name in ("k_initial", "k_hardening", "k_unloading")
    }
    heavy = varied(BLOCK, {"vehicle.gvw": factor * 6804.0, **{f"truss.{n}": v for n, v in law.items()}}).run()
    light = BLOCK.run()
    assert heavy.metrics["dynamic_crush"] == pytest.approx(light.metrics["dynamic_crush"], rel=1e-9)
    assert heavy.metrics["peak_normal_force"] == pytest.approx(
        factor * light.metrics["peak_normal_force"], rel=1e-9
    )


def test_raising_the_mass_centre_moves_it_in_the_structure() -> None:
    car = SEDAN.scene.vehicle
    raised = car.with_mass_center_height(car.mass_center_height + 0.1)
    assert np.allclose(raised.nodes + raised.center_of_mass, car.nodes + car.center_of_mass, atol=1e-12)
    assert raised.inertia[2, 2] == pytest.approx(car.inertia[2, 2], rel=1e-12)  # the same in plan
    assert raised.inertia[0, 0] > car.inertia[0, 0]
    heavier = raised.with_gvw(1.1 * car.mass)
    assert heavier.mass_center_height == raised.mass_center_height


def test_mesh_density_keeps_what_was_changed() -> None:
    car = SEDAN.scene.vehicle.with_gvw(1800.0)
    car = car.with_zones({"bumper": car.zones["bumper"].scaled(1.5)})
    finer = car.with_mesh_density(0.4)
    assert finer.n_elements > 2 * car.n_elements
    assert finer.mass == car.mass
    assert finer.zones["bumper"] == car.zones["bumper"]
    # A coarser mesh cuts the corners of the outline.
    areas = [vehicle.area[vehicle.along_of_node < 0].sum() for vehicle in (finer, car)]
    assert areas[0] == pytest.approx(areas[1], rel=5e-3)


@pytest.mark.parametrize(
    ("simulation", "changes", "words"),
    [
        (SEDAN, {"impact_sped": 1.0}, "impact_speed"),
        (SEDAN, {"zone.bumper.k_initial": 1.0}, "parameter_names"),  # the bumper has an envelope
        (SEDAN, {"truss.k_initial": 1.0}, "parameter"),
        (SEDAN, {"zone.bumper.scale": 0.0}, "scale"),
        (SEDAN, {"zone.bumper.scale": math.nan}, "scale"),
        (SEDAN, {"vehicle.mass_center_height": -1.0}, "mass_center_height"),
        (SEDAN, {"impact_speed": math.nan}, "speed"),
        (SEDAN, {"barrier.friction": -0.1}, "friction"),
        (SEDAN, {"settings.tolerance": 2.0}, "tolerance"),
        (BLOCK, {"vehicle.mesh_density": 2.0}, "parameter"),
        (BLOCK, {"truss.k_initial": -1.0}, "k_initial"),
        (SEDAN, {"zone.nose.scale": 1.0}, "zone"),
    ],
)
def test_bad_changes_name_the_argument(
    simulation: birm3d.Simulation, changes: dict[str, Any], words: str
) -> None:
    with pytest.raises(ValueError, match=words):
        varied(simulation, changes)


def test_several_changes_of_a_vehicle_are_those_in_turn() -> None:
    """One build for all of them: the same vehicle, bit for bit."""
    changes = {"zone.bumper.scale": 1.2, "vehicle.gvw": 1900.0, "vehicle.mass_center_height": 0.6}
    vehicle = SEDAN.scene.vehicle
    in_turn = (
        vehicle.with_zones({"bumper": vehicle.zones["bumper"].scaled(1.2)})
        .with_gvw(1900.0)
        .with_mass_center_height(0.6)
    )
    assert varied(SEDAN, changes).scene.vehicle == in_turn


def test_units_are_those_of_the_scene() -> None:
    units = {name: unit_of(name) for name in parameter_names(SEDAN)}
    assert units["impact_speed"] == "m/s"
    assert units["vehicle.gvw"] == "kg"
    assert units["barrier.friction"] == units["zone.bumper.scale"] == ""
    assert units["zone.bumper.stress[1]"] == "N per m^2"
    assert units["zone.bumper.deflection[1]"] == "m"
    assert unit_of("truss.k_initial") == "N/m"
    assert unit_of("zone.tires.breakaway") == "N"  # of a wheel, whatever its area
    assert set(SEDAN.run().metrics) <= set(METRIC_UNITS)
