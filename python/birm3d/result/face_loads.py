"""Forces of the nodes of a skin on the front of a barrier, step by step."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .. import _core
from ..barrier.fronts import Front
from ..vehicle.unit_shapes import UnitShape, unit_shapes
from .record import RunRecord

__all__ = ["SPREAD", "FaceStep", "face_steps", "lowest_load"]

Floats = npt.NDArray[np.float64]

SPREAD = 0.0125
"""Four quarters of a node's force act so far from it, along and up [m]."""
_MOST_INSTANTS = 800  # until the last contact; in long contacts not at each step's end


def lowest_load(result: RunRecord) -> float:
    """Return the least height of a load [m]: that of the ground, if there is one."""
    return 0.0 if result.scene.settings.ground else -math.inf


class FaceStep(NamedTuple):
    """Forces of nodes on the front at the end of a step."""

    time: float
    along: Floats
    height: Floats
    force: Floats  # across the line [N]


def face_steps(result: RunRecord, front: Front) -> list[FaceStep]:
    """Return the forces of nodes on the front at the ends of all steps."""
    core = result.scene.start()
    shapes = unit_shapes(result.scene.vehicle)
    steps = [FaceStep(core.time, *[np.empty(0)] * 3)]
    loaded = result.time[np.any(result.barrier_force != 0.0, axis=1)]
    until = float(loaded[-1]) if len(loaded) else 0.0
    least = until / _MOST_INSTANTS
    for number in range(result.statistics.steps):
        core.step()
        last = number == result.statistics.steps - 1
        over = steps[-1].time > until
        if not last and (over or core.time < steps[-1].time + least):
            continue
        pressed = [_pressed(core, unit, shape, front) for unit, shape in enumerate(shapes)]
        along, height, force = (np.concatenate(column) for column in zip(*pressed, strict=True))
        steps.append(FaceStep(core.time, along, np.maximum(height, lowest_load(result)), force))
    if core.state_hash != result.state_hash:
        raise ValueError(
            f"a load map needs a scene that runs the same way again: the result ended in state "
            f"{result.state_hash:016x}, its scene now in {core.state_hash:016x}"
        )
    return steps


def _pressed(
    core: _core.Simulation, unit: int, shape: UnitShape, front: Front
) -> tuple[Floats, Floats, Floats]:
    """Return places along the line, heights and forces across it of the nodes of a unit in contact."""
    force = core.truss_force(unit)[: len(shape.nodes)]
    pushing = np.flatnonzero(force > 0.0)
    if len(pushing) == 0:
        return np.empty(0), np.empty(0), np.empty(0)
    nodes = core.nodes(unit)[pushing]
    center, rotation = core.pose(unit)
    truss = nodes - shape.anchors[pushing]
    truss = truss / np.linalg.norm(truss, axis=1)[:, None] @ rotation.T
    return front.pressed(center + nodes @ rotation.T, force[pushing, None] * truss)
