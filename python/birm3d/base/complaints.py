"""Warnings about runs whose results are not reliable, once for a run and once for a study."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

from .arguments import caller_level

__all__ = ["Complaint", "Complaints"]

_MOST_RANGES = 8  # of rows that a warning names


class Complaint(NamedTuple):
    """A quantity of a run that is out of bounds."""

    category: type[Warning]
    quantity: str
    value: float  # the greater the worse
    text: Callable[[], str]
    advice: Callable[[], str] | None = None  # for cautions and reports, where the outcome is in doubt

    def warn(self) -> None:
        """Warn of it, at the line that called this package."""
        warnings.warn(self.text(), self.category, stacklevel=caller_level())


@dataclass
class _Kind:
    """All complaints of one quantity."""

    rows: list[int] = field(default_factory=list)
    worst: float = 0.0
    worst_row: int = -1
    text: Callable[[], str] | str = ""  # of the worst


class Complaints:
    """Complaints of the runs of a study: which rows there are of each kind, and the worst one."""

    def __init__(self) -> None:
        self._kinds: dict[tuple[type[Warning], str], _Kind] = {}

    def add(self, row: int, complaints: Iterable[Complaint]) -> None:
        """Take the complaints of one run."""
        for category, quantity, value, text, _ in complaints:
            kind = self._kinds.get((category, quantity))
            if kind is None:
                kind = self._kinds[category, quantity] = _Kind()
            kind.rows.append(row)
            if kind.worst_row < 0 or value > kind.worst:
                kind.worst, kind.worst_row, kind.text = value, row, text

    def told(self) -> Complaints:
        """Return the same with the texts made of what they are made of, which is not kept."""
        for kind in self._kinds.values():
            kind.text = _text_of(kind.text)
        return self

    def merge(self, others: Complaints) -> None:
        """Take those of other runs."""
        for key, new in others._kinds.items():
            kind = self._kinds.setdefault(key, _Kind())
            kind.rows += new.rows
            # The first row of equal ones, in whichever order the runs end.
            if kind.worst_row < 0 or (new.worst, -new.worst_row) > (kind.worst, -kind.worst_row):
                kind.worst, kind.worst_row, kind.text = new.worst, new.worst_row, new.text

    def summaries(self, runs: int) -> Iterator[tuple[type[Warning], str]]:
        """Yield category and text of one warning for each quantity; of so many runs."""
        for (category, _), kind in sorted(self._kinds.items(), key=lambda item: item[0][1]):
            count = len(kind.rows)
            rows = (
                "" if count == 1 else f", the worst of {count:,} in {runs:,} runs: rows {_ranges(kind.rows)}"
            )
            yield category, f"{_text_of(kind.text)} (row {kind.worst_row}{rows})"

    def warn(self, runs: int) -> None:
        """Warn once of each quantity, at the line that called this package; of so many runs."""
        for category, text in self.summaries(runs):
            warnings.warn(text, category, stacklevel=caller_level())


def _text_of(text: Callable[[], str] | str) -> str:
    return text if isinstance(text, str) else text()


def _ranges(rows: list[int]) -> str:
    """Return "0 to 3, 7" for 0, 1, 2, 3, 7."""
    ordered = sorted(rows)
    ranges: list[list[int]] = []
    for row in ordered:
        if ranges and row == ranges[-1][1] + 1:
            ranges[-1][1] = row
        else:
            ranges.append([row, row])
    named = [f"{a}" if a == b else f"{a} to {b}" for a, b in ranges[:_MOST_RANGES]]
    left = sum(b - a + 1 for a, b in ranges[_MOST_RANGES:])
    return ", ".join(named) + (f" and {left:,} more" if left else "")
