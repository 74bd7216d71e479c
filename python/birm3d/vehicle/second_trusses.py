"""Second trusses of the shell's nodes: what a panel resists along and across the vehicle.

A side panel's trusses point to the rigid core. Two resistances are missing in them; zones add each by a
second law. ``[zone.<name>.along]``: a wall or a corner that ploughs along the side meets fenders, doors and
sills, which carry load lengthways. ``[zone.<name>.across]``: ahead of the rigid core the trusses slant back
to it, and a post would go in beside it. Rails, springs and the engine are in its way.

The node of a second truss stands where the first one's does. The truss is level: along the vehicle to the
rear, or to the front for nodes behind the rigid core; across it to the same place of the other side. It is
long, so that it hardly turns while it is pressed; its anchor is no point of the rigid core.

Trusses across are where the side is straight and its own trusses slant. Beside the rigid core these point
across already. Where the side turns into the front or rear, what a post draws in goes in with that.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .mesher import ExteriorMesh
from .vehicle_file import VehicleFile

__all__ = ["SecondTrusses", "build_second"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

_LENGTH = 3.0  # m, of trusses along the vehicle
_CORNER_SLOPE = 0.2  # of the outline from above against the vehicle's axis: where it is more, the side ends
_BESIDE = 1e-6  # m along the vehicle, by which a node is still beside its anchor


@dataclass(frozen=True, eq=False)
class SecondTrusses:
    """Second trusses, those along the vehicle first: SI units, file axes (x forward, y left, z up).

    Attributes
    ----------
    nodes, anchors
        Ends of the trusses, shape (n, 3) [m].
    area
        Tributary area of the nodes, shape (n,) [m^2].
    zone
        Index of the law into :attr:`VehicleFile.laws`, shape (n,).
    of
        Number of the node of the shell that each truss is a second one of, shape (n,).
    """

    nodes: Floats
    anchors: Floats
    area: Floats
    zone: Ints
    of: Ints


def build_second(file: VehicleFile, mesh: ExteriorMesh) -> SecondTrusses:
    """Return the second trusses of the zones that have a law along or across the vehicle; maybe none."""
    rear = min(box.x_m[0] for box in file.core)
    along, across = mesh.nodes.copy(), mesh.nodes * (1.0, -1.0, 1.0)
    along[:, 0] += np.where(mesh.nodes[:, 0] > rear, -_LENGTH, _LENGTH)
    along_law = _laws_of_nodes(file, mesh, [zone.along_name for zone in file.zones])
    across_law = _laws_of_nodes(file, mesh, [zone.across_name for zone in file.zones])
    of = (
        np.flatnonzero(along_law >= 0),
        np.flatnonzero((across_law >= 0) & _is_straight(mesh) & _slants(mesh)),
    )
    nodes = np.concatenate(of)
    anchors = np.concatenate([along[of[0]], across[of[1]]])
    law = np.concatenate([along_law[of[0]], across_law[of[1]]])
    return SecondTrusses(mesh.nodes[nodes], anchors, mesh.area[nodes], law, nodes)


def _laws_of_nodes(file: VehicleFile, mesh: ExteriorMesh, names: list[str]) -> Ints:
    """Return the index of the law that each node's zone has under its name, -1 for none, shape (n,)."""
    place = {name: index for index, name in enumerate(file.laws)}
    return np.array([place.get(name, -1) for name in names], np.int64)[mesh.zone]


def _slants(mesh: ExteriorMesh) -> npt.NDArray[np.bool_]:
    """Return which nodes are ahead of or behind the core boxes that their trusses start from, shape (n,)."""
    return np.abs(mesh.anchors[:, 0] - mesh.nodes[:, 0]) > _BESIDE


def _is_straight(mesh: ExteriorMesh) -> npt.NDArray[np.bool_]:
    """Return which nodes are of an element on a side's straight part, shape (n,)."""
    corner = mesh.nodes[mesh.quads]
    x, y, z = np.abs(np.cross(corner[:, 2] - corner[:, 0], corner[:, 3] - corner[:, 1])).T
    straight = np.zeros(len(mesh.nodes), bool)
    straight[mesh.quads[(x <= _CORNER_SLOPE * y) & (z < y)]] = True
    return straight
