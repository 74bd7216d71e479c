"""One run of a calibration, as its history keeps it."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["Evaluation"]


@dataclass(frozen=True)
class Evaluation:
    """One run of all simulations.

    Attributes
    ----------
    stage : str
        ``"start 0"``, ``"global"``, ``"profile of <parameter>"`` ...
    values : tuple of float
        Of the parameters.
    cost : float or None
        Half the sum of squared residuals, with the weights of the moment; ``None`` where the run failed.
    failure : str or None
        Why it failed.
    """

    stage: str
    values: tuple[float, ...]
    cost: float | None
    failure: str | None = None
