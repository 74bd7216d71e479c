"""What can end a calibration before its time; finished work stays on the exception."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .evaluation import Evaluation

__all__ = ["CalibrationError", "CalibrationInterruptedError"]


class CalibrationError(RuntimeError):
    """A calibration that could not go on: every run failed, or the executor died.

    Attributes
    ----------
    history : tuple of Evaluation
        What had been computed; :attr:`best_values` are the best of it.
    """

    history: tuple[Evaluation, ...] = ()

    @property
    def best_values(self) -> tuple[float, ...] | None:
        """Values of the parameters with the least cost so far; ``None`` before the first run."""
        return best_values(self.history)


class CalibrationInterruptedError(KeyboardInterrupt):
    """Ctrl-C during a calibration.

    Attributes
    ----------
    history : tuple of Evaluation
    """

    history: tuple[Evaluation, ...] = ()

    @property
    def best_values(self) -> tuple[float, ...] | None:
        """Values of the parameters with the least cost so far; ``None`` before the first run."""
        return best_values(self.history)


def best_values(history: tuple[Evaluation, ...]) -> tuple[float, ...] | None:
    """Return the values with the least cost; ``None`` where no run succeeded."""
    done = [(evaluation.cost, evaluation.values) for evaluation in history if evaluation.cost is not None]
    return min(done)[1] if done else None
