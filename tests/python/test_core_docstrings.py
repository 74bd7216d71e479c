"""Every public member of the extension module says what it is."""

from __future__ import annotations

import inspect
import types
from collections.abc import Iterator
from typing import Any

from birm3d import _core

OF_ENUMERATIONS = ("name", "value")
"""Members that pybind11 gives to each enumeration, without a docstring."""


def text_of(member: Any) -> str:
    """Return the docstring of a member, without the signatures that pybind11 writes ahead of it."""
    lines = (member.__doc__ or "").strip().splitlines()
    return "\n".join(line for line in lines if " -> " not in line).strip()


def members_of(owner: Any) -> Iterator[tuple[str, Any]]:
    """Yield the public classes, functions, methods and properties of a module or a class, by name."""
    is_enumeration = hasattr(owner, "__members__")
    for name, member in vars(owner).items():
        if name.startswith("_") or (is_enumeration and name in OF_ENUMERATIONS):
            continue
        if inspect.isclass(member):
            yield name, member
            yield from ((f"{name}.{inner}", value) for inner, value in members_of(member))
        elif callable(member) or isinstance(member, (property, staticmethod, classmethod)):
            yield name, member


def undocumented(owner: Any) -> list[str]:
    return [name for name, member in members_of(owner) if not text_of(member)]


def test_every_public_member_has_a_docstring() -> None:
    assert len(list(members_of(_core))) > 200
    assert undocumented(_core) == []


def test_a_missing_docstring_is_found() -> None:
    class Undocumented:
        @property
        def mass(self) -> float:
            return 0.0

        def step(self) -> None:
            """step(self) -> None"""

        def run(self) -> None:
            """run(self) -> None

            Run to the end.
            """

    module = types.SimpleNamespace(Undocumented=Undocumented)
    assert undocumented(module) == ["Undocumented", "Undocumented.mass", "Undocumented.step"]
