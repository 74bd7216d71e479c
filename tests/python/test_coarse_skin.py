"""Barriers that can pass between the nodes of a skin are warned of; what meets the body alone is touched."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from functools import cache

import numpy as np
import pytest
from birm3d import Barrier, CoarseSkinWarning, Settings, Simulation, Vehicle, scenes
from birm3d.study.verification.stability import _judged
from birm3d.study.verification.stability_cases import Case, thin_posts
from birm3d.study.verification.stability_result import FAULT, HELD, WARNED
from birm3d.study.verification.triangulated import triangulated
from birm3d.study.verification.watched import LIMITS
from birm3d.vehicle.node_spacing import node_spacing

WEIGHTLESS = Settings(gravity=0.0, ground=False)
BLOCK = scenes.laboratory_block(100, k_initial=3e6, knee=0.4, k_hardening=6e6, k_unloading=60e6)
APART = 2.4 / 9  # m, of its columns of nodes


@cache
def car(mesh_density: float = 0.1, name: str = "passenger_car") -> Vehicle:
    return Vehicle.preset(name, mesh_density=mesh_density)


def box(x: float, y: float, low: float = -1.0, high: float = 1.0, at: float = 0.0) -> np.ndarray:
    """Corners of a box of x by y [m], its middle `at` along the line."""
    signs = np.array([[i & 1, i >> 1 & 1, i >> 2] for i in range(8)])
    return signs * [x, y, high - low] + [-0.5 * x, at - 0.5 * y, low]


SIDES = np.array(
    [
        *((0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4)),
        *((2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2), (1, 3, 7), (1, 7, 5)),
    ]
)


def mesh(*boxes: np.ndarray, soup: bool = False) -> Barrier:
    faces = np.concatenate([SIDES + 8 * i for i in range(len(boxes))])
    corners = np.concatenate(boxes)
    if soup:  # no two triangles share a vertex
        return Barrier.from_mesh(corners[faces.ravel()], np.arange(faces.size).reshape(-1, 3))
    return Barrier.from_mesh(corners, faces)


def told(vehicle: Vehicle, barrier: Barrier | None, angle: float = 90.0, offset: float = 0.0) -> list[str]:
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        Simulation(vehicle, barrier, 10.0, angle, offset, duration=1.0)
    assert all(issubclass(one.category, CoarseSkinWarning) for one in found)
    assert all(one.filename == __file__ for one in found)  # it points at the caller's line
    return [str(one.message) for one in found]


# ---- the distance between nodes ----------------------------------------------------------------------------


@pytest.mark.parametrize(("beside", "above"), [(0.1, 0.1), (0.3, 0.1), (0.1, 0.3)])
def test_spacing_of_a_grid_is_that_of_its_columns(beside: float, above: float) -> None:
    y, z = np.meshgrid(beside * np.arange(12), above * np.arange(12))
    nodes = np.column_stack([np.zeros(y.size), y.ravel(), z.ravel()])
    assert node_spacing(nodes) == pytest.approx(beside, rel=1e-12)
    turned = nodes[:, [1, 0, 2]]
    assert node_spacing(turned) == pytest.approx(beside, rel=1e-12)
    # Two panels meet in nodes of the same places.
    assert node_spacing(np.concatenate([nodes, turned])) == pytest.approx(beside, rel=1e-12)


def test_spacing_of_one_node_and_of_one_column_has_no_end() -> None:
    assert node_spacing(np.zeros((1, 3))) == np.inf
    assert node_spacing(np.column_stack([np.zeros((9, 2)), np.arange(9.0)])) == np.inf


@pytest.mark.parametrize("name", Vehicle.presets())
def test_spacing_of_a_preset_is_about_the_size_of_its_elements(name: str) -> None:
    for unit in Vehicle.preset(name).units:
        assert 0.8 * unit._file.exterior.element_size_m < unit.node_spacing
        assert unit.node_spacing < 1.1 * unit._file.exterior.element_size_m
        finer = unit.with_mesh_density(4.0).node_spacing
        assert finer == pytest.approx(0.5 * unit.node_spacing, rel=0.15)


# ---- which barriers are warned of --------------------------------------------------------------------------


@pytest.mark.parametrize("diameter", [0.01, 0.9 * APART])
@pytest.mark.parametrize("post", [Barrier.pole, Barrier.bollards])
def test_a_thin_post_without_indentations(post: Callable[..., Barrier], diameter: float) -> None:
    (message,) = told(BLOCK, post(diameter=diameter))
    assert "seen along the path must be above the distance between neighbouring nodes" in message
    assert f"'laboratory_block' ({APART:.3g} m)" in message
    assert f"got {diameter:.3g} m" in message
    assert "nodes that are nearer to each other; or with_indentation_length(0.65)" in message
    assert told(BLOCK.with_indentation_length(0.65), post(diameter=diameter)) == []


@pytest.mark.parametrize("post", [Barrier.pole, Barrier.bollards])
def test_a_post_that_is_wide_enough(post: Callable[..., Barrier]) -> None:
    assert told(BLOCK, post(diameter=1.1 * APART)) == []


def test_the_mesh_density_that_is_named_would_do() -> None:
    vehicle = car(0.1).with_indentation_length(0.0)
    (message,) = told(vehicle, Barrier.pole(diameter=0.1))
    density = float(message.split("a mesh_density of ")[1].split(";")[0])
    assert told(vehicle.with_mesh_density(0.4 * density), Barrier.pole(diameter=0.1)) != []
    assert told(vehicle.with_mesh_density(density), Barrier.pole(diameter=0.1)) == []


def test_a_post_of_triangles_makes_no_indentation() -> None:
    vehicle = car(0.1)
    assert told(vehicle, Barrier.pole(diameter=0.1)) == []
    (message,) = told(vehicle, triangulated(Barrier.pole(diameter=0.1)))
    assert "width of the mesh" in message
    assert "Barrier.pole or bollards in its place" in message
    assert told(vehicle, triangulated(Barrier.pole(diameter=0.5))) == []


def test_each_post_of_a_mesh_counts_by_itself() -> None:
    posts = [box(0.1, 0.1, at=at) for at in (-1.0, 0.0, 1.0)]
    assert len(mesh(*posts).parts) == 3
    assert len(told(car(), mesh(*posts))) == 1
    # Boards that touch are one wall, whether their triangles share vertices or not.
    boards = [box(0.1, 0.1, at=0.0999 * i) for i in range(30)]
    for soup in (False, True):
        assert len(mesh(*boards, soup=soup).parts) == 1
        assert told(car(), mesh(*boards, soup=soup)) == []
        assert len(told(car(), mesh(posts[0], soup=soup))) == 1


def test_what_counts_is_the_width_along_the_path() -> None:
    """A thin wall is as wide as it is long, but for who comes along it."""
    for thin in (Barrier.rigid_wall(width=8.0, height=1.0, thickness=0.05), mesh(box(0.05, 8.0))):
        for angle in (90.0, 25.0, 155.0, 3.0):
            assert told(BLOCK, thin, angle) == []
        assert len(told(BLOCK, thin, 0.0)) == 1
        assert len(told(BLOCK, thin, 180.0)) == 1
    segments = Barrier.rigid_wall(width=8.0, segments=100)
    assert told(BLOCK, segments) == []
    assert told(BLOCK, Barrier.rigid_wall(height=1.0, thickness=0.01), 5.0) == []


def test_what_the_skin_can_not_reach_is_no_matter() -> None:
    vehicle = car().with_indentation_length(0.0)
    assert len(told(vehicle, Barrier.bollards(diameter=0.1, height=0.5))) == 1
    assert told(vehicle, Barrier.bollards(diameter=0.1, height=0.1)) == []
    assert told(vehicle, mesh(box(0.1, 0.1, 5.0, 6.0), box(0.1, 8.0, at=0.0))) == []
    assert told(vehicle, None) == []


def test_one_node_has_nothing_beside_it_and_one_column_has() -> None:
    def column(count: int) -> Vehicle:
        nodes = np.column_stack([np.full(count, 2.0), np.zeros(count), np.linspace(-0.5, 0.5, count)])
        return Vehicle.from_arrays(
            mass=1000.0,
            inertia=np.diag([500.0, 1500.0, 1600.0]),
            nodes=nodes,
            anchors=nodes - [1.0, 0.0, 0.0],
            k_initial=1e6,
            k_unloading=1e7,
        )

    assert told(column(1), Barrier.pole(diameter=0.1)) == []
    (message,) = told(column(5), Barrier.pole(diameter=0.1))
    assert "(no neighbours beside them)" in message


def test_any_unit_of_a_combination_counts() -> None:
    semi = car(0.2, "semi_truck")
    assert told(semi, Barrier.pole()) == []
    (message,) = told(semi.with_unit(1, semi.units[1].with_indentation_length(0.0)), Barrier.pole())
    assert "'semi_trailer'" in message


@pytest.mark.parametrize("name", Vehicle.presets())
def test_presets_at_barriers_as_they_come_are_not_warned_of(name: str) -> None:
    vehicle = Vehicle.preset(name)
    barriers = [
        *(Barrier.rigid_wall(), Barrier.rigid_wall(width=5.0, height=1.0, segments=5)),
        *(Barrier.pole(), Barrier.bollards(), Barrier.jersey(), Barrier.jersey(length=20.0, segments=5)),
        Barrier.jersey(length=20.0, segments=5, free_standing=True),
        triangulated(Barrier.jersey(length=20.0)),
    ]
    for barrier in barriers:
        for angle in (90.0, 25.0, 5.0):
            assert told(vehicle, barrier, angle) == [], (barrier, angle)


# ---- what comes of it --------------------------------------------------------------------------------------


def test_stability_counts_a_miss_that_was_warned_of_as_warned() -> None:
    base = Simulation(BLOCK, Barrier.rigid_wall(), 22.352, settings=WEIGHTLESS)
    rows = [_judged(case, LIMITS) for case in thin_posts("block", BLOCK, base)]
    missed = [row for row in rows if row.verdict != HELD]
    assert missed
    for row in missed:
        assert row.verdict == WARNED
        assert "behind the barrier: width of the pole seen along the path must be above" in row.reason
    # The same without a warning is a fault: it was met too late.
    late = Case("thin posts", "", "", lambda: Simulation(BLOCK, Barrier.rigid_wall(), 1.0), behind=-9.0)
    assert _judged(late, LIMITS).verdict == FAULT


def forked() -> Vehicle:
    """Two nodes far to the sides of the rigid body that they are tied to."""
    return Vehicle.from_arrays(
        mass=1000.0,
        inertia=np.diag([500.0, 1500.0, 1600.0]),
        nodes=[[2.0, 1.0, 0.0], [2.0, -1.0, 0.0]],
        anchors=[[1.0, 0.0, 0.0], [1.0, 0.0, 0.0]],
        k_initial=1e6,
        k_unloading=1e7,
    )


def test_a_post_that_meets_the_rigid_body_alone_is_touched() -> None:
    """No node comes near it; the run ends where the body has left it, not after the longest event."""
    with pytest.warns(CoarseSkinWarning, match=r"\(2 m\).*got 0.1 m"):
        simulation = Simulation(forked(), Barrier.pole(diameter=0.1), 5.0, standoff=0.1, settings=WEIGHTLESS)
    result = simulation.run()
    assert (result.peak_deflection == 0.0).all()
    assert result.barrier_normal_force.max() > 0.0
    assert simulation._core.touched
    assert result.end_reason == "separated"
    assert result.velocity[-1, 0] == pytest.approx(-0.5, rel=1e-6)  # the default restitution of 0.1
    assert result.statistics.near_elements == 1
    assert result.statistics.body_steps == 1


def test_a_post_beside_the_vehicle_is_not_touched() -> None:
    with pytest.warns(CoarseSkinWarning):
        simulation = Simulation(
            forked(), Barrier.pole(diameter=0.1), 5.0, 90.0, 0.5, duration=1.0, settings=WEIGHTLESS
        )
    simulation.run()
    assert not simulation._core.touched
