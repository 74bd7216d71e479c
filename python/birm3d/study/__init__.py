"""Studies: tables of many runs, and how accurate, how fast and how stable the program is."""

from __future__ import annotations

from .precision_result import PrecisionRow, WorkPrecision
from .recommendation import Recommendation
from .stability import stability
from .stability_result import Stability, StabilityRow
from .table import Study, Summary
from .work_precision import work_precision

__all__ = [
    "PrecisionRow",
    "Recommendation",
    "Stability",
    "StabilityRow",
    "Study",
    "Summary",
    "WorkPrecision",
    "stability",
    "work_precision",
]
