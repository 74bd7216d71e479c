"""The lognormal curve of an event's probability against speed, fitted to counts."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

__all__ = ["Draws", "LognormalFit", "fit_lognormal"]

Floats = npt.NDArray[np.float64]

# A slope must be this many standard errors away from zero: 95 %, two-sided.
_SLOPE = 1.96


@dataclass(frozen=True, eq=False)
class LognormalFit:
    """P(event) = Phi((ln v - ln median) / dispersion), fitted by maximum likelihood (Baker 2015).

    A negative ``dispersion`` is an event that gets rarer with speed.

    Attributes
    ----------
    median : float
        Speed at which the probability is 1/2 [m/s].
    dispersion : float
        Standard deviation of the logarithm of the speed at which the event begins.
    coefficients, covariance : ndarray, shapes (2,), (2, 2)
        Of Phi(a + b ln v): from the expected information; where runs share draws, with the scatter between
        the draws (Liang and Zeger 1986).
    lack_of_fit : float or None
        Probability of counts as far from the curve as these if it is right. It follows from chi squared of
        the deviance or, where runs share draws, from Hotelling's test of the residuals. ``None`` for two
        speeds, which any curve meets.
    """

    coefficients: Floats
    covariance: Floats
    lack_of_fit: float | None

    @property
    def median(self) -> float:
        """Speed at which the probability is 1/2 [m/s]."""
        a, b = self.coefficients
        return math.exp(-a / b)

    @property
    def dispersion(self) -> float:
        """Standard deviation of ln(speed); negative for an event that gets rarer with speed."""
        return 1.0 / float(self.coefficients[1])

    @property
    def standard_errors(self) -> tuple[float, float]:
        """Of the median [m/s] and of the dispersion, to first order."""
        a, b = self.coefficients
        gradients = np.array([[-self.median / b, self.median * a / b**2], [0.0, -1.0 / b**2]])
        variances = np.einsum("ij,jk,ik->i", gradients, self.covariance, gradients)
        return math.sqrt(variances[0]), math.sqrt(variances[1])

    def probability(self, speeds: npt.ArrayLike) -> Floats:
        """Return the fitted probability at speeds [m/s], shape as `speeds`."""
        from scipy.special import ndtr

        a, b = self.coefficients
        return np.asarray(ndtr(a + b * np.log(np.asarray(speeds, float))))

    def band(self, speeds: npt.ArrayLike, confidence: float = 0.95) -> tuple[Floats, Floats]:
        """Return lower and upper limits of the fitted probability at speeds [m/s] (Wald, on probits)."""
        from scipy.special import ndtr, ndtri

        terms = np.stack(
            [np.ones_like(np.asarray(speeds, float)), np.log(np.asarray(speeds, float))], axis=-1
        )
        middle = terms @ self.coefficients
        half = ndtri(0.5 + confidence / 2.0) * np.sqrt(((terms @ self.covariance) * terms).sum(axis=-1))
        return np.asarray(ndtr(middle - half)), np.asarray(ndtr(middle + half))


class Draws(NamedTuple):
    """Runs that share their draws: run i of every speed has draw i; shape (n, k) each."""

    happened: npt.NDArray[np.bool_]
    valid: npt.NDArray[np.bool_]


def fit_lognormal(
    speeds: Floats, events: Any, runs: Any, draws: Draws | None = None
) -> tuple[LognormalFit | None, str]:
    """Fit Phi(a + b ln v) to counts, or say why there is no curve.

    Without overlap of the two outcomes the likelihood has no maximum. In one variable it has one exactly if
    the range of speeds with the event and that without overlap in more than a point (Silvapulle 1981). If the
    slope b does not differ significantly from zero, the median is not determined, and there is no curve
    either.

    Parameters
    ----------
    speeds
        Shape (k,), k >= 2, > 0 [m/s].
    events, runs
        Shape (k,): number of events in so many runs, >= 1.
    draws
        The same runs one by one, where those of different speeds depend on each other; ``None``: none do.

    Returns
    -------
    LognormalFit or None, and why there is none
    """
    from scipy.optimize import minimize
    from scipy.special import log_ndtr
    from scipy.stats import chi2, norm

    with_event, without = speeds[events > 0], speeds[events < runs]
    if not len(with_event) or not len(without):
        return None, f"the event happened in {'no run' if not len(with_event) else 'every run'}"
    if not max(with_event.min(), without.min()) < min(with_event.max(), without.max()):
        return None, (
            "outcomes do not overlap: at most one speed has runs with and without the event; "
            "choose closer speeds or more runs"
        )
    # Centred and scaled, so that the two coefficients are about as large and weakly correlated.
    x = np.log(speeds)
    center, size = x.mean(), x.std()
    terms = np.column_stack([np.ones_like(x), (x - center) / size])

    def deficit(c: Floats) -> tuple[float, Floats]:
        eta = terms @ c
        log_p, log_q, log_density = log_ndtr(eta), log_ndtr(-eta), norm.logpdf(eta)
        slope = events * np.exp(log_density - log_p) - (runs - events) * np.exp(log_density - log_q)
        return -float(events @ log_p + (runs - events) @ log_q), -(terms.T @ slope)

    found = minimize(
        deficit, np.zeros(2), jac=True, method="BFGS", options={"gtol": 1e-6 * runs.sum() ** 0.5}
    )
    if np.abs(found.jac).max() > 1e-3 * runs.sum() ** 0.5:
        return None, f"the search for the greatest likelihood did not end: {found.message}"
    eta = terms @ found.x
    weight = runs * np.exp(2.0 * norm.logpdf(eta) - log_ndtr(eta) - log_ndtr(-eta))
    covariance = np.linalg.inv((terms.T * weight) @ terms)
    if draws is not None:
        off: Floats = draws.happened - np.where(
            draws.valid, np.exp(log_ndtr(eta)), 0.0
        )  # (n, k), from the curve
        pull = np.exp(norm.logpdf(eta) - log_ndtr(eta) - log_ndtr(-eta))
        lack = _lack_of_fit(off, terms, weight, pull, covariance)
        scores = off @ (pull[:, None] * terms)
        size_correction = len(off) / max(1, len(off) - 1)
        covariance = size_correction * covariance @ (scores.T @ scores) @ covariance
    if abs(found.x[1]) < _SLOPE * math.sqrt(covariance[1, 1]):
        return None, "the probability changes with speed by no more than chance would"
    # Back to Phi(a + b ln v).
    back = np.array([[1.0, -center / size], [0.0, 1.0 / size]])
    if draws is not None:
        return LognormalFit(back @ found.x, back @ covariance @ back.T, lack), ""
    freedom = len(speeds) - 2
    with np.errstate(divide="ignore", invalid="ignore"):
        share = events / runs
        full = np.where(events > 0, events * np.log(share), 0.0)
        full += np.where(events < runs, (runs - events) * np.log1p(-share), 0.0)
    deviance = 2.0 * (float(full.sum()) + float(found.fun))
    lack = float(chi2.sf(deviance, freedom)) if freedom else None
    return LognormalFit(back @ found.x, back @ covariance @ back.T, lack), ""


def _lack_of_fit(off: Floats, terms: Floats, weight: Floats, pull: Floats, inverse: Floats) -> float | None:
    """Probability of residuals as great as these, with their covariance from the scatter between draws.

    Parameters
    ----------
    off
        Outcome less the fitted probability, shape (n, k).
    terms, weight, pull
        Of the fit: columns of the predictor (k, 2), information a speed (k,), and the factor from residual to
        score (k,).
    inverse
        Of the information, shape (2, 2).
    """
    from scipy.stats import f as f_distribution

    # Residuals after the fit are those before it, less what the two coefficients have taken.
    left = np.eye(len(pull)) - ((weight / pull)[:, None] * terms) @ inverse @ (terms.T * pull)
    centred = off - off.mean(axis=0)
    spread = left @ (centred.T @ centred) @ left.T
    values, vectors = np.linalg.eigh(spread)
    told = values > 1e-9 * max(values[-1], 1e-300)
    freedom = min(int(told.sum()), len(pull) - 2)
    rest = len(off) - freedom
    if freedom < 1 or rest < 1:
        return None
    shares = (vectors.T @ off.sum(axis=0))[-freedom:]
    # Hotelling: the covariance is itself an estimate.
    squared = float(np.sum(shares**2 / values[-freedom:])) / len(off)
    return float(f_distribution.sf(squared * rest / freedom, freedom, rest))
