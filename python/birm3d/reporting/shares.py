"""Shares of the runs of a study as cells of a table, with their intervals."""

from __future__ import annotations

from collections.abc import Iterator

from ..base.intervals import wilson
from ..result.event import outcome_words
from ..study import Study
from ..study.counted import counted
from .blocks import Table

__all__ = ["cells_of_share", "interval_of_share", "outcome_table", "share_of_runs", "study_note"]

_FINE = 400  # runs from which a tenth of a percent means something

_INTERVAL_NOTE = "95 % intervals (Wilson) take the runs as independent random draws of the inputs."
_GRID_NOTE = "The runs are a grid of chosen values. A share of them is no probability and has no interval."


def study_note(study: Study) -> str:
    """Return what shares of the runs and their intervals mean."""
    return _INTERVAL_NOTE if study.grid is None else _GRID_NOTE


def share_of_runs(count: int, n: int) -> str:
    """Return a share in percent, whole below 400 runs, finer where it would wrongly read 0 or 100 %."""
    share = count / n
    text = f"{share:.1%}" if n >= _FINE else f"{share:.0%}"
    return f"{share:.2%}" if float(text[:-1]) in (0.0, 100.0) and 0 < count < n else text


def cells_of_share(study: Study, count: int, n: int) -> tuple[str, str]:
    """Return a share of the runs, and its interval where they are no grid, as two cells."""
    text = f"{count:,} of {n:,}, {share_of_runs(count, n)}"
    return text, "–" if study.grid is not None else interval_of_share(count, n)


def interval_of_share(count: int, n: int) -> str:
    """Return the 95 % interval of a share."""
    digits = 1 if n >= _FINE else 0
    low, high = (100.0 * end for end in wilson(count / n, n))
    return f"{low:.{digits}f} to {high:.{digits}f}%"


def outcome_table(study: Study, caption: str) -> Table:
    """Return how many runs end in each outcome, and in how many something is counted."""
    head = ("outcome", "runs", "95 % interval")
    return Table(caption, head, list(_rows(study)), study_note(study), numbers=True)


def _rows(study: Study) -> Iterator[tuple[str, str, str]]:
    done = sum(study.outcomes.values())
    for word, n in study.outcomes.items():
        yield outcome_words(word), *cells_of_share(study, n, done)
    for one in counted(study):
        yield f"any outcome, with {one.words}", *cells_of_share(study, one.runs, one.n)
