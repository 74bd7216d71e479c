"""Loads on the elements of a barrier against time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..result.element_loads import overturning, resultant_height, touched_elements
from .blows import readable_level
from .figure import new_figure
from .style import CYCLE, STYLES, WIDTHS, filtered, legend, prepare, title

if TYPE_CHECKING:
    from ..result.result import Result

__all__ = ["plot_elements"]

Floats = npt.NDArray[np.float64]

# A height is drawn where the force is above this share of the element's peak: below, it is noise.
_HEIGHT_SHARE = 0.05
# The panel of heights is as high as asked for where the force is above this share; less may ring.
_HEAVY = 0.25
# The figure ends where all forces stay below this share of the greatest, and some room after it.
_LOAD_SHARE, _ROOM = 0.01, 1.08
_CUT = 1.05  # of what a panel shows: peaks above are cut off
# Peaks nearer to each other than these shares of the panel are marked once.
_SAME_TIME, _SAME_VALUE = 0.02, 0.02
_MOST_TEXTS = 3  # peaks with their values, each in a row of its own: more would lie on each other


class _Peak(NamedTuple):
    time: float
    value: float
    name: str


def plot_elements(result: Result) -> Figure:
    """Return force, height of the resultant and overturning moment of each element that was touched.

    Forces and moments after CFC 60 (SAE J211-1), before magnitudes are taken. Their peaks are marked, the
    three greatest with their values. Forces are whole, with their parts up and along the line. Of walls the
    moment is that about their line, as in :class:`birm3d.ElementLoad`. Heights follow from both. They are not
    drawn where the horizontal force is below 5 % of its peak. The figure ends where the load does. A blow of
    a few milliseconds that would flatten the rest is cut off, its peak marked at the upper edge.

    Raises
    ------
    ValueError
        If nothing was touched.
    """
    loads = touched_elements(result.element_loads)
    if not loads:
        raise ValueError("elements must have been touched to be drawn, got none that was")
    figure = new_figure(10.0, 9.6)
    panels = figure.subplots(3, 1, sharex=True)
    force_panel, height_panel, moment_panel = panels
    prepare(*panels)
    ms = result.time * 1e3
    class_ = ""
    forces, moments, top = [], [], 0.0
    for i, load in enumerate(loads):
        look = {
            "color": CYCLE[i % len(CYCLE)],
            "ls": STYLES[(i + i // len(CYCLE)) % len(STYLES)],  # a colour that comes again has another line
            "lw": WIDTHS[i % len(WIDTHS)],
        }
        force, class_ = filtered(load.force, 60, load.interval)
        moment, _ = filtered(load.moment, 60, load.interval)
        level = _level(force, load.line)
        least = _HEIGHT_SHARE * readable_level(level, load.interval)
        height = resultant_height(force, moment, load.line, least)
        height = np.where((level > least) & (height > 0.0), height, np.nan)
        heavy = level > _HEAVY * readable_level(level, load.interval)
        top = max(top, float(np.nan_to_num(height).max(initial=0.1, where=heavy)))
        forces.append(np.linalg.norm(force, axis=1) / 1e3)
        moments.append(overturning(moment, load.line) / 1e3)
        force_panel.plot(ms, forces[-1], label=load.name, **look)
        height_panel.plot(ms, height, label=load.name, **look)
        moment_panel.plot(ms, moments[-1], label=load.name, **look)
    names = [load.name for load in loads]
    end = _end_of_load(ms, forces)
    _mark_peaks(force_panel, ms, forces, names, end, "kN")
    _mark_peaks(moment_panel, ms, moments, names, end, "kN m")
    force_panel.set_title(f"Whole force on the element, {class_}")
    force_panel.set_ylabel("force [kN]")
    height_panel.set_title("Height of the horizontal resultant above the foot")
    height_panel.set_ylabel("height [m]")
    height_panel.set_ylim(0.0, 1.1 * top)
    moment_panel.set_title(f"Overturning moment about the foot, {class_}")
    moment_panel.set_ylabel("moment [kN m]")
    moment_panel.set_xlabel("time [ms]")
    moment_panel.set_xlim(0.0, end)
    legend([force_panel])
    figure.suptitle(title(result, figure))
    return figure


def _level(force: Floats, line: Floats | None) -> Floats:
    """Return the size of the horizontal force that overturns: of a wall, across its line."""
    across = force[:, :2] if line is None else force[:, :2] @ np.array([[line[1]], [-line[0]]])
    return np.asarray(np.linalg.norm(across, axis=1))


def _end_of_load(ms: Floats, forces: Sequence[Floats]) -> float:
    """Return where the figure ends [ms]."""
    greatest = np.max(forces, axis=0)
    last = int(np.flatnonzero(greatest >= _LOAD_SHARE * greatest.max())[-1])
    return float(min(ms[-1], max(_ROOM * ms[last], ms[min(1, len(ms) - 1)])))


def _mark_peaks(
    axes: Axes, ms: Floats, curves: Sequence[Floats], names: Sequence[str], end: float, unit: str
) -> None:
    """Mark the greatest value of each curve, and write the three greatest of these, one below the other.

    A blow that would flatten the rest is cut off: its mark, a triangle, is then at the upper edge.
    """
    interval = float(ms[1] - ms[0]) / 1e3
    top = max(readable_level(curve, interval) for curve in curves)
    if top <= 0.0:
        return
    edge = top * _CUT
    peaks: list[_Peak] = []
    for curve, name in zip(curves, names, strict=True):
        at = int(np.argmax(curve))
        time, value = float(ms[at]), float(curve[at])
        cut = value > edge
        axes.scatter([time], [min(value, edge)], s=16.0, color="k", marker="^" if cut else "o", zorder=6.0)
        same = [
            i
            for i, peak in enumerate(peaks)
            if abs(peak.time - time) < _SAME_TIME * end and abs(peak.value - value) < _SAME_VALUE * top
        ]
        if same:
            peaks[same[0]] = peaks[same[0]]._replace(name=f"{peaks[same[0]].name} and {name}")
        else:
            peaks.append(_Peak(time, value, name))
    peaks = sorted(sorted(peaks, key=lambda peak: -peak.value)[:_MOST_TEXTS])
    several = len(names) > 1
    rows = len(peaks)
    for k, peak in enumerate(peaks):
        text = f"{peak.name}: {peak.value:,.0f} {unit}" if several else f"{peak.value:,.0f} {unit}"
        late = peak.time > 0.6 * end
        # No line to a peak crosses a text: texts that go to the right descend, those to the left rise.
        row = k % rows if late else rows - 1 - k % rows
        height = top * (1.10 + 0.13 * row)
        axes.annotate(
            text,
            (peak.time, min(peak.value, edge)),
            (peak.time + (-0.01 if late else 0.01) * end, height),
            fontsize="small",
            va="center",
            ha="right" if late else "left",
            bbox={"fc": "w", "ec": "none", "pad": 0.5, "alpha": 0.85},
            arrowprops={"arrowstyle": "-", "lw": 0.6, "color": "0.4", "relpos": (float(late), 0.5)},
            zorder=7.0,
        )
    axes.set_ylim(0.0, top * (1.12 + 0.13 * rows))
