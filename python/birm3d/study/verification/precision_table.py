"""Rows of a study of errors: settings, what they cost, and how far each metric is off."""

from __future__ import annotations

import csv
import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ...base.arguments import checked
from ...base.frozen_mapping import FrozenMapping
from ...base.plain_words import plain_words
from ...result.metrics import METRIC_UNITS
from ...scene.settings import Settings
from .convergence import Limit

if TYPE_CHECKING:
    import pandas as pd


__all__ = ["AS_GIVEN", "PrecisionRow", "PrecisionTable"]

AS_GIVEN = "as given"
_FACTS = (
    *("variant", "kind", "setting", "value", "error", "worst", "run_time", "steps", "redone"),
    *("force_evaluations", "energy_residual", "momentum_residual", "contact_overlap", "refused"),
)


@dataclass(frozen=True)
class PrecisionRow:
    """One setting of one variant of the scene.

    Attributes
    ----------
    variant
        ``"as given"``; another contact model or representation; ``"mesh"``.
    kind
        ``"tolerance"``, ``"time_step"`` or ``"mesh_density"``: what ``value`` is; ``"reference"``: a
        tolerance of the converged answer.
    value
        The tolerance, the step [s] or the density.
    settings
        With which it was run.
    values, errors
        Of each metric: value in its unit, and relative error (see :mod:`birm3d.study.verification.errors`).
    run_time
        Median over the repeats, stepping only [s].
    steps, redone, force_evaluations
        Accepted steps, those redone, and forces of nodes computed in both.
    energy_residual, momentum_residual, contact_overlap
        The balances: relative, relative, m.
    refused
        Why there is no answer; empty where there is one.
    """

    variant: str
    kind: str
    value: float
    settings: Settings
    values: Mapping[str, float]
    errors: Mapping[str, float]
    run_time: float = math.nan
    steps: int = 0
    redone: int = 0
    force_evaluations: int = 0
    energy_residual: float = math.nan
    momentum_residual: float = math.nan
    contact_overlap: float = 0.0
    refused: str = ""

    @property
    def setting(self) -> str:
        """In words."""
        name = plain_words(self.kind)
        return f"{name} {self.value:.3g}{' s' if self.kind == 'time_step' else ''}"

    @property
    def worst(self) -> str:
        """Metric with the greatest error; "" where there is none."""
        return max(self.errors, key=self.errors.__getitem__, default="")

    @property
    def error(self) -> float:
        """Greatest of all metrics; infinite where there is none: refused, or nothing to compare with."""
        return self.errors[self.worst] if self.errors else math.inf

    def error_of(self, metrics: Collection[str] | None) -> float:
        """Greatest of some metrics; ``None``: all."""
        if metrics is None:
            return self.error
        return max((self.errors[name] for name in metrics if name in self.errors), default=math.inf)


@checked
class PrecisionTable:
    """The rows of :class:`birm3d.study.WorkPrecision`, of which recommendations are made."""

    def __init__(
        self,
        *,
        title: str,
        rows: Collection[PrecisionRow],
        of_variant: Mapping[str, Mapping[str, Limit]],
        scales: Mapping[str, float],
        default: PrecisionRow,
    ) -> None:
        self.title = title
        self.rows = tuple(rows)
        self.of_variant = FrozenMapping({k: FrozenMapping(dict(v)) for k, v in of_variant.items()})
        self.scales = FrozenMapping(dict(scales))
        self.default = default

    @property
    def converged(self) -> Mapping[str, Limit]:
        """Metric -> converged value of the scene as given."""
        return self.of_variant[AS_GIVEN]

    @property
    def uncertainty(self) -> Mapping[str, float]:
        """Metric -> relative uncertainty of its converged value."""
        return {name: limit.uncertainty / self.scales[name] for name, limit in self.converged.items()}

    def of(self, variant: str = AS_GIVEN, kind: str | None = None) -> tuple[PrecisionRow, ...]:
        """Return the rows of a variant, all or those of one kind.

        Raises
        ------
        ValueError
            If there is no such variant.
        """
        known = dict.fromkeys(row.variant for row in self.rows)
        if variant not in known:
            raise ValueError(f"variant must be one of {', '.join(known)}; got {variant!r}")
        return tuple(row for row in self.rows if row.variant == variant and kind in (None, row.kind))

    def departures(self, variant: str) -> dict[str, float]:
        """Return by how much the converged values of a variant differ from those as given, relative.

        No matter of steps: another model of the same crash.
        """
        self.of(variant)
        # A variant that was refused has no converged values.
        other: Mapping[str, Limit] = self.of_variant.get(variant, {})
        return {
            name: (other[name].value - limit.value) / self.scales[name]
            for name, limit in self.converged.items()
            if name in other
        }

    @property
    def table(self) -> Mapping[str, npt.NDArray[Any]]:
        """All rows as columns, shape (n,): what a row is, then ``error.<metric>`` and ``<metric>``.

        NaN: the row does not have this metric.
        """
        columns: dict[str, npt.NDArray[Any]] = {
            name: np.array([getattr(row, name) for row in self.rows]) for name in _FACTS
        }
        for name in self.scales:
            columns[f"error.{name}"] = np.array([row.errors.get(name, math.nan) for row in self.rows])
        for name in self.scales:
            columns[name] = np.array([row.values.get(name, math.nan) for row in self.rows])
        return FrozenMapping(columns)

    def to_dataframe(self) -> pd.DataFrame:
        """Return :attr:`table`; units of the metrics are in ``attrs["units"]``."""
        try:
            import pandas as pd
        except ImportError as error:
            raise ImportError("to_dataframe() needs pandas: pip install 'birm3d[table]'") from error
        table = pd.DataFrame(dict(self.table))
        table.attrs["units"] = {name: METRIC_UNITS[name] for name in self.scales}
        return table

    def save(self, path: str | Path) -> None:
        """Write :attr:`table` as CSV, six figures; an empty cell is a metric that the row does not have."""
        with Path(path).open("w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(self.table)
            writer.writerows([_text(cell) for cell in row] for row in zip(*self.table.values(), strict=True))


def _text(value: Any) -> str:
    if isinstance(value, float):
        return "" if math.isnan(value) else f"{value:.6g}"
    return str(value)
