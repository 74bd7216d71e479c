"""Bands from how the vehicles of a class differ: birm3d.predict and the blocks [[scatter]]."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable
from functools import cache
from pathlib import Path
from statistics import NormalDist

import birm3d
import numpy as np
import pytest
from birm3d import Barrier, Prediction, Simulation, Vehicle, units
from birm3d.scene_parameters import value_of, varied
from birm3d.study.class_draws import drawn_parameters, draws, zones_set
from birm3d.study.predict import quantiles

CAR = Vehicle.preset("passenger_car", mesh_density=0.1)
WALL = Simulation(CAR, Barrier.rigid_wall(), units.km_h(56.0))
Z = NormalDist().inv_cdf(0.9)


@cache
def prediction() -> Prediction:
    return birm3d.predict(WALL, 64)


def test_median_and_band_are_those_of_the_class() -> None:
    """Displacement falls with the front's force alone: ends of the band are its quantiles, taken singly."""
    front = CAR.scatter["front"]
    for band, z in ((prediction().low, Z), (prediction().median, 0.0), (prediction().high, -Z)):
        factor = front.median * math.exp(front.log_sd * z)
        alone = varied(WALL, {"scatter.front": factor}).run().metrics["max_displacement"]
        assert band["max_displacement"] == pytest.approx(alone, rel=0.02)


def test_band_of_displacement_is_as_wide_as_tests_scatter() -> None:
    """NHTSA, 20 cars at 56 km/h: 80 % of displacements from 0.60 to 0.81 m, standard deviation 12 %."""
    band = prediction()
    width = math.log(band.high["max_displacement"] / band.low["max_displacement"])
    assert 0.7 < width / (2.0 * Z * 0.12) < 1.2
    assert 0.60 < band.median["max_displacement"] < 0.78


# 2.56 standard deviations of the logarithm, each about the mean of its class: tests/validation.
TESTS_SCATTER = {"max_displacement": 0.289, "peak_deceleration_cfc60": 0.421}


@pytest.mark.parametrize("name", ["passenger_car", "minivan", "pickup"])
def test_bands_at_a_wall_are_not_wider_than_40_tests_scatter(name: str) -> None:
    """They are drawn by one factor on the front, whose spread is that of displacement and peak."""
    wall = Simulation(Vehicle.preset(name, mesh_density=0.3), Barrier.rigid_wall(), units.km_h(56.0))
    band = birm3d.predict(wall, 32, metrics=list(TESTS_SCATTER))
    widths = {metric: math.log(band.high[metric] / band.low[metric]) for metric in TESTS_SCATTER}
    for metric, scatter in TESTS_SCATTER.items():
        assert 0.85 * scatter < widths[metric] <= scatter


def test_page_of_bands_has_its_tests_covered_and_no_band_too_wide() -> None:
    page = (Path(__file__).parents[1] / "validation/prediction_bands.md").read_text(encoding="utf-8")
    rows = [[cell.strip() for cell in line.strip("|\n").split("|")] for line in page.splitlines()]
    found = {row[0]: row[1:] for row in rows if len(row) == 7}
    for what in (
        "displacement, wall at 56 km/h",
        "peak deceleration, wall at 56 km/h",
        "static crush, pole into the side",
    ):
        inside, width, scatter = (float(cell.rstrip("%")) for cell in found[what][1:4])
        assert 70 <= inside <= 90
        assert width <= scatter


def test_common_random_numbers() -> None:
    """Another speed has the same draws: every vehicle is crushed more, the first to the last."""
    faster = birm3d.predict(varied(WALL, {"impact_speed": 17.0}), 64).study
    slow = prediction().study
    assert all(np.array_equal(faster.parameters[name], slow.parameters[name]) for name in slow.parameters)
    assert (faster.metrics["dynamic_crush"] > slow.metrics["dynamic_crush"]).all()
    again = birm3d.predict(WALL, 64)
    assert again.study.state_hash == slow.state_hash


def test_draws_are_normal_and_independent() -> None:
    columns = np.array(list(draws(8).values()))
    np.testing.assert_allclose(columns.mean(axis=1), 0.0, atol=0.02)
    np.testing.assert_allclose(columns.std(axis=1), 1.0, atol=0.03)
    correlation = np.corrcoef(columns) - np.eye(len(columns))
    assert np.abs(correlation).max() < 0.1
    assert np.abs(np.corrcoef(list(draws(5).values())) - np.eye(len(columns))).max() < 0.35, "of usual draws"
    assert quantiles(np.arange(10) + 0.5, 0.8) == pytest.approx((1.0, 5.0, 9.0))


def test_more_draws_change_little() -> None:
    few = birm3d.predict(WALL, 16, metrics=["max_displacement", "peak_force_50ms"])
    for name in few.median:
        for band, other in ((few.low, prediction().low), (few.high, prediction().high)):
            assert band[name] == pytest.approx(other[name], rel=0.05)


@pytest.mark.parametrize("name", [name for name in Vehicle.presets() if name != "paper_pickup"])
def test_presets_say_how_their_class_scatters(name: str) -> None:
    vehicle = Vehicle.preset(name, mesh_density=0.1)
    scene = Simulation(vehicle, Barrier.jersey(), 20.0, 20.0)
    found = drawn_parameters(scene, 3)
    assert {"scatter.front", "scatter.side", "scatter.tires"} <= set(found)
    assert {"vehicle.mass_center_height", "barrier.friction", "settings.mu_tire"} <= set(found)
    for parameter, values in found.items():
        assert np.median(values) == pytest.approx(value_of(scene, parameter), rel=0.45)
        assert (values > 0.0).all()


def test_forces_of_a_quantity_are_scaled_together() -> None:
    changed = varied(WALL, {"scatter.front": 1.5, "zone.bumper.scale": 2.0}).scene.vehicle.zones
    bumper, bay, door = (CAR.zones[name] for name in ("bumper", "engine_bay", "door"))
    assert changed["bumper"] == bumper.scaled(2.0).scaled(1.5)
    assert changed["engine_bay"] == bay.scaled(1.5)
    assert changed["door"] == door
    assert value_of(WALL, "scatter.front") == 1.0


def test_ratings_have_probabilities() -> None:
    truck = Vehicle.preset("cargo_truck", mesh_density=0.1)
    scene = Simulation(truck, Barrier.bollards(count=5, height=1.0), units.mph(50.0))
    predicted = birm3d.predict(scene, 8)
    rated = birm3d.rate(predicted, "ASTM F2656")
    assert sum(rated.probability.values()) == pytest.approx(1.0)
    assert len(rated.ratings) == 8
    assert sum(predicted.outcomes.values()) == pytest.approx(1.0)


def test_what_it_tells() -> None:
    text = prediction().summary()
    head = text.splitlines()[0]
    assert head.startswith("Passenger car, 1,814 kg, "), "whose bands these are, at which speed"
    assert head.endswith("; 80 % bands of 64 vehicles of the class")
    assert not any(line.strip().startswith("later_contacts") for line in text.splitlines())
    assert "with a contact after the values at separation" in text
    assert "drawn: scatter.front" in text
    (force,) = [line.split() for line in text.splitlines() if line.strip().startswith("peak_force_50ms")]
    assert force[-1] == "kN"
    assert float(force[1]) == pytest.approx(prediction().low["peak_force_50ms"] / 1e3, rel=1e-3)
    told = prediction().to_dict()["metrics"]["max_displacement"]
    assert told["low"] < told["median"] < told["high"]
    cells = re.findall(r"<td[^>]*>(.*?)</td>", prediction()._repr_html_())
    place = cells.index("peak 50-ms mean of the force along the normal")  # words and units of other tables
    assert cells[place + 1 : place + 5] == [*force[1:4], "kN"]
    assert cells[cells.index("peak deceleration along the vehicle, CFC 60") + 4] == "g"


def test_saved_vehicles_keep_their_scatter(tmp_path: Path) -> None:
    CAR.scaled_to(1500.0, length=4.5).save(tmp_path / "v.toml")
    assert Vehicle.from_file(tmp_path / "v.toml").scatter == CAR.scatter


def test_refuses() -> None:
    with pytest.raises(ValueError, match="n must be a power of 2 from 8 to 1024, got 30"):
        birm3d.predict(WALL, 30)
    with pytest.raises(ValueError, match="share must be > 0 and < 1, got 1"):
        birm3d.predict(WALL, share=1.0)
    with pytest.raises(ValueError, match=r"how its class scatters \(\[\[scatter\]\]\), got 'paper_pickup'"):
        birm3d.predict(birm3d.scenes.paper_table_2(30.0))


@pytest.mark.parametrize(
    ("block", "message"),
    [
        ('name = "front"\nlog_sd = 0.1', "zones: must name zones for front"),
        ('name = "front"\nzones = ["sail"]\nlog_sd = 0.1', "must be one of .*got 'sail'"),
        ('name = "barrier_friction"\nzones = ["bumper"]\nlog_sd = 0.1', "zones: must not be given"),
        ('name = "front"\nzones = ["bumper"]\nlog_sd = 0.0', "log_sd"),
    ],
)
def test_wrong_files(tmp_path: Path, block: str, message: str) -> None:
    head = 'extends = "passenger_car"\nname = "c"\n'
    path = tmp_path / "v.toml"
    path.write_text(f'{head}\n[[scatter]]\n{block}\nsource = ["scatter-others"]\nstatus = "estimated"\n')
    with pytest.raises(ValueError, match=message):
        Vehicle.from_file(path)


def test_command_line(command: Callable[..., int], capsys: pytest.CaptureFixture[str]) -> None:
    scene = ["--vehicle", "passenger_car", "--barrier", "rigid_wall", "--speed", "56 km/h"]
    assert command("predict", *scene, "--draws", "8", "--json") == 0
    told = json.loads(capsys.readouterr().out)
    assert told["share"] == 0.8
    assert told["metrics"]["max_displacement"]["low"] < told["metrics"]["max_displacement"]["high"]


def test_draws_that_do_not_touch_the_barrier_are_told() -> None:
    gap = birm3d.predict(Simulation(CAR, Barrier.bollards(count=2, spacing=4.0), 20.0), 8)
    assert "In 8 of 8 draws the vehicle does not touch the barrier." in gap.caution
    assert "does not touch" not in prediction().caution


def test_a_front_that_was_set_is_in_the_middle_of_its_band() -> None:
    """The class of the van has a median of 1.06: a calibrated front was drawn 6 % too stiff."""
    van = Vehicle.preset("van_3500", mesh_density=0.1)
    fitted = van.with_zone("engine", scale=1.3)
    rolling = van.with_zone("tire", rolling_resistance=0.01)
    assert zones_set(rolling) == zones_set(van) == (), "no force of the class"
    for vehicle, middle in ((van, 1.06), (van.scaled_to(3000.0), 1.06), (fitted, 1.0)):
        scene = Simulation(vehicle, Barrier.rigid_wall(), 15.0)
        drawn = drawn_parameters(scene, 5)["scatter.front"]
        assert np.exp(np.log(drawn).mean()) == pytest.approx(middle, rel=1e-9)
    found = birm3d.predict(Simulation(fitted, Barrier.rigid_wall(), 15.0, duration=0.1), 8)
    assert "The law of engine was set by the user. Its band is centred on this vehicle" in found.caution
