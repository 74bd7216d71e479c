"""Runs of a calibration through an executor, with their history."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from concurrent.futures import Executor, Future
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from .._core import UnstableError
from .errors import CalibrationError
from .evaluation import Evaluation
from .packed import PackedProblem
from .problem import Noise, Problem

__all__ = ["Channel", "Evaluator", "NoRunError", "Progress"]

Floats = npt.NDArray[np.float64]
Progress: TypeAlias = Callable[[int, "float | None"], None]
"""Called after every run with the number of runs and the least cost so far."""

# What a scene or the solver says of numbers it can not compute; everything else is a fault in a program.
RUN_FAILURES = (ValueError, UnstableError, ArithmeticError)


class NoRunError(CalibrationError):
    """No run succeeded where one was needed."""


@dataclass(frozen=True)
class _Outcome:
    """What a worker hands back: errors of the scene travel as values, so that the executor's stand out."""

    computed: Floats | None = None
    failure: str | None = None
    fault: BaseException | None = None


def run_problem(packed: PackedProblem, values: Floats) -> _Outcome:
    """Run in a worker; raises nothing."""
    try:
        computed = packed.problem.computed(values)
    except RUN_FAILURES as error:
        return _Outcome(failure=f"{type(error).__name__}: {error}")
    except Exception as error:  # handed to the caller, who raises it
        return _Outcome(fault=error)
    if not np.isfinite(computed).all():
        return _Outcome(failure="a computed value is not finite")
    return _Outcome(computed=computed)


class Evaluator:
    """Computes a problem at many points at once; remembers everything; stops when told.

    Parameters
    ----------
    problem
        See :class:`Problem`.
    executor
        Any ``concurrent.futures.Executor``. It sees one task a run, never one that waits for another.
    progress
        See :data:`Progress`.
    """

    def __init__(self, problem: Problem, executor: Executor, progress: Progress | None = None) -> None:
        self.problem = problem
        self._packed = PackedProblem(problem)
        self._executor = executor
        self._progress = progress
        self._lock = threading.Lock()
        self._stopped = threading.Event()
        self._channels: list[Channel] = []
        self._count = 0
        self._best: float | None = None

    def channel(self, stage: str, noise: Noise) -> Channel:
        """Return a line of work of its own; what it computes depends on nothing that others do."""
        channel = Channel(self, stage, noise)
        self._channels.append(channel)
        return channel

    def stop(self) -> None:
        """Make every channel raise at its next run."""
        self._stopped.set()

    @property
    def history(self) -> tuple[Evaluation, ...]:
        """All runs, channel by channel in the order of their making: no matter who was faster."""
        return tuple(evaluation for channel in self._channels for evaluation in channel.history)

    def outcomes(self, shares: Sequence[Floats]) -> list[_Outcome]:
        """Run at several points, each of shape (p,), in parallel; outcomes in the same order.

        Raises
        ------
        CalibrationError
            If the executor fails.
        """
        if self._stopped.is_set():
            raise CalibrationError("the calibration was stopped")
        futures: list[Future[_Outcome]] = []
        try:
            for share in shares:
                values = self.problem.parameters.from_unit(share)
                futures.append(self._executor.submit(run_problem, self._packed, values))
            outcomes = [future.result() for future in futures]
        except Exception as error:
            for future in futures:
                future.cancel()
            raise CalibrationError(
                f"the executor {type(self._executor).__name__} failed after {self._count} runs: "
                f"{type(error).__name__}: {error}"
            ) from error
        for outcome in outcomes:
            if outcome.fault is not None:
                raise outcome.fault
        return outcomes

    def count(self, evaluations: Sequence[Evaluation]) -> None:
        """Note runs for progress."""
        with self._lock:
            for evaluation in evaluations:
                self._count += 1
                if evaluation.cost is not None and (self._best is None or evaluation.cost < self._best):
                    self._best = evaluation.cost
            if self._progress is not None:
                self._progress(self._count, self._best)


class Channel:
    """A line of work: its own noise model, memory and history."""

    def __init__(self, evaluator: Evaluator, stage: str, noise: Noise) -> None:
        self.evaluator = evaluator
        self.problem = evaluator.problem
        self.stage = stage
        self.noise = noise
        self.history: list[Evaluation] = []
        self._computed: dict[bytes, _Outcome] = {}
        self._derivatives: dict[bytes, Floats] = {}

    def computed(self, points: Sequence[Floats]) -> list[Floats | None]:
        """Return computed values at points, each of shape (p,); ``None`` where the run failed."""
        missing = {point.tobytes(): point for point in points if point.tobytes() not in self._computed}
        if missing:
            outcomes = self.evaluator.outcomes(list(missing.values()))
            notes = []
            for (key, point), outcome in zip(missing.items(), outcomes, strict=True):
                self._computed[key] = outcome
                cost = None
                if outcome.computed is not None:
                    cost = self._cost(point, outcome.computed)
                values = tuple(self.problem.parameters.from_unit(point).tolist())
                notes.append(Evaluation(self.stage, values, cost, outcome.failure))
            self.history += notes
            self.evaluator.count(notes)
        return [self._computed[point.tobytes()].computed for point in points]

    def failure(self, point: Floats) -> str | None:
        """Return why the run at a point failed."""
        return self._computed[point.tobytes()].failure

    def residuals(self, point: Floats) -> Floats:
        """Return weighted residuals and those of the priors, shape (n + q,); infinite where the run failed.

        Optimisers take an infinite residual for a step that went too far.
        """
        computed = self.computed([point])[0]
        prior, _ = self.problem.prior_rows(point)
        if computed is None:
            return np.full(len(self.problem.measured) + len(prior), np.inf)
        return np.concatenate([self.noise.weights * (computed - self.problem.measured), prior])

    def chi_square(self, point: Floats) -> float:
        """Return the sum of squared residuals."""
        residual = self.residuals(point)
        return float(residual @ residual)

    def jacobian(self, point: Floats) -> Floats:
        """Return the derivative of :meth:`residuals` by the shares, shape (n + q, p)."""
        key = point.tobytes()
        if key not in self._derivatives:
            self._derivatives[key] = self._difference(point, self.steps(point))
        _, prior = self.problem.prior_rows(point)
        return np.vstack([self.noise.weights[:, None] * self._derivatives[key], prior])

    def steps(self, point: Floats) -> Floats:
        """Return the steps of finite differences as shares, shape (p,).

        A run is smooth in its parameters but for step control, whose noise is a share of the tolerance t. A
        central difference with relative step h errs by about t / h from noise and h^2 from curvature; both
        together are least near h = (t / 2)^(1/3) (Nocedal and Wright, Numerical Optimization, section 8.1).
        Half of that suits a noise of some 5 % of t, as found on W2 and on the sedan: 0.9 % at 1e-5.
        """
        relative = 0.5 * (0.5 * self.problem.tolerance) ** (1.0 / 3.0)
        parameters = self.problem.parameters
        return np.array(
            [
                parameter.difference_step(value, relative)
                for parameter, value in zip(parameters.parameters, parameters.from_unit(point), strict=True)
            ]
        )

    def blocked(self, point: Floats) -> dict[int, tuple[float, str]]:
        """Return the parameters beside whose value a run of :meth:`jacobian` failed: its step, and why."""
        found = {}
        for k, step in enumerate(self.steps(point)):
            for signed in (-step, step):
                probe = point.copy()
                probe[k] += signed
                outcome = self._computed.get(probe.tobytes())
                if outcome is not None and outcome.failure is not None:
                    found[k] = (float(signed), outcome.failure)
        return found

    def jacobian_change(self, point: Floats) -> Floats:
        """Return how :meth:`jacobian` changes with twice the steps, shape (n + q, p).

        It holds both errors of a difference, that of the solver's noise and that of curvature.
        """
        coarse = self._difference(point, 2.0 * self.steps(point))
        change = self.noise.weights[:, None] * (coarse - self._derivatives[point.tobytes()])
        _, prior = self.problem.prior_rows(point)
        return np.vstack([change, np.zeros_like(prior)])

    def _difference(self, point: Floats, steps: Floats) -> Floats:
        """Central differences, one-sided of the same order at a bound, first order beside a failed run."""
        probes: list[Floats] = [point]
        offsets = []
        for k, step in enumerate(steps):
            if point[k] + step > 1.0:
                pair = (-step, -2.0 * step)
            elif point[k] - step < 0.0:
                pair = (step, 2.0 * step)
            else:
                pair = (step, -step)
            offsets.append(pair)
            for offset in pair:
                probe = point.copy()
                probe[k] += offset
                probes.append(probe)
        center, *rest = self.computed(probes)
        if center is None:
            raise NoRunError(f"the run at the parameters' values failed: {self.failure(point)}")
        columns = []
        for k, (a, b) in enumerate(offsets):
            one, two = rest[2 * k], rest[2 * k + 1]
            if one is None and two is None:
                label = self.problem.parameters.labels[k]
                raise NoRunError(
                    f"no run succeeds beside the value of {label}: {self.failure(probes[1 + 2 * k])}"
                )
            if one is None or two is None:
                offset, value = (b, two) if one is None else (a, one)
                assert value is not None  # one of the two runs has succeeded
                columns.append((value - center) / offset)
            else:
                # Derivative at 0 of the parabola through (0, center), (a, one), (b, two).
                columns.append((b * b * (one - center) - a * a * (two - center)) / (a * b * (b - a)))
        return np.column_stack(columns)

    def _cost(self, point: Floats, computed: Floats) -> float:
        prior, _ = self.problem.prior_rows(point)
        residual = self.noise.weights * (computed - self.problem.measured)
        return 0.5 * float(residual @ residual + prior @ prior)
