"""Fragility curves: the probability of an event against the impact speed, with bands."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .distributions import check_count, check_distributions, check_seed, sample
from .metrics import METRIC_UNITS
from .runs import run_study
from .simulation import Simulation
from .study import Study

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

__all__ = ["Fragility", "LognormalFit", "fragility"]

Floats = npt.NDArray[np.float64]


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
        Of Phi(a + b ln v), from the expected information.
    lack_of_fit : float or None
        Probability of a deviance as great as this one if the curve is right (chi squared); ``None`` for two
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


@dataclass(frozen=True, eq=False)
class Fragility:
    """Probability of an event against the impact speed.

    Attributes
    ----------
    event : str
        What was counted.
    speeds, probability, low, high : ndarray, shape (k,)
        Speeds [m/s], counted shares, and Wilson's interval (1927) of each.
    events, runs : ndarray of int, shape (k,)
        Runs with the event, and runs that did not fail.
    confidence : float
        Level of intervals and bands.
    fit : LognormalFit or None
    no_fit : str
        Why there is no fit; empty if there is one.
    study : Study
        All runs.
    """

    event: str
    speeds: Floats
    events: npt.NDArray[np.int64]
    runs: npt.NDArray[np.int64]
    low: Floats
    high: Floats
    confidence: float
    fit: LognormalFit | None
    no_fit: str
    study: Study

    @property
    def probability(self) -> Floats:
        """Counted share of the runs with the event, shape (k,)."""
        return np.asarray(self.events / self.runs)

    def to_dataframe(self) -> pd.DataFrame:
        """Return a table, one row a speed: events, runs, probability, limits, and the fit if there is one."""
        try:
            import pandas as pd
        except ImportError as error:
            raise ImportError("to_dataframe() needs pandas: pip install 'birm3d[table]'") from error
        columns: dict[str, Any] = {name: getattr(self, name) for name in ("events", "runs", "probability")}
        columns.update(low=self.low, high=self.high)
        if self.fit is not None:
            columns["fit"] = self.fit.probability(self.speeds)
            columns["fit_low"], columns["fit_high"] = self.fit.band(self.speeds, self.confidence)
        return pd.DataFrame(columns, index=pd.Index(self.speeds, name="impact_speed"))

    def plot(self) -> Figure:
        """Return a figure of counted probabilities with their intervals, and the fit with its band."""
        from .study_plots import plot_fragility

        return plot_fragility(self)

    def __repr__(self) -> str:
        if self.fit is None:
            curve = f"no fit: {self.no_fit}"
        else:
            error, _ = self.fit.standard_errors
            curve = f"probability 1/2 at {self.fit.median:.4g} ± {error:.2g} m/s"
        return f"Fragility({self.event}; {len(self.speeds)} speeds, {self.runs.sum()} runs; {curve})"


def fragility(
    simulation: Simulation,
    speeds: Iterable[float],
    distributions: Mapping[str, Any],
    n: int,
    seed: int = 0,
    *,
    exceeds: Mapping[str, float] | None = None,
    confidence: float = 0.95,
    executor: Any = None,
    store: str | Path | None = None,
    progress: bool | None = None,
) -> Fragility:
    """Return the probability of stopping, or of exceeding limits, against the impact speed.

    A run *stops* if the vehicle's motion towards the barrier has come to an end (the velocity of its mass
    centre along the inward normal of the face has passed zero: the run has ``time_of_zero_velocity``) and the
    outcome is decided (``end_reason`` is ``separated`` or ``stopped``, not ``duration`` or ``longest``). Give
    a limit to ``vehicle_penetration`` to ask how far it got.

    Parameters
    ----------
    simulation
        The scene to vary.
    speeds
        Impact speeds [m/s], two or more, > 0, increasing.
    distributions
        Parameter -> frozen distribution of :mod:`scipy.stats`; not ``impact_speed``.
    n
        Runs for each speed, >= 1; drawn anew for every speed, so that counts are independent. A greater n
        keeps the earlier runs.
    seed
        Integer >= 0.
    exceeds
        Metric -> limit [SI, deg]: count the runs in which any of these metrics is above its limit. ``None``:
        count the runs that stop.
    confidence
        Level of intervals and bands, 0 to 1.
    executor, store, progress
        See :func:`birm3d.runs.run_study`.

    Returns
    -------
    Fragility
        Failed runs are left out of the counts; they are in ``study.failed``.

    Raises
    ------
    ValueError
        Naming the argument, its limit and the value; if a run lacks a metric of `exceeds`, or if all runs of
        a speed failed.
    """
    listed = _speeds(speeds)
    check_count("n", n)
    check_seed(seed)
    if not 0.0 < confidence < 1.0:
        raise ValueError(f"confidence must be between 0 and 1, got {confidence}")
    if "impact_speed" in distributions:
        raise ValueError("distributions must leave impact_speed to speeds, got it in both")
    check_distributions(simulation, distributions)
    metrics = _limits(exceeds)
    drawn = [sample(distributions, n, seed, stream=f"@{speed!r}").tolist() for speed in listed]
    # All speeds of the first draw, then of the second: with a greater n the earlier runs come first.
    rows = [(speed, *drawn[j][i]) for i in range(n) for j, speed in enumerate(listed)]
    study = run_study(
        simulation,
        ("impact_speed", *distributions),
        rows,
        metrics=metrics,
        executor=executor,
        store=store,
        progress=progress,
        title="fragility",
    )
    happened = _stopped(study) if exceeds is None else _exceeded(study, exceeds)
    valid = np.array([not error for error in study.error]).reshape(n, len(listed))
    runs = valid.sum(axis=0)
    if not runs.all():
        speed = listed[int(np.argmin(runs))]
        reason = next(iter(study.failed.values()))
        raise ValueError(f"speeds must have runs that succeed, but all {n} at {speed:g} m/s failed: {reason}")
    events = (happened.reshape(n, len(listed)) & valid).sum(axis=0)
    low, high = _wilson(events, runs, confidence)
    fit, no_fit = _fit(np.array(listed), events, runs)
    if exceeds is None:
        event = "stopped"
    else:
        event = " or ".join(
            f"{name} > {limit:g} {METRIC_UNITS[name]}".rstrip() for name, limit in exceeds.items()
        )
    return Fragility(event, np.array(listed), events, runs, low, high, confidence, fit, no_fit, study)


def _speeds(speeds: Iterable[float]) -> list[float]:
    listed = [float(speed) for speed in speeds]
    if len(listed) < 2:
        raise ValueError(f"speeds must have at least two values, got {listed}")
    for before, speed in zip([0.0, *listed], listed, strict=False):
        if not before < speed < math.inf:
            raise ValueError(f"speeds must be > 0, finite and increasing, got {listed}")
    return listed


def _limits(exceeds: Mapping[str, float] | None) -> Sequence[str]:
    """Metrics that the event needs."""
    if exceeds is None:
        return ("time_of_zero_velocity", "end_time")
    for name, limit in exceeds.items():
        if not math.isfinite(limit):
            raise ValueError(f"exceeds[{name!r}] must be finite, got {limit}")
    return tuple(exceeds)


def _stopped(study: Study) -> npt.NDArray[np.bool_]:
    decided = np.isin(study.end_reason, ("separated", "stopped"))
    return np.asarray(decided & np.isfinite(study.metrics["time_of_zero_velocity"]))


def _exceeded(study: Study, exceeds: Mapping[str, float]) -> npt.NDArray[np.bool_]:
    happened = np.zeros(len(study), bool)
    succeeded = np.array([not error for error in study.error])
    for name, limit in exceeds.items():
        values = study.metrics[name]
        missing = int((np.isnan(values) & succeeded).sum())
        if missing:
            raise ValueError(
                f"exceeds must name metrics that all runs have, got {name!r}: {missing} runs lack it"
            )
        happened |= values > limit
    return happened


def _wilson(events: Any, runs: Any, confidence: float) -> tuple[Floats, Floats]:
    from scipy.stats import binomtest

    limits = [
        binomtest(int(k), int(n)).proportion_ci(confidence, method="wilson")
        for k, n in zip(events, runs, strict=True)
    ]
    return np.array([limit.low for limit in limits]), np.array([limit.high for limit in limits])


def _fit(speeds: Floats, events: Any, runs: Any) -> tuple[LognormalFit | None, str]:
    """Fit Phi(a + b ln v); without overlap of the two outcomes the likelihood has no maximum.

    Silvapulle (1981): in one variable there is one if and only if the ranges of the speeds with and without
    the event overlap in more than a point.
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
    # Back to Phi(a + b ln v).
    back = np.array([[1.0, -center / size], [0.0, 1.0 / size]])
    freedom = len(speeds) - 2
    with np.errstate(divide="ignore", invalid="ignore"):
        share = events / runs
        full = np.where(events > 0, events * np.log(share), 0.0)
        full += np.where(events < runs, (runs - events) * np.log1p(-share), 0.0)
    deviance = 2.0 * (float(full.sum()) + float(found.fun))
    lack = float(chi2.sf(deviance, freedom)) if freedom else None
    return LognormalFit(back @ found.x, back @ covariance @ back.T, lack), ""
