"""What a sequence of finer and finer answers converges to, and how well that is known.

Answers are f(h) = f* + c h^p at h falling to 0. The order p is the slope of their changes over h on
logarithmic scales. The limit is Richardson's extrapolation f* = f_n + (f_n - f_n-1) / (r^p - 1) with
r = h_n-1 / h_n.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

__all__ = ["Limit", "limit_of", "order_of", "richardson"]

# An answer that changes by less than this share of its scale is converged: rounding of sums over thousands.
_ROUNDING = 1e-12
# Answers are extrapolated where each change is at most this fraction of the one before it. The limit is then
# at most four times the last change away.
_FALLS = 0.8
# What is not extrapolated is uncertain by so many times the range of the last three answers.
_NOISE = 2.0
_LUCK = 0.25
_SLOW = 4.0


class Limit(NamedTuple):
    """Value at h -> 0; the true one lies within ``uncertainty`` of it. ``order`` None: not extrapolated."""

    value: float
    uncertainty: float
    order: float | None


def order_of(h: npt.ArrayLike, changes: npt.ArrayLike) -> float | None:
    """Return the order p of changes ~ h^p, by least squares on logarithmic scales.

    Parameters
    ----------
    h
        Of the coarser answer of each change, shape (n,), any measure of the coarseness.
    changes
        Magnitudes from each answer to the next, shape (n,).

    Returns
    -------
    float or None
        None: fewer than two changes, or one of them is zero.
    """
    found = np.abs(np.asarray(changes, float))
    if len(found) < 2 or not (found > 0.0).all():
        return None
    return float(np.polyfit(np.log(np.asarray(h, float)), np.log(found), 1)[0])


def richardson(coarse: float, fine: float, ratio: float, order: float) -> float:
    """Return the value at h -> 0 from two answers whose h differ by ``ratio`` > 1."""
    return fine + (fine - coarse) / (math.pow(ratio, order) - 1.0)


def limit_of(h: Sequence[float], values: Sequence[float], scale: float) -> Limit:
    """Return what answers converge to, with its uncertainty.

    The limit is extrapolated where the last three changes have one sign and each is at most 0.8 of the one
    before. Two changes do if there are no more. Its uncertainty is the greatest of three: the whole
    correction, the last change, and a quarter of the one before. Noise may make the last change small. Where
    they have one sign but do not fall so, the limit is the last answer. It is uncertain by four times the
    range of the last three, which covers falls to 0.89. Where signs differ, noise is what is left, such as
    where an event falls in a step. The limit then is the last answer, uncertain by twice that range.

    Parameters
    ----------
    h
        Coarseness of each answer, falling, shape (n,), n >= 3: tolerance, step or size of elements.
    values
        The answers, shape (n,).
    scale
        Of the answer, in its unit.

    Raises
    ------
    ValueError
        If there are fewer than three answers, or h does not fall.
    """
    steps, answers = np.asarray(h, float), np.asarray(values, float)
    if len(steps) < 3 or steps.shape != answers.shape:
        raise ValueError(f"a limit needs three answers or more, got {len(answers)} at {len(steps)} of h")
    if not ((steps > 0.0).all() and (np.diff(steps) < 0.0).all()):
        raise ValueError(f"h must be > 0 and fall from answer to answer, got {steps.tolist()}")
    changes = np.diff(answers)[-3:]
    last = float(changes[-1])
    if np.abs(changes[-2:]).max() <= _ROUNDING * scale:
        return Limit(float(answers[-1]), _ROUNDING * scale, None)
    spread = float(np.ptp(answers[-3:]))
    if not (changes * last > 0.0).all():
        return Limit(float(answers[-1]), _NOISE * spread, None)
    if (np.abs(changes[1:]) <= _FALLS * np.abs(changes[:-1])).all():
        order = order_of(steps[-3:-1], changes[-2:])
        if order is not None and order > 0.0:
            value = richardson(float(answers[-2]), float(answers[-1]), float(steps[-2] / steps[-1]), order)
            correction = abs(value - float(answers[-1]))
            lucky = _LUCK * abs(float(changes[-2]))
            return Limit(value, max(correction, abs(last), lucky, _ROUNDING * scale), order)
    return Limit(float(answers[-1]), _SLOW * spread, None)
