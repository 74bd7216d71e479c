"""The folder of a dossier: refused at once where it can not be, and never mixed with other files."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from pathlib import Path

from ..io.atomic_write import whole_file

__all__ = ["FILES", "PAGE", "check_folder", "write_folder"]

PAGE = "index.html"
FILES = (PAGE, "run.birm3d", "loads.csv", "metrics.csv", "histories.html", "design_loads.csv")
"""All that a dossier may consist of."""


def check_folder(folder: str | Path) -> Path:
    """Return the path of a folder that a dossier can be written to.

    Raises
    ------
    ValueError
        If it is a file, lies in no folder, has files that are not of a dossier, or can not be written to.
    """
    path = Path(folder)
    if path.exists() and not path.is_dir():
        raise ValueError(f"folder must be a folder, got the file {str(path)!r}")
    if not path.absolute().parent.is_dir():
        raise ValueError(f"folder must be in a folder that exists, got {str(path)!r}")
    if path.is_dir():
        others = sorted(one.name for one in path.iterdir() if one.name not in FILES)
        if others:
            more = f" and {len(others) - 3} more" if len(others) > 3 else ""
            raise ValueError(
                "folder must be new, empty or that of an earlier dossier, "
                f"got {str(path)!r} with other files: {', '.join(others[:3])}{more}"
            )
    place = path if path.is_dir() else path.absolute().parent
    try:  # access rights do not show a read-only or full file system
        with tempfile.NamedTemporaryFile(dir=place, prefix=".birm3d-") as file:
            file.write(b"\0")
    except OSError as error:
        raise ValueError(
            f"folder must be one that can be written to, got {str(path)!r}: {error.strerror}"
        ) from error
    return path


def write_folder(path: Path, files: Mapping[str, bytes]) -> None:
    """Write the files of a dossier; the page comes last, and what an earlier dossier had more is removed."""
    path.mkdir(exist_ok=True)
    (path / PAGE).unlink(missing_ok=True)  # a page stands beside its own files only
    for name in FILES:
        if name not in files:
            (path / name).unlink(missing_ok=True)
    for name in sorted(files, key=lambda name: name == PAGE):
        with whole_file(path / name) as part:
            part.write_bytes(files[name])
