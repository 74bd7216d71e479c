"""Damage to files: small changes that a generator draws, and that can be told and repeated."""

from __future__ import annotations

import io
import re
import sqlite3
import zipfile
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from hypothesis import strategies as st

__all__ = ["Change", "changes", "damaged", "damaged_member", "damaged_store"]

_NUMBER = re.compile(rb"-?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")
# What stands in the place of a number: wrong kinds, wrong sizes, and what is no number.
_NUMBERS = (
    b"0", b"-1", b"1", b"2", b"1e-300", b"1e300", b"1e999", b"30000000", b"1000000000000", b"0.1", b"nan",
    b"inf", b"NaN", b'"text"', b"null", b"true", b"[]", b"{}", b"", b"0x10", b"1_000", b"--1",
)  # fmt: skip
_INSERTS = (
    b" " * 60_000, b"[" * 3_000, b"{" * 3_000, b'{"a":' * 3_000, b"a." * 3_000, b"\n", b"\0", b"\xff\xfe",
    b'"', b"'", b'"""', b",", b";", b"|", b":", b"=", b"]", b"}", b"#", b"[[a]]\n", b"x = 1\n",
    "\u2028".encode(), b"(" * 60_000, b"9" * 60_000, b"-" * 60_000, b"=" * 60_000 + b"x",
)  # fmt: skip


@dataclass(frozen=True)
class Change:
    """One change of a file: what, where (as a fraction of its length), and how much."""

    kind: str
    place: float
    more: int

    def apply(self, content: bytes) -> bytes:
        """Return the changed content."""
        at = int(self.place * len(content))
        if self.kind == "flip":
            return (
                content[:at] + bytes([content[at] ^ (1 << self.more % 8)]) + content[at + 1 :]
                if content
                else b""
            )
        if self.kind == "cut":
            return content[:at]
        if self.kind == "remove":
            return content[:at] + content[at + 1 + self.more % 400 :]
        if self.kind == "insert":
            return content[:at] + _INSERTS[self.more % len(_INSERTS)] + content[at:]
        if self.kind == "number":
            return self._number(content)
        return self._line(content)

    def _number(self, content: bytes) -> bytes:
        found = list(_NUMBER.finditer(content))
        if not found:
            return content
        number = found[int(self.place * len(found))]
        return content[: number.start()] + _NUMBERS[self.more % len(_NUMBERS)] + content[number.end() :]

    def _line(self, content: bytes) -> bytes:
        lines = content.split(b"\n")
        at = int(self.place * len(lines))
        if self.kind == "drop":
            del lines[at]
        elif self.kind == "twice":
            lines.insert(at, lines[at])
        else:  # swap
            other = self.more % len(lines)
            lines[at], lines[other] = lines[other], lines[at]
        return b"\n".join(lines)


_KINDS = ("flip", "cut", "remove", "insert", "number", "number", "number", "drop", "twice", "swap")
_change = st.builds(
    Change,
    st.sampled_from(_KINDS),
    st.floats(0.0, 1.0, exclude_max=True),
    st.integers(0, 10_000),
)


def changes() -> st.SearchStrategy[list[Change]]:
    """Return one to three changes."""
    return st.lists(_change, min_size=1, max_size=3)


def damaged(content: bytes, applied: list[Change]) -> bytes:
    """Return content with all changes, one after the other."""
    for change in applied:
        content = change.apply(content)
    return content


def damaged_member(content: bytes, applied: list[Change]) -> bytes:
    """Return an archive with one member changed, and sound as an archive."""
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        members = {member.filename: archive.read(member) for member in archive.infolist()}
    # The header holds most of what a reader has to understand.
    head = next(name for name in ("header.npy", "manifest.json") if name in members)
    names = [*members, *([head] * len(members))]
    name = names[int(applied[0].place * len(names))]
    members[name] = (
        _resized(damaged(members[name], applied)) if name == "header.npy" else damaged(members[name], applied)
    )
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for key, value in members.items():
            archive.writestr(key, value)
    return stream.getvalue()


def _resized(member: bytes) -> bytes:
    """Return an array of one text whose length is again what its head says, if it has one."""
    import numpy as np

    if len(member) < 128:
        return member
    text = member[128:].decode("utf-32-le", "replace")
    stream = io.BytesIO()
    np.save(stream, np.array(text))
    return stream.getvalue()


def damaged_store(path: Path, applied: list[Change]) -> None:
    """Change cells of a database of runs in place."""
    with sqlite3.connect(path) as connection:
        for change in applied:
            table = "study" if change.kind in ("cut", "drop") else "runs"
            columns = [row[1] for row in connection.execute(f"PRAGMA table_info({table})")]
            rows = [row[0] for row in connection.execute(f"SELECT rowid FROM {table}")]
            if not rows:
                continue
            column = columns[int(change.place * len(columns))]
            value: object = (None, -1, 1e308, "text", b"\0\xff", 2**62, 0.5)[change.more % 7]
            with suppress(sqlite3.IntegrityError):  # the database itself would not have it
                connection.execute(
                    f'UPDATE {table} SET "{column}" = ? WHERE rowid = ?',
                    (value, rows[change.more % len(rows)]),
                )
    connection.close()
