"""Reading of files: one error for whatever is wrong with them, limits on their sizes, checksums."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import wraps
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

from typing_extensions import Self

from ..base.arguments import checked

__all__ = [
    "MOST_BYTES", "MOST_DEPTH", "FileFormatError", "check_sum", "checksum", "depth", "read_bytes",
    "read_json", "reading", "reads", "received",
]  # fmt: skip

P = ParamSpec("P")
R = TypeVar("R")

MOST_BYTES = 256 * 2**20
"""Greatest size of a text file [bytes]; an hour of a hundred channels at 10 kHz takes less than half."""

MOST_DEPTH = 64
"""How deep lists and tables of a file may be nested; no format of this package needs more than twenty."""


class FileFormatError(ValueError):
    """A file that can not be used: it is damaged, of another kind, or asks for what can not be.

    Attributes
    ----------
    path : Path or None
        Of the file.
    line : int or None
        The first one that is wrong, from 1, where it is known.
    reason : str
        The message without path and line.
    """

    def __init__(self, message: str, *, path: Path | None = None, line: int | None = None) -> None:
        super().__init__(message)
        self.path = path
        self.line = line

    @classmethod
    def at(cls, path: str | Path, line: int | None, reason: str) -> Self:
        """Return the error of one place of a file."""
        place = f"{path}" if line is None else f"{path}:{line}"
        return cls(f"{place}: {reason}", path=Path(path), line=line)

    @property
    def reason(self) -> str:
        """The message without path and line."""
        place = f"{self.path}: " if self.line is None else f"{self.path}:{self.line}: "
        return str(self).removeprefix(place)


@contextmanager
def reading(path: str | Path, must: str, error: type[FileFormatError] = FileFormatError) -> Iterator[None]:
    """Turn whatever a reader meets in a damaged file into one error; `must` says what the file should be.

    A file can be damaged in more ways than a reader can name: the cause is kept and named.
    """
    try:
        yield
    except (FileFormatError, Warning):
        raise
    except OSError as cause:
        where = cause.filename or path
        raise error.at(where, None, f"can not be read: {cause.strerror or cause}") from cause
    except RecursionError as cause:
        raise error.at(path, None, f"must not be nested deeper than {MOST_DEPTH} levels") from cause
    except MemoryError as cause:
        raise error.at(path, None, f"{must}, but it asks for more memory than there is") from cause
    except Exception as cause:
        raise error.at(path, None, f"{must}, but {_reason(cause)}") from cause


def reads(
    must: str, error: type[FileFormatError] = FileFormatError
) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Decorate a reader whose first argument is a path with :func:`reading`."""

    def decorate(reader: Callable[P, R]) -> Callable[P, R]:
        @wraps(reader)
        def guarded(*args: P.args, **kwargs: P.kwargs) -> R:
            path: Any = args[0] if args else kwargs.get("path", "")
            with reading(Path(path), must, error):
                return reader(*args, **kwargs)

        return checked(guarded)

    return decorate


def _reason(cause: Exception) -> str:
    if isinstance(cause, KeyError):
        return f"{cause} is missing"
    if isinstance(cause, ValueError):
        return str(cause)
    return f"{type(cause).__name__}: {cause}"


def read_bytes(path: Path, limit: int = MOST_BYTES) -> bytes:
    """Return the content of a file, of no more than so many bytes.

    Raises
    ------
    FileFormatError
        If it is larger.
    OSError
        If it can not be read.
    """
    with path.open("rb") as stream:
        content = stream.read(limit + 1)
    if len(content) > limit:
        raise FileFormatError.at(path, None, f"must have at most {limit:,} bytes, got more")
    return content


def depth(data: Any, limit: int = MOST_DEPTH) -> int:
    """Return how deep lists, tuples and mappings are nested, at most `limit` + 1; without recursion."""
    level, found = [data], 0
    while level and found <= limit:
        inner = [item for item in level if isinstance(item, (list, tuple, dict))]
        level = [child for item in inner for child in (item.values() if isinstance(item, dict) else item)]
        found += bool(inner)
    return found


def checksum(document: Any) -> str:
    """Return 32 hexadecimal digits (BLAKE2b) of a document of JSON, however it is laid out."""
    text = json.dumps(document, sort_keys=True, separators=(",", ":"))
    return hashlib.blake2b(text.encode(), digest_size=16).hexdigest()


def check_sum(path: Path, found: Any, document: Any) -> None:
    """Refuse a document that is not the one of which the checksum was taken."""
    expected = checksum(document)
    if found != expected:
        reason = (
            f"checksum must be {expected}, got {received(found)}: the file was changed after it was written"
        )
        raise FileFormatError.at(path, None, reason)


def read_json(path: Path, content: bytes | str) -> Any:
    """Return a document of JSON.

    Raises
    ------
    FileFormatError
        With the line, if it is none, has numbers that JSON does not have, or is nested too deeply.
    """
    try:
        document = json.loads(content, parse_constant=_refuse_constant)
    except json.JSONDecodeError as error:
        raise FileFormatError.at(path, error.lineno, f"must be JSON: {error}") from error
    except (ValueError, RecursionError) as error:
        raise FileFormatError.at(path, None, f"must be JSON: {error}") from error
    if depth(document) > MOST_DEPTH:
        raise FileFormatError.at(path, None, f"must not be nested deeper than {MOST_DEPTH} levels")
    return document


def _refuse_constant(text: str) -> None:
    raise ValueError(f"a number must be finite, got {text}")


def received(value: Any) -> str:
    """Return a value as an error message shows it."""
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."
