"""What a search for a limit asks: which value, by which runs, and when a value holds."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from ..base.plain_words import plain_words
from ..result.event import HELD
from ..result.metrics import METRIC_UNITS
from ..simulation.simulation import Simulation

__all__ = ["Question"]


class Question(NamedTuple):
    """What is searched, and by which runs; its functions can be pickled, as the answer holds it.

    Attributes
    ----------
    name : str
        What is searched, as ``"clear gap"``.
    argument : str
        Which has the range, as ``"gaps"``.
    unit : str
        Of the values: ``"m"`` or ``"kg"``.
    greatest : bool
        Whether the greatest value is sought that holds, or the least.
    parameter : str
        Of the scene, as ``"barrier.spacing"``.
    of_value : callable
        Value -> what the parameter is then.
    offsets : callable
        Value -> impact offsets of its runs [m].
    measure : str
        Metric that may have a limit.
    most : float or None
        Its greatest value that holds, in its unit of :data:`birm3d.metrics.METRIC_UNITS`; ``None``: any.
    caution : str
        What the model leaves out that bears on the answer.
    outcomes : tuple of str
        Those that hold.
    remark : callable or None
        (simulation, question, the value that was found, executor) -> sentences that go on from the caution.
    """

    name: str
    argument: str
    unit: str
    greatest: bool
    parameter: str
    of_value: Callable[[float], Any]
    offsets: Callable[[float], Sequence[float]]
    measure: str
    most: float | None
    caution: str
    outcomes: tuple[str, ...] = HELD
    remark: Callable[[Simulation, Question, float, Any], str] | None = None

    @property
    def quantity(self) -> str:
        """What is searched, for texts with a unit: ``"length"`` or ``"mass"``."""
        return {"m": "length", "kg": "mass"}[self.unit]

    @property
    def measure_label(self) -> str:
        """The measure in words with its unit, as the head of a column."""
        unit = METRIC_UNITS[self.measure]
        return f"{plain_words(self.measure)} [{unit}]" if unit else plain_words(self.measure)

    @property
    def criterion(self) -> str:
        """When a value holds, in words."""
        rolled = ", or rolls over before it" if "rolled_over" in self.outcomes else ""
        text = f"the vehicle is stopped or turned away{rolled}"
        if "passed" in self.outcomes:
            text += ", or passes its end"
        if self.most is None:
            return text
        return f"{text}, {plain_words(self.measure)} <= {self.measured(self.most, 'g')}"

    def measured(self, measure: float, form: str) -> str:
        """Return a value of the measure as text in this format, with its unit."""
        return f"{measure:{form}} {METRIC_UNITS[self.measure]}".rstrip()

    def rows(self, value: float) -> list[tuple[Any, float]]:
        """Return what the parameter is at a value, and the impact offset [m], for each of its runs."""
        return [(self.of_value(value), offset) for offset in self.offsets(value)]

    def holds(self, outcome: str, measure: float) -> bool:
        """Whether a run with this outcome and measure did what it should."""
        within = self.most is None or measure <= self.most  # a NaN is not
        return within and outcome in self.outcomes
