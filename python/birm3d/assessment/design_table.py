"""The design loads of a barrier: a table, its files, and cautions about it."""

# Longer than 300 lines: one class, of which each method writes the same table in another form.
from __future__ import annotations

import csv
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .. import pictures, units
from ..base.arguments import WrongTypeError, checked
from ..base.checks import array, is_whole, shown
from ..base.frozen_mapping import FrozenMapping
from ..io.atomic_write import whole_file
from ..scene.scene import Scene
from ..scene.text import pose_text
from .criteria import table_html, table_text
from .design_cells import is_loaded, load_cell, side_cell
from .element_demand import static_force
from .element_design import (
    BANDED,
    DESIGNED,
    ENVELOPED,
    ElementDesign,
    System,
    check_system,
    design_direction,
)

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

__all__ = ["DesignLoad", "LoadScene"]

Floats = npt.NDArray[np.float64]

_DESIGN = (
    "The first number of each load and height is the design value: the upper end of the 80 % band over "
    "{draws} vehicles of the class in the governing scenes, or this vehicle's own value if that is greater. "
    "About one vehicle of the class in ten exceeds the upper end. Errors of the model and partial factors "
    "are not in it. In square brackets: this vehicle; the band. Direction and DLF are those of this vehicle. "
)
_NUMBERS = (*ENVELOPED[:4], "height", "direction", *ENVELOPED[4:])


class LoadScene(NamedTuple):
    """An impact that the envelope looks at."""

    vehicle: str
    mass: float  # kg
    impact_speed: float  # m/s
    impact_angle: float  # deg
    impact_offset: float  # m
    title: str  # of the vehicle
    impact_yaw: float = 0.0  # deg
    impact_roll: float = 0.0  # deg
    overlap: float | None = None
    overlap_side: str = "left"

    @classmethod
    def of(cls, scene: Scene) -> LoadScene:
        """Return that of a scene."""
        return cls(
            scene.vehicle.name,
            scene.vehicle.mass,
            scene.impact_speed,
            scene.impact_angle,
            scene.impact_offset,
            scene.vehicle.title,
            scene.impact_yaw,
            scene.impact_roll,
            scene.overlap,
            scene.overlap_side,
        )

    def __str__(self) -> str:
        return (
            f"{self.title}, {self.mass:,.0f} kg, {self.impact_speed:.2f} m/s "
            f"({self.impact_speed / units.mph:.1f} mph), {self.impact_angle:g}°{pose_text(self)}"
        )


class DesignLoad:
    """What each element of a barrier has to carry; made by :func:`birm3d.design_load`.

    A sequence of :class:`birm3d.assessment.ElementDesign`, one for each element in the order of
    ``barrier.element_names``; ``loads["bollard 3"]`` finds one by its name. Its own properties of the same
    names are arrays of all elements, shape (n,). These values are those of the vehicle of the scene; what to
    design with is ``design``, and what the printed table has first.

    Attributes
    ----------
    rows : tuple of ElementDesign
    natural_period : float
        [s].
    ductility, damping : float
    peak_filter : str
        Filter of ``peak_force``: ``"CFC 60"``, or ``"unfiltered"`` where the rows are too far apart.
    scenes : tuple of LoadScene
        The impacts that were looked at; a row's ``scene`` has their numbers, from 0.
    failed : mapping of int to str
        Number of each scene that could not be run -> its reason. Its loads are not in the envelope.
    barrier : str
        Kind, count and sizes.
    normal : ndarray, shape (3,)
        Horizontal unit vector square to the barrier's line, into the barrier.
    caution : str
        Assumptions that the numbers depend on, where they matter.
    quantile : float
        Which value of all scenes counts; 1 is the greatest.
    draws : int
        Vehicles of the class that the bands of the rows are made of; 0: there are none.
    finished : int
        Scenes that the envelope is made of; fewer than there are after Ctrl-C, or where some failed.
    """

    def __init__(
        self,
        rows: tuple[ElementDesign, ...],
        system: System,
        *,
        peak_filter: str,
        scenes: tuple[LoadScene, ...],
        failed: Mapping[int, str],
        barrier: str,
        normal: Floats,
        caution: str,
        finished: int,
        quantile: float = 1.0,
    ) -> None:
        self.rows = rows
        self.natural_period, self.ductility, self.damping = system
        self.peak_filter = peak_filter
        self.scenes = scenes
        self.failed = FrozenMapping(dict(failed))
        self.barrier = barrier
        self.normal = normal
        self.caution = caution
        self.finished = finished
        self.quantile = quantile
        self.draws = 0

    def __len__(self) -> int:
        return len(self.rows)

    def __iter__(self) -> Iterator[ElementDesign]:
        return iter(self.rows)

    def __getitem__(self, element: int | str) -> ElementDesign:
        if not isinstance(element, str):
            if not is_whole(element):
                raise WrongTypeError(f"element must be a whole number or text, got {shown(element)}")
            if not -len(self.rows) <= element < len(self.rows):
                raise ValueError(
                    f"element must be >= {-len(self.rows)} and < {len(self.rows)}, the number of elements, "
                    f"got {shown(element)}"
                )
            return self.rows[int(element)]
        for row in self.rows:
            if row.name == element:
                return row
        names = ", ".join(row.name for row in self.rows)
        raise ValueError(f"element must be one of {names}; got {element!r}")

    def _column(self, name: str) -> Floats:
        column = np.array([getattr(row, name) for row in self.rows])
        column.setflags(write=False)
        return column

    @property
    def impulse(self) -> Floats:
        """Along the barrier's normal, positive into the barrier [N s]."""
        return self._column("impulse")

    @property
    def peak_force(self) -> Floats:
        """After ``peak_filter`` [N]."""
        return self._column("peak_force")

    @property
    def force_50ms(self) -> Floats:
        """Greatest mean over 50 ms [N]."""
        return self._column("force_50ms")

    @property
    def longitudinal_force_50ms(self) -> Floats:
        """Greatest mean over 50 ms of the force along the barrier's line, its size [N]."""
        return self._column("longitudinal_force_50ms")

    @property
    def height(self) -> Floats:
        """Of ``force_50ms`` above the foot [m]."""
        return self._column("height")

    @property
    def direction(self) -> Floats:
        """Of ``force_50ms`` from the barrier's normal [deg]."""
        return self._column("direction")

    @property
    def moment(self) -> Floats:
        """Greatest 50-ms mean of the overturning moment about the foot, no dynamic load factor [N m]."""
        return self._column("moment")

    @property
    def equivalent_static_force(self) -> Floats:
        """For the natural period, ductility and damping, or of posts that yield by statics [N]."""
        return self._column("equivalent_static_force")

    @property
    def equivalent_static_moment(self) -> Floats:
        """About the foot, of the same system; see ElementDesign [N m]."""
        return self._column("equivalent_static_moment")

    @property
    def design(self) -> Mapping[str, Floats]:
        """Design values of all elements by name, shape (n,), SI; see ElementDesign."""
        return {name: np.array([row.design[name] for row in self.rows]) for name in DESIGNED}

    @property
    def governing(self) -> ElementDesign:
        """The element with the greatest design value of the equivalent static force."""
        return max(self.rows, key=lambda row: row.design["equivalent_static_force"])

    @property
    def title(self) -> str:
        """What the table is of, in one line."""
        if len(self.scenes) == 1:
            return f"Design loads: {self.barrier}; {self.scenes[0]}"
        kind = "envelope" if self.quantile == 1.0 else f"{self.quantile:g} quantile"
        return f"Design loads: {self.barrier}; {kind} of {self.finished} scenes"

    @property
    def basis(self) -> str:
        """How the columns are made, in a few sentences."""
        kind = "elastic" if self.ductility == 1.0 else f"elastic-plastic, ductility {self.ductility:g}"
        damped = f", damping {self.damping:g}" if self.damping > 0.0 else ""
        return (
            f"{self._of_design()}Forces are horizontal, of walls across their line. Peak force: "
            f"{self.peak_filter}. Forces and moment over 50 ms: greatest means, without a dynamic load "
            "factor; height is that of the 50-ms force above the element's foot, where moments are taken; "
            f"direction that from the barrier's normal. {_of_moments(self.rows)}Equivalent static force, at "
            "this height and in this direction, and equivalent static moment: system with one degree of "
            f"freedom, {kind}, natural period {self.natural_period:g} s{damped}, under the unfiltered "
            "force and the unfiltered moment. Design a foot for these two together, or for a 50-ms force and "
            f"moment by a standard that asks for them.{_of_yielding(self.rows)}"
        )

    def _of_design(self) -> str:
        """Return what the first number of a cell is, where there are bands."""
        return _DESIGN.format(draws=self.draws) if self.draws else ""

    def _head(self) -> tuple[str, ...]:
        design = "design " if self.draws else ""
        return (
            "element",
            f"{design}impulse [kN s]",
            f"{design}peak force, {self.peak_filter} [kN]",
            f"{design}50-ms force [kN]",
            f"{design}50-ms force along the barrier [kN]",
            f"{design}height [m]",
            "direction [deg]",
            f"{design}moment, 50-ms mean, no dynamic factor [kN m]",
            f"{design}equivalent static force [kN]",
            f"{design}equivalent static moment [kN m]",
            "DLF",
        )

    def _cells(self) -> list[tuple[str, ...]]:
        return [
            (
                row.name,
                self._cell(row, "impulse"),
                self._cell(row, "peak_force"),
                self._cell(row, "force_50ms"),
                self._cell(row, "longitudinal_force_50ms"),
                load_cell(row, "height"),
                side_cell(row, "direction"),
                self._cell(row, "moment"),
                self._cell(row, "equivalent_static_force"),
                self._cell(row, "equivalent_static_moment"),
                side_cell(row, "dynamic_load_factor"),
            )
            if is_loaded(row)
            else (row.name, "0", "0", "0", "0", "", "", "0", "0", "0", "")
            for row in self.rows
        ]

    def _cell(self, row: ElementDesign, name: str) -> str:
        """Return a load with the number of the scene that it comes from, where there are several."""
        text = load_cell(row, name)
        return f"{text} ({row.scene[name]})" if len(self.scenes) > 1 and name in row.scene else text

    def _legend(self) -> list[str]:
        """Return the scenes that the table names, and those that failed."""
        if len(self.scenes) == 1:
            return []
        named = sorted({number for row in self.rows for number in row.scene.values()})
        lines = [f"({number}) {self.scenes[number]}" for number in named]
        return lines + [f"({number}) failed: {reason}" for number, reason in self.failed.items()]

    @checked
    def spectrum(
        self, periods: npt.ArrayLike, element: int | str | None = None, ductility: float | None = None
    ) -> Floats:
        """Return the equivalent static force of an element at other natural periods, shape (n,) [N].

        The load is that of the scene which governs at the period of the table. Of a post that yields there
        the force is the same at all periods.

        Parameters
        ----------
        periods
            Shape (n,) [s]; each at least 4 output intervals.
        element
            Its place or name; ``None``: the governing one.
        ductility
            From 1 to 100; ``None``: that of the table.

        Raises
        ------
        ValueError
            If a period is too short, the ductility is out of range, or nothing touches the element.
        """
        row = self.governing if element is None else self[element]
        if row.load is None:
            raise ValueError(f"element must be one that was touched, got {row.name!r}")
        wanted = array("periods", periods, "n")
        system = System(self.natural_period, self.ductility if ductility is None else ductility, self.damping)
        for period in wanted.tolist():
            check_system(system._replace(natural_period=period), row.load.interval, "periods")
        if row.has_yielded:
            return np.full(len(wanted), row.equivalent_static_force)
        direction = design_direction(row.load, self.normal)
        return np.array(
            [
                static_force(
                    row.load,
                    direction,
                    system._replace(natural_period=period),
                    yields=row.can_yield,
                )
                for period in wanted.tolist()
            ]
        )

    def to_dataframe(self) -> pd.DataFrame:
        """Return a row an element, SI; with several scenes the one that each value comes from as text.

        Raises
        ------
        ImportError
            If pandas is not installed.
        """
        import pandas as pd

        return pd.DataFrame(self._records()).set_index("element")

    def to_csv(self, path: str | Path) -> None:
        """Write the same to a file, SI, units in the head."""
        records = self._records()
        with whole_file(path) as part, part.open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file)
            writer.writerow(
                [f"{name} [{unit}]" if (unit := _UNITS.get(name)) else name for name in records[0]]
            )
            writer.writerows(record.values() for record in records)

    def _records(self) -> list[dict[str, Any]]:
        records = []
        for row in self.rows:
            record: dict[str, Any] = {"element": row.name}
            record.update((name, getattr(row, name)) for name in _NUMBERS)
            record["dynamic_load_factor"] = row.dynamic_load_factor
            if self.draws:
                for name in BANDED:
                    low, high = row.band.get(name, (0.0, 0.0))
                    record.update({f"{name}_low": low, f"{name}_high": high})
                record.update((f"{name}_design", row.design[name]) for name in DESIGNED)
            record.update(zip(_VECTOR, row.impulse_vector.tolist(), strict=True))
            if len(self.scenes) > 1:
                for name in ENVELOPED:
                    number = row.scene.get(name)
                    record[f"{name}_scene"] = "" if number is None else str(self.scenes[number])
            records.append(record)
        return records

    def to_dict(self) -> dict[str, Any]:
        """Return all of it but the histories as plain values, SI."""
        return {
            "barrier": self.barrier,
            "natural_period": self.natural_period,
            "ductility": self.ductility,
            "damping": self.damping,
            "peak_filter": self.peak_filter,
            "quantile": self.quantile,
            "draws": self.draws,
            "scenes": [scene._asdict() for scene in self.scenes],
            "failed": {str(number): reason for number, reason in self.failed.items()},
            "elements": [row.to_dict() for row in self.rows],
            "caution": self.caution,
        }

    def to_markdown(self) -> str:
        """Return the table with its basis and its caution, to paste into a report."""
        head, cells = self._head(), self._cells()
        lines = [f"**{self.title}**", "", _pipes(head), _pipes(["---", *["---:"] * (len(head) - 1)])]
        lines += map(_pipes, cells)
        lines += ["", *(f"- {line}" for line in self._legend())]
        if len(self.scenes) > 1:
            lines.append("")
        return "\n".join([*lines, self.basis, "", f"Caution: {self.caution}"])

    def summary(self) -> str:
        """Return the table with its basis and its caution as text."""
        table = table_text(self._head(), self._cells())
        return "\n".join([self.title, table, *self._legend(), self.basis, f"Caution: {self.caution}"])

    __str__ = summary

    def plot(self) -> Figure:
        """Return loads by element, histories of the governing one, and its response spectrum."""
        return pictures.plot_design_load(self)

    def _repr_html_(self) -> str:
        foot = "\n".join([*self._legend(), self.basis, f"Caution: {self.caution}"])
        return table_html(self.title, self._head(), self._cells(), foot)

    def __repr__(self) -> str:
        return f"DesignLoad({len(self.rows)} elements, {self.finished} scenes, greatest: {self.governing!r})"


_VECTOR = ("impulse_x", "impulse_y", "impulse_z")
_UNITS = {
    **dict.fromkeys(("impulse", *_VECTOR), "N s"),
    **dict.fromkeys(("peak_force", "force_50ms", "longitudinal_force_50ms", "equivalent_static_force"), "N"),
    **dict.fromkeys(("moment", "equivalent_static_moment"), "N m"),
    "height": "m",
    "direction": "deg",
}
_UNITS |= {f"{name}_{end}": _UNITS[name] for name in BANDED if name in _UNITS for end in ("low", "high")}
_UNITS |= {f"{name}_design": _UNITS[name] for name in DESIGNED}


def _of_moments(rows: tuple[ElementDesign, ...]) -> str:
    """Return that moments are not forces times heights, where one differs by more than a rounded number."""
    if all(abs(row.moment - row.force_50ms * row.height) <= 0.02 * row.moment for row in rows):
        return ""
    return "The greatest moment is of an instant of its own: it is not the 50-ms force times its height. "


def _of_yielding(rows: tuple[ElementDesign, ...]) -> str:
    """Return how the static force of posts that could yield is made; "" where there is none."""
    text = ""
    if any(row.has_yielded for row in rows):
        text += (
            " Where a post yields, the force is the moment that it resists over the arm of the 50-ms force."
        )
    if any(row.can_yield and not row.has_yielded for row in rows):
        text += " A post that could yield and has not counts as elastic."
    return text


def _pipes(cells: tuple[str, ...] | list[str]) -> str:
    return f"| {' | '.join(cell.replace('|', '/') for cell in cells)} |"
