"""Warning of segments that stand free and would begin to tip."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from ..base.complaints import Complaint
from .metrics import compute_metrics

if TYPE_CHECKING:
    from .. import _core
    from ..scene.scene import Scene
    from .analysis import RunAnalysis

__all__ = [
    "RATIO",
    "TIPPING_LIMIT",
    "TippingWarning",
    "can_tip",
    "segments_that_tip",
    "tipping",
    "tipping_of_extremes",
]

TIPPING_LIMIT = 1.0
"""Overturning over restoring moment of a segment above which it begins to tip."""
RATIO = "max_overturning_ratio"
"""Metric that the limit is for."""


class TippingWarning(UserWarning):
    """The overturning moment of a free-standing segment exceeded its restoring one, as a mean over 50 ms.

    The segment would begin to tip about its toe. The model leaves that out: its segments slide and turn, and
    stay upright. Whether a real one rocks and comes back, or falls, depends on how long the moment lasts: the
    further above 1, the sooner it falls. A vehicle that is computed as stopped or redirected may go over a
    segment that has fallen.
    """


def can_tip(scene: Scene) -> bool:
    """Return whether a scene has segments that stand free and a gravity that holds them down."""
    free = scene.barrier is not None and scene.barrier.stands_free() is not None
    return free and scene.settings.gravity > 0.0


def tipping(result: RunAnalysis) -> Iterator[Complaint]:
    """Yield a complaint that names the segment with the greatest ratio, if that is above 1."""
    if not can_tip(result.scene) or len(result.time) < 2:
        return
    ratio = compute_metrics(result, [RATIO]).get(RATIO, 0.0)
    if ratio > TIPPING_LIMIT:
        yield _complaint(ratio, _segment(result))


def segments_that_tip(result: RunAnalysis) -> tuple[str, ...]:
    """Return the names of all segments that would begin to tip."""
    if not can_tip(result.scene) or len(result.time) < 2:
        return ()
    assert result.scene.barrier is not None
    ratios = result.overturning_ratio.max(axis=0)
    return tuple(result.scene.barrier.element_names[i] for i in np.flatnonzero(ratios > TIPPING_LIMIT))


def tipping_of_extremes(scene: Scene, extremes: _core.Extremes) -> Iterator[Complaint]:
    """Yield the same of a run without histories, of which the segment is not known."""
    if can_tip(scene):
        ratio = extremes.segments.overturning / scene.settings.gravity
        if ratio > TIPPING_LIMIT:
            yield _complaint(ratio, "a segment")


def _complaint(ratio: float, segment: str) -> Complaint:
    text, advice = partial(_text, ratio, segment), partial(_advice, ratio, segment)
    return Complaint(TippingWarning, RATIO, ratio, text, advice)


def _text(ratio: float, segment: str) -> str:
    return (
        f"{RATIO} must be at most {TIPPING_LIMIT:g} for segments that stay upright, got {ratio:.3g} "
        f"(50-ms mean) at {segment}: the vehicle overturns it by more than its weight holds. It would begin "
        "to tip, which is not computed; heavier segments, a wider base or an anchorage help"
    )


def _advice(ratio: float, segment: str) -> str:
    return (
        f"The overturning moment of {segment} is {ratio:.3g} times its restoring one: it would begin to "
        "tip, which is not computed. Containment, penetration, widths and occupant risk hold for segments "
        "that stay upright."
    )


def _segment(result: RunAnalysis) -> str:
    assert result.scene.barrier is not None
    worst = int(np.argmax(result.overturning_ratio.max(axis=0)))
    return repr(result.scene.barrier.element_names[worst])
