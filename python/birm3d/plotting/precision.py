"""Figures of studies of errors. matplotlib is imported here only."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter

from ..study.verification.precision_result import AS_GIVEN
from .figure import new_figure
from .style import legend

if TYPE_CHECKING:
    from ..study.verification.precision_result import PrecisionRow, WorkPrecision

__all__ = ["plot_requested_vs_achieved", "plot_work_precision"]

# An error of zero has no logarithm: it is drawn here.
_NIL = 1e-12
_LABELS = {"tolerance": "adaptive", "time_step": "fixed step", "mesh_density": "mesh, own settings"}


def plot_work_precision(study: WorkPrecision, metrics: Collection[str] | None = None) -> Figure:
    """Return a figure of the greatest error against run time, and against force evaluations; log-log.

    The shade is what the converged value is not known to: no error below it means anything.
    """
    figure = new_figure(11.0, 4.6)
    left, right = figure.subplots(1, 2, sharey=True)
    lines = dict.fromkeys((row.variant, row.kind) for row in study.rows if row.kind != "reference")
    for i, (variant, kind) in enumerate(lines):
        rows = [row for row in study.of(variant, kind) if row.errors]
        if not rows:
            continue
        errors = [max(row.error_of(metrics), _NIL) for row in rows]
        label = _LABELS[kind] if variant in (AS_GIVEN, "mesh") else f"{_LABELS[kind]}, {variant}"
        style = {"label": label, "color": f"C{i}", "ms": 4, "ls": "-" if variant == AS_GIVEN else "--"}
        left.plot([1e3 * row.run_time for row in rows], errors, "o", **style)
        right.plot([max(row.force_evaluations, 1) for row in rows], errors, "o", **style)
    if study.default.errors:
        error = max(study.default.error_of(metrics), _NIL)
        left.plot([1e3 * study.default.run_time], [error], "k*", ms=11, label="the scene's own settings")
        right.plot([max(study.default.force_evaluations, 1)], [error], "k*", ms=11)
    shade = max(_uncertainty(study, metrics), _NIL)
    seen = np.concatenate([np.asarray(line.get_ydata(), float) for line in left.lines])
    for axes in (left, right):
        axes.set(xscale="log", yscale="log")
        axes.set_ylim(0.5 * min(shade, seen.min()), 2.0 * max(shade, seen.max()))
        axes.axhspan(0.1 * _NIL, shade, color="0.85", lw=0, zorder=0)
        axes.grid(alpha=0.3)
        axes.xaxis.set_minor_formatter(NullFormatter())  # over less than a decade its labels overlap
    left.set_xlabel("run time, stepping only [ms]")
    right.set_xlabel("force evaluations of nodes")
    left.set_ylabel("greatest relative error of any metric")
    legend([left])
    figure.suptitle(study.title, fontsize="medium")
    return figure


def plot_requested_vs_achieved(study: WorkPrecision, metrics: Collection[str] | None = None) -> Figure:
    """Return a figure of the error of each metric against the tolerance asked for; log-log."""
    figure = new_figure(8.5, 5.2)
    axes = figure.subplots()
    rows = [row for row in study.of(AS_GIVEN, "tolerance") if row.errors]
    asked = np.array([row.value for row in rows])
    names = [name for name in study.converged if metrics is None or name in metrics]
    # The ten that miss what was asked for by most have a name in the legend.
    names.sort(key=lambda name: -max((row.errors[name] / row.value for row in rows), default=0.0))
    for i, name in enumerate(names):
        errors = _achieved(rows, name)
        color, label = (f"C{i}", name) if i < 10 else ("0.7", "_")
        axes.plot(asked, errors, ".-", lw=0.8, color=color, label=label)
    axes.plot(asked, [max(row.error_of(metrics), _NIL) for row in rows], "k-", lw=1.8, label="greatest")
    axes.plot(asked, asked, "k--", lw=1.0, label="achieved = requested")
    axes.plot(asked, 10.0 * asked, "k:", lw=1.0, label="ten times that")
    shade = _uncertainty(study, metrics)
    axes.axhspan(
        _NIL, max(shade, _NIL), color="0.9", lw=0, zorder=0, label="not known of the converged value"
    )
    axes.set(xscale="log", yscale="log", ylim=(1e-9, None))
    axes.set_xlabel("requested: tolerance")
    axes.set_ylabel("achieved: relative error")
    axes.legend(frameon=False, fontsize="x-small", loc="center left", bbox_to_anchor=(1.0, 0.5))
    axes.grid(alpha=0.3)
    axes.set_title(study.title, fontsize="medium")
    return figure


def _achieved(rows: Sequence[PrecisionRow], name: str) -> list[float]:
    return [max(row.errors[name], _NIL) for row in rows]


def _uncertainty(study: WorkPrecision, metrics: Collection[str] | None) -> float:
    return max(
        (u for name, u in study.uncertainty.items() if metrics is None or name in metrics), default=0.0
    )
