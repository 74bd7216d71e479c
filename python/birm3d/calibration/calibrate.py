"""The one call: fit parameters of simulations to measurements."""

from __future__ import annotations

import math
from collections.abc import Sequence
from concurrent.futures import Executor
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

from .errors import CalibrationError, CalibrationInterruptedError
from .evaluator import Evaluator, Progress
from .fit import Search, search
from .identifiability import Analysis, analyse, correlation, describe
from .parameters import Parameter
from .pool import threads_unless
from .problem import Problem
from .profile import Profile, profile
from .quantities import QUANTITIES
from .result import CalibrationResult, FittedParameter, FittedTarget
from .targets import CurveTarget, ScalarTarget, Target

if TYPE_CHECKING:
    from ..simulation import Simulation

__all__ = ["calibrate"]

Floats = npt.NDArray[np.float64]


def calibrate(
    simulations: Simulation | Sequence[Simulation],
    targets: Target | Sequence[Target] | Sequence[Sequence[Target]],
    parameters: Parameter | Sequence[Parameter],
    *,
    method: Literal["local", "global"] = "local",
    starts: int = 4,
    seed: int = 0,
    intervals: Literal["covariance", "profile"] = "covariance",
    uncertainty: Literal["larger", "given", "scatter"] = "larger",
    confidence: float = 0.95,
    tolerance: float = 1e-5,
    max_steps: int = 50,
    executor: Executor | None = None,
    jobs: int | None = None,
    progress: Progress | None = None,
) -> CalibrationResult:
    r"""Fit parameters of one or several simulations to measurements, and say how far to trust them.

    Minimises :math:`\chi^2 = \sum r_i^2` over the targets' residuals and the priors by least squares
    (``scipy.optimize.least_squares``, a trust region within the bounds) from several starts. The covariance
    is :math:`s^2 (J^T J)^{-1}`; where the data can not tell a parameter, the verdict says why and no
    interval is given (:mod:`birm3d.calibration.identifiability`).

    Parameters
    ----------
    simulations
        One, or several that share parameters.
    targets
        For one simulation its targets, for several one sequence each.
    parameters
        Unknowns with their bounds.
    method
        ``"local"``, or ``"global"``: a differential evolution over the bounds gives the second start.
    starts
        Number of starts: the parameters' own, then points drawn within the bounds. Start i depends on seed
        and i only.
    seed
        >= 0.
    intervals
        ``"covariance"``: symmetric in the parameter (in its logarithm with ``log``); ``"profile"``: from the
        profile of each, asymmetric where the model is, at the cost of some hundred runs a parameter.
    uncertainty
        ``"given"``: the targets' sigmas are true (s = 1, normal quantile). ``"scatter"``: they are relative,
        s^2 = chi-square / dof (Student's t). ``"larger"``: the wider of the two, for models
        that do not follow the data as closely as these are measured.
    confidence
        Of the intervals, between 0 and 1. They end at the bounds at the latest.
    tolerance
        Of the adaptive steps during the fit, where the simulations ask for less: finite differences need runs
        that are smooth in the parameters. The fitted simulations have their own settings again.
    max_steps
        Of each start.
    executor
        Any ``concurrent.futures.Executor``; results do not depend on which. ``None``: threads.
    jobs
        Number of threads; ``None``: one a processor.
    progress
        Called after every batch of runs with their number and the least cost so far.

    Returns
    -------
    CalibrationResult

    Raises
    ------
    ValueError
        Naming the argument, its limit and the value received.
    CalibrationError
        If no run succeeds or the executor fails; ``history`` and ``best_values`` are what was finished.
    CalibrationInterruptedError
        After Ctrl-C, a ``KeyboardInterrupt`` with the same two.
    """
    scenes, goals = _paired(simulations, targets)
    unknowns = (parameters,) if isinstance(parameters, Parameter) else tuple(parameters)
    _check(method, starts, seed, intervals, uncertainty, confidence, tolerance, max_steps)
    problem = Problem(scenes, goals, unknowns, tolerance)
    notes = problem.check(problem.parameters.start)
    with threads_unless(executor, jobs) as pool:
        evaluator = Evaluator(problem, pool, progress)
        try:
            found = search(evaluator, method=method, starts=starts, seed=seed, max_steps=max_steps)
            profiled = intervals == "profile"
            analysis = analyse(found, confidence=confidence, uncertainty=uncertainty, profiled=profiled)
            profiles = _profiles(evaluator, found, analysis, max_steps) if profiled else {}
        except CalibrationError as error:
            evaluator.stop()
            error.history = evaluator.history
            raise
        except KeyboardInterrupt as stop:
            evaluator.stop()
            interrupted = CalibrationInterruptedError("the calibration was interrupted")
            interrupted.history = evaluator.history
            raise interrupted from stop
    settings = {
        "method": method,
        "starts": starts,
        "seed": seed,
        "intervals": intervals,
        "uncertainty": uncertainty,
        "tolerance": problem.tolerance,
        "max_steps": max_steps,
    }
    return _result(evaluator, found, analysis, profiles, notes, confidence, settings)


def _paired(
    simulations: Simulation | Sequence[Simulation],
    targets: Target | Sequence[Target] | Sequence[Sequence[Target]],
) -> tuple[tuple[Simulation, ...], tuple[tuple[Target, ...], ...]]:
    """Return simulations and the targets of each."""
    from ..simulation import Simulation

    scenes = (simulations,) if isinstance(simulations, Simulation) else tuple(simulations)
    if not scenes:
        raise ValueError("simulations must hold at least one Simulation, got none")
    for scene in scenes:
        if not isinstance(scene, Simulation):
            raise TypeError(f"simulations must be birm3d.Simulation, got {type(scene).__name__}")
    listed: list[Any] = [targets] if isinstance(targets, (CurveTarget, ScalarTarget)) else list(targets)
    flat = all(isinstance(item, (CurveTarget, ScalarTarget)) for item in listed)
    if flat and len(scenes) > 1:
        raise ValueError(
            f"targets must be one sequence for each of {len(scenes)} simulations, got {len(listed)} "
            "single targets"
        )
    goals = (tuple(listed),) if flat else tuple(tuple(own) for own in listed)
    if len(goals) != len(scenes):
        raise ValueError(f"targets must be as many sequences as simulations, {len(scenes)}; got {len(goals)}")
    for own in goals:
        for target in own:
            if not isinstance(target, (CurveTarget, ScalarTarget)):
                raise TypeError(f"targets must be CurveTarget or ScalarTarget, got {type(target).__name__}")
    return scenes, goals


def _check(
    method: str,
    starts: int,
    seed: int,
    intervals: str,
    uncertainty: str,
    confidence: float,
    tolerance: float,
    max_steps: int,
) -> None:
    for name, value, known in (
        ("method", method, ("local", "global")),
        ("intervals", intervals, ("covariance", "profile")),
        ("uncertainty", uncertainty, ("larger", "given", "scatter")),
    ):
        if value not in known:
            raise ValueError(f"{name} must be one of {', '.join(known)}; got {value!r}")
    for name, number, least in (("starts", starts, 1), ("seed", seed, 0), ("max_steps", max_steps, 1)):
        if not (isinstance(number, int) and number >= least):
            raise ValueError(f"{name} must be a whole number >= {least}, got {number!r}")
    if not 0.0 < confidence < 1.0:
        raise ValueError(f"confidence must be between 0 and 1, got {confidence}")
    if not 1e-9 <= tolerance <= 0.1:
        raise ValueError(f"tolerance must be 1e-9 to 0.1, got {tolerance}")


def _profiles(evaluator: Evaluator, found: Search, analysis: Analysis, max_steps: int) -> dict[str, Profile]:
    """Profiles of the parameters that have an interval; a flat one takes it away."""
    profiles = {}
    half = analysis.spread.quantile * np.sqrt(np.diag(analysis.covariance))
    for k, label in enumerate(evaluator.problem.parameters.labels):
        if k in analysis.reasons:
            continue
        own = profile(evaluator, found.noise, found.best.end, k, float(half[k]), analysis.spread, max_steps)
        profiles[label] = own
        flat = [side for side, end in (("below", own.lower), ("above", own.upper)) if end is None]
        if flat:
            analysis.reasons[k] = f"flat profile: the data do not bound {label} from {' and '.join(flat)}"
    return profiles


def _result(
    evaluator: Evaluator,
    found: Search,
    analysis: Analysis,
    profiles: dict[str, Profile],
    notes: list[str],
    confidence: float,
    settings: dict[str, Any],
) -> CalibrationResult:
    problem = evaluator.problem
    parameters = problem.parameters
    values = parameters.from_unit(found.best.end)
    slopes = np.array([p.slope(v) for p, v in zip(parameters.parameters, values.tolist(), strict=True)])
    fitted = []
    for k, (parameter, value) in enumerate(zip(parameters.parameters, values.tolist(), strict=True)):
        error = interval = None
        if k not in analysis.reasons:
            share_error = math.sqrt(analysis.covariance[k, k])
            error = share_error * float(slopes[k])
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
    told = [k for k in range(len(parameters)) if k not in analysis.reasons]
    covariance = (analysis.covariance * np.outer(slopes, slopes))[np.ix_(told, told)]
    return CalibrationResult(
        parameters=tuple(fitted),
        targets=_targets(found, values),
        chi_square=float(found.best.chi_square or 0.0),
        spread=analysis.spread,
        confidence=confidence,
        covariance=covariance,
        correlation=correlation(covariance),
        condition_number=analysis.condition_number,
        notes=(*notes, *analysis.notes),
        starts=tuple(describe(found)),
        history=evaluator.history,
        settings=settings,
        profiles=profiles,
        _problem=problem,
        _noise=found.noise,
    )


def _interval(parameter: Parameter, share: float, half: float) -> tuple[float, float]:
    """Return the ends of an interval; it goes no farther than the bounds."""
    return parameter.from_unit(max(0.0, share - half)), parameter.from_unit(min(1.0, share + half))


def _targets(found: Search, values: Floats) -> tuple[FittedTarget, ...]:
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
                unit=QUANTITIES[target.quantity].unit if isinstance(target, CurveTarget) else "SI",
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
