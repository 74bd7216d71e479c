"""Sizes and inertias of a vehicle as parameters, and what is drawn where they are assumed and not known."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import birm3d
import numpy as np
import pytest
from birm3d import Barrier, Simulation, Vehicle
from birm3d.reporting.class_bands import _PARTS
from birm3d.scene_parameters import parameter_names, unit_of, value_of, varied
from birm3d.study.class_draws import drawn_parameters, zones_set
from birm3d.study.distributions import sample
from birm3d.vehicle.class_scatter import QUANTITIES
from birm3d.vehicle.inertia import INERTIAS
from scipy import stats

SIZES = ("length", "width", "height", "wheelbase")
ASSUMED = {f"vehicle.{name}" for name in (*SIZES, "mass_center_height", "roll_inertia", "yaw_inertia")}
WALL = Barrier.rigid_wall()
CAR = Vehicle.from_facts("car", mass=1350.0, mesh_density=0.1)
TRUCK = Vehicle.from_facts("truck", mass=8200.0, mesh_density=0.1)
SEMI = Vehicle.preset("semi_truck", mesh_density=0.1)
BLOCK = birm3d.scenes.laboratory_block(8, k_initial=1e6, k_unloading=1e6)


def at(vehicle: Vehicle, barrier: Barrier = WALL, speed: float = 12.0, **others: Any) -> Simulation:
    return Simulation(vehicle, barrier, speed, **others)


def changed(vehicle: Vehicle, **numbers: float) -> Vehicle:
    return varied(at(vehicle), {f"vehicle.{name}": value for name, value in numbers.items()}).scene.vehicle


def second_moments(vehicle: Vehicle) -> np.ndarray:
    return 0.5 * np.trace(vehicle.inertia) * np.eye(3) - vehicle.inertia


# ---- inertia -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("vehicle", [CAR, TRUCK, BLOCK], ids=lambda one: one.name)
@pytest.mark.parametrize(
    "names",
    [(name,) for name in INERTIAS] + [INERTIAS[:2], INERTIAS[1:], INERTIAS[::2], INERTIAS],
    ids="+".join,
)
def test_inertias_are_those_that_were_asked_for(vehicle: Vehicle, names: tuple[str, ...]) -> None:
    factors = {"roll_inertia": 1.08, "pitch_inertia": 0.93, "yaw_inertia": 0.96}
    wanted = {name: factors[name] * getattr(vehicle, name) for name in names}
    made = vehicle.with_inertia(**wanted)
    assert {name: getattr(made, name) for name in names} == pytest.approx(wanted, rel=1e-12)
    assert np.linalg.eigvalsh(second_moments(made)).min() > 0.0
    assert made.mass == vehicle.mass
    np.testing.assert_array_equal(made.center_of_mass, vehicle.center_of_mass)
    np.testing.assert_array_equal(made.nodes, vehicle.nodes)
    assert changed(vehicle, **wanted) == made


def test_pitch_inertia_follows_from_that_in_yaw() -> None:
    """Mass along the vehicle alone is moved: what it adds to one it adds to the other."""
    made = CAR.with_inertia(yaw_inertia=1.3 * CAR.yaw_inertia)
    assert made.roll_inertia == pytest.approx(CAR.roll_inertia, rel=1e-12)
    more = made.yaw_inertia - CAR.yaw_inertia
    assert made.pitch_inertia - CAR.pitch_inertia == pytest.approx(more, rel=1e-9)
    back = CAR.with_inertia(pitch_inertia=made.pitch_inertia)
    np.testing.assert_allclose(back.inertia, made.inertia, rtol=1e-9, atol=1e-6)


def test_an_inertia_holds_for_a_later_mass_and_size() -> None:
    ratio = second_moments(CAR.with_inertia(roll_inertia=500.0, yaw_inertia=2900.0)) / second_moments(CAR)
    changes: list[Callable[[Vehicle], Vehicle]] = [
        lambda vehicle: vehicle.with_gvw(1500.0),
        lambda vehicle: vehicle.scaled_to(1200.0, length=4.0, width=1.6),
        lambda vehicle: vehicle.with_mass_center_height(0.5),
    ]
    for change in changes:
        after = change(CAR.with_inertia(roll_inertia=500.0, yaw_inertia=2900.0))
        found = second_moments(after) / second_moments(change(CAR))
        np.testing.assert_allclose(found.diagonal(), ratio.diagonal(), rtol=1e-12)
    twice = CAR.with_inertia(yaw_inertia=2900.0).with_inertia(yaw_inertia=2500.0)
    assert twice.yaw_inertia == pytest.approx(2500.0, rel=1e-12)


def test_an_inertia_is_kept_in_files(tmp_path: Path) -> None:
    made = CAR.with_inertia(pitch_inertia=2100.0)
    made.save(tmp_path / "car.toml")
    assert Vehicle.from_file(tmp_path / "car.toml") == made
    result = at(made).run()
    result.capsule(tmp_path / "run.birm3d")
    assert birm3d.load(tmp_path / "run.birm3d").scene.vehicle == made
    assert birm3d.rerun(tmp_path / "run.birm3d").same


def test_a_greater_yaw_inertia_yaws_less() -> None:
    """Off the middle of a pole the vehicle turns: the same blow turns more inertia by less."""
    pole = at(CAR, Barrier.pole(diameter=0.6), 6.0, impact_offset=0.5)
    rates = [
        np.abs(varied(pole, {"vehicle.yaw_inertia": value}).run().angular_velocity[:, 2]).max()
        for value in (1800.0, 2550.0, 3600.0)
    ]
    assert rates[0] > 1.1 * rates[1] > 1.2 * rates[2]


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: CAR.with_inertia(), "at least one of roll_inertia, pitch_inertia, yaw_inertia, got none"),
        (lambda: CAR.with_inertia(yaw_inertia=-1.0), "yaw_inertia must be finite and > 0, got -1"),
        (
            lambda: CAR.with_inertia(yaw_inertia="3 kg"),
            "yaw_inertia must be a number in kg m.2, .*got '3 kg'",
        ),
        (lambda: changed(CAR, yaw_inertia=50.0), r"yaw_inertia must be above 3\d\d\.\d+ kg m\^2, .*got 50"),
        (lambda: changed(CAR, pitch_inertia=50.0), r"pitch_inertia must be above 1\d\d\.\d+ kg m\^2.*got 50"),
        (
            lambda: CAR.with_inertia(roll_inertia=500.0, pitch_inertia=1000.0, yaw_inertia=1600.0),
            "must each be below the sum of the other two, got 500, 1000, 1600",
        ),
        (lambda: SEMI.with_inertia(yaw_inertia=1e5), "inertia must be given to one of the units of 'semi"),
        (
            lambda: Vehicle.preset("cargo_truck").with_inertia(yaw_inertia=4e4).with_sliding_bed(),
            r"inertia of its solids .*got 'cargo_truck' after with_inertia\(\)",
        ),
        (lambda: changed(CAR, length=40.0), "length must be .* a quarter to four times.*got 40"),
        (lambda: changed(CAR, length=0.0), "length must be finite and > 0, got 0"),
        (lambda: changed(CAR, wheelbase=4.6), "wheelbase must be shorter than the length"),
        (lambda: changed(SEMI, yaw_inertia=1e5), "parameter must be one of"),
        (lambda: changed(SEMI, wheelbase=9.0), "parameter must be one of"),
        (lambda: changed(BLOCK, length=1.0), "parameter must be one of"),
    ],
)
def test_refuses(make: Callable[[], Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        make()


# ---- sizes -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("kind", "base"), [("car", CAR), ("truck", TRUCK)])
@pytest.mark.parametrize("name", SIZES)
def test_a_size_makes_the_vehicle_that_the_fact_would_have_made(kind: str, base: Vehicle, name: str) -> None:
    """Its structure, zones and load too: the mass of a truck is its load's."""
    value = 1.07 * getattr(base, name)
    made = changed(base, **{name: value})
    facts = {size: getattr(base, size) for size in SIZES} if name != "length" else {}
    known = Vehicle.from_facts(kind, mass=base.mass, mesh_density=0.1, **{**facts, name: value})
    assert made.mass == base.mass
    assert getattr(made, name) == pytest.approx(value, rel=1e-12)
    for array in ("nodes", "anchors", "wheels", "center_of_mass"):
        np.testing.assert_allclose(getattr(made, array), getattr(known, array), rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(made.inertia, known.inertia, rtol=1e-9, atol=1e-6)
    for zone, law in known.zones.items():
        for number, wanted in law.items():
            np.testing.assert_allclose(np.array(made.zones[zone][number]), np.array(wanted), rtol=1e-9)
    assert zones_set(made) == ()
    assert name not in {one.quantity for one in made.assumptions}


def test_both_units_of_a_vehicle_have_another_size() -> None:
    names = parameter_names(at(SEMI))
    assert {"vehicle.length", "vehicle.width", "vehicle.height"} <= set(names)
    made = changed(SEMI, width=1.1 * SEMI.width)
    assert made.width == pytest.approx(1.1 * SEMI.width, rel=1e-12)
    assert [unit.mass for unit in made.units] == [unit.mass for unit in SEMI.units]
    assert made.length == pytest.approx(SEMI.length, rel=1e-12)


def test_numbers_that_are_given_beside_a_size_hold() -> None:
    """Laws go with the size; one that is given is not changed any more."""
    numbers = {"vehicle.length": 4.0, "vehicle.yaw_inertia": 2000.0, "vehicle.mass_center_height": 0.6}
    made = varied(at(CAR), {**numbers, "zone.door.k_unloading": 5e7, "vehicle.height": 1.3})
    assert {name: value_of(made, name) for name in numbers} == pytest.approx(numbers, rel=1e-12)
    assert made.scene.vehicle.zones["door"].k_unloading == 5e7
    assert (unit_of("vehicle.length"), unit_of("vehicle.yaw_inertia")) == ("m", "kg m^2")


# ---- what is drawn -----------------------------------------------------------------------------------------


def test_bands_are_those_of_the_assumptions() -> None:
    told = {one.name: one for one in CAR.assumptions if one.value is not None}
    found = CAR.assumed_distributions()
    assert set(found) == ASSUMED
    for parameter, distribution in found.items():
        one = told[parameter.removeprefix("vehicle.")]
        assert value_of(at(CAR), parameter) == pytest.approx(one.value, rel=1e-9)
        assert distribution.ppf([0.1, 0.5, 0.9]) == pytest.approx([one.low, one.value, one.high], rel=1e-4)


def test_the_band_of_the_pitch_inertia_follows() -> None:
    """It is not drawn itself. Of 200 vehicles as they are drawn 80 % lie in its band, all are buildable."""
    (pitch,) = (one for one in CAR.assumptions if one.name == "pitch_inertia")
    inertias = {name: d for name, d in CAR.assumed_distributions().items() if name.endswith("_inertia")}
    rows = sample(inertias, 200, 1)
    drawn = [CAR.with_inertia(roll_inertia=roll, yaw_inertia=yaw).pitch_inertia for roll, yaw in rows]
    low, high = np.quantile(drawn, [0.1, 0.9])
    assert low == pytest.approx(pitch.low, rel=0.04)
    assert high == pytest.approx(pitch.high, rel=0.04)


@pytest.mark.parametrize("known", [*SIZES, "mass_center_height"])
def test_facts_are_not_drawn(known: str) -> None:
    car = Vehicle.from_facts("car", mass=1350.0, mesh_density=0.05, **{known: getattr(CAR, known)})
    assert set(car.assumed_distributions()) == ASSUMED - {f"vehicle.{known}"}
    drawn = drawn_parameters(at(car), 5)
    if known == "mass_center_height":  # is measured to 1 %
        assert np.ptp(np.log(drawn["vehicle.mass_center_height"])) < 0.05
    else:
        assert f"vehicle.{known}" not in drawn
        assert ASSUMED - {f"vehicle.{known}"} <= set(drawn)


def test_a_known_mass_centre_stays_where_the_height_is_drawn() -> None:
    car = Vehicle.from_facts("car", mass=1350.0, mass_center_height=0.6, mesh_density=0.05)
    assert changed(car, height=1.6).mass_center_height == pytest.approx(0.6, rel=1e-12)


def test_what_is_given_later_is_not_drawn(tmp_path: Path) -> None:
    later = {
        "vehicle.length": CAR.scaled_to(1350.0, length=4.2),
        "vehicle.yaw_inertia": CAR.with_inertia(yaw_inertia=2400.0),
        "vehicle.mass_center_height": CAR.with_mass_center_height(0.6),
        "vehicle.width": changed(CAR, width=1.8),
    }
    for name, vehicle in later.items():
        vehicle.save(tmp_path / "v.toml")
        for one in (vehicle, Vehicle.from_file(tmp_path / "v.toml")):
            assert name not in one.assumed_distributions()
            assert name not in drawn_parameters(at(one), 3)
            assert name.removeprefix("vehicle.") not in {told.name for told in one.assumptions}
    longer = later["vehicle.length"].assumed_distributions()["vehicle.wheelbase"]
    assert longer.median() == pytest.approx(later["vehicle.length"].wheelbase)


def test_presets_have_no_assumptions() -> None:
    assert Vehicle.preset("small_car", mesh_density=0.05).assumed_distributions() == {}
    assert BLOCK.assumed_distributions() == {}


def test_a_sliding_bed_leaves_the_sizes_to_be_drawn() -> None:
    sliding = TRUCK.with_sliding_bed()
    expected = {f"vehicle.{name}" for name in (*SIZES[:3], "mass_center_height")}
    assert set(sliding.assumed_distributions()) == expected
    assert expected <= set(drawn_parameters(at(sliding), 3))


def test_monte_carlo_takes_them() -> None:
    study = birm3d.monte_carlo(at(CAR), CAR.assumed_distributions(), 24, metrics=["dynamic_crush"])
    assert set(study.parameters) == ASSUMED
    assert study.failed == {}
    assert np.ptp(study.metrics["dynamic_crush"]) > 0.0
    # Of a similar vehicle crush goes with the length.
    slope, _, correlation, _, _ = stats.linregress(
        np.log(study.parameters["vehicle.length"]), np.log(study.metrics["dynamic_crush"])
    )
    assert correlation > 0.5
    assert slope == pytest.approx(1.0, abs=0.7)


def test_predictions_draw_what_is_assumed() -> None:
    known = {name: getattr(CAR, name) for name in (*SIZES, "mass_center_height")}
    whole = Vehicle.from_facts("car", mass=1350.0, mesh_density=0.1, **known)
    assert whole.with_inertia(yaw_inertia=2500.0).assumed_distributions() == {}
    bands = [birm3d.predict(at(one), 32, metrics=["dynamic_crush"]) for one in (whole, CAR)]
    assert set(bands[1].drawn) >= ASSUMED
    assert not set(bands[0].drawn) & {f"vehicle.{size}" for size in SIZES}
    assert bands[1].study.failed == {}
    for name in set(bands[0].drawn) - {"vehicle.mass_center_height"}:  # common random numbers
        np.testing.assert_allclose(
            bands[0].study.parameters[name], bands[1].study.parameters[name], rtol=1e-9
        )
    widths = [math.log(band.high["dynamic_crush"] / band.low["dynamic_crush"]) for band in bands]
    assert widths[1] > widths[0]


def test_dossiers_have_words_for_all_that_is_drawn() -> None:
    assert set(_PARTS) == set(QUANTITIES)
