"""The skin of the vehicle over time, for pictures.

A run keeps no frames: it pays nothing for pictures that nobody asked for; see :mod:`birm3d.result.capture`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

__all__ = ["Frames", "frame_times", "pose"]

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Frames:
    """Places of the shell nodes at chosen instants.

    Attributes
    ----------
    time : ndarray, shape (k,)
        Increasing [s].
    displacement : tuple of ndarray, each of shape (k, n, 3), float32
        For each unit of the vehicle: shell nodes less uncrushed shell nodes, body axes [m].
    """

    time: Floats
    displacement: tuple[npt.NDArray[np.float32], ...]

    def __post_init__(self) -> None:
        self.time.setflags(write=False)
        for array in self.displacement:
            array.setflags(write=False)

    def __len__(self) -> int:
        return len(self.time)

    def displacement_at(self, time: float, unit: int = 0) -> Floats:
        """Return the displacement of one unit's nodes at an instant [m], shape (n, 3), linear between frames.

        Raises
        ------
        ValueError
            If the time is before the first frame or after the last one.
        """
        first, last = float(self.time[0]), float(self.time[-1])
        if not first <= time <= last:
            raise ValueError(
                f"time must be between the first and last frame, {first:g} to {last:g} s, got {time}"
            )
        rows = self.displacement[unit]
        i = int(np.clip(np.searchsorted(self.time, time, side="right") - 1, 0, max(0, len(self) - 2)))
        here: Floats = rows[i].astype(float)
        if len(self) == 1:
            return here
        share = (time - float(self.time[i])) / float(self.time[i + 1] - self.time[i])
        return np.asarray(here + share * (rows[i + 1] - here))


def frame_times(time: Floats, frames: int | Sequence[float] | npt.NDArray[np.float64]) -> Floats:
    """Return the instants of wanted frames [s].

    A number gives instants of the result's rows, as evenly spread as those allow, from first to last.

    Raises
    ------
    ValueError
        If the number is below 2 or above the number of rows, or the instants do not increase within the run.
    """
    if isinstance(frames, (int, np.integer)):
        if not 2 <= frames <= len(time):
            raise ValueError(
                f"frames must be 2 to {len(time)}, the number of the result's rows, got {frames}"
            )
        rows = np.round(np.linspace(0, len(time) - 1, int(frames))).astype(int)
        return np.array(time[rows])
    instants = np.array(frames, float)
    if instants.ndim != 1 or len(instants) == 0:
        raise ValueError(f"frames must be a number or a list of instants, got shape {instants.shape}")
    if not (np.isfinite(instants).all() and (np.diff(instants) > 0.0).all()):
        raise ValueError(f"frames must be finite and increase, got {instants.tolist()}")
    if instants[0] < time[0] or instants[-1] > time[-1]:
        raise ValueError(
            f"frames must be within {time[0]:g} to {time[-1]:g} s, got {instants[0]:g} to {instants[-1]:g} s"
        )
    return instants


def pose(
    time: Floats, position: Floats, roll_pitch_yaw: Floats, instants: npt.ArrayLike
) -> tuple[Floats, Floats]:
    """Return mass centres (k, 3) [m] and rotation matrices body to world (k, 3, 3) at some instants.

    Positions are linear between the rows, orientations turn at a constant rate (slerp).

    Parameters
    ----------
    time, position, roll_pitch_yaw
        Rows: shape (n,) [s], (n, 3) [m], (n, 3) [rad].
    instants
        Shape (k,), within the rows [s].
    """
    from scipy.spatial.transform import Rotation, Slerp

    at = np.atleast_1d(np.asarray(instants, float))
    if not (np.isfinite(at).all() and (at >= time[0]).all() and (at <= time[-1]).all()):
        raise ValueError(
            f"time must be within {time[0]:g} to {time[-1]:g} s, got {np.asarray(instants).tolist()}"
        )
    centers = np.column_stack([np.interp(at, time, position[:, i]) for i in range(3)])
    rotations = Rotation.from_euler("ZYX", roll_pitch_yaw[:, ::-1])
    turned = rotations[np.zeros(len(at), int)] if len(time) == 1 else Slerp(time, rotations)(at)
    return centers, np.asarray(turned.as_matrix())
