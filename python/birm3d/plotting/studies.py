"""Figures of studies. matplotlib is imported here only."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..base.plain_words import plain_words
from ..study.shown_columns import shown_column
from .figure import new_figure
from .style import BLUE, RED, legend, prepare, wrapped

if TYPE_CHECKING:
    from ..study.fragility import Fragility
    from ..study.table import Study

__all__ = ["axis_label", "plot_fragility", "plot_small", "plot_study"]

Floats = npt.NDArray[np.float64]

_QUANTILES = (0.05, 0.5, 0.95)
_LETTERS, _FEW_LETTERS = 45, 26  # of an axis label in one line; of a small figure


def plot_study(study: Study, x: str, y: str, by: str | None = None) -> Figure:
    """Return a figure of column `y` against `x`, a line for each value of `by`.

    Runs that failed or have no `y` are left out. Where several runs share an `x`, they are points. Runs
    that were drawn, as in a Monte Carlo study, are a scatter with the distribution of either column beside
    it; lines are the median (dashed) and the 5 and 95 % quantiles.
    """
    if by is None and _is_drawn(study, x):
        return _plot_scatter(study, x, y)
    figure = new_figure(7.0, 4.8)
    axes = figure.subplots()
    prepare(axes)
    (x_values, x_label), (y_values, y_label) = _column(study, x), _column(study, y)
    groups = np.full(len(study), "") if by is None else study[by]
    for value in dict.fromkeys(groups.tolist()):
        rows = np.flatnonzero((groups == value) & np.isfinite(y_values))
        rows = rows[np.argsort(x_values[rows], kind="stable")]
        once = len(np.unique(x_values[rows])) == len(rows)
        label = "_" if by is None else _group_label(study, by, value)
        more: dict[str, Any] = {"marker": "o", "ms": 4} if once else {"marker": ".", "ls": "none"}
        axes.plot(x_values[rows], y_values[rows], label=label, **more)
    axes.set_xlabel(x_label)
    axes.set_ylabel(y_label)
    axes.set_title(wrapped(study.scene_title, figure), fontsize="medium")
    legend([axes])
    return figure


def plot_small(study: Study) -> Figure | None:
    """Return a small scatter of the first metric that varies against the parameter it varies with most."""
    numbers = {name: v for name, v in study.parameters.items() if v.dtype.kind == "f" and np.ptp(v) > 0.0}
    metrics = {
        name: v
        for name, v in study.metrics.items()
        if np.isfinite(v).sum() > 1 and float(np.nanmax(v) - np.nanmin(v)) > 0.0
    }
    if not numbers or not metrics:
        return None
    y = next(
        (name for name in ("dynamic_crush", "vehicle_penetration") if name in metrics), next(iter(metrics))
    )
    seen = np.isfinite(metrics[y])

    def explains(name: str) -> float:
        values = numbers[name][seen]
        return 0.0 if np.ptp(values) == 0.0 else abs(float(np.corrcoef(values, metrics[y][seen])[0, 1]))

    x = max(numbers, key=explains)
    figure = new_figure(3.6, 2.4)
    axes = figure.subplots()
    prepare(axes)
    (x_values, x_label), (y_values, y_label) = (_column(study, name, _FEW_LETTERS) for name in (x, y))
    axes.plot(x_values, y_values, "o", color=BLUE, ms=2.5, alpha=0.6)
    axes.tick_params(labelsize="x-small")
    axes.set_xlabel(x_label, fontsize="small")
    axes.set_ylabel(y_label, fontsize="small")
    return figure


def plot_fragility(fragility: Fragility) -> Figure:
    """Return a figure of counted probabilities with their intervals, and the fitted curve with its band."""
    figure = new_figure(7.0, 4.8)
    axes = figure.subplots()
    prepare(axes)
    p = fragility.probability
    bars = np.abs(np.array([fragility.low, fragility.high]) - p)
    level = f"{100 * fragility.confidence:g} %"
    counted = f"counted, {level} (Wilson)"
    axes.errorbar(
        fragility.speeds,
        p,
        yerr=bars,
        fmt="o",
        color=BLUE,
        ls="none",
        elinewidth=1.3,
        capsize=3,
        label=counted,
    )
    if fragility.fit is not None:
        speeds = np.linspace(fragility.speeds[0], fragility.speeds[-1], 200)
        low, high = fragility.fit.band(speeds, fragility.confidence)
        axes.plot(speeds, fragility.fit.probability(speeds), color=RED, ls="-", lw=1.8, label="lognormal fit")
        axes.fill_between(speeds, low, high, color=RED, alpha=0.15, lw=0, label=f"{level} of the fit")
    axes.set_ylim(-0.03, 1.03)
    axes.set_xlabel("impact speed [m/s]")
    axes.set_ylabel(f"probability: {plain_words(fragility.event)}")
    axes.set_title(wrapped(fragility.study.scene_title, figure), fontsize="medium")
    legend([axes])
    return figure


def axis_label(name: str, unit: str, letters: int = _LETTERS) -> str:
    """Return a column in words with the unit in which pictures show it, in lines of so many letters."""
    column = shown_column(name, unit)
    fixed = column._replace(unit=column.unit.replace(" ", "\N{NO-BREAK SPACE}"))
    return "\n".join(textwrap.wrap(fixed.label, letters))


def _is_drawn(study: Study, x: str) -> bool:
    """Whether the runs are draws: no grid, numbers as `x`, in no order."""
    values = study[x]
    if study.grid is not None or values.dtype.kind != "f" or len(values) < 3:
        return False
    steps = np.diff(values[np.isfinite(values)])
    return not ((steps >= 0.0).all() or (steps <= 0.0).all())


def _plot_scatter(study: Study, x: str, y: str) -> Figure:
    figure = new_figure(7.0, 6.0)
    (top, corner), (axes, right) = figure.subplots(
        2, 2, sharex="col", sharey="row", width_ratios=(4, 1), height_ratios=(1, 4)
    )
    corner.set_visible(False)
    prepare(axes, top, right)
    (x_values, x_label), (y_values, y_label) = _column(study, x), _column(study, y)
    seen = np.isfinite(x_values) & np.isfinite(y_values)
    x_values, y_values = x_values[seen], y_values[seen]
    axes.plot(x_values, y_values, "o", color=BLUE, ls="none", ms=4, alpha=0.6, mew=0.0)
    _histogram(top, x_values, "vertical")
    _histogram(right, y_values, "horizontal")
    axes.set_xlabel(x_label)
    axes.set_ylabel(y_label)
    top.set_ylabel("runs")
    right.set_xlabel("runs")
    omitted = len(study) - len(x_values)
    rest = f", {omitted:,} without a value left out" if omitted else ""
    head = wrapped(study.scene_title, figure)
    figure.suptitle(f"{head}\n{len(x_values):,} runs{rest}", fontsize="medium")
    return figure


def _histogram(axes: Axes, values: Floats, orientation: Any) -> None:
    if len(values) == 0:
        return
    bins = int(np.clip(np.sqrt(len(values)), 5, 40))
    axes.hist(values, bins=bins, color=BLUE, alpha=0.5, orientation=orientation)
    line = axes.axvline if orientation == "vertical" else axes.axhline
    for quantile, style in zip(np.quantile(values, _QUANTILES), (":", "--", ":"), strict=True):
        line(float(quantile), color="k", lw=1.0, ls=style)


def _column(study: Study, name: str, letters: int = _LETTERS) -> tuple[npt.NDArray[Any], str]:
    """Return a column in the unit in which pictures show it, and its label."""
    values, unit = study[name], study.units.get(name, "")
    size = shown_column(name, unit).divisor
    return (values / size if values.dtype.kind == "f" else values), axis_label(name, unit, letters)


def _group_label(study: Study, by: str, value: Any) -> str:
    if not isinstance(value, float):
        return str(value)
    words, size, unit = shown_column(by, study.units.get(by, ""))
    return f"{words} {value / size:g} {unit}".rstrip()
