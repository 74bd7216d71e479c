"""Barriers of triangles."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import ClassVar

import numpy as np
import numpy.typing as npt
from typing_extensions import override

from .. import _core
from .barrier_kind import BarrierKind, Surface
from .closed_mesh import check_closed
from .description import SeenPart
from .surfaces import placed

__all__ = ["MeshKind"]

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class MeshKind(BarrierKind):
    """A barrier of triangles that close a solid; it may be open where it stands on the ground."""

    vertices: Floats = field(default_factory=lambda: np.empty((0, 3)))
    faces: npt.NDArray[np.int64] = field(default_factory=lambda: np.empty((0, 3), np.int64))

    title: ClassVar = "mesh"
    why_no_indentation: ClassVar = "triangles make none"

    def __post_init__(self) -> None:
        if self.vertices.ndim != 2 or self.vertices.shape[1] != 3:
            raise ValueError(f"vertices must have shape (n, 3), got {self.vertices.shape}")
        if self.faces.ndim != 2 or self.faces.shape[1] != 3:
            raise ValueError(f"faces must have shape (m, 3), got {self.faces.shape}")
        if not np.issubdtype(self.faces.dtype, np.integer):
            raise ValueError(f"faces must be whole numbers, got {self.faces.dtype}")
        object.__setattr__(self, "faces", self.faces.astype(np.int64))
        for array in (self.vertices, self.faces):
            array.setflags(write=False)
        super().__post_init__()
        check_closed(self.vertices, self.faces, ground=1e-9 - self.origin[2])
        volume = self._volume()
        if volume < 0.0:
            raise ValueError(
                f"faces must be counter-clockwise seen from outside, around > 0 m^3, got {volume:.4g}"
            )

    def _volume(self) -> float:
        """Volume that the surface encloses [m^3], negative if it is inside out."""
        # From a point in the plane of the foot, which adds nothing where it is open.
        below = np.array([*self.vertices[0, :2], self.vertices[:, 2].min()])
        a, b, c = (self.vertices[self.faces[:, i]] - below for i in range(3))
        return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)

    @cached_property
    def parts(self) -> tuple[Floats, ...]:
        """Vertices of each part that stands by itself, shape (k, 3) [m]; parts that touch are one.

        Triangles belong together where they share a corner's place, and parts where the boxes around them
        meet, seen from above.
        """
        from scipy.sparse import coo_array
        from scipy.sparse.csgraph import connected_components

        places, which = np.unique(self.vertices, axis=0, return_inverse=True)
        faces = which.reshape(-1)[self.faces]
        ends = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]]]).T
        graph = coo_array((np.ones(ends.shape[1], bool), (ends[0], ends[1])), shape=(len(places),) * 2)
        _, label = connected_components(graph, directed=False)
        of_face = np.unique(label[faces[:, 0]])
        parts = [places[label == k] for k in of_face]
        low, high = (np.array([end(part[:, :2], axis=0) for part in parts]) for end in (np.min, np.max))
        meet = ((low[:, None] <= high) & (low <= high[:, None])).all(axis=2)
        _, group = connected_components(meet, directed=False)
        joined: dict[int, list[Floats]] = {}
        for part, k in zip(parts, group.tolist(), strict=True):
            joined.setdefault(k, []).append(part)
        return tuple(np.concatenate(those) for those in joined.values())

    def elements(self) -> list[_core.Element]:
        """Return the mesh."""
        return [
            _core.Element.mesh(
                vertices=self.vertices,
                faces=self.faces.tolist(),
                position=self.from_origin(0.0, 0.0),
                heading=math.radians(self.heading),
            )
        ]

    @property
    def element_names(self) -> tuple[str, ...]:
        """``mesh``."""
        return ("mesh",)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, MeshKind):
            return NotImplemented
        return (
            (self.friction, self.origin, self.heading) == (other.friction, other.origin, other.heading)
            and np.array_equal(self.vertices, other.vertices)
            and np.array_equal(self.faces, other.faces)
        )

    def __hash__(self) -> int:
        return hash((self.friction, self.origin, self.heading, self.vertices.tobytes()))

    def __repr__(self) -> str:
        return f"MeshBarrier({len(self.vertices)} vertices, {len(self.faces)} faces)"

    @property
    def text(self) -> str:
        """Count and sizes in a few words."""
        sizes = [f"{size:.3g}" for size in self.vertices.max(axis=0) - self.vertices.min(axis=0)]
        return f"mesh of {len(self.faces):,} triangles, {' by '.join(sizes)} m"

    @override
    def surfaces(self, top: float, seen: tuple[float, float]) -> list[Surface]:
        """Return the mesh."""
        return [(placed(self, self.vertices), self.faces)]

    def seen_parts(self, angle: float) -> Iterator[SeenPart]:
        """Yield the parts that stand by themselves."""
        for points in self.parts:
            across = points[:, 0] * math.cos(angle) - points[:, 1] * math.sin(angle)
            low, high = points[:, 2].min(), points[:, 2].max()
            base = self.origin[2]
            yield SeenPart("mesh", float(np.ptp(across)), base + low, base + high)
