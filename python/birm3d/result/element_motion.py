"""Where the elements of a barrier that move are over time: free-standing segments, and posts that yield."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from .record import RunRecord

__all__ = ["ElementMotion", "element_motion"]

Floats = npt.NDArray[np.float64]


class ElementMotion(NamedTuple):
    """Motion of the first elements of a barrier, those that move (e of them), at k instants.

    Attributes
    ----------
    center
        Points about which the turns are, where they were at first, world axes, shape (e, 3) [m]. That is a
        segment's foot, and a post's centre of rotation.
    shift
        Of these points from there, shape (k, e, 3) [m].
    turn
        Rotations from how the elements stood at first, shape (k, e, 3, 3).
    """

    center: Floats
    shift: Floats
    turn: Floats

    @property
    def movable(self) -> int:
        """How many elements move."""
        return len(self.center)

    def moved(self, k: int, element: int, corners: Floats) -> Floats:
        """Return points of an element at an instant from where they were at first, shape (n, 3) [m]."""
        if element >= self.movable:
            return corners
        center = self.center[element]
        return np.asarray((corners - center) @ self.turn[k, element].T + center + self.shift[k, element])


def element_motion(result: RunRecord, time: Floats) -> ElementMotion:
    """Return how the elements of the barrier of a run move, at some instants [s]."""
    if result.post_axis.shape[1]:
        return _of_posts(result, time)
    place = result.segment_position
    parts = range(place.shape[1])
    center = np.zeros((len(parts), 3))
    center[:, :2] = place[0]
    shift = np.zeros((len(time), len(parts), 3))
    turn = np.zeros((len(time), len(parts), 3, 3))
    turn[..., 2, 2] = 1.0
    for i in parts:
        for axis in (0, 1):
            shift[:, i, axis] = np.interp(time, result.time, place[:, i, axis]) - center[i, axis]
        yaw = np.radians(np.interp(time, result.time, result.segment_yaw[:, i]))
        turn[:, i, 0, 0] = turn[:, i, 1, 1] = np.cos(yaw)
        turn[:, i, 1, 0] = np.sin(yaw)
        turn[:, i, 0, 1] = -turn[:, i, 1, 0]
    return ElementMotion(center, shift, turn)


def _of_posts(result: RunRecord, time: Floats) -> ElementMotion:
    """Return how posts turn about their centres of rotation, and not about their own axes."""
    barrier = result.scene.barrier
    assert barrier is not None  # it has posts
    parts = range(result.post_axis.shape[1])
    center = np.array(barrier.rotation_centers())
    turn = np.zeros((len(time), len(parts), 3, 3))
    for i in parts:
        axis = np.stack([np.interp(time, result.time, column) for column in result.post_axis[:, i].T], axis=1)
        axis /= np.linalg.norm(axis, axis=1, keepdims=True)
        x, y, z = axis.T
        # The shortest rotation from the vertical: about (-y, x, 0) by the tilt, whose cosine is z.
        per = 1.0 / (1.0 + z)
        turn[:, i] = np.stack(
            [
                np.stack([1.0 - per * x * x, -per * x * y, x], axis=1),
                np.stack([-per * x * y, 1.0 - per * y * y, y], axis=1),
                np.stack([-x, -y, z], axis=1),
            ],
            axis=1,
        )
    return ElementMotion(center, np.zeros((len(time), len(parts), 3)), turn)
