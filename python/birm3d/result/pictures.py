"""The pictures of a result, as methods of :class:`birm3d.Result`.

Only what a picture needs is loaded, and only when it is made.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Literal, TypeAlias

from ..base.arguments import checked
from .crush_profile import Side

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt
    from matplotlib.figure import Figure

    from .result import Result

__all__ = [
    "Color",
    "View",
    "animate",
    "plot",
    "plot_crush",
    "plot_elements",
    "plot_histories",
    "plot_plan",
    "render",
    "show",
    "write_html",
]

View: TypeAlias = Literal["three_quarter", "side", "top", "front", "driver"]
Color: TypeAlias = Literal["crush", "zone", "plain"]


@checked
def plot(self: Result) -> Figure:
    """Return a figure of force, motion, angles and energies against time."""
    from ..plotting import plot_result

    return plot_result(self)


@checked
def plot_histories(self: Result) -> Figure:
    """Return time histories with their filter class; see :func:`birm3d.plotting.plot_histories`."""
    from ..plotting import plot_histories

    return plot_histories(self)


@checked
def plot_plan(self: Result, times: Sequence[float] | None = None, *, exit_box: bool = True) -> Figure:
    """Return the plan view of the trajectory; see :func:`birm3d.plotting.plot_plan`."""
    from ..plotting import plot_plan

    return plot_plan(self, times, exit_box=exit_box)


@checked
def plot_crush(
    self: Result, side: Side | None = None, *, height: float | None = None, unit: int = 0
) -> Figure:
    """Return crush map and profile of one side, the struck one if none is given.

    See :func:`birm3d.plotting.plot_crush`.
    """
    from ..plotting import plot_crush

    return plot_crush(self, side, height=height, unit=unit)


@checked
def plot_elements(self: Result) -> Figure:
    """Return the loads on the barrier's elements over time; see :func:`birm3d.plotting.plot_elements`."""
    from ..plotting import plot_elements

    return plot_elements(self)


@checked
def render(
    self: Result,
    time: float | Sequence[float] | str | Path | None = None,
    path: str | Path | None = None,
    *,
    view: View = "three_quarter",
    color: Color = "crush",
    size: tuple[int, int] = (1280, 720),
    follow: bool = False,
) -> npt.NDArray[np.uint8]:
    """Return 3-D pictures of some instants, drawn off-screen; see :func:`birm3d.rendering.render`.

    ``render("end.png")`` writes the end to a file, as ``animate("crash.mp4")`` writes the whole run.
    """
    from ..rendering import render

    return render(self, time, path, view=view, color=color, size=size, follow=follow)


@checked
def animate(
    self: Result,
    path: str | Path,
    *,
    frames: int = 100,
    fps: float = 25.0,
    view: View = "three_quarter",
    color: Color = "crush",
    size: tuple[int, int] = (1280, 720),
    follow: bool = False,
    progress: bool | None = None,
) -> None:
    """Write a movie of the whole run (.mp4, .gif, ...); see :func:`birm3d.rendering.animate`."""
    from ..rendering import animate

    animate(
        self,
        path,
        frames=frames,
        fps=fps,
        view=view,
        color=color,
        size=size,
        follow=follow,
        progress=progress,
    )


@checked
def show(self: Result, *, view: View = "three_quarter", color: Color = "crush") -> None:
    """Open a window with the scene in three dimensions; see :func:`birm3d.rendering.show`."""
    from ..rendering import show

    show(self, view=view, color=color)


@checked
def write_html(self: Result, path: str | Path, *, frames: int = 61) -> None:
    """Write one self-contained, interactive page; see :func:`birm3d.html_page.write_html`."""
    from ..html_page import write_html

    write_html(self, path, frames=frames)
