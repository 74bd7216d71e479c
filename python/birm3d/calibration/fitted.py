"""One parameter and one target after the fit."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .parameters import unit_of_values

__all__ = ["FittedParameter", "FittedTarget"]

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True)
class FittedParameter:
    """One parameter after the fit; values in its own unit.

    Attributes
    ----------
    label : str
    names : tuple of str
        Numbers of the scene that it drives; empty for a function.
    factor, log : bool
    lower, upper : float
        Bounds.
    start, value : float
    standard_error : float or None
        ``None`` where the data do not tell the value; of the value, to first order.
    interval : tuple of float or None
        Ends at the confidence asked for; ``None`` where the data do not tell the value.
    reason : str or None
        Why there is no interval.
    """

    label: str
    names: tuple[str, ...]
    factor: bool
    log: bool
    lower: float
    upper: float
    start: float
    value: float
    standard_error: float | None
    interval: tuple[float, float] | None
    reason: str | None

    @property
    def unit(self) -> str:
        """SI unit of the values; ``""`` of a factor or a function."""
        return unit_of_values(self.names, self.factor)


@dataclass(frozen=True, eq=False)
class FittedTarget:
    """One target after the fit.

    Attributes
    ----------
    label, unit : str
    simulation : int
        Number of the simulation it belongs to.
    against : str or None
        ``"time"`` or ``"displacement"``; ``None`` for a scalar.
    x, measured, started, computed, sigma : ndarray, shape (m,)
        ``started`` is computed at the start, ``computed`` at the fitted values. x of a scalar is 0.
    channel_class : float or None
        CFC of a curve.
    independent_points : float
        How many points count as independent, times the target's weight.
    """

    label: str
    unit: str
    simulation: int
    against: str | None
    x: Floats
    measured: Floats
    started: Floats
    computed: Floats
    sigma: Floats
    channel_class: float | None
    independent_points: float

    @property
    def rms(self) -> float:
        """Root mean square of computed less measured."""
        return float(np.sqrt(np.mean((self.computed - self.measured) ** 2)))
