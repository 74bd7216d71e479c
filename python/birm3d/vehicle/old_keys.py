"""Keys that vehicle files and files of results had in earlier versions."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

__all__ = ["OLD_FIELDS", "OLD_KEYS", "with_todays_keys"]

OLD_KEYS: Mapping[tuple[str, ...], tuple[str, ...]] = {
    ("dents",): ("indentation",),
    ("indentation", "reach_m"): ("indentation", "length_m"),
    ("changes", "dent_reach_m"): ("changes", "indentation_length_m"),
}
"""Old key of a vehicle file -> key of today, in the order in which they are renamed."""

OLD_FIELDS: Mapping[str, str] = {"dent_reach": "indentation_length"}
"""Old name of a field of a vehicle -> name of today."""


def with_todays_keys(block: Mapping[str, Any]) -> tuple[dict[str, Any], list[tuple[str, ...]]]:
    """Return the content of a vehicle file with the keys of today, and the old keys that it had.

    Where it has the new key too, the old one stays, for the reader to refuse.
    """
    found: dict[str, Any] = dict(block)
    old = []
    for key, new in OLD_KEYS.items():
        inner = found if len(key) == 1 else found.get(key[0])
        if isinstance(inner, Mapping) and key[-1] in inner and new[-1] not in inner:
            renamed = {new[-1] if name == key[-1] else name: value for name, value in inner.items()}
            found = renamed if len(key) == 1 else {**found, key[0]: renamed}
            old.append(key)
    return found, old
