"""A vehicle's mass centre at another height."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

__all__ = ["stretched_inertia"]

Floats = npt.NDArray[np.float64]


def stretched_inertia(inertia: Floats, factor: float) -> Floats:
    """Return the inertia of a body whose mass stands higher above the ground by a factor.

    Every part of the mass goes from height z to ``factor * z`` above the ground and keeps its place in plan.
    So does the mass centre. The second moments about the mass centre are J = integral of r r^T dm; the
    inertia I gives them as J = trace(I) / 2 - I. The new ones are S J S with S = diag(1, 1, factor). As the
    moments of a mass that could be built, they keep every inequality that an inertia has to.

    Parameters
    ----------
    inertia
        About the mass centre, third axis up, shape (3, 3) [kg m^2].
    factor
        > 0.
    """
    moments = 0.5 * np.trace(inertia) * np.eye(3) - inertia
    scale = np.array([1.0, 1.0, factor])
    moments = scale[:, None] * moments * scale
    return np.asarray(np.trace(moments) * np.eye(3) - moments)
