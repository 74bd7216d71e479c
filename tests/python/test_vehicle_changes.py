"""No change of a vehicle is lost in silence; its mass centre and its inertia belong together."""

from __future__ import annotations

import dataclasses
import pickle
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from birm3d import Barrier, Simulation, UnitWarning, Vehicle, _core, scenes
from birm3d.scene.codec import decode, encode
from birm3d.scene_parameters import parameter_names, varied
from birm3d.vehicle.payload import solids_at
from birm3d.vehicle.vehicle_file import VehicleFile

CAR = Vehicle.preset("passenger_car", mesh_density=0.1)
TRUCK = Vehicle.preset("cargo_truck", mesh_density=0.1)
SEMI = Vehicle.preset("semi_truck", mesh_density=0.1)

WITH: dict[str, Callable[[Vehicle], Vehicle]] = {
    "gvw": lambda v: v.with_gvw(1.1 * v.mass),
    "payload": lambda v: v.with_payload(300.0),
    "scaled": lambda v: v.scaled_to(1.1 * v.mass),
    "mesh": lambda v: v.with_mesh_density(0.15),
    "height": lambda v: v.with_mass_center_height(1.1 * v.mass_center_height),
    "rate": lambda v: v.with_rate_sensitivity(0.05),
    "reach": lambda v: v.with_indentation_length(0.5),
    "tyres": lambda v: v.without_tire_contact(),
    "zone": lambda v: v.with_zones({"engine": v.zones["engine"].scaled(1.2)}),
}
# Others of every public field.
OTHERS: dict[str, Callable[[Vehicle], Any]] = {
    "name": lambda v: "another",
    "mass": lambda v: 1.3 * v.mass,
    "center_of_mass": lambda v: v.center_of_mass + np.array([0.1, 0.0, 0.0]),
    "inertia": lambda v: 1.2 * v.inertia,
    "nodes": lambda v: v.nodes * [1.001, 1.0, 1.0],
    "anchors": lambda v: v.anchors * [0.999, 1.0, 1.0],
    "area": lambda v: 1.1 * v.area,
    "zone_of_node": lambda v: np.where(v.zone_of_node == 1, 2, v.zone_of_node),
    "quads": lambda v: v.quads[::-1].copy(),
    "wheels": lambda v: v.wheels * [1.01, 1.0, 1.0, 1.0],
    "mass_center_height": lambda v: v.mass_center_height + 0.1,
    "zones": lambda v: {name: zone.scaled(1.5) for name, zone in v.zones.items()},
    "rate_sensitivity": lambda v: 0.07,
    "indentation_length": lambda v: 0.31,
    "wheel_of_node": lambda v: np.where(v.wheel_of_node == 0, 1, v.wheel_of_node),
    "zone_of_wheel": lambda v: np.full_like(v.zone_of_wheel, -1),
    "along_of_node": lambda v: np.where(np.arange(v.n_nodes) == 7, 0, v.along_of_node),
}


def changed(vehicle: Vehicle, field: str) -> Vehicle:
    return dataclasses.replace(vehicle, **{field: OTHERS[field](vehicle)})


def same(a: Any, b: Any) -> bool:
    return dict(a) == dict(b) if hasattr(a, "keys") else bool(np.array_equal(a, b))


def test_every_public_field_is_tried() -> None:
    names = {field.name for field in dataclasses.fields(Vehicle) if not field.name.startswith("_")}
    assert names == set(OTHERS)


@pytest.mark.parametrize("method", WITH)
@pytest.mark.parametrize("field", OTHERS)
def test_a_replaced_field_is_kept_or_the_next_change_is_refused(field: str, method: str) -> None:
    """What is left is the other value, or what the method itself is there to change."""
    if field == "mass_center_height":  # contradicts center_of_mass at once
        with pytest.raises(ValueError, match="mass_center_height must be that of center_of_mass"):
            changed(CAR, field)
        return
    vehicle = changed(CAR, field)
    try:
        result = WITH[method](vehicle)
    except ValueError as error:
        assert field in str(error)  # noqa: PT017
        assert "must be changed after what is made from its file" in str(error)  # noqa: PT017
        return
    if (method, field) in (("rate", "rate_sensitivity"), ("reach", "indentation_length")):
        return
    of_nodes = ("nodes", "anchors", "area", "zone_of_node", "wheel_of_node", "along_of_node")
    if method == "tyres" and field in of_nodes:
        shell = vehicle.wheel_of_node < 0
        assert same(getattr(result, field), getattr(vehicle, field)[shell])
    elif field == "zones":
        ratio = result.zones["engine"].k_unloading / CAR.zones["engine"].k_unloading
        expected = {"scaled": 1.5 * result.mass / CAR._file.zones_mass, "zone": 1.5 * 1.2}.get(method, 1.5)
        assert ratio == pytest.approx(expected, rel=1e-9)
    else:
        assert same(getattr(result, field), getattr(vehicle, field))


@pytest.mark.parametrize("field", OTHERS)
def test_a_vehicle_of_two_units_is_changed_in_its_units(field: str) -> None:
    if field == "name":
        assert changed(SEMI, field).with_gvw(30000.0).name == "another"
        return
    with pytest.raises(ValueError, match=field):
        changed(SEMI, field)
    unit = changed(SEMI.units[1], "inertia")
    with pytest.raises(ValueError, match="inertia of 'semi_trailer' must be changed after"):
        SEMI.with_unit(1, unit).with_gvw(30000.0)


def test_what_was_replaced_is_known_in_copies_and_files() -> None:
    heavy = dataclasses.replace(CAR, inertia=1.2 * CAR.inertia)
    arrays: dict[str, Any] = {}
    for copy in (pickle.loads(pickle.dumps(heavy)), decode(encode(heavy, arrays, "v"), arrays)):
        assert copy == heavy
        with pytest.raises(ValueError, match="inertia of 'passenger_car' must be changed after"):
            copy.with_gvw(1900.0)
    assert dataclasses.replace(CAR, inertia=CAR.inertia.copy()).with_gvw(1900.0) == CAR.with_gvw(1900.0)


def test_zones_keep_their_names() -> None:
    with pytest.raises(ValueError, match="zones must keep their names and order"):
        dataclasses.replace(CAR, zones=dict(reversed(list(CAR.zones.items()))))
    block = scenes.laboratory_block(20, k_initial=3e6, k_unloading=3e6)
    with pytest.raises(ValueError, match="zones must keep their names and order, none; got bumper"):
        dataclasses.replace(block, zones={"bumper": CAR.zones["bumper"]})


# ---- what has no effect ------------------------------------------------------------------------------------


def test_a_zone_without_trusses_can_not_be_changed() -> None:
    bare = CAR.without_tire_contact()
    tire = bare.zones["tire"]
    with pytest.raises(ValueError, match=r"zone must be one that trusses belong to .*got 'tire'"):
        bare.with_zones({"tire": tire.scaled(2.0)})
    assert bare.with_zones({"tire": tire}) == bare
    sim = Simulation(bare, Barrier.rigid_wall(), 10.0)
    assert not any(name.startswith("zone.tire") for name in parameter_names(sim))
    with pytest.raises(ValueError, match=r"or it has no effect; got 'zone.tire.scale'"):
        varied(sim, {"zone.tire.scale": 2.0})
    assert any(name == "zone.tire.scale" for name in parameter_names(Simulation(CAR, None, 1.0, duration=1)))


def test_a_core_that_no_zone_lists_is_refused() -> None:
    data = CAR._file.model_dump(by_alias=True)
    known = tuple(box["name"] for box in data["core"])
    for zone in data["zone"]:
        if zone["panels"] != ("tire",) and not zone["core"]:
            zone["core"] = known
    VehicleFile.model_validate(data)
    data["core"] = (*data["core"], {**data["core"][0], "name": "spare"})
    with pytest.raises(ValueError, match=r"must be in the list 'core' of a zone.*got 'spare'"):
        VehicleFile.model_validate(data)
    data["zone"][0]["core"] = ()  # trusses of this zone start from the nearest of all boxes
    VehicleFile.model_validate(data)


# ---- mass centre -------------------------------------------------------------------------------------------


def moments(vehicle: Vehicle, stretch: float) -> Any:
    """Mass properties of the file's solids with all heights above the ground times a number."""
    corners, density = solids_at(vehicle._file, vehicle.mass, vehicle._load_density)
    return _core.mass_properties(corners * [1.0, 1.0, stretch], density / stretch)


@pytest.mark.parametrize("vehicle", [CAR, TRUCK, *SEMI.units], ids=lambda v: v.name)
@pytest.mark.parametrize("share", [0.7, 1.0, 1.35])
def test_the_inertia_is_that_of_solids_whose_mass_centre_is_there(vehicle: Vehicle, share: float) -> None:
    height = share * vehicle.mass_center_height
    there = vehicle.with_mass_center_height(height)
    solids = moments(vehicle, share)
    assert solids.center_of_mass[2] == pytest.approx(height, rel=1e-12)
    assert there.center_of_mass == pytest.approx(solids.center_of_mass, rel=1e-12, abs=1e-12)
    scale = np.trace(vehicle.inertia)
    assert np.abs(there.inertia - solids.inertia).max() < 1e-12 * scale
    a, b, c = np.linalg.eigvalsh(there.inertia)
    assert a > 0.0
    assert a + b > c
    assert there.inertia[2, 2] == pytest.approx(vehicle.inertia[2, 2], rel=1e-12)
    # Its shape and its wheels stand where they stood.
    assert there.nodes + there.center_of_mass == pytest.approx(vehicle.nodes + vehicle.center_of_mass)
    assert there.height == pytest.approx(vehicle.height, rel=1e-12)
    assert (there.with_mass_center_height(None) == vehicle) or share != 1.0


@pytest.mark.parametrize("share", [0.01, 0.3, 2.5])
def test_far_heights_still_have_an_inertia_that_can_be(share: float) -> None:
    a, b, c = np.linalg.eigvalsh(CAR.with_mass_center_height(share * CAR.mass_center_height).inertia)
    assert a > 0.0
    assert a + b > c


@pytest.mark.parametrize("method", ["gvw", "payload", "scaled", "mesh", "rate", "tyres"])
@pytest.mark.parametrize("vehicle", [TRUCK, SEMI], ids=["one", "two"])
def test_a_height_that_was_asked_for_stays(vehicle: Vehicle, method: str) -> None:
    change = WITH[method]
    height = 1.1 * vehicle.mass_center_height
    first, last = change(vehicle.with_mass_center_height(height)), change(vehicle)
    last = last.with_mass_center_height(height)
    assert first.mass_center_height == pytest.approx(height, rel=1e-12)
    assert np.abs(first.inertia - last.inertia).max() < 1e-9 * np.trace(last.inertia)  # in any order
    assert first.mass == pytest.approx(last.mass, rel=1e-12)


def test_a_vehicle_from_arrays_is_stretched_too() -> None:
    arms = {"inertia": np.diag([400.0, 1500.0, 1700.0]), "nodes": [[1.0, 0.0, 0.0]], "anchors": [[0.0] * 3]}
    box = Vehicle.from_arrays(mass=1000.0, **arms, k_initial=1e5, k_unloading=1e5, mass_center_height="50 cm")
    high = box.with_mass_center_height(1.0)
    # Second moments: x 1400, y 300, z 100 kg m^2; the last one times four.
    assert np.diag(high.inertia) == pytest.approx([700.0, 1800.0, 1700.0], rel=1e-12)
    assert high.with_gvw(2000.0).mass_center_height == 1.0
    with pytest.raises(ValueError, match="must be given: 'from_arrays' has no file"):
        box.with_mass_center_height(None)
    with pytest.raises(ValueError, match="mass_center_height must be above the ground to be changed"):
        scenes.laboratory_block(20, k_initial=3e6, k_unloading=3e6).with_mass_center_height(0.5)


@pytest.mark.parametrize("height", [0.0, -1.0, np.nan, 1.5, 600.0])
def test_heights_that_can_not_be_are_refused(height: float) -> None:
    with pytest.raises(ValueError, match=r"mass_center_height must be .*got"):
        CAR.with_mass_center_height(height)


# ---- dimensions and units ----------------------------------------------------------------------------------


@pytest.mark.parametrize("vehicle", [CAR, TRUCK, SEMI.units[0]], ids=lambda v: v.name)
def test_dimensions_are_those_of_the_file(vehicle: Vehicle) -> None:
    file = vehicle._file.dimensions
    found = (vehicle.length, vehicle.width, vehicle.height, vehicle.wheelbase)
    expected = (file.length_m, file.width_m, file.height_m, file.wheelbase_m)
    assert found == pytest.approx(expected, abs=0.01)
    turned = vehicle.with_mass_center_height(1.1 * vehicle.mass_center_height)
    assert (turned.length, turned.height) == pytest.approx((vehicle.length, vehicle.height), rel=1e-12)


def test_dimensions_of_two_units_and_of_none() -> None:
    tractor, trailer = SEMI.units
    assert tractor.length < SEMI.length < tractor.length + trailer.length
    assert trailer.height == pytest.approx(SEMI.height, abs=1e-9)
    assert tractor.track == SEMI.track
    assert tractor.wheelbase < SEMI.wheelbase < SEMI.length
    block = scenes.laboratory_block(20, k_initial=3e6, k_unloading=3e6)
    assert block.wheelbase is None
    assert block.track is None


def test_vehicles_are_changed_in_any_units() -> None:
    assert Vehicle.preset("passenger_car", gvw="4000 lb", mesh_density=0.1) == CAR.with_gvw(4000 * 0.45359237)
    assert TRUCK.with_gvw("7.5 t") == TRUCK.with_gvw(7500.0)
    assert TRUCK.with_payload("2t", density="300 kg/m^3") == TRUCK.with_payload(2000.0, density=300.0)
    assert CAR.scaled_to("2 t").mass == 2000.0
    assert CAR.with_mass_center_height("60 cm") == CAR.with_mass_center_height(0.6)
    assert CAR.with_indentation_length("500 mm").indentation_length == 0.5
    assert CAR.with_rate_sensitivity("0.05 s/m").rate_sensitivity == 0.05
    law = {"k_hardening": 0.0, "k_unloading": "9 MPa/m", "f_max": "300 kPa"}
    zone = CAR.with_zone("hood", k_initial="3 MPa/m", knee="10 cm", **law).zones["hood"]
    assert (zone.k_initial, zone.knee, zone.f_max, zone.k_unloading) == (3e6, 0.1, 3e5, 9e6)
    assert CAR.with_gvw("4000 lbs").mass == CAR.with_gvw("4000 lb").mass
    with pytest.raises(ValueError, match=r"gvw must be a number in kg, .* kg, t, lb, lbs; got '30 mph'"):
        CAR.with_gvw("30 mph")


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (
            lambda: Vehicle.preset("cargo_truck", gvw=7.5, mesh_density=0.1),
            r"gvw = 7.5 kg .* 340.195 to 68,038.9 kg",
        ),
        (lambda: TRUCK.with_gvw(7.5), r"gvw = 7.5 kg .* text with its unit, as '7.5 t'"),
        (lambda: TRUCK.with_payload(2.5), r"payload = 2.5 kg .* 0 or 10 to 100,000 kg"),
        (lambda: CAR.scaled_to(1.8), r"mass = 1.8 kg"),
        (lambda: SEMI.with_gvw(330000.0 * 2), r"gvw = 660000 kg"),
    ],
)
def test_masses_in_the_wrong_unit_are_warned_of(make: Callable[[], Vehicle], message: str) -> None:
    with pytest.warns(UnitWarning, match=message) as told:
        make()
    assert len(told) == 1
    assert told[0].filename == __file__


def test_a_zone_is_scaled_as_a_whole() -> None:
    car = Vehicle.preset("pickup", mesh_density=0.1)
    assert car.with_zone("bumper", scale=1.2).zones["bumper"] == car.zones["bumper"].scaled(1.2)
    both = car.with_zone("bumper", scale=2.0, k_unloading=3e8).zones["bumper"]
    assert both == dataclasses.replace(car.zones["bumper"].scaled(2.0), k_unloading=3e8)
    with pytest.raises(ValueError, match="scale must be finite and > 0, got -1"):
        car.with_zone("bumper", scale=-1.0)
