"""Occupants that fly freely until they strike the interior: OIV and ridedown, THIV and PHD, and OLC."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .. import units
from .pulse import Pulse, crossing

__all__ = ["FlailSpace", "HeadImpact", "flail_space", "head_impact", "occupant_load"]

Floats = npt.NDArray[np.float64]

FORWARD, LATERAL = 0.6, 0.3
"""Free flight of the occupant within the vehicle [m]: NCHRP 350 appendix A5.3, MASH, EN 1317-1."""
_RIDEDOWN = 10e-3  # window of the mean [s]
# OLC: free flight, then what the restraint has [m].
_SLACK, _RESTRAINT = 0.065, 0.235


class FlailSpace(NamedTuple):
    """Flail-space model of NCHRP 350 and MASH: velocities [m/s], ridedown [g], time of the strike [s].

    The time is ``None`` where the occupant does not get that far; velocities are then the vehicle's change.
    """

    velocity_x: float
    velocity_y: float
    ridedown_x: float
    ridedown_y: float
    time: float | None


class HeadImpact(NamedTuple):
    """Theoretical head of EN 1317-1: relative speed [m/s], deceleration after it [g], time of flight [s]."""

    speed: float
    deceleration: float
    time: float | None


def flail_space(pulse: Pulse) -> FlailSpace:
    """Return occupant impact velocities and ridedown accelerations.

    The occupant goes on at the vehicle's velocity at time zero. It strikes when the acceleration, integrated
    twice in the vehicle's axes, reaches 0.6 m along x or 0.3 m along y, whichever is first. The velocities
    are the integrals until then; ridedown is the greatest 10-ms mean that begins later. A window that
    reaches beyond the record has no acceleration there.
    """
    pulse.require_axes("the occupant impact velocity", "x", "y")
    time, velocity = pulse.since_zero()
    strikes = []
    for axis, flight in ((0, FORWARD), (1, LATERAL)):
        for sign in (1.0, -1.0):
            moved, rate = sign * pulse.displacement[:, axis], sign * velocity[:, axis]
            strikes.append(crossing(time, moved, rate, flight))
    found = [strike for strike in strikes if strike is not None]
    if not found:
        pulse.require(np.inf, "the flight of the occupant")
        x, y = (abs(float(v)) for v in velocity[-1, :2])
        return FlailSpace(x, y, 0.0, 0.0, None)
    strike = min(found)
    pulse.require(strike + _RIDEDOWN, "the occupant impact velocity and 10 ms of ridedown")
    x, y = (abs(float(np.interp(strike, time, velocity[:, axis]))) for axis in (0, 1))
    means = np.abs(pulse.change_over(_RIDEDOWN, strike)).max(axis=0)
    return FlailSpace(x, y, float(means[0]), float(means[1]), strike)


def head_impact(pulse: Pulse, head_x: float) -> HeadImpact:
    """Return THIV and PHD: a planar motion with yaw, the head 0.6 m from the front and 0.3 m from the sides.

    The head starts on the vehicle's longitudinal axis, `head_x` [m] before the point of the pulse. It keeps
    the velocity that this point had at time zero. PHD is the greatest 10-ms mean of the magnitude of the
    horizontal acceleration after the strike.
    """
    pulse.require_axes("THIV and PHD", "x", "y", "yaw_rate")
    time, _ = pulse.since_zero()
    rate = pulse.yaw_rate[pulse.zero :]
    steps = np.diff(pulse.velocity[pulse.zero :, :2], axis=0)
    yaw = np.concatenate([[0.0], np.cumsum(0.5 * (rate[1:] + rate[:-1]) * np.diff(time))])
    middle = 0.5 * (yaw[1:] + yaw[:-1])
    gained = _turned(steps, middle)  # in axes that move on as the vehicle did at time zero
    motion = np.concatenate([np.zeros((1, 2)), np.cumsum(gained, axis=0)])
    areas = 0.5 * (motion[1:] + motion[:-1]) * np.diff(time)[:, None]
    displacement = np.concatenate([np.zeros((1, 2)), np.cumsum(areas, axis=0)])
    place = _turned(np.array([head_x, 0.0]) - displacement, -yaw)
    speed = _turned(-motion, -yaw) - rate[:, None] * np.column_stack([-place[:, 1], place[:, 0]])
    strikes = [
        crossing(time, sign * (place[:, axis] - start), sign * speed[:, axis], flight)
        for axis, start, flight in ((0, head_x, FORWARD), (1, 0.0, LATERAL))
        for sign in (1.0, -1.0)
    ]
    found = [strike for strike in strikes if strike is not None]
    if not found:
        pulse.require(np.inf, "the flight of the theoretical head")
        return HeadImpact(math.hypot(*speed[-1].tolist()), 0.0, None)
    strike = min(found)
    pulse.require(strike + _RIDEDOWN, "THIV and 10 ms of PHD")
    there = [float(np.interp(strike, time, speed[:, axis])) for axis in (0, 1)]
    deceleration = _greatest_mean_magnitude(time, steps, strike)
    return HeadImpact(math.hypot(*there), deceleration, strike)


def occupant_load(pulse: Pulse) -> float:
    """Return the occupant load criterion [g].

    The occupant flies freely over 65 mm within the vehicle. Then one deceleration holds it, with which it has
    the vehicle's speed after another 235 mm. It is 0 where the vehicle does not lose so much speed.
    """
    pulse.require_axes("OLC", "x")
    time, velocity = pulse.since_zero()
    lost, ahead = -velocity[:, 0], -pulse.displacement[:, 0]
    restrained_at = crossing(time, ahead, lost, _SLACK)
    if restrained_at is None:
        pulse.require(np.inf, "the occupant load criterion")
        return 0.0
    later = time > restrained_at
    instants, lost, ahead = time[later], lost[later], ahead[later]
    # Held at the deceleration lost / (t - held), the occupant moves by half of what it would without.
    moved = ahead - 0.5 * lost * (instants - restrained_at)
    full = np.flatnonzero(moved >= _SLACK + _RESTRAINT)
    if len(full) == 0:
        pulse.require(np.inf, "the occupant load criterion")
        return 0.0
    k = int(full[0])
    if k == 0:
        end, speed = float(instants[0]), float(lost[0])
    else:
        fraction = (_SLACK + _RESTRAINT - moved[k - 1]) / (moved[k] - moved[k - 1])
        end = float(instants[k - 1] + fraction * (instants[k] - instants[k - 1]))
        speed = float(lost[k - 1] + fraction * (lost[k] - lost[k - 1]))
    pulse.require(end, "the occupant load criterion")
    return speed / (end - restrained_at) / units.g


def _greatest_mean_magnitude(time: Floats, steps: Floats, start: float) -> float:
    """Return the greatest 10-ms mean of the horizontal acceleration's magnitude after an instant [g]."""
    magnitude = np.concatenate([[0.0], np.cumsum(np.hypot(steps[:, 0], steps[:, 1]))])
    begins = np.union1d(time, time - _RIDEDOWN)
    begins = begins[(begins >= start) & (begins + _RIDEDOWN <= time[-1])]
    begins = np.concatenate([[start], begins])
    gained = np.interp(begins + _RIDEDOWN, time, magnitude) - np.interp(begins, time, magnitude)
    return float(gained.max() / (_RIDEDOWN * units.g))


def _turned(vectors: Floats, angle: Floats) -> Floats:
    """Return vectors (n, 2) or (2,) turned to the left by angles (n,) [rad]."""
    x, y = np.broadcast_to(vectors, (len(angle), 2)).T
    cos, sin = np.cos(angle), np.sin(angle)
    return np.column_stack([cos * x - sin * y, sin * x + cos * y])
