"""Recipes: what a vehicle is made of, from which it is made again to the last bit."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from birm3d import Barrier, Simulation, Vehicle, scenes
from birm3d.base.fingerprint import fingerprint
from birm3d.scene_parameters import varied
from birm3d.vehicle import CombinationRecipe, VehicleRecipe, build

CAR = Vehicle.preset("passenger_car", mesh_density=0.1)
TRUCK = Vehicle.preset("cargo_truck", mesh_density=0.1)
SEMI = Vehicle.preset("semi_truck", mesh_density=0.1)
BLOCK = scenes.laboratory_block(20, k_initial=3e6, k_unloading=3e6)
ALL = pytest.mark.parametrize("vehicle", [CAR, TRUCK, SEMI, BLOCK], ids=lambda v: v.name)

# One value of each number of a recipe that differs from that of the truck.
OTHERS: dict[str, Callable[[VehicleRecipe], Any]] = {
    "name": lambda r: "another",
    "mass": lambda r: 0.9 * r.mass,
    "zones": lambda r: {**r.zones, "bumper": r.zones["bumper"].scaled(1.2)},
    "file": lambda r: r.file.scaled_to(1.1 * r.mass),
    "mesh_density": lambda r: 0.13,
    "load_density": lambda r: 500.0,
    "mass_center_height": lambda r: 1.05,
    "spread": lambda r: (1.1, 1.0, 0.95),
    "tire_contact": lambda r: False,
    "rate_sensitivity": lambda r: 0.05,
    "indentation_length": lambda r: 0.4,
}


def unit_recipe(vehicle: Vehicle) -> VehicleRecipe:
    recipe = vehicle.recipe
    assert isinstance(recipe, VehicleRecipe)
    return recipe


def hash_of(vehicle: Vehicle) -> int:
    return Simulation(vehicle, Barrier.bollards(), 12.0, 80.0, duration=0.1).run().state_hash


@ALL
def test_a_recipe_makes_the_same_vehicle(vehicle: Vehicle) -> None:
    again = build(vehicle.recipe)
    assert type(again) is type(vehicle)
    assert again == vehicle
    assert fingerprint(again) == fingerprint(vehicle)
    if vehicle is not BLOCK:
        assert hash_of(again) == hash_of(vehicle)


def test_every_number_of_a_recipe_is_tried() -> None:
    names = {field.name for field in dataclasses.fields(VehicleRecipe)}
    assert names == {*OTHERS, "arrays"}


@pytest.mark.parametrize("first", OTHERS)
@pytest.mark.parametrize("then", OTHERS)
def test_no_number_is_lost_when_another_one_changes(first: str, then: str) -> None:
    """All that the first change gave is there after the second one, in the recipe of what was built."""
    if first == then:
        return
    start = unit_recipe(TRUCK)
    given = OTHERS[first](start)
    changed = TRUCK._changed(dataclasses.replace(start, **{first: given}))
    twice = changed._changed(dataclasses.replace(unit_recipe(changed), **{then: OTHERS[then](start)}))
    kept = getattr(unit_recipe(twice), first)
    assert kept is given if first == "file" else kept == given
    # The way to it does not count, nor what was kept of the vehicles on the way.
    anew = build(unit_recipe(twice))
    assert anew == twice
    assert (anew.nodes == twice.nodes).all()


def test_the_methods_of_a_vehicle_are_changes_of_its_recipe() -> None:
    for vehicle in (CAR, SEMI):
        recipe = vehicle.recipe
        for made, changed in (
            (vehicle.with_rate_sensitivity("0.05 s/m"), recipe.each(rate_sensitivity=0.05)),
            (vehicle.with_gvw(1.1 * vehicle.mass), recipe.with_mass(1.1 * vehicle.mass)),
            (vehicle.with_mesh_density(0.15), recipe.with_mesh_density(0.15)),
            (vehicle.without_tire_contact(), recipe.without_tire_contact()),
            (vehicle.with_mass_center_height("90 cm"), recipe.with_mass_center_height(0.9)),
        ):
            assert build(changed) == made
            assert made != vehicle
    assert build(CAR.recipe.with_inertia({"yaw_inertia": 3e3})) == CAR.with_inertia(yaw_inertia="3000 kg m^2")


def test_several_changes_build_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """A row of a study with five changed numbers makes one vehicle."""
    made = []
    check = Vehicle.__post_init__

    def counted(self: Vehicle) -> None:
        made.append(self)
        check(self)

    simulation = Simulation(TRUCK, Barrier.bollards(), 12.0)
    monkeypatch.setattr(Vehicle, "__post_init__", counted)
    numbers = {"gvw": 7000.0, "rate_sensitivity": 0.05, "indentation_length": 0.4, "mass_center_height": 1.05}
    numbers |= {"length": 7.0, "yaw_inertia": 3e4}
    changes = {"zone.bumper.scale": 1.2} | {f"vehicle.{name}": value for name, value in numbers.items()}
    vehicle = varied(simulation, changes).scene.vehicle
    assert len(made) == 1
    found = {name: getattr(vehicle, "mass" if name == "gvw" else name) for name in numbers}
    assert found == pytest.approx(numbers, rel=1e-12)


def test_a_combination_keeps_its_height_when_it_is_loaded() -> None:
    recipe = SEMI.recipe
    assert isinstance(recipe, CombinationRecipe)
    high = recipe.with_mass_center_height(1.5)
    assert high.mass_center[2] == pytest.approx(1.5, rel=1e-12)
    loaded = build(high.with_payload(5000.0, None, None))
    assert loaded.mass_center_height == pytest.approx(1.5, rel=1e-12)
    assert loaded.mass < SEMI.mass
    assert recipe.mass_center == pytest.approx(SEMI.center_of_mass, rel=1e-15)


def test_a_recipe_says_what_is_not_in_it() -> None:
    other = dataclasses.replace(CAR, nodes=CAR.nodes * [1.001, 1.0, 1.0])
    with pytest.raises(ValueError, match="nodes of 'passenger_car' must be changed after what is made from"):
        _ = other.recipe
    with pytest.raises(ValueError, match="nodes of 'passenger_car' must be changed after what is made from"):
        other.without_tire_contact()
    assert (other.with_rate_sensitivity(0.05).nodes == other.nodes).all()
    longer = dataclasses.replace(
        BLOCK, nodes=BLOCK.nodes + np.array([0.1, 0.0, 0.0])
    )  # arrays are its recipe
    assert build(longer.recipe) == longer
    assert (longer.with_gvw(900.0).nodes == longer.nodes).all()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda: VehicleRecipe("x", 1.0, {}), "file or arrays must be given, and not both, got none"),
        (
            lambda: dataclasses.replace(CAR.recipe, arrays=BLOCK.recipe.arrays),
            "file or arrays must be given, and not both, got both",
        ),
        (lambda: CAR.recipe.with_mass(-1.0), r"gvw must be .*got -1"),
        (lambda: SEMI.recipe.with_mass(100.0), "gvw must be above the leading unit's mass"),
        (lambda: CAR.recipe.with_payload(-1.0, None, None), "payload must be finite and >= 0, got -1"),
        (lambda: BLOCK.recipe.with_mesh_density(2.0), "mesh_density needs a vehicle that has a file"),
        (
            lambda: CAR.recipe.with_mass_center_height(9.0),
            "mass_center_height must be below the vehicle's top",
        ),
        (lambda: CAR.recipe.with_truss_law(k_initial=1.0), "truss law needs a vehicle made from arrays"),
        (lambda: BLOCK.recipe.with_truss_law(k=1.0), "truss law must be one of k_initial"),
        (lambda: build(CAR.recipe.each(mass=np.nan)), "must be"),
        (lambda: build(CAR.recipe.each(mesh_density=-1.0)), "mesh_density must be"),
        (lambda: build(CAR.recipe.each(rate_sensitivity=-1.0)), "rate_sensitivity must be"),
    ],
)
def test_recipes_that_can_not_be(change: Callable[[], Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        change()


def test_drafts_are_names_of_an_earlier_version() -> None:
    for name in ("draft", "finished"):
        with pytest.warns(DeprecationWarning, match=rf"{name}\(\) is not needed any more"):
            assert getattr(CAR, name)() is CAR
