"""The vehicle file format: presets meet their sources, bad files are refused with file, line and value."""

from __future__ import annotations

import pickle
import re
import sys
from pathlib import Path

import birm3d
import numpy as np
import pytest
from birm3d import units
from birm3d.vehicle.combination_file import read_combination
from birm3d.vehicle.scaling import Factors
from birm3d.vehicle.vehicle_file import (
    Solid,
    VehicleFile,
    VehicleFileError,
    preset_names,
    preset_path,
    read_vehicle_file,
    unit_paths,
)

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib


@pytest.fixture(scope="module", params=unit_paths())
def vehicle(request) -> VehicleFile:
    return read_vehicle_file(unit_paths()[request.param])


# ---- presets ---------------------------------------------------------------------------------------------


def scaled_masses(vehicle: VehicleFile, gvw: float) -> np.ndarray:
    """Masses of the solids at a weight: payload takes the difference first, then everything."""
    mass = np.array([solid.mass for solid in vehicle.solids])
    payload = np.array([solid.payload for solid in vehicle.solids])
    loaded = mass[payload].sum()
    if loaded > 0:
        mass[payload] *= max(0.0, 1 + (gvw - mass.sum()) / loaded)
    return mass * gvw / mass.sum()


def heights_of_goods(vehicle: VehicleFile, mass: np.ndarray) -> dict[int, float]:
    """Tops of the boxes of goods of given masses, by their place among the solids.

    They are as dense as the file says, and no higher than their space.
    """
    tops = {}
    for i, solid in enumerate(vehicle.solids):
        if solid.fills_to_m is None:
            continue
        (x0, x1), (y0, y1), (floor, _) = solid.box_m
        stated = vehicle.changes and vehicle.changes.load_density_kg_per_m3
        height = mass[i] / ((x1 - x0) * (y1 - y0) * (stated or solid.density))
        tops[i] = min(floor + height, solid.fills_to_m)
    return tops


def box_mass_properties(vehicle: VehicleFile, gvw: float) -> dict[str, float]:
    """Mass properties of a vehicle made of boxes, from the formula of a box and the parallel-axis theorem."""
    mass = scaled_masses(vehicle, gvw)
    corners = np.array([solid.corners for solid in vehicle.solids])
    for i, top in heights_of_goods(vehicle, mass).items():
        corners[i, 4:, 2] = top
    middle = corners.mean(axis=1)
    size2 = np.ptp(corners, axis=1) ** 2
    center = mass @ middle / mass.sum()
    arm2 = (middle - center) ** 2
    square = mass @ (size2 / 12 + arm2)  # integrals of x^2, y^2, z^2 over the mass
    return {
        "mass_kg": mass.sum(),
        "cg_behind_front_axle_m": -center[0],
        "cg_left_m": center[1],
        "cg_height_m": center[2],
        "Ixx_kg_m2": square[1] + square[2],
        "Iyy_kg_m2": square[0] + square[2],
        "Izz_kg_m2": square[0] + square[1],
    }


def test_presets_are_there_by_weight():
    paper = {
        "passenger_car": units.lb(4000),
        "minivan": units.lb(5000),
        "pickup": units.lb(7500),
        "cargo_truck": units.lb(15000),
        "semi_truck": units.lb(72000),
    }
    standards = {
        "small_car": 900.0,
        "mash_1100c": 1100.0,
        "sedan_1500": 1500.0,
        "mash_2270p": 2270.0,
        "pickup_4x4_2500": 2500.0,
        "heavy_pickup": 2910.0,
        "van_3500": 3500.0,
        "cabover_7200": 7200.0,
        "cabover_7500": 7500.0,
        "mash_10000s": 10000.0,
        "bus_13t": 13000.0,
        "heavy_truck_29500": 29500.0,
        "mash_36000v": 36000.0,
    }
    assert preset_names() == (*paper, "paper_pickup", *standards)
    for weights in (paper, standards):
        assert list(weights.values()) == sorted(weights.values())
        for name, weight in weights.items():
            file_name, gvw = weighed(name)
            assert file_name == name
            assert gvw == pytest.approx(weight, abs=0.05)


def weighed(preset: str) -> tuple[str, float]:
    """Name in the file of a preset, and the weight that it has [kg]: as loaded, where the file loads it."""
    combination = read_combination(preset_path(preset))
    if combination is not None:
        return combination.file.name, combination.file.gvw_kg
    file = read_vehicle_file(preset_path(preset))
    loaded = file.changes and file.changes.gvw_kg
    return file.name, loaded or file.gvw_kg


# Scaled trucks of which no mass centre or inertia was found, in a standard or measured: what MASH asks of
# ballast is no property of the whole. The vehicles that they are scaled from meet their own targets.
NO_TARGETS = {"cabover_7200", "mash_10000s", "mash_36000v_tractor", "mash_36000v_trailer"}


def test_mass_properties_meet_the_targets(vehicle):
    assert bool(vehicle.targets) is (vehicle.name not in NO_TARGETS)
    for target in vehicle.targets:
        value = box_mass_properties(vehicle, target.at_gvw_kg)[target.quantity]
        assert value == pytest.approx(target.value, abs=target.tolerance), target.quantity


def test_payload_carries_the_usual_range_of_weights(vehicle):
    payload = sum(solid.mass for solid in vehicle.solids if solid.payload)
    if vehicle.kind == "tractor":
        assert payload == 0.0  # it is the trailer's
        return
    most = 0.2  # people and luggage
    if any(solid.fills_to_m for solid in vehicle.solids):
        most = 0.85
    elif vehicle.kind == "bus":
        most = 0.3  # its passengers: 3 t of 13 t
    assert 0.05 * vehicle.gvw_kg < payload < most * vehicle.gvw_kg


def test_vehicles_are_left_right_balanced(vehicle):
    assert box_mass_properties(vehicle, vehicle.gvw_kg)["cg_left_m"] == pytest.approx(0.0, abs=1e-12)


def test_inertia_is_that_of_a_possible_body(vehicle):
    got = box_mass_properties(vehicle, vehicle.gvw_kg)
    roll, pitch, yaw = (got[f"{axis}_kg_m2"] for axis in ("Ixx", "Iyy", "Izz"))
    assert roll < min(pitch, yaw)
    assert max(pitch, yaw) < roll + min(pitch, yaw)
    # Cars and pickups are wider than high; a van of goods is not.
    assert pitch < yaw or any(solid.fills_to_m for solid in vehicle.solids)


def test_wheels_stand_under_the_vehicle(vehicle):
    x = sorted({wheel.center_m[0] for wheel in vehicle.wheels})
    assert len(vehicle.wheels) >= 4
    if vehicle.kind == "semi_trailer":
        assert x[-1] < 0.0  # the origin is the kingpin
    else:
        assert x[-1] == 0.0  # the origin is the front axle
    assert -x[0] == pytest.approx(vehicle.dimensions.wheelbase_m, abs=1e-9)
    outer = max(abs(wheel.center_m[1]) + wheel.width_m / 2 for wheel in vehicle.wheels)
    assert outer <= vehicle.dimensions.width_m / 2 + 1e-9


def test_the_law_of_a_zone_is_an_envelope(vehicle):
    assert ("bumper" in vehicle.zone_names) is (vehicle.kind != "semi_trailer")
    for zone in vehicle.zones:
        points = np.array(zone.envelope)
        assert (points[0] == 0).all()
        slope = np.diff(points[:, 1]) / np.diff(points[:, 0])
        assert slope.max() <= zone.k_unloading_Pa_per_m
        assert slope[0] > 0


def test_the_paper_pickup_stands_alone():
    """Its runs are compared with a table of the paper: no other preset may alter them."""
    path = preset_path("paper_pickup")
    assert "extends" not in tomllib.loads(path.read_text(encoding="utf-8"))
    paper = read_vehicle_file(path)
    assert paper.gvw_kg == 3407.72
    assert "engine" not in paper.zone_names  # its front is even


def test_a_vehicle_is_a_value(vehicle):
    again = read_vehicle_file(unit_paths()[vehicle.name])
    assert again == vehicle
    assert hash(again) == hash(vehicle)
    assert pickle.loads(pickle.dumps(vehicle)) == vehicle
    with pytest.raises(ValueError, match="frozen"):
        vehicle.gvw_kg = 1.0
    with pytest.raises(ValueError, match="frozen"):
        vehicle.zones[0].knee_m = 1.0


def test_files_are_readable_and_hold_no_paths(vehicle):
    text = unit_paths()[vehicle.name].read_text(encoding="utf-8")
    assert not re.search(r"(^|\W)/\w+/|\\", text)
    assert max(map(len, text.splitlines())) <= 110


def test_a_vehicle_with_changed_laws_is_a_value(tmp_path):
    path = tmp_path / "changed.toml"
    law = "k_initial_Pa_per_m = 1e6\nknee_m = 0.1\nk_hardening_Pa_per_m = 0.0\nf_max_Pa = 1e5\n"
    rest = f"{law}k_unloading_Pa_per_m = 1e7\n"
    path.write_text(f'extends = "passenger_car"\n[changes.zone.bumper]\n{rest}')
    file, again = read_vehicle_file(path), read_vehicle_file(path)
    assert list(file.changes.zone) == ["bumper"]
    assert again == file
    assert hash(again) == hash(file)
    assert pickle.loads(pickle.dumps(file)) == file
    with pytest.raises(TypeError, match="item assignment"):
        file.changes.zone["bumper"] = None
    path.write_text(path.read_text().replace("1e5", "2e5"))
    assert read_vehicle_file(path) != file


# ---- solids ----------------------------------------------------------------------------------------------

BLOCK = {"source": ("s",), "status": "estimated", "name": "part"}
WEDGE = ((0, 0, 0), (2, 0, 0), (2, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"payload": False}, "must be payload with box_m to fill a space"),
        ({"box_m": None, "corners_m": WEDGE}, "must be payload with box_m to fill a space"),
        ({"fills_to_m": 0.4}, r"must be at least the top of box_m, 0.5, got 0.4"),
    ],
)
def test_a_load_space_is_a_box_of_payload_below_a_roof(changes, message):
    good = {
        "box_m": ((-1.0, 1.0), (0.0, 3.0), (0.0, 0.5)),
        "mass_kg": 60.0,
        "payload": True,
        "fills_to_m": 2.0,
    }
    assert Solid(**BLOCK, **good).density == pytest.approx(20.0)
    with pytest.raises(ValueError, match=message):
        Solid(**BLOCK, **{**good, **changes})


def test_scaled_files_are_files(vehicle):
    """Masses, and stresses relative to what the zones hold for; nothing else."""
    heavy = vehicle.scaled_to(2.0 * vehicle.gvw_kg)
    assert heavy.solids_mass == pytest.approx(2.0 * vehicle.solids_mass, rel=1e-12)
    assert heavy.gvw_kg == heavy.zones_mass == 2.0 * vehicle.gvw_kg
    factor = heavy.gvw_kg / vehicle.zones_mass
    for old, new in zip(vehicle.zones, heavy.zones, strict=True):
        points, scaled = np.array(old.envelope), np.array(new.envelope)
        np.testing.assert_allclose(scaled[:, 1], factor * points[:, 1], rtol=1e-12)
        np.testing.assert_allclose(scaled[:, 0], points[:, 0], rtol=1e-12)
    for part in ("dimensions", "wheels", "exterior", "core"):
        assert getattr(heavy, part) == getattr(vehicle, part)


def test_density_and_mass_are_two_ways_to_say_it():
    box = ((-1.0, 1.0), (0.0, 3.0), (0.0, 0.5))
    by_mass = Solid(**BLOCK, box_m=box, mass_kg=60.0)
    by_density = Solid(**BLOCK, box_m=box, density_kg_per_m3=20.0)
    assert by_mass.volume == pytest.approx(3.0)
    assert by_mass.density == pytest.approx(20.0)
    assert by_density.mass == pytest.approx(60.0)
    assert Solid(**BLOCK, corners_m=by_mass.corners, mass_kg=60.0).volume == pytest.approx(3.0)


def test_a_wedge_has_its_own_volume():
    assert Solid(**BLOCK, corners_m=WEDGE, mass_kg=1.0).volume == pytest.approx(1.5)


@pytest.mark.parametrize(
    ("corners", "message"),
    [
        (WEDGE[4:] + WEDGE[:4], "counter-clockwise"),
        (WEDGE[3::-1] + WEDGE[:3:-1], "counter-clockwise"),
        ((*WEDGE[:6], (1, 1, 1.2), WEDGE[7]), "one plane"),
    ],
)
def test_corners_out_of_order_or_plane_are_refused(corners, message):
    with pytest.raises(ValueError, match=message):
        Solid(**BLOCK, corners_m=corners, mass_kg=1.0)


# ---- bad files -------------------------------------------------------------------------------------------

CAR = preset_path("passenger_car").read_text(encoding="utf-8")


def message_of(path: Path) -> str:
    with pytest.raises(VehicleFileError) as caught:
        read_vehicle_file(path)
    assert isinstance(caught.value, ValueError)
    return str(caught.value)


def line_of(text: str, part: str) -> int:
    return text[: text.index(part)].count("\n") + 1


@pytest.mark.parametrize(
    ("old", "new", "key", "says"),
    [
        # numbers
        ("gvw_kg = 1814.37", "gvw_kg = -1814.37", "gvw_kg", "greater than 0, got -1814.37"),
        ("gvw_kg = 1814.37", "gvw_kg = nan", "gvw_kg", "finite number, got nan"),
        ("gvw_kg = 1814.37", "gvw_kg = inf", "gvw_kg", "finite number, got inf"),
        ("gvw_kg = 1814.37", 'gvw_kg = "heavy"', "gvw_kg", "valid number, got 'heavy'"),
        ("gvw_kg = 1814.37", "gvw_kg = true", "gvw_kg", "valid number, got True"),
        ("gvw_kg = 1814.37", "gvw_kg = 4000", "gvw_kg", "within 1% of the solids' mass, 1814.37, got 4000"),
        ("[0.00, 0.915, 0.17", "[0.00, -0.915, 0.17", "exterior.stations_m.2.1", "got -0.915"),
        ("[0.00, 0.915, 0.17", "[0.00, 0.915, nan", "exterior.stations_m.2.2", "got nan"),
        ("[0.00, 0.915, 0.17", "[0.00, 0.915, 1.17", "exterior.stations_m.2", "below upper edge, got 1.17"),
        ("element_size_m = 0.", "element_size_m = 7.", "exterior.element_size_m", "less than or equal to 1"),
        ("[[0.02, 0.58]", "[[0.92, 0.58]", "solid.0.box_m", "increasing, got [0.92, 0.58]"),
        ("base_x_m = [-0.5", "base_x_m = [1.5", "exterior.upper.0.base_x_m", "must lie on the body"),
        ("bow_m = 0.12", "bow_m = -0.12", "exterior.front.bow_m", "greater than or equal to 0, got -0.12"),
        ("radius_m = 0.33", "radius_m = 0.44", "wheel.0.center_m", "radius_m = 0.44, got 0.33"),
        # keys
        ("payload = true", "payload = 1", "solid.24.payload", "valid boolean, got 1"),
        ("panels = [", 'panels = ["inside", ', "zone.engine.panels.0", "got 'inside'"),
        ("panels = [", "panel = [", "zone.engine.panel", "unknown key, got ('front',)"),
        ("height_m = 1.4", "hight_m = 1.4", "dimensions.hight_m", "unknown key, got 1.445"),
        ("format_version = 1", "format_version = 2", "format_version", "must be 1, got 2"),
        ('name = "passenger_car"', 'name = "Passenger Car"', "name", "got 'Passenger Car'"),
        # names that have to exist, or to differ
        ('source = ["layout"]', 'source = ["hearsay"]', "solid.0.source", "got 'hearsay'"),
        ('source = ["layout"]', "source = []", "solid.0.source", "at least 1 item"),
        ('status = "measured"', 'status = "sure"', "source.0.status", "got 'sure'"),
        ('core = ["bulkhead"]', 'core = ["keel"]', "zone.engine.core", "fire_wall; got 'keel'"),
        ('blocks = ["body"]', 'blocks = ["boot"]', "zone.engine.blocks", "body, cabin; got 'boot'"),
    ],
)  # fmt: skip
def test_a_bad_value_is_named_with_its_line(tmp_path, old, new, key, says):
    text = CAR.replace(old, new, 1)
    assert text != CAR
    path = tmp_path / "bad.toml"
    path.write_text(text)
    line = next(
        i for i, (a, b) in enumerate(zip(CAR.split("\n"), text.split("\n"), strict=True), 1) if a != b
    )
    if key == "wheel.0.center_m":
        line -= 1  # the radius was changed; the height of the centre, one line above, does not fit it
    first = message_of(path).splitlines()[0]
    assert first.startswith(f"{path}:{line}: {key}: ")
    assert says in first


@pytest.mark.parametrize(
    ("changes", "key", "says"),
    [
        ({"knee_m": "-0.1"}, "knee_m", "greater than 0, got -0.1"),
        ({"knee_m": None}, "knee_m", "missing"),
        ({"f_max_Pa": "1.0"}, "f_max_Pa", "stress at the knee, 50000, got 1"),
        ({"k_unloading_Pa_per_m": "1.5e6"}, "k_unloading_Pa_per_m", "every slope of the envelope (2e+06)"),
        ({"k_unloading_Pa_per_m": None}, "k_unloading_Pa_per_m", "missing"),
        ({"envelope_m_Pa": "[[0, 0], [0.1, 5.0]]"}, "k_initial_Pa_per_m", "together with envelope_m_Pa"),
        ({"x_m": "[1.0, 0.0]"}, "x_m", "must increase, got 1 followed by 0"),
        ({"y_m": "[-0.5, 0.5]"}, "y_m", "distances >= 0 from the middle plane, got [-0.5, 0.5]"),
        ({"elastic_recovery_m": "0.0"}, "elastic_recovery_m", "greater than 0, got 0.0"),
        (
            {"tail_slope_Pa_per_m": "1e6"},
            "k_unloading_Pa_per_m",
            "tail_depth must be given beside tail_slope",
        ),
        (
            {"tail_depth_m": "0.6", "tail_slope_Pa_per_m": "2e7"},
            "k_unloading_Pa_per_m",
            "every slope of the envelope (2e+07)",
        ),
    ],
)
def test_a_law_that_is_none_is_refused(tmp_path, changes, key, says):
    law = {
        "k_initial_Pa_per_m": "5e5",
        "knee_m": "0.1",
        "k_hardening_Pa_per_m": "2e6",
        "f_max_Pa": "1e6",
        "k_unloading_Pa_per_m": "1e7",
    }
    path = one_zone(tmp_path, {**law, **changes})
    line = line_of(path.read_text(), key) if changes.get(key, law.get(key)) else 2
    assert message_of(path).startswith(f"{path}:{line}: zone.door.{key}: ")
    assert says in message_of(path)


@pytest.mark.parametrize(
    ("envelope", "says"),
    [
        ("[[0, 0]]", "at least 2"),
        ("[[0, 1], [0.1, 5]]", "start at [0, 0], got [0.0, 1.0]"),
        ("[[0, 0], [0.2, 5], [0.2, 6]]", "deflections must increase, got 0.2 followed by 0.2"),
        ("[[0, 0], [0.2, -5]]", "greater than or equal to 0, got -5"),
    ],
)
def test_an_envelope_that_is_none_is_refused(tmp_path, envelope, says):
    path = one_zone(tmp_path, {"envelope_m_Pa": envelope, "k_unloading_Pa_per_m": "1e7"})
    message = message_of(path)
    assert message.startswith(f"{path}:{line_of(path.read_text(), 'envelope_m_Pa')}: zone.door.envelope_m_Pa")
    assert says in message


def one_zone(folder: Path, law: dict[str, str | None]) -> Path:
    """Write a car with another law for its doors."""
    lines = ['extends = "passenger_car"', "[zone.door]", 'panels = ["side"]', 'status = "estimated"']
    lines += ['source = ["layout"]', *(f"{key} = {value}" for key, value in law.items() if value is not None)]
    path = folder / "one_zone.toml"
    path.write_text("\n".join(lines))
    return path


def test_a_law_with_all_its_numbers_is_read_and_scaled(tmp_path):
    law = {"envelope_m_Pa": "[[0, 0], [0.2, 5e4]]", "k_unloading_Pa_per_m": "1e6"}
    more = {"elastic_recovery_m": "0.05", "tail_depth_m": "0.6", "tail_slope_Pa_per_m": "5e5"}
    vehicle = read_vehicle_file(one_zone(tmp_path, {**law, **more}))
    door = vehicle.zones[vehicle.zone_names.index("door")]
    assert door.law.curve.elastic_recovery == 0.05
    assert door.law.curve.envelope(1.0) == pytest.approx(5e4 + 0.4 * 5e5, rel=1e-12)
    double = door.scaled({"door": Factors(2.0, 1.0)}).law
    assert double == door.law.scaled(2.0)
    assert (double.elastic_recovery, double.tail_depth, double.tail_slope) == (0.05, 0.6, 1e6)
    assert double.k_unloading == 2e6


def test_a_falling_envelope_is_read(tmp_path):
    rows = "[[0, 0], [0.1, 5e4], [0.2, 2e4], [0.3, 9e4]]"
    vehicle = read_vehicle_file(one_zone(tmp_path, {"envelope_m_Pa": rows, "k_unloading_Pa_per_m": "1e6"}))
    door = vehicle.zones[vehicle.zone_names.index("door")]
    assert door.envelope == ((0.0, 0.0), (0.1, 5e4), (0.2, 2e4), (0.3, 9e4))


def test_everything_that_is_wrong_is_reported_at_once(tmp_path):
    path = tmp_path / "bad.toml"
    path.write_text(CAR.replace("bow_m = 0.12", "bow_m = -1").replace("width_m = 1.837", "width_m = 0"))
    assert len(message_of(path).splitlines()) == 2


def test_files_that_are_no_toml_or_not_there(tmp_path):
    path = tmp_path / "broken.toml"
    path.write_text(CAR.replace("gvw_kg = 1814.37", "gvw_kg = = 3"))
    assert f"line {line_of(path.read_text(), 'gvw_kg =')}" in message_of(path)
    path.write_bytes(b"title = '\xff'")
    assert "UTF-8" in message_of(path)
    assert "can not be read" in message_of(tmp_path / "missing.toml")
    with pytest.raises(ValueError, match=r"preset must be one of .*pickup.*; got 'tank'"):
        preset_path("tank")


# ---- extends ---------------------------------------------------------------------------------------------


def test_a_file_may_say_only_what_differs(tmp_path):
    (tmp_path / "other.toml").write_text(
        'extends = "passenger_car"\nname = "other"\n'
        '[[source]]\nid = "mine"\ntext = "own test"\nstatus = "measured"\n'
        '[zone.post]\npanels = ["side"]\nx_m = [-1.2, -1.0]\nsource = ["mine"]\nstatus = "measured"\n'
        "envelope_m_Pa = [[0, 0], [0.1, 9e4]]\nk_unloading_Pa_per_m = 1e7\n"
    )
    car = read_vehicle_file(preset_path("passenger_car"))
    other = read_vehicle_file(tmp_path / "other.toml")
    assert other.zone_names == ("post", *car.zone_names)  # what is new is matched first
    assert other.zones[1:] == car.zones
    assert other.sources[1:] == car.sources
    assert (other.name, other.gvw_kg) == ("other", car.gvw_kg)


def test_a_file_may_leave_zones_out(tmp_path):
    text = 'extends = "passenger_car"\nscatter = []\n'
    (tmp_path / "even.toml").write_text(text + 'without = ["zone.engine"]\n')
    car = read_vehicle_file(preset_path("passenger_car"))
    assert read_vehicle_file(tmp_path / "even.toml").zones == car.zones[1:]
    for value, said in (
        ('"zone.engine"', "without: must be a list of zones, got 'zone.engine'"),
        ('["zone.motor"]', "without: must be one of zone.boot_lid, zone.bumper"),
        ('[["zone.engine"]]', "; got ['zone.engine']"),
    ):
        (tmp_path / "bad.toml").write_text(f"{text}without = {value}\n")
        assert said in message_of(tmp_path / "bad.toml")


def test_zones_that_are_left_out_leave_the_scatter_of_the_class(tmp_path):
    text = 'extends = "passenger_car"\nwithout = ["zone.engine", "zone.tire"]\n'
    (tmp_path / "even.toml").write_text(text)
    zones = {one.name: one.zones for one in read_vehicle_file(tmp_path / "even.toml").scatter}
    whole = {one.name: one.zones for one in read_vehicle_file(preset_path("passenger_car")).scatter}
    assert zones["front"] == ("bumper", "engine_bay")
    assert whole["tires"] == ("tire",)
    assert set(whole) - set(zones) == {"tires", "springs"}  # of tires alone
    assert zones["mass_center_height"] == ()


def test_errors_are_reported_in_the_file_they_are_in(tmp_path):
    base, top = tmp_path / "base.toml", tmp_path / "top.toml"
    base.write_text(CAR.replace("bow_m = 0.12", "bow_m = -1"))
    top.write_text('extends = "base.toml"\n\ngvw_kg = -1\n')
    first, second = message_of(top).splitlines()
    assert first.startswith(f"{top}:3: gvw_kg: ")
    assert second.startswith(f"{base}:{line_of(CAR, 'bow_m')}: exterior.front.bow_m: ")


def test_files_that_extend_each_other_are_refused(tmp_path):
    for a, b in (("a", "b"), ("b", "a")):
        (tmp_path / f"{a}.toml").write_text(f'extends = "{b}.toml"\n')
    assert "in a circle" in message_of(tmp_path / "a.toml")


# ---- lines -----------------------------------------------------------------------------------------------


def test_every_value_of_the_presets_has_its_line():
    from birm3d.io.toml import Locator

    text = CAR.replace("mass_kg = ", "mass_kg=").replace("name = ", '"name" = ')
    lines = Locator(text).lines
    source = text.splitlines()

    def visit(value, path):
        assert path in lines, path
        if isinstance(value, dict):
            for key, item in value.items():
                visit(item, (*path, key))
                assert key in source[lines[(*path, key)] - 1]
        elif isinstance(value, list):
            for index, item in enumerate(value):
                visit(item, (*path, index))

    visit(tomllib.loads(text), ())


@pytest.mark.parametrize(
    "text",
    [
        'a = """x\n[b]\n"""\n[c]\nd = 1',
        "a = '''\n\"b = 2\n'''\n[c]\nd = 1",
        'a = "[c] # no" # [b]\n# x = 1\n[c]\nd = 1',
        "a = [\n [1, 2], # ]\n [3] ]\n[c]\nd = 1",
        "a = {b = [1,\n2], 'c' = \"}\"}\n[c]\nd = 1",
        "a.b.c = 1979-05-27T07:32:00Z\n[[e]]\n[[e]]\n[c]\nd = 1",
        "a = 1\r\n[c]\r\nd = 1",
    ],
)
def test_lines_after_all_kinds_of_values(text):
    from birm3d.io.toml import Locator

    tomllib.loads(text)
    lines = Locator(text).lines
    assert lines[("c",)] == line_of(text, "[c]\n" if "[c]\n" in text else "[c]\r")
    assert lines[("c", "d")] == lines[("c",)] + 1
    assert ("b",) not in lines


def test_no_file_of_the_package_and_no_page_quotes_from_memory() -> None:
    """A client reads the sources: a value without one at hand says so."""
    root = Path(birm3d.__file__).parent
    pages = [path for kind in ("toml", "csv", "py", "html") for path in root.rglob(f"*.{kind}")]
    pages += Path(__file__).parents[2].glob("docs/**/*.md")
    found = [str(path) for path in pages if "from memory" in " ".join(path.read_text("utf-8").split())]
    assert not found
