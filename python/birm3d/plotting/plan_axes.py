"""Axes of plan views: seen from above, along the barrier's line or square to it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from ..barrier.surfaces import Surface, barrier_axes, barrier_surfaces

if TYPE_CHECKING:
    from ..result.result import Result

__all__ = ["PlanAxes", "is_oblique"]

Floats = npt.NDArray[np.float64]


def is_oblique(result: Result) -> bool:
    """Whether the path is within 45 degrees of the barrier's line."""
    return not 45.0 <= result.scene.impact_angle <= 135.0


class PlanAxes:
    """Right-handed axes of a plan view, from the barrier's origin.

    Oblique impacts have the barrier's line level and its traffic side above; in others the vehicle comes from
    the left. Without a barrier: world axes.

    Attributes
    ----------
    labels : tuple of str
        Of the two axes.
    """

    def __init__(self, result: Result) -> None:
        barrier = result.scene.barrier
        along, out, _ = barrier_axes(barrier)[:, :2]
        self._barrier = barrier
        if barrier is None:
            self._origin, self._turn = np.zeros(2), np.eye(2)
            self.labels = ("x [m]", "y [m]")
            return
        self._origin = np.asarray(barrier.origin, float)[:2]
        if is_oblique(result):
            self._turn = np.stack([along, out])
            self.labels = ("along the barrier's line [m]", "in front of the barrier's line [m]")
        else:
            self._turn = np.stack([-out, along])
            self.labels = ("past the barrier's line [m]", "along the barrier's line [m]")

    def plan(self, points: Floats) -> Floats:
        """Return points in the plan, shape (..., 2), from world axes, shape (..., 2) or (..., 3) [m]."""
        return np.asarray((points[..., :2] - self._origin) @ self._turn.T)

    def barrier(self, world: Floats, plan: Floats) -> list[Surface]:
        """Return the surfaces of the barrier, vertices in the plan (n, 2).

        Endless walls are as wide as points `world` (k, 3) and `plan` (m, 2) of the picture ask for.
        """
        if self._barrier is None:
            return []
        more = np.column_stack(
            [plan @ self._turn + self._origin, np.full(len(plan), self._barrier.origin[2])]
        )
        surfaces = barrier_surfaces(self._barrier, np.vstack([world, more]))
        return [(self.plan(vertices), faces) for vertices, faces in surfaces]
