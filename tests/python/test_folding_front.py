"""Fronts that fold: they pass on a share of the barrier's friction, and wheels give way under load."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pytest
from birm3d import Barrier, Result, Settings, Simulation, Vehicle, Zone

TRUCK = Path(__file__).resolve().parents[1] / "data/finite_element/finite_element_truck.toml"
TRAVEL = 0.3  # m
LOAD = 50e3  # N; front wheels stand with 11 kN at rest, rear wheels with 23 kN


def with_all(vehicle: Vehicle, share: float | None, breakaway: float | None) -> Vehicle:
    zones = {}
    for name in vehicle.zones_met:
        tire = name.startswith("tire")
        travel = None if breakaway is None else TRAVEL
        changes = {"breakaway": breakaway, "breakaway_travel": travel} if tire else {"friction_share": share}
        zones[name] = dataclasses.replace(vehicle.zones[name], **changes)
    return vehicle.with_zones(zones)


@pytest.fixture(scope="module")
def truck() -> Vehicle:
    """Without what its file says of friction and wheels."""
    return with_all(Vehicle.from_file(TRUCK, mesh_density=0.3), None, None)


def crash(vehicle: Vehicle, friction: float = 0.2, duration: float = 0.25) -> Result:
    settings = Settings(mu_tire=0.0, mu_body=0.0, mu_tire_barrier=0.0)
    wall = Barrier.rigid_wall(friction=friction)
    return Simulation(vehicle, wall, 13.4, duration=duration, settings=settings).run()


def test_the_whole_of_friction_and_wheels_that_hold_are_as_none_given(truck: Vehicle) -> None:
    assert crash(with_all(truck, 1.0, 1e9)).state_hash == crash(truck).state_hash


def test_a_share_of_friction_acts_as_a_barrier_with_less(truck: Vehicle) -> None:
    """The share times the coefficient is all that counts, where all zones have the same."""
    half, rough, smooth = with_all(truck, 0.5, None), crash(truck, 0.1), crash(truck, 0.0)
    np.testing.assert_allclose(crash(half).velocity, rough.velocity, atol=1e-6)
    np.testing.assert_allclose(crash(with_all(truck, 0.0, None)).velocity, smooth.velocity, atol=1e-6)
    assert np.abs(rough.velocity[:, 2] - smooth.velocity[:, 2]).max() > 0.01  # friction matters here


def lowest_of_front_wheels(result: Result) -> np.ndarray:
    """Height of their lowest points, were they not pushed up (n,) [m]; the run is symmetric."""
    x, _, z, radius = result.scene.vehicle.wheels[0]
    pitch = np.radians(result.pitch)
    return np.asarray(result.position[:, 2] - x * np.sin(pitch) + z * np.cos(pitch) - radius)


def test_wheels_that_are_loaded_too_much_let_the_nose_down_by_their_travel(truck: Vehicle) -> None:
    holding, giving = crash(with_all(truck, 0.0, 1e9)), crash(with_all(truck, 0.0, LOAD))
    assert (giving.statistics.wheels_given_way, holding.statistics.wheels_given_way) == (2, 0)
    assert holding.tire_reaction.max() > 1.2 * LOAD
    gone = (
        int(np.argmax(giving.tire_reaction[:, 0] > LOAD)) + 100
    )  # rows of 0.1 ms; it is a step of 1 to 3 ms
    assert (giving.tire_reaction[gone : gone + 300, :2] == 0.0).all()  # nothing for 30 ms, then the stop
    assert lowest_of_front_wheels(holding).min() > -1e-3
    assert lowest_of_front_wheels(giving).min() == pytest.approx(-TRAVEL, abs=1e-3)
    assert giving.tire_reaction[gone + 300 :, 0].max() > 0.0
    assert giving.pitch.max() > 2.0 * holding.pitch.max()
    assert abs(giving.metrics["energy_residual"]) < 1e-3
    assert crash(with_all(truck, 0.0, LOAD)).state_hash == giving.state_hash


def test_both_numbers_come_back_from_a_saved_file(truck: Vehicle, tmp_path: Path) -> None:
    changed = with_all(truck, 0.3, LOAD)
    changed.save(tmp_path / "truck.toml")
    again = Vehicle.from_file(tmp_path / "truck.toml")
    assert again == changed
    assert again.zones["tire"].breakaway == LOAD
    assert again.zones["rails"].scaled(2.0, 3.0).friction_share == 0.3
    assert again.with_gvw(8000.0).zones["tire"].breakaway == LOAD


@pytest.mark.parametrize(
    ("zone", "line", "message"),
    [
        ("hood", "breakaway_N = 1e5", "breakaway_N: must be in a zone of the panel 'tire', got 100000"),
        ("tire_front", "friction_share = 0.5", "friction_share: must not go with the panel 'tire', got 0.5"),
        ("hood", "friction_share = 1.5", "friction_share: must be less than or equal to 1"),
        ("tire_front", "breakaway_N = 0.0", "breakaway_N: must be greater than 0"),
    ],
)
def test_numbers_of_another_zone_or_out_of_range_are_refused(
    zone: str, line: str, message: str, tmp_path: Path
) -> None:
    text = TRUCK.read_text(encoding="utf-8")
    start = text.index(f"[zone.{zone}]")
    key = line.split(" =")[0]
    block, rest = text[start:].split("\n\n", 1) if "\n\n" in text[start:] else (text[start:], "")
    lines = [each for each in block.splitlines() if not each.startswith(f"{key} ")]
    path = tmp_path / "v.toml"
    path.write_text(text[:start] + "\n".join([*lines, line, "", rest]), encoding="utf-8")
    with pytest.raises(ValueError, match=r"v\.toml") as refused:
        Vehicle.from_file(path)
    assert message in str(refused.value)


def test_a_zone_refuses_numbers_out_of_range() -> None:
    law = {"envelope": ((0.0, 0.0), (0.1, 1e6)), "k_unloading": 2e7}
    with pytest.raises(ValueError, match=r"friction_share must be in \[0, 1\], got 1\.5"):
        Zone(**law, friction_share=1.5)
    with pytest.raises(ValueError, match=r"breakaway must be finite and > 0, got 0\.0"):
        Zone(**law, breakaway=0.0, breakaway_travel=0.1)
    with pytest.raises(ValueError, match=r"breakaway_travel must be given beside breakaway, got None"):
        Zone(**law, breakaway=1e5)


@pytest.mark.parametrize(("speed", "angle"), [(10.0, 40.0), (6.0, 75.0)])
def test_what_gives_way_does_not_depend_on_the_steps(speed: float, angle: float) -> None:
    """The load of a rigid wheel that touches down in a step grows without bound as the step gets shorter."""
    truck = Vehicle.from_file(TRUCK.with_name("fitted_truck.toml"), mesh_density=0.5)
    runs = [
        Simulation(truck, Barrier.rigid_wall(), speed, angle, duration=1.0, settings=settings).run()
        for settings in (Settings(), Settings(tolerance=1e-5), Settings(time_step=1e-4))
    ]
    assert len({run.statistics.wheels_given_way for run in runs}) == 1
    yaw = [run.metrics["max_yaw"] for run in runs]
    assert yaw == pytest.approx([yaw[0]] * 3, rel=0.05)
