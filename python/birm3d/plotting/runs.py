"""Several runs in one figure, and bands of many."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .. import units
from ..barrier.text import barrier_text
from ..result.history_channels import HISTORY_CHANNELS, checked_channels
from ..scene.scene import Scene
from ..scene.text import overlap_text
from ..vehicle.title import vehicle_text
from .figure import new_figure
from .style import BLUE, CYCLE, LEAST_ANGLE, SOLID, at_least, legend, prepare, wrapped
from .time_axis import calm_from, shown_time

if TYPE_CHECKING:
    from ..result.result import Result
    from ..study.history_bands import HistoryBands

__all__ = ["plot_history_bands", "plot_runs"]

_MOST_RUNS = 8  # there are so many colours
_LOADS = ("g", "kN")
_THIN = 40  # at most so many runs are drawn as thin lines behind a band

# Inputs that distinguish scenes, in the order of titles.
_PARTS: Mapping[str, Callable[[Scene], str]] = {
    "vehicle": lambda scene: vehicle_text(scene.vehicle),
    "speed": lambda scene: f"{scene.impact_speed:.2f} m/s ({scene.impact_speed / units.mph:.1f} mph)",
    "angle": lambda scene: f"{scene.impact_angle:g}°{overlap_text(scene)}",
    "offset": lambda scene: f"offset {scene.impact_offset:g} m",
    "yaw": lambda scene: f"yaw {scene.impact_yaw:g}°",
    "roll": lambda scene: f"roll {scene.impact_roll:g}°",
    "barrier": lambda scene: "no barrier" if scene.barrier is None else barrier_text(scene.barrier),
    "friction": lambda scene: "" if scene.barrier is None else f"friction {scene.barrier.friction:g}",
}
_IN_HEAD = ("vehicle", "speed", "angle", "offset", "yaw", "roll")
_UNSAID = ("offset 0 m", "yaw 0°", "roll 0°")  # where all runs have it


def plot_runs(results: Sequence[Result], channels: Sequence[str], labels: Sequence[str] | None) -> Figure:
    """Return the figure that :func:`birm3d.plot_runs` describes."""
    names = checked_channels(channels)
    if not 1 <= len(results) <= _MOST_RUNS:
        raise ValueError(f"results must be 1 to {_MOST_RUNS} runs, got {len(results)}")
    if labels is not None and len(labels) != len(results):
        raise ValueError(f"labels must be {len(results)}, one for each run, got {len(labels)}")
    common, differ = _told_apart([result.scene for result in results])
    texts = differ if labels is None else _with_barriers(labels, [result.scene for result in results])
    figure, panels = _panels(names)
    for axes, name in zip(panels, names, strict=True):
        channel = HISTORY_CHANNELS[name]
        for i, (result, text) in enumerate(zip(results, texts, strict=True)):
            values = channel.values(result) / channel.size
            axes.plot(result.time * 1e3, values, color=CYCLE[i], label=text)
        _finish(axes, name)
    for axes in panels:
        axes.set_xlim(0.0, max(float(result.time[-1]) for result in results) * 1e3)
    handles, shown = panels[0].get_legend_handles_labels()
    figure.legend(handles, shown, loc="outside lower center", ncols=2, frameon=False, fontsize="small")
    figure.suptitle(wrapped(common, figure))
    return figure


def plot_history_bands(bands: HistoryBands) -> Figure:
    """Return the median and the band of each channel over time, some of the runs as thin lines behind.

    The vertical ranges are those of the bands: single runs may leave them. One run that slides on for
    seconds makes all last so long: the figure ends where the bands of forces and decelerations get calm.
    """
    names = tuple(bands.median)
    loads = [name for name in names if HISTORY_CHANNELS[name].unit in _LOADS]
    courses = [np.maximum(np.abs(bands.low[name]), np.abs(bands.high[name])) for name in loads]
    calm, whole = calm_from(bands.time, courses), float(bands.time[-1])
    figure, panels = _panels(names)
    ms = bands.time * 1e3
    step = -(-bands.n // _THIN)
    for axes, name in zip(panels, names, strict=True):
        size = HISTORY_CHANNELS[name].size
        axes.plot(
            ms, bands.runs[name][::step].T / size, color="0.5", ls=SOLID, lw=0.5, alpha=0.4, label="_runs"
        )
        band = f"{100 * bands.share:g} % of {bands.n} runs"
        axes.fill_between(
            ms, bands.low[name] / size, bands.high[name] / size, color=BLUE, alpha=0.25, lw=0, label=band
        )
        axes.plot(ms, bands.median[name] / size, color=BLUE, ls=SOLID, lw=2.0, label="median")
        _finish(axes, name)
        shown = bands.time <= shown_time([axes], calm, whole)
        low, high = float(bands.low[name][shown].min()) / size, float(bands.high[name][shown].max()) / size
        room = 0.08 * max(high - low, 1e-9)
        axes.set_ylim(low - room, high + room)
        legend([axes])
    figure.suptitle(wrapped(bands.title, figure), fontsize="medium")
    return figure


def _panels(names: Sequence[str]) -> tuple[Figure, list[Axes]]:
    columns = 1 if len(names) == 1 else 2
    rows = -(-len(names) // columns)
    figure = new_figure(5.8 * columns, 3.1 * rows + 0.9)
    panels = list(figure.subplots(rows, columns, squeeze=False, sharex=True).flat)
    for unused in panels[len(names) :]:
        unused.remove()
    prepare(*panels[: len(names)])
    return figure, panels[: len(names)]


def _finish(axes: Axes, name: str) -> None:
    channel = HISTORY_CHANNELS[name]
    words = channel.label
    axes.set_title(f"{words[0].upper()}{words[1:]}", fontsize="medium")
    axes.set_ylabel(f"{name.replace('_', ' ')} [{channel.unit}]")
    axes.set_xlabel("time [ms]")
    if channel.unit == "deg":
        at_least(axes, LEAST_ANGLE)


def _with_barriers(labels: Sequence[str], scenes: Sequence[Scene]) -> list[str]:
    """Return labels that name the barrier where the title can not."""
    barriers = [_PARTS["barrier"](scene) for scene in scenes]
    if len(set(barriers)) == 1:
        return list(labels)
    return [f"{label}: {barrier}" for label, barrier in zip(labels, barriers, strict=True)]


def _told_apart(scenes: Sequence[Scene]) -> tuple[str, list[str]]:
    """Return what scenes have in common as a title, and what each has for itself as a label."""
    told = {name: [tell(scene) for scene in scenes] for name, tell in _PARTS.items()}
    same = {name: texts[0] for name, texts in told.items() if len(set(texts)) == 1}
    head = ", ".join(same[name] for name in _IN_HEAD if same.get(name, _UNSAID[0]) not in _UNSAID)
    common = "\n".join(part for part in (head, same.get("barrier", "")) if part) or "several scenes"
    labels = [
        ", ".join(texts[i] for name, texts in told.items() if name not in same) or f"run {i + 1}"
        for i in range(len(scenes))
    ]
    if len(set(labels)) < len(labels):  # scenes that differ in other inputs
        labels = [
            f"run {i + 1}: {label}" if not label.startswith("run ") else label
            for i, label in enumerate(labels)
        ]
    return common, labels
