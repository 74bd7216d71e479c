"""A computed load map beside a measured one: cell by cell, in sum, and where the force acts."""

from __future__ import annotations

import csv
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from .. import pictures
from ..base.arguments import checked
from ..io.atomic_write import whole_file
from ..units import Quantity, si
from .load_map import LoadMap

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["LoadMapComparison", "compare_load_maps"]

Floats = npt.NDArray[np.float64]

QUANTITIES = {
    "impulse": "impulse [N s]",
    "peak": "peak force CFC 60 [N]",
    "peak_50ms": "50-ms force [N]",
}
"""Attribute of a load map -> what a table calls it."""

_SAME_EDGE = 1e-3  # edges closer than this are one [m]
_ROUNDING = 1e-9  # instants closer than this are one [s]
_LONGEST_INTERVAL = 0.1 / 60.0  # s; SAE J211-1 asks for ten times the class in Hz


@checked
@dataclass(frozen=True, eq=False)
class LoadMapComparison:
    """Two load maps of one grid, until the same time after first contact; made by :func:`compare_load_maps`.

    Attributes
    ----------
    measured, computed : LoadMap
        Rows until the common end; time zero is the first contact.
    """

    measured: LoadMap
    computed: LoadMap

    def difference(self, quantity: str = "impulse") -> Floats:
        """Return computed less measured of each cell, shape (rows, columns) [N s] or [N].

        Parameters
        ----------
        quantity
            ``"impulse"``, ``"peak"`` (after CFC 60) or ``"peak_50ms"``.
        """
        measured, computed = self.values(quantity)
        return computed - measured

    def values(self, quantity: str = "impulse") -> tuple[Floats, Floats]:
        """Return what was measured and computed of each cell; `quantity` as of :meth:`difference`."""
        if quantity not in QUANTITIES:
            raise ValueError(f"quantity must be one of {', '.join(QUANTITIES)}; got {quantity!r}")
        return getattr(self.measured, quantity), getattr(self.computed, quantity)

    @property
    def share_elsewhere(self) -> float:
        """Share of the computed impulse that would have to move to lie as the measured one does, 0 to 1.

        Each cell has a share of its map's sum: half the sum of the magnitudes of their differences.
        """
        measured, computed = (one.impulse / one.impulse.sum() for one in (self.measured, self.computed))
        return 0.5 * float(np.abs(computed - measured).sum())

    @property
    def span(self) -> str:
        """The time that both have, in words."""
        end = min(float(one.time[-1]) for one in (self.measured, self.computed))
        return f"until {1e3 * end:.0f} ms after the first contact"

    def summary(self) -> str:
        """Return the numbers of both side by side, as text."""
        both = self.measured, self.computed
        lines = [
            f"{self.computed.title}\nload map against {self.measured.title}, {self.span}",
            f"{'':32}{'measured':>10}{'computed':>10}{'difference':>12}",
        ]
        for name, of in _FORCES.items():
            one, other = (of(side) / 1e3 for side in both)
            lines.append(f"{name:32}{one:>10.4g}{other:>10.4g}{other / one - 1.0:>+12.1%}")
        for name, axis in _PLACES.items():
            one, other = (_place_of_force(side)[axis] for side in both)
            lines.append(f"{name:32}{one:>10.3f}{other:>10.3f}{other - one:>+10.3f} m")
        lines.append(f"{self.share_elsewhere:.0%} of the computed impulse would have to move to other cells")
        outside = float(self.computed.outside[1:].sum() * self.computed.interval)
        if outside > 0.0:
            lines.append(f"computed outside the cells, in none of these numbers: {outside / 1e3:.3g} kN s")
        return "\n".join(lines)

    __str__ = summary

    def plot(self, quantity: str = "impulse") -> Figure:
        """Return both maps on one scale, their difference, and the sum of the cells over time.

        Parameters
        ----------
        quantity
            As of :meth:`difference`.
        """
        self.values(quantity)
        return pictures.plot_load_map_comparison(self, quantity)

    def to_csv(self, path: str | Path) -> None:
        """Write a row a cell: its edges, then each quantity measured and computed; SI."""
        lateral, height = self.measured.lateral, self.measured.height
        head = ["lateral from [m]", "lateral to [m]", "height from [m]", "height to [m]"]
        tables = []
        for quantity, name in QUANTITIES.items():
            head += [f"measured {name}", f"computed {name}"]
            tables += list(self.values(quantity))
        with whole_file(path) as part, part.open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file)
            writer.writerow(head)
            for i, j in np.ndindex(*tables[0].shape):
                edges = (*lateral[j : j + 2].tolist(), *height[i : i + 2].tolist())
                writer.writerow((*edges, *(float(table[i, j]) for table in tables)))

    def _repr_html_(self) -> str:
        return pictures.text_html(self.summary(), self.plot(), "load maps")

    def __repr__(self) -> str:
        one, other = (side.impulse.sum() for side in (self.measured, self.computed))
        return f"LoadMapComparison(measured {one:.4g} N s, computed {other:.4g} N s)"


@checked
def compare_load_maps(
    measured: LoadMap, computed: LoadMap, *, end: Quantity | None = None
) -> LoadMapComparison:
    """Lay a computed load map beside a measured one.

    Both end at the same time after first contact. Of a measured one first contact is time zero. Its rows
    before that are kept.

    Parameters
    ----------
    measured
        Of :func:`birm3d.read_load_cells`.
    computed
        On the same cells: ``result.load_map(lateral=measured.lateral, height=measured.height)``.
    end
        Time after first contact until which both count [s]; ``None``: as long as both are known.

    Raises
    ------
    ValueError
        If the edges of the cells differ by more than 1 mm, or rows are too far apart for CFC 60. If `end` is
        beyond one of the records, or a map has no impulse.
    """
    for name in ("lateral", "height"):
        _require_same_edges(name, getattr(measured, name), getattr(computed, name))
    for name, one in (("measured", measured), ("computed", computed)):
        if one.interval > _LONGEST_INTERVAL:
            raise ValueError(
                f"{name} must have rows at most {_LONGEST_INTERVAL:.3g} s apart for CFC 60, got "
                f"{one.interval:g} s"
            )
    lasts = [float(one.time[-1] - one.first_contact) for one in (measured, computed)]
    last = min(lasts) if end is None else si("end", end, "time")
    if not 0.0 < last <= min(lasts) + _ROUNDING:
        raise ValueError(
            f"end must be > 0 and within both records, measured until {lasts[0]:g} s and computed until "
            f"{lasts[1]:g} s after the first contact, got {last:g} s"
        )
    maps = [_until(one, last) for one in (measured, computed)]
    for name, one in zip(("measured", "computed"), maps, strict=True):
        if not one.impulse.sum() > 0.0:
            raise ValueError(
                f"{name} must press on the cells until {last:g} s after the first contact, got an impulse of "
                f"{one.impulse.sum():g} N s"
            )
    return LoadMapComparison(*maps)


def _until(map_: LoadMap, end: float) -> LoadMap:
    """Return the rows until an instant after the first contact [s], which becomes time zero."""
    time = map_.time - map_.first_contact
    rows = time <= end + _ROUNDING
    if np.count_nonzero(rows) < 2:
        raise ValueError(f"end must leave 2 rows of each load map, from {time[0]:g} s, got {end:g} s")
    return LoadMap(
        time[rows], map_.lateral, map_.height, map_.force[rows], map_.outside[rows], map_.title, map_.cfc,
        first_contact=0.0,
    )  # fmt: skip


def _require_same_edges(name: str, measured: Floats, computed: Floats) -> None:
    alike = len(measured) == len(computed)
    if alike and np.abs(measured - computed).max() <= _SAME_EDGE:
        return
    apart = f", up to {np.abs(measured - computed).max():.3g} m apart" if alike else ""
    raise ValueError(
        f"{name} of computed must have the edges of measured, {len(measured)} from {measured[0]:g} to "
        f"{measured[-1]:g} m, got {len(computed)} from {computed[0]:g} to {computed[-1]:g} m{apart}; "
        f"Result.load_map takes them as {name}=measured.{name}"
    )


def _place_of_force(map_: LoadMap) -> tuple[float, float]:
    """Return along the line and above the foot the mean place of the cells, weighed by their impulses [m]."""
    along, height = (0.5 * (edges[1:] + edges[:-1]) for edges in (map_.lateral, map_.height))
    total = map_.impulse.sum()
    return float(map_.impulse.sum(axis=0) @ along / total), float(map_.impulse.sum(axis=1) @ height / total)


_FORCES: dict[str, Callable[[LoadMap], float]] = {
    "impulse [kN s]": lambda map_: float(map_.impulse.sum()),
    "peak of the sum, CFC 60 [kN]": lambda map_: float(map_.sum_cfc60.max()),
    "greatest cell, CFC 60 [kN]": lambda map_: float(map_.peak.max()),
}
_PLACES = {"average height of force [m]": 1, "average place along [m]": 0}
