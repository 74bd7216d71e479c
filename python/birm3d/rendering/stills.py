"""Pictures of chosen instants, and the window."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ..base.checks import shown
from ..io.atomic_write import whole_file
from .camera import View
from .stage import Color, Stage

if TYPE_CHECKING:
    from ..result.result import Result

__all__ = ["render", "show"]

_INSTANTS = 61  # of the window's slider


def render(
    result: Result,
    time: float | Sequence[float] | str | Path | None = None,
    path: str | Path | None = None,
    *,
    view: View = "three_quarter",
    color: Color = "crush",
    size: tuple[int, int] = (1280, 720),
    follow: bool = False,
) -> npt.NDArray[np.uint8]:
    """Return pictures of some instants, drawn off-screen.

    Parameters
    ----------
    time
        One instant or several [s]; ``None``: the end. A path in its place is `path`.
    path
        Also write the picture to this file (.png, .jpg); several stand below each other.
    view, color, size, follow
        See :class:`birm3d.rendering.Stage`.

    Returns
    -------
    ndarray of uint8
        Shape (height, width, 3) of one instant, (k, height, width, 3) of several.

    Raises
    ------
    ImportError
        Without pyvista.
    ValueError
        If an argument is not one, or an instant is outside the run.
    RuntimeError
        If this machine has no way to draw.
    """
    if isinstance(time, (str, Path)):
        if path is not None:
            raise ValueError(f"path must be given once, got {str(time)!r} and {str(path)!r}")
        time, path = None, time
    if path is not None:  # before it is drawn
        _check_ending(Path(path))
    times = np.asarray(result.time[-1]) if time is None else _instants(time)
    with Stage(result, times, view=view, color=color, size=size, follow=follow) as stage:
        pictures = []
        for k in range(len(stage.times)):
            stage.move_to(k)
            pictures.append(stage.picture())
    if path is not None:
        from PIL import Image

        with whole_file(path) as part:
            Image.fromarray(np.vstack(pictures)).save(part)
    return pictures[0] if times.ndim == 0 else np.stack(pictures)


def _check_ending(path: Path) -> None:
    from PIL import Image

    known = Image.registered_extensions()
    if known.get(path.suffix.lower()) not in Image.SAVE:
        raise ValueError(f"path must end in .png, .jpg or another kind of picture, got {str(path)!r}")


def _instants(time: float | Sequence[float]) -> npt.NDArray[np.float64]:
    try:
        return np.asarray(time, float)
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"time must be a number or a list of numbers, got {shown(time)}") from None


def show(result: Result, *, view: View = "three_quarter", color: Color = "crush") -> None:
    """Open a window with the scene and a slider for the time; return when it is closed.

    Raises
    ------
    ImportError
        Without pyvista.
    RuntimeError
        Where there is no display.
    """
    display = os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    if sys.platform.startswith("linux") and not display:
        raise RuntimeError("show() needs a display, and DISPLAY is not set; render() and animate() need none")
    stage, _ = with_slider(result, view=view, color=color, off_screen=False)
    with stage:
        stage.plotter.show()


def with_slider(result: Result, *, view: View, color: Color, off_screen: bool) -> tuple[Stage, Any]:
    """Return a stage and its slider for the time."""
    times = np.linspace(result.time[0], result.time[-1], _INSTANTS)
    stage = Stage(result, times, view=view, color=color, off_screen=off_screen)

    def slide(ms: float) -> None:  # the camera stays where the user has put it
        stage.move_to(int(np.argmin(np.abs(times * 1e3 - ms))))

    slider = stage.plotter.add_slider_widget(
        slide,
        [0.0, float(times[-1] * 1e3)],
        value=0.0,
        title="time [ms]",
        pointa=(0.55, 0.08),
        pointb=(0.95, 0.08),
        color="black",
        style="modern",
    )
    return stage, slider
