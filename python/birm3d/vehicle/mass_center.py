"""A vehicle's mass centre at another height."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from .inertia import spread_inertia

__all__ = ["stretched_inertia"]

Floats = npt.NDArray[np.float64]


def stretched_inertia(inertia: Floats, factor: float) -> Floats:
    """Return the inertia of a body whose mass stands higher above the ground by a factor.

    Every part of the mass goes from height z to ``factor * z`` above the ground and keeps its place in plan.
    So does the mass centre, and heights above it are multiplied by the factor, too.

    Parameters
    ----------
    inertia
        About the mass centre, third axis up, shape (3, 3) [kg m^2].
    factor
        > 0.
    """
    return spread_inertia(inertia, (1.0, 1.0, factor))
