"""How far a computed curve is from a measured one, in numbers.

All functions take curves at the same instants; :func:`birm3d.compare_curves` brings them there.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

__all__ = ["Residuals", "SpragueGeers", "residuals", "sprague_geers"]

Floats = npt.NDArray[np.float64]


class SpragueGeers(NamedTuple):
    """Magnitude, phase and comprehensive error; 0 for equal curves, 1 is 100 %."""

    magnitude: float
    phase: float
    comprehensive: float


class Residuals(NamedTuple):
    """Mean and standard deviation of measured less computed, over the measured peak."""

    mean: float
    deviation: float


def sprague_geers(time: npt.ArrayLike, measured: npt.ArrayLike, computed: npt.ArrayLike) -> SpragueGeers:
    r"""Return the error measures of Sprague and Geers.

    With the integrals over the record by the trapezoid rule,

    .. math:: M = \sqrt{\int c^2 / \int m^2} - 1,\quad
              P = \frac{1}{\pi} \arccos \frac{\int m c}{\sqrt{\int m^2 \int c^2}},\quad C = \sqrt{M^2 + P^2}.

    M is blind to a shift in time, P to a factor. A sine of amplitude a times the measured one has M = a - 1;
    one that lags by the angle φ has P = φ/π over whole periods.

    M. A. Sprague, T. L. Geers, A spectral-element method for modelling cavitation in transient
    fluid-structure interaction, Int. J. Numer. Meth. Engng 60 (2004) 2467-2499; the measures that NCHRP
    Web-Only Document 179 uses.

    Parameters
    ----------
    time
        Shape (n,), strictly increasing [s].
    measured, computed
        Shape (n,), one unit.

    Raises
    ------
    ValueError
        If the arrays differ in shape or are not finite, the time does not increase, or a curve is zero
        throughout: it then has neither magnitude nor phase.
    """
    t, m, c = _curves(time, measured, computed)
    # Scaled, so that squares of large forces or small strains neither overflow nor vanish.
    m_peak, c_peak = np.abs(m).max(), np.abs(c).max()
    for name, peak in (("measured", m_peak), ("computed", c_peak)):
        if not peak > 0.0:
            raise ValueError(f"{name} must not be zero throughout, got a peak of {peak:g}")
    m, c = m / m_peak, c / c_peak
    mm, cc = _integral(m * m, t), _integral(c * c, t)
    magnitude = math.sqrt(cc / mm) * float(c_peak / m_peak) - 1.0
    # The angle between two unit vectors from their difference and sum: arccos of their product loses half of
    # the digits near equality.
    m, c = m / math.sqrt(mm), c / math.sqrt(cc)
    angle = 2.0 * math.atan2(math.sqrt(_integral((m - c) ** 2, t)), math.sqrt(_integral((m + c) ** 2, t)))
    phase = angle / math.pi
    return SpragueGeers(magnitude, phase, math.hypot(magnitude, phase))


def _integral(values: Floats, time: Floats) -> float:
    return float(np.sum(0.5 * (values[1:] + values[:-1]) * np.diff(time)))


def residuals(measured: npt.ArrayLike, computed: npt.ArrayLike) -> Residuals:
    """Return mean and standard deviation of the residuals over the measured peak.

    The analysis of variance of M. H. Ray as NCHRP Web-Only Document 179 (2010) uses it. A residual is
    measured less computed, divided by the greatest magnitude of the measured curve; the deviation is with
    n - 1. Limits there: 5 % of the peak for the mean, 35 % for the deviation. Source: Repeatability of
    full-scale crash tests and criteria for validating simulation results, Transportation Research Record
    1528, 1996.

    Parameters
    ----------
    measured, computed
        Shape (n,), n > 1, one unit, evenly spaced in time.

    Raises
    ------
    ValueError
        If the arrays differ in shape or are not finite, or the measured curve is zero throughout.
    """
    m = np.asarray(measured, float)
    _, m, c = _curves(np.arange(m.size), m, computed)
    peak = float(np.abs(m).max())
    if not peak > 0.0:
        raise ValueError(f"measured must not be zero throughout, got a peak of {peak:g}")
    relative = (m - c) / peak
    return Residuals(float(relative.mean()), float(relative.std(ddof=1)))


def _curves(
    time: npt.ArrayLike, measured: npt.ArrayLike, computed: npt.ArrayLike
) -> tuple[Floats, Floats, Floats]:
    t, m, c = (np.asarray(array, float) for array in (time, measured, computed))
    if m.ndim != 1 or len(m) < 2:
        raise ValueError(f"measured must have the shape (n,) with n > 1, got {m.shape}")
    for name, array in (("time", t), ("measured", m), ("computed", c)):
        if array.shape != m.shape:
            raise ValueError(f"{name} must have the shape {m.shape} of measured, got {array.shape}")
        if not np.isfinite(array).all():
            raise ValueError(f"{name} must be finite, got {array[~np.isfinite(array)][0]}")
    if not (np.diff(t) > 0.0).all():
        raise ValueError(f"time must be strictly increasing, got a step of {np.diff(t).min():g} s")
    return t, m, c
