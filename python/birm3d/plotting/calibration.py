"""Figures of a calibration. matplotlib is imported here only."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.interpolate import PchipInterpolator

from ..base.shown_numbers import shown_unit
from .figure import new_figure
from .style import BLUE, DASHED, DOTTED, ORANGE, RED, legend, prepare

if TYPE_CHECKING:
    from ..calibration.fitted import FittedTarget
    from ..calibration.profile import Profile
    from ..calibration.result import CalibrationResult

__all__ = ["plot_fit", "plot_profiles", "plot_residuals", "smooth_profile"]

Floats = npt.NDArray[np.float64]


def plot_fit(result: CalibrationResult) -> Figure:
    """Return measured curves under computed ones, before and after; scalars in a panel of their own."""
    curves, scalars = _split(result)
    figure, panels = _panels(len(curves) + bool(scalars))
    for axes, target in zip(panels, curves, strict=False):
        x = target.x * _x_scale(target)
        size, unit = shown_unit(target.unit)
        axes.plot(x, target.measured / size, "k", ls="-", lw=2.6, label="measured")
        axes.plot(x, target.started / size, ORANGE, lw=1.6, ls=DOTTED, label="computed at the start")
        axes.plot(x, target.computed / size, BLUE, lw=1.6, ls=DASHED, label="computed, fitted")
        _curve_axes(axes, target, f"{target.label} [{unit}]")
        legend([axes])
    if scalars:
        _scalar_panel(panels[len(curves)], scalars)
    return figure


def plot_residuals(result: CalibrationResult) -> Figure:
    """Return computed less measured over the standard deviation; a band shows 2."""
    curves, scalars = _split(result)
    figure, panels = _panels(len(curves) + bool(scalars))
    for axes, target in zip(panels, curves, strict=False):
        residuals = (target.computed - target.measured) / target.sigma
        axes.plot(target.x * _x_scale(target), residuals, BLUE, ls="-", lw=0.9)
        axes.axhspan(-2.0, 2.0, color=BLUE, alpha=0.12, lw=0.0)
        _curve_axes(axes, target, f"{target.label}: (computed - measured) / sigma")
    if scalars:
        _scalar_panel(panels[len(curves)], scalars)
    return figure


def plot_profiles(result: CalibrationResult) -> Figure:
    """Return the rise of chi-square along each parameter; a line shows where intervals end.

    Dots are what was computed. The curve goes through all of them, see :func:`smooth_profile`.
    """
    profiles = list(result.profiles.values())
    figure, panels = _panels(len(profiles))
    for axes, profile in zip(panels, profiles, strict=False):
        size, unit = shown_unit(result[profile.name].unit)
        values, rise = smooth_profile(profile)
        axes.plot(values / size, rise, BLUE, ls="-", lw=1.6, label="through the points")
        computed = np.maximum(profile.rise, 0.0)
        axes.plot(profile.values / size, computed, "o", color=BLUE, ls="none", ms=4, label="computed")
        axes.axhline(profile.threshold, color=RED, lw=1.0, ls="--", label="threshold")
        top = max(2.0 * profile.threshold, 1.05 * float(np.min([profile.rise.max(), 30.0])))
        axes.set_ylim(-0.03 * top, top)
        ends = [end for end in (profile.lower, profile.upper) if end is not None]
        for k, end in enumerate(ends):
            axes.axvline(end / size, color=RED, lw=1.0, ls=":", label="_" if k else "ends of the interval")
        axes.set_xlabel(f"{profile.name} [{unit}]" if unit else profile.name)
        axes.set_ylabel("rise of chi-square")
        legend([axes])
    return figure


def smooth_profile(profile: Profile, points: int = 200) -> tuple[Floats, Floats]:
    """Return a smooth curve through the computed points of a profile, and nothing beyond them.

    The signed root of the rise is nearly a straight line (Bates and Watts 1988, section 6.1). The curve is
    the square of its piecewise cubic through the points, which is monotonic between them (Fritsch and Carlson
    1980).
    """
    values, first = np.unique(profile.values, return_index=True)
    rise = np.maximum(profile.rise[first], 0.0)
    if len(values) < 3:
        return values, rise
    best = values[int(np.argmin(rise))]
    root = np.where(values < best, -1.0, 1.0) * np.sqrt(rise)
    fine = np.union1d(np.linspace(values[0], values[-1], points), values)
    return fine, np.asarray(PchipInterpolator(values, root)(fine)) ** 2


def _split(result: CalibrationResult) -> tuple[list[FittedTarget], list[FittedTarget]]:
    curves = [target for target in result.targets if target.against is not None]
    return curves, [target for target in result.targets if target.against is None]


def _panels(n: int) -> tuple[Figure, list[Axes]]:
    columns = 1 if n == 1 else 2
    rows = -(-n // columns)
    figure = new_figure(5.5 * columns, 3.9 * rows)
    panels = list(figure.subplots(rows, columns, squeeze=False).ravel())
    prepare(*panels[:n])
    for unused in panels[n:]:
        unused.set_visible(False)
    return figure, panels


def _x_scale(target: FittedTarget) -> float:
    return 1e3 if target.against == "time" else 1.0


def _curve_axes(axes: Axes, target: FittedTarget, label: str) -> None:
    axes.set_xlabel("time [ms]" if target.against == "time" else "displacement of the mass centre [m]")
    axes.set_ylabel(label)


def _scalar_panel(axes: Axes, scalars: list[FittedTarget]) -> None:
    rows = np.arange(len(scalars))
    for started, color, label in ((True, ORANGE, "at the start"), (False, BLUE, "fitted")):
        left = [((t.started if started else t.computed) - t.measured)[0] / t.sigma[0] for t in scalars]
        axes.plot(left, rows, "o", color=color, ls="none", label=label)
    axes.axvspan(-2.0, 2.0, color=BLUE, alpha=0.12, lw=0.0)
    axes.set_yticks(rows, [target.label for target in scalars])
    axes.set_xlabel("(computed - measured) / sigma")
    legend([axes])
