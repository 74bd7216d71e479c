"""Pictures of the load on a barrier, cell by cell."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .figure import new_figure

if TYPE_CHECKING:
    from ..result.load_map import LoadMap

__all__ = ["plot_load_map"]

Floats = npt.NDArray[np.float64]

_MOST_TEXTS = 120  # cells that are labelled with their numbers
_DARK = 0.55  # share of the greatest value from which on numbers are white


def plot_load_map(map_: LoadMap, time: float | None = None) -> Figure:
    """Return impulse and peak force of each cell; of an instant, the force then.

    The barrier is seen as the vehicle sees it: the place along the line, which is y, runs from right to left.
    """
    if time is None:
        panels = [
            (f"Impulse, {map_.impulse.sum() / 1e3:.3g} kN s in all cells", "impulse [kN s]", map_.impulse),
            ("Peak force of each cell, CFC 60", "force [kN]", map_.peak),
        ]
    else:
        force = map_.at(time)
        head = f"Force at {time * 1e3:.1f} ms, {force.sum() / 1e3:,.0f} kN in all cells"
        panels = [(head, "force [kN]", force)]
    width, height = np.ptp(map_.lateral), np.ptp(map_.height)
    tall = float(np.clip(9.0 * height / width, 1.6, 5.0))
    figure = new_figure(10.0, len(panels) * (tall + 0.8) + 0.6)
    axes = figure.subplots(len(panels), 1, squeeze=False)[:, 0]
    for panel, (head, label, values) in zip(axes, panels, strict=True):
        _draw(figure, panel, map_, values / 1e3, label)
        panel.set_title(head, fontsize="medium")
    figure.suptitle(map_.title, fontsize="medium")
    return figure


def _draw(figure: Figure, axes: Axes, map_: LoadMap, values: Floats, label: str) -> None:
    top = max(float(values.max(initial=0.0)), 1e-12)
    cells = axes.pcolormesh(
        map_.lateral, map_.height, values, cmap="YlOrRd", vmin=0.0, vmax=top, edgecolors="0.8", linewidth=0.4
    )
    figure.colorbar(cells, ax=axes, label=label)
    axes.set_aspect("equal")
    # Ticks change with the room that is left: labels of one width leave room for them beforehand.
    axes.yaxis.set_major_formatter("{x:.2f}")
    axes.invert_xaxis()
    axes.set_xlabel("along the barrier's line [m]")
    axes.set_ylabel("height [m]")
    if values.size > _MOST_TEXTS:
        return
    for i, j in np.ndindex(*values.shape):
        value = float(values[i, j])
        if value < 5e-3 * top:
            continue
        place = (map_.lateral[j : j + 2].mean(), map_.height[i : i + 2].mean())
        color = "w" if value > _DARK * top else "k"
        text = f"{value:.0f}" if value >= 10.0 else f"{value:.2g}"
        axes.text(*place, text, ha="center", va="center", fontsize="x-small", color=color)
