"""Runs of a study of errors: one setting of one variant each, and the row that it becomes."""

from __future__ import annotations

import math
import statistics
import warnings
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field

from ...result.energy_balance import BalanceWarning
from ...simulation.parameters import varied
from ...simulation.simulation import Simulation
from .convergence import Limit, limit_of
from .errors import compared_metrics, relative_errors
from .precision_result import PrecisionRow

__all__ = ["PrecisionRun", "TooManyStepsError", "limits_of", "refuse_stricter", "row_of", "run_at"]

_LONG = 1.0  # s: a run that takes longer is not repeated
_NOT_RUN = "not run: interrupted before it"


class TooManyStepsError(RuntimeError):
    """A run takes more steps than it may."""


@dataclass
class PrecisionRun:
    """A setting of a variant before it is a row."""

    variant: str
    kind: str
    value: float
    simulation: Simulation
    without: Collection[str] = ()
    times: list[float] = field(default_factory=list)
    metrics: Mapping[str, float] = field(default_factory=dict)
    steps: int = 0
    redone: int = 0
    force_evaluations: int = 0
    critical_step: float = math.inf
    refused: str = ""
    most_steps: float = math.inf
    too_long: bool = False  # beyond these steps

    def once(self) -> None:
        """Run it, once more or for the first time; what takes more than a second is not repeated."""
        if self.refused or max(self.times, default=0.0) > _LONG:
            return
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", BalanceWarning)  # what is off shows as the error
                result = self.simulation._run(self._watch)
            if not self.times:
                self.metrics = result.metrics  # too short a run has none
        except (ValueError, RuntimeError) as refused:  # UnstableError, or no longer finite
            self.refused = f"{type(refused).__name__}: {refused}"
            self.too_long = isinstance(refused, TooManyStepsError)
            self.simulation.reset()
            return
        self.times.append(result.run_time)
        counts = result.statistics
        self.steps, self.redone = counts.steps, counts.rejected
        self.force_evaluations = counts.node_evaluations
        self.critical_step = counts.least_critical_step
        self.simulation.reset()  # its record is larger than all that is kept

    def _watch(self, now: float, steps: int) -> None:
        if steps > self.most_steps:
            raise TooManyStepsError(
                f"most_steps must be at least what the run takes, got {self.most_steps:,}, taken by "
                f"t = {now:.4g} s"
            )

    @property
    def values(self) -> dict[str, float]:
        """Metrics that have errors; none of a refused run."""
        if self.refused:
            return {}
        names = compared_metrics(self.metrics)
        return {name: self.metrics[name] for name in names if name not in self.without}


def refuse_stricter(run: PrecisionRun, others: Collection[PrecisionRun]) -> None:
    """Refuse stricter tolerances of a variant of which a run takes too many steps."""
    if not run.too_long:
        return
    for other in others:
        if other.variant == run.variant and other.kind == run.kind and other.value < run.value:
            other.refused = other.refused or f"not run: tolerance {run.value:g} takes too many steps"


def run_at(
    base: Simulation,
    variant: str,
    kind: str,
    value: float,
    without: Collection[str] = (),
    most_steps: float = math.inf,
) -> PrecisionRun:
    """Return a scene at a tolerance or a fixed step, to be run."""
    changes = {"settings.time_step": None, f"settings.{kind}": value}
    return PrecisionRun(variant, kind, value, varied(base, changes), without, most_steps=most_steps)


def limits_of(
    runs: Sequence[PrecisionRun],
    wanted: Sequence[str],
    least: Mapping[str, float],
    h: Sequence[float] | None = None,
) -> dict[str, Limit]:
    """Return what the metrics that all runs have converge to; nothing if one was refused."""
    values = [run.values for run in runs]
    steps = [run.value for run in runs] if h is None else h
    found = {}
    for name in wanted:
        if all(name in answers for answers in values):
            column = [answers[name] for answers in values]
            found[name] = limit_of(steps, column, max(abs(column[-1]), least[name]))
    return found


def row_of(run: PrecisionRun, limits: Mapping[str, Limit], least: Mapping[str, float]) -> PrecisionRow:
    """Return a run with its errors against the converged values."""
    settings = run.simulation.scene.settings
    if run.refused or not run.times:
        return PrecisionRow(
            run.variant, run.kind, run.value, settings, {}, {}, refused=run.refused or _NOT_RUN
        )
    values = {name: value for name, value in run.values.items() if name in limits}
    return PrecisionRow(
        run.variant,
        run.kind,
        run.value,
        settings,
        values,
        relative_errors(values, {name: limits[name].value for name in values}, least),
        run_time=statistics.median(run.times),
        steps=run.steps,
        redone=run.redone,
        force_evaluations=run.force_evaluations,
        energy_residual=run.metrics["energy_residual"],
        momentum_residual=run.metrics["momentum_residual"],
        contact_overlap=run.metrics.get("contact_overlap", 0.0),
    )
