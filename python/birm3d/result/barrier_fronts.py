"""The front of a barrier on which a load map stands."""

from __future__ import annotations

from ..barrier.barrier import Barrier
from ..barrier.fronts import Front
from ..barrier.kinds import KINDS

__all__ = ["front_of"]


def front_of(barrier: Barrier | None) -> Front:
    """Return the front of a barrier.

    Raises
    ------
    ValueError
        If it is a kind that has no load map, or moves.
    """
    if barrier is not None and barrier.stands_free() is not None:
        raise ValueError("barrier must be fixed to have a load map, got one that stands free")
    front = None if barrier is None else barrier.load_front()
    if front is None:
        kinds = [name for name, kind in KINDS.items() if kind.load_front is not Barrier.load_front]
        got = "none" if barrier is None else type(barrier).__name__
        raise ValueError(f"barrier must be one of {', '.join(kinds)} to have a load map, got {got}")
    return front
