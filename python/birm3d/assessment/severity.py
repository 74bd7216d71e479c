"""Acceleration severity index of EN 1317-1 in its two editions."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from .. import units
from ..signals.filters import cfc
from .pulse import Pulse

__all__ = ["severity_index"]

Floats = npt.NDArray[np.float64]

LIMITS_G = (12.0, 9.0, 10.0)
"""Accelerations along x, y, z at which a belted occupant is at the limit of slight injuries [g]."""
_WINDOW = 50e-3  # of the mean, edition of 1998 [s]
# Edition of 2010: four poles without phase, 3 dB down at 13 Hz; a class of J211-1 is so at class / 0.6.
_CLASS = 13.0 * 0.6
# Free motion that the filter is given before and after the record [s].
_BEFORE = 0.25


def severity_index(pulse: Pulse, edition: int) -> float:
    """Return the acceleration severity index, its greatest value from time zero on.

    ASI = max sqrt((ax / 12 g)^2 + (ay / 9 g)^2 + (az / 10 g)^2) of smoothed components. The edition of 1998
    smooths by 50-ms means, that of 2010 by a four-pole Butterworth low-pass of 13 Hz, run forward and back.
    """
    pulse.require_axes("ASI", "x", "y", "z")
    if edition not in (1998, 2010):
        raise ValueError(f"edition of EN 1317-1 must be 1998 or 2010, got {edition}")
    pulse.require(_WINDOW, "the acceleration severity index")
    smooth = pulse.change_over(_WINDOW) if edition == 1998 else _filtered(pulse)
    return float(np.linalg.norm(smooth / np.array(LIMITS_G), axis=1).max())


def _filtered(pulse: Pulse) -> Floats:
    """Return the components after the filter of 2010, from time zero on, shape (k, 3) [g]."""
    dt = pulse.interval
    means = np.diff(pulse.velocity, axis=0) / (dt * units.g)
    recorded = pulse.time[1:] <= pulse.end + 0.5 * dt
    before, after = np.zeros((round(_BEFORE / dt), 3)), np.zeros((round(_BEFORE / dt), 3))
    if not pulse.settled:
        after += means[recorded][-1]
    smooth = cfc(np.concatenate([before, means[recorded], after]), _CLASS, dt)
    first = len(before) + pulse.zero
    return smooth[first : len(before) + int(recorded.sum())]
