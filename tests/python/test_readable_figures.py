"""Figures that can be read: blows are cut off and named, long maps are cropped, far vehicles are followed."""

from __future__ import annotations

import base64
import dataclasses
import time

import birm3d
import numpy as np
import pytest
import shapely
from birm3d import Barrier, Foundation, LoadMap, Result, Settings, Simulation, Vehicle, scenes
from birm3d.barrier.surfaces import barrier_surfaces
from birm3d.filters import cfc
from birm3d.html_page.page_data import page_data
from birm3d.html_page.replay import replay_data
from birm3d.plotting.blows import readable_level
from birm3d.plotting.figure import new_figure
from birm3d.plotting.style import wrapped
from birm3d.result.crushed_side import crushed_direction
from birm3d.result.skin import skins_at
from birm3d.vehicle.raster_outline import CELL
from birm3d.vehicle.silhouette import rings, silhouette
from birm3d.vehicle.unit_shapes import unit_shapes
from matplotlib.axes import Axes
from matplotlib.text import Annotation
from scipy.spatial.transform import Rotation

INTERVAL = 1e-4


@pytest.fixture(scope="module")
def blow() -> Result:
    """A block of weak springs at a wall: they are used up, and the rigid body strikes."""
    block = scenes.laboratory_block(16, k_initial=2e5, knee=0.4, k_hardening=2e5, k_unloading=2e6)
    wall = Barrier.rigid_wall(origin=(0.0, 0.0, -1.0))  # the block flies at 0 m
    result = Simulation(block, wall, 14.0, settings=Settings(ground=False, gravity=0.0)).run()
    assert result.statistics.body_steps > 0
    return result


@pytest.fixture(scope="module")
def far() -> Result:
    """A car that slides along a wall without end, 40 m and more."""
    car = Vehicle.preset("passenger_car", mesh_density=0.1)
    return Simulation(car, Barrier.rigid_wall(height=1.0), 30.0, 4.0, duration=1.6).run()


def texts(axes: Axes) -> list[str]:
    return [one.get_text() for one in axes.texts if isinstance(one, Annotation)]


def pulse(length: float, height: float, start: float, total: float) -> np.ndarray:
    time = np.arange(0.0, total, INTERVAL)
    phase = (time - start) / length
    return np.where((phase > 0.0) & (phase < 1.0), height * np.sin(np.pi * np.clip(phase, 0.0, 1.0)), 0.0)


def test_a_blow_is_what_is_short_and_far_above_the_rest() -> None:
    crush = pulse(0.1, 1000.0, 0.0, 0.3)
    assert readable_level(crush, INTERVAL) == crush.max()
    assert readable_level(-crush, INTERVAL) == crush.max()
    cut = readable_level(crush + pulse(0.008, 28_000.0, 0.09, 0.3), INTERVAL)
    assert 1000.0 < cut < 2000.0
    higher = crush + pulse(0.008, 2500.0, 0.09, 0.3)  # three times the rest can be read beside it
    assert readable_level(higher, INTERVAL) == higher.max()
    longer = crush + pulse(0.06, 28_000.0, 0.09, 0.3)  # it lasts: this is the event
    assert readable_level(longer, INTERVAL) == longer.max()
    alone = pulse(0.004, 5000.0, 0.1, 0.3)  # a short event, and nothing else
    assert readable_level(alone, INTERVAL) == alone.max()
    assert readable_level(np.zeros(50), INTERVAL) == 0.0


def test_force_before_a_blow_can_be_read(blow: Result) -> None:
    normal = cfc(blow.barrier_normal_force / 1e3, 60, INTERVAL)
    before = normal[: int(np.argmax(normal))]
    crush = float(before[: len(before) - round(0.015 / INTERVAL)].max())
    assert normal.max() > 10.0 * crush
    peak = f"{normal.max():,.0f} kN"
    force = blow.plot().axes[0]
    assert crush < force.get_ylim()[1] < 6.0 * crush
    (named,) = [text for one in blow.plot().axes for text in texts(one)]
    assert named.startswith(f"peak {peak} and ")
    assert named.endswith(" g")
    assert any(text == f"peak {peak}" for text in texts(blow.plot_histories().axes[0]))
    elements = blow.plot_elements().axes
    assert elements[0].get_ylim()[1] < 6.0 * crush
    assert any(text.endswith(" kN") and "," in text for text in texts(elements[0]))


def test_height_of_the_force_is_drawn_before_a_blow(blow: Result) -> None:
    """5 % of the blow would be more than all the crush."""
    (line,) = blow.plot_elements().axes[1].get_lines()
    drawn = np.asarray(line.get_xdata())[np.isfinite(np.asarray(line.get_ydata(), float))]
    struck = 1e3 * blow.time[int(np.argmax(blow.barrier_normal_force))]
    assert drawn.min() < 0.3 * struck


def test_page_cuts_a_blow_off_and_says_so(blow: Result) -> None:
    panels = {panel["title"]: panel for panel in page_data(blow, 5)["panels"]}
    force = panels["Barrier force"]
    peak = max(max(curve["y"]) for curve in force["curves"] if not curve["name"].endswith("unfiltered"))
    assert force["range"][1] < 0.5 * peak
    assert f"{peak:,.0f} kN cut off" in force["cut"]
    assert "cut" not in panels["Energy balance"]


def test_label_of_a_flat_plan_is_within_the_figure(far: Result) -> None:
    figure = far.plot_plan()
    figure.canvas.draw()
    (axes,) = figure.axes
    box = axes.yaxis.label.get_window_extent()
    assert box.y0 >= 0.0
    assert box.y1 <= figure.bbox.height
    title = figure._suptitle
    assert title is not None
    gap = title.get_window_extent().y0 - axes.get_window_extent().y1
    assert gap < 0.25 * figure.bbox.height
    assert not box.overlaps(title.get_window_extent())


def load_map(columns: int, rows: int, width: float, loaded: slice) -> LoadMap:
    force = np.zeros((400, rows, columns))
    force[100:300] = 3e2  # what a vehicle that slides on presses, all along
    force[100:300, :, loaded] = 1e4
    lateral = np.linspace(-0.5 * width, 0.5 * width, columns + 1)
    return LoadMap(
        np.arange(400) * INTERVAL, lateral, np.linspace(0.0, 1.0, rows + 1), force, np.zeros(400), "A scene"
    )


@pytest.mark.parametrize("angle", [90.0, 25.0])
def test_plans_at_long_barriers_show_the_vehicle_and_what_is_about_it(angle: float) -> None:
    """Head-on at a barrier of 200 m the car was a fortieth of the picture."""
    car = Vehicle.preset("passenger_car", mesh_density=0.1)
    crash = Simulation(car, Barrier.jersey(length=200.0), 15.0, angle).run()
    (axes,) = crash.plot_plan(exit_box=False).axes
    sizes = np.ptp([axes.get_xlim(), axes.get_ylim()], axis=1)
    assert sizes.max() < 2.2 * (car.length + np.ptp(crash.position[:, :2], axis=0).max())
    posts = Simulation(car, Barrier.bollards(), 15.0).run().plot_plan().axes[0]
    assert np.ptp(posts.get_ylim()) > 4 * 1.2 + 0.32, "m; posts are seen whole"


def test_long_load_maps_are_cropped_to_what_is_loaded() -> None:
    figure = load_map(200, 4, 100.0, slice(20, 30)).plot()
    for axes in figure.axes[:2]:
        left, right = axes.get_xlim()  # from right to left
        assert (right, left) == pytest.approx((-50.0 + 19 * 0.5, -50.0 + 31 * 0.5))
    assert figure._suptitle is not None
    assert "from -40.5 to -34.5 m; beyond, peaks are below 5 %" in figure.get_suptitle().replace(
        "\u00a0", " "
    )
    whole = load_map(12, 4, 6.0, slice(1, 11)).plot()
    assert whole.axes[0].get_xlim() == pytest.approx((3.0, -3.0))
    assert whole._suptitle is not None
    assert whole._suptitle.get_text() == "A scene"


def test_narrow_load_maps_stand_side_by_side() -> None:
    figure = load_map(1, 4, 0.3, slice(0, 1)).plot()
    figure.canvas.draw()
    first, second = (axes.get_window_extent() for axes in figure.axes[:2])
    assert first.y0 == pytest.approx(second.y0, abs=2.0)
    assert first.x1 < second.x0
    assert first.width > 0.15 * figure.bbox.width


def test_replay_has_all_of_a_long_barrier_and_follows_the_vehicle(far: Result) -> None:
    data = replay_data(far, 9)
    (part,) = data["barrier"]
    vertices = np.frombuffer(base64.b64decode(part["vertices"]), "<f4").reshape(-1, 3)
    world = np.vstack([skin.world for one in skins_at(far, [0.0, far.time[-1]]) for skin in one])
    ((own, _),) = barrier_surfaces(far.scene.barrier, world)
    assert np.ptp(own, axis=0).max() > 40.0
    assert vertices.min(axis=0) == pytest.approx(own.min(axis=0), abs=0.5)
    assert vertices.max(axis=0) == pytest.approx(own.max(axis=0), abs=0.5)
    targets = np.array(data["targets"])
    assert len(targets) == len(data["time"])
    place = far.pose(np.array(data["time"]) / 1e3)[0]
    assert targets[:, :2] == pytest.approx(place[:, :2], abs=2e-3)


def test_replay_looks_at_the_crush() -> None:
    car = Vehicle.preset("passenger_car", mesh_density=0.1)
    crash = Simulation(car, Barrier.rigid_wall(), 12.0).run()
    data = replay_data(crash, 9)
    assert len(data["targets"]) == 1  # all of it fits in the picture
    assert data["seeThrough"] is True  # the wall hides it
    (skins,) = skins_at(crash, [data["instant"] / 1e3])
    seen = crushed_direction(crash, skins)
    assert seen is not None
    around = data["camera"]["around"]
    assert np.array([np.cos(around), np.sin(around)]) == pytest.approx(seen[:2], abs=1e-6)
    posts = Simulation(car, Barrier.bollards(), 12.0).run()
    assert replay_data(posts, 5)["seeThrough"] is False


@pytest.mark.parametrize("angles", [(0.0, 0.0, 0.0), (5.0, -8.0, 33.0), (80.0, 10.0, 120.0)])
def test_outline_by_cells_is_the_outline(angles: tuple[float, float, float]) -> None:
    """Of a vehicle that a post has dented, in any pose: within a cell and a half, and of the same area."""
    car = Vehicle.preset("passenger_car", mesh_density=0.3)
    result = Simulation(car, Barrier.pole(), 14.0).run()
    (shape,) = unit_shapes(car)
    turn = Rotation.from_euler("xyz", angles, degrees=True).as_matrix()
    pose = (result.final_nodes(), np.array([3.0, -7.0, 1.0]), turn)
    exact, cells = (rings(silhouette(shape, *pose, exact=exact))[0] for exact in (True, False))
    own, given = shapely.Polygon(cells), shapely.Polygon(exact)
    assert own.symmetric_difference(given).area < CELL * given.length
    assert own.area == pytest.approx(given.area, rel=0.01)
    # Cells miss what is thinner than a cell: edges of crushed sheet that are seen from above.
    assert given.buffer(-0.5 * CELL).difference(own.buffer(2.0 * CELL)).area < 5e-4 * given.area
    assert given.buffer(2.0 * CELL).contains(own)


def test_outline_of_very_many_faces_is_by_cells() -> None:
    """Of 45,000 crumpled faces the exact outline would take a minute, or end in an error of shapely's."""
    random = np.random.default_rng(3)
    n = 151
    x, y = np.meshgrid(np.linspace(0.0, 4.0, n), np.linspace(0.0, 1.5, n), indexing="ij")
    nodes = np.column_stack([x.ravel(), y.ravel(), np.zeros(n * n)])
    inner = (nodes[:, 0] > 0.1) & (nodes[:, 0] < 3.9) & (nodes[:, 1] > 0.1) & (nodes[:, 1] < 1.4)
    nodes[inner] += random.normal(0.0, 0.02, (int(inner.sum()), 3))
    corner = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    quads = np.column_stack([corner, corner + n, corner + n + 1, corner + 1])
    (car,) = unit_shapes(Vehicle.preset("passenger_car", mesh_density=0.1))
    sheet = dataclasses.replace(car, nodes=nodes, quads=quads)
    started = time.perf_counter()
    (ring,) = rings(silhouette(sheet, nodes, np.zeros(3), np.eye(3)))
    assert time.perf_counter() - started < 5.0
    assert shapely.Polygon(ring).symmetric_difference(shapely.box(0.0, 0.0, 4.0, 1.5)).area < 11.0 * CELL


def test_titles_are_within_the_figure_and_keep_numbers_with_their_units() -> None:
    """Those of posts that yield with their foundation are long; design loads cut theirs off on both sides."""
    foundation = Foundation(moment=450e3, rotation_depth=0.4)
    posts = Barrier.bollards(
        count=7, diameter=0.273, wall_thickness=0.016, filling="concrete", foundation=foundation
    )
    result = Simulation(Vehicle.preset("van_3500", mesh_density=0.2), posts, 10.0).run()
    loads = birm3d.design_load([result, result], draws=0)
    figures = (result.plot(), result.plot_elements(), result.plot_plan(), loads.plot())
    for figure in figures:
        figure.canvas.draw()
        assert figure._suptitle is not None
        box = figure._suptitle.get_window_extent()
        assert box.x0 >= 0.0
        assert box.x1 <= figure.bbox.width
        assert "0.273\u00a0m" in figure.get_suptitle()
    narrow = new_figure(2.0, 2.0)
    for n in range(1, 30):
        text = wrapped(f"{'a ' * n}yields at 403 kN m, 64 km/h, 12 mm, 7 bollards", narrow)
        lines = text.split("\n")
        for whole in ("403\u00a0kN\u00a0m", "64\u00a0km/h", "12\u00a0mm"):
            assert any(whole in line for line in lines)
        assert "7 bollards" in text.replace("\n", " ")
