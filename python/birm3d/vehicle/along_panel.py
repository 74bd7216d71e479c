"""Second trusses of the shell's nodes, along the vehicle: what a panel resists in its own plane.

A side panel's trusses point sideways. A wall or a corner that ploughs along the side meets fenders, doors and
sills, which carry load lengthways. Zones say so by a second law, ``[zone.<name>.along]`` in the file.

The node of a second truss stands where the first one's does. The truss runs level along the vehicle, to the
rear, or to the front for nodes behind the rigid core. It is long, so that it hardly turns while it is
pressed; its anchor is no point of the vehicle.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .mesher import ExteriorMesh
from .vehicle_file import VehicleFile

__all__ = ["AlongPanel", "build_along"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

_LENGTH = 3.0  # m, of the trusses


@dataclass(frozen=True, eq=False)
class AlongPanel:
    """Second trusses: SI units, file axes (x forward, y left, z up).

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


def build_along(file: VehicleFile, mesh: ExteriorMesh) -> AlongPanel:
    """Return the second trusses of the zones that have a law along their panel; maybe none."""
    rear = min(box.x_m[0] for box in file.core)
    names = list(file.laws)
    law = np.full(len(file.zones), -1, np.int64)
    for index, zone in enumerate(file.zones):
        if zone.along is not None:
            law[index] = names.index(zone.along_name)
    of = np.flatnonzero(law[mesh.zone] >= 0)
    nodes = mesh.nodes[of]
    offset = np.where(nodes[:, :1] > rear, -_LENGTH, _LENGTH) * np.array([1.0, 0.0, 0.0])
    return AlongPanel(nodes, nodes + offset, mesh.area[of], law[mesh.zone[of]], of)
