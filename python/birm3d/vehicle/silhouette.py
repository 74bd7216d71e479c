"""Outline of a vehicle's unit as seen from above."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import shapely

from .raster_outline import raster_outline
from .unit_shapes import UnitShape

__all__ = ["Outline", "rings", "silhouette"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]
Outline: TypeAlias = Any
"""A polygon of shapely, or several, world x and y [m]."""

# Triangles whose plan is smaller stand upright and cover nothing [m^2].
_LEAST_AREA = 1e-12
_MANY = 20_000  # faces of a skin; those of presets have up to 10,000
_MOST_EDGES = 4000  # of a sheet: the time to cut the plane by them grows with their square
# Points as near to each other are one [m].
_PLACE = 1e-7


def silhouette(
    shape: UnitShape, nodes: Floats, center: Floats, rotation: Floats, *, exact: bool = True
) -> Outline:
    """Return the outline seen from above: the union of the faces of the skin, projected on the ground.

    A unit without a skin has the convex hull of its nodes and anchors.

    Parameters
    ----------
    shape
        The unit.
    nodes
        Its shell nodes now, body axes, shape (n, 3) [m].
    center, rotation
        Mass centre (3,) [m] and rotation body to world (3, 3).
    exact
        Otherwise accurate to 1 cm, in a tenth of the time: see :mod:`birm3d.vehicle.raster_outline`. So are
        skins of very many faces or folds, as imported meshes have, in any case.
    """
    if len(shape.quads) == 0:
        points = (center + np.vstack([nodes, shape.anchors]) @ rotation.T)[:, :2]
        return shapely.MultiPoint(points).convex_hull
    if not exact or len(shape.quads) > _MANY:
        faces = np.vstack([shape.quads[:, [0, 1, 2]], shape.quads[:, [0, 2, 3]]])
        return raster_outline((center + nodes @ rotation.T)[:, :2], faces)
    # Nodes at one place are one, so that panels that lie beside each other share their edges.
    places, which = _at_one_place((center + nodes @ rotation.T)[:, :2])
    triangles = which[np.vstack([shape.quads[:, [0, 1, 2]], shape.quads[:, [0, 2, 3]]])]
    area = _areas(places[triangles])
    sheets = [triangles[side * area > _LEAST_AREA] for side in (1.0, -1.0)]
    borders = [_unshared_edges(sheet, len(places)) for sheet in sheets]
    if max(map(len, borders)) > _MOST_EDGES:
        return raster_outline(places, triangles)
    outlines = (_sheet(places, sheet, border) for sheet, border in zip(sheets, borders, strict=True))
    return shapely.union_all(list(outlines))


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


def _sheet(places: Floats, triangles: Ints, border: Ints) -> Outline:
    """Return the union of triangles that all look up, or all down, and may lie above each other.

    How many triangles cover a point changes only across an edge that two of them do not share in opposite
    directions. These edges cut the plane into pieces, each of which is covered as a whole or not at all.
    There are far fewer edges than triangles, which makes it faster than the union of the triangles.
    """
    noded = shapely.union_all(shapely.linestrings(places[border]))
    pieces = shapely.get_parts(shapely.polygonize(shapely.get_parts(noded)))
    tree = shapely.STRtree(shapely.polygons(places[triangles]))
    covered = np.unique(tree.query(shapely.point_on_surface(pieces), predicate="intersects")[0])
    try:
        return shapely.coverage_union_all(pieces[covered])
    except shapely.errors.GEOSException:  # rounding has left pieces that overlap by a little
        return shapely.union_all(pieces[covered])


def _unshared_edges(triangles: Ints, places: int) -> Ints:
    """Return the edges that are passed more often in one direction than in the other, shape (k, 2)."""
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    low, high = edges.min(axis=1), edges.max(axis=1)
    _, first, which = np.unique(low * places + high, return_index=True, return_inverse=True)
    passed = np.bincount(which.reshape(-1), np.where(edges[:, 0] < edges[:, 1], 1.0, -1.0))
    found: Ints = edges[first[passed != 0.0]]
    return found
