"""Doubts in ratings: why the outcome or a verdict of a run can not be relied on."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

from ..result.run_warnings import doubts_of

if TYPE_CHECKING:
    from ..base.complaints import Complaint
    from ..result import Result

__all__ = ["Doubt", "doubt_of", "doubts_of_run"]


class Doubt(NamedTuple):
    """Why the outcome or a verdict of a run can not be relied on.

    Attributes
    ----------
    kind : str
        Doubts of one kind differ in their numbers only.
    value : float
        The greater the worse.
    text : str
        Whole sentences; ``{names}`` stands for the names.
    names : tuple of str
        Criteria that it is about.
    """

    kind: str
    value: float
    text: str
    names: tuple[str, ...] = ()

    @property
    def sentence(self) -> str:
        """As the cautions of one run have it."""
        return self.text.replace("{names}", ", ".join(self.names))


def doubts_of_run(result: Result) -> Iterator[Doubt]:
    """Yield why the outcome of a run can not be relied on, as its warnings say."""
    yield from map(doubt_of, doubts_of(result))


def doubt_of(complaint: Complaint) -> Doubt:
    """Return the doubt that a complaint with an advice raises."""
    assert complaint.advice is not None
    return Doubt(complaint.quantity, complaint.value, complaint.advice())
