"""What the design loads of a run rest on: said where it matters."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from ..barrier.base import Barrier
from ..result.element_loads import ElementLoad, touched_elements
from ..result.result import Result
from ..signals.filters import cfc
from .element_design import peak_filter

__all__ = ["barrier_caution", "run_cautions"]

_ONE_BODY = (
    "The vehicle is one rigid body with a crushable skin: engine, frame and cargo do not stop one after the "
    "other, as they do in a test."
)
_FIXED = "The barrier is rigid and fixed: the loads are upper estimates for one that gives way."
_FREE = (
    "The segments stand free: the forces are those of the vehicle on a segment, whose inertia takes a part; "
    "the ground gets no more than the friction of its base."
)
_MOVING = "The barrier gives way: its loads hold for the stiffness and strength that it was given."

_BLOW = 2.0  # unfiltered over filtered peak
_STILL_ACTS = 0.05  # share of the peak force at the end of the run


def barrier_caution(barrier: Barrier) -> list[str]:
    """Return what holds for all runs at a barrier."""
    if barrier.stands_free() is not None:
        kind = _FREE
    elif any(getattr(barrier, name, None) is not None for name in ("foundation", "wall_thickness")):
        kind = _MOVING
    else:
        kind = _FIXED
    return ["Computed, not tested: check it against a test or a code of practice.", kind, _ONE_BODY]


def run_cautions(result: Result) -> Iterator[str]:
    """Yield what is to be said of the loads of one run, each text the same for all runs it holds for."""
    loads = touched_elements(result.element_loads)
    if result.outcome == "undecided":
        yield "The outcome of a run was not decided when it ended: later loads are missing."
    if any(_acts_at_end(load) for load in loads):
        yield "A load still acts when its run ends: it is taken as zero from there on."
    if any(_is_along(load) for load in loads):
        yield "A wall takes more force along its line than across it: the table has that across only."
    if any(_has_blow(load) for load in loads):
        yield (
            "Where a crush zone is used up the rigid body strikes: a blow of a few milliseconds is in the "
            "equivalent static force. It is not reliable at natural periods below 50 ms."
        )


def _acts_at_end(load: ElementLoad) -> bool:
    level = np.linalg.norm(load.force, axis=1)
    return bool(level[-1] > _STILL_ACTS * level.max())


def _is_along(load: ElementLoad) -> bool:
    if load.line is None:
        return False
    impulse = load.force.sum(axis=0)
    along = abs(float(impulse @ load.line))
    return along > math.hypot(impulse[0], impulse[1]) / math.sqrt(2.0)


def _has_blow(load: ElementLoad) -> bool:
    """Whether the unfiltered force has a peak that its filter takes most of."""
    if peak_filter(load.interval) == "unfiltered":
        return False
    filtered = cfc(load.force, 60, load.interval)
    return load.peak_force > _BLOW * float(np.linalg.norm(filtered, axis=1).max())
