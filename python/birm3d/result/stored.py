"""Records of a run that were read from a file, with the same attributes as those of the core."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

__all__ = ["Stored", "StoredHistory"]


class Stored:
    """Named values of a record of the core, read from a file; immutable."""

    def __init__(self, values: Mapping[str, Any]) -> None:
        self._values = values

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or name not in self._values:
            raise AttributeError(name)
        return self._values[name]


class StoredHistory(Stored):
    """The history of a run, read from a file; reads like the core's."""

    def __init__(
        self,
        values: Mapping[str, Any],
        units: list[Stored],
        joints: list[Stored],
        elements: list[Stored],
    ) -> None:
        super().__init__(values)
        self.elements = elements
        self._units = units
        self._joints = joints

    def unit(self, index: int) -> Stored:
        """Return the history of one unit of the vehicle."""
        return self._units[index]

    def joint(self, index: int) -> Stored:
        """Return the history of one joint of the vehicle."""
        return self._joints[index]
