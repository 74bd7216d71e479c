"""Motion of the vehicle's compartment during an impact, as occupant risk is computed from it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from .. import units
from ..signals.channel import Channel
from .time_zero import require_rest_before

if TYPE_CHECKING:
    from ..result import Result
    from ..units import Quantity

__all__ = ["Pulse", "crossing", "pulse_of_channels", "pulse_of_result"]

Floats = npt.NDArray[np.float64]

AXES = ("x", "y", "z")
# How long a settled vehicle is followed past the end of its record: a head at 0.3 m/s arrives [s].
_FOLLOWED = 2.0
# A record is settled where the mean over its last rows is below this, or below this share of its peak.
_LAST = 2e-3
_SETTLED_G = 0.5
_SETTLED_SHARE = 0.05
# Below this change of velocity nothing has been hit [m/s].
_NO_IMPACT = 0.05


@dataclass(frozen=True, eq=False)
class Pulse:
    """Change of velocity of a point of the vehicle, integrated in the vehicle's own axes from time zero.

    Attributes
    ----------
    time : ndarray, shape (n,)
        Evenly spaced, one instant is 0, the impact [s].
    velocity : ndarray, shape (n, 3)
        Integral of the accelerations along x, y, z (forward, left, up) since time zero [m/s]; linear between
        the instants.
    yaw_rate : ndarray, shape (n,)
        [rad/s]
    known : tuple of str
        Of ``"x"``, ``"y"``, ``"z"``, ``"yaw_rate"`` those that were given; the others are zero.
    end : float
        Last instant of the record [s]; rows after that go on without acceleration.
    last : float
        Magnitude of the acceleration at the end of the record [g].
    settled : bool
        Whether it has died away by then, so that the motion after the record is known.
    source : str
    """

    time: Floats
    velocity: Floats
    yaw_rate: Floats
    known: tuple[str, ...]
    end: float
    last: float
    settled: bool
    source: str

    @property
    def interval(self) -> float:
        """Between the instants [s]."""
        return float(self.time[1] - self.time[0])

    @property
    def zero(self) -> int:
        """Row of time zero."""
        return int(np.argmin(np.abs(self.time)))

    def since_zero(self) -> tuple[Floats, Floats]:
        """Return the instants from time zero on, and the changes of velocity."""
        return self.time[self.zero :], self.velocity[self.zero :]

    @cached_property
    def displacement(self) -> Floats:
        """Integral of the change of velocity since time zero, rows from there on, shape (m, 3) [m]."""
        time, velocity = self.since_zero()
        return _integral(time, velocity)

    def require(self, until: float, what: str) -> None:
        """Refuse a record that ends before an instant while the vehicle is still pushed.

        Raises
        ------
        ValueError
            Naming the instant, and where the record ends.
        """
        if until > self.end + 1e-9 and not self.settled:
            raise ValueError(
                f"time must reach at least {until:.4f} s after the impact for {what}, or until the "
                f"acceleration has died away; got {self.source}, which ends at {self.end:.4f} s at "
                f"{self.last:.1f} g"
            )

    def require_axes(self, what: str, *names: str) -> None:
        """Refuse a record without the channels that a value is made of.

        Raises
        ------
        ValueError
            Naming the missing one.
        """
        for name in names:
            if name not in self.known:
                raise ValueError(
                    f"{name} must be given for {what} (a Channel, or 0 if there was none), got None"
                )

    def change_over(self, width: float, start: float = 0.0) -> Floats:
        """Return mean accelerations over windows of a width that begin at or after an instant, (k, 3) [g].

        Windows begin or end at a row: between those the mean is linear, so that no other is greater.
        """
        begins = np.union1d(self.time, self.time - width)
        begins = begins[(begins >= start) & (begins + width <= self.time[-1])]
        begins = np.concatenate([[start], begins])
        change = self._at(begins + width) - self._at(begins)
        return change / (width * units.g)

    def _at(self, instants: Floats) -> Floats:
        return np.column_stack([np.interp(instants, self.time, column) for column in self.velocity.T])


def pulse_of_channels(channels: Mapping[str, Channel | float | None], time_zero: float) -> Pulse:
    """Return the motion that accelerometers and a rate gauge have recorded.

    Parameters
    ----------
    channels
        ``"x"``, ``"y"``, ``"z"``, ``"yaw_rate"`` -> channel, 0 for a motion without it, ``None`` where it is
        not known. Rows of the first one that is a channel, which must be even.
    time_zero
        Instant of the impact in the channels' time [s].

    Raises
    ------
    ValueError
        If there is no channel, one measures another quantity, the records do not hold time zero, or the
        velocity changes before it.
    """
    given = {name: value for name, value in channels.items() if isinstance(value, Channel)}
    for name, value in channels.items():
        if value is not None and not isinstance(value, Channel) and value != 0.0:
            raise ValueError(f"{name} must be a Channel, or 0 for a motion without it; got {value!r}")
        if name in ("x", "y") and value is None:
            raise ValueError(f"{name} must be a Channel, or 0 for a motion without it; got None")
    for name, channel in given.items():
        quantity = "angular velocity" if name == "yaw_rate" else "acceleration"
        if channel.quantity != quantity:
            raise ValueError(
                f"{name} must measure {quantity}, got {channel!r}, which measures {channel.quantity}"
            )
    if not any(name in given for name in ("x", "y")):
        raise ValueError("x or y must be a Channel, got 0 for both")
    if not math.isfinite(time_zero):
        raise ValueError(f"time_zero must be finite (s), got {time_zero}")
    for name, channel in given.items():
        first, last = float(channel.time[0]), float(channel.time[-1])
        if not first - 1e-9 <= time_zero < last:
            raise ValueError(
                f"time of {name} must hold time zero, the instant of the impact ({time_zero:g} s; see "
                f"Channel.shifted), got {channel.name!r} from {first:g} to {last:g} s"
            )
        if name in AXES:
            require_rest_before(name, channel, time_zero)
    leading = next(iter(given.values()))
    interval = leading.interval
    first = max(float(channel.time[0]) for channel in given.values()) - time_zero
    last = min(float(channel.time[-1]) for channel in given.values()) - time_zero
    time = _even(interval, math.ceil(first / interval - 1e-6), math.floor(last / interval + 1e-6) + 1)
    if len(time) < 3:
        raise ValueError(f"time must have at least 3 rows that all channels share, got {len(time)}")
    velocity = np.zeros((len(time), 3))
    for i, name in enumerate(AXES):
        if name in given:
            velocity[:, i] = _integrated(given[name].to_si(), time, time_zero)
    rate = given.get("yaw_rate")
    spin = np.zeros(len(time))
    if rate is not None:
        turned = rate.to_si()
        spin = np.radians(np.interp(time + time_zero, turned.time, turned.values))
    known = tuple(name for name, value in channels.items() if value is not None)
    return _followed(time, velocity, spin, known, ", ".join(repr(channel.name) for channel in given.values()))


def pulse_of_result(result: Result, point: str | Sequence[Quantity], part: str | int | None) -> Pulse:
    """Return the motion of a point of a computed run; time zero is the first touch of the barrier.

    Raises
    ------
    ValueError
        If the vehicle does not touch a barrier, or the run has fewer than three rows.
    """
    if result.scene.barrier is None:
        raise ValueError("result must have a barrier for occupant risk, got None")
    touching = np.flatnonzero(result.sum_of_contact_forces > 0.0)
    if len(touching) == 0:
        raise ValueError(f"result must have a contact with the barrier for occupant risk, got {result!r}")
    if len(result.time) < 3:
        raise ValueError(f"result must have at least 3 rows for occupant risk, got {len(result.time)}")
    zero = max(0, int(touching[0]) - 1)
    sensor = result.sensor(point, part)
    steps = np.diff(result.time)[:, None] * sensor.in_body_axes()[1:]
    velocity = np.concatenate([np.zeros((1, 3)), np.cumsum(steps, axis=0)])
    interval = float(result.time[1] - result.time[0])
    time = _even(interval, -zero, len(result.time) - zero)
    spin = np.radians(sensor.angular_velocity[:, 2])
    known = (*AXES, "yaw_rate")
    return _followed(
        time, velocity - velocity[zero], spin, known, repr(result), result.outcome != "undecided"
    )


def _integrated(channel: Channel, time: Floats, time_zero: float) -> Floats:
    """Return the integral of a channel from time zero to each instant; linear between its rows."""
    instants = np.union1d(channel.time - time_zero, time)
    values = np.interp(instants, channel.time - time_zero, channel.values)
    area = _integral(instants, values[:, None])[:, 0]
    return np.interp(time, instants, area) - np.interp(0.0, instants, area)


def _followed(
    time: Floats, velocity: Floats, spin: Floats, known: tuple[str, ...], source: str, decided: bool = False
) -> Pulse:
    interval, end = float(time[1] - time[0]), float(time[-1])
    if np.abs(velocity - velocity[int(np.argmin(np.abs(time)))]).max() < _NO_IMPACT:
        raise ValueError(
            f"x and y must show an impact, a change of velocity above {_NO_IMPACT} m/s, got {source} with "
            f"{np.abs(velocity).max():.3g} m/s"
        )
    means = np.abs(np.diff(velocity, axis=0)) / (interval * units.g)
    rows = max(1, round(_LAST / interval))
    last = float(np.abs(velocity[-1] - velocity[-1 - rows]).max() / (rows * interval * units.g))
    settled = decided or last <= max(_SETTLED_G, _SETTLED_SHARE * float(means.max()))
    more = max(0, math.ceil((_FOLLOWED - end) / interval))
    first = round(float(time[0]) / interval)
    return Pulse(
        _even(interval, first, first + len(time) + more),
        np.concatenate([velocity, np.repeat(velocity[-1:], more, axis=0)]),
        np.concatenate([spin, np.full(more, spin[-1])]),
        known,
        end,
        last,
        settled,
        source,
    )


def _even(interval: float, first: int, end: int) -> Floats:
    """Return instants at whole numbers of intervals [s]."""
    return interval * np.arange(first, end, dtype=np.float64)


def _integral(time: Floats, rows: Floats) -> Floats:
    """Return the integral of rows (n, k) since the first one, by the trapezoid rule."""
    areas = 0.5 * (rows[1:] + rows[:-1]) * np.diff(time)[:, None]
    return np.concatenate([np.zeros((1, rows.shape[1])), np.cumsum(areas, axis=0)])


def crossing(time: Floats, value: Floats, rate: Floats, level: float) -> float | None:
    """Return when a value first reaches a level [s]; ``None`` if it does not.

    Between rows the value follows its rate, which is linear there.

    Parameters
    ----------
    time, value, rate
        Shape (n,) each; `rate` is the derivative of `value`.
    level
        Above the first value.
    """
    beyond = np.flatnonzero(value >= level)
    if len(beyond) == 0:
        return None
    k = int(beyond[0])
    if k == 0:
        return float(time[0])
    step = float(time[k] - time[k - 1])
    missing = level - float(value[k - 1])
    half_slope = 0.5 * float(rate[k] - rate[k - 1]) / step
    speed = float(rate[k - 1])
    root = speed * speed + 4.0 * half_slope * missing
    # The form that has no difference of near numbers; the chord where the rates do not reach the level.
    within = 2.0 * missing / (speed + math.sqrt(root)) if root >= 0.0 and speed > 0.0 else math.inf
    if not 0.0 <= within <= step:
        within = step * missing / float(value[k] - value[k - 1])
    return float(time[k - 1]) + within
