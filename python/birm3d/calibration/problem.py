"""Simulations, targets and parameters as one vector of residuals."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
import numpy.typing as npt

from ..simulation.parameters import varied
from .curve_target import CurveTarget
from .parameters import Parameter, ParameterSet
from .scalar_target import ScalarTarget

if TYPE_CHECKING:
    from ..simulation.simulation import Simulation

__all__ = ["Noise", "Problem", "Target", "independent_share"]

Floats = npt.NDArray[np.float64]
Target: TypeAlias = CurveTarget | ScalarTarget

# Standard deviation that a curve without one starts with, of its peak.
_FIRST_SIGMA = 0.05
# Least standard deviation that residuals may leave, of the curve's peak: below it is the solver's own error.
_LEAST_SIGMA = 1e-9
# Greatest share of a correlation time that fitted parameters are taken to have hidden.
_MOST_TAKEN = 0.5


@dataclass(frozen=True, eq=False)
class Noise:
    """How much each residual counts.

    Attributes
    ----------
    weights : ndarray, shape (n,)
        residual = weight * (computed - measured).
    points : tuple of float
        Independent points of each target, times its weight.
    sigmas : tuple of ndarray
        Standard deviations of each target's points.
    """

    weights: Floats
    points: tuple[float, ...]
    sigmas: tuple[Floats, ...]


class Problem:
    """What a calibration computes: measured values beside those of the simulations at given parameters.

    Parameters
    ----------
    simulations
        As the user gave them.
    targets
        One sequence a simulation.
    parameters
        See :class:`birm3d.calibration.Parameter`.
    tolerance
        Of the adaptive steps during the fit, unless a scene asks for a finer one or a fixed step.
    """

    def __init__(
        self,
        simulations: Sequence[Simulation],
        targets: Sequence[Sequence[Target]],
        parameters: Sequence[Parameter],
        tolerance: float,
    ) -> None:
        self.originals = tuple(simulations)
        self.parameters = ParameterSet(parameters, simulations)
        self.targets = tuple(tuple(own) for own in targets)
        self.simulations = tuple(_tightened(simulation, tolerance) for simulation in simulations)
        self.tolerance = max(simulation.scene.settings.tolerance for simulation in self.simulations)
        self.flat = tuple(target for own in self.targets for target in own)
        if not self.flat:
            raise ValueError("targets must hold at least one target, got none")
        self.owners = tuple(i for i, own in enumerate(self.targets) for _ in own)
        self.measured: Floats = np.concatenate([target.measured for target in self.flat])
        ends = np.cumsum([len(target.measured) for target in self.flat])
        self.slices = tuple(slice(int(a), int(b)) for a, b in zip([0, *ends[:-1]], ends, strict=True))

    def computed(self, values: Floats) -> Floats:
        """Run all simulations; return the computed values beside ``measured``, shape (n,)."""
        rows = []
        for i, (simulation, own) in enumerate(zip(self.simulations, self.targets, strict=True)):
            result = self.parameters.changed(simulation, i, values).run()
            rows += [target.computed(result) for target in own]
        return np.concatenate(rows)

    def check(self, values: Floats) -> list[str]:
        """Hold every target against a first run; return what a reader should know.

        Raises
        ------
        ValueError
            If a target can not be one of its simulation.
        """
        notes = []
        for i, (simulation, own) in enumerate(zip(self.simulations, self.targets, strict=True)):
            result = self.parameters.changed(simulation, i, values).run()
            for target in own:
                notes += [note for note in target.check(result) if note not in notes]
        return notes

    def noise(self, residual: Floats | None = None, free: int = 0) -> Noise:
        """Return weights: as given, or with what the differences computed - measured tell.

        Parameters
        ----------
        residual
            Differences of a fit, shape (n,); ``None`` before the first one.
        free
            Number of fitted parameters, which hide correlations of what they leave.
        """
        weights, points, sigmas = [], [], []
        for target, rows in zip(self.flat, self.slices, strict=True):
            n = rows.stop - rows.start
            if isinstance(target, ScalarTarget):
                sigma, m = np.array([target.sigma]), 1.0
            else:
                own = None if residual is None else residual[rows]
                m = _points(target, own, free)
                sigma = _sigma(target, own)
            weights.append(np.sqrt(target.weight * m / n) / sigma)
            points.append(m * target.weight)
            sigmas.append(sigma)
        return Noise(np.concatenate(weights), tuple(points), tuple(sigmas))

    @property
    def settles(self) -> bool:
        """Whether weights depend on what a fit leaves, so that it has to be repeated."""
        return any(
            isinstance(target, CurveTarget)
            and (target.given_sigma is None or target.independent_points is None)
            for target in self.flat
        )

    def prior_rows(self, shares: Floats) -> tuple[Floats, Floats]:
        """Return the residuals of the priors, shape (q,), and their derivatives, shape (q, p)."""
        rows, derivatives = [], []
        for k, parameter in enumerate(self.parameters.parameters):
            if parameter.prior is not None:
                residual, slope = parameter.prior_row(float(shares[k]))
                rows.append(residual)
                derivatives.append(slope * np.eye(len(self.parameters))[k])
        return np.array(rows), np.array(derivatives).reshape(len(rows), len(self.parameters))


def independent_share(residual: Floats, free: int = 0) -> float:
    """Return 1 / (1 + 2 sum rho_k): the share of independent points in an evenly spaced sequence.

    The sum of autocorrelations ends at the first lag of five correlation times, these being 1/2 + sum rho_k
    (A. D. Sokal, Monte Carlo methods in statistical mechanics, 1997, section 3); never more than 1. Each of
    the `free` fitted parameters lowers the sum by about (2 k + 1) / n for a window of k lags, as subtracting
    the mean does (U. Wolff, Comput. Phys. Commun. 156, 2004, section 3.1). The sum is corrected for this.
    """
    n = len(residual)
    size = float(residual @ residual)
    if n < 4 or size == 0.0:
        return 1.0
    padded = np.fft.rfft(residual, 2 * n)
    correlation = np.fft.irfft(padded * padded.conj(), 2 * n)[:n] / size
    time = 2.0 * np.cumsum(correlation) - 1.0
    window = np.flatnonzero(np.arange(n) >= 2.5 * time)
    last = int(window[0]) if len(window) else n - 1
    taken = min(_MOST_TAKEN, free * (2 * last + 1) / n)
    return float(1.0 / max(1.0, time[last] / (1.0 - taken)))


def _points(target: CurveTarget, residual: Floats | None, free: int) -> float:
    n = len(target.points)
    if target.independent_points == "all":
        return float(n)
    if target.independent_points is not None:
        return float(target.independent_points)
    if residual is None:
        return target.filter_points
    return min(target.filter_points, max(2.0, n * independent_share(residual, free)))


def _sigma(target: CurveTarget, residual: Floats | None) -> Floats:
    if target.given_sigma is not None:
        return target.given_sigma
    peak = float(np.abs(target.measured).max())
    if peak == 0.0:
        raise ValueError(
            f"sigma of {target.label} must be given for a curve that is zero throughout, got None"
        )
    if residual is None:
        return np.full(len(target.points), _FIRST_SIGMA * peak)
    # Of greatest likelihood; the degrees of freedom come in once, with the scatter of all targets together.
    sigma = float(np.sqrt(residual @ residual / len(residual)))
    return np.full(len(target.points), max(sigma, _LEAST_SIGMA * peak))


def _tightened(simulation: Simulation, tolerance: float) -> Simulation:
    settings = simulation.scene.settings
    if settings.time_step is not None or settings.tolerance <= tolerance:
        return simulation
    return varied(simulation, {"settings.tolerance": tolerance})
