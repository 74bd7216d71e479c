"""What figures and tables call the columns of a study, and the units in which they show them."""

from __future__ import annotations

from typing import NamedTuple

from ..base.plain_words import plain_words
from ..base.shown_numbers import plain_number, shown_unit
from ..result.metric_table import METRICS
from ..result.summary import shown_as

__all__ = ["ShownColumn", "metric_column", "parameter_words", "shown_column", "shown_metric"]

# Parameters whose names say less than they could.
_WORDS = {
    "vehicle.gvw": "vehicle mass",
    "vehicle.mass_center_height": "height of the mass centre",
    "barrier.friction": "friction at the barrier",
}


class ShownColumn(NamedTuple):
    """A column: its words, its unit, and the divisor: the shown value is the SI value over it."""

    words: str
    divisor: float
    unit: str

    @property
    def label(self) -> str:
        """Words and unit, as ``"impact speed [m/s]"``."""
        return f"{self.words} [{self.unit}]" if self.unit else self.words


def shown_column(name: str, unit: str) -> ShownColumn:
    """Return how a column is shown; metrics are shown as the tables of a run show them.

    Parameters
    ----------
    name
        Of a parameter, of a metric, or ``outcome``.
    unit
        Of its values, SI; "" for pure numbers.
    """
    if name in METRICS and METRICS[name].shown is not None:
        return ShownColumn(*shown_as(name))
    size, shown = shown_unit(unit)
    return ShownColumn(parameter_words(name), size, shown)


def metric_column(name: str) -> ShownColumn:
    """Return how the column of a metric is shown."""
    return shown_column(name, METRICS[name].unit)


def shown_metric(name: str, value: float) -> str:
    """Return a value of a metric (SI) as text in the unit in which tables show it."""
    column = metric_column(name)
    return f"{plain_number(value / column.divisor)} {column.unit}".rstrip()


def parameter_words(name: str) -> str:
    """Return a parameter in words: ``barrier.spacing`` is ``"barrier: spacing"``."""
    if name in _WORDS:
        return _WORDS[name]
    group, _, number = plain_words(name).rpartition(".")
    return f"{group.replace('.', ' ')}: {number}" if group else number
