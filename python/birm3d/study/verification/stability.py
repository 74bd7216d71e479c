"""What holds at the extremes, what is refused, and where an answer is wrong."""

from __future__ import annotations

import math
import warnings
from collections.abc import Collection
from dataclasses import replace

import numpy as np

from ...base.arguments import checked
from ...base.progress import progress_bar
from ...result.energy_balance import warn_if_open
from ...scene.mesh_check import CoarseSkinWarning
from ...simulation.simulation import Simulation
from ...vehicle.mass_check import MassWarning
from .stability_cases import AXES, Case, default_scenes, laboratory_cases, varied_cases
from .stability_result import FAULT, HELD, REFUSED, WARNED, Stability, StabilityRow
from .watched import LIMITS, Limits, step_through

__all__ = ["stability"]

# A vehicle at rest is at rest: so far, and so fast, it may have gone after a minute [m, m/s].
_STILL = 1e-3
_STILL_SPEED = 1e-3
# Kinds of error that say what is wrong with a scene; any other is one of the program.
_REFUSALS = (ValueError, RuntimeError)


@checked
def stability(
    simulation: Simulation | None = None,
    *,
    axes: Collection[str] | None = None,
    limits: Limits = LIMITS,
    progress: bool | None = None,
) -> Stability:
    """Take a scene to extremes and judge every run by its balances.

    Stiffness x 1e-3 to 1e6; fixed steps x 1 to 1000 of the one that the program advises; 0.05 to 100 m/s;
    mass x 0.01 to 100; paths down to 0.05 deg from the barrier's line; slopes of unloading up to infinity
    and down to full elasticity; posts of 10 mm; a minute at rest; contact at t = 0; vehicles of one node and
    of 100,000; ten rollovers; a barrier whose segments move.

    A run **held** if its balances of energy and momentum close, and every number is finite. No node and no
    rigid body may end a step inside the barrier. The vehicle must also do what the scene demands. It meets a
    barrier in its path, stays in front of a post at its middle, or stays at rest. It was **refused** if an
    error said why not. It was **warned** of if a run of a fixed step tells that its energy balance is open
    (:class:`birm3d.BalanceWarning`). The same word is for a vehicle that missed what the scene told it could
    pass between nodes (:class:`birm3d.CoarseSkinWarning`). All else is a **FAULT**: an answer that its
    balances contradict.

    Parameters
    ----------
    simulation
        The scene to vary; ``None``: a car at a wall at 25 deg, a car at bollards, a block head-on at a wall.
    axes
        Among :data:`birm3d.study.verification.stability_cases.AXES`; ``None``: all.
    limits
        See :class:`birm3d.study.verification.watched.Limits`. Nodes at thin posts are held to a
        tenth of the diameter.
    progress
        Bar on stderr; ``None``: if that is a terminal.

    Raises
    ------
    ValueError
        If an axis is unknown.

    Examples
    --------
    >>> import birm3d
    >>> found = birm3d.study.stability(birm3d.scenes.w2(100), axes=["stiffness"])
    >>> found
    Stability(10 scenes: 10 held, 0 refused, 0 FAULT)
    """
    wanted = AXES if axes is None else tuple(axes)
    for axis in wanted:
        if axis not in AXES:
            raise ValueError(f"axes must be among {', '.join(AXES)}; got {axis!r}")
    scenes = default_scenes() if simulation is None else {simulation.scene.vehicle.name: simulation}
    cases = [case for name, base in scenes.items() for case in varied_cases(name, base)]
    cases = [case for case in cases + laboratory_cases() if case.axis in wanted]
    cases.sort(key=lambda case: AXES.index(case.axis))
    rows = []
    with progress_bar(progress, "stability", len(cases)) as advance:
        for case in cases:
            rows.append(_judged(case, limits))
            advance(1)
    return Stability(rows, limits)


def _judged(case: Case, limits: Limits) -> StabilityRow:
    blank = StabilityRow(case.axis, case.scene, case.value, REFUSED)
    try:
        simulation, coarse = _made(case)
    except _REFUSALS as refused:
        return replace(blank, reason=_reason(refused))
    except Exception as failed:  # a study of faults ends with none of them
        return replace(blank, verdict=FAULT, reason=_reason(failed))
    barrier = simulation.scene.barrier
    diameter = getattr(barrier, "diameter", math.inf)
    limits = replace(limits, node_depth=min(limits.node_depth, 0.1 * diameter))
    try:
        watched, error = step_through(simulation, limits)
    except Exception as failed:
        return replace(blank, verdict=FAULT, reason=_reason(failed))
    row = replace(
        blank,
        outcome=watched.outcome,
        steps=watched.steps,
        energy_residual=watched.energy_residual,
        momentum_residual=watched.momentum_residual,
        node_depth=watched.node_depth,
        anchor_depth=watched.anchor_depth,
    )
    if error is not None:
        return replace(row, reason=_reason(error))
    faults = [watched.fault] if watched.fault else []
    missed = _missed(case, simulation, watched.touched)
    if missed and not faults and coarse:
        return replace(row, verdict=WARNED, reason=f"{'; '.join(missed)}: {coarse}")
    faults += missed
    if faults == ["energy"] and simulation.scene.settings.time_step is not None:
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            warn_if_open(simulation.scene, simulation._core.balances)
        if told:
            return replace(row, verdict=WARNED, reason=str(told[0].message))
    return replace(row, verdict=FAULT if faults else HELD, reason="; ".join(faults))


def _made(case: Case) -> tuple[Simulation, str]:
    """Return the scene of a case, and what was told if its barrier can pass between nodes."""
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always", CoarseSkinWarning)
        warnings.simplefilter("ignore", MassWarning)  # the axis "mass" is of unusual masses
        simulation = case.make()
    coarse = ""
    for one in told:
        if issubclass(one.category, CoarseSkinWarning):
            coarse = str(one.message)
        else:
            warnings.warn_explicit(one.message, one.category, one.filename, one.lineno)
    return simulation, coarse


def _missed(case: Case, simulation: Simulation, touched: bool) -> list[str]:
    """Return what the scene should have done and did not."""
    result, scene = simulation.result(), simulation.scene
    faults = []
    if case.touches and not touched:
        faults.append("the barrier was not met")
    if scene.barrier is not None and math.isfinite(case.behind):
        past = -np.asarray(scene.barrier.core.normal)
        behind = float(((result.position - np.asarray(scene.barrier.origin)) @ past).max())
        if behind > case.behind:
            faults.append(f"the mass centre got {behind:.3g} m behind the barrier")
    if case.turns > 0.0:
        from scipy.integrate import trapezoid

        # Either way: a vehicle that hits the ground with a corner may roll back.
        turns = float(trapezoid(np.abs(result.angular_velocity[:, 0]), result.time)) / 360.0
        if turns < case.turns:
            faults.append(f"{turns:.1f} turns instead of {case.turns:g} or more")
    if not case.moves:
        distance = float(np.linalg.norm(result.position - result.position[0], axis=1).max())
        speed = float(np.linalg.norm(result.velocity, axis=1).max())
        if distance > _STILL or speed > _STILL_SPEED:
            faults.append(f"moved by {distance:.2g} m at up to {speed:.2g} m/s")
    return faults


def _reason(error: Exception) -> str:
    return f"{type(error).__name__}: {error}"
