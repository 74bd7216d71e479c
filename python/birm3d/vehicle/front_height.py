"""How high the structure of a vehicle's front stands above the ground."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from .zone import Zone

__all__ = ["strong_height"]

Floats = npt.NDArray[np.float64]

_CRUSH = 0.3  # m: of bumper beam and rail ends, before an engine is met
_POINTS = 61
_SHARE = 2.0 / 3.0  # with a third above it, a front is bent or rides over; chosen by hand


def strong_height(
    nodes: Floats, inwards: Floats, area: Floats, zone_of_node: npt.NDArray[np.int64], zones: Sequence[Zone]
) -> float | None:
    """Return the height above the ground below which two thirds of the front's resistance stand [m].

    What resists is the work that the front takes up in its first 0.3 m. ``None`` if there is no front.

    Parameters
    ----------
    nodes : ndarray, shape (n, 3)
        Nodes of the skin, z from the ground [m].
    inwards : ndarray, shape (n, 3)
        From there to their anchors [m].
    area : ndarray, shape (n,)
        Of the skin that each stands for [m^2].
    zone_of_node : ndarray of int, shape (n,)
        Which of `zones` each is in.
    zones
        Laws of the skin.
    """
    front = -inwards[:, 0] >= np.abs(inwards[:, 1:]).max(axis=1)
    depth = np.linspace(0.0, _CRUSH, _POINTS)
    each = [np.trapezoid([zone.curve.envelope(d) for d in depth.tolist()], depth) for zone in zones]
    work = np.array(each)[zone_of_node[front]] * area[front]
    if not work.sum() > 0.0:
        return None
    rows, row_of_node = np.unique(nodes[front, 2].round(3), return_inverse=True)
    of_row = np.bincount(row_of_node.reshape(-1), weights=work)
    below = np.cumsum(of_row) - 0.5 * of_row  # a row's elements reach half way to its neighbours
    return float(np.interp(_SHARE * of_row.sum(), below, rows))
