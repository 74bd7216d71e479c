"""Where a figure of histories ends: when nothing goes on but a vehicle that rests, or slides along."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes

from ..signals.filters import moving_average

if TYPE_CHECKING:
    from ..result.result import Result

__all__ = ["limit_time"]

_CALM = 0.05  # of the greatest force and of the greatest angular velocity; below that a run is calm
_MOST = 0.6  # of the run; a figure ends early only if it then shows less than this
_ROOM = 1.1  # times the last instant that is not calm: there such a figure ends
_WINDOW = 0.01  # s, over which the force is a mean


def limit_time(panels: Iterable[Axes], result: Result) -> None:
    """Name the time axes of panels, and end them where the run gets calm, which is then said."""
    end, whole = _calm_from(result) * 1e3, float(result.time[-1]) * 1e3
    cut = 0.0 < end < _MOST * whole
    for axes in panels:
        axes.set_xlabel(f"time [ms]; calm until the run ends at {whole:,.0f} ms" if cut else "time [ms]")
        axes.set_xlim(0.0, end if cut else whole)


def _calm_from(result: Result) -> float:
    """Return when force and rotation have become small for good [s]; 0 where there was none."""
    force = moving_average(result.barrier_normal_force, _WINDOW, result.scene.settings.output_interval)
    rotation = np.linalg.norm(result.angular_velocity, axis=1)
    last = 0.0
    for course in (np.abs(force), rotation):
        if course.max() > 0.0:
            last = max(last, float(result.time[np.flatnonzero(course >= _CALM * course.max())[-1]]))
    return last * _ROOM
