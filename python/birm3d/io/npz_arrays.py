"""Arrays of an npz file; what the file says of its sizes is checked, not trusted.

``numpy.load`` allocates what a header promises before it reads the data. It may not check the archive's own
checksum. Here sizes are bounded first, and every byte is read and checked.
"""

from __future__ import annotations

import io
import math
import os
import zipfile
from pathlib import Path
from typing import IO, Any

import numpy as np
import numpy.typing as npt

from .file_format import FileFormatError

__all__ = ["read_arrays"]

# An archive may unpack to so many bytes, and to so many times its own size beyond: zeros pack well.
_UNPACKED = 256 * 2**20
_RATIO = 100
_MOST_MEMBERS = 100_000


def read_arrays(stream: IO[bytes], path: Path) -> dict[str, npt.NDArray[Any]]:
    """Return the arrays of an npz file, read-only; `path` is for messages.

    Raises
    ------
    FileFormatError
        If it unpacks to too much, or a member is no array of numbers or text as long as it says.
    zipfile.BadZipFile, zlib.error, ValueError, ...
        If the archive or a header is damaged.
    """
    packed = stream.seek(0, os.SEEK_END)
    stream.seek(0)
    with zipfile.ZipFile(stream) as archive:
        members = archive.infolist()
        if len(members) > _MOST_MEMBERS:
            raise FileFormatError.at(
                path, None, f"must have at most {_MOST_MEMBERS} arrays, got {len(members)}"
            )
        limit, size = _UNPACKED + _RATIO * packed, sum(member.file_size for member in members)
        if size > limit:
            reason = f"must unpack to at most {limit:,} bytes, {_RATIO} times its own size, got {size:,}"
            raise FileFormatError.at(path, None, reason)
        arrays = {}
        for member in members:
            name = member.filename.removesuffix(".npy")
            if name in arrays:
                raise FileFormatError.at(
                    path, None, f"arrays must have names of their own, got {name!r} twice"
                )
            arrays[name] = _array(path, name, archive.read(member))
    return arrays


def _array(path: Path, name: str, content: bytes) -> npt.NDArray[Any]:
    head = io.BytesIO(content)
    version = np.lib.format.read_magic(head)
    if version not in ((1, 0), (2, 0)):
        raise FileFormatError.at(path, None, f"array {name!r} must have format 1.0 or 2.0, got {version}")
    read = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
    shape, by_columns, kind = read(head)
    if kind.hasobject or kind.kind not in "biufU":
        raise FileFormatError.at(path, None, f"array {name!r} must be of numbers or text, got {kind}")
    wanted, found = math.prod(shape) * kind.itemsize, len(content) - head.tell()
    if min(shape, default=0) < 0 or wanted != found:
        raise FileFormatError.at(path, None, f"array {name!r} must have {wanted} bytes, got {found}")
    if wanted == 0:
        array: npt.NDArray[Any] = np.empty(shape, kind)
    else:
        array = np.frombuffer(content, kind, offset=head.tell()).reshape(
            shape, order="F" if by_columns else "C"
        )
    array.setflags(write=False)
    return array
