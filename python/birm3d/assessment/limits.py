"""Limits of occupant risk: what standards ask of it.

Preferred and maximum values of MASH and NCHRP Report 350, classes of EN 1317-2. Roadside standards have no
limit for OLC; 25 g and 40 g are where Euro NCAP's rating of a car as a crash partner begins and ends.
"""

from __future__ import annotations

from typing import NamedTuple

from .criteria import Criterion

__all__ = ["ASI_CLASSES", "FLAIL_LIMITS", "FlailLimits", "graded", "severity_class"]


class FlailLimits(NamedTuple):
    """Preferred and maximum occupant impact velocity [m/s] and ridedown acceleration [g]."""

    velocity: tuple[float, float]
    ridedown: tuple[float, float]


FLAIL_LIMITS = {
    "MASH": FlailLimits((9.1, 12.2), (15.0, 20.49)),
    "NCHRP 350": FlailLimits((9.0, 12.0), (15.0, 20.0)),
}
ASI_CLASSES = {"A": 1.0, "B": 1.4, "C": 1.9}
"""Greatest ASI of the impact severity levels of EN 1317-2."""
THIV_LIMIT_KM_H = 33.0
"""EN 1317-2, all levels."""
PHD_LIMIT_G = 20.0
"""EN 1317-2 of 1998; the edition of 2010 has it reported."""
OLC_LIMITS_G = (25.0, 40.0)


def graded(name: str, value: float, unit: str, limits: tuple[float, float]) -> Criterion:
    """Return the verdict on a value with a preferred and a maximum limit."""
    preferred, most = limits
    grade = "preferred" if value <= preferred else "acceptable" if value <= most else "above the maximum"
    limit = f"preferred {preferred:g}, maximum {most:g} {unit}"
    return Criterion(name, value, unit, limit, value <= most, grade)


def severity_class(asi: float) -> str | None:
    """Return the impact severity level by ASI: ``"A"``, ``"B"``, ``"C"``, or ``None`` beyond them."""
    return next((level for level, most in ASI_CLASSES.items() if asi <= most), None)
