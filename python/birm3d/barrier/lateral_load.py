"""Closed forms that a barrier's lateral load is judged by: no simulation, only mass, speed, angle and size.

They bound a computed redirection; none of them is a measurement.
"""

from __future__ import annotations

import math

__all__ = ["NORMAL_IMPULSE", "TL_3_FORCE", "normal_momentum", "olson_mean_force", "olson_peak_force"]

TL_3_FORCE = 240e3
"""Transverse design force of test level 3, AASHTO LRFD Bridge Design Specifications, Table A13.2-1 [N]."""

NORMAL_IMPULSE = (1.0, 1.3)
"""Usual range of the wall's normal impulse over m v sin(angle): 1 + e_n with e_n of 0 to about 0.3."""


def normal_momentum(mass: float, speed: float, angle: float) -> float:
    """Return m v sin(angle), the momentum towards the barrier [N s].

    Parameters
    ----------
    mass, speed
        [kg], [m/s].
    angle
        Of the path from the barrier's line [deg].
    """
    return mass * speed * math.sin(math.radians(angle))


def olson_mean_force(
    mass: float, speed: float, angle: float, *, front: float, half_width: float, deflection: float = 0.0
) -> float:
    """Return the mean lateral force until the vehicle is parallel to the barrier [N].

    Olson, Post and McFarland, NCHRP Report 86 (1970). A constant force F = m (v sin a)^2 / (2 s) takes the
    lateral velocity v sin a. Meanwhile the mass centre moves by
    s = front sin a - half_width (1 - cos a) + deflection.
    The vehicle's corner is taken as rigid apart from that: a lower bound.

    Parameters
    ----------
    mass, speed
        [kg], [m/s].
    angle
        Of the path from the barrier's line [deg].
    front
        From the mass centre forward to the vehicle's front [m].
    half_width
        Of the vehicle [m].
    deflection
        Of the barrier [m].

    Raises
    ------
    ValueError
        If the numbers leave no distance for the mass centre.
    """
    a = math.radians(angle)
    distance = front * math.sin(a) - half_width * (1.0 - math.cos(a)) + deflection
    if not distance > 0.0:
        raise ValueError(f"the lateral distance of the mass centre must be > 0 m, got {distance:g}")
    return normal_momentum(mass, speed, angle) ** 2 / (2.0 * mass * distance)


def olson_peak_force(
    mass: float, speed: float, angle: float, *, front: float, half_width: float, deflection: float = 0.0
) -> float:
    """Return pi / 2 times :func:`olson_mean_force`, the peak of half a sine of that mean [N]."""
    mean = olson_mean_force(mass, speed, angle, front=front, half_width=half_width, deflection=deflection)
    return 0.5 * math.pi * mean
