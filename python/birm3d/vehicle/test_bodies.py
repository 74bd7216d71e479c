"""Vehicles of laboratories: simple bodies whose crashes have exact answers, or whose parts are easy to see.

Scenes that use them are in :mod:`birm3d.scenes`, which has their names too.
"""

from __future__ import annotations

import math

import numpy as np

from ..base.arguments import checked
from ..base.checks import MOST_NODES, whole_number
from .joint import Joint
from .vehicle import ArticulatedVehicle, Vehicle

__all__ = ["elastic_block", "laboratory_block", "laboratory_semi"]


@checked
def laboratory_block(
    n: int,
    *,
    k_initial: float,
    k_unloading: float,
    knee: float = math.inf,
    k_hardening: float = 0.0,
    stagger: float = 0.0,
) -> Vehicle:
    """Return a 15,000-lb body with `n` equal trusses on a flat front face of 2.4 m by 1.6 m.

    Stiffnesses are those of all trusses together [N/m]. `stagger` spreads the nodes over that depth [m] by a
    fixed pattern.
    """
    whole_number("n", n, most=MOST_NODES)
    across = math.isqrt(n * 3 // 2)
    while n % across:
        across -= 1
    y, z = np.meshgrid(np.linspace(-1.2, 1.2, across), np.linspace(-0.8, 0.8, n // across))
    x = 3.0 - stagger * (np.arange(n) * 0.6180339887498949 % 1.0)
    nodes = np.column_stack([x, y.ravel(), z.ravel()])
    return Vehicle.from_arrays(
        name="laboratory_block",
        mass=6804.0,
        inertia=np.diag([5000.0, 40000.0, 42000.0]),
        nodes=nodes,
        anchors=nodes - [2.0, 0.0, 0.0],
        k_initial=k_initial / n,
        knee=knee,
        k_hardening=k_hardening / n,
        k_unloading=k_unloading / n,
    )


@checked
def laboratory_semi(*, front: float = 4e6, side: float = 2e6) -> ArticulatedVehicle:
    """Return a 72,000-lb tractor and semi-trailer, both boxes: a laboratory, not a model of a truck.

    Three axles and 8,633 kg in front, two axles and 24,026 kg behind, fifth wheel 1.2 m above the ground.
    Mass and layout are those of common trucks, rounded; inertia is that of the boxes; stiffness is even.

    Parameters
    ----------
    front, side
        Stiffness of the tractor's front face, and of each side of both units, all trusses together [N/m].
    """
    tractor = _box("tractor", 8633.0, 1.0, (2.2, -4.2), 2.4, (0.4, 2.8), front, side, axles=(0.9, -2.7, -4.0))
    trailer = _box("trailer", 24025.7, 1.95, (6.8, -6.8), 2.5, (1.2, 4.0), front, side, axles=(-3.9, -5.2))
    return Vehicle.articulated([tractor, trailer], Joint((-3.1, 0.0, 1.2), (5.9, 0.0, 1.2)))


def _box(
    name: str,
    mass: float,
    height: float,
    ends: tuple[float, float],
    width: float,
    heights: tuple[float, float],
    front: float,
    side: float,
    axles: tuple[float, ...],
) -> Vehicle:
    """Return a box with a crushable front and sides and tyres of 0.5 m radius below its sides.

    `ends` from the mass centre, which stands `height` above the ground [m].
    """
    length, depth = ends[0] - ends[1], heights[1] - heights[0]
    levels = np.linspace(*heights, 4) - height
    y, z = np.meshgrid(np.linspace(-0.5, 0.5, 7) * width, levels)
    faces = [np.column_stack([np.full(y.size, ends[0]), y.ravel(), z.ravel()])]
    inward = [np.tile([-1.8, 0.0, 0.0], (y.size, 1))]
    # The sides begin where the front's trusses end: a closed side truss would be the rigid body at the wall.
    x, z = np.meshgrid(np.linspace(ends[0] - 1.8, ends[1], 12), levels)
    for left in (0.5, -0.5):
        faces.append(np.column_stack([x.ravel(), np.full(x.size, left * width), z.ravel()]))
        inward.append(np.tile([0.0, -1.6 * left, 0.0], (x.size, 1)))
    nodes = np.concatenate(faces)
    k_initial = np.repeat([front / y.size, side / x.size, side / x.size], [len(face) for face in faces])
    return Vehicle.from_arrays(
        name=name,
        mass=mass,
        inertia=mass / 12.0 * np.diag([width**2 + depth**2, length**2 + depth**2, length**2 + width**2]),
        nodes=nodes,
        anchors=nodes + np.concatenate(inward),
        k_initial=k_initial,
        knee=0.3,
        k_hardening=k_initial,
        k_unloading=20.0 * k_initial,
        mass_center_height=height,
        wheels=[(axle, 0.4 * left * width, 0.5 - height, 0.5) for axle in axles for left in (1.0, -1.0)],
    )


@checked
def elastic_block(n: int) -> Vehicle:
    """Return the body of W1: 3 MN/m, elastic."""
    return laboratory_block(n, k_initial=3e6, k_unloading=3e6)
