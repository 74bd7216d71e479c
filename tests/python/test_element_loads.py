"""Loads on the elements of a barrier: what they add up to, where they act, and that they mirror."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import birm3d
import numpy as np
import pytest
from birm3d import Barrier, Result, Settings, Simulation, Vehicle
from birm3d.filters import cfc
from birm3d.result.element_loads import LEAST_SHARE, ElementLoad, resultant_height
from birm3d.result.summary import ELEMENT_COLUMNS, element_rows

FREE = Settings(gravity=0.0, ground=False)


def car() -> Vehicle:
    return Vehicle.preset("passenger_car", mesh_density=0.3)


@pytest.fixture(scope="module")
def row() -> Result:
    """Two bollards hit off the car's centre."""
    return Simulation(car(), Barrier.bollards(friction=0.3), 12.0, 70.0, 0.35).run()


@pytest.mark.parametrize(
    "barrier",
    [
        Barrier.bollards(count=4, spacing=0.9, rows=2, row_spacing=1.0, row_offset=0.45),
        Barrier.jersey(length=6.0, segments=4),
        Barrier.rigid_wall(width=4.0, height=1.5, segments=3),
        Barrier.rigid_wall(),
        Barrier.pole(),
    ],
    ids=lambda barrier: type(barrier).__name__,
)
@pytest.mark.parametrize("angle", [25.0, 90.0])
def test_elements_carry_the_force_on_the_vehicle(barrier: Barrier, angle: float) -> None:
    result = Simulation(car(), barrier, 15.0, angle).run()
    loads = result.element_loads
    assert [load.name for load in loads] == list(barrier.element_names)
    assert len(loads) == (barrier.segments if hasattr(barrier, "segments") else len(barrier.elements()))
    assert any(load.touched for load in loads)
    total = sum(load.force for load in loads)
    scale = np.abs(result.barrier_force).max()
    # Both are sums of the same forces in another order.
    assert np.abs(total + result.barrier_force).max() <= 1e-9 * scale
    for load in loads:
        assert load.force.shape == load.moment.shape == (len(result.time), 3)
        assert np.isfinite(load.resultant_height).all()
        assert not load.force.flags.writeable


def one_node(height: float, mass: float = 1000.0) -> Vehicle:
    """One truss along r, its line through the mass centre: it neither pitches nor yaws."""
    return Vehicle.from_arrays(
        mass=mass,
        inertia=mass * np.eye(3),
        nodes=[[1.0, 0.0, 0.0]],
        anchors=[[0.0, 0.0, 0.0]],
        k_initial=1e6,
        k_unloading=1e6,
        mass_center_height=height,
    )


@pytest.mark.parametrize("height", [0.3, 0.8])
@pytest.mark.parametrize(
    ("barrier", "reach"),
    [
        (Barrier.bollards(count=3, spacing=2.0, diameter=0.3, friction=0.0), 0.15),
        (Barrier.rigid_wall(width=6.0, segments=3, friction=0.0), 0.0),
        (Barrier.pole(heading=30.0, origin=(2.0, -1.0, 0.0), friction=0.0), 0.15),
    ],
    ids=["bollards", "wall", "pole"],
)
def test_a_force_at_a_known_height(barrier: Barrier, reach: float, height: float) -> None:
    """Head-on and without friction: the moment about the foot is height times force, about y at heading 0."""
    result = Simulation(one_node(height), barrier, 5.0, 90.0, barrier.station(), settings=FREE).run()
    (load,) = [load for load in result.element_loads if load.touched]
    if len(result.element_loads) == 3:
        assert load.index == 1
    angle = np.radians(barrier.heading)
    into, across = (
        np.array([np.cos(angle), np.sin(angle), 0.0]),
        np.array([-np.sin(angle), np.cos(angle), 0.0]),
    )
    force = load.force @ into
    peak = force.max()
    # v sqrt(k m), the spring's greatest force, less what a mean over 0.1 ms takes off the crest.
    assert peak == pytest.approx(5.0 * np.sqrt(1e6 * 1000.0), rel=2e-3)
    assert np.abs(load.moment @ across - height * force).max() <= 1e-9 * peak
    assert np.abs(load.moment[:, 2]).max() <= 1e-9 * peak
    pressed = force > LEAST_SHARE * peak
    assert load.resultant_height[pressed] == pytest.approx(height, rel=1e-9)
    assert (load.resultant_height[force == 0.0] == 0.0).all()
    assert load.overturning_moment == pytest.approx(height * force, abs=1e-9 * peak)
    assert load.peak_force == pytest.approx(peak, rel=1e-12)
    assert load.height_at_peak == pytest.approx(height, rel=1e-9)
    assert load.peak_overturning_moment_50ms == pytest.approx(height * load.peak_force_50ms, rel=1e-9)

    assert result.metrics["vehicle_penetration"] == 0.0


def test_the_force_is_carried_by_the_element_it_is_aimed_at() -> None:
    barrier = Barrier.bollards(count=3, spacing=2.0, friction=0.0)
    for offset, hit in ((-2.0, 0), (0.0, 1), (2.0, 2)):
        loads = Simulation(one_node(0.5), barrier, 5.0, 90.0, offset, settings=FREE).run().element_loads
        assert [load.index for load in loads if load.touched] == [hit]
        for load in loads:
            if load.index != hit:
                assert load.peak_force == load.peak_overturning_moment == load.height_at_peak == 0.0


def test_height_of_what_does_not_push() -> None:
    force = np.array([[0.0, 0.0, 5.0], [1e-3, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 0.0]])
    moment = np.cross([0.0, 0.0, 0.7], force)
    moment[:, 2] += 3.0  # a twist has no height
    assert resultant_height(force, moment).tolist() == [0.0, 0.0, pytest.approx(0.7), 0.0]
    assert resultant_height(np.zeros((3, 3)), np.ones((3, 3))).tolist() == [0.0] * 3
    assert resultant_height(force, -moment).tolist() == [0.0] * 4  # below the ground there is none


def test_a_force_that_is_mostly_weight_has_no_height() -> None:
    """A truck that lay on a barrier of 1.07 m once had its 277 kN of weight and 56 kN at 11.6 m."""
    pushed = np.full((1000, 3), [0.0, 0.0, -20e3])
    pushed[:500, 0] = 100e3  # then it lies on the top
    pushed[500:, 0] = 15e3
    moment = np.cross([0.3, 0.0, 0.6], pushed)
    load = ElementLoad(0, "wall", pushed, moment, 1e-4, np.array([0.0, 1.0, 0.0]))
    assert load.resultant_height[:500] == pytest.approx(0.6 + 0.3 * 20e3 / 100e3)
    assert not load.resultant_height[500:].any()
    lies = ElementLoad(0, "wall", pushed[500:], moment[500:], 1e-4, np.array([0.0, 1.0, 0.0]))
    assert lies.height_at_peak == 0.0


def test_a_blow_within_one_row_leaves_the_heights_of_the_others() -> None:
    """Of the unfiltered peak of 102 MN a hundredth is more than all the rest of the crash has."""
    force = np.zeros((2000, 3))
    force[100:1500, 0] = 400e3
    force[700, 0] = 102e6
    moment = np.cross([0.0, 0.0, 0.5], force)
    for line in (None, np.array([0.0, 1.0, 0.0])):
        load = ElementLoad(0, "bollard", force, moment, 1e-4, line)
        assert load.resultant_height[100:1500] == pytest.approx(0.5)
        assert not load.resultant_height[1500:].any()


def test_a_mirrored_scene_mirrors(row: Result) -> None:
    """Path from the other side, offset to the other side: y changes its sign, posts change places."""
    barrier, brief = row.scene.barrier, 0.06  # s: later, nodes that slip and stick let rounding grow
    here, there = (
        Simulation(car(), barrier, 12.0, angle, offset, duration=brief).run().element_loads
        for angle, offset in ((70.0, 0.35), (110.0, -0.35))
    )
    scale = max(load.peak_force for load in here)
    assert [load.touched for load in here] == [load.touched for load in there][::-1]
    assert scale > 1e5
    mirror = np.array([1.0, -1.0, 1.0])
    for one, other in zip(here, there[::-1], strict=True):
        # The same sums in mirrored order; a moment is an axial vector.
        assert np.abs(other.force - mirror * one.force).max() <= 1e-9 * scale
        assert np.abs(other.moment + mirror * one.moment).max() <= 1e-9 * scale


def test_metrics_are_the_greatest_of_all(row: Result) -> None:
    for metric, name in (
        ("peak_element_force", "peak_force"),
        ("peak_element_force_50ms", "peak_force_50ms"),
        ("peak_overturning_moment", "peak_overturning_moment"),
        ("peak_overturning_moment_50ms", "peak_overturning_moment_50ms"),
    ):
        values = [getattr(load, name) for load in row.element_loads]
        # The core and NumPy round the length of a vector differently, in its last digit.
        assert row.metrics[metric] == pytest.approx(max(values), rel=1e-14)
        assert max(values) > 0.0


def test_tables_name_the_elements_that_were_touched(row: Result) -> None:
    touched = [load for load in row.element_loads if load.touched]
    assert 0 < len(touched) < len(row.element_loads)
    table = row.to_dataframe()
    for load in row.element_loads:
        columns = [name for name in table if str(name).startswith(f"{load.name}:")]
        assert len(columns) == (7 if load.touched else 0)
        assert (f"  {load.name}: " in row.report()) == load.touched
    force = table[f"{touched[0].name}: force_x [N]"].to_numpy()
    assert np.array_equal(force, touched[0].force[:, 0])


def test_files_keep_them(row: Result, tmp_path: Path) -> None:
    row.save(tmp_path / "row.npz")
    loaded = birm3d.load(tmp_path / "row.npz")
    for here, there in zip(row.element_loads, loaded.element_loads, strict=True):
        assert (here.name, here.index, here.interval) == (there.name, there.index, there.interval)
        assert here.force.tobytes() == there.force.tobytes()
        assert here.moment.tobytes() == there.moment.tobytes()
    with np.load(tmp_path / "row.npz") as file:
        touched = {name.split("/")[2] for name in file.files if name.startswith("history/element/")}
    assert touched == {str(load.index) for load in row.element_loads if load.touched}


def test_plot(row: Result) -> None:
    panels = row.plot_elements().get_axes()
    touched = [load for load in row.element_loads if load.touched]
    assert [len(axes.get_lines()) for axes in panels] == [len(touched)] * 3
    assert [line.get_label() for line in panels[0].get_lines()] == [load.name for load in touched]
    assert "CFC 60" in panels[0].get_title()
    heights = np.concatenate([np.asarray(line.get_ydata(), float) for line in panels[1].get_lines()])
    seen = heights[np.isfinite(heights)]
    assert len(seen) > 10
    assert 0.0 < np.median(seen) < 1.0  # the car's front meets posts of 1 m


def test_without_a_touch_or_a_barrier(spring_body: Callable[..., Vehicle]) -> None:
    body = spring_body(1000.0, 1e6, 1.0)
    missed = Simulation(body, Barrier.bollards(count=1), 5.0, 90.0, 3.0, duration=0.1, settings=FREE).run()
    alone = Simulation(body, None, 5.0, duration=0.1, settings=FREE).run()
    assert alone.element_loads == ()
    assert [load.touched for load in missed.element_loads] == [False]
    assert missed.metrics["peak_element_force"] == 0.0
    assert "peak_element_force" not in alone.metrics
    for result in (missed, alone):
        with pytest.raises(ValueError, match="elements must have been touched"):
            result.plot_elements()


def test_peaks_are_shown_after_cfc_60(row: Result) -> None:
    """An unfiltered peak of one output interval says nothing of a load; tables have the filtered one."""
    for load in row.element_loads:
        if not load.touched:
            continue
        smooth = np.column_stack([cfc(load.force[:, i], 60, load.interval) for i in range(3)])
        assert load.peak_force_cfc60 == pytest.approx(np.sqrt((smooth**2).sum(axis=1)).max(), rel=1e-12)
    touched = [load for load in row.element_loads if load.touched]
    shown = {
        cells[0]: cells[ELEMENT_COLUMNS.index("whole force, peak, CFC 60 [kN]")]
        for cells in element_rows(row)
    }
    assert shown == {load.name: f"{load.peak_force_cfc60 / 1e3:.0f}" for load in touched}
