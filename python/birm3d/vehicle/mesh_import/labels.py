"""Panel and block of each triangle of a skin, by which zones find what is theirs."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ..file_schema import Exterior
from ..mesher import match_zones
from ..skin_mesh import PANELS
from ..vehicle_file import VehicleFile

__all__ = ["labelled"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

_END = 0.25  # m behind what bow and profile of an end explain: a panel that looks ahead is no front there

# Elements at the rounded edges between an end and its neighbours belong to the end. So a skin that is laid
# around a preset has the preset's areas of front and rear, within 3 %.
_ENDS_FIRST = 1.8


def labelled(file: VehicleFile, points: Floats, faces: Ints) -> tuple[Ints, Ints]:
    """Return panel and block of triangles, indices into the panels and the exterior's blocks, (m,) each.

    A panel is what the normal looks at most: ahead, back, aside, up or down. The block is an upper one above
    the upper edge of the body that the outline of the file has there. Where no zone would hold a triangle,
    the nearest panel and block that one does are taken.

    Raises
    ------
    ValueError
        If no zone of the file holds some of the triangles.
    """
    corners = points[faces]
    middle = corners.mean(axis=1)
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1), 1e-30)[:, None]
    block = _blocks(file.exterior, middle)
    looks = np.column_stack([normal[:, 0], -normal[:, 0], np.abs(normal[:, 1]), normal[:, 2], -normal[:, 2]])
    looks[:, :2] *= _ENDS_FIRST
    front, rear = _ends(file.exterior, points)
    looks[(block == 0) & (middle[:, 0] < front), PANELS.index("front")] = -1.0
    looks[(block == 0) & (middle[:, 0] > rear), PANELS.index("rear")] = -1.0
    order = np.argsort(-looks, axis=1, kind="stable")
    panel = order[:, 0].copy()
    zone = match_zones(file, middle, panel, block)
    names = file.exterior.blocks
    for choice in range(len(PANELS)):
        for other in (-1, *range(len(names))):
            open_ = np.flatnonzero(zone < 0)
            if len(open_) == 0:
                return panel, block
            trial = block[open_] if other < 0 else np.full(len(open_), other)
            found = match_zones(file, middle[open_], order[open_, choice], trial)
            hit = open_[found >= 0]
            panel[hit], block[hit] = order[hit, choice], trial[found >= 0]
            zone[hit] = found[found >= 0]
    if (zone < 0).any():
        at = ", ".join(f"{value:.3f}" for value in middle[zone < 0][0])
        raise ValueError(f"zones must hold every triangle of the skin, got none at ({at}) m")
    return panel, block


def _blocks(exterior: Exterior, middle: Floats) -> Ints:
    x, _, _, top = np.array(exterior.stations_m)[::-1].T
    edge = np.interp(middle[:, 0], x, top)
    block = np.zeros(len(middle), np.int64)
    for number, upper in enumerate(exterior.upper, 1):
        ahead, behind = upper.base_x_m
        block[(middle[:, 2] > edge) & (behind <= middle[:, 0]) & (middle[:, 0] <= ahead)] = number
    return block


def _ends(exterior: Exterior, points: Floats) -> tuple[float, float]:
    """Return how far back a front and how far ahead a rear of the body may be [m]."""
    depths = [
        end.bow_m + max((row[1] for row in end.profile_m), default=0.0) + _END
        for end in (exterior.front, exterior.rear)
    ]
    return float(points[:, 0].max() - depths[0]), float(points[:, 0].min() + depths[1])
