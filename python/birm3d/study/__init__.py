"""Studies: tables of many runs, and how accurate, how fast and how stable the program is."""

from __future__ import annotations

from .table import Study, Summary
from .verification.precision_result import PrecisionRow, WorkPrecision
from .verification.recommendation import Recommendation
from .verification.stability import stability
from .verification.stability_result import Stability, StabilityRow
from .verification.work_precision import WorkPrecisionInterrupted, work_precision

__all__ = [
    "PrecisionRow",
    "Recommendation",
    "Stability",
    "StabilityRow",
    "Study",
    "Summary",
    "WorkPrecision",
    "WorkPrecisionInterrupted",
    "stability",
    "work_precision",
]
