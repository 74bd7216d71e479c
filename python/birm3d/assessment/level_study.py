"""Probability of the classes of a whole level: each of its tests is run with many vehicles."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from typing import Any

from ..base.arguments import checked
from ..base.frozen_mapping import FrozenMapping
from ..base.intervals import wilson
from .criteria import Criterion, criteria_html, criteria_text
from .probability import RatingStudy
from .rating import Rating
from .rating_caution import level_cautions
from .roadside import RoadsideStandard
from .roadside_rating import level_rating

__all__ = ["LevelStudy", "level_study"]


class LevelStudy:
    """Ratings of a level over the vehicles of each of its tests; made by :func:`birm3d.rate`.

    Vehicles of different tests are taken as independent: a stiff small car says nothing of the pickup.

    Attributes
    ----------
    standard, level : str
    tests : mapping of str to RatingStudy
        Each test of the level -> ratings of its runs.
    probability : mapping of str to float
        Each designation of the level -> its probability, the greatest first. ``"no rating"``: a test has
        none, and no other one fails.
    contained : float
        Probability that the vehicles of all tests are known to be contained.
    caution : str
        Cautions of the tests, each once; doubts say in how many runs of their test they hold.
    """

    def __init__(self, standard: RoadsideStandard, level: str, studies: Sequence[RatingStudy]) -> None:
        self.standard, self.level = standard.name, level
        kinds = [_kinds(study) for study in studies]
        found: dict[str, float] = {}
        self.contained = 0.0
        for combined in itertools.product(*kinds):
            share = 1.0
            for _, part in combined:
                share *= part
            parts = [one for one, _ in combined]
            rated = [one for one in parts if one is not None]
            if len(rated) < len(parts):  # one test that fails decides the level
                name = "no rating" if all(one.passed for one in rated) else "fail"
                designation = f"{standard.name} {level}: {name}"
            else:
                rating = level_rating(standard, level, rated)
                designation = rating.designation
                self.contained += share * rating.contained
            found[designation] = found.get(designation, 0.0) + share
        self.probability: Mapping[str, float] = FrozenMapping(
            dict(sorted(found.items(), key=lambda one: -one[1]))
        )
        self.tests = FrozenMapping({study.test: study for study in studies})
        self.caution = " ".join(level_cautions({study.test: study.cautions for study in studies}))

    @checked
    def interval(self, share: float) -> tuple[float, float]:
        """Return the 95 % interval of a probability (Wilson), by the runs of the test with the fewest.

        The error of a product is smaller than that of a share of so many runs.

        Raises
        ------
        ValueError
            If the share is not from 0 to 1.
        """
        return wilson(share, self._runs)

    @property
    def _runs(self) -> int:
        return min(study.runs for study in self.tests.values())

    @property
    def _rows(self) -> list[Criterion]:
        rows = []
        for name, share in self.probability.items():
            low, high = self.interval(min(share, 1.0))
            rows.append(Criterion(name, f"{share:.1%}", "", f"{low:.1%} to {high:.1%}", None))
        for name, study in self.tests.items():
            good = sum(rating.passed for rating in study.ratings) / study.runs
            low, high = study.interval(good)
            rows.append(Criterion(f"test {name}: pass", f"{good:.1%}", "", f"{low:.1%} to {high:.1%}", None))
        return rows

    @property
    def _title(self) -> str:
        return (
            f"{self.standard} {self.level}, indicative: probability of each class, 95 % interval by "
            f"{self._runs} runs of each test"
        )

    def summary(self) -> str:
        """Return the probabilities, and the bands of each test, as text."""
        parts = [study.summary() for study in self.tests.values()]
        return "\n\n".join([f"{self._title}\n{criteria_text(self._rows)}\nCaution: {self.caution}", *parts])

    __str__ = summary

    def to_dict(self) -> dict[str, Any]:
        """Return all of it as plain values."""
        return {
            "standard": self.standard,
            "level": self.level,
            "probability": dict(self.probability),
            "contained": self.contained,
            "tests": {name: study.to_dict() for name, study in self.tests.items()},
            "caution": self.caution,
        }

    def _repr_html_(self) -> str:
        head = criteria_html(self._title, self._rows, f"Caution: {self.caution}")
        return head + "".join(study._repr_html_() for study in self.tests.values())

    def __repr__(self) -> str:
        return f"LevelStudy({self.standard} {self.level!r}, {dict(self.probability)})"


def _kinds(study: RatingStudy) -> list[tuple[Rating | None, float]]:
    """Return one rating of each kind that the runs of a test have, and the share of the runs with it.

    ``None`` stands for the runs without a rating.
    """
    kinds: dict[tuple[str, bool, bool], list[Rating]] = {}
    for rating in study.ratings:
        kinds.setdefault((rating.designation, rating.contained, rating.passed), []).append(rating)
    found: list[tuple[Rating | None, float]] = [(of[0], len(of) / study.runs) for of in kinds.values()]
    return [*found, (None, len(study.failed) / study.runs)] if study.failed else found


def level_study(standard: RoadsideStandard, level: str, studies: Sequence[RatingStudy]) -> LevelStudy:
    """Return the probabilities of a level.

    Raises
    ------
    ValueError
        If a test of the level is missing, is there twice, or one study has runs of several tests.
    """
    for study in studies:
        names = dict.fromkeys(rating.test for rating in study.ratings)
        if len(names) > 1:
            raise ValueError(
                f"results must hold one study for each test of {standard.name} {level}, got one with runs "
                f"of {', '.join(names)}"
            )
    named = [study.test for study in studies]
    if len(set(named)) < len(named):
        raise ValueError(
            f"results must hold one study for each test of {standard.name} {level}, got {', '.join(named)}"
        )
    return LevelStudy(standard, level, studies)
