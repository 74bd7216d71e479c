"""Vehicle.save: what from_file reads back is the same vehicle, whatever has been changed."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from birm3d import Barrier, Joint, Simulation, Vehicle, Zone
from birm3d.vehicle.vehicle_file import VehicleFileError

Change = Callable[[Vehicle], Vehicle]


def first_zone(vehicle: Vehicle) -> str:
    return next(iter(vehicle.zones))


def knee(vehicle: Vehicle) -> Vehicle:
    law = {"k_initial": 1.1e6, "knee": 0.1, "k_hardening": 0.0, "f_max": np.inf, "k_unloading": 7e6}
    return vehicle.with_zone(first_zone(vehicle), **law)


def several(vehicle: Vehicle) -> Vehicle:
    height = vehicle.mass_center_height
    changed = vehicle.scaled_to(1.3 * vehicle.mass).with_gvw(1.41 * vehicle.mass)
    changed = changed.with_mass_center_height(height + 0.05).with_rate_sensitivity(0.05)
    changed = changed.without_tire_contact().with_mesh_density(0.2).with_mass_center_height(height + 0.07)
    return knee(changed).with_gvw(1.2 * vehicle.mass)


CHANGES: dict[str, Change] = {
    "nothing": lambda v: v,
    "heavier": lambda v: v.with_gvw(1.07 * v.mass),
    "lighter": lambda v: v.with_gvw(0.95 * v.mass),
    "no payload": lambda v: v.with_payload(0.0),
    "payload": lambda v: v.with_payload(321.0),
    "similar": lambda v: v.scaled_to(1.3 * v.mass),
    "zone scaled": lambda v: v.with_zones({first_zone(v): v.zones[first_zone(v)].scaled(1 / 3)}),
    "knee in place of an envelope": knee,
    "mass centre": lambda v: v.with_mass_center_height(v.mass_center_height + 0.123),
    "rate": lambda v: v.with_rate_sensitivity(0.061),
    "no indentations": lambda v: v.with_indentation_length(0.0),
    "indentation": lambda v: v.with_indentation_length(0.7),
    "tyres": lambda v: v.without_tire_contact(),
    "mesh": lambda v: v.with_mesh_density(0.37),
    "all together": several,
}


@pytest.fixture(scope="module", params=Vehicle.presets())
def preset(request) -> Vehicle:
    return Vehicle.preset(request.param, mesh_density=0.1)


def test_every_preset_with_every_change(preset, tmp_path):
    path = tmp_path / "v.toml"
    for what, change in CHANGES.items():
        try:
            vehicle = change(preset)
        except ValueError:  # as a payload of a vehicle that has none
            assert what in ("payload", "no payload")
            continue
        vehicle.save(path)
        assert Vehicle.from_file(path) == vehicle, what


def test_goods_of_another_density(tmp_path):
    truck = Vehicle.preset("cargo_truck", mesh_density=0.1).with_payload(2000.0, density=300.0)
    truck.save(tmp_path / "v.toml")
    again = Vehicle.from_file(tmp_path / "v.toml")
    assert again == truck
    assert again.with_gvw(9000.0) == truck.with_gvw(9000.0)  # and it goes on as the vehicle would


def test_the_same_run(tmp_path):
    car = several(Vehicle.preset("passenger_car"))
    car.save(tmp_path / "v.toml")
    hashes = [
        Simulation(vehicle, Barrier.rigid_wall(), 14.0, 60.0).run().state_hash
        for vehicle in (car, Vehicle.from_file(tmp_path / "v.toml"))
    ]
    assert hashes[0] == hashes[1]


def test_two_units_in_one_file(tmp_path):
    tractor, trailer = Vehicle.preset("semi_truck", mesh_density=0.1).units
    trailer = dataclasses.replace(trailer, name="A trailer, lighter").with_gvw(12000.0)
    joint = Joint((-5.5, 0.0, 1.2), (0.1, 0.0, 1.2), roll_limit=5.0)
    train = Vehicle.articulated([tractor.without_tire_contact(), trailer], joint)
    train.save(tmp_path / "train.toml")
    again = Vehicle.from_file(tmp_path / "train.toml")
    assert again == train
    assert again.joint.roll_limit == 5.0
    assert again.units[1].name == "A trailer, lighter"


def test_units_without_changes_are_as_in_their_own_files(tmp_path):
    semi = Vehicle.preset("semi_truck", mesh_density=0.1)
    semi.with_gvw(20000.0).with_joint("welded").save(tmp_path / "semi.toml")
    again = Vehicle.from_file(tmp_path / "semi.toml", gvw=semi.mass)
    assert again.joint.kind == "welded"
    assert again.with_joint("fifth_wheel").units[0] == semi.units[0]
    assert again.mass == pytest.approx(semi.mass, rel=1e-12)


def test_arguments_of_from_file_go_on_from_what_was_saved(tmp_path):
    car = Vehicle.preset("passenger_car", mesh_density=0.2).with_rate_sensitivity(0.05)
    car.save(tmp_path / "v.toml")
    again = Vehicle.from_file(tmp_path / "v.toml", gvw=2000.0, mesh_density=2.0)
    assert again == car.with_gvw(2000.0).with_mesh_density(0.4)


def test_sources_stay_and_changes_are_apart(tmp_path):
    knee(Vehicle.preset("pickup", mesh_density=0.1)).save(tmp_path / "v.toml")
    blocks, changes = (tmp_path / "v.toml").read_text().split("\n[changes]\n")
    assert 'id = "fit-7360-7582"' in blocks
    assert "envelope_m_Pa = [[0.0, 0.0]" in blocks  # the file's own law, with its source
    assert "k_initial_Pa_per_m = 1100000.0" in changes
    assert "mesh_density = 0.1" in changes


def test_what_a_file_can_not_hold_is_refused(tmp_path):
    path = tmp_path / "v.toml"
    box = Vehicle.from_arrays(
        mass=1e3, inertia=np.eye(3), nodes=np.eye(3), anchors=-np.eye(3), k_initial=1.0, k_unloading=1.0
    )
    with pytest.raises(ValueError, match=r"preset or a file .* got 'from_arrays' from arrays; Result\.save"):
        box.save(path)
    car = Vehicle.preset("passenger_car", mesh_density=0.1)
    with pytest.raises(ValueError, match="got 'passenger_car' with another inertia"):
        dataclasses.replace(car, inertia=2.0 * car.inertia).save(path)
    with pytest.raises(ValueError, match="folder that exists"):
        car.save(tmp_path / "none" / "v.toml")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("[changes.zone.engine]", "[changes.zone.motor]", r"changes\.zone\.motor: must be one of .* 'motor'"),
        ("mesh_density = 0.1", "mesh_densty = 0.1", r"changes\.mesh_densty: unknown key"),
        ("mesh_density = 0.1", "mesh_density = -0.1", r"changes\.mesh_density: must be greater than 0"),
        ("k_initial_Pa_per_m = 1100000.0", "k_initial_Pa_per_m = -1.0", r"changes\.zone\.engine\.k_initial"),
    ],
)
def test_wrong_changes_name_line_and_key(tmp_path, old, new, message):
    path = tmp_path / "v.toml"
    knee(Vehicle.preset("passenger_car", mesh_density=0.1)).save(path)
    text = path.read_text()
    head, tail = text.split("\n[changes]\n")
    assert old in tail
    path.write_text(head + "\n[changes]\n" + tail.replace(old, new, 1))
    with pytest.raises(VehicleFileError, match=message) as raised:
        Vehicle.from_file(path)
    line = int(str(raised.value).split(":")[1])
    assert line > head.count("\n") + 1


def test_wrong_units_name_line_and_key(tmp_path):
    path = tmp_path / "semi.toml"
    Vehicle.preset("semi_truck", mesh_density=0.1).save(path)
    lines = path.read_text().splitlines()
    at = max(i for i, line in enumerate(lines) if line.startswith("k_unloading_Pa_per_m"))
    lines[at] = "k_unloading_Pa_per_m = -1.0"
    path.write_text("\n".join(lines))
    with pytest.raises(VehicleFileError, match=rf"semi.toml:{at + 1}: unit\.1\.zone\.\w+\.k_unloading"):
        Vehicle.from_file(path)


def test_a_zone_without_a_plateau_comes_back(tmp_path):
    car = Vehicle.preset("passenger_car", mesh_density=0.1)
    car.with_zones({"bumper": Zone(1e6, np.inf, 0.0, np.inf, 1e6)}).save(tmp_path / "v.toml")
    assert Vehicle.from_file(tmp_path / "v.toml").zones["bumper"].knee == np.inf


def test_export_for_the_core_holds_the_meshed_vehicle_exactly(tmp_path: Path) -> None:
    """tests/python/test_build.py runs such files in C++ and compares the state hashes."""
    vehicle = several(Vehicle.preset("passenger_car", mesh_density=0.02))
    vehicle.export_core(tmp_path / "car.txt")
    words = (tmp_path / "car.txt").read_text(encoding="ascii").split()
    assert words[:2] == ["birm3d-vehicle", "8"]
    assert [float.fromhex(words[i]) for i in (3, 5)] == [10.0, 1.25]
    assert words[2:9:2] == ["cornering_stiffness", "edge_flank_factor", "units", "mass"]
    assert float.fromhex(words[9]) == vehicle.mass
    assert words[words.index("trusses") + 1] == str(vehicle.n_nodes)
    height = words[words.index("mass_center_height") + 1]
    assert float.fromhex(height) == vehicle.mass_center_height
    assert float.fromhex(words[words.index("rate_sensitivity") + 1]) == vehicle.rate_sensitivity
    assert words[-3:] == ["joints", "0", "end"]


def test_export_for_the_core_of_two_units_and_of_arrays(tmp_path: Path) -> None:
    semi = Vehicle.preset("semi_truck", mesh_density=0.02)
    semi.export_core(tmp_path / "semi.txt")
    words = (tmp_path / "semi.txt").read_text(encoding="ascii").split()
    assert words[6:8] == ["units", "2"]
    joint = words.index("joints")
    assert words[joint + 1 : joint + 5] == ["1", "fifth_wheel", "0", "1"]
    block = Vehicle.from_arrays(
        mass=1000.0, inertia=np.eye(3), nodes=[[1.0, 0.0, 0.0]], anchors=[[0.0, 0.0, 0.0]], k_initial=1e6,
        k_unloading=4e6,
    )  # fmt: skip
    block.export_core(tmp_path / "block.txt")
    text = (tmp_path / "block.txt").read_text(encoding="ascii")
    assert "inf" in text  # the recovery of the paper's law
    with pytest.raises(ValueError, match="path must be a file"):
        block.export_core(tmp_path)
