"""Measured load cells: read with their places, and laid beside a computed load map."""

from __future__ import annotations

import csv
import re
from pathlib import Path
from typing import Any

import birm3d
import numpy as np
import pytest
from birm3d import Barrier, Channel, LoadMap, Result, Simulation, Vehicle

LATERAL = np.array([-1.0, -0.4, 0.0, 0.5, 1.1])  # 4 columns, no two alike
HEIGHT = np.array([0.1, 0.35, 0.55, 0.95])  # 3 rows
ROWS, COLUMNS = len(HEIGHT) - 1, len(LATERAL) - 1
LENGTH = 0.1  # s
TIME = np.arange(-200, 2001) * 1e-4
PEAKS = 1e3 * (
    10.0 + np.arange(ROWS * COLUMNS, dtype=float).reshape(ROWS, COLUMNS) ** 1.5
)  # N, of row, column
GRID: dict[str, Any] = {"lateral": LATERAL, "height": HEIGHT}


def half_sine(peak: float, begin: float = 0.0) -> np.ndarray:
    within = (begin <= TIME) & (begin + LENGTH >= TIME)
    return np.asarray(peak * np.sin(np.pi * (TIME - begin) / LENGTH) * within)


def cell_name(row: int, column: int) -> str:
    """Of the cell in the load map's order: A is the lowest row, 1 the column on the left."""
    return f"{'ABC'[row]}{COLUMNS - column}"


def channels(peaks: np.ndarray = PEAKS, begin: float = 0.0, cfc: float | None = None) -> dict[str, Channel]:
    return {
        cell_name(*place): Channel(
            cell_name(*place), TIME, half_sine(float(peaks[place]), begin) / 1e3, "kN", cfc
        )
        for place in np.ndindex(ROWS, COLUMNS)
    }


def write(path: Path, columns: dict[str, np.ndarray], head: str = "time [ms]", shift: float = 0.0) -> Path:
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow([head, *columns])
        writer.writerows(zip(1e3 * (TIME + shift), *columns.values(), strict=True))
    return path


# ---- reading -----------------------------------------------------------------------------------------------


NAMES = (
    *("{letter}{column}", "{letter}0{column}", "LC {letter}_{column}", "R{row}C{column}"),
    *("wall row {row} col {column}", "cell r0{row}-c0{column}"),
)


@pytest.mark.parametrize("naming", NAMES)
def test_cells_are_where_their_names_say(tmp_path: Path, naming: str) -> None:
    """Half sines of known peaks: impulse 2 A T / pi, in the cell that row and column name."""
    table = {}
    for row, column in np.ndindex(ROWS, COLUMNS):
        name = naming.format(letter="ABC"[row], row=row + 1, column=COLUMNS - column)
        table[f"{name} [kN]"] = half_sine(PEAKS[row, column]) / 1e3
    table["total [kN]"] = sum(table.values())
    table["sled x [g]"] = TIME
    test = birm3d.read_load_cells(write(tmp_path / "wall.csv", table), **GRID)
    assert test.force.shape == (len(TIME), ROWS, COLUMNS)
    assert test.impulse == pytest.approx(2.0 * PEAKS * LENGTH / np.pi, rel=1e-4)
    assert test.peak == pytest.approx(PEAKS, rel=2e-3)
    assert test.time == pytest.approx(TIME, abs=1e-9)
    assert test.resultant == pytest.approx(half_sine(PEAKS.sum()), abs=1e-3 * PEAKS.sum())
    assert test.at("50 ms") == pytest.approx(PEAKS, rel=1e-3)
    assert np.array_equal(test.lateral, LATERAL)
    assert test.title == "wall.csv"


def test_first_row_first_column_and_time_zero(tmp_path: Path) -> None:
    """Row A on top, column 1 on the right; the file's clock reads 0.5 s at the first contact."""
    table = {
        f"{'ABC'[ROWS - 1 - row]}{column + 1} [kN]": half_sine(PEAKS[row, column]) / 1e3
        for row, column in np.ndindex(ROWS, COLUMNS)
    }
    path = write(tmp_path / "wall.csv", table, shift=0.5)
    test = birm3d.read_load_cells(path, **GRID, first_row="top", first_column="right", time_zero="500 ms")
    assert test.impulse == pytest.approx(2.0 * PEAKS * LENGTH / np.pi, rel=1e-4)
    assert test.time[[0, -1]] == pytest.approx(TIME[[0, -1]], abs=1e-9)


def test_the_class_of_the_cells_is_not_filtered_twice() -> None:
    """A pulse of 10 ms loses a part of its peak in CFC 60, and loses it once."""
    raw = {name: one.with_values(np.where(TIME < 0.01, one.values, 0.0)) for name, one in channels().items()}
    once = birm3d.measured_load_map(raw, **GRID)
    filtered = birm3d.measured_load_map({name: one.filtered(60) for name, one in raw.items()}, **GRID)
    assert filtered.cfc == 60.0
    assert filtered.peak == pytest.approx(once.peak, rel=1e-9)
    assert once.peak.max() < 0.95 * once.force.max()


@pytest.mark.parametrize(
    ("change", "options", "message"),
    [
        (lambda c: c.pop("B3"), {}, "a force of each of the 3 x 4 cells .* A1 to C4; got none of B3"),
        (lambda c: c.clear(), {}, "got none of A1, A2, .* and 4 more"),
        (lambda c: c.update(D1=c["A1"]), {}, r"channels must be of the 3 x 4 cells .*; got 'D1'"),
        (lambda c: c.update(A5=c["A1"]), {}, r"got 'A5'"),
        (lambda c: c.update(R1C1=c["A1"]), {}, "must have one of each cell, got 'A1' and 'R1C1'"),
        (lambda c: c.update(B2=c["B2"].shifted(1e-3)), {}, "must have the same instants, got others in 'B2'"),
        (lambda c: c.update(B1=c["B1"].filtered(180)), {}, "must have one cfc, got None of 'A1' and 180"),
        (lambda c: c.update({k: v.filtered(30) for k, v in c.items()}), {}, "cfc must be at least 60"),
        (lambda c: c.update({k: v.flipped() for k, v in c.items()}), {}, "must be positive .* -.* kN s"),
        (lambda c: c.update({k: v.shifted(0.02) for k, v in c.items()}), {},
         r"time_zero must be the first contact, with at most 2% .* got [\d.]+ of [\d.]+ kN s"),
        (lambda c: None, {"time_zero": 0.3}, r"time_zero must be within the record, -0.02 to 0.2 s, got 0.3"),
        (lambda c: None, {"first_row": "up"}, "first_row must be 'bottom' or 'top', got 'up'"),
        (lambda c: None, {"first_column": "east"}, "first_column must be 'left' or 'right', got 'east'"),
        (lambda c: None, {"height": [0.0, 0.0]}, "height must have at least 2 edges that increase"),
        (lambda c: None, {"height": HEIGHT[:-1]}, "must be of the 2 x 4 cells .*; got 'C"),
    ],
)  # fmt: skip
def test_what_is_no_wall_is_refused(change: Any, options: dict[str, Any], message: str) -> None:
    cells = channels()
    change(cells)
    with pytest.raises(ValueError, match=message):
        birm3d.measured_load_map(cells, **{**GRID, **options})


# ---- beside a computed map ---------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def result() -> Result:
    car = Vehicle.preset("passenger_car", mesh_density=0.3)
    return Simulation(car, Barrier.rigid_wall(), 15.0, standoff=0.3).run()


@pytest.fixture(scope="module")
def computed(result: Result) -> LoadMap:
    return result.load_map(lateral=np.linspace(-1.25, 1.25, 11), height=[0.0, 0.25, 0.5, 0.75, 1.0, 1.25])


def as_measured(map_: LoadMap, share: float = 1.0, columns: int = 0, before: int = 100) -> LoadMap:
    """What a wall would record of a computed map, moved by columns to the left, with time before contact."""
    rows, n = map_.impulse.shape[0], map_.impulse.shape[1]
    force = np.roll(map_.force, columns, axis=2)
    first = round(map_.first_contact / map_.interval)
    time = np.arange(-before, len(map_.time) - first) * map_.interval
    table = {}
    for i, j in np.ndindex(rows, n):
        values = np.concatenate([np.zeros(before), force[first:, i, j]])
        table[f"{'ABCDE'[i]}{n - j}"] = Channel("cell", time, share * values / 1e3, "kN")
    return birm3d.measured_load_map(table, lateral=map_.lateral, height=map_.height, title="test 7")


def test_a_map_beside_itself_shows_no_difference(result: Result, computed: LoadMap) -> None:
    """The computed car begins 0.3 m before the wall, the record 10 ms before the contact."""
    assert computed.first_contact == pytest.approx(0.3 / 15.0, abs=2e-3)
    both = birm3d.compare_load_maps(as_measured(computed), computed)
    for quantity in ("impulse", "peak", "peak_50ms"):
        scale = both.values(quantity)[0].max()
        assert np.abs(both.difference(quantity)).max() < 1e-9 * scale
    assert both.share_elsewhere < 1e-9
    # What the wall gets is the change of the car's momentum.
    car = result.scene.vehicle
    assert both.computed.impulse.sum() == pytest.approx(car.mass * (15.0 - result.velocity[-1, 0]), rel=0.01)


def test_a_wall_that_reads_less_and_one_that_stands_aside(computed: LoadMap) -> None:
    """Four fifths of the force: a quarter too much computed. A column to the left: 0.25 m too far right."""
    low = birm3d.compare_load_maps(as_measured(computed, 0.8), computed)
    assert low.difference() == pytest.approx(0.2 * computed.impulse, abs=1e-6)
    assert low.share_elsewhere < 1e-9
    assert re.search(r"impulse \[kN s\] .* \+25.0%", str(low))
    assert re.search(r"peak of the sum, CFC 60 \[kN\] .* \+25.0%", str(low))
    aside = birm3d.compare_load_maps(as_measured(computed, columns=1), computed)
    assert computed.impulse[:, -1].sum() < 1e-9 * computed.impulse.sum()  # so that none goes round
    assert re.search(r"average place along \[m\] .* -0.250 m", str(aside))
    share = (
        0.5 * np.abs(np.roll(computed.impulse, 1, axis=1) - computed.impulse).sum() / computed.impulse.sum()
    )
    assert aside.share_elsewhere == pytest.approx(share, rel=1e-9)
    assert re.search(r"average height of force \[m\] .* [-+]0.000 m", str(aside))


def test_impulses_count_until_the_end_of_both(computed: LoadMap) -> None:
    measured = as_measured(computed)
    both = birm3d.compare_load_maps(measured, computed, end="40 ms")
    rows = (computed.time - computed.first_contact <= 0.04 + 1e-9) & (computed.time > 0.0)
    own = computed.force[rows].sum(axis=0) * computed.interval
    assert both.computed.impulse == pytest.approx(own, rel=1e-9)
    assert both.measured.impulse == pytest.approx(own, rel=1e-9, abs=1e-9)
    assert own.sum() < 0.9 * computed.impulse.sum()
    assert "until 40 ms after the first contact" in both.summary()


def test_files_and_pictures(computed: LoadMap, tmp_path: Path) -> None:
    both = birm3d.compare_load_maps(as_measured(computed, 0.8), computed)
    both.to_csv(tmp_path / "both.csv")
    with (tmp_path / "both.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == computed.impulse.size
    sums = [sum(float(row[f"{role} impulse [N s]"]) for row in rows) for role in ("measured", "computed")]
    assert sums[1] == pytest.approx(computed.impulse.sum())
    assert sums[0] == pytest.approx(0.8 * sums[1])
    figure = both.plot()
    measured, other, apart, force = figure.axes[:4]
    # One scale for both maps, another with zero in its middle for the difference.
    limits = [axes.collections[0].get_clim() for axes in (measured, other, apart)]
    assert limits[0] == limits[1] == pytest.approx((0.0, computed.impulse.max() / 1e3), rel=1e-9)
    assert limits[2] == pytest.approx((-0.2 * limits[0][1], 0.2 * limits[0][1]), rel=1e-6)
    shown = np.asarray(apart.collections[0].get_array()).reshape(computed.impulse.shape)
    assert shown == pytest.approx(0.2 * computed.impulse / 1e3, abs=1e-9)
    for axes in (measured, other, apart):
        assert axes.get_xlim()[0] > axes.get_xlim()[1]  # y runs to the left
    low, high = (np.asarray(line.get_ydata(), float) for line in force.get_lines())
    assert low.max() == pytest.approx(0.8 * high.max(), rel=1e-6)
    assert "Measured: test 7" in figure.get_suptitle()
    assert "kN" in both.plot("peak").axes[4].get_ylabel()
    assert "<img" in both._repr_html_()
    with pytest.raises(ValueError, match="quantity must be one of impulse, peak, peak_50ms; got 'force'"):
        both.plot("force")


def test_numbers_fit_their_cells(tmp_path: Path) -> None:
    """The wall of 8 x 16 cells of 125 mm of frontal tests: no number is wider than its cell."""
    time = np.arange(600) * 1e-4
    shape = (len(time), 8, 16)
    lateral, height = np.linspace(-1.0, 1.0, 17), np.linspace(0.05, 1.05, 9)
    force = np.broadcast_to(half_sine(1.0)[200:800, None, None], shape)
    share = np.random.default_rng(0).uniform(0.2, 1.0, (2, 8, 16))
    one, other = (
        LoadMap(time, lateral, height, 1.5e4 * s * force, np.zeros(len(time)), "A scene", None, 0.0)
        for s in share
    )
    figure = birm3d.compare_load_maps(one, other).plot()
    figure.savefig(tmp_path / "both.png")
    for axes in figure.axes[:3]:
        cell = axes.get_window_extent().width / 16.0
        widths = [text.get_window_extent().width for text in axes.texts]
        assert len(widths) > 64
        assert max(widths) <= cell


@pytest.mark.parametrize(
    ("grid", "message"),
    [
        ({"height": [0.0, 0.25, 0.5, 0.75, 1.0]}, "height of computed must have the edges .* 6 .* got 5"),
        ({"lateral": np.linspace(-1.25, 1.25, 11) + 0.01}, "lateral of computed .* up to 0.01 m apart"),
        ({"lateral": np.linspace(-1.0, 1.0, 5)}, "got 5 from -1 to 1 m; Result.load_map takes them"),
    ],
)  # fmt: skip
def test_grids_that_differ_are_refused(
    result: Result, computed: LoadMap, grid: dict[str, Any], message: str
) -> None:
    other = result.load_map(**{"lateral": computed.lateral, "height": computed.height, **grid})
    with pytest.raises(ValueError, match=message):
        birm3d.compare_load_maps(as_measured(computed), other)


def test_maps_that_can_not_be_compared_are_refused(computed: LoadMap) -> None:
    measured = as_measured(computed)
    with pytest.raises(ValueError, match=r"end must be > 0 and within both records, .* got 9 s"):
        birm3d.compare_load_maps(measured, computed, end=9.0)
    with pytest.raises(ValueError, match=r"measured must press on the cells until .* 0 N s"):
        birm3d.compare_load_maps(as_measured(computed, 0.0), computed)
    slow = slice(None, None, 20)
    coarse = LoadMap(
        computed.time[slow], computed.lateral, computed.height, computed.force[slow],
        computed.outside[slow], "a scene",
    )  # fmt: skip
    with pytest.raises(ValueError, match=r"computed must have rows at most 0.00167 s apart .* got 0.002 s"):
        birm3d.compare_load_maps(measured, coarse)
