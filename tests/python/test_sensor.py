"""Sensors: points of the vehicle move as points of a rigid body do."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable

import birm3d
import numpy as np
import pytest
from birm3d import Barrier, Result, Settings, Simulation, UnitWarning, Vehicle, scenes, units
from birm3d.vehicle.vehicle_file import VehicleFileError
from scipy.spatial.transform import Rotation

POINTS = ((1.0, 0.0, 0.5), (-2.3, 0.9, 1.4), (0.4, -0.8, 0.0))


@pytest.fixture(scope="module")
def pickup_on_jersey() -> Result:
    pickup = Vehicle.preset("pickup", mesh_density=0.3)
    barrier = Barrier.jersey(height=0.81)
    return Simulation(pickup, barrier, units.km_h(100.0), 25.0, duration=0.6).run()


@pytest.fixture(scope="module")
def semi_truck() -> Result:
    truck = Vehicle.preset("semi_truck", mesh_density=0.2)
    return Simulation(truck, Barrier.jersey(height=1.07), units.km_h(80.0), 15.0, duration=0.4).run()


def test_at_the_mass_center_it_is_the_result(pickup_on_jersey: Result) -> None:
    result = pickup_on_jersey
    for sensor in (result.sensor("mass_center"), result.sensor(result.scene.vehicle.center_of_mass.tolist())):
        assert np.array_equal(sensor.position, result.position)
        assert np.array_equal(sensor.velocity, result.velocity)
        assert sensor.in_body_axes() == pytest.approx(result.acceleration, rel=1e-9, abs=1e-9)
        for i, axis in enumerate("xyz"):
            channel = sensor.channel(axis)
            assert channel.unit == "m/s^2"
            assert channel.values == pytest.approx(result.acceleration[:, i], rel=1e-9, abs=1e-9)
    assert np.array_equal(sensor.channel("yaw_rate").values, result.angular_velocity[:, 2])


@pytest.mark.parametrize("point", POINTS)
def test_acceleration_adds_up_to_the_change_of_velocity(pickup_on_jersey: Result, point) -> None:
    sensor = pickup_on_jersey.sensor(point)
    gained = (sensor.acceleration[1:] * np.diff(sensor.time)[:, None]).sum(axis=0)
    change = sensor.velocity[-1] - sensor.velocity[0]
    assert np.abs(gained - change).max() < 1e-9
    assert np.abs(change).max() > 5.0
    assert np.array_equal(sensor.acceleration[0], sensor.acceleration[1])


@pytest.mark.parametrize("point", POINTS)
def test_two_points_keep_their_distance(pickup_on_jersey: Result, body_to_world, point) -> None:
    """v = v_cm + w x (R p), with R from the angles that a user sees; the place moves with that velocity."""
    result = pickup_on_jersey
    sensor, turn = result.sensor(point), body_to_world(result)
    lever = np.asarray(point) - result.scene.vehicle.center_of_mass
    assert sensor.position == pytest.approx(result.position + turn.apply(lever), abs=1e-9)
    omega = turn.apply(np.radians(result.angular_velocity))
    expected = result.velocity + np.cross(omega, turn.apply(lever))
    assert sensor.velocity == pytest.approx(expected, abs=1e-9)
    moved = sensor.position[-1] - sensor.position[0]
    assert np.trapezoid(sensor.velocity, sensor.time, axis=0) == pytest.approx(moved, abs=2e-4)
    assert np.linalg.norm(sensor.position - result.position, axis=1) == pytest.approx(np.linalg.norm(lever))


def test_a_free_spin_has_the_centripetal_part_alone() -> None:
    """A block that left a post spins about its upright axis: a = -w^2 p, of order 100 m/s^2 at the nose."""
    nodes = [[1.0, y, 0.0] for y in (0.3, 0.4, 0.5)]
    block = Vehicle.from_arrays(
        mass=1000.0, inertia=np.diag([200.0, 600.0, 600.0]), nodes=nodes,
        anchors=[[0.0, y, 0.0] for _, y, _ in nodes], k_initial=1e6, k_unloading=1e6, mass_center_height=0.5,
    )  # fmt: skip
    free = Settings(gravity=0.0, ground=False)
    wall = Barrier.rigid_wall(friction=0.0)
    result = Simulation(block, wall, 10.0, 90.0, duration=0.25, settings=free).run()
    rows = result.time > result.metrics["time_of_separation"] + 1e-3
    omega = np.radians(result.angular_velocity[rows])
    assert np.abs(omega[:, :2]).max() < 1e-9
    assert np.ptp(omega[:, 2]) < 1e-9
    assert abs(omega[0, 2]) > 5.0
    nose = result.sensor((0.8, 0.2, 0.9))
    expected = -(omega[0, 2] ** 2) * np.array([0.8, 0.2, 0.0])
    # The mean over an interval of dt lags by w dt / 2. Between steps a turn is shown by its chord: 2e-4 here.
    half = 0.5 * abs(omega[0, 2]) * result.scene.settings.output_interval
    assert np.abs(nose.in_body_axes()[rows] - expected).max() < 1.1 * half * np.linalg.norm(expected)
    magnitude = nose.channel("resultant").values[rows]
    assert magnitude == pytest.approx(np.linalg.norm(expected), rel=3e-4)
    assert np.linalg.norm(expected) > 20.0


def test_angular_acceleration_is_in_it() -> None:
    """While a torque acts: a = a_cm + dw/dt x p + w x (w x p), of a body that turns about one axis."""
    result = Simulation(
        Vehicle.preset("passenger_car", mesh_density=0.3), Barrier.rigid_wall(), 15.0, 45.0,
        settings=Settings(output_interval=2e-5),
    ).run()  # fmt: skip
    lever = np.array([1.5, 0.6, 0.2])
    sensor = result.sensor(result.scene.vehicle.center_of_mass + lever)
    turn = Rotation.from_matrix(sensor.rotation)
    omega = turn.apply(np.radians(result.angular_velocity))
    arm = turn.apply(lever)
    alpha = np.diff(omega, axis=0) / np.diff(result.time)[:, None]
    middle = 0.5 * (omega[1:] + omega[:-1])
    arms = 0.5 * (arm[1:] + arm[:-1])
    center = np.diff(result.velocity, axis=0) / np.diff(result.time)[:, None]
    expected = center + np.cross(alpha, arms) + np.cross(middle, np.cross(middle, arms))
    scale = np.abs(expected - center).max()
    assert scale > 50.0
    # Between steps a turn is shown by its chord, which the long steps after the contact tell.
    assert np.abs(sensor.acceleration[1:] - expected).max() < 2e-3 * scale


def test_filtered_channel(pickup_on_jersey: Result) -> None:
    sensor = pickup_on_jersey.sensor("driver_head")
    raw, smooth = sensor.channel("y"), sensor.channel("y", cfc=60)
    assert smooth.cfc == 60.0
    expected = birm3d.filters.cfc(raw.values, 60, pickup_on_jersey.scene.settings.output_interval)
    assert smooth.values == pytest.approx(expected)
    up = sensor.channel("z", quantity="position", axes="world")
    assert up.unit == "m"
    assert np.array_equal(up.values, sensor.position[:, 2])


def test_parts_of_a_vehicle_of_two_units(semi_truck: Result) -> None:
    bed, head = semi_truck.sensor("load_bed_leading_edge"), semi_truck.sensor("driver_head")
    assert (bed.part, head.part) == ("semi_trailer", "semi_tractor")
    by_number = semi_truck.sensor("load_bed_leading_edge", 1)
    assert np.array_equal(bed.velocity, by_number.velocity)
    tail = semi_truck.sensor("mass_center", "semi_trailer")
    assert np.array_equal(tail.velocity, semi_truck.unit(1).velocity)
    assert np.array_equal(semi_truck.sensor("mass_center").velocity, semi_truck.velocity)
    # The joint is one point of both units.
    joint = semi_truck.scene.vehicle.joint
    assert joint is not None
    ahead = semi_truck.sensor(joint.place_on_leading, "semi_tractor")
    behind = semi_truck.sensor(joint.place_on_trailing, "semi_trailer")
    assert ahead.velocity == pytest.approx(behind.velocity, abs=0.05)
    assert ahead.position == pytest.approx(behind.position, abs=0.005)


def test_a_loaded_result_has_the_same_sensors(pickup_on_jersey: Result, tmp_path) -> None:
    pickup_on_jersey.save(tmp_path / "r.npz")
    again = birm3d.load(tmp_path / "r.npz").sensor("load_bed_leading_edge")
    here = pickup_on_jersey.sensor("load_bed_leading_edge")
    assert np.array_equal(again.acceleration, here.acceleration)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda r: r.sensor("antenna"), "point must be one of mass_center, a_pillar_base, driver_head, load"),
        (lambda r: r.sensor((1.0, 2.0)), "point must be three numbers"),
        (lambda r: r.sensor((1.0, np.nan, 0.0)), "point must be three finite numbers"),
        (lambda r: r.sensor("driver_head", "trailer"), "part must be one of pickup; got 'trailer'"),
        (lambda r: r.sensor("driver_head", 1), "part must be >= 0 and < 1"),
        (lambda r: r.sensor("driver_head").channel("u"), "axis must be one of x, y, z, resultant"),
        (lambda r: r.sensor("driver_head").channel("x", quantity="jerk"), "quantity must be one of"),
        (lambda r: r.sensor("driver_head").channel("x", quantity="position"), "axes must be 'world'"),
        (lambda r: r.sensor("driver_head").channel("x", cfc=60000), "interval must be > 0 and at most"),
    ],
)
def test_bad_input(pickup_on_jersey: Result, call: Callable[[Result], object], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        call(pickup_on_jersey)


@pytest.mark.parametrize(
    ("point", "part", "named"),
    [
        ((100.0, 0.0, 0.0), None, "x = 100 m"),
        ((-600.0, 0.0, 0.8), None, "x = -600 m"),
        ((0.0, -850.0, 0.8), None, "y = -850 m"),
        ((0.0, 0.0, 6.0), None, "z = 6 m"),
        ((-20.0, 0.0, 1.0), "semi_tractor", "x = -20 m"),  # of the trailer, in the tractor's axes
    ],
)
def test_a_point_far_outside_the_skin_is_warned_of(
    pickup_on_jersey: Result, semi_truck: Result, point, part: str | None, named: str
) -> None:
    result = semi_truck if part else pickup_on_jersey
    with pytest.warns(UnitWarning, match=f"point with {named} is most likely in another unit") as told:
        sensor = result.sensor(point, part)
    assert sensor.point.tolist() == list(point)
    (one,) = told
    assert one.filename == __file__
    axis = "xyz".index(named[0])
    unit = result.scene.vehicle.units[0]
    edges = np.array([bound[axis] for bound in unit.skin_bounds]) + unit.center_of_mass[axis]
    said = re.findall(r"from ([-.\d]+) to ([-.\d]+) m", str(one.message))[0]
    assert [float(number) for number in said] == pytest.approx([edges[0] - 1.0, edges[1] + 1.0], abs=0.006)


def test_a_point_within_a_metre_of_the_skin_or_with_its_unit_is_not_warned_of(semi_truck: Result) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for i, unit in enumerate(semi_truck.scene.vehicle.units):
            low, high = unit.skin_bounds
            for corner in (low - 0.99, high + 0.99):
                semi_truck.sensor((corner + unit.center_of_mass).tolist(), i)
        semi_truck.sensor(("30 m", 0.0, "-5000 mm"))
        # A skin that is a front alone: the mass centre is 3 m behind it, and counts too.
        block = scenes.laboratory_block(16, k_initial=3e6, knee=0.4, k_unloading=6e7)
        front = Simulation(block, Barrier.rigid_wall(), 5.0).run()
        assert block.skin_bounds[0][0] == 3.0
        front.sensor((0.0, 0.0, 0.5))
        front.sensor((units.Stated(-9.0), 0.0, 0.5))


def test_points_of_the_files() -> None:
    for name in Vehicle.presets():
        for unit in Vehicle.preset(name, mesh_density=0.1).units:
            assert unit.kind is not None, unit.name
            low, high = unit.skin_bounds
            for point, place in unit.points.items():
                at = np.asarray(place) - unit.center_of_mass
                assert (at > low - 1e-6).all(), (unit.name, point)
                assert (at < high + 1e-6).all(), (unit.name, point)
    assert Vehicle.preset("semi_truck", mesh_density=0.1).kind == "tractor_semitrailer"


def test_a_point_in_a_file(tmp_path) -> None:
    path = tmp_path / "v.toml"
    head = 'extends = "pickup"\nname = "other"\n[[point]]\n'
    tail = 'at_m = [-1.0, 0.5, 1.0]\nsource = ["layout"]\nstatus = "estimated"\n'
    path.write_text(f'{head}name = "roof_rack"\n{tail}', encoding="utf-8")
    vehicle = Vehicle.from_file(path, mesh_density=0.1)
    assert vehicle.points["roof_rack"] == (-1.0, 0.5, 1.0)
    assert "driver_head" not in vehicle.points  # whole keys are replaced
    vehicle.save(tmp_path / "w.toml")
    assert Vehicle.from_file(tmp_path / "w.toml").points == vehicle.points
    path.write_text(f'{head}name = "mass_center"\n{tail}', encoding="utf-8")
    with pytest.raises(VehicleFileError, match=r"v.toml:4: point.0.name: must be another one"):
        Vehicle.from_file(path)
