"""Vehicles of one file share mesh and trusses: another mass moves them, and nothing else is made anew."""

from __future__ import annotations

import copy
import dataclasses
import pickle
import shutil
from importlib import resources
from pathlib import Path

import numpy as np
import pytest
from birm3d import Barrier, Simulation, Vehicle
from birm3d.vehicle import vehicle_file
from birm3d.vehicle.vehicle_shape import VehicleShape


@pytest.fixture(scope="module")
def truck() -> Vehicle:
    return Vehicle.preset("cargo_truck", mesh_density=0.05)


def made_alone(vehicle: Vehicle) -> Vehicle:
    """The same vehicle whose trusses the core cuts and sorts for it alone, in its own axes."""
    return dataclasses.replace(vehicle, _shape=None)


def answers(vehicle: Vehicle, barrier: Barrier, angle: float) -> dict[str, float]:
    result = Simulation(vehicle, barrier, 18.0, angle).run()
    return {name: value for name, value in result.metrics.items() if name != "run_time"}


@pytest.mark.parametrize("angle", [90.0, 35.0])
def test_moved_trusses_are_those_made_for_the_vehicle_alone(truck: Vehicle, angle: float) -> None:
    for barrier in (Barrier.rigid_wall(), Barrier.bollards(count=5)):
        for vehicle in (truck, truck.with_gvw(0.8 * truck.mass), truck.with_mass_center_height(1.2)):
            moved, alone = answers(vehicle, barrier, angle), answers(made_alone(vehicle), barrier, angle)
            assert moved.keys() == alone.keys()
            for name, value in alone.items():
                assert moved[name] == pytest.approx(value, rel=1e-9, abs=1e-9), name


def test_a_mass_does_not_depend_on_the_way_to_it(truck: Vehicle) -> None:
    straight = Vehicle.preset("cargo_truck", gvw=9000.0, mesh_density=0.05)
    round_about = truck.with_gvw(7000.0).with_gvw(9000.0)
    hashes = set()
    for vehicle in (straight, round_about, pickle.loads(pickle.dumps(round_about))):
        simulation = Simulation(vehicle, Barrier.rigid_wall(), 15.0)
        simulation.run()
        hashes.add(simulation.state_hash())
    assert len(hashes) == 1


def test_vehicles_of_one_file_share_their_shape(truck: Vehicle) -> None:
    shape = truck._shape
    assert isinstance(shape, VehicleShape)
    same = (
        truck.with_gvw(8000.0),
        truck.with_mass_center_height(1.1),
        truck.with_rate_sensitivity(0.06),
        truck.with_zones({}),
        Vehicle.preset("cargo_truck", mesh_density=0.05),
        copy.copy(truck),
    )
    for vehicle in same:
        assert vehicle._shape is shape
        assert vehicle.area is shape.area
        assert vehicle._is_shape()
    assert truck.without_tire_contact()._shape is shape.without_tire_nodes
    assert truck.without_tire_contact()._is_shape()
    trusses = shape.trusses(truck.zones, truck.rate_sensitivity, truck.indentation_length)
    assert shape.trusses(same[0].zones, same[0].rate_sensitivity, same[0].indentation_length) is trusses
    assert shape.trusses(truck.zones, 0.06, truck.indentation_length) is not trusses
    assert Vehicle.preset("cargo_truck", mesh_density=0.06)._shape is not shape


def test_other_nodes_or_areas_are_not_lost(truck: Vehicle) -> None:
    """What is replaced by hand is what runs, not what the file has."""
    longer = truck.nodes.copy()
    longer[longer[:, 0] > 0.0, 0] += 0.25
    stiffer = 3.0 * truck.area
    usual = answers(truck, Barrier.rigid_wall(), 90.0)
    for changes in ({"nodes": longer}, {"area": stiffer}):
        other = dataclasses.replace(truck, **changes)
        assert not other._is_shape()
        found = answers(other, Barrier.rigid_wall(), 90.0)
        assert found == answers(made_alone(other), Barrier.rigid_wall(), 90.0)
        # A truck of constant stress is crushed by the same depth, a longer one later.
        assert max(abs(found[name] / usual[name] - 1.0) for name in found if usual[name]) > 1e-2


def test_the_last_laws_are_remembered_and_no_more(truck: Vehicle) -> None:
    shape = truck._shape
    assert shape is not None
    for i in range(10):
        shape.trusses(truck.zones, 0.001 * i, 0.0)
    assert len(shape._trusses) <= 4


def test_arrays_of_a_shape_can_not_be_written(truck: Vehicle) -> None:
    shape = truck._shape
    assert shape is not None
    for array in (shape.nodes, shape.anchors, shape.area, shape.zone_of_node, shape.quads, shape.wheels):
        assert not array.flags.writeable
    assert np.array_equal(truck.nodes, shape.nodes - truck.center_of_mass)


def test_a_preset_is_read_once_and_again_when_a_file_has_changed(monkeypatch: pytest.MonkeyPatch) -> None:
    first = Vehicle.preset("semi_truck").units[0]
    assert Vehicle.preset("semi_truck", mesh_density=0.5).units[0]._file is first._file
    monkeypatch.setattr(vehicle_file, "data_state", lambda: (("semi_tractor.toml", 1, 1),))
    again = Vehicle.preset("semi_truck").units[0]
    assert again._file is not first._file
    assert again == first


def test_the_state_of_the_presets_tells_a_change(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    shutil.copytree(vehicle_file.preset_path("pickup").parent, tmp_path / "data")
    monkeypatch.setattr(resources, "files", lambda _: tmp_path)
    before = vehicle_file.data_state()
    assert len(before) == len(list(tmp_path.rglob("*.toml")))
    (tmp_path / "data/units/semi_tractor.toml").write_text("name = 'other'\n", encoding="utf-8")
    assert vehicle_file.data_state() != before
