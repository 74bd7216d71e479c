"""Figures: the right curves, names and units; numbers behind crush maps and plan views."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from io import BytesIO
from pathlib import Path

import birm3d
import numpy as np
import pytest
import shapely
from birm3d import Barrier, Channel, Result, Settings, Simulation, Vehicle, compare_curves, scenes, units
from birm3d.barrier.surfaces import barrier_surfaces
from birm3d.barrier.text import barrier_text
from birm3d.filters import cfc
from birm3d.plotting import plot_comparisons
from birm3d.plotting.elements import _mark_peaks
from birm3d.plotting.energies import energy_look
from birm3d.plotting.style import prepare
from birm3d.result.crush_profile import crush_map, crush_profile, crushed_sides
from birm3d.result.skin import skins_at
from birm3d.vehicle.silhouette import rings, silhouette
from birm3d.vehicle.unit_shapes import UnitShape, unit_shapes
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from matplotlib.text import Text
from scipy.spatial import ConvexHull


@pytest.fixture(scope="module")
def head_on() -> Result:
    return scenes.nhtsa_10146(mesh_density=0.3).run()


@pytest.fixture(scope="module")
def oblique() -> Result:
    car = Vehicle.preset("passenger_car", mesh_density=0.3)
    return Simulation(car, Barrier.rigid_wall(), 26.7, 24.0).run()


def names(axes: Axes) -> list[str]:
    legend = axes.get_legend()
    assert legend is not None
    return [text.get_text() for text in legend.get_texts()]


def heading(figure: Figure) -> str:
    assert figure._suptitle is not None
    return figure._suptitle.get_text()


def image(figure: Figure, tmp_path: Path) -> np.ndarray:
    from matplotlib.image import imread

    figure.savefig(tmp_path / "figure.png", dpi=50)
    return imread(tmp_path / "figure.png")


def test_histories(oblique: Result) -> None:
    figure = oblique.plot_histories()
    force, acceleration, velocity, rates, tires, angles = figure.get_axes()
    assert names(force) == ["along the normal, CFC 60", "50-ms mean"]
    assert names(acceleration) == ["forward, CFC 60", "left, CFC 60", "up, CFC 60"]
    assert names(rates) == ["roll rate, CFC 180", "pitch rate, CFC 180", "yaw rate, CFC 180"]
    assert names(angles) == ["roll", "pitch", "yaw"]
    assert [a.get_ylabel().split("[")[1] for a in (force, velocity, tires)] == ["kN]", "m/s]", "kN]"]
    assert angles.get_xlabel() == "time [ms]"
    # Thin and unfiltered behind, filtered before it.
    raw, smooth = force.get_lines()[:2]
    assert raw.get_linewidth() < smooth.get_linewidth()
    assert np.array_equal(raw.get_ydata(), oblique.barrier_normal_force / 1e3)
    assert np.array_equal(smooth.get_ydata(), cfc(oblique.barrier_normal_force / 1e3, 60, 1e-4))


def test_an_impulse_does_not_hide_the_rest(make_soft_scene: Callable[..., Simulation]) -> None:
    """The rigid body at the wall stops within a row: the unfiltered line leaves the panel."""
    result = make_soft_scene().run()
    smooth = cfc(result.barrier_normal_force, 60, 1e-4).max() / 1e3
    assert result.barrier_normal_force.max() / 1e3 > 10.0 * smooth
    for figure in (result.plot(), result.plot_histories()):
        assert smooth < figure.get_axes()[0].get_ylim()[1] < 1.7 * smooth


def test_force_and_deceleration_have_one_zero_line() -> None:
    """The deceleration of a truck at a slope has negative peaks; its axis was once a third higher."""
    car = Vehicle.preset("cargo_truck", mesh_density=0.1)
    figure = Simulation(car, Barrier.rigid_wall(), 20.0, 25.0).run().plot()
    force = figure.get_axes()[0]
    other = next(axes for axes in figure.get_axes() if axes.get_ylabel() == "deceleration [g]")
    low, high = other.get_ylim()
    assert low < 0.0 < high
    assert other.transData.transform((0.0, 0.0)) == pytest.approx(force.transData.transform((0.0, 0.0)))


def test_the_legend_of_a_plan_is_below_its_label() -> None:
    truck = Vehicle.preset("cargo_truck", mesh_density=0.1)
    figure = Simulation(truck, Barrier.bollards(), 20.0, 25.0).run().plot_plan()
    figure.savefig(BytesIO())
    label = figure.get_axes()[0].xaxis.label.get_window_extent()
    assert figure.legends[0].get_window_extent().y1 < label.y0


def test_rows_too_far_apart_are_said_to_be_unfiltered() -> None:
    block = scenes.laboratory_block(16, k_initial=3e6, k_unloading=3e6)
    settings = Settings(output_interval=2e-3, gravity=0.0, ground=False)
    result = Simulation(block, Barrier.rigid_wall(), 10.0, settings=settings).run()
    for figure in (result.plot(), result.plot_histories()):
        said = [name for axes in figure.get_axes() if axes.get_legend() for name in names(axes)]
        assert any("unfiltered: rows too far apart" in name for name in said)
        assert not any("CFC" in name for name in said)


@pytest.mark.parametrize("name", ["rolling", "parked"])
def test_figures_without_a_barrier(result_of: Callable[[str], Result], name: str) -> None:
    result = result_of(name)
    assert result.plot_histories().get_axes()[0].get_legend() is None
    plan = result.plot_plan([0.0, 0.1]).get_axes()[0]
    assert (plan.get_xlabel(), plan.get_ylabel()) == ("x [m]", "y [m]")
    assert len(plan.collections) == 0


def test_figures_are_not_blank(oblique: Result, tmp_path: Path) -> None:
    for figure in (
        oblique.plot(),
        oblique.plot_histories(),
        oblique.plot_plan(),
        oblique.plot_crush("right"),
    ):
        pixels = image(figure, tmp_path)
        assert pixels.std() > 0.05
        assert len(np.unique(pixels.reshape(-1, pixels.shape[-1]), axis=0)) > 50


# ---- plan view -------------------------------------------------------------------------------------------


def test_plan(oblique: Result) -> None:
    figure = oblique.plot_plan([0.0, 0.1, 0.2])
    (axes,) = figure.get_axes()
    assert axes.get_aspect() == 1.0
    outlines = [patch for patch in axes.patches if isinstance(patch, Polygon)]
    assert [patch.get_label() for patch in outlines] == ["0 ms", "100 ms", "200 ms"]
    assert axes.get_xlabel() == "along the barrier's line [m]"
    labels = [line.get_label() for line in axes.get_lines()]
    assert "path of the mass centre" in labels
    assert any("exit box (EN 1317-2, MASH)" in str(label) for label in labels)
    # The traffic side is above: no outline is below the face, and that at the wall touches it.
    lowest = [float(patch.get_xy()[:, 1].min()) for patch in outlines]
    assert lowest[1] == pytest.approx(0.0, abs=0.01)
    assert min(lowest) > -0.01
    assert f"{oblique.metrics['exit_angle']:.1f}°" in heading(figure)
    assert "straight on" not in [
        line.get_label() for line in oblique.plot_plan(exit_box=False).gca().get_lines()
    ]


def test_plan_of_a_turned_scene_is_the_same() -> None:
    """The picture is in the barrier's axes, whatever its heading and place."""
    car = Vehicle.preset("passenger_car", mesh_density=0.2)
    plain = Simulation(car, Barrier.rigid_wall(), 20.0, 30.0).run()
    turned = Simulation(car, Barrier.rigid_wall(heading=130.0, origin=(5.0, -3.0, 0.0)), 20.0, 30.0).run()
    a, b = (
        [patch.get_xy() for patch in result.plot_plan([0.0, 0.05]).get_axes()[0].patches]
        for result in (plain, turned)
    )
    for one, other in zip(a, b, strict=True):
        assert np.abs(np.ptp(one, axis=0) - np.ptp(other, axis=0)).max() < 1e-6


def test_exit_box_is_left_out_head_on(head_on: Result) -> None:
    (axes,) = head_on.plot_plan().get_axes()
    assert axes.get_xlabel() == "past the barrier's line [m]"
    assert not any("exit box" in str(line.get_label()) for line in axes.get_lines())
    with pytest.raises(ValueError, match="frames must be"):
        head_on.plot_plan([9.0])


def test_exit_box_of_a_semitrailer_is_that_of_its_rating() -> None:
    """Its length is that of the combination; the trailer's own was taken once."""
    truck = Vehicle.preset("mash_36000v", mesh_density=0.1)
    result = Simulation(truck, Barrier.jersey(height=1.07, length=60.0), units.km_h(80.0), 15.0).run()
    (row,) = [one for one in birm3d.rate(result, "MASH 5-12").criteria if "exit box" in one.name]
    (label,) = [
        one
        for one in map(str, (line.get_label() for line in result.plot_plan().gca().get_lines()))
        if "exit box" in one
    ]
    assert float(label.split()[-5]) == pytest.approx(float(row.limit.split()[1]), abs=0.06)


def box_shape(length: float, width: float) -> UnitShape:
    """A flat skin of 32 faces."""
    x, y = np.meshgrid(np.linspace(-0.5, 0.5, 9) * length, np.linspace(-0.5, 0.5, 5) * width, indexing="ij")
    nodes = np.column_stack([x.ravel(), y.ravel(), 0.0 * x.ravel()])
    index = np.arange(45).reshape(9, 5)
    quads = np.stack([index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]], axis=-1).reshape(-1, 4)
    return UnitShape(nodes, nodes, quads, np.zeros(45, int), ("all",), np.empty((0, 4)), 0.5)


def test_silhouette_of_a_box() -> None:
    """A box of 4 by 2 m, turned: its corners are met."""
    box = box_shape(4.0, 2.0)
    c, s = np.cos(0.5), np.sin(0.5)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    outline = silhouette(box, box.nodes, np.array([3.0, 4.0, 0.0]), turn)
    (ring,) = rings(outline)
    assert np.abs((ring - [3.0, 4.0]) @ turn[:2, :2]).max(axis=0) == pytest.approx([2.0, 1.0], abs=1e-9)
    assert outline.area == pytest.approx(8.0, rel=1e-9)


def test_silhouette_of_a_folded_skin() -> None:
    """Faces that lie over each other count once: half of a sheet folded onto the other half."""
    box = box_shape(4.0, 2.0)
    folded = box.nodes.copy()
    folded[:, 0] = np.abs(folded[:, 0])
    folded[:, 2] = np.where(box.nodes[:, 0] < 0.0, 0.1, 0.0)
    assert silhouette(box, folded, np.zeros(3), np.eye(3)).area == pytest.approx(4.0, rel=1e-9)


@pytest.mark.parametrize("preset", Vehicle.presets())
def test_outlines_of_presets_end_where_the_skin_does(preset: str) -> None:
    """At 36 headings the outline reaches as far as the outermost corners of the skin, and no farther."""
    for shape in unit_shapes(Vehicle.preset(preset, mesh_density=0.2)):
        if len(shape.quads) == 0:
            continue
        corners = shape.nodes[np.unique(shape.quads)]
        for angle in np.radians(np.arange(0.0, 360.0, 10.0) + 1.0):
            c, s = np.cos(angle), np.sin(angle)
            turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
            plan = (corners @ turn.T)[:, :2]
            outline = silhouette(shape, shape.nodes, np.zeros(3), turn)
            expected = [*plan.min(axis=0), *plan.max(axis=0)]
            assert np.abs(np.array(outline.bounds) - expected).max() < 1e-6
            assert 0.7 * ConvexHull(plan).volume < outline.area <= ConvexHull(plan).volume * (1.0 + 1e-9)


def test_silhouette_is_the_union_of_the_crushed_skin() -> None:
    """A car crushed at an angle, whose panels lie above each other: all triangles put together by shapely."""
    car = Vehicle.preset("passenger_car", mesh_density=0.2)
    result = Simulation(car, Barrier.bollards(count=2, spacing=1.1), 17.0, 70.0).run()
    (shape,) = unit_shapes(car)
    ((skin,),) = skins_at(result, [result.time[-1]])
    outline = silhouette(shape, skin.nodes, skin.center, skin.rotation)
    corners = skin.world[np.vstack([shape.quads[:, [0, 1, 2]], shape.quads[:, [0, 2, 3]]]), :2]
    whole = shapely.union_all([one for one in map(shapely.Polygon, corners) if one.area > 1e-12])
    assert shapely.area(shapely.symmetric_difference(outline, whole)) < 1e-8


def test_silhouette_without_a_skin() -> None:
    result = scenes.w2(16).run()
    (skin,) = skins_at(result, 0.0)[0]
    (shape,) = unit_shapes(result.scene.vehicle)
    (ring,) = rings(silhouette(shape, skin.nodes, skin.center, skin.rotation))
    assert np.ptp(ring, axis=0) == pytest.approx([2.0, 2.4], abs=1e-9)


def test_plan_of_a_vehicle_that_comes_back(head_on: Result) -> None:
    """Five outlines would lie on each other: start, greatest travel and end are told apart by their style."""
    (axes,) = head_on.plot_plan().get_axes()
    outlines = [patch for patch in axes.patches if isinstance(patch, Polygon)]
    texts = [str(patch.get_label()) for patch in outlines]
    assert [text.split(",")[0] for text in texts] == ["start", "greatest travel", "end"]
    farthest = head_on.time[np.argmax(head_on.position[:, 0])]
    assert texts[1] == f"greatest travel, {farthest * 1e3:.0f} ms"
    looks = {(patch.get_edgecolor(), str(patch.get_linestyle())) for patch in outlines}
    assert len(looks) == 3
    assert len({color for color, _ in looks}) == 3


def test_a_tractor_and_its_trailer_are_one_outline() -> None:
    result = Simulation(Vehicle.preset("semi_truck", mesh_density=0.2), None, 10.0, duration=0.01).run()
    (axes,) = result.plot_plan([0.0]).get_axes()
    (patch,) = axes.patches
    skins = np.vstack(
        [
            skin.world[np.unique(shape.quads)]
            for shape, skin in zip(unit_shapes(result.scene.vehicle), skins_at(result, 0.0)[0], strict=True)
        ]
    )
    assert np.ptp(patch.get_xy()[:, 0]) == pytest.approx(np.ptp(skins[:, 0]), abs=1e-6)


# ---- titles, legends, colours ----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("barrier", "text"),
    [
        (None, "no barrier"),
        (Barrier.rigid_wall(), "rigid wall without end"),
        (
            Barrier.rigid_wall(width=6.0, height=1.2, thickness=0.4, segments=3),
            "rigid wall 6 m long in 3 segments, 1.2 m high, 0.4 m thick",
        ),
        (Barrier.rigid_wall(height=0.8), "rigid wall without end, 0.8 m high, 0.5 m thick"),
        (Barrier.pole(diameter=0.254), "pole, Ø 0.254 m"),
        (Barrier.planter(length=1.5), "planter, 1.5 m long, 1 m wide, 1 m high"),
        (Barrier.bollards(), "5 bollards, Ø 0.32 m, 1 m high, 1.2 m between axes (0.88 m clear)"),
        (Barrier.bollards(count=1), "1 bollard, Ø 0.32 m, 1 m high"),
        (
            Barrier.bollards(count=2, rows=2),
            "2 rows of 2 bollards, Ø 0.32 m, 1 m high, 1.2 m between axes (0.88 m clear), "
            "rows 1.2 m apart (axis to axis)",
        ),
        (Barrier.jersey(), "New Jersey barrier, 0.813 m high, without end"),
        (
            Barrier.jersey(profile="f_shape", length=12.0, segments=4, free_standing=True),
            "F-shape barrier, 0.813 m high, 12 m long in 4 segments, free-standing",
        ),
        (
            Barrier.from_mesh(
                [[0, 0, 0], [0, 2, 0], [0, 0, 1], [0.5, 0, 0]], [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
            ),
            "mesh of 4 triangles, 0.5 by 2 by 1 m",
        ),
    ],
)
def test_barriers_in_words(barrier: Barrier | None, text: str) -> None:
    assert barrier_text(barrier) == text


def test_every_figure_names_the_barrier(oblique: Result) -> None:
    for figure in (
        oblique.plot(),
        oblique.plot_histories(),
        oblique.plot_plan(),
        oblique.plot_crush(),
        oblique.plot_elements(),
    ):
        assert barrier_text(oblique.scene.barrier) in heading(figure)


def test_plans_say_what_became_of_the_vehicle(oblique: Result, head_on: Result) -> None:
    for result in (oblique, head_on):
        words = heading(result.plot_plan())
        assert f"{result.outcome}: {result.outcome_detail}\n" in words
        side = "from" if result.metrics["exit_angle"] >= 0.0 else "towards"
        assert words.endswith(f"{abs(result.metrics['exit_angle']):.1f}° {side} the barrier's line")
        assert f"{result.metrics['time_of_separation'] * 1e3:.0f}\N{NO-BREAK SPACE}ms" in words


def test_rounding_errors_are_not_drawn_as_motion() -> None:
    spring = Vehicle.from_arrays(
        mass=1000.0,
        inertia=1000.0 * np.eye(3),
        nodes=[[1.0, 0.01, 0.0], [1.0, -0.01, 0.0]],
        anchors=[[0.0, 0.01, 0.0], [0.0, -0.01, 0.0]],
        k_initial=1e6,
        k_unloading=4e6,
        mass_center_height=0.5,
    )
    free = Settings(gravity=0.0, ground=False)
    block = Simulation(spring, Barrier.rigid_wall(friction=0.0), 5.0, settings=free).run()
    assert max(np.abs(block.pitch).max(), np.abs(block.roll).max(), np.abs(block.yaw).max()) < 1e-6
    panels = [*block.plot().get_axes(), *block.plot_histories().get_axes()]
    angles = [axes for axes in panels if axes.get_title().startswith("Angles")]
    assert len(angles) == 2
    for axes in angles:
        low, high = axes.get_ylim()
        assert high - low >= 1.0


def test_legends_are_off_the_curves(oblique: Result, head_on: Result) -> None:
    for result in (oblique, head_on):
        for figure in (result.plot(), result.plot_histories(), result.plot_elements()):
            figure.savefig(BytesIO())
            titles = [axes.title.get_window_extent() for axes in figure.get_axes()]
            for axes in figure.get_axes():
                legend = axes.get_legend()
                if legend is None:
                    continue
                box = legend.get_window_extent()
                assert box.y0 >= axes.bbox.y1 - 1.0
                assert box.x1 <= figure.bbox.x1
                assert not any(one.height > 0 and box.overlaps(one) for one in titles)


def test_every_energy_has_a_colour_of_its_own(oblique: Result) -> None:
    names = [*oblique.energy, "barrier_ground_friction", "joints", "new term", "another"]
    looks = energy_look(names)
    assert len({color for color, *_ in looks.values()}) == len(names)


def test_curves_that_lie_on_each_other_are_told_apart() -> None:
    """In a panel no two lines share colour and style, and a later one is narrower or has gaps."""
    figure = Figure()
    axes = figure.subplots()
    prepare(axes)
    lines = [axes.plot([0.0, 1.0], [0.0, 1.0])[0] for _ in range(4)]
    assert len({(line.get_color(), str(line.get_linestyle())) for line in lines}) == 4
    for before, after in itertools.pairwise(lines):
        assert after.get_linewidth() < before.get_linewidth() or after.get_linestyle() != "-"
    assert all(line.is_dashed() for line in lines[1:])


def test_notebooks_show_figures(oblique: Result) -> None:
    figure = oblique.plot_crush()
    assert isinstance(figure, Figure)
    assert figure._repr_png_().startswith(b"\x89PNG")  # type: ignore[attr-defined]


# ---- elements ------------------------------------------------------------------------------------------


def test_loads_on_a_wall_are_those_about_its_line(oblique: Result) -> None:
    """The vehicle slides 5 m along an endless wall: what its foot is to that way is no height."""
    force, height, moment = oblique.plot_elements().get_axes()
    (load,) = oblique.element_loads
    assert load.line is not None
    expected = np.abs(cfc(load.moment, 60, load.interval) @ load.line) / 1e3
    assert np.array_equal(moment.get_lines()[0].get_ydata(), expected)
    assert 0.3 < np.nanmax(height.get_lines()[0].get_ydata()) < 1.5
    assert np.ptp(oblique.position[:, 1]) > 4.0
    assert force.texts[0].get_text().endswith("kN")


def test_loads_on_elements_end_and_have_peaks() -> None:
    car = Vehicle.preset("pickup", mesh_density=0.3)
    result = Simulation(car, Barrier.bollards(count=2, spacing=1.0), 12.0, duration=1.0).run()
    figure = result.plot_elements()
    force, _, moment = figure.get_axes()
    smooth = [
        np.linalg.norm(cfc(load.force, 60, load.interval), axis=1) / 1e3 for load in result.element_loads
    ]
    greatest = np.max(smooth, axis=0)
    last = result.time[np.flatnonzero(greatest > 0.01 * greatest.max())[-1]] * 1e3
    assert last < 500.0
    assert last <= force.get_xlim()[1] < 1.1 * last
    # The scene is symmetric: both posts have the same peak, written once.
    (text,) = force.texts
    assert text.get_text() in {f"bollard 1 and bollard 2: {post.max():,.0f} kN" for post in smooth}
    assert moment.texts[0].get_text().endswith("kN m")
    assert text.get_position()[1] > greatest.max()
    assert force.get_ylim()[1] > text.get_position()[1]


def test_many_elements_leave_the_panels_their_width() -> None:
    """The legend of nine segments was wider than the figure, which took the width from the panels."""
    car = Vehicle.preset("passenger_car", mesh_density=0.3)
    wall = Barrier.jersey(length=18.0, segments=24)
    result = Simulation(car, wall, 28.0, 20.0, impact_offset=-6.0, duration=0.8).run()
    touched = [load.name for load in result.element_loads if load.touched]
    assert len(touched) > 8
    figure = result.plot_elements()
    figure.savefig(BytesIO(), format="png")  # lays the panels out
    force, _, moment = figure.get_axes()
    assert force.get_position().width > 0.8
    legend = force.get_legend()
    assert legend is not None
    assert legend.get_window_extent().x1 <= figure.bbox.width
    for axes in (force, moment):
        boxes = [Text.get_window_extent(text) for text in axes.texts]  # without their lines
        assert len(boxes) == 3
        assert not any(a.overlaps(b) for i, a in enumerate(boxes) for b in boxes[:i])
    lines = force.get_lines()
    assert lines[0].get_color() == lines[8].get_color()
    assert lines[0].get_linestyle() != lines[8].get_linestyle()


@pytest.mark.parametrize(("first", "descend"), [(20.0, True), (80.0, False)])
def test_lines_to_peaks_cross_no_text(first: float, descend: bool) -> None:
    """Texts of early peaks go to the right and descend, those of late ones to the left and rise."""
    ms = np.linspace(0.0, 100.0, 1001)
    curves = [
        peak * np.exp(-(((ms - at) / 5.0) ** 2)) for at, peak in ((first, 2000.0), (first + 6.0, 900.0))
    ]
    axes = Figure().subplots()
    _mark_peaks(axes, ms, curves, ["bollard 1", "bollard 2"], 100.0, "kN")
    heights = [text.get_position()[1] for text in axes.texts]
    assert [text.get_text()[:9] for text in axes.texts] == ["bollard 1", "bollard 2"]
    assert (heights[0] > heights[1]) is descend


# ---- crush -----------------------------------------------------------------------------------------------


def test_crush_of_a_flat_front_is_the_truss_shortening() -> None:
    """Head-on, all trusses along r: the map is their deflection at the end, the same everywhere."""
    result = scenes.w2(64).run()
    expected = float(result.deflection.mean())
    field = crush_map(result)
    assert field.crush == pytest.approx(result.deflection, abs=1e-12)
    profile = crush_profile(result)
    assert profile.points == pytest.approx(expected, abs=1e-9)
    assert profile.mean == pytest.approx(expected, abs=1e-9)
    assert profile.width == pytest.approx(2.4)
    assert crushed_sides(result) == ("front",)
    with pytest.raises(ValueError, match="skin on, got 'left'"):
        crush_map(result, "left")


def test_six_points(head_on: Result) -> None:
    profile = crush_profile(head_on)
    assert np.diff(profile.stations) == pytest.approx(-profile.width / 5.0)
    assert profile.stations[0] > 0.0  # C1 is at the vehicle's left
    # A symmetric crash has a symmetric profile; weights 1/2 at the ends.
    assert profile.points == pytest.approx(profile.points[::-1], abs=1e-6)
    c = profile.points
    assert profile.mean == pytest.approx((c[0] / 2 + c[1] + c[2] + c[3] + c[4] + c[5] / 2) / 5)
    vehicle = head_on.scene.vehicle
    bumper = vehicle.nodes[vehicle.zone_of_node == list(vehicle.zones).index("bumper"), 2]
    middle = 0.5 * (bumper.min() + bumper.max()) + vehicle.mass_center_height
    assert profile.height == pytest.approx(middle, abs=0.05)
    assert profile.crush.max() <= head_on.metrics["residual_crush"] + 1e-9


def test_crush_is_on_the_struck_side(oblique: Result) -> None:
    """The wall is on the right: it crushes the right and the right half of the front."""
    sides = crushed_sides(oblique)
    assert sides[:2] == ("right", "front")
    assert "left" not in sides
    profile = crush_profile(oblique, "front")
    assert profile.points[5] > 0.05
    assert profile.points[0] < 0.01
    right = crush_profile(oblique, "right")
    assert right.stations[0] < 0.0 < right.stations[5]  # C1 is at the rear


def test_crush_figure_shows_the_struck_side(oblique: Result, head_on: Result) -> None:
    for result, side in ((oblique, "right"), (head_on, "front")):
        assert f"crush of the {side}" in result.plot_crush().get_axes()[0].get_title()
        assert crush_profile(result).side == side
    car = Vehicle.preset("passenger_car", mesh_density=0.2)
    side_impact = Simulation(car, Barrier.pole(), 9.0, impact_yaw=90.0).run()
    struck = crush_map(side_impact).side
    assert struck in ("left", "right")
    assert crushed_sides(side_impact)[0] == struck


def test_hidden_faces_are_not_in_the_crush_map() -> None:
    """The front of a truck's box behind its cab: triangles of the map do not lie over each other."""
    result = Simulation(Vehicle.preset("cargo_truck"), None, 10.0, duration=0.01).run()
    field = crush_map(result, "front")
    (shape,) = unit_shapes(result.scene.vehicle)
    outwards = shape.nodes[field.triangles, 0].mean(axis=1)
    assert (np.diff(outwards) >= 0.0).all()  # the outermost is drawn last
    plane = shape.nodes[field.triangles][:, :, [1, 2]]
    polygons = shapely.polygons(plane)
    # Only those that are half hidden overlap; with the hidden ones it would be a third.
    covered = shapely.union_all(polygons).area
    assert shapely.area(polygons).sum() < 1.09 * covered


def test_bad_sides_and_heights(head_on: Result) -> None:
    with pytest.raises(ValueError, match=r"side must be one of front.*'top'"):
        head_on.plot_crush("top")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"height must be between .* got 5"):
        head_on.plot_crush("front", height=5.0)


def test_labels_of_a_crush_figure_are_within_it() -> None:
    """The map has equal scales and is narrower than its place; the profile below has longer numbers."""
    car = Vehicle.preset("passenger_car", mesh_density=0.2)
    figure = Simulation(car, Barrier.bollards(count=1), 17.9).run().plot_crush("front")
    FigureCanvasAgg(figure).draw()
    assert min(axes.get_tightbbox().x0 for axes in figure.get_axes()) >= 0.0


def test_crush_figure(head_on: Result) -> None:
    above, below, bar = head_on.plot_crush().get_axes()
    assert above.get_xlim() == below.get_xlim()
    assert above.get_xlim()[0] > above.get_xlim()[1]  # left is left
    assert bar.get_ylabel() == "residual crush [m]"
    texts = [text.get_text() for text in below.texts]
    assert [text.split("\n")[0] for text in texts] == ["C1", "C2", "C3", "C4", "C5", "C6"]
    assert texts[2].endswith(f"{crush_profile(head_on).points[2] * 1e3:.0f} mm")
    assert "front" in above.get_title()


def test_crush_figure_of_a_sound_side(head_on: Result) -> None:
    above, *_ = head_on.plot_crush("rear").get_axes()
    assert "greatest 0.000 m" in above.get_title()


# ---- barriers --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("barrier", "volume"),
    [
        (Barrier.rigid_wall(width=3.0, height=1.2, heading=25.0, origin=(1.0, 2.0, 0.1)), 3.0 * 1.2 * 0.5),
        (Barrier.pole(diameter=0.5, origin=(1.0, 0.0, 0.0)), np.pi * 0.25**2 * 1.8),
    ],
)
def test_surfaces_are_closed_and_look_outwards(barrier: Barrier, volume: float) -> None:
    ((vertices, faces),) = barrier_surfaces(barrier, [[0.0, 0.0, 1.5]])
    edges = np.vstack([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    there = {tuple(edge) for edge in edges.tolist()}
    assert len(there) == len(edges)
    assert all((b, a) in there for a, b in there)
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    # The pole is a polygon of 48 sides: 0.3 % less.
    assert np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0 == pytest.approx(volume, rel=4e-3)


def test_walls_stand_where_the_model_has_them() -> None:
    around = np.array([[-3.0, -4.0, 0.0], [-1.0, 6.0, 1.4]])
    ((vertices, _),) = barrier_surfaces(Barrier.rigid_wall(), around)
    assert vertices[:, 0].max() > 0.0 == vertices[:, 0].min()
    assert (vertices[:, 1].min(), vertices[:, 1].max()) == (-5.0, 7.0)
    assert vertices[:, 2].max() == pytest.approx(1.7)
    ((vertices, _),) = barrier_surfaces(Barrier.rigid_wall(width=2.0, height=0.8), around)
    assert (vertices[:, 1].min(), vertices[:, 1].max(), vertices[:, 2].max()) == (-1.0, 1.0, 0.8)
    assert barrier_surfaces(None, around) == []


# ---- comparisons -----------------------------------------------------------------------------------------


def test_panels_of_comparisons(head_on: Result) -> None:
    force = Channel("wall", head_on.time, head_on.barrier_normal_force, "N")
    other = Channel("model", head_on.time, 1.1 * head_on.barrier_normal_force, "N")
    comparison = compare_curves(force, other)
    figure = plot_comparisons([comparison] * 3)
    panels = figure.get_axes()
    assert len(panels) == 4
    assert [axes.get_visible() for axes in panels] == [True, True, True, False]
    assert "measured: wall" in names(panels[0])
    assert "Sprague-Geers" in panels[0].get_title()
    assert panels[2].get_xlabel() == "time [ms]"
    for arguments, message in ((([],), "at least one"), (([comparison], 0), "columns must be")):
        with pytest.raises(ValueError, match=message):
            plot_comparisons(*arguments)  # type: ignore[arg-type]


def test_histories_end_where_a_run_gets_calm() -> None:
    """A car at rest has nothing to show: the axis ends after the event, and says when the run did."""
    car = Vehicle.preset("passenger_car", mesh_density=0.1)
    short = Simulation(car, Barrier.rigid_wall(), 15.0, duration=0.2).run()
    long = Simulation(car, Barrier.rigid_wall(), 15.0, duration=3.0).run()
    for plot in (Result.plot_histories, Result.plot):
        assert plot(short).axes[-1].get_xlim() == pytest.approx((0.0, short.time[-1] * 1e3))
        panels = plot(long).axes
        assert "time [ms]; calm until the run ends at 3,000 ms" in [one.get_xlabel() for one in panels]
        assert all(one.get_xlim()[1] < 1800.0 for one in panels)
