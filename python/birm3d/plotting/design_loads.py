"""Figure of the design loads of a barrier."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..assessment.element_design import degrees_between, design_direction
from ..assessment.oscillator import LEAST_INTERVALS
from ..result.element_loads import overturning
from ..signals.filters import moving_average
from .blows import name_cut_peaks, readable_level
from .figure import new_figure
from .style import BLUE, DASH_DOT, DASHED, GREEN, ORANGE, RED, filtered, legend, prepare, wrapped

if TYPE_CHECKING:
    from ..assessment.design_table import DesignLoad
    from ..assessment.element_design import ElementDesign
    from ..result.element_loads import ElementLoad

__all__ = ["plot_design_load"]

Floats = npt.NDArray[np.float64]

_MOST_BARS = 12
_PERIODS = (0.005, 2.0)  # the spectrum's, s
_POINTS, _SOFT_POINTS = 240, 20  # points of the elastic spectrum, and of the ductile one, which is slow
# A history is drawn until it stays below this share of its peak, and on to this factor of that instant.
_LOAD_SHARE, _ROOM = 0.01, 1.08


def plot_design_load(loads: DesignLoad) -> Figure:
    """Return loads by element, force and moment of the governing one, and its response spectrum.

    The governing element has the greatest design value of the equivalent static force. Its histories are
    those of the vehicle and scene that its own force comes from; a value of the table from another scene
    stands in the legend. Unfiltered lines are thin. A blow of a few milliseconds that would flatten the rest
    is cut off, and its peak is written beside it. At most 12 elements are drawn, the most loaded ones.

    Raises
    ------
    ValueError
        If no element was touched.
    """
    row = loads.governing
    if row.load is None:
        raise ValueError("elements must have been touched to be drawn, got none that was")
    figure = new_figure(11.0, 7.6)
    (bars, force), (moment, spectrum) = figure.subplots(2, 2)
    prepare(bars, force, moment, spectrum)
    _bars(bars, loads)
    end = _end_of_load(row.load)
    direction = design_direction(row.load, loads.normal)
    degrees = degrees_between(loads.normal, direction)
    for axes in (force, moment):
        axes.set_xlim(0.0, end)
    of_other = {
        name: f"in scene {row.scene[name]}"
        for name in ("force_50ms", "moment", "equivalent_static_moment")
        if row.scene[name] != _scene(row)
    }
    _force(force, row, row.load.force @ direction, row.load.interval, degrees, of_other.get("force_50ms"))
    _moment(moment, row, row.load, of_other)
    for axes in (force, moment):
        axes.set_xlabel("time [ms]")
    _spectrum(spectrum, loads, row)
    for axes in (bars, force, moment, spectrum):
        legend([axes])
    scene = "" if len(loads.scenes) == 1 else f"\nhistories of {loads.scenes[_scene(row)]}"
    figure.suptitle(wrapped(f"{loads.title}{scene}", figure), fontsize="medium")
    return figure


def _scene(row: ElementDesign) -> int:
    return row.scene["equivalent_static_force"]


def _bars(axes: Axes, loads: DesignLoad) -> None:
    most = sorted(loads.rows, key=lambda row: -row.equivalent_static_force)[:_MOST_BARS]
    rows = sorted(most, key=lambda row: row.index)
    place = np.arange(len(rows))
    columns = (
        ("peak_force", f"peak, {loads.peak_filter}", ORANGE),
        ("force_50ms", "50-ms mean", BLUE),
        ("equivalent_static_force", "equivalent static", RED),
    )
    for k, (name, label, color) in enumerate(columns):
        values = [getattr(row, name) / 1e3 for row in rows]
        axes.bar(place + 0.27 * (k - 1), values, 0.25, color=color, label=label)
        for at, row in zip(place + 0.27 * (k - 1), rows, strict=True):
            if name in row.band:
                low, high = row.band[name]
                axes.vlines(at, low / 1e3, high / 1e3, color="k", lw=1.0)
    if any(row.band for row in rows):
        axes.plot([], [], "k-", lw=1.0, label="80 % of the class; design: its upper end")
    axes.set_xticks(place, [row.name for row in rows], fontsize="small")
    if len(rows) > 4:
        axes.tick_params("x", labelrotation=30)
    axes.grid(visible=False, axis="x")
    axes.set_ylabel("force [kN]")
    axes.set_title("Horizontal force on each element", fontsize="medium")


def _force(
    axes: Axes, row: ElementDesign, force: Floats, interval: float, degrees: float, other: str | None
) -> None:
    ms = np.arange(len(force), dtype=np.float64) * (interval * 1e3)
    smooth, name = filtered(force, 60, interval)
    mean = moving_average(force, 0.05, interval)
    axes.plot(ms, force / 1e3, color=ORANGE, ls="-", lw=0.5, alpha=0.5, zorder=1.5)
    axes.plot(ms, smooth / 1e3, color=ORANGE, ls="-", lw=2.2, label=name)
    axes.plot(ms, mean / 1e3, color=BLUE, ls=DASHED, lw=1.8, label="mean over the last 50 ms")
    _mark(axes, ms, mean / 1e3, "kN", row.force_50ms / 1e3, other)
    level = row.equivalent_static_force / 1e3
    label = f"equivalent static, {_own_and_design(row, 'equivalent_static_force')} kN"
    axes.axhline(level, color=RED, ls=DASH_DOT, lw=1.4, label=label)
    shown = readable_level(smooth, interval)
    top = max(min(float(smooth.max()), shown) / 1e3, float(mean.max()) / 1e3, level)
    axes.set_ylim(min(0.0, 1.1 * max(float(smooth.min()), -shown) / 1e3), 1.25 * top)
    axes.set_ylabel("force [kN]")
    name_cut_peaks([(axes, [(ms, smooth / 1e3)], "kN")])
    axes.set_title(f"{row.name}: force at {round(degrees)}° from the normal", fontsize="medium")


def _own_and_design(row: ElementDesign, name: str) -> str:
    """Return a value in thousands of its unit, with the design value where that is another one."""
    own, design = getattr(row, name), row.design[name]
    return f"{own / 1e3:,.0f}" + (f"; design {design / 1e3:,.0f}" if design > own else "")


def _moment(axes: Axes, row: ElementDesign, load: ElementLoad, of_other: Mapping[str, str]) -> None:
    ms = np.arange(len(load.moment), dtype=np.float64) * (load.interval * 1e3)
    smooth, name = filtered(load.moment, 60, load.interval)
    mean = moving_average(load.moment, 0.05, load.interval)
    curves = [overturning(moment, load.line) / 1e3 for moment in (load.moment, smooth, mean)]
    axes.plot(ms, curves[0], color=ORANGE, ls="-", lw=0.5, alpha=0.5, zorder=1.5)
    axes.plot(ms, curves[1], color=ORANGE, ls="-", lw=2.2, label=name)
    axes.plot(ms, curves[2], color=BLUE, ls=DASHED, lw=1.8, label="mean over the last 50 ms")
    _mark(axes, ms, curves[2], "kN m", row.moment / 1e3, of_other.get("moment"))
    name_of_static, level = "equivalent_static_moment", row.equivalent_static_moment / 1e3
    label = f"equivalent static, {_own_and_design(row, name_of_static)} kN m"
    if name_of_static in of_other:
        axes.plot([], [], ls="none", label=f"{label}, {of_other[name_of_static]}")
        level = 0.0
    else:
        axes.axhline(level, color=RED, ls=DASH_DOT, lw=1.4, label=label)
    shown = readable_level(curves[1], load.interval)
    top = max(min(float(curves[1].max()), shown), float(curves[2].max()), level)
    axes.set_ylim(0.0, 1.25 * top)
    axes.set_ylabel("moment [kN m]")
    name_cut_peaks([(axes, [(ms, curves[1])], "kN m")])
    axes.set_title(f"{row.name}: overturning moment about its foot", fontsize="medium")


def _mark(
    axes: Axes, ms: npt.NDArray[np.floating[Any]], curve: Floats, unit: str, design: float, other: str | None
) -> None:
    """Mark the greatest value with the number of the table.

    Where that comes from another scene only the legend has it: its curve is not in this panel.
    """
    if other is not None:
        axes.plot([], [], ls="none", label=f"50-ms mean {other}, {design:,.0f} {unit}")
        return
    at = int(np.argmax(curve))
    axes.plot([ms[at]], [curve[at]], "o", color=BLUE, ms=6, mec="w", ls="none", zorder=6)
    axes.annotate(
        f"{design:,.0f} {unit}",
        (ms[at], curve[at]),
        (6.0, 6.0),
        textcoords="offset points",
        fontsize="small",
        color=BLUE,
        zorder=7,
    )


def _spectrum(axes: Axes, loads: DesignLoad, row: ElementDesign) -> None:
    assert row.load is not None
    interval = row.load.interval
    low = max(_PERIODS[0], LEAST_INTERVALS * interval)
    own = loads.natural_period
    label = "moment that the post resists" if row.has_yielded else "elastic"
    wanted = [(1.0, GREEN, label, _POINTS)]
    if loads.ductility > 1.0 and not row.can_yield:
        wanted.append((loads.ductility, RED, f"ductility {loads.ductility:g}", _SOFT_POINTS))
    for ductility, color, label, points in wanted:
        periods = np.unique([own, *np.geomspace(min(low, own), max(_PERIODS[1], own), points)])
        found = loads.spectrum(periods, row.index, ductility)
        axes.semilogx(periods, found / row.peak_force, color=color, ls="-", lw=1.8, label=label)
    if row.can_yield and not row.has_yielded:
        label = f"what the post resists, {row.yield_force / 1e3:,.0f} kN"
        axes.axhline(row.yield_force / row.peak_force, color=BLUE, ls=DASHED, lw=1.4, label=label)
    axes.plot([own], [row.dynamic_load_factor], "o", color=RED, ms=7, mec="w", ls="none", zorder=6)
    axes.annotate(
        f"{own:g} s: {row.dynamic_load_factor:.2f}",
        (own, row.dynamic_load_factor),
        (9.0, 9.0),
        textcoords="offset points",
        fontsize="small",
        color=RED,
        bbox={"fc": "w", "ec": "none", "pad": 1.0, "alpha": 0.85},
        zorder=7,
    )
    axes.set_ylim(0.0, 1.12 * axes.get_ylim()[1])
    axes.set_xlabel("natural period [s]")
    axes.set_ylabel("dynamic load factor")
    size = row.peak_force / 1e3
    other = axes.twinx()
    other.set_ylim(0.0, axes.get_ylim()[1] * size)
    other.set_ylabel("equivalent static force [kN]")
    axes.set_title(f"{row.name}: response spectrum, over the peak force", fontsize="medium")


def _end_of_load(load: ElementLoad) -> float:
    """Return where the panels end [ms]: some time after the load."""
    level = np.linalg.norm(load.force, axis=1)
    last = int(np.flatnonzero(level >= _LOAD_SHARE * level.max())[-1])
    last += round(0.05 / load.interval)
    return float(max(1, min(len(level) - 1, _ROOM * last)) * load.interval * 1e3)
