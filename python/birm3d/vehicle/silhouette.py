"""Outline of a vehicle's unit as seen from above."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import shapely

from .unit_shapes import UnitShape

__all__ = ["Outline", "rings", "silhouette"]

Floats = npt.NDArray[np.float64]
Outline: TypeAlias = Any
"""A polygon of shapely, or several, world x and y [m]."""

# Triangles whose plan is smaller stand upright and cover nothing [m^2].
_LEAST_AREA = 1e-12


def silhouette(shape: UnitShape, nodes: Floats, center: Floats, turn: Floats) -> Outline:
    """Return the outline seen from above: the union of the faces of the skin, projected on the ground.

    A unit without a skin has the convex hull of its nodes and anchors.

    Parameters
    ----------
    shape
        The unit.
    nodes
        Its shell nodes now, body axes, shape (n, 3) [m].
    center, turn
        Mass centre (3,) [m] and rotation body to world (3, 3).
    """
    if len(shape.quads) == 0:
        points = (center + np.vstack([nodes, shape.anchors]) @ turn.T)[:, :2]
        return shapely.MultiPoint(points).convex_hull
    plan = (center + nodes @ turn.T)[:, :2]
    triangles = plan[np.vstack([shape.quads[:, [0, 1, 2]], shape.quads[:, [0, 2, 3]]])]
    zone = np.tile(shape.zone_of_node[shape.quads[:, 0]], 2)
    u, v = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    area = 0.5 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    sheets = [
        _sheet(triangles[(zone == one) & (side * area > _LEAST_AREA)])
        for one in np.unique(zone)
        for side in (1.0, -1.0)
    ]
    return shapely.union_all(sheets)


def rings(outline: Outline) -> list[Floats]:
    """Return the outer rings of an outline, shape (m, 2) each, the greatest first; holes are left out."""
    parts = [part for part in shapely.get_parts(outline) if part.geom_type == "Polygon"]
    if not parts:  # nothing that has an area
        return [shapely.get_coordinates(outline)]
    parts.sort(key=lambda part: -float(part.area))
    return [shapely.get_coordinates(part.exterior)[:-1] for part in parts]


def _sheet(triangles: Floats) -> Outline:
    """Return the union of triangles (k, 3, 2) of one part of the skin that all look up, or all down.

    Mostly they lie side by side. Then dropping the edges that two of them share gives their union, 20 times
    faster than the union of any triangles. They do so if the result is valid and has the sum of their areas:
    all turn the same way, so that no overlap can cancel another.
    """
    polygons = shapely.polygons(triangles)
    total = float(shapely.area(polygons).sum())
    try:
        beside = shapely.coverage_union_all(polygons)
    except shapely.GEOSException:  # its way to say that some overlap
        return shapely.union_all(polygons)
    if shapely.is_valid(beside) and abs(shapely.area(beside) - total) <= 1e-9 * total:
        return beside
    return shapely.union_all(polygons)
