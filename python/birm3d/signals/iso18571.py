"""Objective rating of a computed curve against a measured one, after ISO/TS 18571.

ISO/TS 18571:2024, Road vehicles - Objective rating metric for non-ambiguous signals, is sold and was not at
hand. The definition followed is that of the public implementation of the Vehicle Safety Institute of TU Graz
(objective-rating-metrics 1.3); the tests hold scores that it gives for analytic curves. A second one
(iso18571, the same formulas) is tested by its authors against the curves in the standard's annex. Neither is
used itself: the first brings a compiler (numba, through dtwalign) and half a dozen packages that it never
imports, the second has no wheels below Python 3.12.

The curves are sampled at 10 kHz, as the standard has it: the slope score depends on it.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

__all__ = ["INTERVAL", "ObjectiveRating", "objective_rating"]

Floats = npt.NDArray[np.float64]

INTERVAL = 1e-4
"""Sampling interval that the rating is defined for [s]."""

# Half widths of the inner and outer corridor over the measured peak, and the power between them.
_INNER, _OUTER, _CORRIDOR_POWER = 0.05, 0.5, 2
# Longest shift over the length of the record, at which the phase score is 0.
_SHIFT = 0.2
# Band of the warping over the length, and the error of magnitude at which its score is 0.
_BAND, _MAGNITUDE = 0.1, 0.5
# Rows of the running mean of the slope, and the error of slope at which its score is 0.
_ROWS, _SLOPE = 9, 2.0
_WEIGHTS = {"corridor": 0.4, "phase": 0.2, "magnitude": 0.2, "slope": 0.2}
_GRADES = ((0.94, "excellent"), (0.80, "good"), (0.58, "fair"))


class ObjectiveRating(NamedTuple):
    """Scores from 0 to 1 (equal curves)."""

    corridor: float
    phase: float
    magnitude: float
    slope: float
    shift: float
    """By which the computed curve is late [s]; the phase score is of its magnitude."""

    @property
    def overall(self) -> float:
        """The four scores, weighted 0.4, 0.2, 0.2, 0.2."""
        return sum(weight * float(getattr(self, name)) for name, weight in _WEIGHTS.items())

    @property
    def grade(self) -> str:
        """``"excellent"`` (overall above 0.94), ``"good"`` (0.80), ``"fair"`` (0.58) or ``"poor"``."""
        return next((grade for limit, grade in _GRADES if self.overall > limit), "poor")


def objective_rating(measured: npt.ArrayLike, computed: npt.ArrayLike) -> ObjectiveRating:
    """Return the rating of ISO/TS 18571.

    Parameters
    ----------
    measured, computed
        Shape (n,), n > 9, one unit, at the same instants, 0.1 ms apart.

    Raises
    ------
    ValueError
        If the arrays differ in shape, are too short or not finite, or a curve does not change at all: it has
        no correlation with anything.
    """
    m, c = np.asarray(measured, float), np.asarray(computed, float)
    if m.ndim != 1 or len(m) <= _ROWS:
        raise ValueError(f"measured must have the shape (n,) with n > {_ROWS}, got {m.shape}")
    for name, array in (("measured", m), ("computed", c)):
        if array.shape != m.shape:
            raise ValueError(f"{name} must have the shape {m.shape} of measured, got {array.shape}")
        if not np.isfinite(array).all():
            raise ValueError(f"{name} must be finite, got {array[~np.isfinite(array)][0]}")
        if not np.ptp(array) > 0.0:
            raise ValueError(f"{name} must change over the record, got {array[0]:g} throughout")
    shift = _best_shift(m, c)
    size = len(m) - abs(shift)
    measured_part = m[max(0, -shift) :][:size]
    computed_part = c[max(0, shift) :][:size]
    return ObjectiveRating(
        corridor=_corridor(m, c),
        phase=max(0.0, 1.0 - abs(shift) / (_SHIFT * len(m))),
        magnitude=_magnitude(measured_part, computed_part),
        slope=_slope(measured_part, computed_part),
        shift=shift * INTERVAL,
    )


def _corridor(m: Floats, c: Floats) -> float:
    """Mean score of the rows: 1 within the inner corridor about m, 0 outside of the outer one."""
    away = np.abs(m - c) / np.abs(m).max()
    score = np.clip((_OUTER - away) / (_OUTER - _INNER), 0.0, 1.0)
    return float(np.mean(score**_CORRIDOR_POWER))


def _best_shift(m: Floats, c: Floats) -> int:
    """Rows by which c is late, at the greatest correlation; of equal ones the shortest, late first."""
    best, found = _correlation(m, c), 0
    for rows in range(1, math.floor(_SHIFT * len(m)) + 1):
        for shift, late, early in ((rows, c, m), (-rows, m, c)):
            correlation = _correlation(late[rows:], early[:-rows])
            # A periodic curve fits again after each period, but for rounding.
            if correlation > best + 1e-12:
                best, found = correlation, shift
    return found


def _correlation(a: Floats, b: Floats) -> float:
    da, db = a - a.mean(), b - b.mean()
    norm = math.sqrt(float(da @ da) * float(db @ db))
    # A part that does not change has no correlation; such a shift is never the best.
    return float(da @ db) / norm if norm > 0.0 else -1.0


def _magnitude(m: Floats, c: Floats) -> float:
    """Score of what is left between the curves after warping one onto the other."""
    i, j = warping_path(c, m, max(1, math.ceil(_BAND * len(m))))
    error = float(np.abs(c[i] - m[j]).sum() / np.abs(m[j]).sum())
    return max(0.0, 1.0 - error / _MAGNITUDE)


def _slope(m: Floats, c: Floats) -> float:
    """Score of the differences of the smoothed slopes."""
    slope_m, slope_c = (_running_mean(np.gradient(y, INTERVAL)) for y in (m, c))
    error = float(np.abs(slope_c - slope_m).sum() / np.abs(slope_m).sum())
    return max(0.0, 1.0 - error / _SLOPE)


def _running_mean(y: Floats) -> Floats:
    """Centred mean over nine rows; towards the ends over as many as there are on both sides."""
    total = np.concatenate([[0.0], np.cumsum(y)])
    row = np.arange(len(y))
    half = np.minimum(np.minimum(row, len(y) - 1 - row), _ROWS // 2)
    mean: Floats = (total[row + half + 1] - total[row - half]) / (2 * half + 1)
    return mean


def warping_path(x: Floats, y: Floats, band: int) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]:
    """Return the path of least sum of squared differences that warps x onto y, |i - j| < band.

    Dynamic time warping with the steps (1, 0), (0, 1), (1, 1) of equal weight, preferred in this order where
    they cost the same. Row i and column j of the cost table meet in diagonals i + j, each of which follows
    from the two before it, all of its cells at once.

    Parameters
    ----------
    x, y
        Shape (n,).
    band
        At least 1: of the table only |i - j| < band is used.

    Returns
    -------
    i, j
        Shape (k,), rows of x and of y along the path, from (0, 0) to (n - 1, n - 1).
    """
    n = len(x)
    # cost[i + 1] of the last two diagonals; what is outside of the band stays infinite.
    last, before = np.full(n + 1, np.inf), np.full(n + 1, np.inf)
    steps: list[tuple[int, npt.NDArray[np.uint8]]] = []
    for s in range(2 * n - 1):
        low = max(0, s - n + 1, (s - band) // 2 + 1)
        high = min(n - 1, s, (s + band - 1) // 2)
        cost = np.full(n + 1, np.inf)
        here = slice(low + 1, high + 2)
        if s == 0:
            cost[1] = (x[0] - y[0]) ** 2
            steps.append((0, np.zeros(1, np.uint8)))
        else:
            costs = np.stack([last[low : high + 1], last[here], before[low : high + 1]])
            step = costs.argmin(axis=0)
            i = np.arange(low, high + 1)
            cost[here] = costs[step, np.arange(len(i))] + (x[i] - y[s - i]) ** 2
            steps.append((low, step.astype(np.uint8)))
        last, before = cost, last
    row, column = n - 1, n - 1
    path = [(row, column)]
    while row > 0 or column > 0:
        low, step = steps[row + column]
        kind = int(step[row - low])
        row, column = row - (kind != 1), column - (kind != 0)
        path.append((row, column))
    rows, columns = np.array(path[::-1]).T
    return rows, columns
