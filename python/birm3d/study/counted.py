"""Metrics that count events, over several runs: in how many the event happens. A mean count says little."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..result.metric_table import METRICS
from .table import Study

__all__ = ["Counted", "counted", "is_count"]


class Counted(NamedTuple):
    """In how many (runs) of n runs an event happens; words: what tables call a run in which it does."""

    words: str
    runs: int
    n: int


def is_count(name: str) -> bool:
    """Whether a metric counts events, so that means and percentiles of it say nothing."""
    shown = METRICS[name].shown if name in METRICS else None
    return shown is not None and bool(shown.counted)


def counted(study: Study) -> list[Counted]:
    """Return each count of events that the runs of a study have, of the runs that did not fail."""
    found = []
    for name, values in study.metrics.items():
        shown = METRICS[name].shown if name in METRICS else None
        known = values[np.isfinite(values)]
        if shown is not None and shown.counted and len(known):
            found.append(Counted(shown.counted, int(np.count_nonzero(known)), len(known)))
    return found
