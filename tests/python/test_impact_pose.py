"""How a vehicle comes: yaw and roll at impact, paths along a barrier's line, and how far it gets past."""

from __future__ import annotations

import math

import numpy as np
import pytest
from birm3d import Barrier, Result, Settings, Simulation, Vehicle
from scipy.spatial.transform import Rotation

FREE = Settings(gravity=0.0, ground=False)

# The block has one node to each side, at which posts and ends of walls are aimed.
pytestmark = pytest.mark.filterwarnings("ignore::birm3d.CoarseSkinWarning")


def box(k: float = 3e5, half_width: float = 0.8) -> Vehicle:
    """A block with one truss to each side: ahead, back, left and right, all at the mass centre's height."""
    out = np.array([[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0]])
    size = np.array([2.0, half_width, 0.5])
    return Vehicle.from_arrays(
        mass=1000.0,
        inertia=np.diag([400.0, 1500.0, 1600.0]),
        nodes=out * size,
        anchors=0.5 * out * size,
        k_initial=k,
        k_unloading=k,
        mass_center_height=0.5,
    )


def orientation(result: Result, row: int = 0) -> np.ndarray:
    return np.asarray(result.pose(result.time[row])[1][0])


@pytest.mark.parametrize("angle", [90.0, 60.0])
@pytest.mark.parametrize("yaw", [0.0, 30.0, 90.0, 180.0, -90.0])
@pytest.mark.parametrize("roll", [0.0, 10.0])
def test_the_vehicle_starts_as_asked(angle: float, yaw: float, roll: float) -> None:
    """The path is the barrier's; yaw turns the nose to the left of it, then roll about the nose's axis."""
    settings = Settings(ground=False, gravity=0.0)
    result = Simulation(
        box(), Barrier.rigid_wall(heading=20.0), 10.0, angle, impact_yaw=yaw, impact_roll=roll, standoff=0.1,
        duration=0.001, settings=settings,
    ).run()  # fmt: skip
    path = math.radians(20.0 + 90.0 - angle)
    direction = np.array([math.cos(path), math.sin(path), 0.0])
    assert result.velocity[0] == pytest.approx(10.0 * direction, abs=1e-12)
    turn = Rotation.from_euler("ZYX", [20.0 + 90.0 - angle + yaw, 0.0, roll], degrees=True).as_matrix()
    assert orientation(result) == pytest.approx(turn, abs=1e-12)
    into = np.array([math.cos(math.radians(20.0)), math.sin(math.radians(20.0)), 0.0])
    nodes = result.position[0] + box().nodes @ turn.T
    anchors = result.position[0] + box().anchors @ turn.T
    nearest = max((nodes @ into).max(), (anchors @ into).max())
    assert nearest == pytest.approx(-0.1, abs=1e-9)  # the nearest point stands before the wall


def test_a_side_on_impact_into_a_pole_is_the_exact_one() -> None:
    """The right side goes ahead on one spring: crush v sqrt(m/k), force v sqrt(k m), and it bounces off."""
    speed, k, m = 5.0, 3e5, 1000.0
    pole = Barrier.pole(diameter=0.3, friction=0.0)
    # Crush of 0.29 m, less than the 0.4 m of the truss.
    result = Simulation(box(k), pole, speed, impact_yaw=90.0, settings=FREE).run()
    assert result.peak_deflection.argmax() == 3  # the node on the right
    assert result.metrics["dynamic_crush"] == pytest.approx(speed * math.sqrt(m / k), rel=1e-3)
    assert result.metrics["peak_normal_force"] == pytest.approx(speed * math.sqrt(k * m), rel=1e-3)
    assert result.metrics["exit_speed"] == pytest.approx(speed, rel=2e-3)
    assert np.abs(result.acceleration[:, 0]).max() < 1e-6 * np.abs(result.acceleration[:, 1]).max()
    assert np.abs(result.yaw).max() < 1e-6  # from the initial heading


def test_sides_mirror_each_other() -> None:
    """A side-on pole off the centre, left and right: y, roll and yaw change their signs."""
    car = Vehicle.preset("passenger_car", mesh_density=0.2)
    right, left = (
        Simulation(
            car, Barrier.pole(), 8.0, 90.0, offset, impact_yaw=yaw, impact_roll=roll, duration=0.1
        ).run()
        for offset, yaw, roll in ((0.4, 90.0, 2.0), (-0.4, -90.0, -2.0))
    )
    assert right.metrics["dynamic_crush"] > 0.1
    # Steps follow each other to rounding, which a crash lets grow.
    scale = np.abs(right.barrier_force).max()
    assert np.abs(left.barrier_force - right.barrier_force * [1.0, -1.0, 1.0]).max() < 1e-7 * scale
    assert left.position == pytest.approx(right.position * [1.0, -1.0, 1.0], abs=1e-8)
    assert left.yaw == pytest.approx(-right.yaw, abs=1e-6)
    assert left.roll == pytest.approx(-right.roll, abs=1e-6)


def test_a_rolled_vehicle_stands_on_the_ground() -> None:
    car = Vehicle.preset("passenger_car", mesh_density=0.2)
    result = Simulation(car, Barrier.rigid_wall(), 5.0, impact_roll=20.0, duration=0.002).run()
    turn = orientation(result)
    rim = min(
        (result.position[0] + turn @ wheel[:3])[2] - wheel[3] * math.hypot(turn[2, 0], turn[2, 2])
        for wheel in car.wheels
    )
    skin = (result.position[0] + car.nodes @ turn.T)[:, 2].min()
    assert min(rim, skin) == pytest.approx(0.0, abs=1e-9)
    assert result.roll[0] == pytest.approx(20.0)


# ---- along the barrier's line ------------------------------------------------------------------------------


@pytest.mark.parametrize("angle", [0.0, 180.0])
@pytest.mark.parametrize("heading", [0.0, 40.0])
def test_the_end_of_a_wall(angle: float, heading: float) -> None:
    """Head-on into the end of a wall 0.4 m thick, in its middle: the exact answer of one spring."""
    speed, k, m = 8.0, 3e5, 1000.0
    wall = Barrier.rigid_wall(
        width=10.0, height=1.2, thickness=0.4, friction=0.0, heading=heading, origin=(1.0, 2.0, 0.0)
    )
    result = Simulation(box(k), wall, speed, angle, 0.2, settings=FREE, standoff=0.05).run()
    line = math.radians(heading)
    way = np.array([-math.sin(line), math.cos(line), 0.0]) * (1.0 if angle == 0.0 else -1.0)
    behind = np.array([math.cos(line), math.sin(line), 0.0])
    assert result.velocity[0] == pytest.approx(speed * way, abs=1e-12)
    # The foremost node stands 0.05 m before the end, which is 5 m from the origin, in the middle of the wall.
    start = result.position[0] - [1.0, 2.0, 0.5]
    assert start @ way + 2.0 == pytest.approx(-5.0 - 0.05, abs=1e-6)
    assert start @ behind == pytest.approx(0.2, abs=1e-12)
    assert result.peak_deflection.argmax() == 0
    metrics = result.metrics
    assert metrics["dynamic_crush"] == pytest.approx(speed * math.sqrt(m / k), rel=1e-3)
    assert metrics["max_displacement"] == pytest.approx(metrics["dynamic_crush"], rel=1e-3)
    assert metrics["time_of_zero_velocity"] == pytest.approx(0.5 * math.pi * math.sqrt(m / k), rel=5e-3)
    assert metrics["restitution"] == pytest.approx(1.0, rel=2e-3)
    assert metrics["impact_severity"] == pytest.approx(0.0, abs=1e-9)
    assert "vehicle_penetration" not in metrics
    (load,) = result.element_loads
    assert (load.force @ way).max() == pytest.approx(speed * math.sqrt(k * m), rel=1e-3)


@pytest.mark.parametrize("angle", [0.0, 180.0])
@pytest.mark.parametrize(
    "barrier",
    [Barrier.rigid_wall(), Barrier.rigid_wall(height=1.0), Barrier.jersey()],
    ids=["wall", "low", "jersey"],
)
def test_a_wall_without_an_end_can_not_be_met_along_its_line(barrier: Barrier, angle: float) -> None:
    with pytest.raises(ValueError, match=rf"impact_angle must be > 0 and < 180 deg .* got {angle:g}$"):
        Simulation(box(), barrier, 8.0, angle)


@pytest.mark.parametrize("angle", [-1.0, 180.5, math.nan, math.inf])
def test_angles_beyond_are_refused(angle: float) -> None:
    with pytest.raises(ValueError, match="impact_angle must be within 0 and 180 deg"):
        Simulation(box(), Barrier.rigid_wall(width=3.0), 8.0, angle)


def test_a_row_of_bollards_along_its_line() -> None:
    result = Simulation(box(), Barrier.bollards(count=3, friction=0.0), 5.0, 0.0, settings=FREE).run()
    assert [load.name for load in result.element_loads if load.touched] == ["bollard 1"]


# ---- past the line -----------------------------------------------------------------------------------------


def test_penetration_is_the_foremost_anchor_past_the_line() -> None:
    """A body that no post meets goes as far past the line as its path does."""
    body = box()
    gap = Barrier.bollards(count=2, spacing=4.0, friction=0.0, heading=15.0, origin=(3.0, 1.0, 0.0))
    result = Simulation(body, gap, 10.0, 90.0, gap.station(), duration=0.5, settings=FREE).run()
    past = np.array([math.cos(math.radians(15.0)), math.sin(math.radians(15.0)), 0.0])
    travel = float((result.position[-1] - [3.0, 1.0, 0.0]) @ past)
    assert result.metrics["vehicle_penetration"] == pytest.approx(travel + 1.0, abs=1e-9)  # anchor at r = 1 m
    assert result.metrics["contact_overlap"] == 0.0


def test_penetration_of_a_turned_body_is_its_corner() -> None:
    """Every pose of a tumbling flight is asked for all anchors, in full."""
    car = Vehicle.preset("passenger_car", mesh_density=0.2)
    post = Barrier.bollards(count=1, friction=0.4)
    result = Simulation(car, post, 30.0, 90.0, 0.85, duration=0.6, impact_roll=8.0).run()
    assert np.abs(result.yaw).max() > 5.0
    centers, turns = result.pose(result.time)
    anchors = centers[:, None, :] + np.einsum(
        "kij,nj->kni", turns, car.anchors[(car.wheel_of_node < 0) & (car.along_of_node < 0)]
    )
    expected = max(0.0, float((anchors[..., 0]).max()))
    assert result.metrics["vehicle_penetration"] == pytest.approx(expected, abs=1e-9)
    assert expected > 0.5  # it got by


def test_a_wall_that_holds_is_not_passed() -> None:
    result = Simulation(box(), Barrier.rigid_wall(), 5.0, settings=FREE).run()
    assert result.metrics["vehicle_penetration"] == 0.0
