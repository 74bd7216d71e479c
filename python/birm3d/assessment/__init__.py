"""From a run to a decision: occupant risk and ratings by the standards of barrier testing."""

from __future__ import annotations

from .occupant import OccupantRisk, occupant_risk

__all__ = ["OccupantRisk", "occupant_risk"]
