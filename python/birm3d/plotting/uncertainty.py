"""Figures of Sobol indices and of critical impact points. matplotlib is imported here only."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..result.metrics import METRIC_UNITS
from ..simulation.parameters import unit_of
from ..study.shown_columns import metric_column, parameter_words, shown_column, shown_metric
from .figure import new_figure
from .studies import axis_label
from .style import BLUE, ORANGE, RED, legend, prepare, wrapped

if TYPE_CHECKING:
    from ..study.impact_point import CriticalImpactPoint
    from ..study.sobol import SobolIndex, SobolIndices

__all__ = ["plot_critical_point", "plot_sobol"]

Floats = npt.NDArray[np.float64]

_PANELS = 6
_BAR = 0.38


def plot_sobol(indices: SobolIndices, metrics: Sequence[str] | None = None) -> Figure:
    """Return bars of first and total order with their confidence intervals, a panel for each metric.

    Parameters
    ----------
    indices
        What is drawn.
    metrics
        Names of metrics that have indices; ``None``: the first six.

    Raises
    ------
    ValueError
        If a metric has no indices, or none has.
    """
    names = list(indices.metrics)[:_PANELS] if metrics is None else list(metrics)
    for name in names:
        if name not in indices.metrics:
            reason = indices.omitted.get(name, "it is not among the study's metrics")
            raise ValueError(f"metrics must have indices, got {name!r}: {reason}")
    if not names:
        raise ValueError("metrics must be at least one that has indices, got none")
    columns = 1 if len(names) == 1 else 2
    rows = -(-len(names) // columns)
    height = 1.3 + 0.42 * len(indices.parameters)
    figure = new_figure(5.6 * columns, max(2.6, height * rows + 0.6))
    panels = list(figure.subplots(rows, columns, squeeze=False, sharey=True).flat)
    for axes, name in zip(panels, names, strict=False):
        _bars(axes, indices.parameters, indices.metrics[name])
        axes.set_title(shown_column(name, "").words, fontsize="medium")
    for unused in panels[len(names) :]:
        unused.set_visible(False)
    panels[0].invert_yaxis()
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3, frameon=False, fontsize="small")
    level = f"{100 * indices.design.confidence:g} %"
    head = wrapped(indices.study.scene_title, figure)
    figure.suptitle(
        f"{head}\nSobol indices of {len(indices.study):,} runs, {level} intervals", fontsize="medium"
    )
    return figure


def _bars(axes: Axes, parameters: Sequence[str], found: SobolIndex) -> None:
    prepare(axes)
    place = np.arange(len(parameters))
    for values, half, shift, color, label in (
        (found.first, found.first_confidence, -0.5 * _BAR, BLUE, "first order"),
        (found.total, found.total_confidence, 0.5 * _BAR, ORANGE, "total"),
    ):
        axes.barh(place + shift, values, _BAR, color=color, label=label)
        axes.errorbar(values, place + shift, xerr=half, fmt="none", ecolor="0.2", elinewidth=1.0, capsize=2.5)
    axes.axvline(0.0, color="k", lw=0.8)
    axes.set_yticks(place, [parameter_words(name) for name in parameters])
    axes.set_xlim(min(0.0, axes.get_xlim()[0]), max(1.0, axes.get_xlim()[1]))
    axes.set_xlabel("share of the variance")


def plot_critical_point(found: CriticalImpactPoint) -> Figure:
    """Return the metric over the ranges searched: the grid, the runs of the refinement, and the point.

    Over one range it is a curve, over two a map. Of more than two ranges those with the greatest effect are
    drawn, and over the others the worst value of the grid is taken.
    """
    names = sorted(found.effect, key=lambda name: -found.effect[name])[:2]
    names = [name for name in found.point if name in names]
    size = metric_column(found.metric).divisor
    figure = new_figure(7.0, 5.2)
    axes = figure.subplots()
    prepare(axes)
    label = axis_label(found.metric, METRIC_UNITS[found.metric])
    if len(names) == 1:
        _curve(axes, found, names[0], size)
        axes.set_ylabel(label)
    else:
        _map(figure, axes, found, names, size, label)
        axes.set_ylabel(axis_label(names[1], unit_of(names[1])))
    axes.set_xlabel(axis_label(names[0], unit_of(names[0])))
    notes = "".join(f"; {parameter_words(name)} at its bound" for name in found.at_bound)
    runs = len(found.grid) + len(found.refinement)
    words = metric_column(found.metric).words
    value = f"{words} {shown_metric(found.metric, found.value)}"
    head = wrapped(found.grid.scene_title, figure)
    axes.set_title(f"{head}\n{value}, {runs} runs{notes}", fontsize="medium")
    legend([axes])
    return figure


def _worst(found: CriticalImpactPoint, names: Sequence[str]) -> tuple[list[Floats], Floats]:
    """Return the grid's values along some parameters, and the worst of the metric over all the others."""
    grid = found.grid.grid
    assert grid is not None  # made by critical_impact_point
    values = found.grid[found.metric].reshape([len(places) for places in grid.values()])
    others = tuple(i for i, name in enumerate(grid) if name not in names)
    sought = -np.inf if found.value >= np.nanmedian(values) else np.inf
    filled = np.where(np.isnan(values), sought, values)
    worst = filled.max(axis=others) if sought < 0.0 else filled.min(axis=others)
    axes = [np.asarray(places, float) for name, places in grid.items() if name in names]
    return axes, np.where(np.isfinite(worst), worst, np.nan)


def _curve(axes: Axes, found: CriticalImpactPoint, name: str, size: float) -> None:
    (places,), worst = _worst(found, [name])
    axes.plot(places, worst / size, "o-", color=BLUE, lw=1.4, ms=5, label="grid")
    tried = found.refinement
    axes.plot(tried[name], tried[found.metric] / size, ".", color=ORANGE, ls="none", ms=6, label="refinement")
    axes.plot(
        [found.point[name]], [found.value / size], "*", color=RED, ls="none", ms=14, label="critical point"
    )


def _map(
    figure: Figure, axes: Axes, found: CriticalImpactPoint, names: Sequence[str], size: float, label: str
) -> None:
    (x, y), worst = _worst(found, names)
    shades = axes.contourf(x, y, worst.T / size, levels=14, cmap="YlOrRd")
    figure.colorbar(shades, ax=axes, label=label)
    grid_x, grid_y = np.meshgrid(x, y)
    axes.plot(grid_x.ravel(), grid_y.ravel(), ".", color="0.35", ls="none", ms=3, label="grid")
    tried = [found.refinement[name] for name in names]
    axes.plot(*tried, ".", color=BLUE, ls="none", ms=5, label="refinement")
    point = [[found.point[name]] for name in names]
    axes.plot(*point, "*", color="k", ls="none", ms=14, mec="w", label="critical point")
