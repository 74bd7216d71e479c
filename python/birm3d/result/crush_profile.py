"""Crush of one side of a vehicle: of every node of its skin, and at six points of equal spacing."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from ..base.checks import index as place
from ..pictures import Side
from ..vehicle.unit_shapes import UnitShape, unit_shapes

if TYPE_CHECKING:
    from .record import RunRecord

__all__ = ["CrushMap", "CrushProfile", "Side", "crush_map", "crush_profile", "crushed_sides", "side_words"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

# Outward direction of each side and its lateral axis, body axes.
_SIDES: Mapping[Side, tuple[int, float, int]] = {
    "front": (0, 1.0, 1),
    "rear": (0, -1.0, 1),
    "left": (1, 1.0, 0),
    "right": (1, -1.0, 0),
}
# An element belongs to a side if its normal is within 60 degrees of outwards.
_FACING = 0.5
_POINTS = 6
# Parts of a side that are further apart, square to it, can hide each other [m].
_APART = 1e-3
# Nodes with this share of the greatest crush say at which height it is.
_ALMOST = 0.95


@dataclass(frozen=True, eq=False)
class CrushMap:
    """Crush of the skin of one side.

    Attributes
    ----------
    side : str
    lateral : ndarray, shape (n,)
        Of all nodes of the unit, uncrushed, body axes: s for front and rear, r for left and right [m].
    height : ndarray, shape (n,)
        Of all nodes above the ground at rest, uncrushed [m].
    crush : ndarray, shape (n,)
        Of all nodes: how far they have moved inwards, square to the side, once covers have sprung back [m].
    triangles : ndarray, shape (m, 3)
        Of the side, indices of nodes, those that no other part of the same side hides from outside.
    """

    side: Side
    lateral: Floats
    height: Floats
    crush: Floats
    triangles: Ints


@dataclass(frozen=True, eq=False)
class CrushProfile:
    """Crush along a level line across one side of a vehicle.

    Attributes
    ----------
    side : str
    height : float
        Of the line above the ground at rest [m].
    lateral, crush : ndarray, shape (k,)
        Along the line: body axis s (front, rear) or r (left, right) and crush [m].
    stations, points : ndarray, shape (6,)
        Places of C1 to C6 along the line, evenly spaced over its whole width, and the crush there [m]. C1 is
        at the left end of front and rear, at the rear end of left and right.
    width : float
        Of the line [m].
    mean : float
        Mean crush by the trapezium rule of six points, (C1/2 + C2 + C3 + C4 + C5 + C6/2) / 5 [m].
    """

    side: Side
    height: float
    lateral: Floats
    crush: Floats
    stations: Floats
    points: Floats
    width: float
    mean: float


def crush_map(result: RunRecord, side: Side | None = None, *, unit: int = 0) -> CrushMap:
    """Return the residual crush of one side: uncrushed less final place, square to the side, of every node.

    Parameters
    ----------
    side
        ``"front"``, ``"rear"``, ``"left"`` or ``"right"``; ``None``: that with the greatest crush, the front
        where nothing is crushed.
    unit
        Of the vehicle.

    Raises
    ------
    ValueError
        If the side is unknown or the unit has no skin there.
    """
    if side is None:
        return _struck(result, unit)
    if side not in _SIDES:
        raise ValueError(f"side must be one of {', '.join(_SIDES)}; got {side!r}")
    shape = _shape(result, unit)
    axis, sign, lateral = _SIDES[side]
    triangles = _visible(shape, _facing(shape, axis, sign, lateral), axis, sign, lateral)
    if len(triangles) == 0:
        raise ValueError(f"side must be one that the vehicle has skin on, got {side!r}")
    return CrushMap(
        side=side,
        lateral=shape.nodes[:, lateral],
        height=shape.nodes[:, 2] + shape.height,
        crush=_sprung_back(result, unit, sign * (shape.nodes - result.final_nodes(unit))[:, axis]),
        triangles=triangles,
    )


def _sprung_back(result: RunRecord, unit: int, crush: Floats) -> Floats:
    """Return the crush less what covers come back by, as in ``residual_crush``, once the vehicle has left."""
    if not result.has_left:
        return crush
    return np.where(crush > 0.0, np.maximum(crush - result.scene.vehicle.core.springback(unit), 0.0), crush)


def crush_profile(
    result: RunRecord, side: Side | None = None, *, height: float | None = None, unit: int = 0
) -> CrushProfile:
    """Return the crush of one side along a level line, with the six points of a CRASH3 (NHTSA) measurement.

    Parameters
    ----------
    side
        ``"front"``, ``"rear"``, ``"left"`` or ``"right"``; ``None``: that with the greatest crush.
    height
        Of the line above the ground at rest [m]; ``None``: the middle of the zone ``bumper`` in front, else
        where the crush is greatest.

    Raises
    ------
    ValueError
        If the side is unknown, the unit has no skin there, or none at that height.
    """
    field = crush_map(result, side, unit=unit)
    side = field.side
    if height is None:
        height = _usual_height(_shape(result, unit), field)
    lateral, crush = _cut(field, height)
    if len(lateral) < 2:
        heights = field.height[field.triangles]
        raise ValueError(
            f"height must be between {heights.min():.3f} and {heights.max():.3f} m, "
            f"where the {side} has skin, got {height}"
        )
    ends = (lateral[-1], lateral[0]) if _SIDES[side][0] == 0 else (lateral[0], lateral[-1])
    stations = np.linspace(*ends, _POINTS)
    points = np.interp(stations, lateral, crush)
    weights = np.array([0.5, *[1.0] * (_POINTS - 2), 0.5]) / (_POINTS - 1)
    return CrushProfile(
        side=side,
        height=float(height),
        lateral=lateral,
        crush=crush,
        stations=stations,
        points=points,
        width=float(lateral[-1] - lateral[0]),
        mean=float(weights @ points),
    )


def side_words(side: str) -> str:
    """Return what a side is called in a title, as "right side"."""
    return f"{side} side" if side in ("left", "right") else side


def crushed_sides(result: RunRecord, least: float = 0.01, *, unit: int = 0) -> tuple[Side, ...]:
    """Return the sides that are crushed by more than `least` [m] somewhere, greatest crush first."""
    return tuple(field.side for field in _all_sides(result, unit) if _greatest(field) > least)


def _shape(result: RunRecord, unit: int) -> UnitShape:
    shapes = unit_shapes(result.scene.vehicle)
    return shapes[place("unit", unit, len(shapes), "units")]


def _all_sides(result: RunRecord, unit: int) -> list[CrushMap]:
    """Return the maps of all sides that have a skin, that of the greatest crush first."""
    shape = _shape(result, unit)
    fields = [
        crush_map(result, side, unit=unit) for side, axes in _SIDES.items() if len(_facing(shape, *axes))
    ]
    return sorted(fields, key=lambda field: -_greatest(field))


def _greatest(field: CrushMap) -> float:
    return float(field.crush[np.unique(field.triangles)].max())


def _struck(result: RunRecord, unit: int) -> CrushMap:
    fields = _all_sides(result, unit)
    if not fields:
        raise ValueError(f"unit must be one that has a skin on some side, got {unit}")
    if _greatest(fields[0]) <= 0.0:
        return next((field for field in fields if field.side == "front"), fields[0])
    return fields[0]


def _facing(shape: UnitShape, axis: int, sign: float, lateral: int) -> Ints:
    """Return the triangles of the skin that look to a side."""
    if len(shape.quads):
        corners = shape.nodes[shape.quads]
        normals = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
        lengths = np.linalg.norm(normals, axis=1)
        quads = shape.quads[sign * normals[:, axis] > _FACING * lengths]
        second = quads[quads[:, 2] != quads[:, 3]]  # skins of meshes are triangles, their last corner twice
        return np.vstack([quads[:, [0, 1, 2]], second[:, [0, 2, 3]]])
    # Without a skin: nodes whose trusses point to the side, joined to their neighbours.
    trusses = shape.nodes - shape.anchors
    mine = np.flatnonzero(sign * trusses[:, axis] > _FACING * np.linalg.norm(trusses, axis=1))
    plane = shape.nodes[mine][:, [lateral, 2]]
    if len(mine) < 3 or np.linalg.matrix_rank(plane - plane.mean(axis=0), tol=1e-9) < 2:
        return np.empty((0, 3), np.int64)
    from scipy.spatial import Delaunay

    return np.asarray(mine[Delaunay(plane).simplices])


def _visible(shape: UnitShape, triangles: Ints, axis: int, sign: float, lateral: int) -> Ints:
    """Return the triangles that others do not hide altogether, the outermost last: drawn so, they cover."""
    import shapely

    plane = shape.nodes[triangles][:, :, [lateral, 2]]
    outwards = sign * shape.nodes[triangles, axis].mean(axis=1)
    # A triangle is hidden if points near its three corners are.
    corners = plane + 0.05 * (plane.mean(axis=1, keepdims=True) - plane)
    tree = shapely.STRtree(shapely.polygons(plane))
    inner, outer = tree.query(shapely.points(corners.reshape(-1, 2)), predicate="within")
    hides = outwards[outer] > outwards[inner // 3] + _APART
    hidden = np.bincount(np.unique(inner[hides]) // 3, minlength=len(triangles)) == 3
    order = np.argsort(outwards, kind="stable")
    return np.asarray(triangles[order[~hidden[order]]])


def _usual_height(shape: UnitShape, field: CrushMap) -> float:
    nodes = np.unique(field.triangles)
    if field.side == "front" and "bumper" in shape.zone_names:
        bumper = nodes[shape.zone_of_node[nodes] == shape.zone_names.index("bumper")]
        if len(bumper):
            return float(0.5 * (field.height[bumper].min() + field.height[bumper].max()))
    crush = field.crush[nodes]
    return float(field.height[nodes[crush >= _ALMOST * crush.max()]].mean())


def _cut(field: CrushMap, height: float) -> tuple[Floats, Floats]:
    """Return lateral places, increasing, where the edges of the side cross a height, and the crush there."""
    t = field.triangles
    edges = np.unique(np.sort(np.vstack([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]]), axis=1), axis=0)
    above = field.height[edges] - height
    edges = edges[(above[:, 0] * above[:, 1] <= 0.0) & (above[:, 0] != above[:, 1])]
    a, b = edges.T
    share = (height - field.height[a]) / (field.height[b] - field.height[a])
    lateral = field.lateral[a] + share * (field.lateral[b] - field.lateral[a])
    crush = field.crush[a] + share * (field.crush[b] - field.crush[a])
    order = np.argsort(lateral, kind="stable")
    return lateral[order], crush[order]
