"""Where on a barrier the load acts: force over time in the cells of a grid, as load cells read it."""

from __future__ import annotations

import csv
from collections.abc import Iterable
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from .. import pictures
from ..io.atomic_write import whole_file
from ..signals.filters import cfc, moving_average
from ..units import Quantity, si
from .unit_result import read_only

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["LoadMap"]

Floats = npt.NDArray[np.float64]

_CLASS = 60.0  # SAE J211-1, barrier forces


class LoadMap:
    """Force on the cells of a grid over a barrier's front.

    Computed by :meth:`birm3d.Result.load_map`; measured, see :func:`birm3d.read_load_cells`.

    Attributes
    ----------
    time : ndarray, shape (n,)
        Of the result's rows, or of the record's [s].
    lateral, height : ndarray, shape (columns + 1,), (rows + 1,)
        Edges of the cells: along the line from the barrier's origin, and above its foot [m]. Seen by the
        vehicle the columns run from right to left, as y does.
    force : ndarray, shape (n, rows, columns)
        Across the line, into the barrier [N]. Computed ones are means over the output interval, measured
        ones are samples. Friction along the line is not in it.
    outside : ndarray, shape (n,)
        Force that no cell has, where edges were given and the vehicle pushes beside them [N].
    title : str
        Of the scene, as figures have it; of a measured one the name of its file.
    cfc : float or None
        Channel frequency class that measured forces have been filtered to; ``None``: none.
    first_contact : float
        Instant at which the vehicle touches the cells [s]; of measured ones 0, their time zero.
    """

    def __init__(
        self, time: Floats, lateral: Floats, height: Floats, force: Floats, outside: Floats, title: str,
        cfc: float | None = None, first_contact: float | None = None,
    ) -> None:  # fmt: skip
        self.time, self.lateral, self.height = time, lateral, height
        self.force, self.outside = read_only(force), read_only(outside)
        self.title, self.cfc = title, cfc
        self.first_contact = self._first_force() if first_contact is None else first_contact

    @property
    def interval(self) -> float:
        """Between rows [s]."""
        return float(self.time[1] - self.time[0])

    @cached_property
    def resultant(self) -> Floats:
        """Sum of all cells and of what is outside them, shape (n,) [N]."""
        return read_only(self.sum_of_cells + self.outside)

    @cached_property
    def sum_of_cells(self) -> Floats:
        """Without what is outside them, shape (n,) [N]."""
        return read_only(self.force.sum(axis=(1, 2)))

    @cached_property
    def impulse(self) -> Floats:
        """Of each cell, shape (rows, columns) [N s]."""
        return read_only(self.force[1:].sum(axis=0) * self.interval)

    def _first_force(self) -> float:
        """Return the last instant before there is a force; the end where there is none."""
        loaded = np.flatnonzero(self.resultant > 0.0)
        return float(self.time[max(0, int(loaded[0]) - 1)] if len(loaded) else self.time[-1])

    @cached_property
    def peak(self) -> Floats:
        """Greatest force of each cell after CFC 60 (SAE J211-1), shape (rows, columns) [N].

        Where the output interval is too long for that class, the greatest of the unfiltered means.
        """
        cells = self._after_cfc60(self.force.reshape(len(self.time), -1))
        return read_only(cells.max(axis=0).reshape(self.force.shape[1:]))

    @cached_property
    def sum_cfc60(self) -> Floats:
        """Sum of the cells after CFC 60, as :attr:`peak` has it, shape (n,) [N]."""
        return read_only(self._after_cfc60(self.sum_of_cells))

    def _after_cfc60(self, rows: Floats) -> Floats:
        """Return rows (n,) or (n, k) after CFC 60: as they are if they have it, or lie too far apart."""
        as_is = self.cfc == _CLASS or self.interval * _CLASS > 0.1
        return rows if as_is else cfc(rows, _CLASS, self.interval)

    @cached_property
    def peak_50ms(self) -> Floats:
        """Greatest mean force of each cell over 50 ms, shape (rows, columns) [N]."""
        cells = self.force.reshape(len(self.time), -1)
        means = [moving_average(cell, 0.05, self.interval).max() for cell in cells.T]
        return read_only(np.array(means).reshape(self.force.shape[1:]))

    def at(self, time: Quantity) -> Floats:
        """Return the forces of the row that is nearest to an instant, shape (rows, columns) [N].

        Raises
        ------
        ValueError
            If the instant is outside the run or the record.
        """
        instant = si("time", time, "time")
        if not self.time[0] <= instant <= self.time[-1]:
            raise ValueError(
                f"time must be within the run, {self.time[0]:g} to {self.time[-1]:g} s, got {instant:g}"
            )
        return read_only(self.force[int(np.argmin(np.abs(self.time - instant)))])

    def to_csv(self, path: str | Path) -> None:
        """Write a row a cell: its edges, impulse, peak after CFC 60, and greatest 50-ms mean; SI."""
        head = (
            *("lateral from [m]", "lateral to [m]", "height from [m]", "height to [m]"),
            *("impulse [N s]", "peak force CFC 60 [N]", "50-ms force [N]"),
        )
        with whole_file(path) as part, part.open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file)
            writer.writerow(head)
            for i, j in np.ndindex(*self.impulse.shape):
                edges = (*self.lateral[j : j + 2].tolist(), *self.height[i : i + 2].tolist())
                values = (self.impulse[i, j], self.peak[i, j], self.peak_50ms[i, j])
                writer.writerow((*edges, *map(float, values)))

    def summary(self) -> str:
        """Return the table of impulses, the highest row of cells first, columns as y runs."""
        middles = 0.5 * (self.lateral[1:] + self.lateral[:-1])
        lines = [f"{self.title}: impulse by cell [kN s]", "height [m]  " + _row(f"{y:+.2f}" for y in middles)]
        for i in reversed(range(len(self.height) - 1)):
            range_ = f"{self.height[i]:.2f}-{self.height[i + 1]:.2f}"
            lines.append(f"{range_:<12}" + _row(_number(value / 1e3) for value in self.impulse[i].tolist()))
        total = self.impulse.sum() / 1e3
        lines.append(
            f"sum of the cells {total:.3g} kN s, greatest cell {self.peak.max() / 1e3:,.0f} kN, CFC 60"
        )
        return "\n".join(lines)

    __str__ = summary

    def plot(self, time: Quantity | None = None) -> Figure:
        """Return a picture of impulse and peak force by cell; of an instant, of the force then."""
        return pictures.plot_load_map(self, None if time is None else si("time", time, "time"))

    def _repr_html_(self) -> str:
        return pictures.text_html(self.summary(), self.plot(), "load map")

    def __repr__(self) -> str:
        rows, columns = self.impulse.shape
        return f"LoadMap({rows} x {columns} cells, {self.impulse.sum():.4g} N s)"


def _row(cells: Iterable[str]) -> str:
    return "".join(f"{cell:>8}" for cell in cells)


def _number(value: float) -> str:
    return "." if abs(value) < 5e-4 else f"{value:.3g}"
