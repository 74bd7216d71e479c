"""A mesh as its file has it: points, triangles and the parts that they belong to."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import numpy.typing as npt

from ...io.file_format import FileFormatError
from .deck_mass import DeckMass

__all__ = ["MeshFileError", "RawMesh", "triangulated"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


class MeshFileError(FileFormatError):
    """A mesh that can not become a vehicle; the message names the file and what is wrong."""


@dataclass(frozen=True)
class RawMesh:
    """Triangles of a file, in its own axes and unit.

    Attributes
    ----------
    path
        Of the file.
    points
        Shape (n, 3), unit of the file.
    triangles
        Numbers of points, shape (m, 3).
    part
        Number of the part of each triangle, shape (m,).
    titles
        Number of a part -> what the file calls it.
    is_deck
        Whether it is a finite-element model: sheets with gaps between them, not one closed skin.
    mass
        What the file says of masses.
    """

    path: Path
    points: Floats
    triangles: Ints
    part: Ints
    titles: Mapping[int, str] = field(default_factory=dict)
    is_deck: bool = False
    mass: DeckMass | None = None

    def fault(self, reason: str) -> MeshFileError:
        """Return an error that names the file."""
        return MeshFileError.at(self.path, None, reason)

    def only(self, keep: npt.NDArray[np.bool_]) -> RawMesh:
        """Return the mesh of some triangles, without points that none of them has."""
        used, triangles = np.unique(self.triangles[keep], return_inverse=True)
        return RawMesh(
            self.path,
            self.points[used],
            triangles.reshape(-1, 3).astype(np.int64),
            self.part[keep],
            self.titles,
            self.is_deck,
            self.mass,
        )

    def numbers_of(self, argument: str, parts: Sequence[int | str]) -> set[int]:
        """Return the numbers of the parts that a user names, by number or by a piece of the title."""
        known = {int(number) for number in np.unique(self.part)}
        found: set[int] = set()
        for name in parts:
            if isinstance(name, str):
                lower = name.lower()
                hits = {n for n in known if lower in self.titles.get(n, "").lower()}
            else:
                hits = known & {int(name)}
            if not hits:
                told = [f"{n} {self.titles.get(n, '')!r}" for n in sorted(known)[:8]]
                more = f" and {len(known) - 8} more" if len(known) > 8 else ""
                raise self.fault(
                    f"{argument} must name parts of the mesh ({', '.join(told)}{more}), got {name!r}"
                )
            found |= hits
        return found

    def checked(self) -> RawMesh:
        """Return the mesh without triangles that have no area.

        Raises
        ------
        MeshFileError
            If it has no triangles, or numbers that are not finite or not those of points.
        """
        if len(self.triangles) == 0:
            raise self.fault("must have triangles or shell elements, got none")
        low, high = int(self.triangles.min()), int(self.triangles.max())
        if low < 0 or high >= len(self.points):
            bad = low if low < 0 else high
            raise self.fault(f"triangles must be made of points 0 to {len(self.points) - 1}, got {bad}")
        corners = self.points[self.triangles]
        if not np.isfinite(corners).all():
            bad = int(np.flatnonzero(~np.isfinite(corners).all(axis=(1, 2)))[0])
            raise self.fault(f"coordinates must be finite, got {corners[bad].tolist()} in triangle {bad}")
        size = np.ptp(corners.reshape(-1, 3), axis=0).max()
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        flat = np.linalg.norm(normals, axis=1) <= 1e-14 * size**2
        if flat.all():
            raise self.fault(f"must have a surface, got {len(flat)} triangles without area")
        return self.only(~flat)


def triangulated(quads: Ints) -> Ints:
    """Return the triangles (k, 3) of elements (m, 4); a repeated last corner makes one triangle."""
    first, second = quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]
    return np.concatenate([first, second[quads[:, 2] != quads[:, 3]]])
