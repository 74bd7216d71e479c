"""What a barrier is, in a few words: kind, count and sizes."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING

from .kinds import Bollards, Jersey, MeshBarrier, Pole, RigidWall

if TYPE_CHECKING:
    from .base import Barrier

__all__ = ["barrier_text", "varied_barrier_text"]

_PROFILES = {
    "new_jersey": "New Jersey barrier",
    "f_shape": "F-shape barrier",
    "single_slope": "single-slope barrier",
}


def barrier_text(barrier: Barrier | None) -> str:
    """Return kind, count and sizes of a barrier, as ``5 bollards, Ø 0.32 m, 1 m high, 1.2 m apart``."""
    if barrier is None:
        return "no barrier"
    if isinstance(barrier, RigidWall):
        if math.isinf(barrier.width) and math.isinf(barrier.height):
            return "rigid wall without end"
        sizes = [_length(barrier.width), _height(barrier.height), f"{barrier.thickness:g} m thick"]
        if barrier.edge_radius > 0.0:
            sizes.append(f"edges rounded by {barrier.edge_radius:g} m")
        return ", ".join([f"rigid wall {sizes[0]}{_segments(barrier.segments)}", *sizes[1:]])
    if isinstance(barrier, Pole):
        return f"pole, Ø {barrier.diameter:g} m"
    if isinstance(barrier, Bollards):
        return _bollards(barrier)
    if isinstance(barrier, Jersey):
        kind = _PROFILES.get(barrier.profile) if isinstance(barrier.profile, str) else None
        name = f"{kind or 'concrete barrier'}, {_height(float(barrier.half_profile()[-1, 1]))}"
        free = "" if barrier.free_standing is None else ", free-standing"
        return f"{name}, {_length(barrier.length)}{_segments(barrier.segments)}{free}"
    if isinstance(barrier, MeshBarrier):
        sizes = [f"{size:.3g}" for size in barrier.vertices.max(axis=0) - barrier.vertices.min(axis=0)]
        return f"mesh of {len(barrier.faces):,} triangles, {' by '.join(sizes)} m"
    return type(barrier).__name__


def varied_barrier_text(barrier: Barrier | None, parameters: Iterable[str]) -> str:
    """Return :func:`barrier_text` of a study, which may vary the barrier or some of its numbers."""
    names = list(parameters)
    if "barrier" in names:
        return "several barriers"
    own = [name.removeprefix("barrier.") for name in names if name.startswith("barrier.")]
    words = ", ".join(name.replace("_", " ") for name in own)
    return barrier_text(barrier) + (f"; {words} varied" if own else "")


def _bollards(barrier: Bollards) -> str:
    many = barrier.count * barrier.rows > 1
    rows = f"{barrier.rows} rows of " if barrier.rows > 1 else ""
    text = f"{rows}{barrier.count} bollard{'s' if many else ''}, Ø {barrier.diameter:g} m"
    text += f", {_height(barrier.height)}"
    if barrier.count > 1:
        text += f", {barrier.spacing:g} m apart"
    return text + (f", rows {barrier.row_spacing:g} m apart" if barrier.rows > 1 else "")


def _length(length: float) -> str:
    return "without end" if math.isinf(length) else f"{length:g} m long"


def _height(height: float) -> str:
    return "without a top" if math.isinf(height) else f"{height:.3g} m high"


def _segments(count: int) -> str:
    return f" in {count} segments" if count > 1 else ""
