"""Profiles: the least cost at each value of one parameter, the others fitted anew."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ..base.arguments import checked
from .evaluator import Channel, Evaluator, NoRunError
from .fit import descend
from .identifiability import Spread
from .problem import Noise

__all__ = ["Profile", "profile"]

Floats = npt.NDArray[np.float64]

# Steps outwards: of the half-width expected, and how far and how often at most.
_STEP = 0.5
_MOST_STEPS = 16
# Share of the bounds for a parameter without an expected half-width, and at most.
_BLIND_STEP = 1.0 / 12.0
# A profile is followed to this multiple of the quantile, for the figure.
_BEYOND = 1.3


@checked
@dataclass(frozen=True, eq=False)
class Profile:
    """Least cost along one parameter.

    Attributes
    ----------
    name : str
        Of the parameter.
    values : ndarray, shape (m,)
        Increasing, the fitted one among them.
    others : ndarray, shape (m, p)
        All parameters at those points.
    rise : ndarray, shape (m,)
        Chi-square above its least value, over the spread's factor.
    threshold : float
        Rise at which the interval ends: the squared quantile.
    lower, upper : float or None
        Ends of the interval (Seber and Wild 1989, section 5.2); ``None`` where the profile stays below
        the threshold up to the bound: it is flat.
    """

    name: str
    values: Floats
    others: Floats
    rise: Floats
    threshold: float
    lower: float | None
    upper: float | None


def profile(
    evaluator: Evaluator,
    noise: Noise,
    best: Floats,
    index: int,
    half_width: float | None,
    spread: Spread,
    max_steps: int,
) -> Profile:
    """Return the profile of parameter number `index` around an optimum.

    The signed root of the rise is nearly a straight line (Bates and Watts, Nonlinear Regression Analysis,
    1988, section 6.1). So a few points and a secant find where it meets the quantile.

    Parameters
    ----------
    best
        Optimum as shares, shape (p,).
    half_width
        Expected, as a share; ``None``: unknown.
    """
    parameters = evaluator.problem.parameters
    label = parameters.labels[index]
    channel = evaluator.channel(f"profile of {label}", noise)
    least = channel.chi_square(best)
    step = _BLIND_STEP if half_width is None else min(max(_STEP * half_width, 1e-6), _BLIND_STEP)
    sides = [_side(channel, best, index, sign * step, least, spread, max_steps) for sign in (-1.0, 1.0)]
    (down, low), (up, high) = sides
    points = [*reversed(down), (best, 0.0), *up]
    points.sort(key=lambda item: float(item[0][index]))
    return Profile(
        label,
        np.array([parameters.parameters[index].from_unit(float(point[index])) for point, _ in points]),
        np.array([parameters.from_unit(point) for point, _ in points]),
        np.array([rise for _, rise in points]),
        spread.quantile**2,
        None if low is None else parameters.parameters[index].from_unit(low),
        None if high is None else parameters.parameters[index].from_unit(high),
    )


def _side(
    channel: Channel,
    best: Floats,
    index: int,
    step: float,
    least: float,
    spread: Spread,
    max_steps: int,
) -> tuple[list[tuple[Floats, float]], float | None]:
    """Points of one side with their rises, and where the root of the rise meets the quantile."""
    bound = 1.0 if step > 0.0 else 0.0
    found: list[tuple[Floats, float]] = []
    before = best
    previous = (float(best[index]), 0.0)
    end = None
    for _ in range(_MOST_STEPS):
        share = previous[0] + step
        reached = (bound - share) * step <= 0.0
        share = bound if reached else share
        # The others go on as they went, which is what a quadratic cost would have them do.
        guess = before + (before - best) * _ratio(share - before[index], before[index] - best[index])
        rise = _rise(channel, guess, index, share, least, spread, max_steps)
        if rise is None:
            break
        found.append(rise)
        before = rise[0]
        root = math.sqrt(max(0.0, rise[1]))
        if end is None and root >= spread.quantile:
            end = previous[0] + (share - previous[0]) * (spread.quantile - previous[1]) / (root - previous[1])
            closer = _rise(channel, before.copy(), index, end, least, spread, max_steps)
            if closer is not None:
                found.append(closer)
                middle = math.sqrt(max(0.0, closer[1]))
                nearer, farther = (
                    (previous, (end, middle)) if middle >= spread.quantile else ((end, middle), (share, root))
                )
                if farther[1] > nearer[1]:
                    end = nearer[0] + (farther[0] - nearer[0]) * (spread.quantile - nearer[1]) / (
                        farther[1] - nearer[1]
                    )
        if reached or root >= _BEYOND * spread.quantile:
            break
        if root - previous[1] < 0.5 * _STEP * spread.quantile:
            step *= 1.6  # flatter than expected
        previous = (share, root)
    return found, end


def _rise(
    channel: Channel, guess: Floats, index: int, share: float, least: float, spread: Spread, max_steps: int
) -> tuple[Floats, float] | None:
    """Fit the others at a share of one parameter; ``None`` where no run succeeds."""
    start = np.clip(guess, 1e-9, 1.0 - 1e-9)
    start[index] = min(1.0, max(0.0, share))
    if channel.computed([start])[0] is None:
        return None
    try:
        point, _ = descend(channel, start, max_steps, fixed=index)
    except NoRunError:
        return None
    return point, (channel.chi_square(point) - least) / spread.factor


def _ratio(a: float, b: float) -> float:
    return a / b if abs(b) > 1e-12 else 0.0
