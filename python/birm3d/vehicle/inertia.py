"""Inertia of a body whose parts stand further from its mass centre, or nearer to it.

Every part of the mass is moved along the axes r, s and t: its distance from the mass centre is multiplied by
one factor for each axis. The second moments about the mass centre are J = integral of r r^T dm, and the
inertia I gives them as J = trace(I) / 2 - I. The new ones are S J S with S = diag(factors). As the moments of
a mass that could be built, they keep every inequality that an inertia has to.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from .zone import positive

__all__ = ["INERTIAS", "UNIT", "spread_factors", "spread_inertia"]

Floats = npt.NDArray[np.float64]

INERTIAS = ("roll_inertia", "pitch_inertia", "yaw_inertia")
"""About the axes r (forward), s (left) and t (up) through the mass centre."""
UNIT = "kg m^2"


def spread_inertia(inertia: Floats, factors: Sequence[float]) -> Floats:
    """Return the inertia (3, 3) [kg m^2] with distances from the mass centre multiplied by factors > 0."""
    moments = _second_moments(inertia)
    scale = np.array(factors)
    moments = scale[:, None] * moments * scale
    return np.asarray(np.trace(moments) * np.eye(3) - moments)


def spread_factors(inertia: Floats, wanted: Mapping[str, float]) -> tuple[float, float, float]:
    """Return the factors of distances along r, s and t that lead to the inertias which are wanted.

    A roll inertia alone changes distances across and up by one factor. A pitch or a yaw inertia then changes
    those along the vehicle, and the other of both follows. Where both are wanted, roll, pitch and yaw inertia
    say how far the mass is spread along each axis.

    Parameters
    ----------
    inertia
        About the mass centre, axes r, s, t, shape (3, 3) [kg m^2].
    wanted
        Names of :data:`INERTIAS`, at least one -> [kg m^2].

    Raises
    ------
    ValueError
        If no mass could have them; the message names the limit.
    """
    now = _second_moments(inertia).diagonal().tolist()
    if not min(now) > 0.0:
        raise ValueError(
            "inertia must be that of a mass in three dimensions to be changed: the sum of any two above the "
            f"third, got {inertia.diagonal().tolist()} {UNIT}"
        )
    values = {name: positive(name, value) for name, value in wanted.items()}
    if {"pitch_inertia", "yaw_inertia"} <= values.keys():
        new = _of_three({"roll_inertia": float(inertia[0, 0]), **values})
    else:
        new = _of_two(now, values)
    x, y, z = (math.sqrt(after / before) for after, before in zip(new, now, strict=True))
    return x, y, z


def _second_moments(inertia: Floats) -> Floats:
    return np.asarray(0.5 * np.trace(inertia) * np.eye(3) - inertia)


def _of_three(values: Mapping[str, float]) -> list[float]:
    """Return the second moments along the axes by the three inertias about them."""
    half = 0.5 * sum(values.values())
    moments = [half - values[name] for name in INERTIAS]
    if not min(moments) > 0.0:
        got = ", ".join(f"{values[name]:g}" for name in INERTIAS)
        raise ValueError(
            f"{', '.join(INERTIAS)} must each be below the sum of the other two, got {got} {UNIT}"
        )
    return moments


def _of_two(now: Sequence[float], values: Mapping[str, float]) -> list[float]:
    """Return the second moments along the axes where pitch or yaw inertia follows from the others."""
    along, across, up = now
    if "roll_inertia" in values:
        factor = values["roll_inertia"] / (across + up)
        across, up = factor * across, factor * up
    for name, least, what in (("pitch_inertia", up, "up and down"), ("yaw_inertia", across, "across")):
        if name in values:
            along = values[name] - least
            if not along > 0.0:
                raise ValueError(
                    f"{name} must be above {least:.5g} {UNIT}, that of the spread of the mass {what}, "
                    f"got {values[name]:g}"
                )
    return [along, across, up]
