"""Skins with nodes at even distances: centroidal Voronoi clusters (Valette and Chassery 2004)."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import numpy.typing as npt

from .surface_file import needed

__all__ = ["edge_lengths", "even_mesh", "is_even"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

_FINER = 6  # points to make clusters of, for each cluster at least
_FEWEST = 50


def edge_lengths(points: Floats, triangles: Ints) -> Floats:
    """Return the lengths of the edges of all triangles, (3 m,)."""
    corners = points[triangles]
    return np.asarray(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).reshape(-1))


def is_even(points: Floats, triangles: Ints, size: float) -> bool:
    """Return whether triangles are already those of a skin with nodes at about this distance."""
    edges = edge_lengths(points, triangles)
    middle = float(np.median(edges))
    return 0.6 * size < middle < 1.7 * size and float(np.quantile(edges, 0.95)) < 2.2 * size


def even_mesh(points: Floats, triangles: Ints, count: int) -> tuple[Floats, Ints]:
    """Return a mesh of the same surface with about `count` nodes at even distances.

    Raises
    ------
    ImportError
        If pyacvd is not installed.
    """
    pyvista: Any = needed("pyvista")
    pyacvd: Any = needed("pyacvd")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of pyacvd's use of pyvista
        clusters = pyacvd.Clustering(pyvista.PolyData.from_regular_faces(points, triangles))
        finer = 0
        while clusters.mesh.n_points * 4**finer < _FINER * count:
            finer += 1
        if finer:
            clusters.subdivide(finer)
        clusters.cluster(max(_FEWEST, count))
    points, faces = (np.asarray(part) for part in (clusters.mesh.points, clusters.mesh.regular_faces))
    return _of_clusters(points.astype(float), faces.astype(np.int64), np.asarray(clusters.clusters, np.int64))


def _of_clusters(points: Floats, faces: Ints, cluster: Ints) -> tuple[Floats, Ints]:
    """Return the mesh with a node in the middle of each cluster, a triangle where three of them meet."""
    corners = points[faces]
    weight = np.zeros(len(points))
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    np.add.at(weight, faces, area[:, None])
    total = np.bincount(cluster, weight)
    middle = [np.bincount(cluster, weight * points[:, i]) / np.maximum(total, 1e-30) for i in range(3)]
    three = cluster[faces]
    three = three[(three[:, 0] != three[:, 1]) & (three[:, 1] != three[:, 2]) & (three[:, 2] != three[:, 0])]
    three = three[np.unique(np.sort(three, axis=1), axis=0, return_index=True)[1]]
    used, triangles = np.unique(three, return_inverse=True)
    return np.stack(middle, axis=1)[used], triangles.reshape(-1, 3)
