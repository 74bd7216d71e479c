"""Measured curves beside computed ones."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..base.shown_numbers import shown_unit
from .figure import new_figure
from .style import BLUE, DASHED, RED, legend, prepare

if TYPE_CHECKING:
    from ..signals.compare import CurveComparison

__all__ = ["plot_comparison", "plot_comparisons"]


def plot_comparison(comparison: CurveComparison) -> Figure:
    """Return both curves above, and below the residuals over the measured peak with mean ± deviation."""
    figure = new_figure(9.0, 6.4)
    curves, below = figure.subplots(2, 1, sharex=True, height_ratios=(2, 1))
    prepare(curves, below)
    _curves(curves, comparison)
    measured, computed = comparison.measured, comparison.computed
    ms = measured.time * 1e3
    peak = np.abs(measured.values).max()
    mean, deviation = comparison.residuals
    below.plot(ms, 100.0 * (measured.values - computed.values) / peak, color=RED, ls="-", lw=1.0)
    below.axhline(100.0 * mean, color=RED, ls=":")
    below.axhspan(100.0 * (mean - deviation), 100.0 * (mean + deviation), color=RED, alpha=0.15)
    below.axhline(0.0, color="0.5", lw=0.6)
    below.set_ylabel("measured − computed\n[% of measured peak]")
    below.set_xlabel("time [ms]")
    figure.suptitle(_rating(comparison), fontsize="medium")
    return figure


def plot_comparisons(comparisons: Sequence[CurveComparison], columns: int = 2) -> Figure:
    """Return a panel for each comparison: both curves, their ratings above.

    Raises
    ------
    ValueError
        If there are no comparisons or no columns.
    """
    if len(comparisons) == 0:
        raise ValueError("comparisons must be at least one, got none")
    if columns < 1:
        raise ValueError(f"columns must be at least 1, got {columns}")
    columns = min(columns, len(comparisons))
    rows = -(-len(comparisons) // columns)
    figure = new_figure(5.8 * columns, 3.9 * rows)
    panels = list(figure.subplots(rows, columns, squeeze=False).flat)
    for axes, comparison in zip(panels, comparisons, strict=False):
        prepare(axes)
        axes.set_title(_rating(comparison).replace("; residuals", "\nresiduals"), fontsize="small")
        _curves(axes, comparison)
        axes.set_xlabel("time [ms]")
    for unused in panels[len(comparisons) :]:
        unused.set_visible(False)
    return figure


def _curves(axes: Axes, comparison: CurveComparison) -> None:
    measured, computed = comparison.measured, comparison.computed
    ms = measured.time * 1e3
    scale, unit = shown_unit(measured.unit)
    axes.plot(ms, measured.values / scale, color="0.2", ls="-", lw=2.2, label=f"measured: {measured.name}")
    axes.plot(ms, computed.values / scale, color=BLUE, ls=DASHED, lw=1.6, label=f"computed: {computed.name}")
    class_ = f", CFC {measured.cfc:g}" if measured.cfc is not None else ""
    axes.set_ylabel(f"{measured.quantity} [{unit}]{class_}")
    legend([axes])


def _rating(comparison: CurveComparison) -> str:
    magnitude, phase, _ = comparison.sprague_geers
    mean, deviation = comparison.residuals
    rating = comparison.rating
    return (
        f"Sprague-Geers M {magnitude:+.1%}, P {phase:.1%}; residuals {mean:+.1%} ± {deviation:.1%}; "
        f"ISO/TS 18571 {rating.overall:.2f} ({rating.grade})"
    )
