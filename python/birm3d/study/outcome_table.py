"""Outcomes of many runs in columns: some hundred bytes a run, however many there are."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

import numpy as np
import numpy.typing as npt

from .store import Outcome

__all__ = ["OutcomeTable"]

_FIRST = 1024  # runs for which there is room at first, where their number is unknown


class OutcomeTable(Mapping[int, Outcome]):
    """Number of the run -> outcome, as a dictionary has it, but held in arrays.

    Parameters
    ----------
    metrics
        How many each outcome has.
    runs
        How many there will be, if that is known.
    """

    def __init__(self, metrics: int, runs: int | None = None) -> None:
        room = _FIRST if runs is None else runs
        self._values = np.empty((metrics, room))
        self._finished = np.zeros(room, bool)
        self._state_hash = np.zeros(room, "S16")
        self._words: dict[str, int] = {"": 0}  # texts that come again and again, and their places
        self._reason = np.zeros(room, np.int16)
        self._outcome = np.zeros(room, np.int16)
        self._error: dict[int, str] = {}
        self._count = 0

    def update(self, outcomes: Mapping[int, Outcome] | Iterable[tuple[int, Outcome]]) -> None:
        """Take finished runs."""
        new = dict(outcomes)
        if not new:
            return
        if max(new) >= len(self._finished):
            self._grow(max(new) + 1)
        runs = np.fromiter(new, np.int64, len(new))
        self._count += int(np.count_nonzero(~self._finished[runs]))
        self._finished[runs] = True
        self._values[:, runs] = np.array([outcome.metrics for outcome in new.values()]).T
        self._state_hash[runs] = [outcome.state_hash for outcome in new.values()]
        self._reason[runs] = [self._place(outcome.end_reason) for outcome in new.values()]
        self._outcome[runs] = [self._place(outcome.outcome) for outcome in new.values()]
        for run, outcome in new.items():
            self._error.pop(run, None)
            if outcome.error:
                self._error[run] = outcome.error

    def _place(self, word: str) -> int:
        return self._words.setdefault(word, len(self._words))

    def _grow(self, least: int) -> None:
        more = max(least, 2 * len(self._finished)) - len(self._finished)
        self._values = np.concatenate([self._values, np.empty((len(self._values), more))], axis=1)
        self._finished, self._state_hash, self._reason, self._outcome = (
            np.concatenate([column, np.zeros(more, column.dtype)])
            for column in (self._finished, self._state_hash, self._reason, self._outcome)
        )

    def __len__(self) -> int:
        return self._count

    def __contains__(self, run: object) -> bool:
        return isinstance(run, int) and 0 <= run < len(self._finished) and bool(self._finished[run])

    def __iter__(self) -> Iterator[int]:
        return iter(self.runs.tolist())

    def __getitem__(self, run: int) -> Outcome:
        if run not in self:
            raise KeyError(run)
        words = tuple(self._words)
        reason, outcome = words[self._reason[run]], words[self._outcome[run]]
        values = tuple(self._values[:, run].tolist())
        return Outcome(values, reason, outcome, self._state_hash[run].decode(), self._error.get(run, ""))

    @property
    def runs(self) -> npt.NDArray[np.int64]:
        """Numbers of the finished runs, in order."""
        return np.flatnonzero(self._finished)

    def metrics(self) -> npt.NDArray[np.float64]:
        """Return the metrics of the finished runs in order, read-only, shape (metrics, n)."""
        whole = self._count == len(self._finished)
        values = self._values if whole else self._values[:, self._finished]
        values = values.view()
        values.setflags(write=False)
        return values

    def end_reasons(self) -> list[str]:
        """Return the end reasons of the finished runs, in order."""
        return self._texts(self._reason)

    def outcomes(self) -> list[str]:
        """Return what became of the vehicles of the finished runs, in order."""
        return self._texts(self._outcome)

    def _texts(self, places: npt.NDArray[np.int16]) -> list[str]:
        words = tuple(self._words)
        return [words[place] for place in places[self._finished].tolist()]

    def state_hashes(self) -> list[str]:
        """Return the hashes of the last states of the finished runs, in order."""
        return [text.decode() for text in self._state_hash[self._finished].tolist()]

    def errors(self) -> list[str]:
        """Return the reasons of failures of the finished runs, in order; "" where there is none."""
        return [self._error.get(run, "") for run in self.runs.tolist()]
