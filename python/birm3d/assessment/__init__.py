"""From a run to a decision: occupant risk and ratings by the standards of barrier testing."""

from __future__ import annotations

from .criteria import Criterion
from .matrix import Matrix, test_matrix
from .occupant import OccupantRisk, occupant_risk
from .probability import RatingStudy
from .rate import STANDARDS, rate
from .rating import Rating

__all__ = [
    "STANDARDS",
    "Criterion",
    "Matrix",
    "OccupantRisk",
    "Rating",
    "RatingStudy",
    "occupant_risk",
    "rate",
    "test_matrix",
]
