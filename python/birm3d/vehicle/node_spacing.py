"""How far apart the nodes of a skin are."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

__all__ = ["node_spacing"]

Floats = npt.NDArray[np.float64]

# Neighbours among which the nearest beside a node is looked for, and nodes for which it is.
_NEIGHBOURS = 16
_SAMPLE = 4096


def node_spacing(nodes: Floats) -> float:
    """Return the median distance of nodes (n, 3) from the nearest other beside them [m].

    Beside: further away along the ground than up or down. Infinite where most nodes have none, as one node
    or one column.
    """
    from scipy.spatial import cKDTree

    if len(nodes) == 1:
        return math.inf
    some = nodes[:: max(1, len(nodes) // _SAMPLE)]
    distance, which = cKDTree(nodes).query(some, k=min(len(nodes), _NEIGHBOURS + 1))
    apart = np.abs(nodes[which] - some[:, None])
    beside = np.hypot(apart[..., 0], apart[..., 1]) > apart[..., 2]
    return float(np.median(np.where(beside, distance, np.inf).min(axis=1)))
