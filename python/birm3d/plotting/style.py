"""What all figures share: colours, titles, filtered lines, legends."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal

import numpy as np
import numpy.typing as npt
from cycler import cycler
from matplotlib.axes import Axes

from .. import units
from ..filters import cfc

if TYPE_CHECKING:
    from ..result import Result

__all__ = [
    "BLUE",
    "CYCLE",
    "GREEN",
    "ORANGE",
    "RED",
    "STYLES",
    "filtered",
    "fit",
    "legend",
    "plot_filtered",
    "prepare",
    "title",
]

Floats = npt.NDArray[np.float64]

# Okabe and Ito's palette, told apart by colour-blind readers; yellow is left out: too faint on white.
BLUE, ORANGE, GREEN, RED = "#0072B2", "#E69F00", "#009E73", "#D55E00"
CYCLE = (BLUE, RED, GREEN, "#CC79A7", ORANGE, "#56B4E9", "#000000", "#7F7F7F")
_UNFILTERED = "_unfiltered"
STYLES = ("-", "--", "-.", ":", "-", "--", "-", "--")


def prepare(*panels: Axes) -> None:
    """Give panels the grid and the colours."""
    for axes in panels:
        axes.grid(alpha=0.3, lw=0.6)
        axes.set_prop_cycle(cycler(color=CYCLE) + cycler(linestyle=STYLES))


def title(result: Result) -> str:
    """Return vehicle, mass, speed, angle and barrier in one line."""
    scene = result.scene
    speed = f"{scene.impact_speed:.2f} m/s ({scene.impact_speed / units.mph:.1f} mph)"
    if scene.barrier is None:
        return f"{scene.vehicle.name}, {scene.vehicle.mass:,.0f} kg, {speed}, no barrier"
    return f"{scene.vehicle.name}, {scene.vehicle.mass:,.0f} kg, {speed} at {scene.impact_angle:g}°"


def filtered(signal: Floats, channel_class: float, interval: float) -> tuple[Floats, str]:
    """Return a signal after a channel frequency class and what to call it.

    Where the rows are too far apart for the class (SAE J211-1), the signal as it is, and that is said.
    """
    if interval * channel_class > 0.1:
        return signal, "unfiltered: rows too far apart"
    return cfc(signal, channel_class, interval), f"CFC {channel_class:g}"


def plot_filtered(
    axes: Axes, result: Result, signal: Floats, channel_class: float, label: str, color: str, style: str = "-"
) -> None:
    """Draw a channel of a result filtered, and unfiltered as a thin line behind."""
    ms = result.time * 1e3
    values, name = filtered(signal, channel_class, result.scene.settings.output_interval)
    axes.plot(ms, signal, color=color, ls="-", lw=0.6, alpha=0.45, zorder=1.5, label=_UNFILTERED)
    axes.plot(ms, values, color=color, ls=style, lw=1.5, label=f"{label}, {name}" if label else name)


def fit(axes: Axes) -> None:
    """Let the named lines set the vertical range; unfiltered ones may widen it by half on either side.

    The impulse of a rigid contact within one row may be a thousand times the filtered force.
    """
    named: list[tuple[float, float]] = []
    unfiltered: list[tuple[float, float]] = []
    for line in axes.get_lines():
        values = np.asarray(line.get_ydata(), float)
        (unfiltered if line.get_label() == _UNFILTERED else named).append(
            (float(values.min()), float(values.max()))
        )
    if not named:
        return
    low, high = float(np.min(named)), float(np.max(named))
    room = 0.5 * (high - low)
    for least, most in unfiltered:
        low, high = min(low, max(least, low - room)), max(high, min(most, high + room))
    margin = 0.05 * (high - low)
    if margin > 0.0:
        axes.set_ylim(low - margin, high + margin)


def legend(
    axes: Sequence[Axes],
    loc: Literal["best", "center right", "upper right", "lower right"] = "best",
    columns: int = 1,
) -> None:
    """One legend for all axes that share a panel, on the last of them: it is drawn on top."""
    lines = [line for one in axes for line in one.get_lines()]
    shown = [line for line in lines if not str(line.get_label()).startswith("_")]
    axes[-1].legend(
        shown,
        [str(line.get_label()) for line in shown],
        loc=loc,
        ncols=columns,
        fontsize="small",
        framealpha=0.8,
        edgecolor="none",
    )
