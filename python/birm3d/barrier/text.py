"""What a barrier is, in a few words: kind, count and sizes."""

from __future__ import annotations

from collections.abc import Iterable

from ..base.plain_words import plain_words
from .barrier_kind import BarrierKind

__all__ = ["barrier_text", "varied_barrier_text"]


def barrier_text(barrier: BarrierKind | None) -> str:
    """Return kind, count and sizes of a barrier, as ``5 bollards, Ø 0.32 m, 1 m high, ...``."""
    return "no barrier" if barrier is None else barrier.text


_VARIED = {"free_standing": "its segments"}
"""Number of a barrier -> what is varied with it, where the name does not say it."""


def varied_barrier_text(barrier: BarrierKind | None, parameters: Iterable[str]) -> str:
    """Return :func:`barrier_text` of a study, which may vary the barrier or some of its numbers."""
    names = list(parameters)
    if "barrier" in names:
        return "several barriers"
    own = [name.removeprefix("barrier.") for name in names if name.startswith("barrier.")]
    words = ", ".join(_VARIED.get(name, plain_words(name)) for name in own)
    return barrier_text(barrier) + (f"; {words} varied" if own else "")
