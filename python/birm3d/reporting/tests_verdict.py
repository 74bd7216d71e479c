"""What the given tests nearest to a scene say of the model, in one line each."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from statistics import median

from ..result.summary import shown_as
from .given_tests import Compared, errors
from .likeness import same_group
from .study_case import Case

__all__ = ["answers_of_tests", "distance_past"]

_ALL_ALIKE = 4  # vehicle, barrier, speed, angle
_KINDS = {"limit": "at most ", "dynamic": "dynamic "}
_RIGID = (
    "the posts of these scenes are rigid, and real ones and their foundations give way; rely on no computed "
    "penetration"
)


def answers_of_tests(case: Case) -> Iterator[tuple[str, str]]:
    """Yield questions and answers: containment, class, values, and penetration at posts."""
    told = [*_verdicts(case.tests), *_values(case.tests)]
    if told and not any({"vehicle", "barrier"} <= set(one.alike) for one in case.tests):
        told.append("none of these tests has both this kind of vehicle and this kind of barrier")
    if told:
        yield "How well does the model do in given tests nearby?", "; ".join(told)
    yield from _penetrations(case)


def _verdicts(tests: Sequence[Compared]) -> Iterator[str]:
    """Yield how many verdicts are as published, and which are not."""
    rights = [one for one in tests if one.right is not None]
    if rights:
        yield _counted("containment", rights, [one for one in rights if one.right is False])
    judged = [one for one in rights if one.class_judged != "not published"]
    if judged:
        yield _counted("class or penetration", judged, [one for one in judged if one.class_judged == "wrong"])
    elif rights:
        yield "class or penetration published of none of them"


def _counted(what: str, tests: Sequence[Compared], wrong: Sequence[Compared]) -> str:
    names = f" (WRONG: {'; '.join(one.test.name for one in wrong)})" if wrong else ""
    return f"{what} computed as published in {len(tests) - len(wrong)} of {len(tests)} tests{names}"


def _values(tests: Sequence[Compared]) -> Iterator[str]:
    """Yield the median error, and that of each value of a test that is like the scene in everything."""
    found = errors(tests)
    if not found:
        return
    values = "1 value that was" if len(found) == 1 else f"{len(found)} values that were"
    yield f"median error {median(map(abs, found)):.0%} in {values} not fitted"
    for one in tests:
        if len(one.alike) == _ALL_ALIKE and one.error is not None and not one.test.fitted:
            yield f"{one.test.name}, {shown_as(one.test.quantity)[0]}: {one.error:+.0%}"


def _penetrations(case: Case) -> Iterator[tuple[str, str]]:
    """Yield computed beside published penetration, where a vehicle of the same group met posts."""
    barrier, kind = case.result.scene.barrier, case.result.scene.vehicle.kind or ""
    if barrier is None or not barrier.has_posts:
        return
    told = []
    for one in case.tests:
        alike = "barrier" in one.alike and same_group(kind, one.scene.vehicle.kind or "")
        if alike and one.rating is not None and one.test.penetration is not None:
            own, published = one.rating.penetration, one.test.penetration
            how = _KINDS.get(one.test.penetration_kind, "")
            told.append(f"{one.test.name}: computed {distance_past(own)}, published {how}{published:g} m")
    question = "How did penetration compare in given tests nearby?"
    if told:
        yield question, "; ".join([*told, _RIGID])
    else:
        yield question, "no published penetration of such a vehicle at posts is among them"


def distance_past(penetration: float) -> str:
    """Return a penetration [m] in words, negative ones as what the vehicle stays short by."""
    return f"{-penetration:.2f} m short of the datum" if penetration < 0.0 else f"{penetration:.2f} m"
