"""Text of data files, with errors that say where."""

from __future__ import annotations

import math
from pathlib import Path

from ...io.file_format import FileFormatError, read_bytes, received

__all__ = ["number", "read_text"]


def read_text(path: Path) -> str:
    """Content of a text file: UTF-8, or else ISO 8859-1, in which older laboratories write degree signs."""
    data = read_bytes(path)
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("iso-8859-1")


def number(path: Path, line: int, text: str, what: str) -> float:
    """Finite number of a cell; a FileFormatError with file and line if it is none."""
    try:
        value = float(text)
    except ValueError:
        raise FileFormatError.at(path, line, f"{what} must be a number, got {received(text)}") from None
    if not math.isfinite(value):
        raise FileFormatError.at(path, line, f"{what} must be finite, got {received(text)}")
    return value
