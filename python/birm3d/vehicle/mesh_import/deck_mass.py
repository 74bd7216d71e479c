"""Masses of an LS-DYNA model from its own densities, thicknesses and added masses.

Cards are those of the LS-DYNA keyword user's manual, volumes I and II. Read are RO of ``*MAT``, T1 to T4 of
``*SECTION_SHELL``, SECID and MID of ``*PART``, and the thicknesses of ``*ELEMENT_SHELL_THICKNESS``. So are
``*PART_INERTIA``, ``*ELEMENT_MASS`` and ``*ELEMENT_MASS_PART``. Beams, rigid bodies of nodes and springs have
no mass here.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .columns import columns, lines_of, real, whole

__all__ = ["MASS_BLOCKS", "DeckMass", "Lumps", "lumps_of_solids"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

MASS_BLOCKS = ("*MAT_", "*SECTION_SHELL", "*PART", "*ELEMENT_MASS")
_WITHOUT_DENSITY = ("*MAT_ADD", "*MAT_SPRING", "*MAT_DAMPER", "*MAT_S0", "*MAT_THERMAL", "*MAT_T0")
# Tetrahedra about the diagonal from corner 0 to corner 6 of a solid; repeated corners give none.
_TETRAHEDRA = ((0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6))


class Lumps(NamedTuple):
    """Masses at points, axes and units of the file; `silent` are parts whose elements have no known mass."""

    points: Floats  # (k, 3)
    mass: Floats  # (k,)
    part: Ints  # (k,); 0: of no part
    silent: tuple[int, ...]

    def of_parts(self, parts: Ints) -> Lumps:
        """Return the masses of some parts, and those of no part."""
        keep = np.isin(self.part, parts) | (self.part == 0)
        silent = tuple(one for one in self.silent if one in set(parts.tolist()))
        return Lumps(self.points[keep], self.mass[keep], self.part[keep], silent)

    def properties(self) -> tuple[float, Floats, Floats]:
        """Return mass, mass centre (3,) and inertia (3, 3) about it, units of the file."""
        total = float(self.mass.sum())
        center = self.mass @ self.points / total
        arm = self.points - center
        second = np.einsum("k,ki,kj->ij", self.mass, arm, arm)
        return total, center, np.trace(second) * np.eye(3) - second


@dataclass
class DeckMass:
    """What a model says of its masses, unread: only who asks for them needs cards without a fault.

    blocks: keyword, lines, whether the format is long. nodes: numbers in order, points. shells, solids: part
    and numbers of corners; thickness: lines of each block of shells, ``None`` where it has none.
    """

    blocks: list[tuple[str, bytes, bool]] = field(default_factory=list)
    node_ids: Ints = field(default_factory=lambda: np.zeros(0, np.int64))
    points: Floats = field(default_factory=lambda: np.zeros((0, 3)))
    shells: list[tuple[Ints, Ints]] = field(default_factory=list)
    thickness: list[list[bytes] | None] = field(default_factory=list)
    solids: list[tuple[Ints, Ints]] = field(default_factory=list)

    def lumps(self) -> Lumps:
        """Return the masses of all elements.

        Raises
        ------
        ValueError
            If a card holds no numbers.
        """
        cards = _Cards()
        for name, body, long in self.blocks:
            cards.read(name, lines_of(body), long)
        found = [*self._shell_lumps(cards), *self._solid_lumps(cards), *self._added(cards)]
        if not found:
            return Lumps(np.zeros((0, 3)), np.zeros(0), np.zeros(0, np.int64), ())
        points, mass, part = (np.concatenate(column) for column in zip(*found, strict=True))
        # A part with a mass of its own has that in place of its elements'.
        for number, given in cards.part_mass.items():
            of_part = part == number
            of_elements = float(mass[of_part].sum())
            if of_elements > 0.0:
                mass[of_part] *= (given[0] or of_elements + given[1]) / of_elements
        parts = np.unique(part)
        silent = [int(n) for n in parts if n and not mass[part == n].sum() > 0.0]
        keep = mass > 0.0
        return Lumps(points[keep], mass[keep], part[keep], tuple(silent))

    def _at(self, corners: Ints) -> Floats:
        where = np.minimum(np.searchsorted(self.node_ids, corners), len(self.node_ids) - 1)
        return self.points[where]

    def _shell_lumps(self, cards: _Cards) -> Iterator[tuple[Floats, Floats, Ints]]:
        for (part, quads), lines in zip(self.shells, self.thickness, strict=True):
            sheet = cards.of_parts(part, shells=True)
            if lines is not None:
                thickness = np.mean([real(one) for one in columns(lines, (16,) * 4, False)], axis=0)
                density = cards.of_parts(part, shells=False)
                sheet = np.where(thickness > 0.0, density * thickness, sheet)
            corners = self._at(quads)
            for i, j, k in ((0, 1, 2), (0, 2, 3)):
                a, b, c = corners[:, i], corners[:, j], corners[:, k]
                area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
                yield (a + b + c) / 3.0, sheet * area, part

    def _solid_lumps(self, cards: _Cards) -> Iterator[tuple[Floats, Floats, Ints]]:
        for part, nodes in self.solids:
            centers, volume = lumps_of_solids(self._at(nodes))
            yield centers, cards.of_parts(part, shells=False) * volume, part

    def _added(self, cards: _Cards) -> Iterator[tuple[Floats, Floats, Ints]]:
        for nodes, mass, part in cards.node_masses:
            yield self._at(nodes), mass, part


def lumps_of_solids(corners: Floats) -> tuple[Floats, Floats]:
    """Return centroids (k, 3) and volumes (k,) of solids by their 8 corners, shape (k, 8, 3)."""
    volume = np.zeros(len(corners))
    moment = np.zeros((len(corners), 3))
    for four in _TETRAHEDRA:
        a, b, c, d = (corners[:, i] for i in four)
        six = np.einsum("ki,ki->k", np.cross(b - a, c - a), d - a)
        volume += six / 6.0
        moment += six[:, None] / 24.0 * (a + b + c + d)
    middle = corners.mean(axis=1)
    whole_ = np.abs(volume) > 0.0
    middle[whole_] = moment[whole_] / volume[whole_, None]
    return middle, np.abs(volume)


class _Cards:
    """Cards of materials, sections, parts and added masses."""

    def __init__(self) -> None:
        self.density: dict[int, float] = {}
        self.sheet: dict[int, float] = {}  # thickness of a section
        self.parts: dict[int, tuple[int, int]] = {}  # section, material
        self.part_mass: dict[int, tuple[float, float]] = {}  # in place of its own; added to it
        self.node_masses: list[tuple[Ints, Floats, Ints]] = []

    def read(self, name: str, lines: list[bytes], long: bool) -> None:
        """Read the cards of one block."""
        titled = 1 if name.endswith("_TITLE") else 0
        if name.startswith("*MAT_"):
            if not name.startswith(_WITHOUT_DENSITY) and len(lines) > titled:
                number, density = columns([lines[titled]], (10, 10), long)
                self.density[int(whole(number)[0])] = float(real(density)[0])
        elif name.startswith("*SECTION_SHELL"):
            for first, second in zip(
                lines[titled :: 2 + titled], lines[titled + 1 :: 2 + titled], strict=False
            ):
                (number,) = columns([first], (10,), long)
                self.sheet[int(whole(number)[0])] = float(
                    np.mean([real(one)[0] for one in columns([second], (10,) * 4, long)])
                )
        elif name == "*ELEMENT_MASS":
            _, node, mass, part = columns(lines, (8, 8, 16, 8), long)
            self.node_masses.append((whole(node), real(mass), whole(part)))
        elif name == "*ELEMENT_MASS_PART":
            rows = columns(lines, (8, 16, 16), long)
            for number, added, final in zip(whole(rows[0]), real(rows[1]), real(rows[2]), strict=True):
                self.part_mass[int(number)] = (float(final), float(added))
        elif name == "*PART":
            for line in lines[1::2]:
                self._part(line, long)
        elif name.startswith("*PART_") and len(lines) > 1:
            one = self._part(lines[1], long)
            if "INERTIA" in name and len(lines) > 2:
                total = columns([lines[2]], (10,) * 4, long)[3]
                self.part_mass[one] = (float(real(total)[0]), 0.0)

    def _part(self, line: bytes, long: bool) -> int:
        number, section, material = (int(whole(one)[0]) for one in columns([line], (10,) * 3, long))
        self.parts[number] = (section, material)
        return number

    def of_parts(self, part: Ints, shells: bool) -> Floats:
        """Return density, of shells times thickness, of elements by their parts, shape (k,); 0 if unknown."""
        numbers, which = np.unique(part, return_inverse=True)
        found = np.zeros(len(numbers))
        for i, number in enumerate(numbers.tolist()):
            section, material = self.parts.get(number, (0, 0))
            size = self.sheet.get(section, 0.0) if shells else 1.0
            found[i] = self.density.get(material, 0.0) * size
        return found[which.reshape(-1)]
