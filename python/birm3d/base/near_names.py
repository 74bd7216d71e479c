"""Names that a caller may have meant by one that is not known."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches

__all__ = ["did_you_mean", "near_names"]


def near_names(name: str, known: Iterable[str], most: int = 5) -> list[str]:
    """Return the known names that hold this one, or else those that are spelled nearly as it is."""
    listed = list(known)
    plain = name.strip().lower().replace(" ", "_")
    holding = [one for one in listed if plain and plain in one.lower().replace(" ", "_")]
    return holding[:most] or get_close_matches(name, listed, n=most)


def did_you_mean(name: str, known: Iterable[str], start: str = ", did") -> str:
    """Return ", did you mean ...?" for the end of a message, or nothing where no known name is near."""
    near = near_names(name, known, most=3)
    return f"{start} you mean {' or '.join(map(repr, near))}?" if near else ""
