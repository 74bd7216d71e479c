"""Pictures of the load on a barrier, cell by cell."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from .figure import new_figure
from .style import wrapped

if TYPE_CHECKING:
    from ..result.load_map import LoadMap

__all__ = ["draw_cells", "plot_load_map"]

Floats = npt.NDArray[np.float64]

_LEAST_TOP = 1e-12  # of colours and numbers, where there is no load
_LEAST_TEXT = 5e-3  # cells below this share of the greatest value have no number
_MOST_TEXTS = 128  # maps of more cells than a wall of 8 x 16 have no numbers in them
_NARROW = 0.6  # width over height of a map below which its panels stand side by side
_FLAT, _FLAT_SIDE = 0.12, 0.4  # height over width, and width over height, below which scales are not equal
_MOST_COLUMNS = 60  # cells of maps with more columns have no edge
_CROPPED = 0.05  # columns at the ends with less than this share of the greatest peak are not drawn
_LEAST_CROP = 0.25  # unless they are less than this share of all columns
_DARK = 0.55  # numbers are white in cells above this share of the greatest value


def plot_load_map(map_: LoadMap, time: float | None = None) -> Figure:
    """Return impulse and peak force of each cell; of an instant, the force then.

    The barrier is seen as the vehicle sees it: the place along the line, which is y, runs from right to left.
    Of a long barrier the part is drawn where cells carry at least 5 % of the greatest peak; the title says
    so.
    """
    columns = _loaded(map_)
    if time is None:
        panels = [
            (f"Impulse, {map_.impulse.sum() / 1e3:.3g} kN s in all cells", "impulse [kN s]", map_.impulse),
            ("Peak force of each cell, CFC 60", "force [kN]", map_.peak),
        ]
    else:
        force = map_.at(time)
        head = f"Force at {time * 1e3:.1f} ms, {force.sum() / 1e3:,.0f} kN in all cells"
        panels = [(head, "force [kN]", force)]
    lateral = map_.lateral[columns.start : columns.stop + 1]
    ratio = float(np.ptp(map_.height) / np.ptp(lateral))
    figure, axes = _panels(len(panels), ratio)
    for panel, (head, label, values) in zip(axes, panels, strict=True):
        shown = values[:, columns] / 1e3
        cells = draw_cells(panel, lateral, map_.height, shown, float(shown.max(initial=0.0)))
        figure.colorbar(cells, ax=panel, label=label)
        panel.set_title(head, fontsize="medium")
    text = map_.title
    if columns != slice(0, len(map_.lateral) - 1):
        text += f"\nfrom {lateral[0]:.1f} to {lateral[-1]:.1f} m; beyond, peaks are below 5 % of the greatest"
    figure.suptitle(wrapped(text, figure), fontsize="medium")
    return figure


def _loaded(map_: LoadMap) -> slice:
    """Return the columns to draw: all, or those of a long barrier that carry load, and one more each side."""
    peak = map_.peak.max(axis=0)
    found = np.flatnonzero(peak > _CROPPED * peak.max(initial=0.0))
    if not len(found):
        return slice(0, len(peak))
    low, high = max(0, int(found[0]) - 1), min(len(peak), int(found[-1]) + 2)
    return slice(low, high) if high - low <= (1.0 - _LEAST_CROP) * len(peak) else slice(0, len(peak))


def _panels(count: int, ratio: float) -> tuple[Figure, Sequence[Axes]]:
    """Return a figure with so many panels of a map of this height over width."""
    if ratio > 1.0 / _NARROW:
        figure = new_figure(3.6 * count + 0.8, 6.0)
        return figure, list(figure.subplots(1, count, squeeze=False)[0])
    tall = float(np.clip(9.0 * ratio, 1.6, 5.0))
    figure = new_figure(10.0, count * (tall + 0.8) + 0.6)
    return figure, list(figure.subplots(count, 1, squeeze=False)[:, 0])


def draw_cells(
    axes: Axes, lateral: Floats, height: Floats, values: Floats, greatest: float, *, signed: bool = False
) -> QuadMesh:
    """Draw cells as the vehicle sees them, with their numbers where there are few.

    Colours run from 0 to the greatest value of the map, or of all maps on this scale; those of signed values
    from minus to plus their own greatest magnitude. Scales are equal unless the map is very flat or narrow.
    """
    top = max(float(np.abs(values).max()) if signed else greatest, _LEAST_TOP)
    edge = 0.4 if values.shape[1] <= _MOST_COLUMNS else 0.0
    cells = axes.pcolormesh(
        lateral, height, values, cmap="RdBu_r" if signed else "YlOrRd", vmin=-top if signed else 0.0,
        vmax=top, edgecolors="0.8", linewidth=edge,
    )  # fmt: skip
    # Ticks change with the room that is left: labels of one width leave room for them beforehand.
    axes.yaxis.set_major_formatter("{x:.2f}")
    axes.xaxis.set_major_locator(MaxNLocator(8 if np.ptp(lateral) > np.ptp(height) else 3))
    axes.invert_xaxis()
    axes.set_xlabel("along the barrier's line [m]")
    axes.set_ylabel("height [m]")
    ratio = float(np.ptp(height) / np.ptp(lateral))
    axes.set_aspect("equal" if _FLAT < ratio < 1.0 / _FLAT_SIDE else "auto")
    if values.size > _MOST_TEXTS or greatest < _LEAST_TOP:
        return cells
    decimals = max(0, 1 - math.floor(math.log10(greatest)))  # two digits of the greatest value
    for i, j in np.ndindex(*values.shape):
        value = float(values[i, j])
        if abs(value) < max(_LEAST_TEXT * greatest, 0.5 * 0.1**decimals):
            continue
        text = f"{value:{'+' if signed else ''},.{decimals}f}".replace("-", "\u2212")
        place = (lateral[j : j + 2].mean(), height[i : i + 2].mean())
        color = "w" if abs(value) > _DARK * top else "k"
        axes.text(*place, text, ha="center", va="center", fontsize="x-small", color=color)
    return cells
