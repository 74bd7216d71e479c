"""Movies of a run."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ..base.progress import progress_bar
from ..io.atomic_write import whole_file
from .camera import View
from .stage import Color, Stage, check_drawing

if TYPE_CHECKING:
    from ..result.result import Result

__all__ = ["animate", "check_movie"]

Picture = npt.NDArray[np.uint8]


def animate(
    result: Result,
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
    """Write a movie of the whole run: .gif, or what ffmpeg writes (.mp4, .mkv, .webm, ...).

    The file is complete or is not there, also after Ctrl-C.

    Parameters
    ----------
    path
        Its ending says which kind.
    frames
        Their number, evenly spread over the run, >= 2.
    fps
        Frames a second of the movie. The run is shown slower by frames / (fps * its duration).
    view, color, size, follow
        See :class:`birm3d.rendering.Stage`; ffmpeg needs even numbers as size.
    progress
        Bar on stderr; ``None``: if that is a terminal.

    Raises
    ------
    ImportError
        Without pyvista, or without imageio-ffmpeg where it is needed.
    ValueError
        If an argument is not one.
    RuntimeError
        If this machine has no way to draw, or ffmpeg fails.
    """
    path = Path(path)
    if not (isinstance(frames, int) and frames >= 2):
        raise ValueError(f"frames must be a whole number >= 2, got {frames}")
    if not 0.1 <= fps <= 240.0:
        raise ValueError(f"fps must be 0.1 to 240, got {fps}")
    write = _writer(path, size, fps)
    times = np.linspace(result.time[0], result.time[-1], frames)
    with (
        whole_file(path) as part,
        Stage(result, times, view=view, color=color, size=size, follow=follow) as stage,
        progress_bar(progress, path.name, frames) as advance,
    ):

        def pictures() -> Iterator[Picture]:
            for k in range(frames):
                stage.move_to(k)
                yield stage.picture()
                advance(1)

        write(part, pictures())


def check_movie(path: Path) -> None:
    """Refuse what :func:`animate` would refuse: a file's ending, missing packages, no drawing."""
    _writer(path, (2, 2), 25.0)
    check_drawing()


def _writer(path: Path, size: tuple[int, int], fps: float) -> Callable[[Path, Iterator[Picture]], None]:
    """Return what writes pictures to a path as the ending of `path` says."""
    ending = path.suffix.lower()
    if ending == ".gif":
        return partial(_write_gif, fps=fps)
    if ending not in (".mp4", ".m4v", ".mov", ".mkv", ".webm", ".avi"):
        raise ValueError(f"path must end in .gif, .mp4, .m4v, .mov, .mkv, .webm or .avi, got {str(path)!r}")
    if any(n % 2 for n in size):
        raise ValueError(f"size must be even numbers for {ending}, got {size}")
    _ffmpeg(ending)
    return partial(_write_video, fps=fps, size=size)


def _ffmpeg(ending: str) -> Any:
    try:
        import imageio_ffmpeg
    except ImportError as error:
        message = f"{ending} movies need imageio-ffmpeg: pip install 'birm3d[render]'; .gif does not"
        raise ImportError(message) from error
    return imageio_ffmpeg


def _write_gif(path: Path, pictures: Iterator[Picture], fps: float) -> None:
    from PIL import Image

    # Rare colours matter, those of crush and of its bar: a palette by area would lose them.
    rare, plain = Image.Quantize.MAXCOVERAGE, Image.Dither.NONE
    images = (Image.fromarray(picture).quantize(256, method=rare, dither=plain) for picture in pictures)
    first = next(images)
    # A GIF counts in hundredths of a second, and viewers slow down what is below two of them.
    duration = 10 * max(2, round(100.0 / fps))
    with path.open("wb") as stream:  # Pillow leaves its own open when it is stopped
        first.save(stream, "GIF", save_all=True, append_images=images, duration=duration, loop=0)


def _write_video(path: Path, pictures: Iterator[Picture], fps: float, size: tuple[int, int]) -> None:
    writer = _ffmpeg(path.suffix).write_frames(str(path), size, fps=fps, quality=7, macro_block_size=2)
    try:
        writer.send(None)
        for picture in pictures:
            writer.send(picture)
    except OSError as error:  # how it tells that ffmpeg has died
        raise RuntimeError(f"ffmpeg can not write {path.suffix}: {error}") from error
    finally:
        writer.close()
