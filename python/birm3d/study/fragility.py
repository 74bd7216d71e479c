"""Fragility curves: the probability of an event against the impact speed, with bands."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .. import pictures
from ..base.arguments import checked
from ..base.intervals import wilson
from ..result.event import HELD
from ..result.metrics import METRIC_UNITS
from ..simulation.simulation import Simulation
from ..unit_check import warn_if_any_unusual
from ..units import Quantity, si
from .distributions import check_count, check_distributions, check_seed, sample
from .lognormal_fit import Draws, LognormalFit, fit_lognormal
from .runner import run_study
from .table import Study

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

__all__ = ["Fragility", "fragility"]

Floats = npt.NDArray[np.float64]


@checked
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
        return pictures.plot_fragility(self)

    def _repr_html_(self) -> str:
        return pictures.text_html(repr(self), self.plot(), "fragility curve")

    def __repr__(self) -> str:
        if self.fit is None:
            curve = f"no fit: {self.no_fit}"
        else:
            error, _ = self.fit.standard_errors
            curve = f"probability 1/2 at {self.fit.median:.4g} ± {error:.2g} m/s"
        return f"Fragility({self.event}; {len(self.speeds)} speeds, {self.runs.sum()} runs; {curve})"


@checked
def fragility(
    simulation: Simulation,
    speeds: Iterable[Quantity],
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

    A run *stops* if the barrier contains the vehicle: its outcome (:mod:`birm3d.result.event`) is ``stopped``
    or ``redirected``. ``rolled_over`` counts if the motion towards the barrier ended (the run has
    ``time_of_zero_velocity``). Give a limit to ``vehicle_penetration`` to ask how far it got.

    Parameters
    ----------
    simulation
        The scene to vary.
    speeds
        Impact speeds [m/s], or text as ``"30 mph"``; two or more, > 0, increasing.
    distributions
        Parameter -> frozen distribution of :mod:`scipy.stats`; not ``impact_speed``.
    n
        Runs for each speed, >= 1. Run i of every speed has the same draw (common random numbers), so that
        differences between speeds are the speeds', not those of the draws. The errors of the fit count draws
        as independent, not runs. A greater n keeps the earlier runs.
    seed
        Integer >= 0.
    exceeds
        Metric -> limit [SI, deg]: count the runs in which any of these metrics is above its limit. ``None``:
        count the runs that stop.
    confidence
        Level of intervals and bands, 0 to 1.
    executor, store, progress
        See :func:`birm3d.study.runner.run_study`.

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
    check_count("n", n, each=len(listed))
    check_seed(seed)
    if not 0.0 < confidence < 1.0:
        raise ValueError(f"confidence must be between 0 and 1, got {confidence}")
    if "impact_speed" in distributions:
        raise ValueError("distributions must leave impact_speed to speeds, got it in both")
    check_distributions(simulation, distributions)
    metrics = _limits(exceeds)
    # All speeds of the first draw, then of the second: with a greater n the earlier runs come first.
    rows = [(speed, *draw) for draw in sample(distributions, n, seed).tolist() for speed in listed]
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
    happened = happened.reshape(n, len(listed)) & valid
    events = happened.sum(axis=0)
    limits = [wilson(k / of, of, confidence) for k, of in zip(events.tolist(), runs.tolist(), strict=True)]
    low, high = np.array(limits).T
    fit, no_fit = fit_lognormal(np.array(listed), events, runs, Draws(happened, valid))
    if exceeds is None:
        event = "stopped"
    else:
        event = " or ".join(
            f"{name} > {limit:g} {METRIC_UNITS[name]}".rstrip() for name, limit in exceeds.items()
        )
    return Fragility(event, np.array(listed), events, runs, low, high, confidence, fit, no_fit, study)


def _speeds(speeds: Iterable[Quantity]) -> list[float]:
    stated = list(speeds)
    listed = [si("speeds", speed, "speed") for speed in stated]
    warn_if_any_unusual("impact_speed", stated)
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
    outcome = study["outcome"]
    turned = np.isfinite(study.metrics["time_of_zero_velocity"])
    held = np.isin(outcome, HELD) & (turned | (outcome != "rolled_over"))
    return np.asarray(held, bool)


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
