"""Outline of a vehicle's unit as seen from above."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import shapely

from .unit_shapes import UnitShape

__all__ = ["Outline", "rings", "silhouette"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]
Outline: TypeAlias = Any
"""A polygon of shapely, or several, world x and y [m]."""

# Triangles whose plan is smaller stand upright and cover nothing [m^2].
_LEAST_AREA = 1e-12
# Points as near to each other are one [m].
_PLACE = 1e-7


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
    # Nodes at one place are one, so that panels that lie beside each other share their edges.
    places, which = _at_one_place((center + nodes @ turn.T)[:, :2])
    triangles = which[np.vstack([shape.quads[:, [0, 1, 2]], shape.quads[:, [0, 2, 3]]])]
    area = _areas(places[triangles])
    return shapely.union_all([_sheet(places, triangles[side * area > _LEAST_AREA]) for side in (1.0, -1.0)])


def rings(outline: Outline) -> list[Floats]:
    """Return the outer rings of an outline, shape (m, 2) each, the greatest first; holes are left out."""
    parts = [part for part in shapely.get_parts(outline) if part.geom_type == "Polygon"]
    if not parts:  # nothing that has an area
        return [shapely.get_coordinates(outline)]
    parts.sort(key=lambda part: -float(part.area))
    return [shapely.get_coordinates(part.exterior)[:-1] for part in parts]


def _at_one_place(plan: Floats) -> tuple[Floats, Ints]:
    """Return the places of points (n, 2) and the row of each point's place, shape (n,)."""
    cells = np.round(plan / _PLACE).astype(np.int64)
    cells -= cells.min(axis=0)
    key = cells[:, 0] * (int(cells[:, 1].max()) + 1) + cells[:, 1]
    _, first, which = np.unique(key, return_index=True, return_inverse=True)
    return plan[first], which.reshape(-1)


def _areas(triangles: Floats) -> Floats:
    """Return the areas of triangles (k, 3, 2), positive counter-clockwise, shape (k,)."""
    u, v = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    area: Floats = 0.5 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    return area


def _sheet(places: Floats, triangles: Ints) -> Outline:
    """Return the union of triangles that all look up, or all down, and may lie above each other.

    How many triangles cover a point changes only across an edge that two of them do not share in opposite
    directions. These edges cut the plane into pieces, each of which is covered as a whole or not at all.
    There are far fewer edges than triangles, which makes it faster than the union of the triangles.
    """
    border = _unshared_edges(triangles, len(places))
    noded = shapely.union_all(shapely.linestrings(places[border]))
    pieces = shapely.get_parts(shapely.polygonize(shapely.get_parts(noded)))
    tree = shapely.STRtree(shapely.polygons(places[triangles]))
    covered = np.unique(tree.query(shapely.point_on_surface(pieces), predicate="intersects")[0])
    return shapely.coverage_union_all(pieces[covered])


def _unshared_edges(triangles: Ints, places: int) -> Ints:
    """Return the edges that are passed more often in one direction than in the other, shape (k, 2)."""
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    low, high = edges.min(axis=1), edges.max(axis=1)
    _, first, which = np.unique(low * places + high, return_index=True, return_inverse=True)
    passed = np.bincount(which.reshape(-1), np.where(edges[:, 0] < edges[:, 1], 1.0, -1.0))
    found: Ints = edges[first[passed != 0.0]]
    return found
