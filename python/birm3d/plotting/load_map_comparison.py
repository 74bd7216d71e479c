"""Pictures of a measured load map beside a computed one."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .figure import new_figure
from .load_maps import draw_cells
from .style import BLUE, DASHED, legend, prepare, wrapped

if TYPE_CHECKING:
    from ..result.load_map_comparison import LoadMapComparison

__all__ = ["plot_load_map_comparison"]

_WIDTH = 13.0  # in
_PANEL = 4.8  # width of a map [in]
_LABELS = {
    "impulse": ("Impulse", "impulse", "N s"),
    "peak": ("Peak force of each cell, CFC 60", "force", "N"),
    "peak_50ms": ("Greatest 50-ms force of each cell", "force", "N"),
}


def plot_load_map_comparison(comparison: LoadMapComparison, quantity: str) -> Figure:
    """Return measured and computed map on one scale, their difference, and the sums of the cells over time.

    The wall is seen as the vehicle sees it: the place along the line, which is y, runs from right to left.
    """
    lateral, height = comparison.measured.lateral, comparison.measured.height
    tall = float(np.clip(_PANEL * np.ptp(height) / np.ptp(lateral), 1.6, 5.0))
    figure = new_figure(_WIDTH, 2.0 * (tall + 0.9) + 0.7)
    (one, other), (apart, force) = figure.subplots(2, 2)
    head, label, unit = _LABELS[quantity]
    measured, computed = comparison.values(quantity)
    top = max(float(measured.max()), float(computed.max()))
    # Of small cells in N and N s: there numbers with decimals do not fit.
    scale, unit = (1e3, f"k{unit}") if top >= 1e3 else (1.0, unit)
    for axes, role, values in ((one, "measured", measured), (other, "computed", computed)):
        cells = draw_cells(axes, lateral, height, values / scale, top / scale)
        total = f"; {values.sum() / 1e3:.3g} kN s in all cells" if quantity == "impulse" else ""
        axes.set_title(f"{head}, {role}{total}", fontsize="medium")
    figure.colorbar(cells, ax=(one, other), label=f"{label} [{unit}]")
    difference = (computed - measured) / scale
    cells = draw_cells(apart, lateral, height, difference, top / scale, signed=True)
    figure.colorbar(cells, ax=apart, label=f"difference of {label} [{unit}]")
    apart.set_title("Computed − measured", fontsize="medium")
    _draw_sums(force, comparison)
    scene = ", ".join(comparison.computed.title.splitlines())
    text = f"Measured: {comparison.measured.title}\nComputed: {scene}\nBoth {comparison.span}"
    figure.suptitle(wrapped(text, figure), fontsize="medium")
    return figure


def _draw_sums(axes: Axes, comparison: LoadMapComparison) -> None:
    """Draw the sum of the cells of both over time."""
    prepare(axes)
    measured, computed = (
        (1e3 * one.time, one.sum_cfc60 / 1e3) for one in (comparison.measured, comparison.computed)
    )
    axes.plot(*measured, color="0.2", ls="-", lw=2.2, label="measured")
    axes.plot(*computed, color=BLUE, ls=DASHED, lw=1.6, label="computed")
    axes.set_title("Sum of the cells, CFC 60", fontsize="medium")
    axes.set_xlabel("time after the first contact [ms]")
    axes.set_ylabel("force [kN]")
    legend([axes])
