"""Wheels with free steering, round treads and overhanging floors: laws, and trucks at barriers."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from birm3d import Barrier, Result, Settings, Simulation, Vehicle, units
from birm3d.barrier.barrier_kind import BarrierKind
from birm3d.vehicle.mesher import build_mesh, winding_number
from birm3d.vehicle.vehicle_file import preset_path, read_vehicle_file
from tires import quick_to_steer, tired

TRUCK = "mash_10000s"


@pytest.fixture(scope="module")
def truck() -> Vehicle:
    return Vehicle.preset(TRUCK, mesh_density=0.3)


def oblique(vehicle: Vehicle, barrier: Barrier, side: float = 1.0, **settings: float) -> Result:
    """A short impact, with steered wheels and a body that rolls."""
    return Simulation(vehicle, barrier, 25.0, side * 15.0, duration=0.6, settings=Settings(**settings)).run()


def test_free_wheels_change_nothing_where_the_vehicle_runs_straight(truck: Vehicle) -> None:
    held = Simulation(tired(truck, steering_time=None), None, 20.0, duration=0.5).run()
    free = Simulation(truck, None, 20.0, duration=0.5).run()
    np.testing.assert_allclose(free.position, held.position, atol=1e-9)


def test_energy_and_momentum_close_with_steered_wheels(truck: Vehicle) -> None:
    result = oblique(truck, Barrier.jersey())
    assert result.metrics["max_roll"] > 10.0  # it stands on the edges of two treads
    assert result.metrics["energy_residual"] < 5e-4
    assert result.metrics["momentum_residual"] < 1e-9


def test_the_lag_needs_no_short_steps(truck: Vehicle) -> None:
    coarse, fine = (oblique(truck, Barrier.jersey(), tolerance=t).metrics for t in (1e-3, 1e-5))
    for name in ("max_roll", "peak_force_50ms"):
        assert coarse[name] == pytest.approx(fine[name], rel=2e-3)


def test_straight_wheels_press_a_truck_on_the_barrier_and_free_ones_do_not(truck: Vehicle) -> None:
    """The side force of held front wheels points to the barrier: all along, tyres give it an impulse."""
    wall = Barrier.rigid_wall()
    pushed = [
        oblique(vehicle, wall).tire_friction_force[:, 0].sum()
        for vehicle in (tired(truck, steering_time=None), tired(truck, steering_time=1e-3))
    ]
    assert pushed[1] < 0.3 * pushed[0]


def test_wheels_at_the_rear_do_not_steer(truck: Vehicle) -> None:
    from birm3d.vehicle.wheel_arguments import tires

    rows = tires(truck)
    np.testing.assert_array_equal(np.isfinite(rows[:, 0]), truck.wheels[:, 0] > 0.0)
    assert (rows[:, 1] == 0.2).all()


def test_a_round_tread_keeps_the_energy_of_a_body_that_rocks(truck: Vehicle) -> None:
    """Its lowest point moves along the tread: no work is done beside that of the springs."""
    smooth = tired(truck, damping_ratio=0.0, bump_travel=1.0)
    start = oblique(smooth, Barrier.rigid_wall(height=1.07), mu_tire=0.0, mu_tire_barrier=0.0)
    assert start.metrics["energy_residual"] < 5e-4


@pytest.mark.parametrize("key", ["steering_time", "tread_radius", "camber_ratio"])
def test_files_and_saved_vehicles_keep_the_numbers(key: str, truck: Vehicle, tmp_path: Path) -> None:
    changed = tired(truck, **{key: 0.11})
    changed.save(tmp_path / "truck.toml")
    again = Vehicle.from_file(tmp_path / "truck.toml", mesh_density=0.3)
    assert getattr(again.zones["tire"], key) == 0.11
    with pytest.raises(ValueError, match=rf"{key} must be finite and > 0, got 0\.0"):
        tired(truck, **{key: 0.0})


def test_an_overhang_is_stepped_and_the_skin_stays_closed() -> None:
    file = read_vehicle_file(preset_path(TRUCK))
    mesh = build_mesh(file)
    assert file.overhang is not None
    (rear, front), y, z = file.overhang.x_m, file.overhang.beyond_y_m, file.overhang.z_m
    x_mid = 0.5 * (rear + front)
    below, above = np.array([[x_mid, y + 0.2, z - 0.05]]), np.array([[x_mid, y + 0.2, z + 0.05]])
    frame = np.array([[x_mid, y - 0.2, z - 0.05]])
    inside = winding_number(np.vstack([below, above, frame]), mesh.nodes, mesh.quads)
    np.testing.assert_allclose(inside, [0.0, 1.0, 1.0], atol=1e-9)


def test_an_overhang_scales_with_the_vehicle() -> None:
    file = read_vehicle_file(preset_path(TRUCK))
    wide = Vehicle.preset(TRUCK).scaled_to(10000.0, width=2.6)
    scaled = wide.units[0]._file
    assert scaled is not None
    assert scaled.overhang is not None
    assert file.overhang is not None
    factor = 2.6 / file.extent.width
    assert scaled.overhang.beyond_y_m == pytest.approx(factor * file.overhang.beyond_y_m)


# The truck that rolls over falls on the barrier with its load.
@pytest.mark.filterwarnings("ignore::birm3d.CoreContactWarning")
@pytest.mark.parametrize(
    ("barrier", "speed", "angle", "over"),
    [
        (Barrier.jersey(height=0.81), 90.9, 16.2, True),
        (Barrier.jersey(profile="single_slope", height=0.91), 92.0, 16.1, False),
        (Barrier.rigid_wall(height=0.91), 91.7, 16.2, False),
        (Barrier.jersey(height=1.07), 91.7, 16.2, False),
        (Barrier.jersey(profile="f_shape", height=1.07), 91.7, 16.2, False),
        (Barrier.jersey(profile="single_slope", height=1.07), 91.7, 16.2, False),
    ],
    ids=lambda given: given.text if isinstance(given, BarrierKind) else str(given),
)
def test_a_low_barrier_rolls_the_10_t_truck_over_and_a_higher_one_does_not(
    barrier: BarrierKind, speed: float, angle: float, over: bool
) -> None:
    """MASH 4-12, as commonly reported: over at 0.81 m, contained and upright at 0.91 m and above."""
    result = Simulation(Vehicle.preset(TRUCK), barrier, units.km_h(speed), angle).run()
    assert (result.outcome == "rolled_over") == over
    if not over:
        assert result.outcome == "redirected"
        assert result.metrics["max_roll"] < 40.0


# Speed [km/h], angle [deg] and mass [kg] of standards, whose vehicles are to stay upright.
STANDARD_TRUCKS = [
    ("cabover_7500", 80.0, 15.0, 8000.0),
    ("bus_13t", 70.0, 20.0, 13000.0),
    ("mash_36000v", 80.0, 15.0, 36000.0),
]


@pytest.mark.parametrize(("name", "speed", "angle", "mass"), STANDARD_TRUCKS)
@pytest.mark.parametrize("profile", ["new_jersey", "f_shape"])
def test_heavy_vehicles_leave_the_barrier_upright(
    profile: str, name: str, speed: float, angle: float, mass: float
) -> None:
    """Single trucks turn away as in tests; straight wheels pressed them on the barrier for seconds."""
    barrier = Barrier.jersey(profile=profile, height=0.91)
    result = Simulation(Vehicle.preset(name).with_gvw(mass), barrier, units.km_h(speed), angle).run()
    assert result.outcome == "redirected"
    assert result.metrics["max_roll"] < 40.0
    if name != "mash_36000v":  # a tractor with its trailer rides along the barrier
        assert result.metrics["time_of_separation"] < 2.5


def test_a_lower_barrier_and_a_steeper_impact_roll_a_vehicle_further() -> None:
    name, speed, angle, mass = STANDARD_TRUCKS[0]
    vehicle = Vehicle.preset(name).with_gvw(mass)
    rolls = {
        (height, steeper): float(
            Simulation(vehicle, Barrier.jersey(height=height), units.km_h(speed), angle + steeper)
            .run()
            .metrics["max_roll"]
        )
        for height in (0.81, 0.91, 1.07)
        for steeper in (-2.0, 0.0, 2.0)
    }
    for height in (0.81, 0.91, 1.07):
        assert rolls[height, -2.0] < rolls[height, 0.0] < rolls[height, 2.0]
    for steeper in (-2.0, 0.0, 2.0):
        assert rolls[1.07, steeper] < rolls[0.91, steeper] < rolls[0.81, steeper]
    assert rolls[1.07, 2.0] < 45.0


# A vehicle that rolls over falls on the barrier with its load.
@pytest.mark.filterwarnings("ignore::birm3d.CoreContactWarning")
def test_camber_thrust_sets_a_truck_down_that_would_tip_late() -> None:
    """With wheels quick to steer, the 10-t truck tips over at 16 degrees, after it has left the barrier."""
    barrier = Barrier.jersey(height=1.07)
    truck = quick_to_steer(Vehicle.preset(TRUCK))
    upright = Simulation(tired(truck, camber_ratio=0.1), barrier, units.km_h(90.0), 16.0).run()
    bare = Simulation(truck, barrier, units.km_h(90.0), 16.0).run()
    assert upright.outcome == "redirected"
    assert upright.metrics["max_roll"] < 0.75 * bare.metrics["max_roll"]


def test_the_8_t_truck_stays_upright_at_the_low_barrier() -> None:
    """NCHRP 350 test 4-12: 80 km/h and 15 degrees. Straight wheels never let the truck leave."""
    for truck in (Vehicle.preset(TRUCK), Vehicle.preset("cargo_truck")):
        result = Simulation(truck.with_gvw(8000.0), Barrier.jersey(), units.km_h(80.0), 15.0).run()
        assert result.outcome_detail == "it left along the barrier"
        assert result.metrics["max_roll"] < 40.0


@pytest.mark.parametrize(
    ("was", "given", "complaint"),
    [
        (
            "z_m = 1.095",
            "z_m = 9.0",
            r"overhang.z_m: must be between .* body there, 0.55 and 1.245 m, got 9",
        ),
        (
            "tread_radius_m = 0.2",
            "tread_radius_m = 0.9",
            r"tread radius must be >= 0 m and at most the wheel's",
        ),
        (
            "steering_time_s = 0.5",
            "steering_time_s = -0.1",
            r"steering_time_s: must be greater than 0, got -0.1",
        ),
    ],
)
def test_numbers_that_can_not_be_are_refused(was: str, given: str, complaint: str, tmp_path: Path) -> None:
    text = preset_path("mash_10000s").read_text(encoding="utf-8")
    assert was in text
    path = tmp_path / "truck.toml"
    path.write_text(text.replace(was, given), encoding="utf-8")
    with pytest.raises(ValueError, match=complaint):
        Vehicle.from_file(path)
