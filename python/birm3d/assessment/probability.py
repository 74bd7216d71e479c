"""Probabilities of classes: every run of a study is rated."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ..base.arguments import checked
from ..base.frozen_mapping import FrozenMapping
from ..base.intervals import wilson
from ..study.predict import SHARE, quantiles
from ..study.whole_runs import look_at_study, require_found
from .criteria import Criterion, criteria_html, criteria_text, foot_html, table_html, table_text
from .rating import Rating
from .rating_bands import BAND_HEAD, band_rows
from .roadside import EN_1317, MASH
from .study_cautions import cautions_of_runs

if TYPE_CHECKING:
    from ..result import Result
    from ..study import Study

__all__ = ["RatingStudy", "rate_study", "rating_study", "why_missing"]

_UNDECIDED = "result must have run until"
_UNKNOWN = "vehicle must be one that"


class RatingStudy:
    """Ratings of the runs of a study; made by :func:`birm3d.rate`. Always indicative.

    Attributes
    ----------
    ratings : tuple of Rating
        In the order of the study's runs, of those that could be rated.
    failed : mapping of int to str
        Number of each run that failed, or could not be rated -> its reason. Shares count these runs, too.
    """

    def __init__(self, ratings: Mapping[int, Rating], failed: Mapping[int, str]) -> None:
        self.ratings = tuple(ratings.values())
        self.failed = FrozenMapping(dict(failed))

    @property
    def designation(self) -> tuple[str, ...]:
        """Of each run that could be rated."""
        return tuple(rating.designation for rating in self.ratings)

    @property
    def penetration(self) -> npt.NDArray[np.float64]:
        """Of each run that could be rated, shape (n,) [m]; see :class:`birm3d.assessment.Rating`."""
        return np.array([rating.penetration for rating in self.ratings])

    @property
    def counts(self) -> Mapping[str, int]:
        """Number of the runs that have each designation, or ``"no rating: why"``; the greatest first."""
        missing = [f"no rating: {why_missing(reason)}" for reason in self.failed.values()]
        return FrozenMapping(dict(Counter([*self.designation, *missing]).most_common()))

    @property
    def runs(self) -> int:
        """Number of all runs, also of those without a rating."""
        return len(self.ratings) + len(self.failed)

    @property
    def probability(self) -> Mapping[str, float]:
        """Share of all runs that have each designation, or ``"no rating: why"``; the greatest first."""
        return FrozenMapping({name: count / self.runs for name, count in self.counts.items()})

    @property
    def contained(self) -> float:
        """Share of all runs in which the vehicle is known to be contained."""
        return sum(rating.contained for rating in self.ratings) / self.runs

    @checked
    def interval(self, share: float) -> tuple[float, float]:
        """Return the 95 % interval of a probability by its share of these runs (Wilson).

        Raises
        ------
        ValueError
            If the share is not from 0 to 1.
        """
        return wilson(share, self.runs)

    @property
    def cautions(self) -> tuple[str, ...]:
        """Those of the runs that could be rated, each once; doubts say in how many of these they hold."""
        return self.cautions_of("runs")

    def cautions_of(self, noun: str) -> tuple[str, ...]:
        """Return the cautions with another word for the runs, in the plural."""
        return cautions_of_runs(self.ratings, f"rated {noun}" if self.failed else noun)

    @property
    def caution(self) -> str:
        """All cautions as one text."""
        return " ".join(self.cautions)

    @property
    def test(self) -> str:
        """What the first run is rated as, as ``"3-11"``; "" of a security barrier."""
        return self.ratings[0].test

    @property
    def rows(self) -> list[tuple[str, str, str, str, str]]:
        """Name, median, 80 % band, limit and share of the runs within it of each criterion, as text.

        Of the runs that could be rated.
        """
        return band_rows(self.ratings)

    def _rows(self) -> list[Criterion]:
        rows = []
        for name, share in self.probability.items():
            low, high = self.interval(share)
            limit = f"{low:.1%} to {high:.1%} by {self.runs} runs"
            rows.append(Criterion(name, f"{share:.1%}", "", limit, None))
        low, median, high = quantiles(self.penetration, SHARE)
        past = "vehicle intrusion" if self.ratings[0].standard in (MASH.name, EN_1317.name) else "penetration"
        rows.append(
            Criterion(f"{past}, median", float(median), "m", f"80 %: {low:.2f} to {high:.2f} m", None)
        )
        return rows

    @property
    def _title(self) -> str:
        first = self.ratings[0]
        without = f"; {len(self.failed)} runs without a rating" if self.failed else ""
        what = "indicative: probability of each class"
        return f"{first.standard}, {what} (vehicle {first.vehicle_class}){without}"

    @property
    def _of_rated(self) -> str:
        """Return which runs the bands are of."""
        rated = f"the {len(self.ratings)} of {self.runs} runs that are rated" if self.failed else "the runs"
        return f"Each criterion over {rated}"

    def summary(self) -> str:
        """Return the probabilities with their sampling errors, each criterion's band, and the caution."""
        tables = [criteria_text(self._rows()), "", self._of_rated, table_text(BAND_HEAD, self.rows)]
        return "\n".join([self._title, *tables, f"Caution: {self.caution}"])

    __str__ = summary

    def to_dict(self) -> dict[str, Any]:
        """Return all of it as plain values."""
        return {
            "standard": self.ratings[0].standard,
            "probability": dict(self.probability),
            "contained": self.contained,
            "penetration": self.penetration.tolist(),
            "criteria": [dict(zip(BAND_HEAD, row, strict=True)) for row in self.rows],
            "failed": {str(run): reason for run, reason in self.failed.items()},
            "caution": self.caution,
        }

    def _repr_html_(self) -> str:
        bands = table_html(self._of_rated, BAND_HEAD, self.rows)
        return criteria_html(self._title, self._rows()) + bands + foot_html(self.caution)

    def __repr__(self) -> str:
        return f"RatingStudy({self.runs} runs, {dict(self.probability)})"


def why_missing(reason: str) -> str:
    """Return why a run has no rating in few words, by the error that said so."""
    if reason.startswith(_UNDECIDED):
        return "outcome not decided"
    if reason.startswith(_UNKNOWN):
        return "the standard has no vehicle of that mass"
    return re.split("[,;] got ", reason)[0]


def rate_study(study: Study, rate: Callable[[Result], Rating]) -> RatingStudy:
    """Return the ratings of all runs of a study; each is run once more, for its histories.

    Raises
    ------
    ValueError
        If no run can be rated; the message has the reason of the first.
    """
    ratings, failed = look_at_study(study, rate, title="ratings")
    return rating_study(ratings, failed)


def rating_study(ratings: Mapping[int, Rating], failed: Mapping[int, str]) -> RatingStudy:
    """Return the ratings of runs as a study.

    Raises
    ------
    ValueError
        If there is none; the message has the reason of the first.
    """
    require_found(ratings, failed, "can be rated")
    return RatingStudy(ratings, failed)
