"""How far fitted values can be trusted, and which of them the data can not tell."""

# Longer than 300 lines: one analysis, whose parts share its matrices.
from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from ..base.shown_numbers import shown_value
from .fit import Search
from .problem import Problem

__all__ = ["Analysis", "Spread", "analyse"]

Floats = npt.NDArray[np.float64]

# A parameter this near a bound, as a share of the way between the bounds, is held by it.
_AT_BOUND = 1e-3
# Downhill slope of chi-square / 2 over a standard error that counts as pushing against runs that fail.
_PUSH = 0.1
# A derivative that changes by this share with the step of its differences is none.
_ALL_ERROR = 0.5
# Nor is one that is this small beside the greatest, where differences cancel to the last digits.
_ZERO = 1e-9
# An interval that covers so much of the way between the bounds says no more than the bounds.
_AS_WIDE_AS_BOUNDS = 0.8
# Correlation from which a parameter is named beside one that is not identified.
_PARTNER = 0.8
# Share of a direction that nothing resolves above which a parameter belongs to it.
_PART_OF_DIRECTION = 0.1
# Correlation above which two parameters count as poorly separated.
_POORLY_APART = 0.95
# Optima differ if they lie so many standard errors and this share of the bounds apart.
_APART, _APART_SHARE = 3.0, 5e-3
# Chi-square that has to be climbed between two optima for them to be two.
_BARRIER = 4.0
_ALONG = 7


@dataclass(frozen=True)
class Spread:
    """How residuals become intervals.

    Attributes
    ----------
    factor : float
        Multiplies (J^T J)^-1: 1 with the given uncertainties, chi-square / dof with the scatter found.
    quantile : float
        Of Student's t with ``dof`` degrees of freedom, or of the normal distribution.
    dof : float
        Independent points, priors among them, less parameters that were free.
    from_scatter : bool
    """

    factor: float
    quantile: float
    dof: float
    from_scatter: bool


@dataclass
class Analysis:
    """Where the fit stands.

    Attributes
    ----------
    jacobian : ndarray, shape (n, p)
        Of weighted residuals by shares.
    covariance : ndarray, shape (p, p)
        Of the shares; meaningful for parameters without a reason only.
    reasons : dict
        Number of a parameter -> why the data do not tell its value.
    notes : list of str
    doubts : list of str
        Why intervals that are given say less than they seem to.
    condition_number : float or None
        Of the Jacobian by the shares; ``None`` where a column is zero.
    singular_values : ndarray, shape (p,)
    """

    jacobian: Floats
    spread: Spread
    covariance: Floats
    singular_values: Floats
    condition_number: float | None
    reasons: dict[int, str] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    doubts: list[str] = field(default_factory=list)


def analyse(search: Search, *, confidence: float, uncertainty: str, profiled: bool) -> Analysis:
    """Return covariance and verdicts at the best optimum.

    The covariance is s^2 (J^T J)^-1 (Seber and Wild, Nonlinear Regression, 1989, section 5.1) over the
    parameters that the data determine. Left out, each with its reason:

    * insensitive: the column of J is zero, or within the error E of its finite differences, which is known
      from a second J with twice the steps;
    * rank-deficient: with columns scaled to length 1, a right singular vector v has |E v| >= |J v| / 2: what
      it seems to change is error; every parameter with a share in v;
    * at a bound that holds it, or where runs fail that would have a lower cost;
    * practically not identified: the interval covers most of the way between the bounds (Raue et al.,
      Bioinformatics 25, 2009, call it so where a profile has no end);
    * two optima of statistically equal cost with a higher cost between them, or one flat valley.
    """
    best = search.best
    channel, point = best.channel, best.end
    problem = channel.problem
    labels = problem.parameters.labels
    jacobian = channel.jacobian(point)
    residual = channel.residuals(point)
    error = channel.jacobian_change(point)
    lengths = np.linalg.norm(jacobian, axis=0)
    zero = _ZERO * float(np.linalg.norm(channel.noise.weights * problem.measured))
    reasons: dict[int, str] = {}
    notes: list[str] = []

    for k, label in enumerate(labels):
        if lengths[k] <= max(zero, float(np.linalg.norm(error[:, k])) / _ALL_ERROR):
            reasons[k] = f"insensitive: nothing that was measured changes with {label}"
    gradient = jacobian.T @ residual
    for k, parameter in enumerate(problem.parameters.parameters):
        side = _side(point[k], gradient[k])
        if k not in reasons and side is not None:
            bound = parameter.lower if side == "lower" else parameter.upper
            reasons[k] = (
                f"at its {side} bound {shown_value(bound, parameter.unit)}: the data would go on beyond it"
            )

    for k, (step, failure) in channel.blocked(point).items():
        # Downhill past the value, by a tenth of what its own standard error would bring.
        beyond = "above" if step > 0.0 else "below"
        if k not in reasons and -gradient[k] * np.sign(step) > _PUSH * lengths[k]:
            reasons[k] = f"held where runs fail: the data would go on {beyond}, but {failure}"
        elif k not in reasons:
            notes.append(f"runs fail just {beyond} the value of {labels[k]}: {failure}")

    free = np.array([k for k in range(len(labels)) if k not in reasons], int)
    spread = _spread(search, residual, len(free), confidence, uncertainty)
    covariance, unresolved = _covariance(jacobian[:, free], error[:, free], zero)
    for direction in unresolved:
        reason = _combination(problem, point, free, direction)
        for k in free[np.abs(direction) > _PART_OF_DIRECTION * np.abs(direction).max()]:
            reasons.setdefault(int(k), reason)
    whole = np.zeros((len(labels), len(labels)))
    whole[np.ix_(free, free)] = covariance * spread.factor
    singular: Floats = np.asarray(np.linalg.svd(jacobian, compute_uv=False), float)
    sound = lengths.min() > 0.0 and singular[-1] > 0.0
    analysis = Analysis(
        jacobian,
        spread,
        whole,
        singular,
        float(singular[0] / singular[-1]) if sound else None,
        reasons,
        notes,
    )
    if not profiled:  # else the profiles say it better
        _practical(analysis, point, problem, free)
    _other_optima(analysis, search)
    _weak(analysis, problem)
    return analysis


def correlation(covariance: Floats) -> Floats:
    """Return the correlation matrix of a covariance, zero where a variance is."""
    size = np.sqrt(np.diag(covariance))
    scale = np.where(size > 0.0, size, 1.0)
    return np.asarray(covariance / np.outer(scale, scale))


def _side(share: float, gradient: float) -> str | None:
    if share < _AT_BOUND and gradient > 0.0:
        return "lower"
    if share > 1.0 - _AT_BOUND and gradient < 0.0:
        return "upper"
    return None


def _spread(search: Search, residual: Floats, free: int, confidence: float, uncertainty: str) -> Spread:
    from scipy.stats import norm, t

    priors = len(residual) - len(search.best.channel.problem.measured)
    dof = sum(search.noise.points) + priors - free
    normal = Spread(1.0, float(norm.ppf(0.5 + 0.5 * confidence)), dof, False)
    if uncertainty == "given" or dof <= 0.0:
        return normal
    scatter = Spread(float(residual @ residual) / dof, float(t.ppf(0.5 + 0.5 * confidence, dof)), dof, True)
    if uncertainty == "scatter" or scatter.quantile * scatter.factor**0.5 > normal.quantile:
        return scatter
    return normal


def _covariance(jacobian: Floats, error: Floats, zero: float) -> tuple[Floats, list[Floats]]:
    """(J^T J)^-1 over the directions that are resolved, and the others (columns scaled to length 1)."""
    if jacobian.shape[1] == 0:
        return np.zeros((0, 0)), []
    lengths = np.linalg.norm(jacobian, axis=0)
    _, singular, directions = np.linalg.svd(jacobian / lengths, full_matrices=False)
    errors = np.linalg.norm((error / lengths) @ directions.T, axis=0)
    resolved = singular > np.maximum(zero / lengths.max(), errors / _ALL_ERROR)
    kept = directions[resolved] / singular[resolved, None]
    return (kept.T @ kept) / np.outer(lengths, lengths), [
        direction / lengths for direction in directions[~resolved]
    ]


def _combination(problem: Problem, point: Floats, free: npt.NDArray[np.int64], direction: Floats) -> str:
    """Text for a direction of shares that changes nothing; the largest relative change is 1 %."""
    values = problem.parameters.from_unit(point)
    changes = {}
    for k, share in zip(free, direction, strict=True):
        parameter = problem.parameters.parameters[k]
        change = parameter.slope(values[k]) * share
        changes[parameter.label] = change / abs(values[k]) if values[k] != 0.0 else change
    largest = max(changes.items(), key=lambda item: abs(item[1]))[1]
    parts = [
        f"{label} {change / largest:+.2g} %"
        for label, change in changes.items()
        if abs(change) > _PART_OF_DIRECTION * abs(largest)
    ]
    return f"rank-deficient: {', '.join(parts)} together change nothing that was measured"


def _practical(analysis: Analysis, point: Floats, problem: Problem, free: npt.NDArray[np.int64]) -> None:
    half = analysis.spread.quantile * np.sqrt(np.diag(analysis.covariance))
    related = correlation(analysis.covariance)
    for k in free:
        if k in analysis.reasons:
            continue
        label = problem.parameters.labels[k]
        low, high = point[k] - half[k], point[k] + half[k]
        if min(1.0, high) - max(0.0, low) < _AS_WIDE_AS_BOUNDS:
            continue
        partners = [
            f"{problem.parameters.labels[j]} ({related[k, j]:+.2f})"
            for j in free
            if j != k and abs(related[k, j]) > _PARTNER
        ]
        apart = f"; correlated with {', '.join(partners)}" if partners else ""
        analysis.reasons[int(k)] = (
            f"not identified: the data leave {label} as uncertain as its bounds do{apart}"
        )


def _other_optima(analysis: Analysis, search: Search) -> None:
    """Compare the ends of all starts whose cost is statistically that of the best."""
    best = search.best
    assert best.chi_square is not None
    spread = analysis.spread
    problem = best.channel.problem
    errors = np.sqrt(np.diag(analysis.covariance))
    for descent in search.descents:
        if descent is best or descent.chi_square is None:
            continue
        if descent.chi_square - best.chi_square > spread.quantile**2 * spread.factor:
            continue
        chord = descent.end - best.end
        apart = [
            k
            for k in range(len(chord))
            if k not in analysis.reasons and abs(chord[k]) > max(_APART * errors[k], _APART_SHARE)
        ]
        if not apart:
            continue
        between = [
            best.channel.chi_square(best.end + share * chord) for share in np.linspace(0, 1, _ALONG)[1:-1]
        ]
        climbed = max(between) - max(descent.chi_square, best.chi_square)
        here, there = problem.parameters.from_unit(best.end), problem.parameters.from_unit(descent.end)
        for k in apart:
            label = problem.parameters.labels[k]
            unit = problem.parameters.parameters[k].unit
            ends = [shown_value(values[k], unit) for values in (here, there)]
            if climbed > _BARRIER * spread.factor:
                reason = f"two optima of equal cost: {label} = {ends[0]} or {ends[1]}"
            else:
                reason = f"flat valley: {label} = {ends[0]} and {ends[1]} and all between cost the same"
            analysis.reasons[k] = reason


def _weak(analysis: Analysis, problem: Problem) -> None:
    """Doubt pairs that are told apart poorly, and intervals that are the prior's own."""
    labels = problem.parameters.labels
    related = correlation(analysis.covariance)
    told = [k for k in range(len(labels)) if k not in analysis.reasons]
    for i in told:
        for j in told:
            if i < j and abs(related[i, j]) > _POORLY_APART:
                analysis.doubts.append(
                    f"{labels[i]} and {labels[j]} are told apart poorly (correlation {related[i, j]:+.3f})"
                )
    for k in told:
        parameter = problem.parameters.parameters[k]
        if parameter.prior is None:
            continue
        _, slope = parameter.prior_row(0.0)
        if analysis.covariance[k, k] * slope**2 > 0.9 * min(1.0, analysis.spread.factor):
            analysis.doubts.append(f"the interval of {labels[k]} is its prior's: the data add nothing")


def describe(search: Search) -> list[dict[str, Any]]:
    """Return where every start began and ended, as plain data."""
    parameters = search.best.channel.problem.parameters
    return [
        {
            "start": parameters.from_unit(descent.start).tolist(),
            "end": None if descent.chi_square is None else parameters.from_unit(descent.end).tolist(),
            "chi_square": descent.chi_square,
            "message": descent.message,
        }
        for descent in search.descents
    ]
