"""The skin of a vehicle's unit in the world at some instants of a run."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import numpy.typing as npt

from ..base.deprecated import warn_renamed
from ..vehicle.unit_shapes import unit_shapes
from .capture import capture

if TYPE_CHECKING:
    from .record import RunRecord

__all__ = ["Skin", "skins_at"]

Floats = npt.NDArray[np.float64]


class Skin(NamedTuple):
    """Shell nodes of one unit at one instant, and its pose.

    Attributes
    ----------
    nodes
        Body axes, shape (n, 3) [m].
    displacement
        The same less the uncrushed ones, shape (n, 3) [m].
    center, rotation
        Mass centre (3,) [m] and rotation body to world (3, 3).
    """

    nodes: Floats
    displacement: Floats
    center: Floats
    rotation: Floats

    @property
    def world(self) -> Floats:
        """Shell nodes in world axes, shape (n, 3) [m]."""
        return np.asarray(self.center + self.nodes @ self.rotation.T)

    @property
    def turn(self) -> Floats:
        """Old name of ``rotation``."""
        warn_renamed("turn", "rotation")
        return self.rotation

    @property
    def crush(self) -> Floats:
        """Distance of each node from its uncrushed place, shape (n,) [m]."""
        return np.asarray(np.linalg.norm(self.displacement, axis=1))


def skins_at(result: RunRecord, instants: npt.ArrayLike) -> list[tuple[Skin, ...]]:
    """Return the skins of all units at some instants: a list over instants of tuples over units.

    From the result's frames, linear between them; a result without frames is run once more.

    Raises
    ------
    ValueError
        If an instant is outside the run or the frames, or the scene does not run the same way again.
    """
    times = np.atleast_1d(np.asarray(instants, float))
    frames = result.frames
    if frames is None:
        frames = capture(result, np.unique(times))
    shapes = unit_shapes(result.scene.vehicle)
    poses = [result.pose(times, unit) for unit in range(len(shapes))]
    skins = []
    for k, time in enumerate(times):
        units = []
        for unit, (shape, (centers, rotations)) in enumerate(zip(shapes, poses, strict=True)):
            moved = frames.displacement_at(float(time), unit)
            units.append(Skin(shape.nodes + moved, moved, centers[k], rotations[k]))
        skins.append(tuple(units))
    return skins
