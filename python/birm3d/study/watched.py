"""A run that is watched step by step: what may never happen in a crash, counted."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

import numpy as np

from ..simulation import Simulation

# Where three faces meet, as those of a barrier on the ground, a node may be this far inside at the end of a
# step [m]: it goes onto two of them.
NODE_DEPTH = 5e-3
# Closed trusses are held by rigid contact, which finds what is inside at the end of the step [m].
ANCHOR_DEPTH = 1e-3
ENERGY = 5e-3
MOMENTUM = 1e-9


@dataclass(frozen=True)
class Watched:
    """Outcome of one run; lengths in m, energies and forces relative."""

    outcome: str
    steps: int
    run_time: float
    crush: float
    penetration: float
    node_depth: float
    deep_nodes: int  # steps that ended with a node deeper than NODE_DEPTH
    anchor_depth: float
    deep_anchors: int
    energy_residual: float
    momentum_residual: float
    touched: bool
    fault: str

    @staticmethod
    def names() -> list[str]:
        return [field.name for field in fields(Watched)]


def watch(simulation: Simulation) -> Watched:
    """Run to the end, looking at every step; an error becomes a fault of the row."""
    core = simulation._core
    node = anchor = 0.0
    deep_nodes = deep_anchors = 0
    error = ""
    try:
        while simulation.step():
            depth, anchored = core.deepest_node, core.deepest_anchor
            node, anchor = max(node, depth), max(anchor, anchored)
            deep_nodes += depth > NODE_DEPTH
            deep_anchors += anchored > ANCHOR_DEPTH
    except (ValueError, RuntimeError) as raised:
        error = f"{type(raised).__name__}: {raised}"
    result = simulation.result()
    metrics = result.metrics
    energy, momentum = metrics["energy_residual"], metrics["momentum_residual"]
    faults = [error] if error else []
    if not (np.isfinite(result.position).all() and all(map(math.isfinite, (energy, momentum)))):
        faults.append("not finite")
    if not energy < ENERGY:
        faults.append("energy")
    if not momentum < MOMENTUM:
        faults.append("momentum")
    if deep_nodes:
        faults.append("node inside")
    if deep_anchors:
        faults.append("body inside")
    return Watched(
        core.end_reason.name,
        core.statistics.steps,
        metrics["run_time"],
        metrics["dynamic_crush"],
        metrics["vehicle_penetration"],
        node,
        deep_nodes,
        anchor,
        deep_anchors,
        energy,
        momentum,
        core.touched,
        "; ".join(faults),
    )


def text(value: object) -> str:
    """Of a cell of a table: three figures."""
    return f"{value:.3g}" if isinstance(value, float) else str(value)
