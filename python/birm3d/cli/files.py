"""Command line: files to write, which are looked at before anything is run."""

from __future__ import annotations

import tempfile
from importlib import import_module
from pathlib import Path
from typing import Any

import click

__all__ = [
    "CAPSULE",
    "CSV",
    "HTML",
    "JSON",
    "LOAD_MAP",
    "MOVIE",
    "PICTURE",
    "RESULT",
    "STORE",
    "TABLE",
    "VEHICLE",
    "OutputFile",
]


class OutputFile(click.ParamType):  # type: ignore[type-arg,unused-ignore]
    """A file that a command will write: refused at once where that can not be.

    Parameters
    ----------
    endings
        That the name may have; none: any.
    needs
        Module -> extra to install that writing needs.
    """

    name = "file"

    def __init__(self, *endings: str, **needs: str) -> None:
        self._endings = endings
        self._needs = needs

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Path:
        """Return the path; a ValueError or an ImportError says why the file can not be written."""
        path = Path(value)
        option = param.opts[0] if param is not None else "file"
        device = path.exists() and not path.is_file() and not path.is_dir()
        if self._endings and not device and not path.name.lower().endswith(self._endings):
            raise ValueError(f"{option} must end in {_listed(self._endings)}, got {str(path)!r}")
        _check_place(option, path)
        if ctx is not None:
            taken = ctx.meta.setdefault("birm3d.outputs", {})
            other = taken.setdefault(path.absolute(), option)
            if other != option:
                raise ValueError(f"{option} must be another file than {other}, got {str(path)!r} for both")
        for module, extra in self._needs.items():
            try:
                import_module(module)
            except ImportError as error:
                package = module.split(".")[0].replace("_", "-")
                raise ImportError(f"{option} needs {package}: pip install 'birm3d[{extra}]'") from error
        return path


def _check_place(option: str, path: Path) -> None:
    if path.is_dir():
        raise ValueError(f"{option} must be a file, got the folder {str(path)!r}")
    if not path.parent.is_dir():
        raise ValueError(f"{option} must be in a folder that exists, got {str(path)!r}")
    if path.exists() and not path.is_file():
        return  # a device or a pipe: writing tells
    try:  # access rights do not show a read-only or full file system
        with tempfile.NamedTemporaryFile(dir=path.parent, prefix=".birm3d-") as file:
            file.write(b"\0")
    except OSError as error:
        raise ValueError(
            f"{option} must be in a folder that can be written to, got {str(path)!r}: {error.strerror}"
        ) from error


def _listed(endings: tuple[str, ...]) -> str:
    return endings[0] if len(endings) == 1 else f"{', '.join(endings[:-1])} or {endings[-1]}"


# What Matplotlib writes without further programs.
PICTURE = OutputFile(".png", ".pdf", ".svg", ".jpg", ".jpeg", ".webp", ".tif", ".tiff", ".eps", ".ps")
LOAD_MAP = OutputFile(".csv", ".png", ".pdf", ".svg")
TABLE = OutputFile(".csv", ".csv.gz", ".csv.xz", ".csv.zip", ".txt", pandas="table")
CSV = OutputFile(".csv", ".txt")
RESULT = OutputFile(".npz")
CAPSULE = OutputFile(".birm3d")
HTML = OutputFile(".html", ".htm", plotly="html")
GLTF = OutputFile(".glb", ".gltf", pygltflib="export")
VTK = OutputFile(".pvd", pyvista="export")
JSON = OutputFile(".json")
VEHICLE = OutputFile(".toml")
STORE = OutputFile()


class _MovieFile(OutputFile):
    """A movie; all kinds but .gif need ffmpeg too."""

    def __init__(self) -> None:
        super().__init__(".mp4", ".gif", ".m4v", ".mov", ".mkv", ".webm", ".avi")

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Path:
        """Return the path; see :class:`OutputFile`."""
        path = super().convert(value, param, ctx)
        from ..rendering.movie import check_movie

        try:
            check_movie(path)
        except RuntimeError as error:
            raise ValueError(str(error)) from error
        return path


MOVIE = _MovieFile()
