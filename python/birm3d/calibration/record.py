"""What a calibration found: fitted values, their intervals and the runs that led to them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from .evaluation import Evaluation
from .fitted import FittedParameter, FittedTarget
from .identifiability import Spread
from .problem import Noise, Problem
from .profile import Profile

__all__ = ["CalibrationRecord"]

Floats = npt.NDArray[np.float64]


@dataclass(eq=False)
class CalibrationRecord:
    """The values of :class:`CalibrationResult`, of which its text and its file are made."""

    parameters: tuple[FittedParameter, ...]
    targets: tuple[FittedTarget, ...]
    chi_square: float
    spread: Spread
    confidence: float
    covariance: Floats
    correlation: Floats
    condition_number: float | None
    notes: tuple[str, ...]
    starts: tuple[Mapping[str, Any], ...]
    history: tuple[Evaluation, ...]
    settings: Mapping[str, Any]
    profiles: dict[str, Profile] = field(default_factory=dict)
    doubts: tuple[str, ...] = ()
    _problem: Problem | None = None
    _noise: Noise | None = None

    @property
    def values(self) -> dict[str, float]:
        """Fitted value of every parameter."""
        return {parameter.label: parameter.value for parameter in self.parameters}

    @property
    def intervals(self) -> dict[str, tuple[float, float] | None]:
        """Interval of every parameter; ``None`` where the data do not tell it."""
        return {parameter.label: parameter.interval for parameter in self.parameters}

    @property
    def identified(self) -> tuple[str, ...]:
        """Parameters that the data tell: those with an interval."""
        return tuple(parameter.label for parameter in self.parameters if parameter.reason is None)

    @property
    def verdict(self) -> str:
        """What the data can and can not tell, in plain words."""
        missing = [f"{p.label}: {p.reason}" for p in self.parameters if p.reason is not None]
        if not missing and not self.doubts:
            return "every parameter is identified"
        if not missing:
            return _listed("every parameter has an interval, NOT all are identified by the data", self.doubts)
        count = f"{len(missing)} of {len(self.parameters)} parameters"
        lines = _listed(f"NOT identified, without an interval: {count}", missing)
        return f"{lines}\n{_listed('intervals with doubts', self.doubts)}" if self.doubts else lines

    @property
    def failed_runs(self) -> int:
        """Runs that failed; their reasons are in the history."""
        return sum(evaluation.cost is None for evaluation in self.history)

    def __getitem__(self, label: str) -> FittedParameter:
        for parameter in self.parameters:
            if parameter.label == label:
                return parameter
        raise KeyError(f"parameter must be one of {', '.join(self.values)}; got {label!r}")


def _listed(head: str, lines: Sequence[str]) -> str:
    return "\n".join([head, *(f"  {line}" for line in lines)])
