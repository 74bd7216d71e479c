"""Each criterion of a rating over the vehicles of a class: median, 80 % band, share that meets it."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence

import numpy as np

from ..study.predict import SHARE, quantiles
from .criteria import Criterion
from .rating import Rating

__all__ = ["BAND_HEAD", "band_rows"]

BAND_HEAD = ("criterion", "median", "80 % band", "limit", "runs within the limit")
_SPEED = re.compile(r" at [\d.]+ m/s")  # in a grade, which differs from run to run
_ROUNDING = 1e-9  # relative; values that differ by less are the same

BandRow = tuple[str, str, str, str, str]


def band_rows(ratings: Sequence[Rating]) -> list[BandRow]:
    """Return name, median, band, limit and share of the runs within it of each criterion, as text.

    A value that is text has the share of the runs with each text in place of a median.
    """
    columns: dict[str, list[Criterion]] = {}
    for rating in ratings:
        for one in rating.criteria:
            columns.setdefault(one.name, []).append(one)
    return [_row(name, column) for name, column in columns.items()]


def _row(name: str, column: Sequence[Criterion]) -> BandRow:
    limits = dict.fromkeys(one.limit for one in column)
    limit = next(iter(limits)) if len(limits) == 1 else "differs between the runs"
    return name, *_values(column), limit, _share(column)


def _values(column: Sequence[Criterion]) -> tuple[str, str]:
    numbers = [one.value for one in column if not isinstance(one.value, str)]
    if len(numbers) < len(column):
        shown = Counter(one.shown for one in column).most_common()
        if len(shown) == 1:
            return shown[0][0], "the same in all"
        return ", ".join(f"{text} {n / len(column):.0%}" for text, n in shown), "–"
    low, middle, high = quantiles(np.array(numbers, float), SHARE)
    unit = column[0].unit
    median = Criterion("", middle, unit, "", None).shown
    if max(numbers) - min(numbers) <= _ROUNDING * max(map(abs, numbers)):
        return median, "the same in all"
    return median, f"{Criterion('', low, '', '', None).shown} to {Criterion('', high, unit, '', None).shown}"


def _share(column: Sequence[Criterion]) -> str:
    judged = [one.passed for one in column if one.passed is not None]
    grades = Counter(_SPEED.sub("", one.grade) for one in column if one.grade)
    if judged:
        return f"{sum(judged) / len(column):.0%}"
    if len(grades) > 1:
        return ", ".join(f"{grade} {n / len(column):.0%}" for grade, n in grades.most_common())
    return "reported"
