"""What a panel resists along the vehicle: laws of zones in files, second trusses, and what they do."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from birm3d import Barrier, Settings, Simulation, Vehicle
from birm3d.vehicle.vehicle_file import VehicleFileError

FILE = """
extends = "passenger_car"
scatter = []
[zone.fender]
panels = ["{panel}"]
blocks = ["body"]
x_m = [-0.3, 1.2]
envelope_m_Pa = [[0.0, 0.0], [0.15, 0.05e6], [0.42, 0.6e6], [0.55, 0.6e6], [0.75, 2.0e6]]
k_unloading_Pa_per_m = 1e7
source = ["order-of-magnitude"]
status = "estimated"
[zone.wheel_house]
panels = ["side"]
blocks = ["body"]
x_m = [-0.9, -0.3]
envelope_m_Pa = [[0.0, 0.0], [0.15, 0.05e6]]
k_unloading_Pa_per_m = 1e7
source = ["order-of-magnitude"]
status = "estimated"
"""
ALONG = """
[zone.fender.along]
envelope_m_Pa = [[0.0, 0.0], [0.1, 0.4e6]]
k_unloading_Pa_per_m = 2e7
elastic_recovery_m = 0.05
source = ["order-of-magnitude"]
status = "estimated"
"""


def read(folder: Path, along: str = ALONG, panel: str = "side") -> Vehicle:
    path = folder / "car.toml"
    path.write_text(FILE.format(panel=panel) + along)
    return Vehicle.from_file(path, mesh_density=0.3)


@pytest.fixture(scope="module")
def car(tmp_path_factory: pytest.TempPathFactory) -> Vehicle:
    return read(tmp_path_factory.mktemp("along"))


def test_each_node_of_the_zone_has_a_second_truss_along_the_vehicle(car: Vehicle) -> None:
    second = np.flatnonzero(car.along_of_node >= 0)
    of = car.along_of_node[second]
    names = list(car.zones)
    fender = np.flatnonzero(car.zone_of_node == names.index("fender"))
    assert np.array_equal(np.sort(of), fender)
    assert set(car.zone_of_node[second]) == {names.index("fender.along")}
    np.testing.assert_array_equal(car.nodes[second], car.nodes[of])
    np.testing.assert_array_equal(car.area[second], car.area[of])
    np.testing.assert_allclose(
        car.anchors[second] - car.nodes[second], [[-3.0, 0.0, 0.0]] * len(of), atol=1e-12
    )


def test_a_law_along_the_panel_is_a_zone_like_others(car: Vehicle, tmp_path: Path) -> None:
    stiffer = car.with_zone("fender.along", k_unloading=4e7)
    assert stiffer.zones["fender.along"].k_unloading == 4e7
    assert stiffer.zones["fender"] == car.zones["fender"]
    stiffer.save(tmp_path / "stiffer.toml")
    assert Vehicle.from_file(tmp_path / "stiffer.toml") == stiffer
    doubled = car.scaled_to(2.0 * car.mass)
    factor = doubled.zones["fender"].k_unloading / car.zones["fender"].k_unloading
    assert doubled.zones["fender.along"] == car.zones["fender.along"].scaled(factor)


def test_without_a_second_truss_nothing_changes(car: Vehicle, tmp_path: Path) -> None:
    """A law of no force to speak of: the same crash to the share that it has."""
    weak = car.with_zone("fender.along", envelope=((0.0, 0.0), (0.1, 1e-3)), k_unloading=1.0)
    bare = read(tmp_path, along="")
    assert (bare.along_of_node == -1).all()
    runs = [
        Simulation(
            vehicle, Barrier.rigid_wall(), 20.0, 25.0, duration=0.15, settings=Settings(tolerance=1e-5)
        ).run()
        for vehicle in (weak, bare)
    ]
    np.testing.assert_allclose(runs[0].velocity[-1], runs[1].velocity[-1], rtol=0.0, atol=20.0 * 1e-5)


def small_overlap(vehicle: Vehicle) -> Simulation:
    """The wall covers the outer quarter of the vehicle."""
    wall = Barrier.rigid_wall(width=4.0, height=2.0)
    return Simulation(vehicle, wall, 17.9, 90.0, 2.0 + 0.25 * vehicle.width, duration=0.12)


def test_a_corner_that_ploughs_along_the_side_is_resisted(car: Vehicle, tmp_path: Path) -> None:
    along, bare = small_overlap(car).run(), small_overlap(read(tmp_path, along="")).run()
    assert along.velocity[-1, 0] < bare.velocity[-1, 0] - 1.0
    for run in (along, bare):
        assert run.metrics["energy_residual"] < 1e-3
        assert run.metrics["momentum_residual"] < 1e-9


def test_left_and_right_mirror_each_other(car: Vehicle) -> None:
    left = Simulation(car, Barrier.rigid_wall(), 20.0, 25.0, duration=0.1).run()
    right = Simulation(car, Barrier.rigid_wall(), 20.0, 155.0, duration=0.1).run()
    np.testing.assert_allclose(left.velocity[-1] * [1.0, -1.0, 1.0], right.velocity[-1], rtol=0.0, atol=1e-8)


@pytest.mark.parametrize(
    ("along", "panel", "message"),
    [
        (
            ALONG,
            "front",
            r"zone\.fender\.along: must be in a zone of the panels side, top and bottom, got front",
        ),
        (ALONG.replace("2e7", "1e6"), "side", r"zone\.fender\.along\.k_unloading_Pa_per_m: .*every slope"),
        (ALONG.replace("order-of", "no-order-of"), "side", r"zone\.fender\.along\.source"),
    ],
)
def test_what_is_no_such_law_is_refused(tmp_path: Path, along: str, panel: str, message: str) -> None:
    with pytest.raises(VehicleFileError, match=message):
        read(tmp_path, along, panel)
