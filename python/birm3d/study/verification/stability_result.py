"""What :func:`birm3d.study.stability` returns."""

from __future__ import annotations

import csv
import math
from collections import Counter
from collections.abc import Collection, Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ... import pictures
from ...base.arguments import checked
from .watched import Limits, text

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

__all__ = ["FAULT", "HELD", "REFUSED", "WARNED", "Stability", "StabilityRow"]

HELD, REFUSED, WARNED, FAULT = "held", "refused", "warned", "FAULT"
_VERDICTS = (HELD, REFUSED, WARNED, FAULT)


@dataclass(frozen=True)
class StabilityRow:
    """One extreme scene.

    Attributes
    ----------
    axis, scene, value
        What is taken to which extreme in which scene.
    verdict
        ``"held"``: every balance is within its limit. ``"refused"``: an error said why not. ``"warned"``: the
        program gave an answer with a :class:`birm3d.BalanceWarning` or a :class:`birm3d.CoarseSkinWarning`.
        ``"FAULT"``: it gave one that is wrong without a word, or failed without a reason.
    reason
        Of all but ``"held"``.
    steps, energy_residual, momentum_residual, node_depth, anchor_depth
        Of the run as far as it went; relative, relative, m, m. NaN: it did not begin.
    """

    axis: str
    scene: str
    value: str
    verdict: str
    reason: str = ""
    outcome: str = ""
    steps: int = 0
    energy_residual: float = math.nan
    momentum_residual: float = math.nan
    node_depth: float = math.nan
    anchor_depth: float = math.nan


@checked
class Stability:
    """What holds, what is refused, and what is wrong; see :func:`birm3d.study.stability`.

    Attributes
    ----------
    rows : tuple of StabilityRow
    limits : Limits
        What the balances were judged by.
    """

    def __init__(self, rows: Collection[StabilityRow], limits: Limits) -> None:
        self.rows = tuple(rows)
        self.limits = limits

    @property
    def faults(self) -> tuple[StabilityRow, ...]:
        """Rows that are wrong without a word."""
        return tuple(row for row in self.rows if row.verdict == FAULT)

    @property
    def table(self) -> Mapping[str, npt.NDArray[Any]]:
        """All rows as columns, shape (n,)."""
        names = [field.name for field in fields(StabilityRow)]
        return MappingProxyType({n: np.array([getattr(row, n) for row in self.rows]) for n in names})

    def to_dataframe(self) -> pd.DataFrame:
        """Return :attr:`table`."""
        try:
            import pandas as pd
        except ImportError as error:
            raise ImportError("to_dataframe() needs pandas: pip install 'birm3d[table]'") from error
        return pd.DataFrame(dict(self.table))

    def save(self, path: str | Path) -> None:
        """Write :attr:`table` as CSV, three figures."""
        with Path(path).open("w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(self.table)
            writer.writerows([text(cell) for cell in row] for row in zip(*self.table.values(), strict=True))

    def report(self) -> str:
        """Return how many held, were refused or are wrong, by axis, and every fault and refusal in words."""
        lines = ["".join(f"{title:>9s}" for title in ("", "", *_VERDICTS)) + f"{'energy residual':>17s}"]
        for axis in dict.fromkeys(row.axis for row in self.rows):
            rows = [row for row in self.rows if row.axis == axis]
            count = Counter(row.verdict for row in rows)
            energy = max((row.energy_residual for row in rows if row.verdict == HELD), default=math.nan)
            shown = "" if math.isnan(energy) else f"{energy:.1e}"
            counts = "".join(f"{count[verdict]:9d}" for verdict in _VERDICTS)
            lines.append(f"{axis:18s}{counts}{shown:>17s}")
        limits = self.limits
        lines.append(
            f"limits: energy {limits.energy:g} of the initial kinetic energy, momentum {limits.momentum:g}, "
            f"nodes {1e3 * limits.node_depth:g} mm and rigid body {1e3 * limits.anchor_depth:g} mm inside"
        )
        for verdict in (FAULT, WARNED, REFUSED):
            for row in self.rows:
                if row.verdict == verdict:
                    lines.append(f"{verdict}: {row.axis} {row.value}, {row.scene}: {row.reason}")
        return "\n".join(lines)

    def plot(self) -> Figure:
        """Return a figure of the energy residual of every row, by axis."""
        return pictures.plot_stability(self)

    def __repr__(self) -> str:
        count = Counter(row.verdict for row in self.rows)
        told = ", ".join(f"{count[verdict]} {verdict}" for verdict in _VERDICTS)
        return f"Stability({len(self.rows)} scenes: {told})"
