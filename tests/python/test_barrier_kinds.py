"""Every kind of barrier wherever one goes: equality, pickles, files, fingerprints, sweeps, surfaces."""

from __future__ import annotations

import dataclasses
import importlib
import inspect
import json
import math
import pickle
import re
from pathlib import Path
from typing import Any

import birm3d
import numpy as np
import pytest
from birm3d import Barrier, FreeStanding, Simulation, Vehicle
from birm3d.barrier.kinds import KINDS as ALL_KINDS
from birm3d.barrier.surfaces import barrier_surfaces
from birm3d.base.fingerprint import fingerprint
from birm3d.scene.codec import decode, encode
from birm3d.scene_parameters import parameter_names, unit_of, value_of, varied
from birm3d.simulation.scene_file import read_scene_file

WEDGE = np.array([[0, -1, 0], [1, -1, 0], [1, -1, 1], [0, 1, 0], [1, 1, 0], [1, 1, 1]], float)
SIDES = np.array([[0, 1, 2], [3, 5, 4], [0, 4, 1], [0, 3, 4], [1, 5, 2], [1, 4, 5], [0, 2, 5], [0, 5, 3]])

# Each with what differs from it by one number.
KINDS: dict[str, tuple[Barrier, Barrier]] = {
    "endless wall": (Barrier.rigid_wall(), Barrier.rigid_wall(friction=0.1)),
    "wall": (
        Barrier.rigid_wall(width=4.0, height=1.1, thickness=0.3, segments=2, heading=30.0),
        Barrier.rigid_wall(width=4.0, height=1.1, thickness=0.3, segments=4, heading=30.0),
    ),
    "pole": (Barrier.pole(diameter=0.25), Barrier.pole(diameter=0.26)),
    "bollards": (
        Barrier.bollards(count=3, rows=2, row_offset=0.6, heading=-20.0),
        Barrier.bollards(count=3, rows=2, row_offset=0.5, heading=-20.0),
    ),
    "jersey": (
        Barrier.jersey(length=6.0, segments=2, origin=(1.0, 2.0, 0.0)),
        Barrier.jersey(profile="f_shape", length=6.0, segments=2, origin=(1.0, 2.0, 0.0)),
    ),
    "free-standing": (
        Barrier.jersey(length=6.0, segments=2, free_standing=FreeStanding(ground_friction=0.4)),
        Barrier.jersey(length=6.0, segments=2, free_standing=FreeStanding(ground_friction=0.45)),
    ),
    "profile": (
        Barrier.jersey(profile=((0.3, 0.0), (0.1, 0.6)), length=5.0),
        Barrier.jersey(profile=((0.3, 0.0), (0.1, 0.7)), length=5.0),
    ),
    "rounded wall": (
        Barrier.rigid_wall(width=3.0, height=1.1, edge_radius=0.15),
        Barrier.rigid_wall(width=3.0, height=1.1, edge_radius=0.14),
    ),
    "planter": (
        Barrier.planter(length=1.5, width=0.8, height=0.9, heading=15.0),
        Barrier.planter(length=1.5, width=0.9, height=0.9, heading=15.0),
    ),
    "planters": (
        Barrier.planter(length=1.5, count=3, spacing=2.7),
        Barrier.planter(length=1.5, count=3, spacing=2.8),
    ),
    "mesh": (
        Barrier.from_mesh(WEDGE, SIDES, heading=10.0),
        Barrier.from_mesh(1.1 * WEDGE, SIDES, heading=10.0),
    ),
}
EVERY = pytest.mark.parametrize("kind", KINDS)


# Posts can pass between its four nodes, which is what one test asks for.
pytestmark = pytest.mark.filterwarnings("ignore::birm3d.CoarseSkinWarning")


def lab() -> Vehicle:
    """A slow block with a front of four nodes."""
    across = [[1.0, y, z] for y in (-0.6, 0.6) for z in (-0.2, 0.2)]
    return Vehicle.from_arrays(
        mass=1000.0,
        inertia=np.diag([300.0, 1200.0, 1300.0]),
        nodes=across,
        anchors=[[0.0, y, z] for _, y, z in across],
        k_initial=2e5,
        k_unloading=2e6,
        mass_center_height=0.5,
    )


@EVERY
def test_equal_ones_are_equal_and_others_are_not(kind: str) -> None:
    barrier, other = KINDS[kind]
    again = dataclasses.replace(barrier)
    assert barrier == again != other
    assert hash(barrier) == hash(again)
    assert fingerprint(barrier) == fingerprint(again) != fingerprint(other)
    for another, (different, _) in KINDS.items():
        assert (barrier == different) == (kind == another)
        assert (fingerprint(barrier) == fingerprint(different)) == (kind == another)


@EVERY
def test_pickles_and_files_keep_them(kind: str) -> None:
    barrier, _ = KINDS[kind]
    assert pickle.loads(pickle.dumps(barrier)) == barrier
    arrays: dict[str, np.ndarray] = {}
    plain = json.loads(json.dumps(encode(barrier, arrays, "barrier"), allow_nan=False))
    back = decode(plain, arrays)
    assert type(back) is type(barrier)
    assert back == barrier


@EVERY
@pytest.mark.filterwarnings("ignore::birm3d.TippingWarning")
def test_results_of_all_kinds_are_kept(kind: str, tmp_path: Path) -> None:
    result = Simulation(lab(), KINDS[kind][0], 6.0, 80.0, duration=0.15).run()
    result.save(tmp_path / "r")
    loaded = birm3d.load(tmp_path / "r")
    assert loaded.scene == result.scene
    assert Simulation.from_scene(loaded.scene).run().state_hash == result.state_hash
    assert (
        pickle.loads(pickle.dumps(Simulation.from_scene(result.scene))).run().state_hash == result.state_hash
    )


@EVERY
def test_names_are_as_many_as_elements(kind: str) -> None:
    barrier, _ = KINDS[kind]
    whole = [element for element in barrier.elements() if element.part_of is None]
    assert len(set(barrier.element_names)) == len(whole)


@EVERY
def test_surfaces_are_closed_and_stand_where_the_model_has_them(kind: str) -> None:
    """Every edge has its opposite, the volume is positive, and the surfaces are as many as the elements."""
    barrier, _ = KINDS[kind]
    around = np.array([[-3.0, -4.0, 0.0], [0.0, 4.0, 1.5]])
    surfaces = barrier_surfaces(barrier, around)
    assert len(surfaces) == len(barrier.element_names)
    for vertices, faces in surfaces:
        edges = np.vstack([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
        there = {tuple(edge) for edge in edges.tolist()}
        assert len(there) == len(edges)
        assert all((b, a) in there for a, b in there)
        a, b, c = (vertices[faces[:, i]] - vertices[0] for i in range(3))
        assert np.einsum("ij,ij->", a, np.cross(b, c)) > 0.0
        assert np.isfinite(vertices).all()


def test_a_drawn_segment_is_the_one_that_is_met() -> None:
    """A single node run into a Jersey barrier touches where the drawn surface is, face and place."""
    barrier = Barrier.jersey(length=4.0, segments=2, heading=35.0, origin=(2.0, 1.0, 0.0))
    (low, faces), (high, _) = barrier_surfaces(barrier, [[0.0, 0.0, 1.0]])
    axes = np.array([[math.cos(a), math.sin(a)] for a in (math.radians(35.0), math.radians(125.0))])
    across, along = ((low[:, :2] - [2.0, 1.0]) @ axes.T).T
    assert (across.min(), across.max()) == (pytest.approx(0.0, abs=1e-12), pytest.approx(0.6096))
    assert (along.min(), along.max()) == (pytest.approx(-2.0), pytest.approx(0.0, abs=1e-12))
    assert ((high[:, :2] - [2.0, 1.0]) @ axes[1]).max() == pytest.approx(2.0)
    assert low[:, 2].max() == pytest.approx(0.8128)
    height = 0.5
    vehicle = Vehicle.from_arrays(
        mass=1000.0, inertia=1000.0 * np.eye(3), nodes=[[1.0, 0.0, 0.0]], anchors=[[0.0, 0.0, 0.0]],
        k_initial=1e5, k_unloading=1e5, mass_center_height=height,
    )  # fmt: skip
    settings = birm3d.Settings(gravity=0.0, ground=False)
    start = Simulation(vehicle, barrier, 1.0, 90.0, -1.0, settings=settings).result()
    node = start.position[0] + np.array([*axes[0], 0.0])
    corners = low[faces]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    gap = np.einsum("ij,ij->i", node - corners[:, 0], normal)
    foot = node - gap[:, None] * normal
    edges = np.roll(corners, -1, axis=1) - corners
    turns = np.einsum("ijk,ik->ij", np.cross(edges, foot[:, None, :] - corners), normal)
    beside = (turns >= -1e-9).all(axis=1)  # the node lies off the triangle itself, not off its edges
    assert np.abs(gap[beside]).min() == pytest.approx(0.0, abs=1e-6)


# ---- a planter, and where a kind is known ------------------------------------------------------------------


@pytest.mark.filterwarnings("ignore::birm3d.CoreContactWarning")  # sharp edges pass between nodes
@pytest.mark.parametrize(
    ("height", "angle"), [(1.0, 90.0), (0.6, 70.0)], ids=["face and edges", "face, edges and top"]
)
def test_a_planter_is_the_box_of_its_sizes(height: float, angle: float) -> None:
    """The same as a wall of those sizes to the last bit, and as twelve triangles but for the last digits."""
    car = Vehicle.preset("passenger_car", mesh_density=0.3)
    place: dict[str, Any] = {"origin": (1.0, 2.0, 0.0), "heading": 20.0}
    sharp = place | {"edge_radius": 0.0}
    below, length, width = -1.0, 1.5, 1.2
    box = np.array(
        [[x, y, z] for x in (0.0, width) for y in (-length / 2, length / 2) for z in (below, height)]
    )
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    triangles = np.array([[quad[i] for i in corners] for quad in quads for corners in ((0, 1, 2), (0, 2, 3))])
    planter, wall, mesh = (
        Simulation(car, barrier, 12.0, angle, 0.4, duration=0.15).run()
        for barrier in (
            Barrier.planter(length=length, width=width, height=height, **sharp),
            Barrier.rigid_wall(width=length, thickness=width, height=height, **sharp),
            Barrier.from_mesh(box, triangles, **place),
        )
    )
    assert planter.state_hash == wall.state_hash
    assert planter.velocity == pytest.approx(mesh.velocity, abs=1e-8)
    assert np.linalg.norm(planter.velocity[-1] - planter.velocity[0]) > 5.0


@pytest.mark.parametrize("edge_radius", [None, 0.0, 0.5])
def test_each_planter_of_a_row_is_met_as_if_it_stood_alone(edge_radius: float | None) -> None:
    """Those beside it are out of reach, until the path leads between them."""
    car, block = (
        Vehicle.preset("passenger_car", mesh_density=0.2),
        {"length": 1.5, "edge_radius": edge_radius},
    )
    row, alone = Barrier.planter(**block, count=3, spacing=4.0), Barrier.planter(**block)
    for i, along in enumerate((-4.0, 0.0, 4.0)):
        one, other = (
            Simulation(car, barrier, 12.0, 90.0, offset, duration=0.15).run()
            for barrier, offset in ((row, along + 0.3), (alone, 0.3))
        )
        assert one.velocity == pytest.approx(other.velocity, abs=1e-9)
        touched = [load.name for load in one.element_loads if load.touched]
        assert touched == [f"planter {i + 1}"]
    van = Vehicle.preset("van_3500", mesh_density=0.2)
    over_two, at_one = (
        Simulation(van, b, 1.0, impact_yaw=90.0, impact_offset=0.3).run() for b in (row, alone)
    )
    # The loads of each are followed on their own, with those of its edges. Mixed up: 100 times as many steps
    assert over_two.metrics["steps"] < 3 * at_one.metrics["steps"]
    wide = Barrier.planter(**block, count=2, spacing=4.5)
    through = Simulation(car, wide, 12.0).run()
    assert through.outcome_detail == "it passed between two elements of the barrier, untouched"


def test_a_planter_is_met_where_it_stands() -> None:
    """Turned and moved with the path it does the same; a length further along its line it is missed."""
    here = Simulation(lab(), Barrier.planter(length=1.5), 6.0, duration=0.2).run()
    place: dict[str, Any] = {"origin": (5.0, -3.0, 0.0), "heading": 40.0}
    barrier = Barrier.planter(length=1.5, **place)
    there = Simulation(lab(), barrier, 6.0, impact_offset=barrier.station(), duration=0.2).run()
    turned = math.radians(40.0)
    lost = here.velocity[-1] - here.velocity[0]
    expected = [lost[0] * math.cos(turned), lost[0] * math.sin(turned), lost[2]]
    assert there.velocity[-1] - there.velocity[0] == pytest.approx(expected, rel=1e-6, abs=1e-6)
    missed = Simulation(lab(), Barrier.planter(length=1.5, origin=(0.0, 1.5, 0.0)), 6.0, duration=0.2).run()
    assert not missed.element_loads[0].touched
    assert here.element_loads[0].touched


def test_a_kind_is_known_in_three_files() -> None:
    """The class, the function of ``Barrier`` that makes it, and its row in the list of all kinds."""
    package = Path(birm3d.__file__).parent
    code = re.compile(r"""\bPlanter\b|\bplanter\(|["']planter["']|import.*\bplanter\b""")
    # Folders that must work with any kind; those above them may make barriers of their own.
    folders = (
        "base",
        "io",
        "barrier",
        "scene",
        "result",
        "simulation",
        "plotting",
        "rendering",
        "html_page",
        "cli",
    )
    paths = [path for folder in folders for path in (package / folder).rglob("*.py")]
    known = [path for path in paths if code.search(path.read_text(encoding="utf-8"))]
    there = sorted(str(path.relative_to(package)) for path in known)
    assert there == ["barrier/barrier.py", "barrier/kinds.py", "barrier/planter.py"]


@pytest.mark.parametrize(
    "place",
    [
        "jersey.Jersey",
        "mesh.MeshBarrier",
        "planter.Planter",
        "posts.Bollards",
        "posts.Pole",
        "rigid_wall.RigidWall",
    ],
)
def test_kinds_are_found_where_they_were(place: str) -> None:
    module, name = place.split(".")
    found = getattr(importlib.import_module(f"birm3d.barrier.{module}"), name)
    assert found is getattr(birm3d.barrier.kinds, name)
    with pytest.warns(DeprecationWarning, match=r"write birm3d\.barrier\.barrier"):
        assert importlib.import_module("birm3d.barrier.base").Barrier is Barrier


def test_every_size_is_an_argument_and_every_kind_can_be_made() -> None:
    for kind, made in ALL_KINDS.items():
        arguments = inspect.signature(getattr(Barrier, kind)).parameters
        placed = {"friction", "origin", "heading"}
        assert {size.name for size in made.sizes} == set(arguments) - placed
        assert isinstance(getattr(Barrier, kind)(), made)
        assert issubclass(made, Barrier)
        # The site's table of kinds is made of these.
        assert isinstance(vars(Barrier)[kind], staticmethod)


# ---- names of numbers --------------------------------------------------------------------------------------


def test_sizes_can_be_swept() -> None:
    simulation = Simulation(lab(), Barrier.bollards(count=2, spacing=1.2), 6.0, duration=0.1)
    names = parameter_names(simulation)
    for name in ("count", "diameter", "height", "spacing", "rows", "row_spacing", "row_offset", "friction"):
        assert f"barrier.{name}" in names
    assert unit_of("barrier.spacing") == unit_of("barrier.row_offset") == "m"
    study = birm3d.sweep(
        simulation, parameters={"barrier.spacing": [1.2, 2.4]}, metrics=["peak_element_force"], progress=False
    )
    hit, passed = study.to_dataframe()["peak_element_force"]
    assert hit > 0.0 == passed  # posts at +-0.6 m meet the nodes, at +-1.2 m they do not


def test_counts_of_a_sweep_are_whole_numbers() -> None:
    simulation = Simulation(lab(), Barrier.bollards(count=2), 6.0)
    changed = varied(simulation, {"barrier.count": 3.0})
    assert value_of(changed, "barrier.count") == 3
    assert changed.scene.barrier == Barrier.bollards(count=3)
    with pytest.raises(ValueError, match=r"count must be a whole number >= 1, got 2\.5"):
        varied(simulation, {"barrier.count": 2.5})
    with pytest.raises(ValueError, match=r"near: .*barrier\.spacing"):
        varied(simulation, {"barrier.spacin": 2.0})
    jersey = Simulation(lab(), Barrier.jersey(length=6.0), 6.0)
    assert value_of(varied(jersey, {"barrier.profile": "f_shape"}), "barrier.profile") == "f_shape"


# ---- scene files -------------------------------------------------------------------------------------------

SCENE = """
[vehicle]
preset = "passenger_car"
mesh_density = 0.1
[barrier]
{barrier}
[impact]
speed = "30 km/h"
angle = "60 deg"
"""


@pytest.mark.parametrize(
    ("text", "barrier"),
    [
        (
            "kind = 'bollards'\ncount = 3\ndiameter_m = 0.4\nheight_m = 0.9\nspacing_m = 1.3\nrows = 2\n"
            "row_spacing_m = 1.1\nrow_offset_m = 0.65\nheading_deg = 10.0\nfriction = 0.1",
            Barrier.bollards(
                count=3, diameter=0.4, height=0.9, spacing=1.3, rows=2, row_spacing=1.1, row_offset=0.65,
                heading=10.0, friction=0.1,
            ),
        ),
        ("kind = 'bollards'", Barrier.bollards()),
        ("kind = 'jersey'", Barrier.jersey()),
        (
            "kind = 'jersey'\nlength_m = 6.0\nfree_standing = true\ndensity_kg_m3 = 2300.0",
            Barrier.jersey(length=6.0, free_standing=True, density=2300.0),
        ),
        (
            "kind = 'jersey'\nlength_m = 6.0\nfree_standing = {joint = 'loose', "
            "mass_per_length_kg_m = 600.0}",
            Barrier.jersey(length=6.0, free_standing=FreeStanding(joint="loose", mass_per_length=600.0)),
        ),
        (
            "kind = 'jersey'\nprofile = 'f_shape'\nheight_m = 1.07\nlength_m = 9.0\nsegments = 3",
            Barrier.jersey(profile="f_shape", height=1.07, length=9.0, segments=3),
        ),
        (
            "kind = 'jersey'\nprofile = [[0.3, 0.0], [0.1, 0.6]]",
            Barrier.jersey(profile=((0.3, 0.0), (0.1, 0.6))),
        ),
        (
            "kind = 'rigid_wall'\nwidth_m = 5.0\nheight_m = 1.2\nthickness_m = 0.4\nsegments = 5",
            Barrier.rigid_wall(width=5.0, height=1.2, thickness=0.4, segments=5),
        ),
        ("kind = 'pole'\ndiameter_m = 0.254", Barrier.pole(diameter=0.254)),
        (
            "kind = 'planter'\nlength_m = 1.5\nwidth_m = 0.8\nheight_m = 0.9\norigin_m = [0.0, 0.4, 0.0]",
            Barrier.planter(length=1.5, width=0.8, height=0.9, origin=(0.0, 0.4, 0.0)),
        ),
        (
            "kind = 'rigid_wall'\nwidth_m = 3.0\nedge_radius_m = 0.1",
            Barrier.rigid_wall(width=3.0, edge_radius=0.1),
        ),
    ],
)  # fmt: skip
def test_scene_files(text: str, barrier: Barrier, tmp_path: Path) -> None:
    (tmp_path / "scene.toml").write_text(SCENE.format(barrier=text), encoding="utf-8")
    assert read_scene_file(tmp_path / "scene.toml").scene.barrier == barrier


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ("kind = 'fence'", ["kind", "fence"]),
        ("kind = 'bollards'\nwidth_m = 3.0", ["width_m", "rigid_wall"]),
        ("kind = 'rigid_wall'\nspacing_m = 3.0", ["spacing_m", "bollards"]),
        ("kind = 'bollards'\nspacing_m = 0.1", ["spacing", "above the diameter", "0.1"]),
        ("kind = 'bollards'\ncount = 0", ["count", ">= 1", "0"]),
        ("kind = 'jersey'\nprofile = 'vertical'", ["profile", "new_jersey", "vertical"]),
        ("kind = 'jersey'\nsegments = 2", ["segments", "infinite length", "2"]),
        ("kind = 'pole'\ncolour = 'red'", ["colour"]),
        ("kind = 'planter'\nheight_m = 0.0", ["height", "> 0 m", "0.0"]),
        ("kind = 'planter'\nsegments = 2", ["segments", "rigid_wall or jersey", "planter"]),
    ],
)
def test_scene_files_that_can_not_be(text: str, parts: list[str], tmp_path: Path) -> None:
    (tmp_path / "scene.toml").write_text(SCENE.format(barrier=text), encoding="utf-8")
    with pytest.raises(ValueError, match=r"scene\.toml") as caught:
        read_scene_file(tmp_path / "scene.toml")
    for part in parts:
        assert part in str(caught.value)


def test_a_bare_barrier_names_all_makers() -> None:
    with pytest.raises(TypeError, match=r" or from_mesh$") as found:
        Barrier()
    assert all(kind in str(found.value) for kind in ALL_KINDS)
