"""Vehicles of which few facts are known: birm3d.Vehicle.from_facts."""

from __future__ import annotations

import math
from pathlib import Path

import birm3d
import numpy as np
import pytest
from birm3d import Barrier, Simulation, Vehicle
from birm3d.reference import nhtsa_tests
from birm3d.vehicle.from_facts import KINDS

FACTS = {"length": 4.3, "width": 1.75, "height": 1.5, "wheelbase": 2.6, "mass_center_height": 0.55}


def test_facts_are_met_and_nothing_else_is_assumed() -> None:
    car = Vehicle.from_facts("car", mass=1350.0, **FACTS, mesh_density=0.1)
    assert car.mass == 1350.0
    for name, value in FACTS.items():
        assert getattr(car, name) == pytest.approx(value, rel=1e-9)
    assert not {one.quantity for one in car.assumptions} & set(FACTS)
    assert car.name == "car_from_facts"
    assert car.kind == "car"


@pytest.mark.parametrize("kind", KINDS)
def test_mass_alone_is_enough(kind: str) -> None:
    """What is not given is assumed, within a band around the value; the vehicle crashes as its class does."""
    mass = 1.1 * KINDS[kind][0][1]
    made = Vehicle.from_facts(kind, mass=mass, mesh_density=0.1)
    assert made.mass == pytest.approx(mass)
    assert made.kind == kind
    told = {one.quantity: one for one in made.assumptions}
    assert set(FACTS) <= set(told)
    for name in FACTS:
        one = told[name]
        assert one.value == pytest.approx(getattr(made, name), rel=1e-6)
        assert one.low < one.value < one.high
        assert one.low * one.high == pytest.approx(one.value**2)
        assert f"{one.value:.4g}" in one.text
    moments = 0.5 * np.trace(made.inertia) * np.eye(3) - made.inertia
    assert np.linalg.eigvalsh(moments).min() > 0.0
    run = Simulation(made, Barrier.rigid_wall(), 12.0).run()
    assert run.outcome == "stopped"
    assert run.metrics["energy_residual"] < 1e-3
    assert "assumed: mass_center_height" in run.report()


@pytest.mark.parametrize("kind", KINDS)
def test_base_is_the_nearest_preset_of_the_kind(kind: str) -> None:
    for name, mass in KINDS[kind]:
        preset = Vehicle.preset(name, mesh_density=0.1)
        assert (preset.kind, round(preset.mass)) == (kind, round(mass))
        made = Vehicle.from_facts(kind, mass=preset.mass, mesh_density=0.1)
        assert f"the preset {name}," in made.assumptions[0].text
        np.testing.assert_allclose(made.nodes, preset.nodes, atol=1e-9)


def test_bands_of_dimensions_hold_the_tested_vehicles() -> None:
    """NHTSA: 80 % bands of the length of cars and pickups by their mass hold 70 to 95 % of those tested."""
    inside = []
    for test in nhtsa_tests().values():
        kind = "pickup" if test.vehicle_class.startswith("pickup") else test.vehicle_class
        if kind in ("car", "pickup"):
            made = Vehicle.from_facts(kind, mass=test.mass, mesh_density=0.03)
            (length,) = (one for one in made.assumptions if one.quantity == "length")
            inside.append(length.low <= test.length <= length.high)
    assert len(inside) > 40
    assert 0.7 <= np.mean(inside) <= 0.95


def test_unknown_mass_centre_has_a_wider_band() -> None:
    known = Vehicle.from_facts("pickup", mass=2200.0, mass_center_height=0.7, mesh_density=0.1)
    unknown = Vehicle.from_facts("pickup", mass=2200.0, mesh_density=0.1)
    spreads = [vehicle.scatter["mass_center_height"].log_sd for vehicle in (known, unknown)]
    assert spreads[0] < 0.5 * spreads[1]
    (height,) = (one for one in unknown.assumptions if one.quantity == "mass_center_height")
    assert math.log(height.high / height.low) == pytest.approx(2 * 1.2816 * spreads[1])
    band = birm3d.predict(Simulation(unknown, Barrier.rigid_wall(), 15.0), 8)
    assert band.low["dynamic_crush"] < band.high["dynamic_crush"]


def test_saved_and_read_and_changed(tmp_path: Path) -> None:
    truck = Vehicle.from_facts("truck", mass="8 t", length=7.5, mesh_density=0.1)
    truck.save(tmp_path / "v.toml")
    again = Vehicle.from_file(tmp_path / "v.toml")
    assert again == truck
    assert again.assumptions == truck.assumptions
    assert truck.with_gvw(9000.0).assumptions == truck.assumptions


@pytest.mark.parametrize(
    ("kind", "facts", "message"),
    [
        ("boat", {"mass": 1000.0}, "kind must be one of car, minivan, .*got 'boat'"),
        ("car", {"mass": -1.0}, "mass must be finite and > 0, got -1"),
        ("car", {"mass": 1000.0, "length": 0.0}, "length must be finite and > 0, got 0"),
        ("car", {"mass": 1000.0, "length": 4000.0}, "length must be .* a quarter to four times"),
        ("van", {"mass": 3000.0, "wheelbase": 6.5}, "wheelbase must be shorter than the length"),
    ],
)
def test_refuses(kind: str, facts: dict[str, float], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        Vehicle.from_facts(kind, **facts)
