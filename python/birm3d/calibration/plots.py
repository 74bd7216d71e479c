"""Figures of a calibration. matplotlib is imported here only."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

if TYPE_CHECKING:
    from .fitted import FittedTarget
    from .result import CalibrationResult

__all__ = ["plot_fit", "plot_profiles", "plot_residuals"]


def plot_fit(result: CalibrationResult) -> Figure:
    """Return measured curves under computed ones, before and after; scalars in a panel of their own."""
    curves, scalars = _split(result)
    figure, panels = _panels(len(curves) + bool(scalars))
    for axes, target in zip(panels, curves, strict=False):
        scale = _x_scale(target)
        axes.plot(target.x * scale, target.measured, "k", lw=1.2, label="measured")
        axes.plot(target.x * scale, target.started, "C1", lw=1.0, ls=":", label="computed at the start")
        axes.plot(target.x * scale, target.computed, "C0", lw=1.4, label="computed, fitted")
        _curve_axes(axes, target, f"{target.label} [{target.unit}]")
        axes.legend(frameon=False, fontsize="small")
    if scalars:
        _scalar_panel(panels[len(curves)], scalars)
    return figure


def plot_residuals(result: CalibrationResult) -> Figure:
    """Return computed less measured over the standard deviation; a band shows 2."""
    curves, scalars = _split(result)
    figure, panels = _panels(len(curves) + bool(scalars))
    for axes, target in zip(panels, curves, strict=False):
        axes.plot(
            target.x * _x_scale(target), (target.computed - target.measured) / target.sigma, "C0", lw=0.9
        )
        axes.axhspan(-2.0, 2.0, color="C0", alpha=0.12, lw=0.0)
        _curve_axes(axes, target, f"{target.label}: (computed - measured) / sigma")
    if scalars:
        _scalar_panel(panels[len(curves)], scalars)
    return figure


def plot_profiles(result: CalibrationResult) -> Figure:
    """Return the rise of chi-square along each parameter; a line shows where intervals end."""
    profiles = list(result.profiles.values())
    figure, panels = _panels(len(profiles))
    for axes, profile in zip(panels, profiles, strict=False):
        axes.plot(profile.values, profile.rise, "C0.-", lw=1.2)
        axes.axhline(profile.threshold, color="C3", lw=0.8, ls="--")
        axes.set_ylim(0.0, max(2.0 * profile.threshold, 1.05 * float(np.min([profile.rise.max(), 30.0]))))
        for end in (profile.lower, profile.upper):
            if end is not None:
                axes.axvline(end, color="C3", lw=0.8, ls=":")
        axes.set_xlabel(profile.name)
        axes.set_ylabel("rise of chi-square")
        axes.grid(alpha=0.3)
    return figure


def _split(result: CalibrationResult) -> tuple[list[FittedTarget], list[FittedTarget]]:
    curves = [target for target in result.targets if target.against is not None]
    return curves, [target for target in result.targets if target.against is None]


def _panels(n: int) -> tuple[Figure, list[Axes]]:
    columns = 1 if n == 1 else 2
    rows = -(-n // columns)
    figure = Figure(figsize=(5.5 * columns, 3.6 * rows), layout="constrained")
    panels = list(figure.subplots(rows, columns, squeeze=False).ravel())
    for unused in panels[n:]:
        unused.set_visible(False)
    return figure, panels


def _x_scale(target: FittedTarget) -> float:
    return 1e3 if target.against == "time" else 1.0


def _curve_axes(axes: Axes, target: FittedTarget, label: str) -> None:
    axes.set_xlabel("time [ms]" if target.against == "time" else "displacement of the mass centre [m]")
    axes.set_ylabel(label)
    axes.grid(alpha=0.3)


def _scalar_panel(axes: Axes, scalars: list[FittedTarget]) -> None:
    rows = np.arange(len(scalars))
    for started, color, label in ((True, "C1", "at the start"), (False, "C0", "fitted")):
        left = [((t.started if started else t.computed) - t.measured)[0] / t.sigma[0] for t in scalars]
        axes.plot(left, rows, "o", color=color, label=label)
    axes.axvspan(-2.0, 2.0, color="C0", alpha=0.12, lw=0.0)
    axes.set_yticks(rows, [target.label for target in scalars])
    axes.set_xlabel("(computed - measured) / sigma")
    axes.legend(frameon=False, fontsize="small")
    axes.grid(alpha=0.3)
