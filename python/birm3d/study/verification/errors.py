"""Relative errors of metrics: the scale of each error, and which metrics have none.

An error is |value - converged value| over a scale, max(|converged value|, least). ``least`` keeps the error
finite for metrics that are zero or nearly so, as the yaw of a head-on crash:

=======================================  ============================================================
unit                                     least scale
=======================================  ============================================================
deg                                      5 deg
m/s                                      a tenth of the impact speed, at least 0.1 m/s
m/s^2                                    0.1 g
N                                        0.1 g times the vehicle's mass
N m                                      the same force on an arm of 1 m
m                                        10 mm
s                                        1 ms
J                                        the vehicle's kinetic energy at the least speed above
1 (restitution, overturning ratio)       0.1
=======================================  ============================================================
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping

from ... import units
from ...base.frozen_mapping import FrozenMapping
from ...result.metrics import METRIC_UNITS, METRICS
from ...scene.scene import Scene

__all__ = ["BALANCES", "BOOKKEEPING", "compared_metrics", "least_scales", "relative_errors"]

BOOKKEEPING = frozenset(name for name, metric in METRICS.items() if metric.error == "effort")
"""Metrics that say how an answer was found, and how long the run went on; they have no error."""

BALANCES = frozenset(name for name, metric in METRICS.items() if metric.error == "balance")
"""Metrics that are errors themselves: their converged value is zero, and they are shown as they are."""


def compared_metrics(metrics: Collection[str]) -> tuple[str, ...]:
    """Return those of the names that have an error, in the order of :data:`birm3d.metrics.METRIC_UNITS`."""
    return tuple(name for name in METRIC_UNITS if name in metrics and name not in BOOKKEEPING | BALANCES)


def least_scales(scene: Scene, given: Mapping[str, float] | None = None) -> Mapping[str, float]:
    """Return the least scale of every metric, in its unit; see the table above.

    Parameters
    ----------
    scene
        Says mass and speed.
    given
        Metric -> least scale to take instead, > 0.

    Raises
    ------
    ValueError
        If a name in ``given`` is no metric that has an error, or its scale is not > 0.
    """
    mass = scene.vehicle.mass
    speed = max(0.1 * scene.impact_speed, 0.1)
    deceleration = 0.1 * units.g
    of_unit = {
        "deg": 5.0,
        "m/s": speed,
        "m/s^2": deceleration,
        "N": mass * deceleration,
        "N m": mass * deceleration,
        "m": 0.01,
        "s": 1e-3,
        "J": 0.5 * mass * speed**2,
        "": 0.1,
    }
    scales = {name: of_unit[METRIC_UNITS[name]] for name in compared_metrics(METRIC_UNITS)}
    for name, scale in (given or {}).items():
        if name not in scales:
            raise ValueError(f"scales must name metrics among {', '.join(scales)}; got {name!r}")
        if not 0.0 < scale < float("inf"):
            raise ValueError(f"scales[{name!r}] must be finite and > 0, got {scale}")
        scales[name] = float(scale)
    return FrozenMapping(scales)


def relative_errors(
    values: Mapping[str, float], converged: Mapping[str, float], least: Mapping[str, float]
) -> dict[str, float]:
    """Return |value - converged| / max(|converged|, least) of every converged metric.

    Parameters
    ----------
    values, converged
        Metric -> value, in its unit. A metric that ``values`` does not have has an infinite error.
    least
        Metric -> least scale; 0 where there is none: then a converged value of 0 leaves the departure itself.
    """
    errors = {}
    for name, expected in converged.items():
        departure = abs(values.get(name, math.inf) - expected)
        scale = max(abs(expected), least.get(name, 0.0))
        errors[name] = departure / scale if scale > 0.0 else departure
    return errors
