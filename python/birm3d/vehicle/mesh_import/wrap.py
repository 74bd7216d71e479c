"""A closed skin around any triangles: what of a finite-element vehicle a barrier meets first.

A finite-element vehicle is thousands of sheets with gaps between them, engine and seats within. All sheets
are drawn into a grid of cubes. A cube is inside if a sheet is in it, or if sheets enclose it on both sides
along two of the three axes. So openings below the engine and missing windows do no harm. The skin is where
inside ends; its nodes are then moved onto the sheets that they are next to.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .surface_file import needed

__all__ = ["Enclosure", "WheelSpace", "cube_size", "enclosed", "fitted_to", "sampled"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]
Cubes = npt.NDArray[np.bool_]

_PER_ELEMENT = 4.0  # cubes along the side of an element
_MOST_CUBES = 60_000_000
_ROOM = 4  # empty cubes around the vehicle
_MIRROR = 0.03  # a slice across the vehicle with less of the greatest one's cubes is a mirror's


class WheelSpace(NamedTuple):
    """Wheel house to fill, so that the side goes on beside the wheel: ranges of x, z and of |y| [m]."""

    x: tuple[float, float]
    z: tuple[float, float]
    y: tuple[float, float]


def sampled(points: Floats, triangles: Ints, size: float) -> Floats:
    """Return points (k, 3) on triangles, not further apart than `size`, one in each cube of that size."""
    a, b, c = (points[triangles[:, i]] for i in range(3))
    longest = np.sqrt(np.max([((u - v) ** 2).sum(axis=1) for u, v in ((a, b), (b, c), (c, a))], axis=0))
    parts = np.maximum(1, np.ceil(longest / size)).astype(np.int64)
    found = []
    for n in np.unique(parts):
        i, j = (grid.reshape(-1) for grid in np.indices((n + 1, n + 1)))
        i, j = i[i + j <= n] / n, j[i + j <= n] / n
        here = np.flatnonzero(parts == n)
        for some in np.array_split(here, max(1, len(here) * len(i) // 2_000_000)):
            at = a[some, None] + i[:, None] * (b - a)[some, None] + j[:, None] * (c - a)[some, None]
            found.append(_thinned(at.reshape(-1, 3), size))
    return _thinned(np.concatenate(found), size)


def _thinned(points: Floats, size: float) -> Floats:
    low = points.min(axis=0)
    cell = ((points - low) / size).astype(np.int64)
    extent = cell.max(axis=0) + 1
    key = (cell[:, 0] * extent[1] + cell[:, 1]) * extent[2] + cell[:, 2]
    return points[np.unique(key, return_index=True)[1]]


@dataclass(frozen=True)
class Enclosure:
    """The inside of a vehicle as cubes.

    Attributes
    ----------
    solid
        Cubes that are inside.
    origin
        Corner of the first cube, shape (3,) [m].
    size
        Of a cube [m].
    samples
        Points of the sheets, shape (k, 3) [m].
    """

    solid: Cubes
    origin: Floats
    size: float
    samples: Floats

    @property
    def sides(self) -> tuple[float, float]:
        """Where the vehicle ends to the right and to the left, without mirrors [m]."""
        across = np.flatnonzero(self.solid.any(axis=(0, 2)))
        low, high = (self.origin[1] + self.size * (across[[0, -1]] + (0, 1))).tolist()
        y = self.samples[:, 1]
        y = y[(low <= y) & (y <= high)]
        return float(y.min()), float(y.max())

    def moved(self, offset: Floats) -> Enclosure:
        """Return the same elsewhere, by (3,) [m]."""
        return Enclosure(self.solid, self.origin + offset, self.size, self.samples + offset)

    def skin(self, underside: Floats | None, wheels: Sequence[WheelSpace]) -> tuple[Floats, Ints]:
        """Return a closed skin: points (n, 3) [m], triangles (m, 3).

        Parameters
        ----------
        underside
            Rows (x, z), x falling: what is below is cut away; ``None``: nothing.
        wheels
            Wheel houses to fill.
        """
        from scipy import ndimage

        solid = self.solid.copy()
        x, y, z = (self.origin[i] + (np.arange(n) + 0.5) * self.size for i, n in enumerate(solid.shape))
        for wheel in wheels:
            solid[np.ix_(_within(x, wheel.x), _within(np.abs(y), wheel.y), _within(z, wheel.z))] = True
        if underside is not None:
            floor = np.interp(x, underside[::-1, 0], underside[::-1, 1])
            solid &= z[None, None, :] > floor[:, None, None]
        ball = ndimage.generate_binary_structure(3, 1)
        solid = ndimage.binary_closing(solid, ball, iterations=2)
        solid = ndimage.binary_fill_holes(ndimage.binary_opening(solid, ball))
        labels, count = ndimage.label(solid)
        if count > 1:
            solid = labels == 1 + np.argmax(np.bincount(labels.reshape(-1))[1:])
        return _surface(solid, self.origin + 0.5 * self.size, self.size)


def enclosed(samples: Floats, element_size: float) -> Enclosure:
    """Return the inside of sheets, of which points (k, 3) are given [m], for elements of a size [m]."""
    low, high = samples.min(axis=0), samples.max(axis=0)
    size = cube_size(element_size)
    size = max(size, float(np.prod(high - low) / _MOST_CUBES) ** (1.0 / 3.0))
    origin = low - _ROOM * size
    shape = np.ceil((high - origin) / size).astype(int) + _ROOM + 1
    sheet = np.zeros(shape, dtype=bool)
    sheet[tuple(np.floor((samples - origin) / size).astype(np.int64).T)] = True
    return Enclosure(_without_mirrors(_inside(sheet)), origin, size, samples)


def cube_size(element_size: float) -> float:
    """Return the size of cubes for elements of a size [m]."""
    return element_size / _PER_ELEMENT


def _within(values: Floats, limits: tuple[float, float]) -> Ints:
    return np.flatnonzero((limits[0] <= values) & (values <= limits[1]))


def _inside(sheet: Cubes) -> Cubes:
    """Return the cubes with sheets in them, or on both sides of them along two axes or more."""
    enclosed = np.zeros(sheet.shape, dtype=np.int8)
    for axis in range(3):
        before = np.logical_or.accumulate(sheet, axis=axis)
        behind = np.flip(np.logical_or.accumulate(np.flip(sheet, axis), axis=axis), axis)
        enclosed += before & behind
    return np.asarray(sheet | (enclosed >= 2))


def _without_mirrors(solid: Cubes) -> Cubes:
    count = solid.sum(axis=(0, 2))
    body = count >= _MIRROR * count.max()
    return np.asarray(solid & body[None, :, None])


def _surface(solid: Cubes, origin: Floats, size: float) -> tuple[Floats, Ints]:
    """Return where cubes end, as a smooth surface: the zero of the distance from the end, smoothed."""
    from scipy import ndimage

    pyvista: Any = needed("pyvista")
    inside = ndimage.distance_transform_edt(solid)
    outside = ndimage.distance_transform_edt(~solid)
    field = ndimage.gaussian_filter(inside - outside, 0.8)
    grid = pyvista.ImageData(dimensions=solid.shape, spacing=(size,) * 3, origin=origin)
    grid.point_data["distance"] = field.astype(np.float32).reshape(-1, order="F")
    skin = grid.contour([0.0], scalars="distance", method="flying_edges").triangulate()
    skin = skin.extract_largest() if hasattr(skin, "extract_largest") else skin
    return np.asarray(skin.points, float), np.asarray(skin.regular_faces, np.int64)


def fitted_to(points: Floats, triangles: Ints, samples: Floats, reach: float) -> Floats:
    """Return the points of a skin moved along its normals to sheets that are not further than `reach` [m]."""
    from scipy.spatial import cKDTree

    normals = np.zeros_like(points)
    a, b, c = (points[triangles[:, i]] for i in range(3))
    face = np.cross(b - a, c - a)
    for corner in range(3):
        np.add.at(normals, triangles[:, corner], face)
    normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-30)[:, None]
    distance, nearest = cKDTree(samples).query(points, distance_upper_bound=reach, workers=1)
    found = np.isfinite(distance)
    moved = points.copy()
    depth = np.einsum("ij,ij->i", samples[nearest[found]] - points[found], normals[found])
    moved[found] += depth[:, None] * normals[found]
    return moved
