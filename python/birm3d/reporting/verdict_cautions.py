"""Cautions of the verdict: of the run, of the vehicles of its class, and of the runs of a study."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from ..assessment import RatingStudy
from ..assessment.rating_caution import level_cautions, model_cautions
from .blocks import Caution
from .study_case import Case

__all__ = ["has_doubts", "rating_cautions"]

_CLASS, _STUDY = "vehicles of the class", "runs of the study"


def rating_cautions(case: Case) -> Iterator[Caution]:
    """Yield the cautions of the ratings, each once: the doubts of some vehicles or runs with their number."""
    if not case.ratings:
        return
    model = model_cautions(case.result.scene.barrier)
    yield Caution(" ".join(model))
    told = {*model}
    yield from _without(told, {rating.standard: rating.cautions for rating in case.ratings})
    for noun, studies in _studies(case):
        yield from _without(told, {name: study.cautions_of(noun) for name, study in studies.items()})


def has_doubts(case: Case) -> bool:
    """Whether a rating on the page says why it can not be relied on."""
    studies = [study for _, found in _studies(case) for study in found.values()]
    return any(one.doubts for one in [*case.ratings, *(one for study in studies for one in study.ratings)])


def _studies(case: Case) -> Iterator[tuple[str, Mapping[str, RatingStudy]]]:
    """Yield what a run is called, and standard -> ratings of such runs."""
    if not isinstance(case.bands, str):
        yield _CLASS, case.bands.ratings
    if case.rating_study is not None:
        yield _STUDY, {case.rating_study.ratings[0].standard: case.rating_study}


def _without(told: set[str], cautions: Mapping[str, Sequence[str]]) -> Iterator[Caution]:
    """Yield cautions that were not told yet, those of several standards once, and take them as told."""
    new = {name: [one for one in found if one not in told] for name, found in cautions.items()}
    told.update(one for found in new.values() for one in found)
    yield from map(Caution, level_cautions(new, "Standard"))
