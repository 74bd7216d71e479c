"""A vehicle of two units in files, frames and pictures: each unit is where its own history has it."""

from __future__ import annotations

import pickle
from pathlib import Path

import birm3d
import numpy as np
import pytest
from birm3d import Barrier, Result, Simulation, Vehicle
from birm3d.base.fingerprint import fingerprint
from birm3d.plotting import plot_plan
from birm3d.result.skin import skins_at
from birm3d.vehicle.unit_shapes import unit_shapes


@pytest.fixture(scope="module")
def result() -> Result:
    """An oblique crash into bollards that bends the truck at its fifth wheel."""
    truck = Vehicle.preset("semi_truck", mesh_density=0.2)
    posts = Barrier.bollards(count=7, spacing=1.0)
    return Simulation(truck, posts, 15.0, 60.0, duration=0.4).run(frames=5)


def test_a_file_has_both_units_and_the_joint(result: Result, tmp_path: Path) -> None:
    result.save(tmp_path / "semi.npz")
    for loaded in (birm3d.load(tmp_path / "semi.npz"), pickle.loads(pickle.dumps(result))):
        assert loaded.scene == result.scene
        assert fingerprint(loaded.scene) == fingerprint(result.scene)
        assert dict(loaded.metrics) == dict(result.metrics)
        assert loaded.report() == result.report()
        for name in ("joint_force", "joint_moment", "articulation_angle", "joint_roll", "joint_pitch"):
            assert getattr(loaded, name).tobytes() == getattr(result, name).tobytes(), name
        for u in range(2):
            here, there = result.unit(u), loaded.unit(u)
            for name in (
                *("position", "velocity", "acceleration", "yaw", "barrier_force", "tire_reaction"),
                *("joint_force", "nodes", "deflection", "peak_deflection", "final_velocity"),
            ):
                assert getattr(there, name).tobytes() == getattr(here, name).tobytes(), name
            assert loaded.frames is not None
            assert result.frames is not None
            assert np.array_equal(loaded.frames.displacement[u], result.frames.displacement[u])
        for name, values in result.energy.items():
            assert loaded.energy[name].tobytes() == values.tobytes()
        with pytest.raises(ValueError, match="index must be >= 0 and < 2"):
            loaded.unit(2)


def test_the_scene_of_a_file_runs_the_same_way(result: Result, tmp_path: Path) -> None:
    result.save(tmp_path / "semi.npz")
    scene = birm3d.load(tmp_path / "semi.npz").scene
    assert Simulation.from_scene(scene).run().state_hash == result.state_hash
    loaded, truck = scene.vehicle, result.scene.vehicle
    assert loaded.with_gvw(30000.0) == truck.with_gvw(30000.0) != truck
    assert loaded.with_joint("welded") == truck.with_joint("welded") != truck


def test_shapes_and_frames_are_those_of_the_units(result: Result) -> None:
    shapes = unit_shapes(result.scene.vehicle)
    assert [len(shape.nodes) for shape in shapes] == [unit.n_nodes for unit in result.scene.vehicle.units]
    assert result.frames is not None
    for u, shape in enumerate(shapes):
        moved = result.frames.displacement[u]
        assert moved.shape == (5, len(shape.nodes), 3)
        assert np.abs(moved[0]).max() == 0.0
        # Frames are 32-bit numbers.
        assert moved[-1] == pytest.approx(result.unit(u).nodes - shape.nodes, abs=1e-6)


def test_the_joint_is_one_point_of_both_units(result: Result) -> None:
    """Skins in the world hang together: the joint's places on both units coincide at every instant drawn."""
    truck = result.scene.vehicle
    assert truck.joint is not None
    leading, trailing = truck.units
    places = (
        np.subtract(truck.joint.place_on_leading, leading.center_of_mass),
        np.subtract(truck.joint.place_on_trailing, trailing.center_of_mass),
    )
    assert np.abs(result.articulation_angle).max() > 1.0
    for skins in skins_at(result, np.linspace(0.0, result.time[-1], 5)):
        first, second = (
            skin.center + skin.rotation @ place for skin, place in zip(skins, places, strict=True)
        )
        # Between two steps the path of each unit is interpolated by itself; at the steps the gap is rounding.
        # Measured over all rows: 1.4e-5 m.
        assert first == pytest.approx(second, abs=1e-4)


def test_the_plan_has_an_outline_around_both_units_and_a_line_around_each(result: Result) -> None:
    times = [0.0, 0.2, 0.4]
    axes = plot_plan(result, times).gca()
    assert len(axes.patches) == len(times)
    thin = [line for line in axes.get_lines() if line.get_linewidth() == 0.6]
    assert len(thin) == 2 * len(times)
