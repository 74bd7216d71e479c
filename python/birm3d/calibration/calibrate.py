"""The one call: fit parameters of simulations to measurements."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from ..base.arguments import checked
from ..base.checks import check_runs
from ..signals.channel import Channel
from ..units import Quantity
from .curve_target import CurveTarget
from .errors import CalibrationError, CalibrationInterruptedError
from .evaluator import Evaluator, Progress
from .fit import Search, search
from .identifiability import Analysis, analyse
from .outcome import outcome
from .parameters import Parameter
from .pool import threads_unless
from .problem import Problem, Target
from .profile import Profile, profile
from .result import CalibrationResult
from .scalar_target import ScalarTarget

if TYPE_CHECKING:
    from ..simulation.simulation import Simulation

__all__ = ["calibrate"]

Floats = npt.NDArray[np.float64]
Given: TypeAlias = Target | Channel

# What a channel is held against, by what it measures.
_OF_CHANNELS = {
    "force": "normal_force",
    "acceleration": "acceleration_r",
    "speed": "velocity_normal",
    "length": "displacement_normal",
}


@checked
def calibrate(
    simulations: Simulation | Sequence[Simulation],
    targets: Given | Sequence[Given] | Sequence[Sequence[Given]],
    parameters: Parameter | Sequence[Parameter] | Mapping[str, tuple[Quantity, Quantity]],
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
        For one simulation its targets, for several one sequence each. A :class:`birm3d.Channel` stands for
        ``CurveTarget.from_channel``: a force is that along the normal, an acceleration that along r, velocity
        and displacement those towards the barrier.
    parameters
        Unknowns with their bounds. A mapping of names (:mod:`birm3d.scene_parameters`) to (lower, upper)
        stands for parameters of these, with ``log`` where the lower bound is above 0.
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
    unknowns = _unknowns(parameters)
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
    return outcome(evaluator, found, analysis, profiles, notes, confidence, settings)


def _unknowns(
    parameters: Parameter | Sequence[Parameter] | Mapping[str, tuple[Quantity, Quantity]],
) -> tuple[Parameter, ...]:
    """Return parameters of what may be one of them, several, or names with bounds."""
    if isinstance(parameters, Parameter):
        return (parameters,)
    if not isinstance(parameters, Mapping):
        return tuple(parameters)
    found = []
    for name, bounds in parameters.items():
        if isinstance(bounds, str) or not isinstance(bounds, Sequence) or len(bounds) != 2:
            raise ValueError(f"parameters must give {name!r} its (lower, upper), got {bounds!r}")
        plain = Parameter(name, *bounds)
        found.append(replace(plain, log=True) if plain.lower > 0.0 else plain)
    return tuple(found)


def _as_target(item: Any) -> Any:
    """Return the target that a channel stands for; anything else as it is."""
    if not isinstance(item, Channel):
        return item
    if item.quantity not in _OF_CHANNELS:
        raise ValueError(
            f"targets must be channels of {', '.join(_OF_CHANNELS)}, or CurveTarget.from_channel with a "
            f"quantity, got {item.name!r} in {item.unit!r}"
        )
    return CurveTarget.from_channel(item, _OF_CHANNELS[item.quantity])


def _paired(
    simulations: Simulation | Sequence[Simulation],
    targets: Given | Sequence[Given] | Sequence[Sequence[Given]],
) -> tuple[tuple[Simulation, ...], tuple[tuple[Target, ...], ...]]:
    """Return simulations and the targets of each."""
    from ..simulation.simulation import Simulation

    scenes = (simulations,) if isinstance(simulations, Simulation) else tuple(simulations)
    if not scenes:
        raise ValueError("simulations must hold at least one Simulation, got none")
    for scene in scenes:
        if not isinstance(scene, Simulation):
            raise TypeError(f"simulations must be birm3d.Simulation, got {type(scene).__name__}")
    alone = isinstance(targets, (CurveTarget, ScalarTarget, Channel))
    several: Sequence[Any] = [targets] if alone else targets  # type: ignore[assignment]
    listed = [_as_target(one) for one in several]
    flat = all(isinstance(item, (CurveTarget, ScalarTarget)) for item in listed)
    if flat and len(scenes) > 1:
        raise ValueError(
            f"targets must be one sequence for each of {len(scenes)} simulations, got {len(listed)} "
            "single targets"
        )
    goals = (tuple(listed),) if flat else tuple(tuple(map(_as_target, own)) for own in listed)
    if len(goals) != len(scenes):
        raise ValueError(f"targets must be as many sequences as simulations, {len(scenes)}; got {len(goals)}")
    for own in goals:
        for target in own:
            if not isinstance(target, (CurveTarget, ScalarTarget)):
                raise TypeError(
                    f"targets must be CurveTarget, ScalarTarget or Channel, got {type(target).__name__}"
                )
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
    check_runs("starts", starts)
    if not 0.0 < confidence < 1.0:
        raise ValueError(f"confidence must be between 0 and 1, got {confidence}")
    if not 1e-9 <= tolerance <= 1.0:
        raise ValueError(f"tolerance must be 1e-9 to 1, got {tolerance}")


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
