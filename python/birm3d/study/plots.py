"""Figures of studies. matplotlib is imported here only."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

if TYPE_CHECKING:
    from ..fragility import Fragility
    from .table import Study

__all__ = ["plot_fragility", "plot_study"]


def plot_study(study: Study, x: str, y: str, by: str | None = None) -> Figure:
    """Return a figure of column `y` against `x`, a line for each value of `by`.

    Runs that failed or have no `y` are left out. Where several runs share an `x`, they are points.
    """
    figure = Figure(figsize=(7.0, 4.5), layout="constrained")
    axes = figure.subplots()
    ordinate = study[y]
    groups = np.full(len(study), "") if by is None else study[by]
    for value in dict.fromkeys(groups.tolist()):
        rows = np.flatnonzero((groups == value) & np.isfinite(ordinate))
        rows = rows[np.argsort(study[x][rows], kind="stable")]
        once = len(np.unique(study[x][rows])) == len(rows)
        label = "" if by is None else f"{value:g}" if isinstance(value, float) else value
        axes.plot(study[x][rows], ordinate[rows], "o-" if once else ".", ms=4, label=label)
    axes.set_xlabel(_label(study, x))
    axes.set_ylabel(_label(study, y))
    if by is not None:
        axes.legend(title=_label(study, by), frameon=False)
    axes.grid(alpha=0.3)
    axes.set_title(study.vehicle)
    return figure


def plot_fragility(fragility: Fragility) -> Figure:
    """Return a figure of counted probabilities with their intervals, and the fitted curve with its band."""
    figure = Figure(figsize=(7.0, 4.5), layout="constrained")
    axes = figure.subplots()
    p = fragility.probability
    bars = np.abs(np.array([fragility.low, fragility.high]) - p)
    level = f"{100 * fragility.confidence:g} %"
    axes.errorbar(fragility.speeds, p, yerr=bars, fmt="o", capsize=3, label=f"counted, {level} (Wilson)")
    if fragility.fit is not None:
        speeds = np.linspace(fragility.speeds[0], fragility.speeds[-1], 200)
        low, high = fragility.fit.band(speeds, fragility.confidence)
        axes.plot(speeds, fragility.fit.probability(speeds), color="C1", label="lognormal fit")
        axes.fill_between(speeds, low, high, color="C1", alpha=0.2, lw=0, label=f"{level} of the fit")
    axes.set_ylim(-0.03, 1.03)
    axes.set_xlabel("impact speed [m/s]")
    axes.set_ylabel(f"probability: {fragility.event}")
    axes.legend(frameon=False)
    axes.grid(alpha=0.3)
    return figure


def _label(study: Study, name: str) -> str:
    unit = study.units.get(name, "")
    return f"{name.replace('_', ' ')} [{unit}]" if unit else name.replace("_", " ")
