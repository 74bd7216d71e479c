"""Cautions about design loads: assumptions that they depend on, where these matter."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping

import numpy as np
import numpy.typing as npt

from ..barrier.barrier import Barrier
from ..barrier.kinds import Bollards
from ..base.complaints import Complaint
from ..result.element_loads import ElementLoad, touched_elements
from ..result.result import Result
from ..result.run_warnings import worst_lines
from ..result.tipping import segments_that_tip
from ..signals.filters import cfc
from .element_design import peak_filter
from .impact_end import end_of_impact
from .vehicles import HEAVY_KG

__all__ = ["barrier_caution", "has_blow", "height_caution", "merged", "run_cautions"]

_ONE_BODY = (
    "The vehicle is one rigid body with a crushable skin: engine, frame and cargo do not stop one after the "
    "other, as they do in a test."
)
_FIXED = "The barrier is rigid and fixed: the loads are upper estimates for one that gives way."
_FREE = (
    "The segments stand free: the forces are those of the vehicle on a segment, whose inertia takes a part; "
    "the ground gets no more than the friction of its base."
)
_YIELDING = (
    "The posts yield, and the loads hold for the moment that they were given. Real steel is stronger, 1.5 to "
    "2 times with hardening and rate: design a foundation for the moment and the shear of that upper bound. "
    "About a point at the depth d below the ground, a post that is loaded at the height h asks for 1 + d/h "
    "times its plastic moment."
)
_LOW_LOAD, _HIGH_LOAD = 0.3, 1.0  # heights above the ground between which vehicles load posts, about (m)
_SWITCHES = (
    "A load below {height:.2f} m turns the foundation, a higher one bends the tube. Only what a load at "
    "0.6 m moves gives way here: check the other one by itself."
)
_SLENDER = (
    "The tubes are slender (D/t beyond class 1 of EN 1993-1-1): they may buckle at the foot and lose their "
    "moment, which is not computed."
)

_ACTS = "On {elements} a load still acts when the run ends: it is taken as zero from there on."
_ALONG = "On {elements} the force along the line is greater than that across it: design for both."
_BLOW = (
    "On {elements} a crush zone is used up and the rigid body strikes, a blow of a few milliseconds. "
    "The peak, the equivalent static force and its moment rest on it. They are too high, most at short "
    "natural periods."
)
_TIPS = (
    "On {elements} the overturning moment exceeds the restoring one: the segment would begin to tip, which "
    "is not computed."
)
_UNTOUCHED = "In a run the vehicle does not touch the barrier: that run adds no load."
_OVER = "In a run the vehicle goes over {elements}: wheels meet nothing ahead of them, so loads are missing."
_PAST = "In a run the vehicle gets past {elements}: stopping it asks for more."
_LATER = "In a run the vehicle touches {elements} again after it has left: the impulse does not count that."
_LEANS = "After it has come to rest the vehicle still leans on {elements}: the impulse does not count that."
_UNDECIDED = "The outcome was not decided when a run ended: later loads on {elements} are missing."

_LOW = (
    "The vehicle is heavy, and its force is computed lower than design tables have it: at a wall of 1.07 m "
    "(TL-5) it acts at 0.59 m, and AASHTO applies its design force at 1.07 m. In four finite-element runs of "
    "another truck the moment was 1.2 to 1.5 times that of the preset cargo truck. The design values do not "
    "cover this. Where the moment by your standard is greater, use that."
)

_LEAST_SHARE = 0.01  # elements that carry less than this share of the greatest load are not mentioned
_OF_FILTERED = 2.0  # a peak that is as many times its filtered value is called a blow
_LEANS_ON = 0.02  # a lean that adds more than this share to the impulse is mentioned
_STILL_ACTS = 0.05  # a force that ends above this share of its peak still acts


def barrier_caution(barrier: Barrier) -> list[str]:
    """Return what holds for all runs at a barrier."""
    if barrier.stands_free() is not None:
        kind = _FREE
    elif barrier.core.yielding_posts:
        kind = " ".join([_YIELDING, *_of_posts(barrier)])
    else:
        kind = _FIXED
    return ["Computed, not tested: check it against a test or a code of practice.", kind, _ONE_BODY]


def _of_posts(barrier: Barrier) -> Iterator[str]:
    """Yield what the section and the foundation of posts that yield ask to be said."""
    if not isinstance(barrier, Bollards) or barrier.tube is None or barrier.weaker is None:
        return
    if barrier.tube.is_slender:
        yield _SLENDER
    if _LOW_LOAD < barrier.weaker.switch_height < _HIGH_LOAD:
        yield _SWITCHES.format(height=barrier.weaker.switch_height)


def run_cautions(result: Result) -> dict[str, tuple[str, ...]]:
    """Return cautions about the loads of one run: text -> names of the elements that it is about.

    Elements with less than a hundredth of the greatest load have none.
    """
    loads = touched_elements(result.element_loads)
    least = _LEAST_SHARE * max((load.peak_force for load in loads), default=0.0)
    loads = [load for load in loads if load.peak_force > least]
    kinds = ((_ACTS, _acts_at_end), (_ALONG, _is_along), (_BLOW, _has_blow))
    found = {text: tuple(load.name for load in loads if holds(load)) for text, holds in kinds}
    if "time_of_separation" not in result.metrics:
        later = result.time > end_of_impact(result)
        found[_LEANS] = tuple(load.name for load in loads if _leans(load, later))
    found[_TIPS] = segments_that_tip(result)
    if loads and height_caution(result):
        found[_LOW] = ("the barrier",)
    if result.outcome == "undecided":
        found[_UNDECIDED] = ("the barrier",)
    elif not loads:
        found[_UNTOUCHED] = ("the barrier",)
    if result.metrics.get("later_contacts", 0.0) > 0.0:
        found[_LATER] = ("the barrier",)
    if result.outcome == "passed" and loads:
        found[_PAST] = ("the barrier",)
    if result.outcome == "overridden":
        found[_OVER] = ("the barrier",)
    return {text: names for text, names in found.items() if names}


def height_caution(result: Result) -> str:
    """Return that the force of a heavy vehicle is found low; ``""`` for a car, a van or a pickup."""
    return _LOW if result.scene.vehicle.mass > HEAVY_KG else ""


def has_blow(result: Result) -> bool:
    """Return whether the rigid body strikes an element that carries much of the load."""
    return _BLOW in run_cautions(result)


def merged(runs: Iterable[Mapping[str, tuple[str, ...]]], doubts: Iterable[Complaint] = ()) -> list[str]:
    """Return the texts of several runs, each once with all its elements, and the worst doubt of each kind."""
    names: dict[str, dict[str, None]] = {}
    for run in runs:
        for text, elements in run.items():
            names.setdefault(text, {}).update(dict.fromkeys(elements))
    texts = [text.format(elements=", ".join(elements)) for text, elements in names.items()]
    return texts + list(worst_lines(doubts))


def _leans(load: ElementLoad, later: npt.NDArray[np.bool_]) -> bool:
    """Whether the load in later rows than those of the impact would add to the impulse."""
    lean, whole = (float(np.linalg.norm(load.force[rows].sum(axis=0))) for rows in (later, slice(None)))
    return lean > _LEANS_ON * whole


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
    return load.peak_force > _OF_FILTERED * float(np.linalg.norm(filtered, axis=1).max())
