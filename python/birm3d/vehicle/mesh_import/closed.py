"""Whether triangles close a skin: corners merged, holes found and closed, normals turned outwards."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from .raw_mesh import RawMesh
from .surface_file import needed

__all__ = ["closed_skin", "merged"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

_SAME = 1e-5  # m, corners nearer to each other than this are one
_LARGEST_HOLE = 0.25  # share of the skin's area that closing may add


def merged(points: Floats, triangles: Ints) -> tuple[Floats, Ints]:
    """Return points and triangles with corners at one place made one, without triangles that vanish."""
    grid = np.round(points / _SAME).astype(np.int64)
    _, first, which = np.unique(grid, axis=0, return_index=True, return_inverse=True)
    triangles = which.reshape(-1)[triangles]
    a, b, c = triangles.T
    triangles = triangles[(a != b) & (b != c) & (c != a)]
    used, triangles = np.unique(triangles, return_inverse=True)
    return points[first][used], triangles.reshape(-1, 3)


def closed_skin(mesh: RawMesh, points: Floats, triangles: Ints, holes: str) -> tuple[Floats, Ints]:
    """Return a closed skin whose triangles run counter-clockwise seen from outside.

    Parameters
    ----------
    mesh
        Where it is from, for messages.
    points, triangles
        Shapes (n, 3) [m] and (m, 3).
    holes
        ``"refuse"`` or ``"close"``.

    Raises
    ------
    MeshFileError
        If it has holes that are not to be closed, edges of more than two triangles, or no volume.
    """
    points, triangles = merged(points, triangles)
    loops, crowded = _open_edges(triangles)
    if crowded:
        raise mesh.fault(
            f"skin must have two triangles at every edge, got {crowded} edges with three or more; "
            "holes='wrap' lays a closed skin around it"
        )
    if len(loops):
        if holes == "refuse":
            a, b = (", ".join(f"{value:.3f}" for value in points[end]) for end in loops[0])
            raise mesh.fault(
                f"skin must be closed, got holes: {len(loops)} edges have one triangle only, the first from "
                f"({a}) to ({b}) m behind the front, left of the middle and above the lowest point. "
                "holes='close' closes holes, holes='wrap' lays a closed skin around all parts"
            )
        points, triangles = _filled(mesh, points, triangles, loops)
    return points, _outwards(mesh, points, triangles)


def _open_edges(triangles: Ints) -> tuple[Ints, int]:
    """Return the edges that one triangle has, (k, 2), and the number of those that three or more have."""
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    _, first, count = np.unique(np.sort(edges, axis=1), axis=0, return_index=True, return_counts=True)
    return edges[first[count == 1]], int((count > 2).sum())


def _filled(mesh: RawMesh, points: Floats, triangles: Ints, edges: Ints) -> tuple[Floats, Ints]:
    """Close every ring of open edges by a fan of triangles around its middle."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    n = len(points)
    graph = coo_matrix((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(n, n))
    ring = connected_components(graph, directed=False)[1][edges[:, 0]]
    degree = np.bincount(edges.reshape(-1), minlength=n)
    if (degree > 2).any():
        raise mesh.fault(
            "holes must not touch each other to be closed, got two at one corner; use holes='wrap'"
        )
    numbers, ring = np.unique(ring, return_inverse=True)
    middles = np.stack([points[np.unique(edges[ring == one])].mean(axis=0) for one in range(len(numbers))])
    fan = np.column_stack([edges[:, 1], edges[:, 0], n + ring])
    points, every = np.concatenate([points, middles]), np.concatenate([triangles, fan])
    added, before = _area(points, fan), _area(points, triangles)
    if added > _LARGEST_HOLE * before:
        raise mesh.fault(
            f"holes must be below {_LARGEST_HOLE:.0%} of the skin's area to be closed, "
            f"got {added / before:.0%}; "
            "use holes='wrap'"
        )
    return points, every


def _area(points: Floats, triangles: Ints) -> float:
    a, b, c = (points[triangles[:, i]] for i in range(3))
    return 0.5 * float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())


def _outwards(mesh: RawMesh, points: Floats, triangles: Ints) -> Ints:
    """Turn triangles so that neighbours agree and all look outwards."""
    pyvista: Any = needed("pyvista")
    skin = pyvista.PolyData.from_regular_faces(points, triangles).compute_normals(
        cell_normals=True, point_normals=False, consistent_normals=True, auto_orient_normals=True
    )
    faces = np.asarray(skin.regular_faces, np.int64)
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    if len(np.unique(edges, axis=0)) < len(edges):
        raise mesh.fault("skin must have an inside and an outside, got a surface that is turned in itself")
    a, b, c = (points[faces[:, i]] for i in range(3))
    volume = float(np.einsum("ij,ij->", a, np.cross(b, c))) / 6.0
    space = float(np.prod(np.ptp(points, axis=0)))
    if not abs(volume) > 0.05 * space:
        raise mesh.fault(
            f"skin must enclose a volume, got {abs(volume):.3g} m^3 in a box of {space:.3g} m^3: a sheet "
            "without thickness, or normals that contradict each other; holes='wrap' lays a skin around it"
        )
    return faces if volume > 0.0 else faces[:, ::-1].copy()
