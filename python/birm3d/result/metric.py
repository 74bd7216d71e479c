"""What a row of the table of metrics consists of."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal, NamedTuple, get_args

from .run_values import RunValues

__all__ = ["GROUPS", "Group", "Metric", "Shown", "asked", "kilo", "metres"]

Group = Literal[
    "crush", "barrier", "turn", "load", "motion", "departure", "attitude", "later", "check", "joint", "run"
]
GROUPS: tuple[Group, ...] = get_args(Group)
"""Groups of metrics in the order in which tables show them."""


class Shown(NamedTuple):
    """How tables show a metric: its label; divided by ``size`` it is in ``unit``; ``form`` is its format."""

    label: str
    form: str
    unit: str = ""
    size: float = 1.0
    headline: bool = False  # whether a run or a study is judged by it first
    listed: bool = True  # whether the tables of a run list it; others show it where it is asked for
    counted: str = ""  # of a count: what tables of several runs call a run in which it is above 0


class Metric(NamedTuple):
    """One scalar of a run.

    Attributes
    ----------
    unit
        SI or deg; "" for a pure number.
    group
        One of :data:`GROUPS`.
    meaning
        What it is, for the documentation. It stands alone: it refers to no other row.
    needs
        Group of extremes that the core finds for it; "end": none.
    value
        Makes it of a run; ``None``: the run does not have it.
    of
        What a run must have: nothing ("run"), a "barrier", or one of
        :data:`birm3d.result.run_values.PARTS`.
    error
        "answer": it has an error; "balance": it is one itself; "effort": it says how an answer was found.
    shown
        ``None``: tables show it by its name only, where it is asked for.
    """

    unit: str
    group: Group
    meaning: str
    needs: str
    value: Callable[[RunValues], float | None]
    of: Literal["run", "barrier", "segments", "posts", "moving", "joint", "sliding"] = "barrier"
    error: Literal["answer", "balance", "effort"] = "answer"
    shown: Shown | None = None


def kilo(label: str, unit: str, headline: bool = False) -> Shown:
    """Return how a metric is shown in thousands of its unit."""
    return Shown(label, ".0f", f"k{unit}", 1e3, headline)


def metres(label: str, headline: bool = False) -> Shown:
    """Return how a length is shown."""
    return Shown(label, ".3f", "m", headline=headline)


def asked(label: str, unit: str, size: float = 1.0) -> Shown:
    """Return how a metric is shown where it is asked for, and not in the tables of a run."""
    return Shown(label, ".4g", unit, size, listed=False)
