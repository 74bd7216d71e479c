"""Loads on the elements of a barrier against time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from ..element_loads import LEAST_SHARE, resultant_height, touched_elements
from .style import CYCLE, STYLES, filtered, legend, prepare, title

if TYPE_CHECKING:
    from ..result import Result

__all__ = ["plot_elements"]


def plot_elements(result: Result) -> Figure:
    """Return force, height of the resultant and overturning moment of each element that was touched.

    Forces and moments after CFC 60 (SAE J211-1), before magnitudes are taken; heights follow from them and
    are not drawn where the horizontal force is below 1 % of its peak.

    Raises
    ------
    ValueError
        If nothing was touched.
    """
    loads = touched_elements(result)
    if not loads:
        raise ValueError("elements must have been touched to be drawn, got none that was")
    figure = Figure(figsize=(10.0, 9.0), layout="constrained")
    panels = figure.subplots(3, 1, sharex=True)
    force_panel, height_panel, moment_panel = panels
    prepare(*panels)
    ms = result.time * 1e3
    name = ""
    for i, load in enumerate(loads):
        look = {"color": CYCLE[i % len(CYCLE)], "ls": STYLES[i % len(STYLES)], "lw": 1.5}
        force, name = filtered(load.force, 60, load.interval)
        moment, _ = filtered(load.moment, 60, load.interval)
        level = np.hypot(force[:, 0], force[:, 1])
        height = np.where(level > LEAST_SHARE * level.max(), resultant_height(force, moment), np.nan)
        force_panel.plot(ms, np.linalg.norm(force, axis=1) / 1e3, label=load.name, **look)
        height_panel.plot(ms, height, label=load.name, **look)
        moment_panel.plot(ms, np.hypot(moment[:, 0], moment[:, 1]) / 1e3, label=load.name, **look)
    force_panel.set_title(f"Force on the element, {name}")
    force_panel.set_ylabel("force [kN]")
    height_panel.set_title("Height of the horizontal resultant above the foot")
    height_panel.set_ylabel("height [m]")
    moment_panel.set_title(f"Overturning moment about the foot, {name}")
    moment_panel.set_ylabel("moment [kN m]")
    moment_panel.set_xlabel("time [ms]")
    moment_panel.set_xlim(0.0, float(ms[-1]))
    legend([force_panel], columns=1 if len(loads) < 6 else 2)
    figure.suptitle(title(result))
    return figure
