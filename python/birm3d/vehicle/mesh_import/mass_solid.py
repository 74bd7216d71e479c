"""A solid that has a given mass, mass centre and inertia."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ..file_schema import Solid

__all__ = ["solid_of"]

Floats = npt.NDArray[np.float64]
_BOX = ((-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1))


def solid_of(mass: float, center: Floats, inertia: Floats) -> Solid:
    """Return the uniform box with this mass [kg], mass centre (3,) [m] and inertia (3, 3) about it [kg m^2].

    A box of sides a along its own axes has the second moments m a^2 / 12, which J = trace(I) / 2 - I has as
    principal values: every inertia of a mass is that of one box.
    """
    moments, axes = np.linalg.eigh(0.5 * np.trace(inertia) * np.eye(3) - inertia)
    # The axis nearest to x first, and so on; then each along its own, so that the corners keep their order.
    order = np.argmax(np.abs(axes), axis=1)
    if len(set(order.tolist())) < 3:
        order = np.array([2, 1, 0])
    moments, axes = moments[order], axes[:, order]
    axes = axes * np.where(np.diagonal(axes) < 0.0, -1.0, 1.0)
    if np.linalg.det(axes) < 0.0:
        axes[:, 1] *= -1.0
    half = 0.5 * np.sqrt(12.0 * moments / mass)
    corners = center + (np.array(_BOX, float) * half) @ axes.T
    return Solid(
        name="vehicle",
        corners_m=tuple(tuple(corner) for corner in corners.tolist()),
        mass_kg=mass,
        source=("given",),
        status="measured",
    )
