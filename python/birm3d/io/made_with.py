"""What made a result: versions, source and platform, as far as bits can depend on them."""

from __future__ import annotations

import platform
import sys
from collections.abc import Mapping

import numpy as np

from .._source import WITH_CHANGES, installed_source, shortened
from .._version import __version__

__all__ = ["code_text", "code_to_install", "facts_text", "platform_facts"]


def platform_facts() -> dict[str, str]:
    """Return versions, source and platform of this process; ``commit`` only where the build knew it.

    The core takes pow, hypot and atan2 from the C library. Where that does not say its version, the system's
    stands for it.
    """
    library = " ".join(filter(None, platform.libc_ver()))
    return {
        "birm3d": __version__,
        **installed_source().facts,
        "python": platform.python_version(),
        "numpy": np.__version__,
        "system": platform.system(),
        "libc": library or f"{platform.system()} {platform.release()}",
        "machine": platform.machine(),
        "byte_order": sys.byteorder,
    }


def code_text(facts: Mapping[str, str]) -> str:
    """Return which code made a result, hashes shortened; facts that are not known are left out."""
    return _listed(facts, "birm3d", "source", "commit")


def facts_text(facts: Mapping[str, str]) -> str:
    """Return what made a result as one line: code, Python, NumPy, machine and C library."""
    place = " ".join(facts[name] for name in ("system", "machine") if name in facts)
    rest = (_listed(facts, "python", "numpy"), place, facts.get("libc", ""))
    return ", ".join(filter(None, (code_text(facts), *rest)))


def _listed(facts: Mapping[str, str], *names: str) -> str:
    return ", ".join(f"{name} {shortened(facts[name])}" for name in names if name in facts)


def code_to_install(facts: Mapping[str, str]) -> str:
    """Return which code made a result, as far as its facts say, and how to know that it is installed."""
    version = f"birm3d {facts['birm3d']}"
    if "source" not in facts:  # files of earlier versions
        return f"{version}; the file does not say which source"
    check = f"`birm3d --version` then says source {shortened(facts['source'])}"
    commit = facts.get("commit")
    if commit is None:
        return f"{version}, of a commit that its build did not know; {check}"
    if commit.endswith(WITH_CHANGES):
        return f"{version}, commit {commit} that were not committed; {check}"
    return f"{version}, commit {commit}: git checkout, then pip install .; {check}"
