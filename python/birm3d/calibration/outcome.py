"""From shares of the way between bounds to what a user sees."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from ..base.shown_numbers import shown_value
from .curve_target import CurveTarget
from .evaluator import Evaluator
from .fit import Search
from .fitted import FittedParameter, FittedTarget
from .identifiability import Analysis, correlation, describe
from .parameters import Parameter, ParameterSet
from .profile import Profile
from .quantities import QUANTITIES
from .result import CalibrationResult

__all__ = ["outcome"]

Floats = npt.NDArray[np.float64]


def outcome(
    evaluator: Evaluator,
    found: Search,
    analysis: Analysis,
    profiles: dict[str, Profile],
    notes: list[str],
    confidence: float,
    settings: dict[str, Any],
) -> CalibrationResult:
    """Return values, intervals and reasons in the parameters' own units."""
    problem = evaluator.problem
    parameters = problem.parameters
    values = parameters.from_unit(found.best.end)
    slopes = np.array([p.slope(v) for p, v in zip(parameters.parameters, values.tolist(), strict=True)])
    fitted = _fitted(found, analysis, profiles, parameters, values.tolist(), slopes.tolist())
    doubts = (*analysis.doubts, *_ends_at_bounds(fitted))
    told = [k for k in range(len(parameters)) if k not in analysis.reasons]
    covariance = (analysis.covariance * np.outer(slopes, slopes))[np.ix_(told, told)]
    return CalibrationResult(
        parameters=tuple(fitted),
        targets=_targets(found),
        chi_square=float(found.best.chi_square or 0.0),
        spread=analysis.spread,
        confidence=confidence,
        covariance=covariance,
        correlation=correlation(covariance),
        condition_number=analysis.condition_number,
        notes=(*notes, *analysis.notes, *doubts),
        doubts=doubts,
        starts=tuple(describe(found)),
        history=evaluator.history,
        settings=settings,
        profiles=profiles,
        _problem=problem,
        _noise=found.noise,
    )


def _fitted(
    found: Search,
    analysis: Analysis,
    profiles: dict[str, Profile],
    parameters: ParameterSet,
    values: list[float],
    slopes: list[float],
) -> list[FittedParameter]:
    fitted = []
    for k, (parameter, value) in enumerate(zip(parameters.parameters, values, strict=True)):
        error = interval = None
        if k not in analysis.reasons:
            share_error = math.sqrt(analysis.covariance[k, k])
            error = share_error * slopes[k]
            interval = _interval(parameter, float(found.best.end[k]), analysis.spread.quantile * share_error)
            if parameter.label in profiles:
                own = profiles[parameter.label]
                assert own.lower is not None  # else there would be a reason
                assert own.upper is not None
                interval = (own.lower, own.upper)
        fitted.append(
            FittedParameter(
                parameter.label,
                tuple(parameter.names),
                parameter.factor,
                parameter.log,
                parameter.lower,
                parameter.upper,
                float(parameters.start[k]),
                value,
                error,
                interval,
                analysis.reasons.get(k),
            )
        )
    return fitted


def _interval(parameter: Parameter, share: float, half: float) -> tuple[float, float]:
    """Return the ends of an interval; it goes no farther than the bounds."""
    return parameter.from_unit(max(0.0, share - half)), parameter.from_unit(min(1.0, share + half))


def _ends_at_bounds(fitted: list[FittedParameter]) -> list[str]:
    """Intervals that end at a bound: there it is the bound that ends them, not the data."""
    return [
        f"the interval of {parameter.label} ends at its {side} bound "
        f"{shown_value(bound, parameter.unit)}, not by the data"
        for parameter in fitted
        if parameter.interval is not None
        for side, end, bound in zip(
            ("lower", "upper"), parameter.interval, (parameter.lower, parameter.upper), strict=True
        )
        if math.isclose(end, bound, rel_tol=1e-9, abs_tol=1e-9 * (parameter.upper - parameter.lower))
    ]


def _targets(found: Search) -> tuple[FittedTarget, ...]:
    """Measured beside computed, at the fitted values and at the parameters' own start."""
    channel = found.best.channel
    problem = channel.problem
    computed = channel.computed([found.best.end])[0]
    assert computed is not None  # the optimum has been run
    started = problem.computed(problem.parameters.start)
    rows = []
    for target, owner, own, points, sigma in zip(
        problem.flat, problem.owners, problem.slices, found.noise.points, found.noise.sigmas, strict=True
    ):
        rows.append(
            FittedTarget(
                label=target.label,
                unit=QUANTITIES[target.quantity].unit if isinstance(target, CurveTarget) else target.unit,
                simulation=owner,
                against=target.against if isinstance(target, CurveTarget) else None,
                x=target.points if isinstance(target, CurveTarget) else np.zeros(1),
                measured=target.measured,
                started=started[own],
                computed=computed[own],
                sigma=np.array(sigma),
                channel_class=target.cfc if isinstance(target, CurveTarget) else None,
                independent_points=points,
            )
        )
    return tuple(rows)
