"""A run that is checked step by step for what may never happen in a crash."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace

import numpy as np

from ...result.energy_balance import ENERGY_LIMIT
from ...result.result import Result
from ...simulation.simulation import Simulation

__all__ = ["LIMITS", "Limits", "Watched", "step_through", "watch"]


@dataclass(frozen=True)
class Limits:
    """What a run is judged by.

    Parameters
    ----------
    node_depth
        How far a node may be inside a barrier at the end of a step [m]. Where three faces meet, as those of a
        barrier on the ground, it goes onto two of them.
    anchor_depth
        The same of the rigid body [m]. Bottomed-out trusses are held by rigid contact, which finds points
        inside only at the end of the step.
    energy, momentum
        Greatest residuals of the balances, see :func:`birm3d.metrics.compute_metrics`.
    """

    node_depth: float = 5e-3
    anchor_depth: float = 1e-3
    energy: float = ENERGY_LIMIT
    momentum: float = 1e-9

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if not value >= 0.0:
                raise ValueError(f"{field.name} must be >= 0, got {value}")


LIMITS = Limits()


@dataclass(frozen=True)
class Watched:
    """Outcome of one run; lengths in m, energies and forces relative. NaN: the scene does not have it."""

    outcome: str
    steps: int
    run_time: float
    crush: float
    penetration: float
    node_depth: float
    deep_nodes: int  # steps that ended with a node deeper than the limit
    anchor_depth: float
    deep_anchors: int
    energy_residual: float
    momentum_residual: float
    touched: bool
    fault: str

    @staticmethod
    def names() -> list[str]:
        """Of the fields, in their order."""
        return [field.name for field in fields(Watched)]


def watch(simulation: Simulation, limits: Limits = LIMITS) -> Watched:
    """Run to the end, looking at every step; an error becomes a fault of the row."""
    watched, error = step_through(simulation, limits)
    if error is None:
        return watched
    told = f"{type(error).__name__}: {error}"
    return replace(watched, fault=f"{told}; {watched.fault}" if watched.fault else told)


def step_through(
    simulation: Simulation, limits: Limits = LIMITS
) -> tuple[Watched, ValueError | RuntimeError | None]:
    """Run to the end, looking at every step; return what was seen, and the error that ended it."""
    core = simulation._core
    node = anchor = 0.0
    deep_nodes = deep_anchors = 0
    error: ValueError | RuntimeError | None = None
    try:
        while simulation.step():
            depth, anchored = core.deepest_node, core.deepest_anchor
            node, anchor = max(node, depth), max(anchor, anchored)
            deep_nodes += depth > limits.node_depth
            deep_anchors += anchored > limits.anchor_depth
    except (ValueError, RuntimeError) as raised:
        error = raised
    result = simulation.result()
    faults = []
    metrics: dict[str, float] = {}
    if error is None or len(result.time) > 1:  # a run that was refused at once has no metrics
        metrics = dict(result.metrics)
        if not _finite(result, metrics):
            faults.append("not finite")
        if not metrics["energy_residual"] < limits.energy:
            faults.append("energy")
        if not metrics["momentum_residual"] < limits.momentum:
            faults.append("momentum")
    if deep_nodes:
        faults.append("node inside")
    if deep_anchors:
        faults.append("body inside")
    watched = Watched(
        core.end_reason.name,
        core.statistics.steps,
        metrics.get("run_time", math.nan),
        metrics.get("dynamic_crush", math.nan),
        metrics.get("vehicle_penetration", math.nan),
        node,
        deep_nodes,
        anchor,
        deep_anchors,
        metrics.get("energy_residual", math.nan),
        metrics.get("momentum_residual", math.nan),
        core.touched,
        "; ".join(faults),
    )
    return watched, error


def _finite(result: Result, metrics: dict[str, float]) -> bool:
    arrays = (result.position, result.velocity, result.acceleration, result.roll, result.pitch, result.yaw)
    return all(map(math.isfinite, metrics.values())) and all(np.isfinite(array).all() for array in arrays)


def text(value: object) -> str:
    """Of a cell of a table: three figures."""
    return f"{value:.3g}" if isinstance(value, float) else str(value)
