"""Crush map and crush profile of one side of a vehicle."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..result.crush_profile import CrushProfile, Side, crush_map, crush_profile, side_words
from .figure import new_figure
from .style import BLUE, prepare, title

if TYPE_CHECKING:
    from ..result.result import Result

__all__ = ["plot_crush"]

_LATERAL = {
    "front": "s, to the vehicle's left [m]  (left is left, as the driver sees it)",
    "rear": "s, to the vehicle's left [m]  (seen from behind)",
    "left": "r, forward of the mass centre [m]  (seen from the vehicle's left)",
    "right": "r, forward of the mass centre [m]  (seen from the vehicle's right)",
}
_PANEL_WIDTH, _PROFILE_HEIGHT = 8.0, 2.4  # inches
_UNITS = ("Leading unit", "Trailing unit")
_LEAST_SCALE = 0.01  # m: the colours of an uncrushed vehicle


def plot_crush(
    result: Result, side: Side | None = None, *, height: float | None = None, unit: int = 0
) -> Figure:
    """Return a map of the residual crush of one side, and below it the crush profile with C1 to C6.

    Crush is counted square to the side. The six points are evenly spaced over the width of the side at one
    height (CRASH3, NHTSA); see :func:`birm3d.result.crush_profile.crush_profile`.

    Parameters
    ----------
    side
        ``"front"``, ``"rear"``, ``"left"`` or ``"right"``; ``None``: that with the greatest crush.
    height
        Of the profile above the ground at rest [m]; ``None``: the middle of the bumper in front, else where
        the crush is greatest.
    unit
        Of the vehicle.

    Raises
    ------
    ValueError
        If the side is unknown, the unit has no skin there, or none at that height.
    """
    field = crush_map(result, side, unit=unit)
    side = field.side
    profile = crush_profile(result, side, height=height, unit=unit)
    nodes = np.unique(field.triangles)
    low, high = float(field.lateral[nodes].min()), float(field.lateral[nodes].max())
    margin = 0.05 * (high - low)
    # Both panels are as wide and show the same range, so that the points stand below each other.
    shape = (float(np.ptp(field.height[nodes])) + 2.0 * margin) / (high - low + 2.0 * margin)
    map_height = max(1.2, _PANEL_WIDTH * shape)
    figure = new_figure(_PANEL_WIDTH + 2.0, map_height + _PROFILE_HEIGHT + 2.0)
    above, below = figure.subplots(2, 1, height_ratios=(map_height, _PROFILE_HEIGHT))
    prepare(below)

    greatest = max(_LEAST_SCALE, float(field.crush[nodes].max()))
    shown = np.clip(field.crush, 0.0, None)
    colors = above.tripcolor(
        field.lateral,
        field.height,
        field.triangles,
        shown,
        shading="gouraud",
        cmap="YlOrRd",
        vmin=0.0,
        vmax=greatest,
    )
    lines = None
    if float(field.crush[nodes].max()) > _LEAST_SCALE:
        step = _round_step(greatest / 6.0)
        levels = np.arange(step, greatest, step)
        lines = above.tricontour(
            field.lateral, field.height, field.triangles, shown, levels=levels, colors="k", linewidths=0.7
        )
    above.triplot(field.lateral, field.height, field.triangles, color="k", lw=0.15, alpha=0.25)
    above.axhline(profile.height, color=BLUE, lw=1.2, ls="--")
    above.plot(profile.stations, np.full(6, profile.height), "o", color=BLUE, mec="w", ms=7.0)
    above.set_ylabel("height above the ground [m]")
    above.set_aspect("equal")
    part = "" if len(result.scene.vehicle.units) == 1 else f"{_UNITS[unit]}: "
    above.set_title(
        f"{part}Residual crush of the {side_words(side)}, greatest {float(shown[nodes].max()):.3f} m"
    )
    bar = figure.colorbar(colors, ax=[above, below], label="residual crush [m]", pad=0.02)
    if lines is not None:
        bar.add_lines(lines)

    _draw_profile(below, profile)
    limits = (low - margin, high + margin)
    for axes in (above, below):
        axes.set_xlim(limits if side == "right" else limits[::-1])
    heights = field.height[nodes]
    above.set_ylim(float(heights.min()) - margin, float(heights.max()) + margin)
    figure.suptitle(title(result, figure))
    figure.draw_without_rendering()  # the map's equal scales move it, and with it the room for labels
    return figure


def _draw_profile(below: Axes, profile: CrushProfile) -> None:
    """Draw the crush along the side, and C1 to C6."""
    below.plot(profile.lateral, profile.crush, color="0.35", ls="-", lw=1.2)
    below.fill_between(profile.lateral, profile.crush, color="0.35", alpha=0.15, lw=0.0)
    below.plot(profile.stations, profile.points, "o", color=BLUE, mec="w", ms=7.0, zorder=3.0)
    for i, (place, crush) in enumerate(zip(profile.stations, profile.points, strict=True)):
        text = f"C{i + 1}\n{round(crush * 1e3)} mm"
        below.annotate(
            text,
            (place, crush),
            (0, 7),
            textcoords="offset points",
            ha="center",
            fontsize="small",
            bbox={"boxstyle": "round,pad=0.1", "fc": "w", "ec": "none", "alpha": 0.7},
        )
    below.set_ylim(0.0, 1.45 * max(_LEAST_SCALE, float(profile.crush.max())))
    below.set_ylabel("residual crush [m]")
    below.set_xlabel(_LATERAL[profile.side])
    below.set_title(
        f"Crush profile {profile.height:.2f} m above the ground, width {profile.width:.2f} m, "
        f"mean of C1 to C6 {profile.mean:.3f} m",
        fontsize="medium",
    )


def _round_step(step: float) -> float:
    """Return the next of 1, 2, 5 times a power of ten."""
    power = 10.0 ** np.floor(np.log10(step))
    return float(power * min(m for m in (1.0, 2.0, 5.0, 10.0) if m * power >= step * (1.0 - 1e-9)))
