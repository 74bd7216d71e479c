"""Vehicles of another mass and size: shape, mass properties, stiffness, crashes and files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from birm3d import Barrier, Settings, Simulation, Vehicle

CAR = Vehicle.preset("passenger_car", mesh_density=0.1)
TRUCK = Vehicle.preset("cargo_truck", mesh_density=0.1)
SEMI = Vehicle.preset("semi_truck", mesh_density=0.1)
SIZES = ("length", "width", "height", "wheelbase")

HEAD = """
extends = "passenger_car"
name = "short_car"
title = "Short car"
description = "A car of a test."

[[source]]
id = "here"
text = "This test"
status = "estimated"
"""
SCALED = """
[scaled]
mass_kg = 1100.0
length_m = 4.0
width_m = 1.7
wheelbase_m = 2.5
source = ["here"]
status = "estimated"
"""


def sizes(vehicle: Vehicle) -> dict[str, float]:
    return {name: getattr(vehicle, name) for name in SIZES}


def second_moments(vehicle: Vehicle) -> np.ndarray:
    """Integral of r r^T dm about the mass centre."""
    return 0.5 * np.trace(vehicle.inertia) * np.eye(3) - vehicle.inertia


@pytest.mark.parametrize("vehicle", [CAR, TRUCK, SEMI], ids=lambda v: v.name)
def test_same_mass_and_size_is_the_same_vehicle(vehicle: Vehicle) -> None:
    wanted = {name: getattr(vehicle, name) for name in SIZES[:3]}
    same = vehicle.scaled_to(vehicle.mass, **wanted)
    for name in ("nodes", "anchors", "wheels", "inertia", "center_of_mass"):
        np.testing.assert_allclose(getattr(same, name), getattr(vehicle, name), rtol=1e-12, atol=1e-12)


def test_zones_are_the_same_at_the_mass_that_they_hold_for() -> None:
    assert CAR.scaled_to(1719.0, length=CAR.length).zones == CAR.zones


@pytest.mark.parametrize("vehicle", [CAR, TRUCK], ids=lambda v: v.name)
def test_has_the_size_that_was_asked_for(vehicle: Vehicle) -> None:
    wanted = {"length": 0.85, "width": 1.08, "height": 0.93, "wheelbase": 0.9}
    wanted = {name: factor * getattr(vehicle, name) for name, factor in wanted.items()}
    scaled = vehicle.scaled_to(0.7 * vehicle.mass, **wanted, mass_center_height=0.7)
    assert sizes(scaled) == pytest.approx(wanted, rel=1e-12)
    assert scaled.mass == 0.7 * vehicle.mass
    assert scaled.mass_center_height == pytest.approx(0.7, rel=1e-12)
    assert np.linalg.eigvalsh(second_moments(scaled)).min() > 0.0
    np.testing.assert_allclose(scaled.wheels[:, 3], scaled.wheels[:, 2] + 0.7, rtol=1e-12)  # on the ground
    assert sizes(vehicle.scaled_to(2000.0, wheelbase=wanted["wheelbase"])) == pytest.approx(
        {**sizes(vehicle), "wheelbase": wanted["wheelbase"]}
    )


def test_places_between_the_axles_go_with_the_wheelbase() -> None:
    longer = TRUCK.scaled_to(TRUCK.mass, wheelbase=TRUCK.wheelbase + 1.0, length=TRUCK.length + 1.0)
    before, after = (np.array([*v.points["load_bed_leading_edge"]]) for v in (TRUCK, longer))
    assert after[0] == pytest.approx(before[0] * 5.0 / 4.0, rel=1e-12)
    np.testing.assert_array_equal(after[1:], before[1:])
    low, high = longer.skin_bounds
    assert high[0] + longer.center_of_mass[0] == pytest.approx(1.0)  # overhangs stay
    assert low[0] + longer.center_of_mass[0] == pytest.approx(-5.65 - 1.0)


def test_second_moments_go_with_mass_and_lengths() -> None:
    factors = np.array([0.8, 1.1, 1.2])
    wanted = {name: f * getattr(CAR, name) for name, f in zip(SIZES, factors, strict=False)}
    scaled = CAR.scaled_to(0.6 * CAR.mass, **wanted)
    expected = 0.6 * second_moments(CAR) * np.outer(factors, factors)
    np.testing.assert_allclose(second_moments(scaled), expected, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(scaled.center_of_mass, factors * CAR.center_of_mass, rtol=1e-12, atol=1e-12)
    for name in ("a_pillar_base", "driver_head"):
        np.testing.assert_allclose(scaled.points[name], factors * CAR.points[name], rtol=1e-12)


def test_two_steps_are_one() -> None:
    wanted = {"length": 4.2, "width": 1.7, "height": 1.5, "wheelbase": 2.5}
    once = CAR.scaled_to(1200.0, **wanted)
    twice = CAR.scaled_to(1500.0, length=4.6, height=1.4, wheelbase=2.6).scaled_to(1200.0, **wanted)
    np.testing.assert_allclose(twice.inertia, once.inertia, rtol=1e-12, atol=1e-9)
    assert twice.points["driver_head"] == pytest.approx(once.points["driver_head"], rel=1e-12)
    for name, zone in once.zones.items():
        for key, number in zone.items():
            np.testing.assert_allclose(np.array(twice.zones[name][key]), np.array(number), rtol=1e-9)


@pytest.mark.parametrize("size", [0.7, 1.25])
def test_similar_vehicle_is_crushed_by_the_same_share_of_its_length(size: float) -> None:
    """Time and depth go with the size, deceleration with its inverse; mass has no part in it."""
    settings = Settings(gravity=0.0, ground=False)
    car = CAR.without_tire_contact()
    similar = car.scaled_to(3000.0, **{name: size * getattr(car, name) for name in SIZES[:3]})
    runs = [
        Simulation(one, Barrier.rigid_wall(friction=0.0), 15.0, settings=settings).run().metrics
        for one in (car.scaled_to(car.mass), similar)
    ]
    assert runs[1]["dynamic_crush"] == pytest.approx(size * runs[0]["dynamic_crush"], rel=2e-3)
    assert runs[1]["delta_v"] == pytest.approx(runs[0]["delta_v"], rel=2e-3)
    force = 3000.0 / car.mass / size * runs[0]["peak_normal_force"]
    assert runs[1]["peak_normal_force"] == pytest.approx(force, rel=0.02)
    assert abs(runs[1]["energy_residual"]) < 1e-3


def test_indentation_and_goods_and_heights_go_with_the_size() -> None:
    scaled = TRUCK.with_indentation_length(0.5).scaled_to(TRUCK.mass, length=2.0 * TRUCK.length)
    assert scaled.indentation_length == pytest.approx(0.5 * 2.0**0.5)
    heap = TRUCK.with_payload(2000.0, height=1.0).scaled_to(TRUCK.mass, height=1.5 * TRUCK.height)
    low = TRUCK.with_payload(2000.0, height=1.0)
    load = heap.mass_center_height / 1.5 - low.scaled_to(TRUCK.mass).mass_center_height
    assert load == pytest.approx(0.0, abs=1e-9)
    assert heap.with_gvw(9000.0).mass == 9000.0
    raised = TRUCK.with_mass_center_height(1.4).scaled_to(8000.0, height=0.5 * TRUCK.height)
    assert raised.mass_center_height == pytest.approx(0.7)


def test_zones_keep_their_changes() -> None:
    changed = CAR.with_zone("bumper", k_unloading=8e6).scaled_to(2 * 1719.0, length=2.0 * CAR.length)
    # Twice the force at twice the length is the same stress at twice the deflection.
    law = changed.zones["bumper"]
    assert law.k_unloading == pytest.approx(4e6)
    assert law.envelope[1] == pytest.approx((2 * 0.130, CAR.zones["bumper"].envelope[1][1]))


@pytest.mark.parametrize("vehicle", [CAR, TRUCK, SEMI], ids=lambda v: v.name)
def test_saved_and_read(vehicle: Vehicle, tmp_path: Path) -> None:
    scaled = vehicle.scaled_to(0.8 * vehicle.mass, length=0.9 * vehicle.length, height=1.1 * vehicle.height)
    scaled.save(tmp_path / "v.toml")
    assert Vehicle.from_file(tmp_path / "v.toml") == scaled


def test_two_units_stay_joined() -> None:
    scaled = SEMI.scaled_to(30000.0, length=0.8 * SEMI.length, mass_center_height=1.3)
    assert scaled.length == pytest.approx(0.8 * SEMI.length)
    assert scaled.mass == pytest.approx(30000.0)
    assert scaled.mass_center_height == pytest.approx(1.3)
    assert scaled.joint.place_on_leading[0] == pytest.approx(0.8 * SEMI.joint.place_on_leading[0])
    with pytest.raises(ValueError, match="wheelbase must be None"):
        SEMI.scaled_to(30000.0, wheelbase=10.0)


@pytest.mark.parametrize(
    ("wanted", "message"),
    [
        ({"length": 4500.0}, r"length must be 1\.22\d* to 19\.58 m.*got 4500"),
        ({"height": -1.0}, "height must be finite and > 0, got -1"),
        ({"wheelbase": 4.9}, r"wheelbase must be shorter than the length, 4\.896 m; got 4\.9"),
        ({"mass_center_height": 2.0}, "mass_center_height must be below the vehicle's top"),
    ],
)
def test_refuses(wanted: dict[str, float], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        CAR.scaled_to(1500.0, **wanted)


class TestFile:
    """A file may say that its vehicle is another one, scaled."""

    def test_is_the_vehicle_scaled(self, tmp_path: Path) -> None:
        path = tmp_path / "v.toml"
        path.write_text(HEAD + SCALED)
        read = Vehicle.from_file(path, mesh_density=0.1)
        made = CAR.scaled_to(1100.0, length=4.0, width=1.7, wheelbase=2.5)
        for name in ("nodes", "anchors", "inertia", "wheels", "area"):
            np.testing.assert_array_equal(getattr(read, name), getattr(made, name))
        assert read.zones == made.zones
        read.save(tmp_path / "again.toml")
        assert Vehicle.from_file(tmp_path / "again.toml") == read

    def test_own_blocks_come_after(self, tmp_path: Path) -> None:
        path = tmp_path / "v.toml"
        own = """
[[point]]
name = "tow_hook"
at_m = [0.7, 0.3, 0.4]
source = ["here"]
status = "measured"
"""
        path.write_text(HEAD + SCALED + own)
        points = Vehicle.from_file(path, mesh_density=0.1).points
        assert points["tow_hook"] == (0.7, 0.3, 0.4)
        assert points["driver_head"][0] == pytest.approx(-1.55 * 2.5 / 2.825)
        path.write_text(HEAD + SCALED + own.replace("tow_hook", "driver_head"))
        assert Vehicle.from_file(path, mesh_density=0.1).points["driver_head"] == (0.7, 0.3, 0.4)
        path.write_text(HEAD + SCALED + own.replace("0.3, 0.4", "0.3"))
        with pytest.raises(ValueError, match=r"v\.toml:22: point\.2\.at_m"):
            Vehicle.from_file(path)

    def test_leaves_out(self, tmp_path: Path) -> None:
        path = tmp_path / "v.toml"
        left_out = SCALED.replace("[scaled]", '[scaled]\nwithout = ["driver_head", "luggage"]')
        path.write_text("gvw_kg = 1043.3\n" + HEAD + left_out)
        car = Vehicle.from_file(path, mesh_density=0.1)
        assert "driver_head" not in car.points
        assert car.mass == 1043.3  # 93.5 kg of 1,814.37 are luggage
        path.write_text(HEAD + SCALED.replace("[scaled]", '[scaled]\nwithout = ["sail"]'))
        with pytest.raises(ValueError, match=r"scaled\.without: must be one of .*got 'sail'"):
            Vehicle.from_file(path)

    def test_places_one_by_one(self, tmp_path: Path) -> None:
        path = tmp_path / "v.toml"
        rows = """
[scaled]
mass_kg = 1100.0
x_m = [[-3.916, -3.0], [-1.0, -1.0], [0.98, 0.98]]
z_m = [[0.0, 0.0], [1.445, 1.5]]
source = ["here"]
status = "estimated"
"""
        path.write_text(HEAD + rows)
        short = Vehicle.from_file(path, mesh_density=0.1)
        assert short.length == pytest.approx(3.98)
        assert short.points["a_pillar_base"][0] == pytest.approx(-0.50)
        assert short.points["driver_head"][2] == pytest.approx(1.20 * 1.5 / 1.445)

    @pytest.mark.parametrize(
        ("text", "line", "message"),
        [
            (SCALED.replace("= 4.0", "= 400.0"), 12, r"length must be 1\.224 to 19\.58 m.*got 400"),
            (SCALED.replace("1100.0", '"heavy"'), 13, "mass_kg"),
            (SCALED.replace("length_m = 4.0", "x_m = [[0.0, 0.0], [1.0, 0.9]]"), 12, "wheelbase_m.*must not"),
            (SCALED.replace('["here"]', '["there"]'), 12, "must be one of.*got 'there'"),
            (SCALED + "[changes]\ngvw_kg = -1.0\n", 20, "gvw_kg"),
        ],
    )
    def test_says_what_is_wrong(self, tmp_path: Path, text: str, line: int, message: str) -> None:
        path = tmp_path / "v.toml"
        path.write_text(HEAD + text)
        with pytest.raises(ValueError, match=message):
            Vehicle.from_file(path)

    def test_needs_a_vehicle_to_scale(self, tmp_path: Path) -> None:
        path = tmp_path / "v.toml"
        path.write_text((HEAD + SCALED).replace('extends = "passenger_car"', ""))
        with pytest.raises(ValueError, match="scaled: unknown key"):
            Vehicle.from_file(path)
