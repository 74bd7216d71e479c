"""Bands of occupant risk: every run of a study is looked at."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from ..base.arguments import checked
from ..base.complaints import Complaints
from ..base.frozen_mapping import FrozenMapping
from ..study.predict import SHARE, quantiles
from ..study.whole_runs import require_found
from .criteria import table_html, table_text
from .limits import FLAIL_LIMITS
from .risk_values import CAUTION, NOT_JUDGED, OccupantRisk

__all__ = ["RiskStudy", "risk_of_study"]

Floats = npt.NDArray[np.float64]

_NOT_FRONTAL = (
    "OLC is for frontal pulses: in {n:,} of {all:,} runs the speed changes more across the vehicle than it "
    "falls along it, and a low OLC says nothing."
)
_PUSHED_ON = (
    "OLC does not apply in {n:,} of {all:,} runs: there the vehicle is pushed on, not braked, as if hit from "
    "the rear."
)
_HEAD = ("criterion", "median", "80 % band", "limit", "runs within the limit")


class RiskStudy:
    """Occupant risk of the runs of a study; made by :func:`birm3d.occupant_risk`.

    Attributes
    ----------
    risks : tuple of OccupantRisk
        In the order of the study's runs; runs that failed are left out.
    failed : mapping of int to str
        Number of each run that failed, or has no occupant risk -> its reason.
    low, median, high : mapping of str to float
        Each value (``"oiv_x"``, ``"asi"``, ...), SI and g. Between low and high are 80 % of the runs.
    """

    def __init__(self, risks: Mapping[int, OccupantRisk], failed: Mapping[int, str]) -> None:
        self.risks = tuple(risks.values())
        self._by_run = dict(risks)
        self.failed = FrozenMapping(dict(failed))
        bands = {name: quantiles(values, SHARE) for name, values in self.values.items()}
        self.low, self.median, self.high = (
            FrozenMapping({name: band[i] for name, band in bands.items()}) for i in range(3)
        )

    @property
    def values(self) -> Mapping[str, Floats]:
        """Each value of all runs, shape (n,), SI and g."""
        rows = [risk.to_dict() for risk in self.risks]
        return FrozenMapping({name: np.array([row[name] for row in rows]) for name in rows[0]})

    @checked
    def passed(self, standard: str) -> float:
        """Return the share of the runs that meet all limits of a standard, see :meth:`OccupantRisk.passed`.

        Raises
        ------
        ValueError
            If the standard is not known.
        """
        return sum(risk.passed(standard) for risk in self.risks) / len(self.risks)

    @property
    def rows(self) -> list[tuple[str, str, str, str, str]]:
        """Name, median, band, limit and share of the runs within it of each criterion, as text."""
        found = []
        for columns in zip(*(risk.criteria for risk in self.risks), strict=True):
            first = columns[0]
            low, middle, high = quantiles(np.array([float(one.value) for one in columns]), SHARE)
            unit = f" {first.unit}" if first.unit else ""
            within = sum(one.passed is True for one in columns) / len(columns)
            share = "reported" if first.passed is None else f"{within:.0%}"
            found.append(
                (first.name, f"{middle:.2f}{unit}", f"{low:.2f} to {high:.2f}{unit}", first.limit, share)
            )
        return found

    @property
    def _title(self) -> str:
        without = f"; {len(self.failed)} runs without a value" if self.failed else ""
        shares = ", ".join(f"{name} {self.passed(name):.0%}" for name in (*FLAIL_LIMITS, "EN 1317"))
        return f"occupant risk of {len(self.risks)} runs; all limits are met in: {shares}{without}"

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the runs warned of, of each kind the worst, with the numbers of the runs."""
        told = Complaints()
        for run, risk in self._by_run.items():
            told.add(run, risk._complaints)
        runs = len(self.risks) + len(self.failed)
        return tuple(f"{category.__name__}: {text}" for category, text in told.summaries(runs))

    @property
    def notes(self) -> tuple[str, ...]:
        """What to consider before the values are used: warnings of runs, and where no standard judges."""
        reasons = [risk._why_no_olc() for risk in self.risks]
        counts = {_NOT_FRONTAL: reasons.count("not frontal"), _PUSHED_ON: reasons.count("pushed on")}
        heavy = any(risk.is_heavy for risk in self.risks)
        return (
            *([NOT_JUDGED] if heavy else []),
            *self.warnings,
            *(text.format(n=n, all=len(self.risks)) for text, n in counts.items() if n),
        )

    def summary(self) -> str:
        """Return medians, bands, limits and the caution as text."""
        return "\n".join([self._title, *self.notes, table_text(_HEAD, self.rows), CAUTION])

    __str__ = summary

    def to_dict(self) -> dict[str, Any]:
        """Return all of it as plain values, SI and g."""
        return {
            "values": {
                name: {"low": self.low[name], "median": self.median[name], "high": self.high[name]}
                for name in self.median
            },
            "passed": {name: self.passed(name) for name in (*FLAIL_LIMITS, "EN 1317")},
            "failed": {str(run): reason for run, reason in self.failed.items()},
            "notes": list(self.notes),
        }

    def _repr_html_(self) -> str:
        return table_html(". ".join([self._title, *self.notes]), _HEAD, self.rows, CAUTION)

    def __repr__(self) -> str:
        bands = ", ".join(
            f"{name}={self.median[name]:.4g} ({self.low[name]:.4g} to {self.high[name]:.4g})"
            for name in self.median
        )
        return f"RiskStudy({len(self.risks)} runs, {bands})"


def risk_of_study(found: Mapping[int, OccupantRisk], failed: Mapping[int, str]) -> RiskStudy:
    """Return the occupant risk of runs.

    Raises
    ------
    ValueError
        If there is none; the message has the reason of the first.
    """
    require_found(found, failed, "has occupant risk")
    return RiskStudy(found, failed)
