"""Figures of studies of stability. matplotlib is imported here only."""

from __future__ import annotations

from typing import TYPE_CHECKING

from matplotlib.figure import Figure

from ..study.verification.stability_result import FAULT, HELD, REFUSED, WARNED
from .figure import new_figure
from .style import legend

if TYPE_CHECKING:
    from ..study.verification.stability_result import Stability

__all__ = ["plot_stability"]

_LEAST = 1e-16
_STYLES = {HELD: ("o", "C2"), REFUSED: ("x", "C7"), WARNED: ("^", "C1"), FAULT: ("D", "C3")}


def plot_stability(study: Stability) -> Figure:
    """Return a figure of the energy residual of every row; refused ones at the bottom."""
    axes_names = list(dict.fromkeys(row.axis for row in study.rows))
    figure = new_figure(10.0, 5.0)
    axes = figure.subplots()
    for verdict, (marker, color) in _STYLES.items():
        x, y = [], []
        for i, name in enumerate(axes_names):
            rows = [row for row in study.rows if row.axis == name]
            for j, row in enumerate(rows):
                if row.verdict == verdict:
                    x.append(i + 0.8 * (j + 0.5) / len(rows) - 0.4)
                    seen = verdict != REFUSED and row.energy_residual > _LEAST
                    y.append(row.energy_residual if seen else _LEAST)
        axes.plot(x, y, marker, color=color, ms=4, label=f"{verdict} ({len(x)})")
    axes.axhline(study.limits.energy, color="k", lw=0.8, ls="--", label="limit")
    axes.set_yscale("log")
    axes.set_ylabel("energy residual / initial kinetic energy")
    axes.set_xticks(range(len(axes_names)), axes_names, rotation=30, ha="right")
    axes.grid(alpha=0.3, axis="y")
    legend([axes])
    return figure
