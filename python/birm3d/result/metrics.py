"""Scalars of a run.

:data:`birm3d.metrics.METRICS` says what they are. Each is made in one place, of the end of the run and of the
extremes that the core finds in its histories. So a run of which no histories are kept has the same scalars,
bit for bit.

Forces and accelerations are taken from the interval means of the result. Filtered values use the channel
frequency class in their name (SAE J211-1). A scalar that a scene does not have (a crush without a barrier, an
exit angle of a vehicle that rests) is absent, never NaN.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from functools import lru_cache
from itertools import repeat
from types import MappingProxyType

from .. import _core
from ..base.arguments import checked
from ..scene.scene import Scene
from .metric_table import METRICS, Metric
from .record import RunRecord
from .run_values import ALONG_LINE, ResultOutcome, RunValues, energy_residual, relative_to_start

__all__ = [
    "ALONG_LINE",
    "METRICS",
    "METRIC_UNITS",
    "compute_metrics",
    "energy_residual",
    "extremes_for",
    "relative_to_start",
    "values_of_outcome",
]

METRIC_UNITS: Mapping[str, str] = MappingProxyType({name: metric.unit for name, metric in METRICS.items()})
"""Every scalar that a run may have -> its unit; "" for a pure number."""

_Function = Callable[[RunValues], float | None]


@checked
def compute_metrics(result: RunRecord, names: Collection[str] | None = None) -> dict[str, float]:
    """Return the scalars of a run, SI units and degrees: all that it has, or those among `names`.

    What each is, :data:`birm3d.metrics.METRICS` says. A run has a metric if it has all that the metric is
    computed from. That may be a barrier, wheels and a ground, two units, free-standing segments, or a
    sampling rate that a filter allows. The values at separation do not depend on the duration, once it is
    long enough.

    A result that was read from a file has the scalars that it was saved with.

    Raises
    ------
    ValueError
        If the run is shorter than the output interval.
    """
    _require_rows(result.scene, len(result.time))
    if not isinstance(result._history, _core.History):
        saved = result.saved_metrics or {}
        return {name: saved[name] for name in saved if names is None or name in names}
    wanted = tuple(METRICS) if names is None else names
    return _found(
        RunValues(result.scene, ResultOutcome(result, result._extremes(extremes_for(wanted)))), wanted
    )


def values_of_outcome(scene: Scene, outcome: _core.Outcome, names: tuple[str, ...]) -> tuple[float, ...]:
    """Return what :func:`compute_metrics` would, of a run without histories with :func:`extremes_for`.

    In the order of the names, and NaN where the run has none.

    Raises
    ------
    ArithmeticError
        If a metric is not a number.
    """
    _require_rows(scene, outcome.extremes.rows)
    found = _found(RunValues(scene, outcome), names)
    if math.isnan(sum(found.values())):  # some value is NaN, or there are both infinities
        for name, value in found.items():
            if math.isnan(value):
                raise ArithmeticError(f"{name} is not a number")
    return tuple(map(found.get, names, repeat(math.nan)))


def extremes_for(names: Collection[str]) -> _core.ExtremeGroups:
    """Return the groups of extremes that metrics are made of."""
    needs = {METRICS[name].needs for name in names} - {"end"}
    return _core.ExtremeGroups(**dict.fromkeys(needs, True))


def _require_rows(scene: Scene, rows: int) -> None:
    if rows < 2:
        interval = scene.settings.output_interval
        raise ValueError(f"output_interval must be shorter than the run for metrics, got {interval} s")


def _found(run: RunValues, names: Collection[str]) -> dict[str, float]:
    found = {}
    for name, value_of in _functions(tuple(names), run.barrier is not None):
        value = value_of(run)
        if value is not None:
            found[name] = value
    return found


@lru_cache(maxsize=16)
def _functions(names: tuple[str, ...], with_barrier: bool) -> tuple[tuple[str, _Function], ...]:
    wanted = ((name, METRICS[name]) for name in names)
    return tuple(
        (name, _guarded(metric)) for name, metric in wanted if with_barrier or metric.of != "barrier"
    )


def _guarded(metric: Metric) -> _Function:
    """Return the function of a metric, ``None`` of a run that can not have it."""
    value = metric.value
    if metric.of in ("run", "barrier"):
        return value
    return lambda run: value(run) if metric.of in run.parts else None
