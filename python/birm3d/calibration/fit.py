"""Searching: least squares from several starts, and a global search before it."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from .errors import CalibrationError
from .evaluator import Channel, Evaluator, NoRunError
from .problem import Noise, Problem

__all__ = ["Descent", "Search", "search"]

Floats = npt.NDArray[np.float64]

# Cost of a failed run for the global search, above that of any run that succeeds.
_FAILED = 1e30
# The noise model counts as settled when no number of it moves by more.
_SETTLED = 0.02
_MOST_ROUNDS = 6
# Runs of the global search for each parameter and generation, and its most generations.
_POPULATION = 10
_GENERATIONS = 40
# Least distance of a start from its bounds, as a share of the way between them.
_INSIDE = 1e-9


@dataclass
class Descent:
    """One start and where it ended.

    Attributes
    ----------
    start, end : ndarray, shape (p,)
        As shares of the way between the bounds.
    chi_square : float or None
        At the end; ``None`` where no run succeeded.
    message : str
        Of the optimiser, or why it failed.
    """

    channel: Channel
    start: Floats
    end: Floats
    chi_square: float | None = None
    message: str = ""


@dataclass
class Search:
    """What a search found: the best descent, all of them, and the noise they were weighed with."""

    best: Descent
    descents: list[Descent]
    noise: Noise


def search(evaluator: Evaluator, *, method: str, starts: int, seed: int, max_steps: int) -> Search:
    """Find the least sum of squares.

    Raises
    ------
    CalibrationError
        If no run succeeds, or the executor fails.
    """
    problem = evaluator.problem
    noise = problem.noise()
    points = [problem.parameters.to_unit(problem.parameters.start)]
    if method == "global":
        points.append(_global(evaluator, noise, seed))
    while len(points) < starts:
        points.append(start_point(seed, len(points), len(points[0])))
    descents = [
        Descent(evaluator.channel(f"start {i}", noise), point, point.copy()) for i, point in enumerate(points)
    ]
    _in_threads([_descending(descent, max_steps) for descent in descents], evaluator)
    best = _best(descents)
    for _ in range(_MOST_ROUNDS if problem.settles else 0):
        settled = _reweigh(problem, best, descents)
        _in_threads([_descending(d, max_steps) for d in descents if d.chi_square is not None], evaluator)
        best = _best(descents)
        if settled:
            break
    return Search(best, descents, best.channel.noise)


def start_point(seed: int, index: int, size: int) -> Floats:
    """Return start number `index` as shares, shape (size,): it depends on seed and index only."""
    generator = np.random.Generator(np.random.Philox(key=[seed, index]))
    point: Floats = generator.uniform(0.02, 0.98, size)
    return point


def descend(channel: Channel, start: Floats, max_steps: int, fixed: int | None = None) -> tuple[Floats, str]:
    """Least squares from a start strictly within the bounds, by a trust region (Branch, Coleman and Li 1999).

    Parameters
    ----------
    fixed
        Number of a parameter that stays where it is, for profiles.

    Returns
    -------
    tuple of ndarray and str
        The end, shape (p,), and the optimiser's message.
    """
    from scipy.optimize import (
        least_squares,
    )  # imported when used: it takes longer to load than a crash to run

    free = np.arange(len(start)) != (-1 if fixed is None else fixed)
    if not free.any():
        return start.copy(), "nothing to vary"

    def whole(x: Floats) -> Floats:
        point = start.copy()
        point[free] = x
        return point

    fit: Any = least_squares(
        lambda x: channel.residuals(whole(x)),
        start[free],
        jac=lambda x: channel.jacobian(whole(x))[:, free],
        bounds=(0.0, 1.0),
        x_scale="jac",
        # Far below what an interval can show; far above the noise of step control.
        xtol=1e-6,
        ftol=1e-6,
        gtol=1e-12,
        max_nfev=max_steps,
    )
    return whole(fit.x), str(fit.message)


def _descending(descent: Descent, max_steps: int) -> Callable[[], None]:
    def work() -> None:
        channel = descent.channel
        # Strictly inside, as the trust region asks for.
        descent.end = np.clip(descent.end, _INSIDE, 1.0 - _INSIDE)
        if channel.computed([descent.end])[0] is None:
            descent.message = f"the first run failed: {channel.failure(descent.end)}"
            return
        try:
            descent.end, descent.message = descend(channel, descent.end, max_steps)
        except NoRunError as error:
            descent.chi_square, descent.message = None, str(error)
            return
        descent.chi_square = channel.chi_square(descent.end)

    return work


def _in_threads(work: list[Callable[[], None]], evaluator: Evaluator) -> None:
    """Do pieces of work side by side; they only wait for the executor, so that threads cost nothing."""
    with ThreadPoolExecutor(max_workers=len(work)) as threads:
        futures = [threads.submit(piece) for piece in work]
        try:
            for future in futures:
                future.result()
        except BaseException:
            evaluator.stop()
            raise


def _best(descents: list[Descent]) -> Descent:
    done = [descent for descent in descents if descent.chi_square is not None]
    if not done:
        reasons = "; ".join(dict.fromkeys(descent.message for descent in descents))
        raise CalibrationError(f"no run succeeded from any of {len(descents)} starts: {reasons}")
    return min(done, key=lambda descent: descent.chi_square or 0.0)


def _reweigh(problem: Problem, best: Descent, descents: list[Descent]) -> bool:
    """Give all descents the noise that the best one leaves; return whether it had settled."""
    computed = best.channel.computed([best.end])[0]
    assert computed is not None  # the best one has succeeded
    noise = problem.noise(computed - problem.measured, free=len(problem.parameters))
    before = best.channel.noise.weights
    settled = bool((np.abs(noise.weights - before) <= _SETTLED * before).all())
    for descent in descents:
        descent.channel.noise = noise
    return settled


def _global(evaluator: Evaluator, noise: Noise, seed: int) -> Floats:
    """Return the best point of a differential evolution (Storn and Price 1997) over the bounds."""
    from scipy.optimize import differential_evolution

    channel = evaluator.channel("global", noise)
    size = len(evaluator.problem.parameters)

    def costs(points: Floats) -> Floats:
        columns = points.reshape(size, -1).T
        channel.computed([np.ascontiguousarray(column) for column in columns])
        values = [channel.chi_square(np.ascontiguousarray(column)) for column in columns]
        return np.array([min(value, _FAILED) for value in values])

    found: Any = differential_evolution(
        costs,
        [(0.0, 1.0)] * size,
        popsize=_POPULATION,
        maxiter=_GENERATIONS,
        tol=1e-3,
        polish=False,
        init="latinhypercube",
        seed=np.random.Generator(np.random.Philox(key=[seed, 0])),
        vectorized=True,
        updating="deferred",
    )
    return np.asarray(found.x, float)
