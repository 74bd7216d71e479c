"""The pictures of a result, as methods of :class:`birm3d.Result`.

Only what a picture needs is loaded, and only when it is made.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from .crush_profile import Side
    from .result import Result

__all__ = ["plot", "plot_crush", "plot_histories", "plot_plan"]


def plot(self: Result) -> Figure:
    """Return a figure of force, motion, angles and energies against time."""
    from .plotting import plot_result

    return plot_result(self)


def plot_histories(self: Result) -> Figure:
    """Return time histories with their filter class; see :func:`birm3d.plotting.plot_histories`."""
    from .plotting import plot_histories

    return plot_histories(self)


def plot_plan(self: Result, times: Sequence[float] | None = None, *, exit_box: bool = True) -> Figure:
    """Return the plan view of the trajectory; see :func:`birm3d.plotting.plot_plan`."""
    from .plotting import plot_plan

    return plot_plan(self, times, exit_box=exit_box)


def plot_crush(self: Result, side: Side = "front", *, height: float | None = None, unit: int = 0) -> Figure:
    """Return crush map and profile of one side; see :func:`birm3d.plotting.plot_crush`."""
    from .plotting import plot_crush

    return plot_crush(self, side, height=height, unit=unit)
