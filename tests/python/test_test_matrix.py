"""Simulations of the tests of a standard: vehicle, speed, angle, and what it knows no vehicle for."""

from __future__ import annotations

from contextlib import suppress

import birm3d
import pytest
from birm3d import Barrier, Vehicle, units
from birm3d.assessment.roadside import EN_1317, MASH
from birm3d.assessment.security import SECURITY


def test_mash_level() -> None:
    tests = birm3d.test_matrix("MASH TL-4", mesh_density=0.1)
    assert isinstance(tests, list)
    assert tests.names == ("4-10", "4-11", "4-12")
    conditions = [(s.scene.vehicle.mass, s.scene.impact_speed * 3.6, s.scene.impact_angle) for s in tests]
    assert [kind for kind in (s.scene.vehicle.kind for s in tests)] == ["car", "pickup", "truck"]
    for found, expected in zip(
        conditions, [(1100.0, 100.0, 25.0), (2270.0, 100.0, 25.0), (10_000.0, 90.0, 15.0)], strict=True
    ):
        assert found == pytest.approx(expected)
    assert all(s.scene.barrier is None for s in tests)
    assert tests[0].run().outcome == "undecided"  # on its own, for a second


@pytest.mark.parametrize(
    ("standard", "mass", "speed", "angle"),
    [
        ("MASH 2-11", 2270.0, units.km_h(70.0), 25.0),
        ("MASH 5-12", 36_000.0, units.km_h(80.0), 15.0),
        ("EN 1317 TB32", 1500.0, units.km_h(110.0), 20.0),
        ("EN 1317 TB42", 10_000.0, units.km_h(70.0), 15.0),
        ("ASTM F2656 M50", 6800.0, units.mph(50.0), 90.0),
        ("ASTM F2656 PU60", 2300.0, units.mph(60.0), 90.0),
        ("ASTM F2656-07 P40", 2300.0, units.mph(40.0), 90.0),
        ("SD-STD-02.01 K12", 6804.0, units.mph(50.0), 90.0),
        ("IWA 14-1 V/1500[M1]/48/90", 1500.0, units.km_h(48.0), 90.0),
        ("PAS 68 V/2500[N1G]/64/45:0.0", 2500.0, units.km_h(64.0), 45.0),
    ],
)
def test_one_test(standard: str, mass: float, speed: float, angle: float) -> None:
    (test,) = birm3d.test_matrix(standard, mesh_density=0.1)
    assert test.scene.vehicle.mass == pytest.approx(mass)
    assert test.scene.impact_speed == pytest.approx(speed)
    assert test.scene.impact_angle == angle


def test_what_it_makes_is_rated_by_the_same_standard() -> None:
    """The vehicles, speeds and angles are those that the rating asks for: only what is hit may fail."""
    posts = Barrier.bollards(count=3)
    (truck,) = birm3d.test_matrix("ASTM F2656 M50", barrier=posts, mesh_density=0.3)
    assert birm3d.rate(truck.run(), "ASTM F2656").designation == "M50-P1"
    (code,) = birm3d.test_matrix("ISO 22343-1 V/1500[M1]/48/90", barrier=posts, mesh_density=0.3)
    assert birm3d.rate(code.run(), "ISO 22343-1").designation.startswith("V/1500[M1]/48/90:")
    level = birm3d.test_matrix("MASH TL-3", barrier=Barrier.jersey(), mesh_density=0.3)
    rating = birm3d.rate([test.run() for test in level], "MASH TL-3")
    assert [one.name for one in rating.criteria] == ["test 3-10", "test 3-11"]
    assert rating.contained


def test_a_semi_truck_on_a_tall_wall() -> None:
    (test,) = birm3d.test_matrix("MASH 5-12", barrier=Barrier.jersey(height=1.07), mesh_density=0.1)
    rating = birm3d.rate(test.run(), "MASH TL-5")
    assert rating.designation == "MASH 5-12: pass"
    row = {one.name: one for one in rating.criteria}
    assert row["G: upright"].grade == "yes"
    assert row["impact severity"].value == pytest.approx(595.4, rel=1e-3)
    assert rating.penetration > 0.3  # the van leans over the wall


def test_ballast_is_as_high_as_mash_asks_for() -> None:
    """The whole's mass centre follows from structure and load, whose middle is 1.60 m or 1.85 m high."""
    for standard, height in (("MASH 4-12", 1.60), ("MASH 5-12", 1.85)):
        (test,) = birm3d.test_matrix(standard, mesh_density=0.1)
        carrier = test.scene.vehicle.units[-1]
        empty = carrier.with_payload(0.0)
        load = carrier.mass - empty.mass
        moment = carrier.mass * carrier.mass_center_height - empty.mass * empty.mass_center_height
        assert moment / load == pytest.approx(height, abs=1e-6)


def test_own_vehicles() -> None:
    bus = Vehicle.preset("cargo_truck", mesh_density=0.1).with_gvw(13_000.0)
    car, own = birm3d.test_matrix("EN 1317 H2", vehicles={"13-t bus": bus}, mesh_density=0.1)
    assert own.scene.vehicle is bus
    assert car.scene.vehicle.mass == pytest.approx(900.0)


@pytest.mark.parametrize(
    ("standard", "vehicles", "message"),
    [
        ("MASH", None, "standard must name a level .TL-1, .* or a test"),
        ("MASH TL-7", None, "standard must name a level"),
        ("EN 1317 N1", {"bus": None}, "vehicles must"),
        ("ASTM F2656", None, "standard must name one of SC, FS, PU, M, C7, H with 30, 40 or 50"),
        ("ASTM F2656 M60", None, "standard must name one of SC"),
        ("ASTM F2656 C50", None, "standard must name one of SC"),
        ("SD-STD-02.01 K6", None, "standard must name one of K4, K8, K12"),
        ("IWA 14-1 N3C", None, "standard must have a code such as"),
        ("IWA 14-1 V/9999[M1]/48/90", None, "standard must have a code such as"),
        ("F2656 M50", None, "standard must be one of ASTM F2656"),
    ],
)
def test_bad_input(standard: str, vehicles: dict[str, Vehicle] | None, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        birm3d.test_matrix(standard, vehicles=vehicles, mesh_density=0.1)


@pytest.mark.filterwarnings("ignore::birm3d.MassWarning")  # 30 t has no preset of its own
def test_every_vehicle_is_found_or_asked_for() -> None:
    codes = [f"MASH {name}" for name in MASH.tests] + [f"EN 1317 {name}" for name in EN_1317.tests]
    codes += [f"{s} {one.code}30" for s in ("ASTM F2656", "ASTM F2656-07") for one in SECURITY[s].vehicles]
    codes += [
        f"{s} V/{one.mass:.0f}[{one.code}]/48/90"
        for s in ("IWA 14-1", "PAS 68")
        for one in SECURITY[s].vehicles
    ]
    known = []
    for code in codes:
        with suppress(ValueError):
            known += birm3d.test_matrix(code, mesh_density=0.1).names
    assert set(MASH.tests) <= set(known)
    assert {"M30", "PU30", "FS30", "SC30", "TB11", "TB32", "TB42", "TB81"} <= set(known)
