"""A measured scalar that a calibration is held against."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from ..base.arguments import checked
from ..base.near_names import near_names
from ..result.metrics import METRIC_UNITS

if TYPE_CHECKING:
    from ..result.result import Result

__all__ = ["ScalarTarget", "check_positive"]

Floats = npt.NDArray[np.float64]


@checked
@dataclass(frozen=True)
class ScalarTarget:
    """A measured scalar.

    Parameters
    ----------
    metric
        One of ``Result.metrics``, as ``"max_displacement"``.
    value
        Measured, SI, degrees.
    sigma
        Standard deviation of the measurement, same unit.
    weight
        Counts the scalar as so many.
    """

    metric: str
    value: float
    sigma: float
    weight: float = 1.0

    def __post_init__(self) -> None:
        if not math.isfinite(self.value):
            raise ValueError(f"value of {self.metric} must be finite, got {self.value}")
        check_positive(f"sigma of {self.metric}", self.sigma)
        check_positive(f"weight of {self.metric}", self.weight)

    @property
    def label(self) -> str:
        """Name for reports."""
        return self.metric

    @property
    def unit(self) -> str:
        """Of the metric; "" for a pure number."""
        return METRIC_UNITS.get(self.metric, "")

    @property
    def measured(self) -> Floats:
        """Shape (1,)."""
        return np.array([self.value])

    def computed(self, result: Result) -> Floats:
        """Return the computed value, shape (1,)."""
        metrics = result.metrics
        if self.metric not in metrics:
            near = near_names(self.metric, metrics, most=3) or sorted(metrics)
            raise ValueError(f"metric must be one the run has (near: {', '.join(near)}); got {self.metric!r}")
        return np.array([metrics[self.metric]])

    def check(self, result: Result) -> list[str]:
        """Hold the scalar against a first run.

        Raises
        ------
        ValueError
            If the run has no such metric, or of the other sign.
        """
        computed = float(self.computed(result)[0])
        if computed * self.value < 0.0 and abs(self.value) > 3.0 * self.sigma:
            raise ValueError(
                f"value of {self.metric} must have the sign of the computed {computed:g}, got {self.value}"
            )
        return []


def check_positive(name: str, value: float) -> None:
    """Raise unless a value is finite and > 0."""
    if not (math.isfinite(value) and value > 0.0):
        raise ValueError(f"{name} must be finite and > 0, got {value}")
