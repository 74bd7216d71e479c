"""What became of the vehicle at the barrier: one of six words, and a sentence that says how.

The core finds it while the run goes on (:class:`birm3d._core.Event`), without histories. It does not depend
on the duration of a run that ends after the vehicle has left or rests. The vehicle *has left for good* when
it moves away from every element of the barrier so that no rotation brings it back. Of a free-standing chain
the box around it counts.
A vehicle that goes on past the barrier must also be out of its reach. One that skids beside an end of the
barrier is followed until its tyres turn its path no more, one that rolls past the end until it has passed.

Where it goes then decides. Whether a contained vehicle is stopped or redirected is judged as it loses contact
for the last time, as its exit angle is. Rolling over counts over the whole run:

``overridden``
    It left past the barrier's line, or rests there. While its mass centre was past the line, the top of an
    element was below its rigid body. Or it has rolled over, or rests, behind the far side of the element
    over which it crossed the line.
``passed``
    It left past the line, or towards it beyond the barrier's end, or rests past the line without touching
    the barrier. So does one that was stopped or redirected, and came past an end of the barrier afterwards.
    The path of one that was turned back counts until it is clear: two times the reach of the vehicle from
    its mass centre away from every element.
    It may end before the line: one that had crossed it and came back, as about a pole, or one that was still
    on its way. The detail has the distance.
``rolled_over``
    Neither of these, and an up axis was beyond 90 degrees from the vertical at some step. Vehicles that start
    more than 46 degrees from upright never have rolled over.
``redirected``
    Contained, and it leaves along the barrier, within 45 degrees of the line in its direction of travel. It
    has more than a tenth of its impact speed. Or it slides on along a straight barrier, at rest sideways. Or
    it still slides along any barrier when a run of 5 s or longer ends.
``stopped``
    Contained, and its motion into the barrier ended: it rebounds or rests. One that rests against a post may
    have its mass centre past the line. Or it has less than a tenth of its
    impact speed when a run of 5 s or longer ends.
``undecided``
    The run ended before, or there is no barrier and the vehicle has not rolled over.

The line is that of :func:`birm3d.metrics.compute_metrics`; of free-standing barriers it moves with their
segments, of meshes it is where they end. On paths along the line it is where the barrier begins.
The mass centre is that of the leading unit.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ..barrier.kinds import MeshBarrier
from .metric_functions import angle_of_exit
from .metrics import ALONG_LINE, METRIC_UNITS, METRICS, compute_metrics
from .record import RunRecord
from .run_values import parts_of

if TYPE_CHECKING:
    from .. import _core
    from ..barrier.barrier import Barrier
    from .stored import Stored

__all__ = [
    "CONTAINED",
    "DECIDED",
    "HELD",
    "OUTCOMES",
    "PAST",
    "Metrics",
    "gets_past",
    "has_rolled_over",
    "is_open",
    "longer_run",
    "metrics_of",
    "outcome_detail",
    "outcome_words",
]

CONTAINED = ("stopped", "redirected")
"""Outcomes of a vehicle that the barrier contains."""
HELD = (*CONTAINED, "rolled_over")
"""Outcomes of a vehicle that does not get past the barrier, upright or not."""
PAST = ("passed", "overridden")
"""Outcomes of a vehicle that gets past the barrier."""
OUTCOMES = (*CONTAINED, *PAST, "rolled_over", "undecided")
"""All words that :attr:`birm3d.Result.outcome` may be."""


def outcome_words(outcome: str) -> str:
    """Return an outcome as texts have it: ``"rolled over"``."""
    return outcome.replace("_", " ")


def gets_past(result: RunRecord) -> bool:
    """Whether the vehicle passed the barrier, or went over it."""
    return result.outcome in PAST


def has_rolled_over(result: RunRecord) -> bool:
    """Return whether the vehicle rolled over, also one that passed the barrier or went over it."""
    return result._event is not None and result._event.rolled_over


def is_open(result: RunRecord) -> bool:
    """Return whether the run ended before the barrier had kept the vehicle or not, rolled over or upright."""
    return result._event is None or result._event.manner in ("moving", "no_barrier")


def longer_run(result: RunRecord) -> str:
    """Return which duration would let the outcome be decided; with ``None`` the run had the longest one."""
    if result.scene.duration is None:
        return f"a duration above {result.time[-1]:g} s"
    return "duration=None"


DECIDED = ("separated", "stopped", "sliding")
"""Ends of a run at which nothing can change any more; see :data:`birm3d.result.report.END_REASONS`."""

_TIPPED = 60.0  # deg; beyond, a leading unit may be the one whose up axis pointed below the horizontal
_MANNERS = {
    "rests_untouched": "it came to rest before it reached the barrier",
    "rests": "it came to rest at the barrier",
    "rebounds": "it rebounded from the barrier",
    "leaves": "it left along the barrier",
    "slides_to_end": "it slid along the barrier to its end and left",
    "slides_on": "it slides on along the barrier",
    "rests_beyond": "it came to rest behind the barrier",
    "over": "it went over the top of the barrier",
}
_AT_POSTS = {
    "leaves": "it left along the barrier's line",
    "slides_to_end": "it left along the barrier's line beyond the last post",
}
"""The same at posts, which have no face to slide along."""
_GLANCES = "it glanced off the {post} and left beside it"
_AT_LINE = 0.05  # m; a mass centre that is nearer to the line is neither before it nor past it
_CLEARLY_NEARING = -1.0  # deg, of the path at the last contact
_PARTS = {
    "segments": "no segments stand free",
    "posts": "no posts yield",
    "moving": "nothing of the barrier moves",
    "joint": "the vehicle is one unit",
    "sliding": "the vehicle has no load bed that slides",
}
"""Part of a scene that a metric needs -> what is said where there is none."""
_AT_SEPARATION = ("time_of_separation", "exit_speed", "exit_angle", "restitution")


def outcome_detail(result: RunRecord) -> str:
    """Return how the outcome came about: one sentence."""
    event = result._event
    if event is None:
        return (
            f"birm3d {result.version}, which made the result, did not find the outcome: run its scene again"
        )
    rolled = f" and {_who_rolled(result)}rolled over" if event.rolled_over else ""
    if event.manner == "no_barrier":
        return f"there is no barrier{': it rolled over' if rolled else ''}"
    touched = bool(result._history.elements)
    if event.manner in ("moving", "slow"):
        where = "in contact with" if event.touching else "clear of" if touched else "not yet at"
        pace = "slower than a tenth of its impact speed" if event.manner == "slow" else "still moving"
        nearing = _nearing(event, result.scene.barrier) if event.manner == "slow" else ""
        return f"it was {pace} when the run ended, {where} the barrier{nearing}{rolled}"
    if event.manner in ("between", "beside"):
        return _way_past(result, event.manner, "touching it" if touched else "untouched") + rolled
    if event.manner == "over" and not touched:
        return f"{_MANNERS['over']} untouched: wheels meet nothing ahead of them in this model{rolled}"
    return _manner_words(event.manner, result.scene.barrier) + _nearing(event, result.scene.barrier) + rolled


def _single_post(barrier: Barrier | None) -> str | None:
    """Return what the only post of a barrier is called; ``None`` of other barriers."""
    if barrier is None or not barrier.has_posts or len(barrier.element_names) > 1:
        return None
    return barrier.element_names[0]


def _manner_words(manner: str, barrier: Barrier | None) -> str:
    post = _single_post(barrier)
    if post is not None and manner == "slides_to_end":
        return _GLANCES.format(post=post)
    words = _AT_POSTS if barrier is not None and barrier.has_posts else _MANNERS
    return words.get(manner, _MANNERS[manner])


def _way_past(result: RunRecord, manner: str, touching: str) -> str:
    """Return where a vehicle passed; of one that ends before the barrier's line that it does."""
    post = _single_post(result.scene.barrier)
    beside = "the barrier's end" if post is None else f"beside the {post}"
    where = "between two elements of the barrier" if manner == "between" else beside
    past = _past_line(result)
    if past is None or past[-1] > -_AT_LINE:
        return f"it passed {where}, {touching}"
    before = f"{-past[-1]:.1f} m before the barrier's line when the run ended"
    if past.max() > _AT_LINE:
        return f"it passed {where}, {touching}, and came back: its mass centre was {before}"
    beside = "beside the barrier's end" if post is None and manner == "beside" else where
    return f"it left {beside}, {touching}: its mass centre was {before}"


def _past_line(result: RunRecord) -> npt.NDArray[np.float64] | None:
    """Return how far the mass centre is past the line, shape (n,) [m].

    ``None`` where the line does not pass through the barrier's origin. At meshes it is their far side.
    Segments that stand free take it along. On a path along the barrier it lies across the path, where the
    barrier begins.
    """
    scene = result.scene
    barrier = scene.barrier
    along = abs(math.sin(math.radians(scene.impact_angle))) < ALONG_LINE
    if barrier is None or along or barrier.core.segments or isinstance(barrier, MeshBarrier):
        return None
    past: npt.NDArray[np.float64] = (result.position - np.asarray(barrier.origin)) @ np.asarray(barrier._past)
    return past


def _nearing(event: _core.Event | Stored, barrier: Barrier | None) -> str:
    """Return a clause for a vehicle that still neared the barrier at its last contact."""
    assert barrier is not None  # without one there is no such manner
    angle = angle_of_exit(event, barrier)
    if angle is None or angle > _CLEARLY_NEARING:
        return ""
    return f", though at the last contact its mass centre still neared the barrier, at {-angle:.1f} degrees"


def _who_rolled(result: RunRecord) -> str:
    """Return "its trailing unit " if that alone rolled over: angles of a run are those of the leading one."""
    lead = np.maximum(np.abs(result.roll), np.abs(result.pitch)).max()
    return "its trailing unit " if len(result.scene.vehicle.units) > 1 and lead < _TIPPED else ""


class Metrics(Mapping[str, Any]):
    """Scalars of a run by name: numbers in SI, angles in degrees; a name that is absent says why.

    ``outcome`` and ``outcome_detail``, which are text, can be asked for; they are not among the numbers that
    iteration gives.
    """

    def __init__(self, result: RunRecord, values: Mapping[str, float]) -> None:
        self._result = result
        self._values = dict(values)

    def __getitem__(self, name: str) -> Any:
        if name in self._values:
            return self._values[name]
        if name == "outcome":
            return self._result.outcome
        if name == "outcome_detail":
            return outcome_detail(self._result)
        raise KeyError(_why_absent(self._result, name))

    def __contains__(self, name: object) -> bool:
        return name in self._values or name in ("outcome", "outcome_detail")

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __repr__(self) -> str:
        return f"Metrics({self._values!r})"


def metrics_of(result: RunRecord) -> Metrics:
    """Return all scalars of a run; of one that was read from a file, those that it was saved with."""
    saved = result.saved_metrics
    return Metrics(result, compute_metrics(result) if saved is None else saved)


def _why_absent(result: RunRecord, name: str) -> str:
    if name not in METRIC_UNITS:
        return f"metric must be one of {', '.join(METRIC_UNITS)}, outcome or outcome_detail; got {name!r}"
    scene, event = result.scene, result._event
    if scene.barrier is None:
        return f"{name}: there is no barrier"
    if name in _AT_SEPARATION and event is not None:
        if event.time_of_separation is None:
            return f"{name}: the vehicle did not separate from the barrier for good: {outcome_detail(result)}"
        if name == "exit_angle":
            return f"{name}: the vehicle does not leave on the traffic side: {outcome_detail(result)}"
    part = METRICS[name].of
    if part in _PARTS and part not in parts_of(scene):
        return f"{name}: {_PARTS[part]}"
    if name == "vehicle_penetration" and abs(math.sin(math.radians(scene.impact_angle))) < ALONG_LINE:
        return (
            f"{name}: the path runs along the barrier's line (impact_angle {scene.impact_angle:g}), so that "
            "nothing gets past it; max_displacement is the travel towards its end"
        )
    return f"{name}: the run does not have it, see birm3d.metrics.compute_metrics"
