"""Error against run time of one scene: what accuracy costs, and which setting is the cheapest."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from typing import Any

from ...base.arguments import checked
from ...scene.settings import Settings
from ...simulation.parameters import varied
from ...simulation.simulation import Simulation
from .errors import least_scales
from .precision_plan import PrecisionPlan
from .precision_result import AS_GIVEN, WorkPrecision
from .precision_runs import PrecisionRun, run_at
from .triangulated import triangulated

__all__ = ["WorkPrecisionInterrupted", "work_precision"]

_TOLERANCES = (1.0, 3e-1, 1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5)
_REFERENCES = (1e-6, 1e-7, 1e-8)
_DENSITIES = (0.25, 0.5, 1.0, 2.0, 4.0)
# Fixed steps as shares of the critical step that adaptive stepping found; without contact, in s.
_SHARES = (0.25, 0.08, 0.025, 0.008, 0.0025)
_FREE_STEPS = (5e-3, 1e-3, 2e-4)
_MOST_STEPS = 50_000
# Of a barrier that is many elements and, in triangles, one.
_OF_ELEMENTS = (
    *("peak_element_force", "peak_element_force_50ms"),
    *("peak_overturning_moment", "peak_overturning_moment_50ms"),
)


class WorkPrecisionInterrupted(KeyboardInterrupt):
    """Ctrl-C; ``work_precision`` has the finished runs, ``None`` before those of the scene as given.

    Settings that were not run are rows whose ``refused`` says so.
    """

    def __init__(self, message: str, work_precision: WorkPrecision | None) -> None:
        super().__init__(message)
        self.work_precision = work_precision

    def __reduce__(self) -> tuple[Any, ...]:
        return (type(self), (self.args[0], self.work_precision))


@checked
def work_precision(
    simulation: Simulation,
    *,
    tolerances: Sequence[float] = _TOLERANCES,
    time_steps: Sequence[float] | None = None,
    references: Sequence[float] = _REFERENCES,
    contact_models: bool = True,
    representations: bool = True,
    mesh_densities: Sequence[float] | None = None,
    metrics: Collection[str] | None = None,
    scales: Mapping[str, float] | None = None,
    repeats: int = 5,
    most_steps: int = 200_000,
    progress: bool | None = None,
) -> WorkPrecision:
    """Find the error of every metric of a scene, and what it costs.

    The scene runs at several tolerances and fixed steps. Errors are against its own converged values: what
    the answers at ``references`` tend to, with the uncertainty of that (:func:`.convergence.limit_of`). They
    are relative to the magnitude of the converged value or to a least scale of the metric, the greater of
    both (see :mod:`birm3d.study.verification.errors`). Other contact models and representations of the
    barrier are other models of the same crash. Each has its own converged values, and
    :meth:`.WorkPrecision.departures` returns how far they are from the scene's. Meshes are compared with what
    finer ones tend to.

    By default some 230 runs are made, on one core. A car at a wall takes about 4 s, at a pole 30 s, and a
    truck of 10 t at planters 45 to 75 s. Most of it are runs at strict tolerances.

    Parameters
    ----------
    simulation
        The scene; its own settings are the default that others are compared with.
    tolerances
        Falling; that of the scene is added.
    time_steps
        Fixed, falling [s]; ``None``: five, from a quarter of the critical step down; a step that would need
        more than 50,000 is left out.
    references
        Tolerances of the converged answer, falling, below all others; two or more, down to 1e-9.
    contact_models
        Whether the other contact model is run too.
    representations
        Whether a triangulated copy of the barrier is run too, where there can be one.
    mesh_densities
        Rising, relative to the vehicle's file, three or more, or none; ``None``: 0.25 to 4 where the vehicle
        has a file.
    metrics
        Those wanted; ``None``: all that the scene has.
    scales
        Metric -> least scale to take instead of the usual one, in its unit.
    repeats
        Runs of each setting in turn (A B A B ...); times are medians, stepping only. Reference runs are not
        repeated, nor are runs of more than a second.
    most_steps
        Most steps of a run with a contact model or representation other than the scene's own, > 0; at strict
        tolerances such a model may take ever shorter steps between changes of contact. One that takes more is
        refused, and so are stricter tolerances of that model.
    progress
        Bar on stderr; ``None``: if that is a terminal.

    Raises
    ------
    ValueError
        If an argument is out of range, a metric is unknown to the scene, or the scene itself is refused.
    WorkPrecisionInterrupted
        A KeyboardInterrupt, with what the finished runs tell in its ``work_precision``.

    Examples
    --------
    >>> import birm3d
    >>> found = birm3d.study.work_precision(birm3d.scenes.w2(100), repeats=1)
    >>> print(found.recommend(0.01))  # doctest: +SKIP
    >>> found.plot().savefig("precision.png")  # doctest: +SKIP
    """
    # Longer than 60 lines: one plan of runs, carried out in turn, and judged together.
    least = least_scales(simulation.scene, scales)
    own = simulation.scene.settings
    loose = _falling("tolerances", {*tolerances, own.tolerance} if own.time_step is None else tolerances)
    fine = _falling("references", references)
    if len(fine) < 2 or not fine[0] < loose[-1]:
        raise ValueError(
            f"references must be two tolerances or more, all below {loose[-1]:g}, got {list(references)}"
        )
    for name, count in (("repeats", repeats), ("most_steps", most_steps)):
        if isinstance(count, bool) or not isinstance(count, int) or count < 1:
            raise ValueError(f"{name} must be an integer >= 1, got {count!r}")
    densities = _densities(simulation, mesh_densities)

    runs = [run_at(simulation, AS_GIVEN, "tolerance", value) for value in loose]
    first = next((run for run in runs if run.value <= own.tolerance), runs[-1])
    first.once()
    if first.refused:
        raise ValueError(f"simulation must run at tolerance {first.value:g}; {first.refused}")
    steps = (
        _steps(first.critical_step, first.metrics["end_time"])
        if time_steps is None
        else _falling("time_steps", time_steps)
    )
    if own.time_step is not None:
        steps = _falling("time_steps", {*steps, own.time_step})
    first.times.clear()  # a warm-up
    runs += [run_at(simulation, AS_GIVEN, "time_step", value) for value in steps]
    wanted = _wanted(first.values, metrics)

    bases = _bases(simulation, contact_models, representations)
    others = list(bases.items())[1:]
    for variant, (base, without) in others:
        runs += [run_at(base, variant, "tolerance", value, without, most_steps) for value in loose]
    sharp = [run_at(simulation, AS_GIVEN, "tolerance", value) for value in fine]
    for variant, (base, without) in others:
        sharp += [run_at(base, variant, "tolerance", value, without, most_steps) for value in fine]
    meshes = [varied(simulation, {"vehicle.mesh_density": density}) for density in densities]
    coarse = [
        PrecisionRun("mesh", "mesh_density", density, mesh)
        for density, mesh in zip(densities, meshes, strict=True)
    ]
    meshed = [run_at(mesh, "mesh", "tolerance", loose[-1]) for mesh in meshes]
    plan = PrecisionPlan(simulation, runs, sharp, coarse, meshed, list(bases), wanted, least)
    try:
        plan.carry_out(repeats, progress)
    except KeyboardInterrupt:
        message = f"work_precision() was stopped after {plan.done} of {plan.planned} runs"
        raise WorkPrecisionInterrupted(message, plan.found()) from None
    found = plan.found()
    if found is None:
        raise ValueError(f"references must be tolerances that the scene runs at; {plan.first_refusal()}")
    return found


def _bases(
    simulation: Simulation, contact_models: bool, representations: bool
) -> dict[str, tuple[Simulation, Collection[str]]]:
    """Return the scene and its other models by variant, each with the metrics that it does not have."""
    bases: dict[str, tuple[Simulation, Collection[str]]] = {AS_GIVEN: (simulation, ())}
    other = "along_truss" if simulation.scene.settings.contact_model == "projected" else "projected"
    if contact_models and simulation.scene.barrier is not None:
        bases[f"contact model {other}"] = varied(simulation, {"settings.contact_model": other}), ()
    copy = triangulated(simulation.scene.barrier) if representations else None
    if copy is not None and simulation.scene.barrier is not None:
        whole = len(simulation.scene.barrier.element_names) == 1
        bases["triangulated barrier"] = (
            varied(simulation, {"barrier": copy}),
            () if whole else _OF_ELEMENTS,
        )
    return bases


def _falling(name: str, values: Collection[float]) -> list[float]:
    """Return numbers in falling order; a setting refuses one that it can not have."""
    found = sorted((float(value) for value in values), reverse=True)
    if not found:
        raise ValueError(f"{name} must be one number or more, got none")
    key = "time_step" if name == "time_steps" else "tolerance"
    for value in found:
        try:
            changed: dict[str, Any] = {key: value}
            Settings(**changed)
        except ValueError as refused:
            raise ValueError(f"{name}: {refused}") from refused
    return list(dict.fromkeys(found))


def _densities(simulation: Simulation, given: Sequence[float] | None) -> list[float]:
    has_file = simulation.scene.vehicle.has_file
    if given is None:
        return list(_DENSITIES) if has_file else []
    found = sorted(float(density) for density in given)
    if found and (len(found) < 3 or not has_file or not found[0] > 0.0):
        file = "" if has_file else " of a vehicle that has a file"
        raise ValueError(
            f"mesh_densities must be three numbers > 0 or more{file}, or none, got {list(given)}"
        )
    return found


def _steps(critical: float, end: float) -> list[float]:
    """Return fixed steps for a scene with a critical step, that ends at `end`, falling [s]."""
    steps = [share * critical for share in _SHARES] if math.isfinite(critical) else list(_FREE_STEPS)
    return [step for step in steps if step < end and end / step <= _MOST_STEPS]


def _wanted(values: Mapping[str, float], metrics: Collection[str] | None) -> tuple[str, ...]:
    if metrics is None:
        return tuple(values)
    for name in metrics:
        if name not in values:
            raise ValueError(f"metrics must be among {', '.join(values)}; got {name!r}")
    if not metrics:
        raise ValueError("metrics must name at least one, got none")
    return tuple(name for name in values if name in metrics)
