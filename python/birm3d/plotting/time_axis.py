"""Where a figure of histories ends: when nothing goes on but a vehicle that rests, or slides along."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes

from ..signals.filters import moving_average

if TYPE_CHECKING:
    from ..result.result import Result

__all__ = ["calm_from", "limit_time", "shown_time"]

Floats = npt.NDArray[np.float64]

_CALM = 0.05  # of the greatest force and of the greatest angular velocity; below that a run is calm
_MOST = 0.6  # of the run; a figure ends early only if it then shows less than this
_ROOM = 1.1  # times the last instant that is not calm: there such a figure ends
_WINDOW = 0.01  # s, over which the force is a mean


def limit_time(panels: Iterable[Axes], result: Result) -> None:
    """Name the time axes of panels, and end them where the run gets calm, which is then said."""
    force = moving_average(result.barrier_normal_force, _WINDOW, result.scene.settings.output_interval)
    rotation = np.linalg.norm(result.angular_velocity, axis=1)
    shown_time(panels, calm_from(result.time, (np.abs(force), rotation)), float(result.time[-1]))


def shown_time(panels: Iterable[Axes], calm: float, whole: float) -> float:
    """Name time axes, end them at `calm` [s] where that is well before the whole; return their end."""
    cut = 0.0 < calm < _MOST * whole
    end = calm if cut else whole
    for axes in panels:
        text = f"time [ms]; calm until the run ends at {whole * 1e3:,.0f} ms"
        axes.set_xlabel(text if cut else "time [ms]")
        axes.set_xlim(0.0, end * 1e3)
    return end


def calm_from(time: Floats, courses: Iterable[Floats]) -> float:
    """Return when all of some courses >= 0 have become small for good [s]; 0 where there is none."""
    last = 0.0
    for course in courses:
        if course.max() > 0.0:
            last = max(last, float(time[np.flatnonzero(course >= _CALM * course.max())[-1]]))
    return last * _ROOM
