"""Bottomed-out trusses: the rigid body itself is held at the wall, at any speed."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable

import numpy as np
import pytest
from birm3d import Barrier, Settings, Simulation, Vehicle, scenes
from scipy.spatial.transform import Rotation

SoftScene = Callable[..., Simulation]
FREE = {"gravity": 0.0, "ground": False}
STEPS = pytest.mark.parametrize("time_step", [None, 1e-3, 2e-4])
ANGLES = pytest.mark.parametrize("angle", [90.0, 65.0, 45.0, 25.0])

# m; the core calls points nearer than 1e-6 m touching, and a step that turns the body curves its way.
DEPTH = 1e-5


@ANGLES
@STEPS
def test_the_rigid_body_is_held_at_the_wall(
    make_soft_scene: SoftScene, angle: float, time_step: float | None
) -> None:
    simulation = make_soft_scene(angle, Settings(time_step=time_step, **FREE))
    simulation.run()
    result = simulation.result()
    metrics = result.metrics
    assert 0.0 <= metrics["contact_overlap"] < DEPTH
    assert result.energy["impacts"][-1] > 0.05 * result.energy["kinetic"][0]  # it was held indeed
    assert metrics["energy_residual"] < 1e-3
    assert metrics["momentum_residual"] < 1e-9
    assert all(math.isfinite(value) for value in metrics.values())
    for array in (result.position, result.velocity, result.acceleration, result.barrier_force, result.nodes):
        assert np.isfinite(array).all()


@ANGLES
@STEPS
def test_no_anchor_passes_the_face_in_any_step(
    make_soft_scene: SoftScene, angle: float, time_step: float | None
) -> None:
    """Seen from outside: anchors placed by the position and the angles after each step."""
    # One output row per step: the last row of the result is the state after the step for fixed steps.
    step = time_step or 1e-4
    simulation = make_soft_scene(angle, Settings(time_step=time_step, output_interval=step, **FREE))
    result = simulation.run()
    anchors = result.scene.vehicle.anchors
    angles = np.column_stack([result.yaw + 90.0 - angle, result.pitch, result.roll])
    turn = Rotation.from_euler("ZYX", angles, degrees=True).as_matrix()
    front = (np.einsum("nij,aj->nai", turn, anchors) + result.position[:, None, :])[..., 0].max(axis=1)
    # Between adaptive steps positions are interpolated across rigid impacts, which lie on step ends: the
    # cubic between rows of 0.1 ms may overshoot by a share of the 0.1 mm that a step of the approach covers.
    assert front.max() < (DEPTH if time_step else 1e-4)
    nodes = np.einsum("ij,nj->ni", turn[-1], result.nodes) + result.position[-1]
    assert nodes[:, 0].max() < 1e-3


@STEPS
def test_speed_after_closing(time_step: float | None) -> None:
    """Flat and head-on it is Eq. 1 of the whole body: restitution 0.1 of the speed left, and the springs."""
    mass, speed, k, knee, ku, length = 6804.0, 30.0, 5e5, 0.2, 5e6, 2.0
    block = scenes.laboratory_block(100, k_initial=k, knee=knee, k_unloading=ku)
    choice = Settings(time_step=time_step, **FREE)
    metrics = Simulation(block, Barrier.rigid_wall(friction=0.0), speed, settings=choice).run().metrics
    force = k * knee
    work = 0.5 * k * knee**2 + force * (length - knee)
    arriving = math.sqrt(speed**2 - 2.0 * work / mass)
    leaving = math.sqrt((0.1 * arriving) ** 2 + force**2 / (ku * mass))
    # A fixed step holds the body from the beginning of the step in which it would arrive: 1 % of the crush.
    tolerance = 1e-3 if time_step is None else 1e-2
    assert metrics["exit_speed"] == pytest.approx(leaving, rel=tolerance)
    assert metrics["dynamic_crush"] == pytest.approx(length, rel=1e-6 if time_step is None else 2e-2)


@pytest.mark.filterwarnings("ignore::birm3d.UnitWarning")  # 300 m/s is meant
@pytest.mark.parametrize("speed", [5.0, 30.0, 100.0, 300.0])
def test_nothing_passes_at_any_speed(speed: float) -> None:
    block = scenes.laboratory_block(36, k_initial=1e4, knee=0.1, k_unloading=1e5)
    simulation = Simulation(
        block, Barrier.rigid_wall(), speed, 70.0, duration=6.0 / speed, settings=Settings(**FREE)
    )
    result = simulation.run()
    assert result.metrics["contact_overlap"] < DEPTH
    assert result.velocity[-1, 0] < speed


@pytest.mark.parametrize("restitution", [0.0, 0.5, 1.0])
def test_restitution_of_the_rigid_body(restitution: float) -> None:
    # Next to no springs: what comes back is Eq. 1.
    block = scenes.laboratory_block(36, k_initial=1.0, k_unloading=1.0)
    choice = Settings(restitution=restitution, **FREE)
    wall = Barrier.rigid_wall(friction=0.0)
    result = Simulation(block, wall, 10.0, duration=0.3, settings=choice).run()
    # The springs do 2 J of 340 kJ.
    assert result.velocity[-1, 0] == pytest.approx(-restitution * 10.0, abs=1e-3)


@pytest.mark.parametrize(
    ("vehicle", "barrier", "speed", "angle", "duration", "metric"),
    [
        # The front is crushed to the rigid body: rows of anchors reach the post within half a millimetre.
        ("pickup", Barrier.bollards(), 20.0, 90.0, 0.15, "max_pitch"),
        # A wheel lands beside one that is 0.002 mm in the ground after a long step; the next step is short.
        ("minivan", Barrier.jersey(length=30.0), 21.0, 25.0, 0.41, "max_roll"),
    ],
    ids=["rows of anchors", "wheels"],
)
def test_impacts_do_not_hang_on_the_step(
    vehicle: str, barrier: Barrier, speed: float, angle: float, duration: float, metric: str
) -> None:
    """0.01 deg: what the steps' own error is at a tolerance of 3e-4; once 0.05 and 0.22 deg.

    Wheels are held straight and upright: steering and camber thrust have errors of their own, 0.016 deg.
    """
    preset = Vehicle.preset(vehicle)
    held = dataclasses.replace(preset.zones["tire"], steering_time=None, camber_ratio=None)
    straight = preset.with_zones({"tire": held})
    angles = [
        Simulation(
            straight,
            barrier,
            speed,
            angle,
            duration=duration,
            settings=Settings(tolerance=tolerance),
        )
        .run()
        .metrics[metric]
        for tolerance in (3e-4, 1e-4, 3e-5)
    ]
    assert max(angles) - min(angles) < 0.01


def test_contacts_that_rounding_lets_join_and_leave_for_ever_are_let_be() -> None:
    """A semi-truck's body stands at a wall with hundreds of anchors, of which three took turns."""
    result = Simulation(
        Vehicle.preset("semi_truck"), Barrier.rigid_wall(width=6.0, height=1.0), 40.0, 90.0
    ).run()
    assert result.metrics["energy_residual"] < 1e-3
    assert result.metrics["momentum_residual"] < 1e-9


@pytest.mark.parametrize("tolerance", [1e-5, 1.7e-7])
def test_steps_do_not_shrink_to_nothing_where_the_rigid_body_rebounds(tolerance: float) -> None:
    """Its impact is no reversal that a shorter step would locate: once an UnstableError in the second case.

    Vehicle, anchors and wall are symmetric. Anchors that stand at its face hold their trusses on both sides
    alike, so that nothing turns the vehicle.
    """
    truck = Vehicle.preset("semi_truck", mesh_density=0.2)
    result = Simulation(
        truck.with_gvw(1.323 * truck.mass),
        Barrier.rigid_wall(width=6.2473, height=1.5642, thickness=0.01166, friction=0.0),
        45.0,
        impact_offset=0.3282,
        duration=0.1,
        settings=Settings(tolerance=tolerance, restitution=0.911),
    ).run()
    assert result.statistics.body_steps > 0
    assert result.velocity[-1][0] < 0.0
    assert result.metrics["energy_residual"] < 1e-4
    assert np.abs(result.yaw).max() < 1e-6


def test_points_found_inside_a_thin_wall_are_not_thrown_out() -> None:
    """Anchors behind the skin come out of the wall's round end 1 mm inside: 1.7 % of the energy was made."""
    car = Vehicle.preset("passenger_car", mesh_density=0.2)
    wall = Barrier.rigid_wall(width=3.1023, height=0.649, thickness=0.050633, friction=0.0)
    simulation = Simulation(
        car.with_gvw(1.38026 * car.mass),
        wall,
        14.0,
        19.8186,
        0.3,
        impact_yaw=-99.0,
        duration=0.61,
        settings=Settings(tolerance=1.14350e-3),
    )
    result = simulation.run()
    assert result.statistics.deepest_point > 5e-4
    impacts = result.energy["impacts"]
    fall = (np.maximum.accumulate(impacts) - impacts).max()
    assert fall < 1e-6 * result.energy["kinetic"][0]


@pytest.mark.parametrize("tolerance", [1e-3, 1e-1])
def test_a_body_that_turns_on_a_point_keeps_it_at_the_surface(tolerance: float) -> None:
    """An upturned truck turns about an edge that leans on a bollard. The arcs of its steps led 0.06 mm in."""
    truck = Vehicle.preset("cargo_truck", mesh_density=0.2)
    settings = Settings(tolerance=tolerance)
    result = Simulation(
        truck,
        Barrier.bollards(),
        20.0,
        70.0,
        0.2,
        impact_roll=180.0,
        duration=0.4,
        settings=settings,
    ).run()
    assert result.statistics.body_steps > 20
    assert result.statistics.deepest_point < 5e-6
