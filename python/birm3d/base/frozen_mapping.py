"""Mappings that can not be changed, and that pickle, copy and, as their values do, hash."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, TypeVar

__all__ = ["FrozenMapping"]

Key = TypeVar("Key")
Value = TypeVar("Value", covariant=True)


class FrozenMapping(Mapping[Key, Value]):
    """A read-only mapping in the order of the one it is made of; shown as a dict."""

    __slots__ = ("_content",)

    def __init__(self, content: Mapping[Key, Value]) -> None:
        self._content = dict(content)

    def __getitem__(self, key: Key) -> Value:
        return self._content[key]

    def __iter__(self) -> Iterator[Key]:
        return iter(self._content)

    def __len__(self) -> int:
        return len(self._content)

    def __hash__(self) -> int:
        return hash(frozenset(self._content.items()))

    def __contains__(self, key: object) -> bool:
        return key in self._content

    def __reduce__(self) -> tuple[Any, ...]:
        return (FrozenMapping, (self._content,))

    def __repr__(self) -> str:
        return repr(self._content)
