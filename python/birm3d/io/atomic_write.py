"""Files that last: complete or not there, and refused in plain words where they are of another kind."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from .file_format import FileFormatError, received

__all__ = ["check_format", "whole_file"]


@contextmanager
def whole_file(path: str | Path) -> Iterator[Path]:
    """Yield a path to write to; it becomes `path` when the block ends well, and vanishes when it does not.

    A device or a pipe is written to as it is.

    Raises
    ------
    ValueError
        If `path` is a folder or lies in none.
    """
    path = Path(path)
    if path.is_dir():
        raise ValueError(f"path must be a file, got the folder {str(path)!r}")
    if not path.parent.is_dir():
        raise ValueError(f"path must be in a folder that exists, got {str(path)!r}")
    if path.exists() and not path.is_file():  # a device or a pipe, which stays what it is
        yield path
        return
    # The ending stays last: writers of pictures and movies go by it.
    part = path.with_name(f".part-{path.name}")
    try:
        yield part
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)


def check_format(path: Path, document: Any, name: str, *versions: int) -> None:
    """Refuse a document that has another ``format``, or a ``format_version`` that this package does not know.

    Raises
    ------
    FileFormatError
        Naming the file, what it should be and what it is.
    """
    found = document.get("format") if isinstance(document, dict) else type(document).__name__
    if not isinstance(document, dict) or found != name:
        raise FileFormatError.at(path, None, f"format must be {name!r}, got {received(found)}")
    made = document.get("format_version")
    if made not in versions or isinstance(made, bool):
        newer = isinstance(made, int) and made > max(versions)
        advice = "; a newer birm3d made the file and can read it" if newer else ""
        known = " or ".join(map(str, versions))
        raise FileFormatError.at(path, None, f"format_version must be {known}, got {received(made)}{advice}")
