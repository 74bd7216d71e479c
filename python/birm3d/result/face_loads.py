"""What the nodes of a skin press on the face of a wall, step by step."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .. import _core
from ..barrier.rigid_wall import RigidWall
from ..vehicle.unit_shapes import UnitShape, unit_shapes
from .record import RunRecord

__all__ = ["SPREAD", "Face", "FaceStep", "face_steps"]

Floats = npt.NDArray[np.float64]

SPREAD = 0.0125
"""Four quarters of a node's force act so far from it, along and up [m]."""
_NEAR = 1e-3  # of the face: a node that pushes and is as near stands on it [m]
_MOST_INSTANTS = 800  # at which nodes are looked at: of longer runs not at the end of every step


class Face(NamedTuple):
    """The front of a wall in the world, and its rounded edges."""

    origin: Floats
    line: Floats
    across: Floats
    half_width: float
    radius: float

    @classmethod
    def of(cls, wall: RigidWall) -> Face:
        """Return that of a wall."""
        angle = math.radians(wall.heading)
        line = np.array([-math.sin(angle), math.cos(angle), 0.0])
        across = np.array([line[1], -line[0], 0.0])
        return cls(np.asarray(wall.origin, float), line, across, 0.5 * wall.width, wall.edge_radius)

    def places(self, world: Floats) -> tuple[Floats, Floats, Floats]:
        """Return depth behind the face, place along the line, and height, each of shape (n,) [m]."""
        way = world - self.origin
        return way @ self.across, way @ self.line, way[:, 2]

    def on_it(self, depth: Floats, along: Floats) -> npt.NDArray[np.bool_]:
        """Return which nodes stand on the front, its rounded edges included."""
        flat = (np.abs(depth) <= _NEAR) & (np.abs(along) <= self.half_width + _NEAR)
        if self.radius == 0.0:
            return flat
        beyond = np.abs(along) - (self.half_width - self.radius)
        circle = np.hypot(beyond, depth - self.radius)
        rounded = (beyond > 0.0) & (depth < self.radius) & (np.abs(circle - self.radius) <= _NEAR)
        return np.asarray((flat & (beyond <= 0.0)) | rounded)


class FaceStep(NamedTuple):
    """What nodes press on the front at the end of a step."""

    time: float
    along: Floats
    height: Floats
    force: Floats  # across the line [N]


def face_steps(result: RunRecord, face: Face) -> list[FaceStep]:
    """Return what nodes press on the face at the ends of all steps."""
    core = result.scene.start()
    shapes = unit_shapes(result.scene.vehicle)
    steps = [FaceStep(core.time, *[np.empty(0)] * 3)]
    least = float(result.time[-1]) / _MOST_INSTANTS
    for number in range(result.statistics.steps):
        core.step()
        last = number == result.statistics.steps - 1
        if not last and core.time < steps[-1].time + least:
            continue
        pressed = [_pressed(core, unit, shape, face) for unit, shape in enumerate(shapes)]
        along, height, force = (np.concatenate(column) for column in zip(*pressed, strict=True))
        steps.append(FaceStep(core.time, along, height, force))
    if core.state_hash != result.state_hash:
        raise ValueError(
            f"a load map needs a scene that runs the same way again: the result ended in state "
            f"{result.state_hash:016x}, its scene now in {core.state_hash:016x}"
        )
    return steps


def _pressed(
    core: _core.Simulation, unit: int, shape: UnitShape, face: Face
) -> tuple[Floats, Floats, Floats]:
    """Return places along the line, heights and forces across it of the nodes of a unit that press now."""
    force = core.truss_force(unit)[: len(shape.nodes)]
    pushing = np.flatnonzero(force > 0.0)
    if len(pushing) == 0:
        return np.empty(0), np.empty(0), np.empty(0)
    nodes = core.nodes(unit)[pushing]
    center, turn = core.pose(unit)
    depth, along, height = face.places(center + nodes @ turn.T)
    truss = nodes - shape.anchors[pushing]
    truss = truss / np.linalg.norm(truss, axis=1)[:, None] @ turn.T
    # The force along the truss, projected on the face's normal.
    across = force[pushing] * (truss @ face.across)
    here = face.on_it(depth, along) & (across > 0.0)
    return along[here], height[here], across[here]
