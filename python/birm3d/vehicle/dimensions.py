"""How long, wide and high a vehicle is, and where its wheels stand."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

__all__ = ["Dimensions", "dimensions"]

Floats = npt.NDArray[np.float64]

# Wheels belong to one axle where their centres are this near to each other along the vehicle [m].
_AXLE = 0.1


class Dimensions(NamedTuple):
    """Of a vehicle at rest [m]; see :attr:`birm3d.Vehicle.length` and those beside it."""

    length: float
    width: float
    height: float
    wheelbase: float | None
    track: float | None


def dimensions(nodes: Floats, wheels: Floats, mass_center_height: float) -> Dimensions:
    """Return the dimensions of an uncrushed vehicle.

    Parameters
    ----------
    nodes
        Of the skin and of the treads, body axes, shape (n, 3) [m].
    wheels
        Centres and radius, shape (w, 4) [m].
    mass_center_height
        Above the ground [m].
    """
    low, high = nodes.min(axis=0), nodes.max(axis=0)
    if len(wheels) == 0:
        wheelbase = track = None
    else:
        x, y, _, radius = wheels.T
        low[0], high[0] = min(low[0], (x - radius).min()), max(high[0], (x + radius).max())
        low[1], high[1] = min(low[1], y.min()), max(high[1], y.max())
        front = y[x >= x.max() - _AXLE]
        wheelbase, track = _apart(x), _apart(front)
    length, width, _ = (high - low).tolist()
    return Dimensions(length, width, float(high[2]) + mass_center_height, wheelbase, track)


def _apart(places: Floats) -> float | None:
    """Distance of the outermost places, ``None`` where they are one."""
    distance = float(np.ptp(places))
    return distance if distance > _AXLE else None
