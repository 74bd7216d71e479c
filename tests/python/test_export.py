"""Runs for other programs: glTF (Blender, browsers) and VTK (ParaView), read back and compared."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import numpy.typing as npt
import pygltflib
import pytest
import pyvista
import trimesh
from birm3d import Barrier, Result, Simulation, Vehicle
from birm3d.result.skin import skins_at
from scipy.spatial.transform import Rotation

Floats = npt.NDArray[np.float64]

_COLUMNS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}


@pytest.fixture(scope="module")
def run() -> Result:
    car = Vehicle.preset("passenger_car", mesh_density=0.1)
    return Simulation(car, Barrier.rigid_wall(friction=0.2), 15.0, 60.0, duration=0.4).run()


@pytest.fixture(scope="module")
def pushed() -> Result:
    car = Vehicle.preset("passenger_car", mesh_density=0.1)
    barrier = Barrier.jersey(length=12.0, segments=2, free_standing=True)
    return Simulation(car, barrier, 20.0, 25.0).run()


# ---- glTF --------------------------------------------------------------------------------------------------


class Player:
    """What a player of glTF does: interpolates the animation and puts nodes into each other."""

    def __init__(self, path: Path) -> None:
        self.file: Any = pygltflib.GLTF2().load(str(path))
        if self.file.binary_blob() is None:
            self.file.convert_buffers(pygltflib.BufferFormat.BINARYBLOB)
        self.parent = {c: i for i, n in enumerate(self.file.nodes) for c in n.children or []}

    def array(self, number: int) -> npt.NDArray[Any]:
        accessor = self.file.accessors[number]
        view = self.file.bufferViews[accessor.bufferView]
        kind = {5126: np.float32, 5125: np.uint32}[accessor.componentType]
        count = accessor.count * _COLUMNS[accessor.type]
        values = np.frombuffer(self.file.binary_blob(), kind, count, view.byteOffset)
        return values.reshape(accessor.count, -1).astype(float)

    def number(self, name: str) -> int:
        return next(i for i, node in enumerate(self.file.nodes) if node.name == name)

    def value(self, node: int, path: str, k: int) -> Floats | None:
        animation = self.file.animations[0]
        for channel in animation.channels:
            if (channel.target.node, channel.target.path) == (node, path):
                times = self.array(animation.samplers[channel.sampler].input)
                values = self.array(animation.samplers[channel.sampler].output)
                return values.reshape(len(times), -1)[k]
        given = getattr(self.file.nodes[node], path, None)
        return None if given is None else np.array(given)

    def times(self) -> Floats:
        return self.array(self.file.animations[0].samplers[0].input)[:, 0]

    def points(self, name: str, k: int) -> Floats:
        """Corners of the mesh of a node at an instant, in axes with y up."""
        node = self.number(name)
        mesh = self.file.meshes[self.file.nodes[node].mesh]
        primitive = mesh.primitives[0]
        points = self.array(primitive.attributes.POSITION)
        weights = self.value(node, "weights", k)
        for weight, target in zip([] if weights is None else weights, primitive.targets or [], strict=True):
            if weight:
                points = points + weight * self.array(target["POSITION"])
        while node is not None:
            turn, shift = self.value(node, "rotation", k), self.value(node, "translation", k)
            points = points if turn is None else Rotation.from_quat(turn).apply(points)
            points = points if shift is None else points + shift
            node = self.parent.get(node)
        return points


def to_world(points: Floats) -> Floats:
    """From y up to z up."""
    return points @ np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])


@pytest.mark.parametrize("ending", ["glb", "gltf"])
def test_gltf_has_the_nodes_where_the_result_has_them(run: Result, tmp_path: Path, ending: str) -> None:
    path = tmp_path / f"crash.{ending}"
    run.write_gltf(path, frames=7)
    player = Player(path)
    times = player.times()
    np.testing.assert_allclose(times[[0, -1]], run.time[[0, -1]] - run.time[0], atol=1e-6)
    shown = np.unique(run.scene.vehicle.quads)
    rows = np.round(np.linspace(0, len(run.time) - 1, 7)).astype(int)
    for k, units in enumerate(skins_at(run, run.time[rows])):
        np.testing.assert_allclose(
            to_world(player.points("skin of vehicle", k)), units[0].world[shown], atol=2e-5
        )
    wheel = to_world(player.points("wheel 1 of vehicle", 0))
    (center,), (turn,) = run.pose([run.time[0]])
    center = center + turn @ run.scene.vehicle.wheels[0, :3]
    np.testing.assert_allclose(wheel.mean(axis=0), center, atol=1e-3)
    assert np.ptp(wheel[:, 2]) == pytest.approx(2.0 * run.scene.vehicle.wheels[0, 3], rel=1e-3)


def test_gltf_is_read_by_another_library(run: Result, tmp_path: Path) -> None:
    run.write_gltf(tmp_path / "crash.glb", frames=3)
    scene = trimesh.load_scene(tmp_path / "crash.glb")
    names = set(scene.geometry)
    assert any("skin" in name for name in names)
    assert any("barrier" in name for name in names)
    skin = next(mesh for name, mesh in scene.geometry.items() if "skin" in name)
    assert len(skin.faces) == 2 * run.scene.vehicle.n_elements


@pytest.mark.filterwarnings("ignore::birm3d.TippingWarning")
def test_gltf_moves_segments_that_stand_free(pushed: Result, tmp_path: Path) -> None:
    pushed.write_gltf(tmp_path / "pushed.glb", frames=5)
    player = Player(tmp_path / "pushed.glb")
    went = pushed.segment_position[-1] - pushed.segment_position[0]
    assert np.abs(went).max() > 0.01
    for segment in range(2):
        first, last = (to_world(player.points(f"barrier {segment + 1}", k)) for k in (0, 4))
        angle = np.radians(pushed.segment_yaw[-1, segment])
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        foot = pushed.segment_position[0, segment, :2]
        expected = (first[:, :2] - foot) @ turn.T + pushed.segment_position[-1, segment, :2]
        np.testing.assert_allclose(last[:, :2], expected, atol=1e-4)


def test_gltf_is_valid_where_players_are_strict(run: Result, tmp_path: Path) -> None:
    """Bounds of positions and times, alignment, lengths: what validators ask for."""
    run.write_gltf(tmp_path / "crash.glb", frames=4)
    player = Player(tmp_path / "crash.glb")
    size = player.file.buffers[0].byteLength
    for number, accessor in enumerate(player.file.accessors):
        view = player.file.bufferViews[accessor.bufferView]
        assert view.byteOffset % 4 == 0
        assert view.byteOffset + view.byteLength <= size
        values = player.array(number)
        assert np.isfinite(values).all()
        if accessor.min:
            np.testing.assert_allclose(values.min(axis=0), accessor.min, rtol=1e-6)
            np.testing.assert_allclose(values.max(axis=0), accessor.max, rtol=1e-6)
    for mesh in player.file.meshes:
        primitive = mesh.primitives[0]
        count = player.file.accessors[primitive.attributes.POSITION].count
        assert player.array(primitive.indices).max() < count
        assert all(player.file.accessors[one["POSITION"]].count == count for one in primitive.targets or [])
        assert len(mesh.weights or []) == len(primitive.targets or [])
    for channel in player.file.animations[0].channels:
        assert channel.target.path in ("translation", "rotation", "weights")


# ---- VTK ---------------------------------------------------------------------------------------------------


def series(path: Path) -> list[tuple[float, str, Any]]:
    root = ElementTree.parse(path).getroot()
    return [
        (float(one.get("timestep")), one.get("group"), pyvista.read(path.parent / one.get("file")))
        for one in root.iter("DataSet")
    ]


def test_vtk_has_nodes_crush_and_forces_of_the_result(run: Result, tmp_path: Path) -> None:
    run.write_vtk(tmp_path / "crash.pvd", frames=9)
    parts = series(tmp_path / "crash.pvd")
    reader = pyvista.PVDReader(tmp_path / "crash.pvd")
    rows = np.round(np.linspace(0, len(run.time) - 1, 9)).astype(int)
    np.testing.assert_allclose(reader.time_values, run.time[rows], atol=1e-8)
    skins = [mesh for _, name, mesh in parts if name == "vehicle"]
    car = run.scene.vehicle
    n = int(car.quads.max()) + 1
    core = run.scene.start()
    touched = 0
    for units, time, mesh in zip(skins_at(run, run.time[rows]), run.time[rows], skins, strict=True):
        while core.time < time and core.step():
            pass
        skin = units[0]
        np.testing.assert_allclose(mesh.points, skin.world[:n], atol=1e-5)
        np.testing.assert_allclose(mesh.point_data["crush"], skin.crush[:n], atol=1e-6)
        np.testing.assert_allclose(
            np.linalg.norm(mesh.point_data["displacement"], axis=1), skin.crush[:n], atol=1e-6
        )
        force = mesh.point_data["truss_force"]
        np.testing.assert_allclose(force, core.truss_force(0)[:n])
        np.testing.assert_array_equal(mesh.point_data["contact"], force > 0.0)
        touched = max(touched, int(mesh.point_data["contact"].sum()))
        assert mesh.n_cells == car.n_elements
    assert touched > 5
    assert skins[0].point_data["contact"].sum() == 0
    walls = [mesh for _, name, mesh in parts if name == "barrier"]
    assert len(walls) == 9
    assert walls[0].bounds[5] >= 1.0


@pytest.mark.filterwarnings("ignore::birm3d.TippingWarning")
def test_vtk_of_a_vehicle_of_two_units_and_of_free_segments(pushed: Result, tmp_path: Path) -> None:
    pushed.write_vtk(tmp_path / "pushed.pvd", frames=3)
    walls = [mesh for _, name, mesh in series(tmp_path / "pushed.pvd") if name == "barrier"]
    assert set(walls[0].cell_data["element"]) == {0, 1}
    assert np.abs(walls[2].points - walls[0].points).max() > 0.01
    truck = Vehicle.preset("semi_truck", mesh_density=0.05)
    two = Simulation(truck, Barrier.bollards(), 5.0, duration=0.02).run()
    two.write_vtk(tmp_path / "pushed.pvd", frames=2)
    names = {name for _, name, _ in series(tmp_path / "pushed.pvd")}
    assert {"vehicle_unit_1", "vehicle_unit_2", "wheels_1", "wheels_2", "barrier"} == names
    assert len(list((tmp_path / "pushed").iterdir())) == 2 * 5  # nothing is left of the first series


def test_vehicle_from_arrays_is_written(tmp_path: Path) -> None:
    from birm3d import scenes

    block = scenes.w1().run()
    block.write_vtk(tmp_path / "block.pvd", frames=2)
    assert next(mesh for _, name, mesh in series(tmp_path / "block.pvd") if name == "vehicle").n_points > 10
    block.write_gltf(tmp_path / "block.glb", frames=2)
    assert Player(tmp_path / "block.glb").number("vehicle") > 0


# ---- arguments and command line ----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("method", "path", "frames", "message"),
    [
        ("write_gltf", "crash.stl", 5, r"path must end in .glb or .gltf, got .*crash.stl"),
        ("write_gltf", "crash.glb", 1, r"frames must be 2 to \d+.*got 1"),
        ("write_gltf", "lost/crash.glb", 5, r"lost"),
        ("write_vtk", "crash.vtk", 5, r"path must end in .pvd"),
        ("write_vtk", "crash.pvd", 0, r"frames must be 2 to \d+.*got 0"),
        ("write_vtk", "taken.pvd", 5, r"room for a folder 'taken'"),
    ],
)
def test_arguments_are_refused_by_name(
    run: Result, tmp_path: Path, method: str, path: str, frames: int, message: str
) -> None:
    (tmp_path / "taken").write_text("")
    with pytest.raises(ValueError, match=message):
        getattr(run, method)(tmp_path / path, frames=frames)
    assert [file.name for file in tmp_path.iterdir()] == ["taken"]


@pytest.mark.parametrize(("module", "method"), [("pygltflib", "write_gltf"), ("pyvista", "write_vtk")])
def test_missing_library_is_named(
    run: Result, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, module: str, method: str
) -> None:
    monkeypatch.setitem(__import__("sys").modules, module, None)
    with pytest.raises(ImportError, match=rf"{method}\(\) needs {module}: pip install 'birm3d\[export\]'"):
        getattr(run, method)(tmp_path / ("a.glb" if module == "pygltflib" else "a.pvd"))


def test_command_line_writes_both(
    tmp_path: Path, command: Callable[..., int], capsys: pytest.CaptureFixture[str]
) -> None:
    files = [tmp_path / "crash.glb", tmp_path / "crash.pvd"]
    arguments = ["run", "--vehicle", "passenger_car", "--mesh-density", "0.05", "--speed", "20mph"]
    assert command(*arguments, "--gltf", files[0], "--vtk", files[1]) == 0
    assert all(file.stat().st_size > 1000 for file in files)
    told = capsys.readouterr().err
    assert f"animation: {files[0]}" in told
    assert f"series: {files[1]}" in told
