"""From where the crush of a vehicle is best seen."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from ..barrier.surfaces import barrier_axes
from ..vehicle.unit_shapes import unit_shapes
from .skin import Skin

if TYPE_CHECKING:
    from .result import Result

__all__ = ["crushed_direction"]

Floats = npt.NDArray[np.float64]

# Crush below this is not looked for [m]; of what is crushed, nodes above this share of the greatest count.
_LEAST_CRUSH, _CRUSHED = 0.02, 0.25
_ASIDE = 40.0  # by which the viewer stands beside the direction of a crushed side, 0 at a corner, deg


def crushed_direction(result: Result, skins: Sequence[Skin]) -> Floats | None:
    """Return the level direction from which the greatest residual crush is best seen, a unit vector.

    It is that of the crushed nodes from the middle of their unit, in parts of its length and width: a
    crushed corner is seen from the corner. A crushed side is seen from beside its middle, where the barrier
    hides less; of two such places from the left one.

    Parameters
    ----------
    skins
        Of all units at an instant: their poses then are used.

    Returns
    -------
    ndarray of shape (3,) or None
        World axes; ``None`` where nothing is crushed.
    """
    best, direction = _LEAST_CRUSH, None
    for unit, (shape, skin) in enumerate(zip(unit_shapes(result.scene.vehicle), skins, strict=True)):
        corners = np.unique(shape.quads)
        if len(corners) == 0:
            continue
        nodes = shape.nodes[corners]
        crush = np.linalg.norm(result.final_nodes(unit)[corners] - nodes, axis=1)
        if crush.max() <= best:
            continue
        best = float(crush.max())
        middle, half = 0.5 * (nodes.max(axis=0) + nodes.min(axis=0)), 0.5 * np.ptp(nodes, axis=0)
        weight = np.where(crush > _CRUSHED * best, crush, 0.0)
        place = (weight @ ((nodes - middle) / half) / weight.sum())[:2]
        direction = _beside(place, skin.rotation, barrier_axes(result.scene.barrier)[1])
    return direction


def _beside(place: Floats, rotation: Floats, out: Floats) -> Floats:
    angle = np.arctan2(place[1], place[0])
    aside = np.radians(_ASIDE) * (1.0 - abs(np.sin(2.0 * angle)))
    looks = []
    for sign in (1.0, -1.0):
        look = rotation @ np.array([np.cos(angle + sign * aside), np.sin(angle + sign * aside), 0.0])
        look[2] = 0.0
        looks.append(look / max(float(np.linalg.norm(look)), 1e-9))
    left, right = looks
    return np.asarray(left if left @ out >= right @ out - 1e-6 else right)
