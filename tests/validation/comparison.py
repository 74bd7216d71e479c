"""A figure of a test beside what is computed of it: what every kind of test returns."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).parent
MEASURED = FOLDER / "measured"
RESULTS = FOLDER / "results"

# Quantities of which a relative error says little: they can be nought.
ABSOLUTE = frozenset({"deg", "-"})
# Units that tables have in place of SI, and their factors.
TOLD = {"N": (1e-3, "kN"), "N s": (1e-3, "kN s"), "N m": (1e-3, "kN m")}


@dataclass(frozen=True)
class Row:
    """One figure.

    measured is in the row's unit; predicted is met where it lies from ``low`` to ``high``, the mark: the
    scatter of tests, a bound or a target, as the text of the kind says. role: "fitted", "left out",
    "predicted", or "check" of what no test has measured. judged: false for a figure that nobody read in a
    source ("source not at hand"); such rows are printed apart.
    """

    test: str
    vehicle: str
    quantity: str
    unit: str
    measured: float
    low: float
    high: float
    predicted: float
    role: str = "predicted"
    judged: bool = True

    @property
    def met(self) -> bool:
        """Whether the prediction is within the mark."""
        return self.low <= self.predicted <= self.high

    @property
    def relative(self) -> bool:
        """Whether the error is a share of what was measured."""
        return self.unit not in ABSOLUTE and self.measured != 0.0 and not self.is_limit

    @property
    def is_limit(self) -> bool:
        """Whether the source gives an upper limit only, in place of a measured value."""
        return self.quantity.endswith("limit")

    @property
    def error(self) -> float:
        """Predicted less measured; as a share of the measured if that is ``relative``."""
        return self.predicted / self.measured - 1.0 if self.relative else self.predicted - self.measured

    @property
    def error_text(self) -> str:
        """The error with its sign; above a limit it is the least one."""
        if self.relative:
            return f"{100.0 * self.error:+.0f} %"
        factor, unit = TOLD.get(self.unit, (1.0, self.unit))
        digits = 2 if unit in ("-", "m") else 1
        least = "at least " if self.is_limit and self.error > 0.0 else ""
        return f"{least}{factor * self.error:+.{digits}f} {unit}".removesuffix(" -")


def about(measured: float, share: float) -> tuple[float, float]:
    """Lowest and highest value within a share of the measured one."""
    return measured - share * abs(measured), measured + share * abs(measured)


def facts(name: str) -> list[dict[str, str]]:
    """Rows of a table in ``measured``; lines that begin with # say where they are from."""
    lines = (MEASURED / f"{name}.csv").read_text(encoding="utf-8").splitlines()
    return list(csv.DictReader(line for line in lines if not line.startswith("#")))


def write(name: str, rows: Iterable[Row]) -> None:
    """Write the rows of a kind of test to ``results``."""
    names = [field.name for field in fields(Row)]
    with (RESULTS / f"{name}.csv").open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(names)
        for row in rows:
            table.writerow([_text(getattr(row, each)) for each in names])


def write_rows(path: Path, rows: Sequence[Any]) -> None:
    """Write a table of dataclasses of one kind: five digits of each number that is no whole one."""
    path.parent.mkdir(parents=True, exist_ok=True)
    names = [field.name for field in fields(rows[0])]
    with path.open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(names)
        for row in rows:
            values = (getattr(row, each) for each in names)
            table.writerow([f"{value:.5g}" if isinstance(value, float) else value for value in values])


def read(name: str) -> list[Row]:
    """Read what :func:`write` wrote."""
    with (RESULTS / f"{name}.csv").open(encoding="utf-8") as file:
        return [_row(each) for each in csv.DictReader(file)]


def _text(value: object) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _row(cells: Mapping[str, str]) -> Row:
    numbers = {name: float(cells[name]) for name in ("measured", "low", "high", "predicted")}
    words = {name: cells[name] for name in ("test", "vehicle", "quantity", "unit", "role")}
    return Row(**words, **numbers, judged=cells["judged"] == "yes")


def of(rows: Sequence[Row], quantity: str) -> list[Row]:
    """Judged rows of one quantity."""
    return [row for row in rows if row.judged and row.quantity == quantity]
