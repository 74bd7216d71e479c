"""From a run to a decision: occupant risk, ratings by the standards of barrier testing, design loads."""

from __future__ import annotations

from .criteria import Criterion
from .design_load import DesignLoadInterrupted, design_load
from .design_table import DesignLoad, LoadScene
from .element_design import ElementDesign
from .level_study import LevelStudy
from .matrix import Matrix, test_matrix
from .occupant import OccupantRisk, occupant_risk
from .probability import RatingStudy
from .rate import STANDARDS, rate
from .rating import Rating
from .risk_study import RiskStudy

__all__ = [
    "STANDARDS",
    "Criterion",
    "DesignLoad",
    "DesignLoadInterrupted",
    "ElementDesign",
    "LevelStudy",
    "LoadScene",
    "Matrix",
    "OccupantRisk",
    "Rating",
    "RatingStudy",
    "RiskStudy",
    "design_load",
    "occupant_risk",
    "rate",
    "test_matrix",
]
