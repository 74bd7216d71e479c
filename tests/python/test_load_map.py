"""Load maps of walls: their cells add up to the wall's load, and each has what its nodes press."""

from __future__ import annotations

import csv
import re
from pathlib import Path

import birm3d
import numpy as np
import pytest
from birm3d import Barrier, LoadMap, Result, Settings, Simulation, Vehicle, scenes
from birm3d.result.face_loads import face_steps


@pytest.fixture(scope="module")
def oblique() -> Result:
    car = Vehicle.preset("passenger_car", mesh_density=0.3)
    wall = Barrier.rigid_wall(width=8.0, height=1.5, segments=3, heading=30.0, origin=(1.0, 2.0, 0.0))
    return Simulation(car, wall, 15.0, 50.0, impact_offset=wall.station()).run()


@pytest.fixture(scope="module")
def cells(oblique: Result) -> LoadMap:
    return oblique.load_map(0.1)


def test_cells_add_up_to_the_walls_load(oblique: Result, cells: LoadMap) -> None:
    across = np.array([np.cos(np.radians(30.0)), np.sin(np.radians(30.0)), 0.0])
    own = sum(load.force @ across for load in oblique.element_loads)
    assert isinstance(own, np.ndarray)
    assert np.abs(cells.resultant - own).max() < 1e-10 * own.max()
    assert np.abs(cells.outside).max() == 0.0
    assert cells.height[0] == 0.0
    assert cells.height[-1] <= 1.5  # the wall's top
    assert oblique.load_map(0.4).height[-1] <= 1.5
    impulse = own[1:].sum() * oblique.scene.settings.output_interval
    assert cells.impulse.sum() == pytest.approx(impulse, rel=1e-10)
    assert cells.force.min() >= -1e-12 * cells.force.max()  # a wall does not pull, to rounding


def test_the_load_is_where_the_moments_of_the_elements_say(oblique: Result, cells: LoadMap) -> None:
    """Height and place of the impulse, from force and moment of each segment about its own foot."""
    angle = np.radians(30.0)
    across, line = (
        np.array([np.cos(angle), np.sin(angle), 0.0]),
        np.array([-np.sin(angle), np.cos(angle), 0.0]),
    )
    feet = [8.0 * ((i + 0.5) / 3.0 - 0.5) for i in range(3)]
    force = np.array([load.force[1:].sum(axis=0) @ across for load in oblique.element_loads])
    up = sum(load.moment[1:].sum(axis=0) @ line for load in oblique.element_loads) / force.sum()
    about_z = np.array([load.moment[1:].sum(axis=0)[2] for load in oblique.element_loads])
    along = (np.dot(feet, force) - about_z.sum()) / force.sum()
    y, z = (0.5 * (edges[1:] + edges[:-1]) for edges in (cells.lateral, cells.height))
    assert cells.impulse.sum(axis=1) @ z / cells.impulse.sum() == pytest.approx(up, abs=0.01)
    assert cells.impulse.sum(axis=0) @ y / cells.impulse.sum() == pytest.approx(along, abs=0.01)


def test_equal_springs_share_the_impulse_equally() -> None:
    """100 equal springs, head-on: a cell has m (v + v') times its share of the springs."""
    block = scenes.laboratory_block(100, k_initial=3e6, knee=5.0, k_unloading=3e6)
    settings = Settings(gravity=0.0, ground=False)
    simulation = Simulation(block, Barrier.rigid_wall(friction=0.0), 10.0, settings=settings)
    result = simulation.run()
    places = block.nodes[:, 1:] + [0.0, result.position[0, 2]]
    edges = (np.array([-2.0, -0.5, 0.07, 2.0]), np.array([-9.0, 0.33 + places[:, 1].min(), 9.0]))
    found = result.load_map(lateral=edges[0], height=edges[1]).impulse
    # A node's force acts in four quarters 12.5 mm about it.
    quarters = np.concatenate(
        [places + np.array([a, b]) for a in (-0.0125, 0.0125) for b in (-0.0125, 0.0125)]
    )
    count = np.histogram2d(quarters[:, 1], quarters[:, 0], [edges[1], edges[0]])[0]
    momentum = block.mass * (10.0 - result.velocity[-1, 0])
    assert found == pytest.approx(momentum * count / count.sum(), rel=2e-3)


def test_nodes_alone_have_almost_all_of_it() -> None:
    """What nodes press by their trusses, by the trapezium rule over the steps, without any scaling."""
    car = Vehicle.preset("passenger_car", mesh_density=0.3)
    result = Simulation(car, Barrier.rigid_wall(), 15.0).run()
    core = result.scene.start()
    edges = np.arange(-1.25, 1.3, 0.25)
    times, presses = [0.0], [np.zeros(len(edges) - 1)]
    while core.step():
        center, turn = core.pose()
        nodes, force = core.nodes(), core.truss_force()
        truss = nodes - car.anchors
        along = (truss / np.linalg.norm(truss, axis=1)[:, None] @ turn.T)[:, 0]
        places = center + nodes @ turn.T
        mine = (force > 0.0) & (np.abs(places[:, 0]) < 1e-3) & (places[:, 2] > 1e-3)
        quarters = [places[mine, 1] + shift for shift in (-0.0125, 0.0125)]
        presses.append(
            sum(0.5 * np.histogram(q, edges, weights=(force * along)[mine])[0] for q in quarters)  # type: ignore[arg-type]
        )
        times.append(core.time)
    own = np.trapezoid(np.array(presses), times, axis=0)
    found = result.load_map(lateral=edges).impulse.sum(axis=0)
    assert np.abs(found - own).max() < 3e-3 * found.max()


def test_edges_of_a_load_cell_wall(oblique: Result) -> None:
    """What the vehicle presses beside the cells is told apart, and not lost."""
    found = oblique.load_map(lateral=[-1.0, 0.0], height=[0.0, 0.5, 1.0])
    assert found.impulse.shape == (2, 1)
    assert found.outside.max() > 0.0
    assert found.resultant == pytest.approx(oblique.barrier_normal_force, abs=1e-6)


def test_files_text_and_figures(oblique: Result, cells: LoadMap, tmp_path: Path) -> None:
    cells.to_csv(tmp_path / "map.csv")
    with (tmp_path / "map.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == cells.impulse.size
    assert sum(float(row["impulse [N s]"]) for row in rows) == pytest.approx(cells.impulse.sum())
    assert float(rows[0]["height from [m]"]) == 0.0
    figure = cells.plot()
    assert "wall" in figure.get_suptitle()
    assert figure.axes[0].get_xlim()[0] > figure.axes[0].get_xlim()[1]  # y runs to the left
    assert any("[kN s]" in axes.get_ylabel() for axes in figure.axes)
    assert "50.0 ms" in cells.plot("50 ms").axes[0].get_title()
    total = float(re.findall(r"sum of the cells ([\d.]+) kN s", str(cells))[0])
    assert total == pytest.approx(cells.impulse.sum() / 1e3, rel=5e-3)
    oblique.write_html(tmp_path / "page.html", frames=5)
    assert "Load on the wall by cell" in (tmp_path / "page.html").read_text(encoding="utf-8")


FRONTS = {
    "jersey": (Barrier.jersey(length=30.0, segments=3, heading=20.0, origin=(1.0, 2.0, 0.0)), 18.0, 25.0),
    "planter": (Barrier.planter(heading=-40.0), 12.0, 90.0),
    "bollards": (Barrier.bollards(count=4, spacing=1.1, heading=30.0, origin=(0.5, 0.0, 0.0)), 14.0, 70.0),
    "pole": (Barrier.pole(), 9.0, 90.0),
}


@pytest.mark.parametrize("name", FRONTS)
def test_other_fronts_add_up_and_have_the_height_of_the_moments(name: str) -> None:
    """Sloped faces, blocks, posts: force of each post and of the whole; mean height by the moments alone."""
    barrier, speed, angle = FRONTS[name]
    car = Vehicle.preset("passenger_car", mesh_density=0.3)
    result = Simulation(car, barrier, speed, angle, impact_offset=barrier.station()).run()
    cells = result.load_map(0.1)
    turn = np.radians(barrier.heading)
    across, line = (np.array([np.cos(a), np.sin(a), 0.0]) for a in (turn, turn + 0.5 * np.pi))
    loads = result.element_loads
    own = np.sum([load.force @ across for load in loads], axis=0)
    assert np.abs(cells.resultant - own).max() < 1e-9 * own.max()
    if barrier.has_posts:
        each = [load.force[1:].sum(axis=0) @ across * cells.interval for load in loads]
        assert cells.impulse.sum(axis=0) == pytest.approx(each, rel=1e-9, abs=1e-6)
    middles = 0.5 * (cells.height[1:] + cells.height[:-1])
    # Of a face that leans back vertical forces have a lever, here that of its middle.
    lever = -0.5 * 0.61 + 0.13 if name == "jersey" else -0.5 * getattr(barrier, "diameter", 0.0)
    moment = sum(load.moment[1:].sum(axis=0) @ line + lever * load.force[1:, 2].sum() for load in loads)
    height = moment / own[1:].sum()
    assert cells.impulse.sum(axis=1) @ middles / cells.impulse.sum() == pytest.approx(height, abs=0.05)


def test_the_load_on_a_slope_is_where_it_touches() -> None:
    """A block of springs that meets only the upper face of a Jersey barrier loads only the upper cells."""
    block = scenes.laboratory_block(100, k_initial=3e6, knee=5.0, k_unloading=3e6)
    settings = Settings(gravity=0.0, ground=False)
    result = Simulation(block, Barrier.jersey(friction=0.0), 4.0, settings=settings).run()
    cells = result.load_map(0.1)
    low = float((block.nodes[:, 2] + result.position[:, 2].min()).min())
    assert cells.impulse[cells.height[1:] < low - 0.05].sum() <= 1e-9 * cells.impulse.sum()
    assert cells.impulse.sum() == pytest.approx(block.mass * (4.0 - result.velocity[-1, 0]), rel=1e-3)


def test_no_load_is_below_the_ground() -> None:
    """Wheels on the toe of a low wall: sums and mean height stay those of the elements' loads."""
    barrier = Barrier.jersey(profile="f_shape", height=0.81, length=60.0, segments=15)
    result = birm3d.test_matrix("EN 1317 TB81", barrier=barrier)[0].run()
    cells = result.load_map()
    assert cells.height[0] == 0.0
    assert not cells.outside.any()
    front = barrier.load_front()
    assert all((step.height >= 0.0).all() for step in face_steps(result, front))
    across = np.sum([load.force @ front.across for load in result.element_loads], axis=0)
    assert np.abs(cells.resultant - across).max() < 1e-9 * across.max()
    moment = sum(
        float((load.moment @ front.line + front.lever * load.force[:, 2])[1:].sum())
        for load in result.element_loads
    )
    middles = 0.5 * (cells.height[1:] + cells.height[:-1])
    found = cells.impulse.sum(axis=1) @ middles / cells.impulse.sum()
    assert found == pytest.approx(moment / across[1:].sum(), abs=0.02)
    wide = result.load_map(height=[-0.5, 0.0, 0.81])
    assert not wide.impulse[0].any()


def _cube() -> tuple[list[list[float]], list[list[int]]]:
    corners = [[x, y, z] for x in (0.0, 0.5) for y in (-2.0, 2.0) for z in (0.0, 1.0)]
    faces = [
        *([0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5]),
        *([0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [1, 5, 7], [1, 7, 3], [0, 2, 6], [0, 6, 4]),
    ]
    return corners, faces


@pytest.mark.filterwarnings("ignore::birm3d.TippingWarning")
def test_wrong_input(oblique: Result, cells: LoadMap) -> None:
    car = Vehicle.preset("passenger_car", mesh_density=0.1)
    posts = Simulation(car, Barrier.bollards(count=1), 8.0).run()
    with pytest.raises(ValueError, match="lateral must be None for posts, of which each has one column"):
        posts.load_map(lateral=[-1.0, 1.0])
    for barrier, message in (
        (Barrier.bollards(count=2, rows=2), "must have one row of posts to have a load map, got 2 rows"),
        (Barrier.jersey(length=6.0, free_standing=True), "barrier must be fixed to have a load map"),
        (Barrier.from_mesh(*_cube()), "must be one of .*jersey, .* to have a load map, got Mesh"),
    ):
        with pytest.raises(ValueError, match=message):
            Simulation(car, barrier, 8.0, impact_offset=barrier.station()).run().load_map()
    with pytest.raises(ValueError, match=r"cell must be >= 0.01 m, got 0.001"):
        oblique.load_map(0.001)
    with pytest.raises(ValueError, match="lateral must have at least 2 edges that increase"):
        oblique.load_map(lateral=[1.0, 0.0])
    with pytest.raises(ValueError, match="time must be within the run"):
        cells.at(9.0)
