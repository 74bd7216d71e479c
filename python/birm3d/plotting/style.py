"""What all figures share: colours, titles, filtered lines, legends."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Sequence
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
import numpy.typing as npt
from cycler import cycler
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..scene.text import scene_text
from ..signals.filters import cfc
from .blows import name_cut_peaks, readable_level

if TYPE_CHECKING:
    from ..result.result import Result

__all__ = [
    "BLUE",
    "CYCLE",
    "DASHED",
    "DASH_DOT",
    "DOTTED",
    "GREEN",
    "LEAST_ANGLE",
    "LEAST_RATE",
    "ORANGE",
    "RED",
    "SOLID",
    "STYLES",
    "WIDTHS",
    "Style",
    "at_least",
    "cut_peaks",
    "filtered",
    "fit",
    "legend",
    "level_zeros",
    "plot_filtered",
    "prepare",
    "title",
    "wrapped",
]

Floats = npt.NDArray[np.float64]

LEAST_ANGLE, LEAST_RATE = 1.0, 1.0
"""Least ranges of panels with angles [deg] and angular rates [deg/s]."""

# Okabe and Ito's palette, which colour-blind readers can distinguish. Yellow is too faint on white.
BLUE, ORANGE, GREEN, RED = "#0072B2", "#E69F00", "#009E73", "#D55E00"
CYCLE = (BLUE, ORANGE, RED, GREEN, "#CC79A7", "#56B4E9", "#000000", "#7F7F7F")
_UNFILTERED = "_unfiltered"
_LEAST_ROWS = 3  # of a history; fewer are a straight line
Style: TypeAlias = str | tuple[float, tuple[float, ...]]
# Dashes with wide gaps, in line widths: a line below shows in them.
SOLID: Style = "-"
DASHED: Style = (0.0, (5.0, 3.5))
DASH_DOT: Style = (0.0, (8.0, 3.0, 1.5, 3.0))
DOTTED: Style = (0.0, (1.2, 2.0))
STYLES = (SOLID, DASHED, DASH_DOT, DOTTED, SOLID, DASHED, SOLID, DASHED)
# Earlier lines are wider: where a later one lies on them, they show on both sides and in its gaps.
WIDTHS = (3.2, 2.0, 1.5, 1.8, 1.2, 1.2, 1.0, 1.0)
# Of a legend's text: mean width of a letter, of a line sample with its gaps, and height of a row, points.
_LETTER, _SAMPLE, _ROW = 4.7, 42.0, 13.5
_LETTERS_PER_INCH = 11.2  # of a title in one line
_UNITS = "N|kN|MN|J|kJ|MJ|Pa|kPa|MPa|kg|t|lb|mm|cm|m|in|ft|ms|s|km/h|m/s|mph|g|deg|°|%"
_BEFORE_UNIT = re.compile(rf"(?<=\d) (?=(?:{_UNITS})(?![\w/]))")
_WITHIN_UNIT = re.compile(r"(?<=N) (?=[ms]\b)")


def prepare(*panels: Axes) -> None:
    """Give panels the grid and the colours."""
    for axes in panels:
        axes.grid(alpha=0.3, lw=0.6)
        axes.set_prop_cycle(cycler(color=CYCLE) + cycler(linestyle=STYLES) + cycler(linewidth=WIDTHS))


def title(result: Result, figure: Figure | None = None) -> str:
    """Return vehicle, mass, speed and angle, and in a second line the barrier: kind, count and sizes.

    Lines that are longer than the ``figure`` is wide are broken.
    """
    text = scene_text(result.scene, separator="\n")
    return text if figure is None else "\n".join(wrapped(line, figure) for line in text.splitlines())


def filtered(signal: Floats, channel_class: float, interval: float) -> tuple[Floats, str]:
    """Return a signal after a channel frequency class and what to call it.

    Where the rows are too far apart for the class (SAE J211-1), the signal as it is, and that is said.
    """
    if interval * channel_class > 0.1:
        return signal, "unfiltered: rows too far apart"
    return cfc(signal, channel_class, interval), f"CFC {channel_class:g}"


def plot_filtered(
    axes: Axes, result: Result, signal: Floats, channel_class: float, label: str, color: str, order: int = 0
) -> None:
    """Draw a channel of a result filtered, and unfiltered as a thin line behind.

    ``order`` is that of the channel in its panel: it chooses style and width.
    """
    ms = result.time * 1e3
    values, name = filtered(signal, channel_class, result.scene.settings.output_interval)
    axes.plot(ms, signal, color=color, ls="-", lw=0.6, alpha=0.35, zorder=1.5, label=_UNFILTERED)
    axes.plot(ms, values, color=color, ls=STYLES[order], lw=WIDTHS[order], label=f"{label}, {name}")


def fit(axes: Axes) -> None:
    """Let the named lines set the vertical range; unfiltered ones may widen it by half on either side.

    The impulse of a rigid contact within one row may be a thousand times the filtered force. A filtered blow
    that would flatten all the rest is cut off, see :func:`cut_peaks`. Horizontal places are in ms.
    """
    named: list[tuple[float, float]] = []
    unfiltered: list[tuple[float, float]] = []
    for line in axes.get_lines():
        values = np.asarray(line.get_ydata(), float)
        ends = (float(values.min()), float(values.max()))
        if line.get_label() == _UNFILTERED:
            unfiltered.append(ends)
            continue
        level = _readable(np.asarray(line.get_xdata(), float), values)
        named.append((max(ends[0], -level), min(ends[1], level)))
    if not named:
        return
    low, high = float(np.min(named)), float(np.max(named))
    room = 0.5 * (high - low)
    for least, most in unfiltered:
        low, high = min(low, max(least, low - room)), max(high, min(most, high + room))
    margin = 0.05 * (high - low)
    if margin > 0.0:
        axes.set_ylim(low - margin, high + margin)


def _readable(ms: Floats, values: Floats) -> float:
    if len(values) < _LEAST_ROWS:  # a straight line
        return float(np.abs(values).max(initial=0.0))
    return readable_level(values, float(ms[1] - ms[0]) / 1e3)


def cut_peaks(*all_axes: Axes) -> None:
    """Write the peaks that a panel cuts off, with the units of its labels; its limits must be final.

    Axes that share the panel are given together.
    """
    panel = []
    for axes in all_axes:
        lines = [line for line in axes.get_lines() if line.get_label() != _UNFILTERED]
        curves = [
            (np.asarray(line.get_xdata(), float), np.asarray(line.get_ydata(), float)) for line in lines
        ]
        unit = axes.get_ylabel().partition("[")[2].rstrip("]")
        panel.append((axes, [curve for curve in curves if len(curve[1]) >= _LEAST_ROWS], unit))
    name_cut_peaks(panel)


def level_zeros(*all_axes: Axes) -> None:
    """Draw the zeros of axes that share a panel at one height: lower limits fall as far as that asks for."""
    limits = [axes.get_ylim() for axes in all_axes]
    if any(high <= 0.0 for _, high in limits):
        return
    below = max(max(-low, 0.0) / high for low, high in limits)
    for axes, (_, high) in zip(all_axes, limits, strict=True):
        axes.set_ylim(-below * high, high)


def at_least(axes: Axes, span: float) -> None:
    """Widen a vertical range that is narrower than the span: rounding errors are not drawn as motion."""
    low, high = axes.get_ylim()
    if high - low < span:
        middle = 0.5 * (low + high)
        axes.set_ylim(middle - 0.5 * span, middle + 0.5 * span)


def legend(axes: Sequence[Axes]) -> None:
    """One legend for all axes that share a panel, between the panel and its title, off the curves.

    It is on the last of the axes, which is drawn on top. The title must have been set on the first.
    """
    found = [one.get_legend_handles_labels() for one in axes]
    shown = [handle for handles, _ in found for handle in handles]
    labels = [label for _, names in found for label in names]
    if not labels:
        return
    columns = _columns(axes[0], labels)
    axes[-1].legend(
        shown,
        labels,
        loc="lower left",
        bbox_to_anchor=(0.0, 1.0),
        ncols=columns,
        fontsize="small",
        frameon=False,
        borderaxespad=0.1,
        borderpad=0.2,
        columnspacing=1.2,
        handlelength=3.2,
    )
    rows = -(-len(labels) // columns)
    axes[0].set_title(axes[0].get_title(), pad=6.0 + _ROW * rows, fontsize=axes[0].title.get_fontsize())


def wrapped(text: str, figure: Figure) -> str:
    """Return a title in as many lines as the figure's width asks for; the barrier begins a line.

    Lines are broken between words. A number stays with its unit, by a non-breaking space.
    """
    letters = round(_LETTERS_PER_INCH * figure.get_figwidth())
    lines = []
    for line in text.splitlines():
        parts = [line] if len(line) <= letters else re.split("(?<=:) ", line, maxsplit=1)
        lines += [broken for part in parts for broken in textwrap.wrap(_with_units(part), letters)]
    return "\n".join(lines)


def _with_units(text: str) -> str:
    """Return a text with non-breaking spaces between numbers and units, and within units."""
    return _WITHIN_UNIT.sub("\u00a0", _BEFORE_UNIT.sub("\u00a0", text))


def _columns(axes: Axes, labels: Sequence[str]) -> int:
    """Return how many columns of labels are as wide as the panel at the most."""
    place = axes.get_subplotspec()
    panels = 1 if place is None else place.get_gridspec().ncols
    room = 72.0 * (axes.figure.bbox.width / axes.figure.dpi / panels - 1.2)
    for columns in range(len(labels), 1, -1):
        # Rows are shared out as matplotlib does: the first columns have one more.
        shares = np.array_split([len(label) for label in labels], columns)
        widest = [int(letters.max()) for letters in shares]
        if sum(_SAMPLE + _LETTER * letters for letters in widest) <= room:
            return columns
    return 1
