"""Trucks whose load bed slides along the frame: what is split, what stays, and what the slip depends on."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from importlib.resources import files
from pathlib import Path

import birm3d
import numpy as np
import pytest
from birm3d import Barrier, Joint, Simulation, Vehicle, units
from birm3d.simulation.scene_file import read_scene_file
from birm3d.vehicle.sliding_bed import UNDERSIDE
from birm3d.vehicle.vehicle_file import VehicleFileError

TRUCKS = ("cargo_truck", "heavy_truck_29500")
Slide = tuple[tuple[float, ...], ...]
WEAK = ((0.0, 1.0e5),)


@pytest.fixture(scope="module")
def truck() -> Vehicle:
    return Vehicle.preset("cargo_truck")


def at_a_wall(vehicle: Vehicle, speed: float = 20.0) -> birm3d.Result:
    return Simulation(vehicle, Barrier.rigid_wall(), speed).run()


@pytest.mark.parametrize("name", TRUCKS)
def test_both_parts_have_the_mass_properties_of_the_whole(name: str) -> None:
    whole = Vehicle.preset(name)
    for vehicle in (whole, whole.with_gvw(1.1 * whole.mass), whole.with_gvw(0.9 * whole.mass)):
        split = vehicle.with_sliding_bed()
        assert split.mass == pytest.approx(vehicle.mass, rel=1e-12)  # rounding
        assert split.center_of_mass == pytest.approx(vehicle.center_of_mass, abs=1e-9)
        assert split.inertia == pytest.approx(vehicle.inertia, rel=1e-9, abs=1e-6 * vehicle.inertia.max())
        assert split.kind == vehicle.kind == "truck"


def test_a_height_that_was_asked_for_stays(truck: Vehicle) -> None:
    assert truck.with_mass_center_height(1.4).with_sliding_bed().center_of_mass[2] == pytest.approx(1.4)


def test_all_changes_of_the_whole_go_to_the_part_that_they_concern(truck: Vehicle) -> None:
    changed = truck.with_rate_sensitivity(0.03).with_indentation_length(0.5)
    law = truck.zones["box"]
    chassis, bed = changed.with_zones({"box": law.scaled(2.0), "underside": law}).with_sliding_bed().units
    assert "box" not in chassis.zones
    assert bed.zones["box"] == law.scaled(2.0)
    assert bed.zones[UNDERSIDE] == law == chassis.zones["underside"]
    for unit in (chassis, bed):
        assert (unit.rate_sensitivity, unit.indentation_length) == (0.03, 0.5)
    assert list(bed.points) == ["mass_center", "load_bed_leading_edge"]
    assert "load_bed_leading_edge" not in chassis.points


def test_laws_along_and_across_stay_with_the_chassis(tmp_path: Path) -> None:
    """The bed's underside has the law of its zone alone: a second one was looked for by a name it has not."""
    side = """
extends = "cargo_truck"
[zone.underside]
panels = ["bottom", "side"]
z_m = [0.0, 0.6]
envelope_m_Pa = [[0.0, 0.0], [0.1, 0.1e6]]
k_unloading_Pa_per_m = 1e7
source = ["order-of-magnitude"]
status = "estimated"
[zone.underside.across]
envelope_m_Pa = [[0.0, 0.0], [0.1, 0.1e6]]
k_unloading_Pa_per_m = 1e7
source = ["order-of-magnitude"]
status = "estimated"
"""
    (tmp_path / "truck.toml").write_text(side)
    chassis, bed = Vehicle.from_file(tmp_path / "truck.toml", mesh_density=0.2).with_sliding_bed().units
    assert not any(name.endswith(".across") for name in bed.zones)
    assert "underside" in chassis.zones


def test_a_welded_bed_is_the_truck_of_one_body(truck: Vehicle) -> None:
    # Both are computed to the tolerance of 1e-3, with other steps.
    one, two = at_a_wall(truck), at_a_wall(truck.with_sliding_bed().with_joint("welded"))
    for name in ("peak_force_50ms", "dynamic_crush", "max_pitch"):
        assert two.metrics[name] == pytest.approx(one.metrics[name], rel=2e-3)
    assert "bed_slip" not in two.metrics
    assert two.sensor("load_bed_leading_edge").position[:, 0].max() == pytest.approx(
        one.sensor("load_bed_leading_edge").position[:, 0].max(), abs=2e-3
    )


def test_the_bed_slides_further_the_weaker_its_fixings_are(truck: Vehicle) -> None:
    slides = truck.with_sliding_bed().joint.slide
    slips = []
    for factor in (0.25, 0.5, 1.0, 4.0):
        result = at_a_wall(truck.with_sliding_bed([(s, factor * force) for s, force in slides]), 22.0)
        slips.append(result.metrics["bed_slip"])
        assert result.metrics["bed_slip"] == pytest.approx(np.abs(result.bed_slip).max(), abs=1e-6)
        assert result.metrics["energy_residual"] < 1e-3
    assert slips == sorted(slips, reverse=True)
    assert slips[0] > 1.0
    assert slips[-1] < 0.02


def test_the_energy_of_sliding_is_force_times_slip(truck: Vehicle) -> None:
    result = at_a_wall(truck.with_sliding_bed(WEAK))
    # The bed comes back a little once it has met the wall itself.
    way = np.abs(np.diff(result.bed_slip)).sum()
    assert way > result.bed_slip.max() > 2.0
    lost = result.energy["sliding"]
    assert lost[-1] == pytest.approx(1.0e5 * way, rel=1e-3)
    assert np.all(np.diff(lost) >= -1e-6 * lost[-1])
    assert "slip" in result.report()
    assert result.to_dataframe()["bed_slip [m]"].iloc[-1] == pytest.approx(result.bed_slip[-1])


def test_a_rating_reads_the_edge_of_the_bed_that_slid(truck: Vehicle) -> None:
    posts = Barrier.bollards(count=5, diameter=0.3, height=1.0, spacing=1.5)
    fixed, weak = (
        birm3d.rate(Simulation(vehicle, posts, units.mph(50.0)).run(), "ASTM F2656").penetration
        for vehicle in (truck, truck.with_sliding_bed([(0.0, 2.0e5)]))
    )
    assert weak > fixed + 1.0


def test_a_rating_says_when_the_bed_would_have_left_the_frame(truck: Vehicle) -> None:
    near, far = (
        birm3d.rate(at_a_wall(truck.with_sliding_bed([(0.0, force)]), 22.0), "SD-STD-02.01")
        for force in (4.0e5, 1.0e5)
    )
    assert "left the frame" in far.caution
    assert "left the frame" not in near.caution


def test_a_truck_with_a_sliding_bed_is_saved_and_pickled(truck: Vehicle, tmp_path: Path) -> None:
    split = truck.with_sliding_bed(WEAK)
    split.save(tmp_path / "truck.toml")
    assert Vehicle.from_file(tmp_path / "truck.toml") == split
    assert pickle.loads(pickle.dumps(split)) == split
    result = at_a_wall(split)
    result.save(tmp_path / "run.npz")
    again = birm3d.load(tmp_path / "run.npz")
    assert np.array_equal(again.bed_slip, result.bed_slip)
    assert again.energy["sliding"][-1] == result.energy["sliding"][-1]


def test_a_truck_of_another_mass_has_fixings_in_proportion(truck: Vehicle) -> None:
    bigger = truck.scaled_to(1.5 * truck.mass).with_sliding_bed().joint.slide
    for (slip, force), (own_slip, own) in zip(truck.with_sliding_bed().joint.slide, bigger, strict=True):
        assert (own_slip, own) == (slip, pytest.approx(1.5 * force))
    # A heavier load does not make fixings stronger.
    assert truck.with_gvw(7500.0).with_sliding_bed().joint.slide == truck.with_sliding_bed().joint.slide


def test_studies_vary_the_fixings_and_predictions_draw_them(truck: Vehicle) -> None:
    wall = Simulation(truck.with_sliding_bed(), Barrier.rigid_wall(), 20.0)
    study = birm3d.sweep(wall, {"vehicle.bed_fixings": [0.25, 0.5, 1.0]}, progress=False)
    slips = list(study["bed_slip"])
    assert slips == sorted(slips, reverse=True)
    assert slips[2] == pytest.approx(wall.run().metrics["bed_slip"])
    prediction = birm3d.predict(wall, n=8, progress=False)
    assert "vehicle.bed_fixings" in prediction.drawn
    assert prediction.low["bed_slip"] < prediction.high["bed_slip"]
    fixed = Simulation(truck, Barrier.rigid_wall(), 20.0)
    assert "vehicle.bed_fixings" not in birm3d.predict(fixed, n=8, progress=False).drawn


def test_command_line_and_scene_files_let_it_slide(
    tmp_path: Path, command: Callable[..., int], capsys: pytest.CaptureFixture[str]
) -> None:
    assert command("run", "--vehicle", "cargo_truck", "--sliding-bed", "--speed", "20m/s") == 0
    assert "with a sliding bed" in capsys.readouterr().out
    scene = tmp_path / "scene.toml"
    scene.write_text(
        '[vehicle]\npreset = "cargo_truck"\nsliding_bed = true\n[barrier]\nkind = "rigid_wall"\n'
        '[impact]\nspeed = "20 m/s"\n',
        encoding="utf-8",
    )
    result = read_scene_file(scene).run()
    assert result.metrics["bed_slip"] > 0.0


def test_vehicles_without_a_bed_say_so() -> None:
    with pytest.raises(ValueError, match="must have a file with a block 'bed', got 'pickup'"):
        Vehicle.preset("pickup").with_sliding_bed()
    with pytest.raises(ValueError, match="must be of one unit, got 'semi_truck' of two"):
        Vehicle.preset("semi_truck").with_sliding_bed()
    with pytest.raises(ValueError, match=r"bed_slip needs a vehicle with_sliding_bed\(\)"):
        _ = at_a_wall(Vehicle.preset("cargo_truck"), 5.0).bed_slip


@pytest.mark.parametrize(
    ("slide", "message"),
    [
        ((), "slide must have a pair of slip"),
        (((0.1, 1e4),), "slips .* that increase from 0"),
        (((0.0, 1e4), (0.0, 2e4)), "slips .* that increase from 0"),
        (((0.0, 1e4, 2.0),), "must be pairs of slip"),
        (((0.0, -1.0),), "finite slips .* and finite forces"),
        (((0.0, float("nan")),), "finite slips .* and finite forces"),
    ],
)
def test_impossible_slide_forces_are_refused(truck: Vehicle, slide: Slide, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        truck.with_sliding_bed(slide)
    with pytest.raises(ValueError, match=message):
        Joint((0, 0, 1), (0, 0, 1), "sliding", slide=slide)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('block = "box"\nunderside', 'block = "hold"\nunderside', "bed.block: must be one of box, cab"),
        ('underside = "underside"', 'underside = "floor"', "bed.underside: must be one of"),
        ('"box_roof", "cargo",', '"box_roof", "carg",', "bed.solids: must be one of"),
        ("    [0.0, 5.1e5],", "    [0.1, 5.1e5],", "bed.slide_m_N: must start at a slip of 0"),
    ],
)
def test_a_bed_that_is_not_there_is_refused_by_line(tmp_path: Path, old: str, new: str, message: str) -> None:
    text = (files("birm3d") / "data/cargo_truck.toml").read_text(encoding="utf-8")
    assert text.count(old) == 1
    path = tmp_path / "truck.toml"
    path.write_text(text.replace(old, new), encoding="utf-8")
    with pytest.raises(VehicleFileError, match=rf"truck.toml:\d+: {message}"):
        Vehicle.from_file(path)


def test_a_checkpoint_of_a_bed_with_other_fixings_is_refused() -> None:
    """Its joint was no part of what tells vehicles apart."""
    truck = Vehicle.preset("cargo_truck", mesh_density=0.2)
    weak, strong = (
        Simulation(truck.with_sliding_bed(slide), Barrier.rigid_wall(), 10.0)
        for slide in (WEAK, ((0.0, 5e5),))
    )
    with pytest.raises(ValueError, match="snapshot"):
        strong.restore(weak.snapshot())
