"""Intervals of a probability that was counted."""

from __future__ import annotations

import math
from statistics import NormalDist

__all__ = ["wilson"]


def wilson(share: float, n: int, confidence: float = 0.95) -> tuple[float, float]:
    """Return the interval of a probability by its share of n runs (Wilson 1927).

    Raises
    ------
    ValueError
        If the share is not from 0 to 1, n is not >= 1, or the confidence is not between 0 and 1.
    """
    if not 0.0 <= share <= 1.0:
        raise ValueError(f"share must be >= 0 and <= 1, got {share}")
    if not n >= 1:
        raise ValueError(f"n must be >= 1, got {n}")
    if not 0.0 < confidence < 1.0:
        raise ValueError(f"confidence must be between 0 and 1, got {confidence}")
    z = NormalDist().inv_cdf(0.5 + 0.5 * confidence)
    middle = (share + z**2 / (2 * n)) / (1 + z**2 / n)
    half = z / (1 + z**2 / n) * math.sqrt(share * (1 - share) / n + z**2 / (4 * n**2))
    # Exact at both ends, where rounding would leave 1e-17.
    return 0.0 if share == 0.0 else middle - half, 1.0 if share == 1.0 else middle + half
