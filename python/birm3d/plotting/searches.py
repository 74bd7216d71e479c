"""Figures of searches: limits of a barrier, and the worst offset for each spacing."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..result.metrics import METRIC_UNITS
from ..study.shown_columns import metric_column, shown_metric
from .figure import new_figure
from .studies import axis_label
from .style import BLUE, CYCLE, DASHED, GREEN, RED, legend, prepare, wrapped

if TYPE_CHECKING:
    from ..study.limit_search import Limit
    from ..study.worst_offset import WorstOffset

__all__ = ["plot_limit", "plot_worst_offset"]


def plot_limit(limit: Limit) -> Figure:
    """Return all runs over what was searched: their measure, and their offsets where there are several.

    A value holds if all its runs do. The range that holds is green; from the first failure on it is red.
    """
    offsets = max(Counter(run.value for run in limit.runs).values()) > 1
    figure = new_figure(7.6, 6.4 if offsets else 4.8)
    panels = figure.subplots(2 if offsets else 1, 1, sharex=True, squeeze=False)[:, 0]
    prepare(*panels)
    for axes in panels:
        _ranges(axes, limit)
    _runs(panels[0], limit, [run.measure for run in limit.runs])
    panels[0].set_ylabel(axis_label(limit.measure, METRIC_UNITS[limit.measure]))
    if limit.most is not None:
        allowed = limit.question.measured(limit.most, "g")
        panels[0].axhline(limit.most, color="k", ls=DASHED, lw=1.0, label=f"{allowed} allowed")
    if offsets:
        _runs(panels[1], limit, [run.impact_offset for run in limit.runs])
        panels[1].set_ylabel("impact offset [m]")
    panels[-1].set_xlabel(f"{limit.name} [{limit.unit}]")
    note = "" if limit.monotonic else "; not monotonic"
    lines = "\n".join([limit.study.scene_title, f"{limit.headline}{note}", limit.band])
    panels[0].set_title(wrapped(lines, figure), fontsize="medium")
    legend([panels[0]])
    return figure


def _ranges(axes: Axes, limit: Limit) -> None:
    values = [run.value for run in limit.runs]
    safe = (min(values), limit.value) if limit.greatest else (limit.value, max(values))
    axes.axvspan(*safe, color=GREEN, alpha=0.12, lw=0, label="holds")
    if limit.fails_at is not None:
        beyond = (limit.fails_at, max(values)) if limit.greatest else (min(values), limit.fails_at)
        axes.axvspan(*beyond, color=RED, alpha=0.08, lw=0, label="from the first failure on")
    axes.axvline(limit.value, color=GREEN, ls="-", lw=1.6)
    axes.margins(x=0.02)


def _runs(axes: Axes, limit: Limit, heights: list[float]) -> None:
    values, found = np.array([run.value for run in limit.runs]), np.array(heights)
    holds = np.array([run.holds for run in limit.runs])
    looks = ((holds, BLUE, "o", 5, "run that holds"), (~holds, RED, "X", 8, "run that fails"))
    for kind, color, mark, size, label in looks:
        if kind.any():
            axes.plot(values[kind], found[kind], mark, color=color, ls="none", ms=size, mec="w", label=label)


def plot_worst_offset(found: WorstOffset) -> Figure:
    """Return the metric over the offset for each spacing, and its greatest value over the spacing."""
    size = metric_column(found.metric).divisor
    label = found.label
    several = len(found.rows) > 1
    figure = new_figure(11.0 if several else 7.0, 4.8)
    panels = figure.subplots(1, 2 if several else 1, squeeze=False)[0]
    prepare(*panels)
    _curves(panels[0], found, size)
    panels[0].set_ylabel(label)
    if several:
        axes = panels[1]
        axes.plot(found.spacing, found.value / size, "o-", color=BLUE, lw=1.6, ms=6)
        for row in found.rows:
            axes.annotate(
                f"{row.share:.2f}",
                (row.spacing, row.value / size),
                (0.0, 7.0),
                textcoords="offset points",
                ha="center",
                fontsize="small",
            )
        axes.margins(y=0.15)
        axes.set_xlabel("spacing between axes [m]")
        axes.set_ylabel(label)
        axes.set_title("Greatest value; numbers: distance from a post over the spacing", fontsize="medium")
    worst = found.worst
    place = f"spacing {worst.spacing:g} m, offset {worst.offset:.2f} m"
    value = f"{found.words} {shown_metric(found.metric, worst.value)}"
    head = f"{wrapped(worst.search.grid.scene_title, figure)}\nworst: {value} at {place}"
    figure.suptitle(head, fontsize="medium" if several else "small")
    return figure


def _curves(axes: Axes, found: WorstOffset, size: float) -> None:
    for i, row in enumerate(found.rows):
        studies = (row.search.grid, row.search.refinement)
        offset, value = (
            np.concatenate([study[name] for study in studies]) for name in ("impact_offset", found.metric)
        )
        order = np.argsort(offset, kind="stable")
        color = CYCLE[i % len(CYCLE)]
        axes.plot(
            offset[order], value[order] / size, ".-", color=color, lw=1.3, ms=5, label=f"{row.spacing:g} m"
        )
        axes.plot([row.offset], [row.value / size], "*", color=color, ls="none", ms=14, mec="k", zorder=6)
    axes.set_xlabel("impact offset [m]")
    axes.set_title("All runs by spacing; stars: the worst", fontsize="medium")
    legend([axes])
