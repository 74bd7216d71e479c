"""Text with units wherever a number has a dimension, and a word about numbers in the wrong unit."""

from __future__ import annotations

import dataclasses
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from birm3d import (
    Barrier,
    FreeStanding,
    MassWarning,
    Settings,
    Simulation,
    UnitWarning,
    Vehicle,
    critical_impact_point,
    design_load,
    fragility,
    monte_carlo,
    predict,
    scenes,
    sweep,
    units,
)
from birm3d.calibration import Parameter
from birm3d.scene_parameters import parameter_names, quantity_of, value_of, varied
from birm3d.simulation.scene_file import read_scene_file
from scipy import stats

WALL = Barrier.rigid_wall()
BLOCK = scenes.laboratory_block(20, k_initial=3e6, k_unloading=3e6)


def at(speed: Any = 10.0, barrier: Barrier = WALL, **others: Any) -> Simulation:
    return Simulation(BLOCK, barrier, speed, **others)


# ---- text --------------------------------------------------------------------------------------------------


def test_a_simulation_is_given_in_any_units() -> None:
    text = at(
        "50 mph",
        impact_angle="1.5rad",
        impact_offset="12 in",
        standoff="50mm",
        impact_yaw="2 deg",
        impact_roll="1°",
        duration="150 ms",
    ).scene
    assert text.impact_speed == units.mph(50)
    assert text.impact_angle == pytest.approx(np.degrees(1.5), rel=1e-15)
    assert text.impact_offset == 12 * 0.0254
    assert (text.standoff, text.duration) == (0.05, 0.15)
    assert (text.impact_yaw, text.impact_roll) == (2.0, 1.0)


def test_barriers_are_given_in_any_units() -> None:
    assert Barrier.pole(diameter="10 in", heading="0.5 rad").diameter == 10 * 0.0254
    assert Barrier.rigid_wall(width="20 ft", height="1200mm", thickness="40 cm") == Barrier.rigid_wall(
        width=20 * 0.3048, height=1.2, thickness=0.4
    )
    row = Barrier.bollards(
        diameter="220 mm", height="3ft", spacing="4 ft", row_spacing="1.5 m", row_offset="60 cm", rows=2
    )
    expected = Barrier.bollards(
        diameter=0.22, height=3 * 0.3048, spacing=4 * 0.3048, row_spacing=1.5, row_offset=0.6, rows=2
    )
    assert row == expected
    chain = Barrier.jersey(height="42 in", length="12 m", free_standing=True, density="150 lb/ft^3")
    assert chain.height == 42 * 0.0254
    assert chain.free_standing is not None
    assert chain.free_standing.density == pytest.approx(150 * 0.45359237 / 0.3048**3, rel=1e-14)
    assert Barrier.pole(origin=("1 ft", 0.6, "0 m")).origin == (0.3048, 0.6, 0.0)
    assert dataclasses.replace(row, spacing="2 m").spacing == 2.0  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("make", "parts"),
    [
        (lambda: at("30"), ["impact_speed", "m/s", "mph", "got '30'"]),
        (lambda: at("30 kg"), ["impact_speed", "speed units", "km/h", "got '30 kg'"]),
        (lambda: at(None), ["impact_speed", "got None"]),
        (lambda: at(duration="3 m"), ["duration", "time units s, ms", "got '3 m'"]),
        (lambda: at(impact_angle="90 grad"), ["impact_angle", "deg", "rad", "got '90 grad'"]),
        (lambda: at(impact_offset="here"), ["impact_offset", "mm", "got 'here'"]),
        (lambda: Barrier.bollards(spacing="1.2 kg"), ["spacing", "length units m, mm", "got '1.2 kg'"]),
        (lambda: Barrier.pole(heading="1 m"), ["heading", "rad", "got '1 m'"]),
        (lambda: Barrier.pole(origin=("a", 0.0, 0.0)), ["origin", "ft", "got 'a'"]),
        (lambda: sweep(at(), impact_speed=["30 deg"]), ["impact_speed", "mph", "got '30 deg'"]),
    ],
)
def test_text_of_another_dimension_is_refused(make: Callable[[], Any], parts: list[str]) -> None:
    with pytest.raises(ValueError, match="must be a number in") as caught:
        make()
    for part in parts:
        assert part in str(caught.value)


def test_sweeps_take_text_and_give_numbers() -> None:
    study = sweep(at(), impact_speed=["20 mph", 10.0], metrics=["dynamic_crush"])
    assert study.parameters["impact_speed"].tolist() == [units.mph(20), 10.0]
    plain = sweep(at(), impact_speed=[units.mph(20), 10.0], metrics=["dynamic_crush"])
    assert study.state_hash == plain.state_hash
    assert varied(at(), {"impact_offset": "30 cm"}).scene.impact_offset == 0.3


def test_every_number_of_a_scene_that_has_a_unit_takes_text() -> None:
    car = Simulation(Vehicle.preset("passenger_car", mesh_density=0.1), Barrier.bollards(), 10.0)
    for name in parameter_names(car):
        value = value_of(car, name)
        if quantity_of(name) is None or not isinstance(value, float) or not np.isfinite(value):
            continue
        unit = units._QUANTITIES[quantity_of(name)][0]
        if "scale" not in name:
            assert value_of(varied(car, {name: f"{value!r} {unit}"}), name) == pytest.approx(value, rel=1e-12)
        with pytest.raises(ValueError, match=rf"{name.split('[')[0]}.* must be a number in"):
            varied(car, {name: "1 furlong"})


def test_settings_studies_and_calibrations_take_text() -> None:
    settings = Settings(time_step="20 us", output_interval="0.1 ms", gravity="1 g")
    found = (settings.time_step, settings.output_interval, settings.gravity)
    assert found == pytest.approx((2e-5, 1e-4, 9.80665), rel=1e-15)
    assert dataclasses.replace(Settings(), gravity="1 g").gravity == 9.80665  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"output_interval must be a number in s, or text .*got '1 m'"):
        Settings(output_interval="1 m")
    assert FreeStanding(mass_per_length="0.6 t/m").mass_per_length == 600.0
    parameter = Parameter("vehicle.gvw", "3000 lb", 2500.0, start="1.8 t", prior=("1.8 t", "100 kg"))
    assert (parameter.lower, parameter.upper, parameter.start) == (3000 * 0.45359237, 2500.0, 1800.0)
    assert parameter.prior == (1800.0, 100.0)
    with pytest.raises(ValueError, match=r"upper of vehicle.gvw must be a number in kg, .*got '30 mph'"):
        Parameter("vehicle.gvw", 1000.0, "30 mph")
    with pytest.raises(ValueError, match=r"lower of zone.a.scale must be a number, got '1 m'"):
        Parameter("zone.a.scale", "1 m", 2.0)
    deep = critical_impact_point(at(), "dynamic_crush", {"impact_speed": ("20 mph", 10.0)}, points=3)
    assert deep.point == {"impact_speed": 10.0}
    friction = {"barrier.friction": stats.uniform(0.1, 0.1)}
    risk = fragility(at(), ["20 mph", "10 m/s"], friction, n=1, exceeds={"dynamic_crush": 0.45})
    assert risk.speeds.tolist() == [units.mph(20), 10.0]


# ---- numbers in the wrong unit -----------------------------------------------------------------------------


def box(size: float) -> Any:
    vertices = size * np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return Barrier.from_mesh(vertices, [f for a, b, c, d in quads for f in ((a, b, c), (a, c, d))])


WRONG: dict[str, tuple[Callable[[], Any], str]] = {
    "speed in km/h": (lambda: at(300.0), r"impact_speed = 300 m/s .* 0 to 45 m/s"),
    "speed in km/h of a road": (
        lambda: at(50),
        r"impact_speed = 50 m/s \(180 km/h\) is most likely in another unit: .* as '50 km/h'",
    ),
    "angle in rad": (
        lambda: at(impact_angle=1.57),
        r"impact_angle = 1.57 deg .* in radians .* 0 or 1 to 180 deg",
    ),
    "yaw in rad": (lambda: at(impact_yaw=1.5708), r"impact_yaw = 1.5708 deg .* in radians \(90 deg\)"),
    "roll in rad": (lambda: at(impact_roll=-0.349), r"impact_roll .* in radians \(-20 deg\)"),
    "heading in rad": (lambda: Barrier.pole(heading=0.7854), r"heading .* in radians \(45 deg\)"),
    "duration in ms": (lambda: at(duration=150), r"duration = 150 s .* 0 to 100 s"),
    "standoff in mm": (lambda: at(standoff=500), r"standoff = 500 m .* 0 to 200 m"),
    "natural period in ms": (
        lambda: design_load(at(), natural_period=50, draws=0),
        r"natural_period = 50 s .* 0 to 4 s, or text with its unit, as '50 ms'",
    ),
    "diameter in mm": (lambda: Barrier.pole(diameter=320), r"diameter = 320 m .* 0.01 to 5 m"),
    "spacing in mm": (lambda: Barrier.bollards(spacing=1200), r"spacing = 1200 m .* 0.01 to 100 m"),
    "height in mm": (lambda: Barrier.bollards(height=900), r"height = 900 m .* 0.001 to 20 m"),
    "width in mm": (lambda: Barrier.rigid_wall(width=6000), r"width = 6000 m .* 0.05 to 1,000 m"),
    "density in t/m^3": (
        lambda: Barrier.jersey(length=4, free_standing=True, density=2.4),
        r"density = 2.4 kg/m\^3 .* 100 to 20,000 kg/m\^3",
    ),
    "mesh in mm": (lambda: box(1000.0), r"vertices .* 1000 m high .* 0.001 to 100 m"),
    "a list": (
        lambda: sweep(at(), impact_speed=[10.0, 300.0], metrics=["dynamic_crush"]),
        r"impact_speed = 300 m/s",
    ),
    "a distribution": (
        lambda: monte_carlo(at(), {"impact_speed": stats.norm(300, 1)}, 1, metrics=["dynamic_crush"]),
        r"impact_speed = 300 m/s",
    ),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_number_in_the_wrong_unit_is_warned_of(name: str) -> None:
    make, message = WRONG[name]
    with pytest.warns(UnitWarning, match=message) as told:
        make()
    (one,) = (warning for warning in told if warning.category is UnitWarning)
    assert one.filename == __file__  # it points at the caller


def test_what_is_usual_or_says_its_unit_is_not_warned_of() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        at("300 km/h", impact_yaw="1.5708 deg", duration="101 s")
        for yaw in (0.0, 1.0, 2.0, 0.5, 90.0, -30.0):
            at(45.0, impact_angle=4.0, impact_yaw=yaw, impact_roll=-yaw)
        at(barrier=Barrier.rigid_wall(width=6.0, thickness=4.0), impact_angle=0.0)
        box(0.15)
        Simulation.from_scene(at("400 km/h").scene)  # known already
        at(units.parse("400 km/h", "speed"))  # as the command line and scene files say it


# ---- masses that no vehicle of the class can have ----------------------------------------------------------

TRUCK = Vehicle.preset("cargo_truck", mesh_density=0.1)
USUAL = r"far outside what 'cargo_truck' can have: usual is 2,300 to 17,010 kg"


def told_once(make: Callable[[], Any], message: str) -> None:
    with pytest.warns(MassWarning, match=message) as told:
        make()
    (one,) = (warning for warning in told if warning.category in (MassWarning, UnitWarning))
    assert one.filename == __file__


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Vehicle.preset("cargo_truck", gvw=500, mesh_density=0.1), f"gvw = 500 kg is {USUAL}"),
        (lambda: Vehicle.preset("cargo_truck", gvw="500 kg", mesh_density=0.1), f"gvw = 500 kg is {USUAL}"),
        (lambda: TRUCK.with_gvw(2250.0), f"gvw = 2,250 kg is {USUAL}"),
        (lambda: TRUCK.with_gvw("40 t"), f"gvw = 40,000 kg is {USUAL}"),
        (
            lambda: Vehicle.preset("semi_truck", mesh_density=0.1).with_gvw(90_000.0),
            r"'semi_truck' can have: usual is 6,580 to 81,647 kg",
        ),
        (
            lambda: Vehicle.from_facts("truck", mass=1000.0),
            r"mass = 1,000 kg is far outside what 'cargo_truck'",
        ),
    ],
)
def test_a_mass_that_the_class_can_not_have_is_warned_of(make: Callable[[], Any], message: str) -> None:
    told_once(make, message)


def test_a_scene_file_tells_an_odd_mass(tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    blocks = ('[vehicle]\npreset = "cargo_truck"\ngvw = "500 kg"', '[barrier]\nkind = "rigid_wall"')
    path.write_text("\n".join((*blocks, '[impact]\nspeed = "30 mph"')))
    told_once(lambda: read_scene_file(path), f"gvw = 500 kg is {USUAL}")


def test_a_changed_mass_in_a_file_and_a_varied_one_are_warned_of(tmp_path: Path) -> None:
    path = tmp_path / "light.toml"
    with pytest.warns(MassWarning):
        TRUCK.with_gvw(500.0).save(path)
    told_once(lambda: Vehicle.from_file(path), f"changes.gvw_kg = 500 kg is {USUAL}")
    scene = tmp_path / "scene.toml"
    scene.write_text(f'[vehicle]\nfile = "{path.name}"\n[impact]\nspeed = "30 mph"\nduration = "0.1 s"\n')
    told_once(lambda: read_scene_file(scene), f"changes.gvw_kg = 500 kg is {USUAL}")
    crash = Simulation(TRUCK, WALL, 10.0)
    told_once(lambda: varied(crash, {"vehicle.gvw": "500 kg"}), f"vehicle.gvw = 500 kg is {USUAL}")


def test_studies_tell_odd_masses_once() -> None:
    crash = Simulation(TRUCK, WALL, 10.0)
    wanted = ["dynamic_crush"]
    masses = {"vehicle.gvw": [500.0, 1000.0, 6804.0]}
    message = rf"vehicle.gvw = 500 kg \(the worst of 2 of 3 runs\) is {USUAL}"
    told_once(lambda: sweep(crash, masses, metrics=wanted), message)
    light = {"vehicle.gvw": stats.uniform(1000.0, 10.0)}
    told_once(lambda: monte_carlo(crash, light, 4, metrics=wanted), r"\(the worst of 4 of 4 runs\)")


def test_a_prediction_does_not_repeat_what_its_vehicle_was_warned_of() -> None:
    with pytest.warns(MassWarning):
        light = TRUCK.with_gvw(2000.0)
    with warnings.catch_warnings():
        warnings.simplefilter("error", MassWarning)
        predict(Simulation(light, WALL, 5.0), 8, metrics=["dynamic_crush"])


def test_usual_masses_are_not_warned_of() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for name in Vehicle.presets():
            preset = Vehicle.preset(name, mesh_density=0.1)
            preset.with_gvw(1.2 * preset.mass)
        TRUCK.with_gvw(4600.0).with_gvw(12_000.0)
        TRUCK.scaled_to(3000.0)  # another vehicle of the class
        Vehicle.from_facts("truck", mass="18 t", mesh_density=0.1)
        BLOCK.with_gvw(10.0)  # a laboratory body has no class
