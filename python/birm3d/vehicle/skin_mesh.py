"""Skin of a vehicle file that is given as triangles, in place of sections and roofs."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated

import numpy as np
import numpy.typing as npt
from pydantic import Field, model_validator

from ..io.toml import Strict, reject

__all__ = ["PANELS", "SkinMesh", "SkinSurface", "subdivided", "table_of"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

PANELS = ("front", "rear", "side", "top", "bottom")
_MOST = 300_000  # triangles
_BEYOND = 100.0  # m


class SkinMesh(Strict):
    """A closed skin of triangles, as two tables in text.

    points_m: a line a point, x y z in m, file axes. triangles: a line a triangle. It has the numbers of the
    points (from 0, counter-clockwise seen from outside), then panel and block, which zones go by.
    """

    points_m: Annotated[str, Field(min_length=1)]
    triangles: Annotated[str, Field(min_length=1)]

    @model_validator(mode="after")
    def _check(self) -> SkinMesh:
        points, rows = self.points, self.rows
        if not (np.isfinite(points).all() and np.abs(points).max() < _BEYOND):
            reject("points_m", f"must be finite and within {_BEYOND:g} m of the front axle")
        if len(rows) > _MOST:
            reject("triangles", f"must be at most {_MOST}, got {len(rows)}")
        numbers = self.faces
        if numbers.min() < 0 or numbers.max() >= len(points):
            bad = int(numbers.min()) if numbers.min() < 0 else int(numbers.max())
            reject("triangles", f"must be of points 0 to {len(points) - 1}, got {bad}")
        if unknown := set(rows[:, 3].tolist()) - set(PANELS):
            reject("triangles", f"panel must be one of {', '.join(PANELS)}; got {min(unknown)!r}")
        # Around a closed skin the faces' vectors add up to nothing.
        a, b, c = (points[numbers[:, i]] for i in range(3))
        vectors = 0.5 * np.cross(b - a, c - a)
        area = np.linalg.norm(vectors, axis=1)
        if not area.sum() > 0.0:
            reject("triangles", "must have an area, got none")
        if np.linalg.norm(vectors.sum(axis=0)) > 0.02 * area.sum():
            reject(
                "triangles", "must close a skin, got one with a hole or with triangles that turn both ways"
            )
        if not np.einsum("ij,ij->", a + b + c, vectors) > 0.0:
            reject("triangles", "must go counter-clockwise seen from outside, got clockwise")
        return self

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, SkinMesh):
            return NotImplemented
        return (self.points_m, self.triangles) == (other.points_m, other.triangles)

    def __hash__(self) -> int:
        return hash((self.points_m, self.triangles))

    @cached_property
    def points(self) -> Floats:
        """Shape (n, 3) [m]."""
        return _table("points_m", self.points_m, 3).astype(float)

    @cached_property
    def rows(self) -> npt.NDArray[np.str_]:
        """The lines of triangles, shape (m, 5), as text."""
        return _table("triangles", self.triangles, 5)

    @cached_property
    def faces(self) -> Ints:
        """Numbers of points, shape (m, 3)."""
        return self.rows[:, :3].astype(np.int64)

    @property
    def panels(self) -> Ints:
        """Index of each triangle's panel into :data:`PANELS`, shape (m,)."""
        return np.array([PANELS.index(name) for name in self.rows[:, 3].tolist()])

    def moved_to(self, points: Floats) -> SkinMesh:
        """Return the same with its points elsewhere, shape (n, 3) [m]."""
        return self.changed({"points_m": table_of(points)})

    def surface(self, blocks: tuple[str, ...], density: float) -> SkinSurface:
        """Return the surface to make elements of, with `density` times as many of them."""
        block = np.array([blocks.index(name) for name in self.rows[:, 4].tolist()])
        one = SkinSurface(self.points, self.faces, self.panels, block)
        if density == 1.0:
            return one
        if density > 1.0:
            return subdivided(one, max(2, round(math.sqrt(density))))
        return _coarser(one, density)


def _table(key: str, text: str, columns: int) -> npt.NDArray[np.str_]:
    words = text.split()
    if len(words) % columns or not words:
        reject(key, f"must be lines of {columns} words, got {len(words)} words in all")
    table = np.array(words).reshape(-1, columns)
    numbers = table if columns == 3 else table[:, :3]
    try:
        numbers.astype(float if columns == 3 else np.int64)
    except ValueError as error:
        reject(key, f"must be numbers: {error}")
    return table


def table_of(points: Floats) -> str:
    """Return points as lines of text, to 0.01 mm."""
    return "\n" + "".join(f"{x:.5f} {y:.5f} {z:.5f}\n" for x, y, z in points.tolist())


@dataclass(frozen=True, eq=False)
class SkinSurface:
    """Triangles with panel and block, as the mesher makes elements of them."""

    points: Floats
    faces: Ints
    panel: Ints
    block: Ints

    @property
    def quads(self) -> Ints:
        """Elements (m, 4): triangles with their last corner twice."""
        return self.faces[:, [0, 1, 2, 2]]


def subdivided(surface: SkinSurface, n: int) -> SkinSurface:
    """Return the surface with every triangle cut into n^2 equal ones."""
    rows = [(i, j) for i in range(n + 1) for j in range(n + 1 - i)]
    number = {pair: k for k, pair in enumerate(rows)}
    small = [[number[i, j], number[i + 1, j], number[i, j + 1]] for i in range(n) for j in range(n - i)]
    small += [
        [number[i + 1, j], number[i + 1, j + 1], number[i, j + 1]] for i in range(n) for j in range(n - i - 1)
    ]
    a, b, c = (surface.points[surface.faces[:, k]] for k in range(3))
    share = np.array(rows, float) / n
    # The same sum at both triangles of an edge, so that their points are one to the last bit.
    at = a[:, None] + share[:, :1] * (b - a)[:, None] + share[:, 1:] * (c - a)[:, None]
    grid = np.round(at.reshape(-1, 3) * 1e7).astype(np.int64)
    _, first, which = np.unique(grid, axis=0, return_index=True, return_inverse=True)
    which = which.reshape(len(surface.faces), len(rows))
    faces = which[:, np.array(small)].reshape(-1, 3)
    times = len(small)
    return SkinSurface(
        at.reshape(-1, 3)[first], faces, np.repeat(surface.panel, times), np.repeat(surface.block, times)
    )


def _coarser(surface: SkinSurface, density: float) -> SkinSurface:
    """Return a surface with fewer triangles; each has panel and block of the nearest one of the old."""
    from scipy.spatial import cKDTree

    from .mesh_import.remesh import even_mesh

    points, faces = even_mesh(surface.points, surface.faces, round(density * len(surface.points)))
    old = surface.points[surface.faces].mean(axis=1)
    nearest = cKDTree(old).query(points[faces].mean(axis=1))[1]
    return SkinSurface(points, faces, surface.panel[nearest], surface.block[nearest])
