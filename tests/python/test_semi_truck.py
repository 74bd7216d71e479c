"""The semi truck: two vehicle files and a joint, statics, and what presses on what in a crash."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from birm3d import Barrier, Simulation, Vehicle, units
from birm3d.vehicle.combination_file import read_combination
from birm3d.vehicle.vehicle_file import VehicleFileError, preset_path, unit_paths

GRAVITY = 9.80665


@pytest.fixture(scope="module")
def semi() -> Vehicle:
    return Vehicle.preset("semi_truck", mesh_density=0.2)


def test_mass_and_units(semi: Vehicle) -> None:
    tractor, trailer = semi.units
    assert semi.mass == pytest.approx(units.lb(72000), rel=1e-5)
    assert tractor.mass == pytest.approx(8633.0, rel=1e-9)
    assert semi.joint.kind == "fifth_wheel"
    assert semi.joint.place_on_leading == (-5.635, 0.0, 1.2)
    # 48 ft of trailer behind a kingpin in the middle of the drive axles.
    ahead = semi.joint.shift[0]
    assert trailer.nodes[:, 0].min() + trailer.center_of_mass[0] + ahead == pytest.approx(-13.72 - 5.635)
    assert Vehicle.preset("semi_truck").n_elements == pytest.approx(6000, rel=0.03)


def test_gvw_and_payload_are_the_trailers(semi: Vehicle) -> None:
    lighter = semi.with_gvw(20000.0)
    assert lighter.mass == pytest.approx(20000.0, rel=1e-12)
    assert lighter.units[0] == semi.units[0]
    assert lighter.mass_center_height < semi.mass_center_height
    empty = semi.with_payload(0.0)
    assert empty.mass == pytest.approx(8633.0 + 4526.0, rel=1e-9)
    loaded = semi.with_payload(10000.0, density=200.0)
    assert loaded.mass == pytest.approx(8633.0 + 14526.0, rel=1e-9)
    assert Vehicle.preset("semi_truck", gvw=20000.0, mesh_density=0.2) == lighter
    assert semi.scaled_to(40000.0).mass == pytest.approx(40000.0, rel=1e-12)


def test_a_parked_semi_truck_shares_its_weight_by_the_lever_rule(semi: Vehicle) -> None:
    result = Simulation(semi, None, 0.0, duration=2.0).run()
    tractor, trailer = semi.units
    settled = result.time > 1.0
    reaction = result.tire_reaction[settled].mean(axis=0) / GRAVITY
    axle = semi.wheels[:, 0] + semi.center_of_mass[0]  # from the front axle
    tandem = 0.5 * (11.60 + 12.82)  # behind the kingpin
    on_tandem = trailer.mass * -trailer.center_of_mass[0] / tandem
    on_kingpin = trailer.mass - on_tandem
    drives = (tractor.mass * -tractor.center_of_mass[0] + on_kingpin * 5.635) / (0.5 * (5.0 + 6.27))
    # Four axles on the ground of two rigid bodies: pairs share as they like, their sum is known within the
    # uneven share's moment.
    assert reaction[axle < -10.0].sum() == pytest.approx(on_tandem, rel=0.02)
    assert reaction[(axle < -4.0) & (axle > -10.0)].sum() == pytest.approx(drives, rel=0.02)
    assert reaction.sum() == pytest.approx(semi.mass, rel=1e-6)
    assert -result.joint_force[settled, 2].mean() / GRAVITY == pytest.approx(on_kingpin, rel=0.02)


@pytest.fixture(scope="module")
def crash(semi: Vehicle) -> dict[str, object]:
    wall = Barrier.rigid_wall()
    return {
        kind: Simulation(semi.with_joint(kind), wall, 12.0, duration=0.4).run()
        for kind in ("fifth_wheel", "welded")
    }


def test_the_trailer_pushes_the_tractor(semi: Vehicle, crash: dict) -> None:
    result = crash["fifth_wheel"]
    trailer = semi.units[1]
    dt = np.diff(result.time)
    along = result.joint_force[1:, 0] @ dt
    change = result.unit(1).velocity[-1, 0] - result.unit(1).velocity[0, 0]
    # The push on the tractor takes the trailer's momentum. The trailer's rolling resistance takes the rest.
    assert along == pytest.approx(-trailer.mass * change, rel=2e-4)
    assert along > 0.0
    assert result.metrics["peak_joint_force_50ms"] > 1e6
    for kind in ("fifth_wheel", "welded"):
        assert abs(crash[kind].metrics["energy_residual"]) < 5e-3
        assert crash[kind].metrics["momentum_residual"] < 1e-9


def test_a_fifth_wheel_lets_pitch_go_and_a_weld_does_not(crash: dict) -> None:
    """The tractor's force is below both mass centres: hinged, they pitch against each other."""
    apart = {kind: np.abs(run.pitch - run.unit(1).pitch).max() for kind, run in crash.items()}
    assert apart["fifth_wheel"] > 10.0 * apart["welded"]
    assert apart["welded"] < 1e-3


def test_the_semi_truck_jackknifes_at_an_oblique_wall(semi: Vehicle) -> None:
    result = Simulation(semi, Barrier.rigid_wall(), 20.0, 15.0, duration=0.6).run()
    assert result.metrics["max_articulation_angle"] > 2.0
    welded = Simulation(semi.with_joint("welded"), Barrier.rigid_wall(), 20.0, 15.0, duration=0.6).run()
    assert welded.metrics["max_articulation_angle"] < 1e-3
    assert abs(result.metrics["energy_residual"]) < 5e-3


# ---- the file ----------------------------------------------------------------------------------------------


def test_a_preset_of_one_unit_is_no_combination() -> None:
    assert read_combination(preset_path("pickup")) is None


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "roll_limit_deg = 2.0",
            "roll_limit_deg = 95.0",
            r":\d+: joint.roll_limit_deg: must be less than 90",
        ),
        ('kind = "fifth_wheel"', 'kind = "rope"', r":\d+: joint.kind: must be .*fifth_wheel.*, got 'rope'"),
        ("[0.0, 0.0, 1.20]", "[0.0, 0.0, 1.25]", r"joint.place_on_trailing_m: must be as high as.*got 1.25"),
        (
            "gvw_kg = 32658.65",
            "gvw_kg = 30000.0",
            r":\d+: gvw_kg: must be within 1% of .* 32658.65, got 30000",
        ),
        ("units/semi_trailer.toml", "units/semi_tractor.toml", r"gvw_kg: must be within|names of zones"),
        ("units/semi_trailer.toml", "units/none.toml", r"none.toml: can not be read"),
        (
            'source = ["simulation-set", "fifth-wheel"]',
            'source = ["rumour"]',
            r"joint.source: must be one of",
        ),
        ("roll_limit_deg = 2.0", "roll_limit = 2.0", r":\d+: joint.roll_limit: unknown key"),
    ],
)
def test_bad_files_are_refused_by_line(tmp_path: Path, old: str, new: str, message: str) -> None:
    text = preset_path("semi_truck").read_text(encoding="utf-8")
    assert old in text
    folder = tmp_path / "units"
    folder.mkdir()
    for name in ("semi_tractor", "semi_trailer"):
        (folder / f"{name}.toml").write_text(unit_paths()[name].read_text(encoding="utf-8"), encoding="utf-8")
    file = tmp_path / "semi.toml"
    file.write_text(text, encoding="utf-8")
    assert Vehicle.from_file(file, mesh_density=0.1).mass == pytest.approx(32658.65, rel=1e-9)
    file.write_text(text.replace(old, new), encoding="utf-8")
    with pytest.raises(VehicleFileError, match=message):
        Vehicle.from_file(file, mesh_density=0.1)
