"""What the units of a vehicle look like, for pictures."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from .vehicle import Vehicle

__all__ = ["UnitShape", "unit_shapes"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


@dataclass(frozen=True)
class UnitShape:
    """Skin and wheels of one unit in its body axes, origin at its mass centre, uncrushed.

    Attributes
    ----------
    nodes, anchors
        Shape (n, 3) [m].
    quads
        Shape (m, 4), counter-clockwise seen from outside; empty where the unit has no skin.
    zone_of_node
        Shape (n,), index into ``zone_names``; -1 for a node without a zone.
    zone_names
        Names of the stiffness zones.
    wheels
        Shape (w, 4): centre and radius [m].
    height
        Of the mass centre above the ground at rest [m].
    """

    nodes: Floats
    anchors: Floats
    quads: Ints
    zone_of_node: Ints
    zone_names: tuple[str, ...]
    wheels: Floats
    height: float


def unit_shapes(vehicle: Vehicle) -> tuple[UnitShape, ...]:
    """Return the shapes of the units of a vehicle, in the order of the result's units."""
    return tuple(
        UnitShape(
            nodes=unit.nodes,
            anchors=unit.anchors,
            quads=unit.quads,
            zone_of_node=unit.zone_of_node,
            zone_names=tuple(unit.zones),
            wheels=unit.wheels,
            height=unit.mass_center_height,
        )
        for unit in vehicle.units
    )
