"""Which code this is: a hash of its sources, and the commit where the build knew it.

The build runs this file as a script, which imports nothing of the package. It writes :data:`RECORD` beside
the compiled module, with the hash of the C++ sources. Those of Python are hashed when the source is asked
for. In a checkout ``python python/birm3d/_source.py`` prints the source without a build.
"""

from __future__ import annotations

import hashlib
import json
import sys
from collections.abc import Iterable
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple

__all__ = ["RECORD", "Source", "installed_source", "shortened"]

RECORD = "_build.json"
"""File beside the compiled module: hashes of what it was built from, and the commit."""
WITH_CHANGES = " with changes"
"""Follows a commit from which the sources differ."""

_DIGITS = 12  # of hashes that are shown
_PACKAGE = Path(__file__).resolve().parent
_CPP = ("CMakeLists.txt", "bindings", "cpp")
_CPP_ENDINGS = (".cpp", ".hpp", ".txt", ".cmake", ".in")
_PACKAGE_ENDINGS = (".py", ".toml", ".csv")


class Source(NamedTuple):
    """What a package was made of.

    digest: BLAKE2b of all sources, 32 hexadecimal digits. commit: of git, 40 digits, followed by
    :data:`WITH_CHANGES` where the sources differ from it; ``None``: not known.
    """

    digest: str
    commit: str | None

    @property
    def facts(self) -> dict[str, str]:
        """Of results and capsules: ``source``, and ``commit`` where it is known."""
        return {"source": self.digest} | ({} if self.commit is None else {"commit": self.commit})

    def __str__(self) -> str:
        return ", ".join(f"{name} {shortened(value)}" for name, value in self.facts.items())


def shortened(value: str) -> str:
    """Return a digest or a commit as it is shown, with what follows it."""
    digits, space, rest = value.partition(" ")
    return digits[:_DIGITS] + space + rest


@cache
def installed_source() -> Source:
    """Return the source of this package: the files as they are when it is first asked for.

    Without the record of a build, the compiled module stands for the C++ sources.
    """
    spec = find_spec("birm3d._core")
    assert spec is not None  # the package does not work without it
    assert spec.origin is not None
    module = Path(spec.origin)
    package = _package_digest(_PACKAGE)
    record = module.with_name(RECORD)
    if not record.is_file():
        return Source(_joined(_digest([("", module)]), package), None)
    built = json.loads(record.read_text(encoding="utf-8"))
    commit = built["commit"]
    if commit is not None and built["package"] != package and not commit.endswith(WITH_CHANGES):
        commit += WITH_CHANGES
    return Source(_joined(built["cpp"], package), commit)


def _package_digest(package: Path) -> str:
    return _digest(_below(package, package, _PACKAGE_ENDINGS))


def _cpp_digest(root: Path) -> str:
    return _digest(file for name in _CPP for file in _below(root / name, root, _CPP_ENDINGS))


def _below(place: Path, root: Path, endings: tuple[str, ...]) -> list[tuple[str, Path]]:
    """Return the files at a place with their names relative to a root; hidden ones are no sources."""
    files = [place] if place.is_file() else place.rglob("*")
    return [
        (file.relative_to(root).as_posix(), file)
        for file in files
        if file.suffix in endings and not file.name.startswith(".")
    ]


def _digest(files: Iterable[tuple[str, Path]]) -> str:
    """Return the hash of names and contents, whatever the order of the files."""
    digest = hashlib.blake2b(digest_size=16)
    for name, file in sorted(files):
        content = file.read_bytes()
        digest.update(f"{name}:{len(content)}:".encode())
        digest.update(content)
    return digest.hexdigest()


def _joined(cpp: str, package: str) -> str:
    return hashlib.blake2b(f"{cpp}:{package}".encode(), digest_size=16).hexdigest()


# ---- at the build ------------------------------------------------------------------------------------------


def _record(root: Path) -> dict[str, str | None]:
    """Return what :data:`RECORD` holds of a checkout or an unpacked archive."""
    package = _package_digest(root / "python/birm3d")
    return {"cpp": _cpp_digest(root), "package": package, "commit": _commit(root)}


def _commit(root: Path) -> str | None:
    """Return the commit of a checkout, or that which git wrote into an archive."""
    note = root / ".git_archival.txt"
    if note.is_file():
        text = note.read_text(encoding="utf-8").strip().removeprefix("commit: ")
        if not text.startswith("$"):
            return text
    found = _git(root, "rev-parse", "--show-toplevel", "HEAD")
    if found is None:
        return None
    top, commit = found.split("\n")
    if Path(top).resolve() != root:  # a checkout of something else, with this in it
        return None
    changed = _git(root, "status", "--porcelain", "--", *_CPP, "python/birm3d")
    return commit if changed == "" else commit + WITH_CHANGES


def _git(root: Path, *arguments: str) -> str | None:
    """Return what git prints; ``None`` without git, or where it knows no checkout."""
    import subprocess  # only builds need it

    try:
        done = subprocess.run(
            ["git", "-C", str(root), *arguments], stdin=subprocess.DEVNULL, capture_output=True, text=True
        )
    except FileNotFoundError:
        return None
    return done.stdout.strip() if done.returncode == 0 else None


def _main(files: list[str]) -> None:
    """Write the record of the checkout that this file is in, or print its source."""
    record = _record(_PACKAGE.parents[1])
    for file in files:
        Path(file).write_text(json.dumps(record, indent=1), encoding="utf-8")
    if not files:
        assert record["cpp"] is not None
        assert record["package"] is not None
        print(Source(_joined(record["cpp"], record["package"]), record["commit"]))


if __name__ == "__main__":
    _main(sys.argv[1:])
