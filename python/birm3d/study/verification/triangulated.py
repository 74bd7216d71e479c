"""A barrier's triangulated copy: what the paper's vertex-to-face algorithm makes of it."""

from __future__ import annotations

import numpy as np

from ...barrier.barrier import Barrier
from ...barrier.kinds import MeshBarrier
from ...barrier.surfaces import barrier_axes, barrier_surfaces

__all__ = ["triangulated"]

# An endless barrier reaches this far along its line and up: further than any vehicle goes [m].
_ALONG = 200.0
_UP = 20.0


def triangulated(barrier: Barrier | None) -> MeshBarrier | None:
    """Return the barrier as one mesh; ``None`` where there is none to make.

    That is without a barrier, of one that is a mesh already, and of one that stands free: meshes are fixed.
    Cylinders get 48 sides with their corners on the cylinder. The copy is one element, and indentations
    (:meth:`birm3d.Vehicle.with_indentation_length`) are made by exact posts only.
    """
    if barrier is None or isinstance(barrier, MeshBarrier) or barrier.stands_free() is not None:
        return None
    origin = np.asarray(barrier.origin)
    along, out, up = barrier_axes(barrier)
    # Where the exact shape goes on below the ground, which blocks of laboratories do not have.
    far = origin + np.array([_ALONG * along, -_ALONG * along, _UP * up])
    vertices, faces, count = [], [], 0
    for points, triangles in barrier_surfaces(barrier, far):
        local = (points - origin) @ np.stack([-out, along, up]).T
        if barrier.is_bottomless:
            local[local[:, 2] == 0.0, 2] = -_UP
        vertices.append(local)
        faces.append(triangles + count)
        count += len(points)
    return Barrier.from_mesh(
        np.concatenate(vertices),
        np.concatenate(faces),
        friction=barrier.friction,
        origin=barrier.origin,
        heading=barrier.heading,
    )
