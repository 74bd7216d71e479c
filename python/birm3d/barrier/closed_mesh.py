"""Whether triangles close a solid: contact needs to know on which side of them a point is."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

__all__ = ["check_closed"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


def check_closed(vertices: Floats, faces: Ints, ground: float) -> None:
    """Refuse triangles with a hole.

    At every edge as many triangles must run one way along it as the other way. Corners at the same place
    count as one. Edges on or below the ground may be open: nothing comes from there. The core refuses
    triangles that do not all turn the same way.

    Parameters
    ----------
    vertices, faces
        Shapes (n, 3) [m] and (m, 3).
    ground
        Height of the ground in the axes of the vertices [m].

    Raises
    ------
    ValueError
        Naming how many edges are open, and the first of them.
    """
    places, which = np.unique(vertices, axis=0, return_inverse=True)
    corners = which.reshape(-1)[faces]
    edges = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    edges = edges[edges[:, 0] != edges[:, 1]]  # of triangles that are no more than a line
    forward = edges[:, 0] < edges[:, 1]
    pairs, edge = np.unique(np.sort(edges, axis=1), axis=0, return_inverse=True)
    balance = np.zeros(len(pairs), np.int64)
    np.add.at(balance, edge.reshape(-1), np.where(forward, 1, -1))
    standing = (places[pairs][:, :, 2] <= ground).all(axis=1)
    wrong = (balance != 0) & ~standing
    if not wrong.any():
        return
    first = int(np.flatnonzero(wrong)[0])
    a, b = (", ".join(f"{value:g}" for value in place) for place in places[pairs[first]])
    where = f"the first from ({a}) to ({b}) m"
    raise ValueError(
        f"faces must close a solid, got a hole: {wrong.sum()} edges have no second face, {where}"
    )
