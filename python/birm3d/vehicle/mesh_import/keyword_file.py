"""Reader of LS-DYNA keyword files: nodes, shell and solid elements, titles of parts, included files.

Fixed and free format, long format (``*NODE+``, ``LONG=S`` or ``LONG=Y``), comments, ``*INCLUDE`` and
``*INCLUDE_PATH``. Parts of the model that are not its shape are skipped. Columns are those of the LS-DYNA
keyword user's manual, volume I: ``*NODE``, ``*ELEMENT_SHELL``, ``*ELEMENT_SOLID``, ``*PART``, ``*INCLUDE``.
Columns are cut out of all lines of a block at once, so that a million elements take seconds.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import numpy.typing as npt

from ...io.file_format import read_bytes
from .columns import columns, lines_of, real, whole
from .deck_mass import MASS_BLOCKS, DeckMass
from .raw_mesh import MeshFileError, RawMesh, triangulated

__all__ = ["KEYWORD_ENDINGS", "read_keyword_file"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

KEYWORD_ENDINGS = (".k", ".key", ".dyn", ".dat", ".inc", ".asc")
_MOST_BYTES = 2**31
_MOST_FILES = 200
_HEADER = re.compile(rb"^\*[^\r\n]*", re.MULTILINE)
_SOLID_FACES = ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))
_CARDS = ("THICKNESS", "BETA", "MCID")  # options of which any brings one more line for each element
_UNREADABLE = ("*INCLUDE_TRANSFORM", "*INCLUDE_BINARY", "*NODE_TRANSFORM")


class _Model:
    """What has been read so far."""

    def __init__(self) -> None:
        self.node_ids: list[Ints] = []
        self.points: list[Floats] = []
        self.shells: list[tuple[Ints, Ints]] = []  # part, corners (m, 4)
        self.solids: list[tuple[Ints, Ints]] = []  # part, corners (m, 8)
        self.titles: dict[int, str] = {}
        self.mass = DeckMass()
        self.files: set[Path] = set()
        self.folders: list[Path] = []


def read_keyword_file(path: Path) -> RawMesh:
    """Return the shell elements of a keyword file and of all that it includes, and the faces of its solids.

    Raises
    ------
    MeshFileError
        If a file can not be read, or an element has a node that is none; with the file and line.
    """
    model = _Model()
    _read(path, model, long=False)
    if not model.node_ids:
        raise MeshFileError.at(path, None, "must have nodes (*NODE), got none")
    ids, points = np.concatenate(model.node_ids), np.concatenate(model.points)
    order = np.argsort(ids, kind="stable")
    ids, points = ids[order], points[order]
    model.mass.node_ids, model.mass.points = ids, points
    model.mass.shells, model.mass.solids = model.shells, model.solids
    corners = [*model.shells]
    for part, solid in model.solids:
        faces = np.concatenate([solid[:, face] for face in _SOLID_FACES])
        corners.append((np.tile(part, len(_SOLID_FACES)), faces))
    if not corners:
        raise MeshFileError.at(path, None, "must have shell or solid elements, got none")
    parts = np.concatenate([part for part, _ in corners])
    quads = np.concatenate([quad for _, quad in corners])
    where = np.minimum(np.searchsorted(ids, quads), len(ids) - 1)
    if (unknown := ids[where] != quads).any():
        bad = quads[unknown][0]
        raise MeshFileError.at(path, None, f"elements must have nodes of the model, got node {bad}")
    second = where[:, 2] != where[:, 3]
    return RawMesh(
        path,
        points,
        triangulated(where.astype(np.int64)),
        np.concatenate([parts, parts[second]]),
        model.titles,
        is_deck=True,
        mass=model.mass,
    )


def _read(path: Path, model: _Model, long: bool) -> None:
    """Read one file, and those that it includes."""
    try:
        real = path.resolve(strict=True)
        content = read_bytes(path, _MOST_BYTES)
    except OSError as error:
        raise MeshFileError.at(path, None, f"can not be read: {error.strerror or error}") from error
    if real in model.files:
        return
    if len(model.files) == _MOST_FILES:
        raise MeshFileError.at(path, None, f"must include at most {_MOST_FILES} files, got more")
    model.files.add(real)
    model.folders.append(path.parent)
    if not _HEADER.search(content):
        raise MeshFileError.at(path, None, "must be an LS-DYNA keyword file, got no line that begins with *")
    for name, body, start in _blocks(content):
        if name.startswith("*KEYWORD"):
            long = b"LONG=S" in body.upper()[:80] or "LONG=S" in name or "LONG=Y" in name
        if name == "*END":
            return
        try:
            _block(name, body, path, model, long)
        except MeshFileError:
            raise
        except (ValueError, OverflowError, IndexError) as error:
            line = content.count(b"\n", 0, start) + 1
            raise MeshFileError.at(
                path, line, f"{name}: must hold numbers in its columns, {error}"
            ) from error


def _blocks(content: bytes) -> Iterator[tuple[str, bytes, int]]:
    """Yield the blocks of a file: keyword, lines below it, where it starts."""
    found = list(_HEADER.finditer(content))
    ends = [one.start() for one in found[1:]] + [len(content)]
    for one, end in zip(found, ends, strict=True):
        yield one[0].decode("latin-1").strip().upper(), content[one.end() : end], one.start()


def _block(name: str, body: bytes, path: Path, model: _Model, long: bool) -> None:
    long = (long or name.endswith(("+", " +"))) and not name.endswith(("-", " -"))
    name = name.split()[0].rstrip("+-%")
    if name in _UNREADABLE:
        raise MeshFileError.at(
            path, None, f"must be without {name}, which is not read: write one plain model"
        )
    if name.startswith(MASS_BLOCKS):
        model.mass.blocks.append((name, body, long))
    if name in ("*INCLUDE", "*INCLUDE_PATH", "*INCLUDE_PATH_RELATIVE"):
        _include(name, body, path, model, long)
    elif name == "*PART":
        _titles(lines_of(body), model, long)
    elif name == "*NODE":
        ids, *axes = columns(lines_of(body), (8, 16, 16, 16), long)
        model.node_ids.append(whole(ids))
        model.points.append(np.column_stack([real(axis) for axis in axes]))
    elif name == "*ELEMENT_SHELL" or name.startswith("*ELEMENT_SHELL_"):
        options = name.removeprefix("*ELEMENT_SHELL")
        more = any(option in options for option in _CARDS) + ("OFFSET" in options) + ("DOF" in options)
        lines = lines_of(body)
        _shells(lines[:: 1 + more], model, long)
        model.mass.thickness.append(lines[1 :: 1 + more] if "THICKNESS" in options else None)
    elif name in ("*ELEMENT_SOLID", "*ELEMENT_SOLID_ORTHO"):
        _solids(lines_of(body), model, long, ortho=name.endswith("ORTHO"))


def _include(name: str, body: bytes, path: Path, model: _Model, long: bool) -> None:
    text = ""
    for line in lines_of(body):
        part = line.decode("utf-8", "replace").strip()
        text += part.removesuffix(" +")
        if part.endswith(" +"):  # a name goes on in the next line
            continue
        here = Path(text.strip("'\"").replace("\\", "/"))
        text = ""
        if name != "*INCLUDE":
            model.folders.append(path.parent / here)
            continue
        places = [path.parent / here, *(folder / here for folder in model.folders)]
        found = next((place for place in places if place.is_file()), None)
        if found is None:
            raise MeshFileError.at(path, None, f"*INCLUDE must name a file beside it, got {str(here)!r}")
        _read(found, model, long)


def _titles(lines: list[bytes], model: _Model, long: bool) -> None:
    for title, numbers in zip(lines[::2], lines[1::2], strict=False):
        (number,) = columns([numbers], (10,), long)
        model.titles[int(whole(number)[0])] = title.decode("latin-1").strip()


def _shells(lines: list[bytes], model: _Model, long: bool) -> None:
    _, part, *corners = columns(lines, (8,) * 6, long)
    quads = np.column_stack([whole(corner) for corner in corners])
    quads[:, 3] = np.where(quads[:, 3] == 0, quads[:, 2], quads[:, 3])
    model.shells.append((whole(part), quads))


def _solids(lines: list[bytes], model: _Model, long: bool, ortho: bool) -> None:
    if not lines:
        return
    one_line = len(lines[0].rstrip().replace(b",", b" ").split()) > 2
    step = (1 if one_line else 2) + 2 * ortho
    if one_line:
        _, part, *corners = columns(lines[::step], (8,) * 10, long)
    else:
        _, part = columns(lines[::step], (8, 8), long)
        corners = columns(lines[1::step], (8,) * 8, long)
    nodes = np.column_stack([whole(corner) for corner in corners])
    for column in range(4, 8):  # wedges and tetrahedra leave the last ones out
        nodes[:, column] = np.where(nodes[:, column] == 0, nodes[:, 3], nodes[:, column])
    model.solids.append((whole(part), nodes))
