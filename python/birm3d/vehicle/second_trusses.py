"""Second trusses of the shell's nodes: what a panel resists along and across the vehicle.

A side panel's trusses point to the rigid core. Two resistances are missing in them; zones add each by a
second law. ``[zone.<name>.along]``: a wall or a corner that ploughs along the side meets fenders, doors and
sills, which carry load lengthways. ``[zone.<name>.across]``: ahead of the rigid core the trusses slant back
to it, and a post would go in beside it. Rails, springs and the engine are in its way.

The node of a second truss stands where the first one's does. The truss is level: along the vehicle to the
rear, or to the front for nodes behind the rigid core; across it to the same place of the other side. It is
long, so that it hardly turns while it is pressed; its anchor is no point of the rigid core.

Trusses across have the area of elements on the side's straight part. Where the side turns into the front,
what a post draws in goes in with the front. They have none of it beside the rigid core, where the side's own
trusses point across. They have all of it from the radius of a usual pole ahead of the core.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .mesher import ExteriorMesh, node_areas
from .vehicle_file import VehicleFile

__all__ = ["SecondTrusses", "build_second"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

_LENGTH = 3.0  # m, of trusses along the vehicle
_BESIDE_CORE = 0.15  # m, ahead of the rigid core: a pole of 0.3 m further ahead passes the core
_CORNER_SLOPE = 0.2  # of the outline from above against the vehicle's axis: where it is more, the side ends


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
    place = {name: index for index, name in enumerate(file.law_names)}
    along_law = _laws_of_nodes(mesh, [place.get(zone.along_name, -1) for zone in file.zones])
    across_law = _laws_of_nodes(mesh, [place.get(zone.across_name, -1) for zone in file.zones])
    # An element's nodes are of one zone, so that elements of other zones add nothing to nodes with a law.
    area_across = _straight_area(mesh, mesh.quads[across_law[mesh.quads[:, 0]] >= 0]) * _share_across(mesh)
    of = (np.flatnonzero(along_law >= 0), np.flatnonzero(area_across > 0.0))
    nodes = np.concatenate(of)
    anchors = np.concatenate([along[of[0]], across[of[1]]])
    area = np.concatenate([mesh.area[of[0]], area_across[of[1]]])
    law = np.concatenate([along_law[of[0]], across_law[of[1]]])
    return SecondTrusses(mesh.nodes[nodes], anchors, area, law, nodes)


def _laws_of_nodes(mesh: ExteriorMesh, laws: list[int]) -> Ints:
    """Return the index of the law that each node's zone has, -1 for none, shape (n,)."""
    return np.array(laws, np.int64)[mesh.zone]


def _share_across(mesh: ExteriorMesh) -> Floats:
    """Return how much of a node's area its truss across has, by its place ahead of its anchor, shape (n,)."""
    return np.asarray(np.clip((mesh.nodes - mesh.anchors)[:, 0] / _BESIDE_CORE, 0.0, 1.0))


def _straight_area(mesh: ExteriorMesh, quads: Ints) -> Floats:
    """Return the nodes' share of the area of those elements that are on the side's straight part [m^2]."""
    corner = mesh.nodes[quads]
    x, y, z = np.abs(np.cross(corner[:, 2] - corner[:, 0], corner[:, 3] - corner[:, 1])).T  # normals
    return node_areas(mesh.nodes, quads[(x <= _CORNER_SLOPE * y) & (z < y)])
