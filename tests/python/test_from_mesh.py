"""Vehicles whose skin is a mesh: birm3d.Vehicle.from_mesh."""

from __future__ import annotations

import struct
from collections.abc import Callable
from itertools import permutations
from pathlib import Path
from typing import Any

import meshio
import numpy as np
import numpy.typing as npt
import pytest
import trimesh
from birm3d import Barrier, FileFormatError, Simulation, Vehicle, units
from birm3d.result.crush_profile import crush_map
from birm3d.vehicle.mesh_import.mass_solid import solid_of
from birm3d.vehicle.mesh_import.surface_file import read_mesh
from birm3d.vehicle.mesh_import.wrap import sampled
from hypothesis import given
from hypothesis import strategies as st
from keyword_decks import box, car_parts, skin_of, write_deck
from scipy.spatial import cKDTree

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

MASS = 1719.0  # of the test that the front of the preset was fitted to
UNDERSIDE = 0.16  # m, of the preset's skin above the ground
OVERHANG = 0.98
GIVEN: dict[str, Any] = {
    "mass": MASS, "like": "passenger_car", "clearance": UNDERSIDE, "front_overhang": OVERHANG
}  # fmt: skip


@pytest.fixture(scope="module")
def skin() -> tuple[Floats, Ints]:
    return skin_of(Vehicle.preset("passenger_car"))


@pytest.fixture(scope="module")
def car_stl(skin: tuple[Floats, Ints], tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("mesh") / "car.stl"
    written(path, skin[0] / units.mm, skin[1])
    return path


@pytest.fixture(scope="module")
def deck(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("deck") / "car.k"
    write_deck(path, car_parts())
    return path


@pytest.fixture(scope="module")
def from_deck(deck: Path) -> Vehicle:
    return Vehicle.from_mesh(deck, mass=MASS, kind="car", unit="mm")


def written(path: Path, points: Floats, triangles: Ints) -> Path:
    trimesh.Trimesh(points, triangles, process=False).export(path)
    return path


def crash(vehicle: Vehicle, angle: float = 90.0) -> dict[str, float]:
    run = Simulation(vehicle, Barrier.rigid_wall(friction=0.2), 57.09 * units.km_h, angle).run()
    return {name: run.metrics[name] for name in ("dynamic_crush", "peak_normal_force_cfc60", "exit_speed")}


# ---- a preset's own skin -----------------------------------------------------------------------------------


def test_preset_whose_skin_went_through_a_file_crashes_as_the_preset(car_stl: Path) -> None:
    preset = Vehicle.preset("passenger_car", gvw=MASS)
    front_axle, _, down, radius = preset.wheels[0]
    known = {"inertia": preset.inertia, "center_of_mass": (-front_axle, 0.0, radius - down)}
    own = Vehicle.from_mesh(car_stl, unit="mm", **known, **GIVEN)
    assert own.name == "car"
    assert (own.mass, own.kind) == (MASS, "car")
    for name in ("length", "width", "height", "wheelbase", "track"):
        assert getattr(own, name) == pytest.approx(getattr(preset, name), abs=1e-3)
    area = [np.bincount(v.zone_of_node, v.area, len(v.zones)) for v in (preset, own)]
    assert list(own.zones) == list(preset.zones)
    np.testing.assert_allclose(area[1], area[0], rtol=0.02)
    for angle in (90.0, 45.0):
        for name, value in crash(preset, angle).items():
            assert crash(own, angle)[name] == pytest.approx(value, rel=0.01), (name, angle)


def test_skin_laid_around_the_pieces_of_a_preset_crashes_as_the_preset(from_deck: Vehicle) -> None:
    """Sheets without side windows, open below, with engine, seat, one mirror and tyres."""
    preset = Vehicle.preset("passenger_car", gvw=MASS)
    assert from_deck.length == pytest.approx(preset.length, abs=0.01)
    assert from_deck.width == pytest.approx(preset.width, abs=0.01)  # without the mirror
    assert from_deck.height == pytest.approx(preset.height, abs=0.01)
    assert from_deck.wheelbase == pytest.approx(2.825, abs=0.001)
    assert from_deck.track == pytest.approx(1.6, abs=0.001)
    assert from_deck._file.extent.front == pytest.approx(0.98, abs=0.005)
    nodes = from_deck.nodes[from_deck.is_skin] + from_deck.center_of_mass
    assert trimesh.Trimesh(nodes, from_deck.quads[:, :3]).volume > 0.0
    places, triangles = skin_of(preset)
    apart = cKDTree(sampled(places, triangles, 0.01)).query(nodes)[0]
    assert np.quantile(apart, 0.8) < 0.02  # but for windows and the opening below the engine
    assert np.abs(nodes[:, 1]).max() < places[:, 1].max() + 0.02
    assert nodes[:, 2].min() > UNDERSIDE - 0.03  # tyres are not part of the skin
    for angle in (90.0, 45.0):
        for name, value in crash(preset, angle).items():
            assert crash(from_deck, angle)[name] == pytest.approx(value, rel=0.05), (name, angle)


def test_what_was_understood_is_told(from_deck: Vehicle) -> None:
    told = "\n".join(one.text for one in from_deck.assumptions)
    assert "wheelbase 2.8" in told
    assert "closed skin of" in told
    assert "the preset passenger_car" in told
    assert "11,664 triangles of 9 parts, in mm" not in told
    assert any("car.k" in source.text for source in from_deck._file.sources)


def test_what_is_known_is_not_drawn(deck: Path, from_deck: Vehicle) -> None:
    """Size and wheelbase are those of the mesh."""
    assert set(from_deck.assumed_distributions()) == {
        f"vehicle.{name}" for name in ("mass_center_height", "roll_inertia", "yaw_inertia")
    }
    known = {"inertia": (600.0, 2900.0, 3100.0), "center_of_mass": (-1.2, 0.0, 0.55)}
    measured = Vehicle.from_mesh(deck, mass=MASS, kind="car", unit="mm", **known)
    assert measured.assumed_distributions() == {}
    assert not {"mass_center_height", "roll_inertia", "yaw_inertia"} & set(measured.scatter)


def test_saved_vehicle_is_read_back(from_deck: Vehicle, tmp_path: Path) -> None:
    from_deck.save(tmp_path / "car.toml")
    back = Vehicle.from_file(tmp_path / "car.toml")
    assert back == from_deck
    assert [one.text for one in back.assumptions] == [one.text for one in from_deck.assumptions]
    lighter = from_deck.with_gvw(1600.0).with_zone("bumper", k_unloading=6e6)
    lighter.save(tmp_path / "lighter.toml")
    assert Vehicle.from_file(tmp_path / "lighter.toml") == lighter


def test_scaled_vehicle_has_a_scaled_skin(from_deck: Vehicle) -> None:
    longer = from_deck.scaled_to(2000.0, length=1.1 * from_deck.length)
    assert longer.length == pytest.approx(1.1 * from_deck.length, rel=1e-5)
    ratio = np.ptp(longer.nodes[longer.is_skin], axis=0) / np.ptp(from_deck.nodes[from_deck.is_skin], axis=0)
    np.testing.assert_allclose(ratio, [1.1, 1.0, 1.0], rtol=1e-4)


# ---- laws --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("forward", "up"), [("-y", "+z"), ("+z", "-x"), ("-x", "+y")])
def test_axes_of_the_mesh_do_not_matter(
    car_stl: Path, skin: tuple[Floats, Ints], tmp_path: Path, forward: str, up: str
) -> None:
    basis = {"x": [1.0, 0.0, 0.0], "y": [0.0, 1.0, 0.0], "z": [0.0, 0.0, 1.0]}
    ahead, above = (float(f"{axis[0]}1") * np.array(basis[axis[1]]) for axis in (forward, up))
    turned = skin[0] @ np.stack([ahead, np.cross(above, ahead), above])
    path = written(tmp_path / "car.stl", turned / units.mm + 7e3, skin[1])
    plain = Vehicle.from_mesh(car_stl, unit="mm", **GIVEN)
    own = Vehicle.from_mesh(path, unit="mm", forward=forward, up=up, **GIVEN)
    for name in ("center_of_mass", "inertia"):
        np.testing.assert_allclose(getattr(own, name), getattr(plain, name), rtol=1e-6, atol=1e-6)
    assert own.n_nodes == plain.n_nodes
    assert cKDTree(plain.nodes).query(own.nodes)[0].max() < 1e-3
    area = [np.bincount(v.zone_of_node, v.area, len(v.zones)) for v in (plain, own)]
    np.testing.assert_allclose(area[1], area[0], rtol=1e-3)


@pytest.mark.parametrize(("unit", "size"), [("m", 1.0), ("cm", 1e-2), ("in", 0.0254), ("ft", 0.3048)])
def test_units_of_the_mesh_do_not_matter(
    skin: tuple[Floats, Ints], tmp_path: Path, unit: str, size: float
) -> None:
    path = written(tmp_path / "car.ply", skin[0] / size, skin[1])
    own = Vehicle.from_mesh(path, unit=unit, **GIVEN)
    assert own.length == pytest.approx(4.896, abs=1e-3)


def test_mass_properties_are_those_that_are_given(car_stl: Path) -> None:
    inertia = np.array([[700.0, 30.0, -120.0], [30.0, 3000.0, 15.0], [-120.0, 15.0, 3300.0]])
    center = (-1.2, 0.03, 0.57)
    facts = {**GIVEN, "mass": 1650.0}
    own = Vehicle.from_mesh(car_stl, unit="mm", center_of_mass=center, inertia=inertia, **facts)
    np.testing.assert_allclose(own.center_of_mass, center, atol=1e-9)
    np.testing.assert_allclose(own.inertia, inertia, rtol=1e-9, atol=1e-6)
    assert own.mass == 1650.0
    assert own.mass_center_height == pytest.approx(0.57)
    assert own.with_inertia(yaw_inertia=3000.0).yaw_inertia == pytest.approx(3000.0)
    higher = Vehicle.from_mesh(car_stl, unit="mm", mass_center_height=0.6, **facts)
    assert higher.mass_center_height == pytest.approx(0.6)


@given(st.integers(0, 10_000))
def test_every_inertia_of_a_mass_is_that_of_one_solid(seed: int) -> None:
    """Recomputed from the eight corners: a uniform box has m a^2 / 12 along each of its edges."""
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(12, 3)) * rng.uniform(0.1, 3.0, 3)
    points -= points.mean(axis=0)
    inertia = 100.0 * (np.sum(points**2) * np.eye(3) - points.T @ points)
    solid = solid_of(1200.0, np.array([-1.0, 0.1, 0.6]), inertia)
    corners = np.array(solid.corners)
    center = corners.mean(axis=0)
    edges = np.stack([corners[1] - corners[0], corners[3] - corners[0], corners[4] - corners[0]])
    second = 1200.0 / 12.0 * edges.T @ edges
    np.testing.assert_allclose(center, [-1.0, 0.1, 0.6], atol=1e-9)
    np.testing.assert_allclose(np.trace(second) * np.eye(3) - second, inertia, rtol=1e-8, atol=1e-6)


def test_crash_settles_as_the_skin_gets_finer(car_stl: Path) -> None:
    """Skins made anew at three distances of nodes, and one with each triangle cut into four."""
    own = [Vehicle.from_mesh(car_stl, unit="mm", element_size=size, **GIVEN) for size in (0.2, 0.13, 0.05)]
    assert own[0].n_nodes < own[1].n_nodes < own[2].n_nodes
    exact = crash(Vehicle.preset("passenger_car", gvw=MASS, mesh_density=4.0))
    runs = [crash(vehicle) for vehicle in own]
    force, crush = (
        [abs(run[name] / exact[name] - 1.0) for run in runs]
        for name in ("peak_normal_force_cfc60", "dynamic_crush")
    )
    assert max(force) < 0.15
    assert force[2] < 0.03
    assert max(crush) < 0.03
    finer = own[1].with_mesh_density(4.0)
    assert finer.n_elements == 4 * own[1].n_elements
    assert finer.area[finer.is_skin].sum() == pytest.approx(own[1].area[own[1].is_skin].sum(), rel=1e-9)
    coarser = own[2].with_mesh_density(0.3)
    assert 0.2 < coarser.n_elements / own[2].n_elements < 0.4


def test_nodes_of_a_made_skin_are_even(from_deck: Vehicle) -> None:
    nodes, faces = from_deck.nodes, from_deck.quads[:, :3]
    edges = np.linalg.norm(nodes[faces] - nodes[np.roll(faces, 1, axis=1)], axis=2)
    low, middle, high = np.quantile(edges, [0.05, 0.5, 0.95])
    assert 0.7 * middle < low < high < 1.4 * middle


# ---- zones and cores ---------------------------------------------------------------------------------------


def test_zones_and_boxes_of_the_core_are_those_that_are_given(car_stl: Path) -> None:
    pole = {
        "panels": ["side"], "x_m": [-2.0, -1.5], "core": ["chassis"], "k_initial_Pa_per_m": 1e6,
        "knee_m": 0.1,
        "k_hardening_Pa_per_m": 1e5, "f_max_Pa": 2e5, "k_unloading_Pa_per_m": 2e7,
    }  # fmt: skip
    core = {"chassis": {"half_width_m": 0.2}}
    zones = {"b_pillar": pole, "hood": {"x_m": [-0.3, 1.0]}}
    own = Vehicle.from_mesh(car_stl, unit="mm", zones=zones, core=core, **GIVEN)
    assert next(iter(own.zones)) == "b_pillar"
    assert own.zones["b_pillar"].k_initial == 1e6
    x = (own.nodes + own.center_of_mass)[own.zone_of_node == 0][:, 0]
    assert -2.1 < x.min() < x.max() < -1.4
    assert next(box for box in own._file.core if box.name == "chassis").half_width_m == 0.2
    with pytest.raises(ValueError, match=r"zones\['hood'\]\.x_m: must increase"):
        Vehicle.from_mesh(car_stl, unit="mm", zones={"hood": {"x_m": [1.0, -1.0]}}, **GIVEN)
    with pytest.raises(ValueError, match=r"core\['chassis'\].*half_width"):
        Vehicle.from_mesh(car_stl, unit="mm", core={"chassis": {"half_width_m": -1.0}}, **GIVEN)


# ---- readers -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("ending", ["stl", "obj", "ply", "off", "glb", "vtk", "vtu"])
def test_formats_say_the_same(skin: tuple[Floats, Ints], tmp_path: Path, ending: str) -> None:
    path = tmp_path / f"car.{ending}"
    if ending in ("vtk", "vtu"):
        meshio.write_points_cells(path, skin[0], [("triangle", skin[1])])
    else:
        written(path, *skin)
    mesh = read_mesh(path)
    assert len(mesh.triangles) == len(skin[1])
    corners = np.sort(mesh.points[mesh.triangles].reshape(-1, 9), axis=0)
    np.testing.assert_allclose(corners, np.sort(skin[0][skin[1]].reshape(-1, 9), axis=0), atol=1e-5)


DECK = """*KEYWORD
$ two parts, a comment in every block
*PART
$# title
hood outer
         1         1         1
tire front
         2         1         1
*NODE
$    nid               x               y               z
       1             0.0             0.0             0.0
       2          1000.0             0.0             0.0       0       0
$ between nodes
       3          1.0e+3          1000.0             0.0
       4                          1000.0          2.5+2
*ELEMENT_SHELL
       1       1       1       2       3       4
       2       1       1       2       3       3
       3       2       1       2       3
*INCLUDE
more.k
*END
nothing behind the end is read
"""
MORE = f"""*NODE
     105,1.0,2.0,3.0
     106,1.0,2.0,4.0
*ELEMENT_SHELL_THICKNESS_OFFSET
      11       2       1       2       4     105
             1.0             1.0             1.0             1.0
             0.5
      12       2       1       2       3     106
             1.0             1.0             1.0             1.0
             0.5
*ELEMENT_SOLID
      20       3
       1       2       3       4       4       4       4       4
*ELEMENT_SHELL+
{31:20d}{1:20d}{1:20d}{2:20d}{3:20d}{4:20d}
"""


def test_keyword_file_as_the_manual_has_it(tmp_path: Path) -> None:
    (tmp_path / "main.k").write_text(DECK)
    (tmp_path / "more.k").write_text(MORE)
    mesh = read_mesh(tmp_path / "main.k")
    np.testing.assert_array_equal(mesh.points[3], [0.0, 1000.0, 250.0])
    assert mesh.titles == {1: "hood outer", 2: "tire front"}
    shells = {1: 2 + 1 + 2, 2: 1 + 2 + 2}
    assert {n: int((mesh.part == n).sum()) for n in (1, 2)} == shells
    assert (mesh.part == 3).sum() >= 4  # faces of the tetrahedron
    np.testing.assert_array_equal(mesh.points[-1], [1.0, 2.0, 4.0])
    assert mesh.is_deck


def test_parts_are_taken_and_left_out(deck: Path) -> None:
    mesh = read_mesh(deck)
    assert mesh.numbers_of("parts", ["tire"]) == {6, 7, 8, 9}
    assert mesh.numbers_of("parts", [3, "seat"]) == {3, 4}
    with pytest.raises(FileFormatError, match=r"without_parts must name parts.*'hood outer'.*got 'wing'"):
        Vehicle.from_mesh(deck, mass=MASS, kind="car", unit="mm", without_parts=["wing"])


@given(data=st.data())
def test_damaged_files_are_refused_by_name(
    data: st.DataObject, tmp_path_factory: pytest.TempPathFactory
) -> None:
    """Bytes changed, left out and put in: what can not be read is a FileFormatError that names the file."""
    folder = tmp_path_factory.getbasetemp() / "damaged"
    folder.mkdir(exist_ok=True)
    ending = data.draw(st.sampled_from(["k", "stl", "obj", "ply", "off", "glb", "vtk"]))
    content = bytearray(_small_file(ending))
    for _ in range(data.draw(st.integers(1, 6))):
        at = data.draw(st.integers(0, len(content) - 1))
        change = data.draw(st.sampled_from(["byte", "cut", "more"]))
        if change == "byte":
            content[at] = data.draw(st.integers(0, 255))
        elif change == "cut" and len(content) > 80:
            del content[at : at + data.draw(st.integers(1, 60))]
        else:
            content[at:at] = data.draw(st.binary(max_size=12))
    path = folder / f"mesh.{ending}"
    path.write_bytes(bytes(content))
    error = None
    try:
        mesh = read_mesh(path)
    except FileFormatError as refused:
        error = str(refused)
    if error is not None:
        assert path.name in error
    else:
        assert np.isfinite(mesh.points[mesh.triangles]).all()


_FILES: dict[str, bytes] = {}


def _small_file(ending: str) -> bytes:
    if ending == "k":
        return DECK.replace("*INCLUDE\nmore.k\n", "").encode()
    if not _FILES:
        nodes, quads = box((0.0, 0.0, 0.0), (4.0, 2.0, 1.5))
        triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
        body = trimesh.Trimesh(nodes, triangles, process=False)
        for kind in ("stl", "obj", "ply", "off", "glb"):
            content = body.export(file_type=kind)
            _FILES[kind] = content.encode() if isinstance(content, str) else content
        lines = ["# vtk DataFile Version 3.0", "box", "ASCII", "DATASET POLYDATA", "POINTS 8 double"]
        lines += [" ".join(map(str, node)) for node in nodes.tolist()]
        lines += [f"POLYGONS 12 {4 * 12}", *(f"3 {a} {b} {c}" for a, b, c in triangles.tolist())]
        _FILES["vtk"] = "\n".join(lines).encode()
    return _FILES[ending]


# ---- what is refused ---------------------------------------------------------------------------------------


def _holed(points: Floats, triangles: Ints) -> tuple[Floats, Ints]:
    return points, np.delete(triangles, [0, 2000, 5000], axis=0)


def _sheet(points: Floats, triangles: Ints) -> tuple[Floats, Ints]:
    back = triangles[:, ::-1] + len(points)
    return np.concatenate([points, points + 1e-3]), np.concatenate([triangles[:400], back[:400]])


def _crowded(points: Floats, triangles: Ints) -> tuple[Floats, Ints]:
    a, b, _ = triangles[0]
    extra = np.append(points, [points.mean(axis=0)], axis=0)
    return extra, np.append(triangles, [[a, b, len(points)]], axis=0)


def _nan(points: Floats, triangles: Ints) -> tuple[Floats, Ints]:
    bad = points.copy()
    bad[triangles[0, 0]] = np.nan
    return bad, triangles


def _flat(points: Floats, triangles: Ints) -> tuple[Floats, Ints]:
    return points * (1.0, 1.0, 1e-4), triangles


@pytest.mark.parametrize(
    ("damage", "options", "message"),
    [
        (_holed, {}, r"skin must be closed, got holes: \d+ edges .*holes='close'"),
        (_crowded, {}, r"two triangles at every edge, got 1 edges with three"),
        (_nan, {}, r"coordinates must be finite, got .*nan"),
        (_flat, {}, r"height must be above 0.1 m"),
        (None, {"unit": None}, r"unit must be given.*4\.9 m with unit='m'"),
        (None, {"unit": "mm"}, r"unit must make a vehicle of about .*got 0\.004896 m in 'mm'.*unit='m'"),
        (None, {"unit": "in"}, r"got 0\.1244 m in 'in'; .*unit='m'"),
        (None, {"unit": "parsec"}, r"unit must be one of m, mm, cm, in, ft, got 'parsec'"),
        (None, {"forward": "+y"}, r"forward must be the axis along the vehicle.*forward='\+x' or '-x'"),
        (None, {"forward": "ahead"}, r"forward must be one of \+x"),
        (None, {"up": "+x"}, r"up must be another axis than forward"),
        (None, {"forward": "+y", "up": "+x"}, r"up must be the axis across the ground"),
        (None, {"clearance": 0.0}, r"clearance must say how high"),
        (None, {"clearance": -1.0}, r"clearance must be 0 to 2 m, got -1"),
        (None, {"holes": "ignore"}, r"holes must be one of refuse, close, wrap; got 'ignore'"),
        (None, {"kind": "car"}, r"kind or like must be given, and not both, got both"),
        (None, {"like": None}, r"kind or like must be given, and not both, got neither"),
        (None, {"like": None, "kind": "tank"}, r"kind must be one of car"),
        (None, {"like": "semi_truck"}, r"like must be a vehicle of one unit"),
        (None, {"mass": -3.0}, r"mass must be"),
        (None, {"element_size": 3.0}, r"element_size must be 0.01 to 1 m, got 3"),
        (None, {"front_overhang": 4.0}, r"front_overhang must be > 0 and below .*got 4"),
        (None, {"wheelbase": 6.0}, r"wheelbase must be shorter"),
        (None, {"inertia": (100.0, 1.0, 1.0)}, r"inertia must be that of a mass"),
        (None, {"inertia": (np.nan, 1.0, 1.0)}, r"inertia must be finite"),
        (None, {"center_of_mass": (9.0, 0.0, 0.5)}, r"center_of_mass must be inside the vehicle"),
        (None, {"center_of_mass": (0.0, 0.5)}, r"center_of_mass shape must be \(3\)"),
        (None, {"mesh_density": 1e9}, r"mesh_density must be"),
        (None, {"core": {"big": {"x_m": [-3.0, 0.0], "half_width_m": 5.0, "z_m": [0.3, 0.6]}}}, r"core"),
    ],
)
def test_what_can_not_be_meant_is_refused(
    skin: tuple[Floats, Ints],
    tmp_path: Path,
    damage: Callable[[Floats, Ints], tuple[Floats, Ints]] | None,
    options: dict[str, Any],
    message: str,
) -> None:
    path = written(tmp_path / "car.ply", *(skin if damage is None else damage(*skin)))
    with pytest.raises(ValueError, match=message) as refused:
        Vehicle.from_mesh(path, **{**GIVEN, "unit": "m", **options})
    if isinstance(refused.value, FileFormatError):
        assert "car.ply" in str(refused.value)


def test_mesh_in_inches_is_noticed(skin: tuple[Floats, Ints], tmp_path: Path) -> None:
    path = written(tmp_path / "car.ply", skin[0] / 0.0254, skin[1])
    with pytest.raises(FileFormatError, match=r"got 192\.8 m in 'm'.*4\.9 m with unit='in'"):
        Vehicle.from_mesh(path, **{**GIVEN, "unit": "m"})
    with pytest.raises(FileFormatError, match=r"got 1\.928 m in 'cm'.*unit='in'"):
        Vehicle.from_mesh(path, **{**GIVEN, "unit": "cm"})


def test_holes_are_closed_where_asked(skin: tuple[Floats, Ints], tmp_path: Path) -> None:
    path = written(tmp_path / "car.ply", *_holed(*skin))
    own = Vehicle.from_mesh(path, unit="m", holes="close", **GIVEN)
    whole = Vehicle.preset("passenger_car")
    assert own.area[own.is_skin].sum() == pytest.approx(whole.area[whole.is_skin].sum(), rel=0.01)
    half = written(tmp_path / "half.ply", skin[0], skin[1][skin[0][skin[1]].mean(axis=1)[:, 2] < 0.8])
    with pytest.raises(FileFormatError, match=r"holes must be below 25%"):
        Vehicle.from_mesh(half, **{**GIVEN, "unit": "m", "holes": "close"})


@pytest.mark.parametrize("flip", [slice(None), slice(0, 4000), slice(5, 6)])
def test_normals_are_mended(skin: tuple[Floats, Ints], tmp_path: Path, flip: slice) -> None:
    triangles = skin[1].copy()
    triangles[flip] = triangles[flip][:, ::-1]
    own = Vehicle.from_mesh(written(tmp_path / "car.ply", skin[0], triangles), unit="m", **GIVEN)
    mesh = own._file.exterior.mesh
    assert trimesh.Trimesh(mesh.points, mesh.faces, process=False).volume == pytest.approx(
        trimesh.Trimesh(*skin, process=False).volume, rel=1e-4
    )


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("car.step", b"", r"car\.step: name must end in one of \.k"),
        ("none.stl", None, r"none\.stl: must be a file"),
        ("car.k", b"solid", r"got no line that begins with \*"),
        ("car.k", b"*KEYWORD\n*END\n", r"must have nodes"),
        ("car.k", b"*NODE\n       1       x\n", r"car\.k:1: \*NODE: must hold numbers"),
        (
            "car.k",
            DECK.replace("more.k", "lost.k").encode(),
            r"\*INCLUDE must name a file beside it, got 'lost.k'",
        ),
        ("car.k", b"*INCLUDE_TRANSFORM\nx.k\n", r"must be without \*INCLUDE_TRANSFORM"),
        ("car.k", b"*NODE\n&n,1.,1.,1.\n", r"got the parameter in '&n"),
        ("car.k", b"*NODE\n1,0.,0.,0.\n*ELEMENT_SHELL\n1,1,1,7,8,9\n", r"nodes of the model, got node 7"),
        ("car.stl", struct.pack("<80xI", 4_000_000_000), r"car\.stl"),
    ],
)
def test_files_that_are_none_are_refused(
    tmp_path: Path, name: str, content: bytes | None, message: str
) -> None:
    if content is not None:
        (tmp_path / name).write_bytes(content)
    with pytest.raises(FileFormatError, match=message):
        read_mesh(tmp_path / name)


# ---- command line and figure -------------------------------------------------------------------------------


def test_command_line_makes_file_and_figure(
    deck: Path, tmp_path: Path, command: Callable[..., int], capsys: pytest.CaptureFixture[str]
) -> None:
    out, figure = tmp_path / "own.toml", tmp_path / "own.png"
    options = ["--mass", "1719 kg", "--kind", "car", "--unit", "mm", "--element-size", "15 cm"]
    leave = ["--without-part", "mirror", "--without-part", "4"]
    assert command("from-mesh", deck, *options, *leave, "--plot", figure, "-o", out) == 0
    assert "assumed: wheelbase 2.8" in capsys.readouterr().out
    assert Vehicle.from_file(out).mass == 1719.0
    assert figure.stat().st_size > 20_000
    assert command("from-mesh", deck, "--mass", "1.7 t", "-o", out) == 2
    assert "kind or like must be given" in capsys.readouterr().err


def test_figure_shows_zones_core_wheels_and_front(from_deck: Vehicle) -> None:
    figure = from_deck.plot()
    texts = [text.get_text() for axes in figure.axes for text in axes.texts]
    assert texts.count("FRONT") == 2
    assert texts.count("mass centre") == 4
    side = figure.axes[0]
    faces = side.collections[0].get_paths()
    corners = from_deck.nodes[from_deck.quads[:, :3]]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert len(faces) == (normal[:, 1] > 0.0).sum()
    circles = [patch for patch in side.patches if hasattr(patch, "radius")]
    assert len(circles) == 4
    low = side.get_xlim()[0]
    assert low < -from_deck._file.extent.front - 0.5  # room for the arrow
    assert "4.90 x 1.84 x 1.4" in figure.get_suptitle()


def test_crush_of_a_mesh_is_drawn(from_deck: Vehicle) -> None:
    """Triangles without area would keep the contours of a crush map from ending."""
    run = Simulation(from_deck, Barrier.bollards(), 10.0).run()
    triangles = crush_map(run, "front").triangles
    assert (np.diff(np.sort(triangles, axis=1), axis=1) > 0).all()
    assert len(run.plot_crush().axes) >= 2


def test_missing_library_is_named(car_stl: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "trimesh", None)
    with pytest.raises(ImportError, match=r"from_mesh\(\) needs trimesh here: pip install 'birm3d\[mesh\]'"):
        Vehicle.from_mesh(car_stl, unit="mm", **GIVEN)


def test_box_of_shells_becomes_a_truck(tmp_path: Path) -> None:
    """A cab and a cargo box with a gap between them, from primitives; wheels are those of the class."""
    parts = [
        ("cab", *box((-1.5, -1.1, 0.5), (1.0, 1.1, 2.6))),
        ("cargo", *box((-7.0, -1.25, 1.0), (-1.7, 1.25, 3.3))),
    ]
    parts += [
        ("frame", *box((-6.8, -0.45, 0.6), (0.5, 0.45, 1.05))),
        ("ground mark", *box((-3.0, -0.1, 0.0), (-2.9, 0.1, 0.7))),
    ]
    write_deck(tmp_path / "truck.key", parts, unit=1.0)
    own = Vehicle.from_mesh(tmp_path / "truck.key", mass="12 t", kind="truck", unit="m", element_size=0.15)
    assert own.length == pytest.approx(8.0, abs=0.03)
    assert own.height == pytest.approx(3.3, abs=0.03)
    run = Simulation(own, Barrier.bollards(), 40 * units.mph).run()
    assert run.metrics["energy_residual"] < 1e-3


def test_all_axes_are_right_handed() -> None:
    from birm3d.vehicle.mesh_import.placing import rotation

    for a, b in permutations("xyz", 2):
        for s, t in ("++", "+-", "-+", "--"):
            assert np.linalg.det(rotation(s + a, t + b)) == pytest.approx(1.0)
