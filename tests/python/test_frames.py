"""Frames: where the skin is at chosen instants, without changing the run."""

from __future__ import annotations

import numpy as np
import pytest
from birm3d import Barrier, Result, Settings, Simulation, Vehicle, scenes
from birm3d.result.frames import pose
from birm3d.result.skin import skins_at
from scipy.spatial.transform import Rotation


def pole_crash() -> Simulation:
    car = Vehicle.preset("passenger_car", mesh_density=0.3)
    return Simulation(car, Barrier.pole(diameter=0.4), 12.0, impact_offset=0.1)


@pytest.fixture(scope="module")
def result() -> Result:
    return pole_crash().run()


def test_frames_change_nothing(result: Result) -> None:
    sim = pole_crash()
    framed = sim.run(frames=7)
    assert framed.state_hash == sim.state_hash() == result.state_hash
    assert np.array_equal(framed.position, result.position)
    assert result.frames is None


def test_a_number_of_frames_spans_the_run(result: Result) -> None:
    frames = result.with_frames(7).frames
    assert frames is not None
    assert len(frames) == 7
    assert set(frames.time) <= set(result.time)
    assert (frames.time[0], frames.time[-1]) == (0.0, result.time[-1])
    assert np.ptp(np.diff(frames.time)) <= 1.001 * result.scene.settings.output_interval
    (moved,) = frames.displacement
    assert moved.shape == (7, result.scene.vehicle.n_nodes, 3)
    assert not moved.flags.writeable
    assert np.all(moved[0] == 0.0)
    # The last row is at most an output interval before the state at the end.
    final = result.nodes - result.scene.vehicle.nodes
    assert np.abs(moved[-1] - final).max() < 1e-3


def test_frames_are_the_nodes_of_the_steps(result: Result) -> None:
    """At the end of a step a frame has the state's nodes, to the digits of float32."""
    sim = pole_crash()
    for _ in range(60):
        sim.step()
    there = sim.result().nodes - result.scene.vehicle.nodes
    assert np.abs(there).max() > 0.1
    frames = result.with_frames([sim.time]).frames
    assert frames is not None
    assert np.abs(frames.displacement[0][0] - there).max() < 1e-6


def test_nodes_of_a_wall_crash_stay_before_the_wall() -> None:
    """Pose and nodes together: no node is behind the face, and those in contact are on it."""
    result = scenes.nhtsa_10146(mesh_density=0.3).run()
    for (skin,) in skins_at(result, [0.02, 0.05, 0.08]):
        # Rows are 0.1 ms apart and the car has at most 16 m/s: nodes may be 1 mm off between them.
        assert skin.world[:, 0].max() == pytest.approx(0.0, abs=2e-3)


def test_between_frames_it_is_linear(result: Result) -> None:
    frames = result.with_frames([0.02, 0.04]).frames
    assert frames is not None
    a, b = frames.displacement[0].astype(float)
    assert np.allclose(frames.displacement_at(0.025), 0.75 * a + 0.25 * b, atol=1e-9)
    assert np.allclose(frames.displacement_at(0.04), b, atol=1e-9)
    for time in (0.019, 0.041, float("nan")):
        with pytest.raises(ValueError, match="time must be between"):
            frames.displacement_at(time)


@pytest.mark.parametrize(
    ("frames", "message"),
    [
        (1, "frames must be 2 to"),
        (10**6, "frames must be 2 to"),
        ([], "frames must be a number or a list"),
        ([[0.1]], "frames must be a whole number or a list of numbers"),
        ([0.1, 0.1], "frames must be finite and increase"),
        ([float("nan")], "frames must be finite and increase"),
        ([0.0, 99.0], "frames must be within 0 to"),
    ],
)
def test_bad_frames(result: Result, frames: list[float], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        result.with_frames(frames)


def test_another_run_is_refused(result: Result) -> None:
    """As of a result that another version has computed."""
    other = result.with_frames(2)
    other.state_hash ^= 1
    with pytest.raises(ValueError, match="scene that runs the same way again"):
        other.with_frames(2)


def test_unfinished_run_has_frames() -> None:
    sim = pole_crash()
    for _ in range(40):
        sim.step()
    result = sim.result()
    assert result.end_reason == "running"
    assert result.with_frames(3).frames is not None


def test_pose() -> None:
    """A turn at a constant rate about a slanted axis, known at rows and between them."""
    time = np.linspace(0.0, 1.0, 11)
    turn = Rotation.from_rotvec(np.outer(time, [0.3, 0.5, 2.0]))
    position = np.outer(time, [10.0, 0.0, -1.0])
    at = np.array([0.0, 0.25, 1.0])
    centers, matrices = pose(time, position, turn.as_euler("ZYX")[:, ::-1], at)
    assert np.allclose(centers, np.outer(at, [10.0, 0.0, -1.0]), atol=1e-12)
    assert np.allclose(matrices, Rotation.from_rotvec(np.outer(at, [0.3, 0.5, 2.0])).as_matrix(), atol=1e-12)
    with pytest.raises(ValueError, match="time must be within 0 to 1 s"):
        pose(time, position, turn.as_euler("ZYX")[:, ::-1], [1.1])


def test_pose_of_a_result() -> None:
    result = Simulation(
        Vehicle.preset("pickup", mesh_density=0.1), None, 10.0, duration=0.1, settings=Settings(ground=False)
    ).run()
    centers, turns = result.pose(result.time)
    assert np.allclose(centers, result.position)
    assert np.allclose(turns, np.eye(3), atol=1e-12)
