"""Motion of any point of the vehicle: what an accelerometer or a rate gauge fixed there would record."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ..base.arguments import checked
from ..base.checks import index
from ..signals.channel import Channel
from ..unit_check import warn_if_far_from_skin
from ..units import Quantity, Stated, si
from .unit_result import read_only

if TYPE_CHECKING:
    from ..vehicle.vehicle import Vehicle
    from .record import RunRecord

__all__ = ["Sensor", "place_sensor"]

Floats = npt.NDArray[np.float64]

_AXES = {"x": 0, "y": 1, "z": 2}
_RATES = {"roll_rate": 0, "pitch_rate": 1, "yaw_rate": 2}
_UNITS = {"acceleration": "m/s^2", "velocity": "m/s", "position": "m"}


@checked
class Sensor:
    """A point that moves with one rigid body of the vehicle; :meth:`birm3d.Result.sensor` places it.

    The point has the position x + R p and the velocity v + w x R p. Here x and v are place and velocity of
    the mass centre, and R is the rotation from body to world axes. The vector w is the angular velocity in
    world axes and p the lever in body axes. Its acceleration is the mean of that velocity's change over the
    output interval, as the accelerations of :class:`birm3d.Result` are. So it has the angular and the
    centripetal part, and adds up to the change of velocity exactly. Gravity is not taken off: the channel of
    a vehicle at rest is zero.

    Attributes
    ----------
    name : str
    part : str
        Name of the unit of the vehicle that it is fixed to.
    point : ndarray, shape (3,)
        In the axes of that unit's file [m].
    lever : ndarray, shape (3,)
        From the unit's mass centre, body axes r, s, t (forward, left, up) [m].
    """

    def __init__(self, result: RunRecord, name: str, point: npt.ArrayLike, unit: int = 0) -> None:
        vehicle = result.scene.vehicle.units[index("unit", unit, len(result.scene.vehicle.units), "units")]
        self.name = name
        self.part = vehicle.name
        self.point = read_only(point)
        if self.point.shape != (3,) or not np.isfinite(self.point).all():
            raise ValueError(f"point must be three finite numbers (m), got {np.asarray(point).tolist()}")
        self.lever = read_only(self.point - vehicle.center_of_mass)
        self._result = result
        self._unit = unit

    @property
    def time(self) -> Floats:
        """Shape (n,) [s]."""
        return self._result.time

    @cached_property
    def rotation(self) -> Floats:
        """From body to world axes, shape (n, 3, 3)."""
        return self.rotation_at(slice(None))

    def rotation_at(self, rows: Any) -> Floats:
        """Return the rotations from body to world axes at some rows, shape (k, 3, 3)."""
        return read_only(_rotations(self._result._history.unit(self._unit).roll_pitch_yaw[rows]))

    @cached_property
    def position(self) -> Floats:
        """World axes, shape (n, 3) [m]."""
        center = self._result.unit(self._unit).position
        return read_only(center + self.rotation @ self.lever if self.lever.any() else center)

    @cached_property
    def velocity(self) -> Floats:
        """World axes, shape (n, 3) [m/s]."""
        unit = self._result.unit(self._unit)
        spin = np.cross(np.radians(unit.angular_velocity), self.lever)
        return read_only(unit.velocity + _turned(self.rotation, spin))

    @cached_property
    def acceleration(self) -> Floats:
        """World axes, shape (n, 3) [m/s^2]; means over the interval that ends at the row.

        The first row: over the interval that begins there.
        """
        if len(self.time) == 1:
            return read_only(np.zeros((1, 3)))
        means = np.diff(self.velocity, axis=0) / np.diff(self.time)[:, None]
        return read_only(np.concatenate([means[:1], means]))

    @property
    def angular_velocity(self) -> Floats:
        """Of the body that it is fixed to, body axes, shape (n, 3) [deg/s]."""
        return self._result.unit(self._unit).angular_velocity

    def in_body_axes(self, quantity: str = "acceleration") -> Floats:
        """Return ``"acceleration"`` or ``"velocity"`` in body axes r, s, t, shape (n, 3), SI."""
        _one_of("quantity", quantity, ("acceleration", "velocity"))
        return read_only(_turned(np.swapaxes(self.rotation, 1, 2), getattr(self, quantity)))

    def channel(
        self,
        axis: str = "x",
        cfc: float | None = None,
        *,
        quantity: str = "acceleration",
        axes: str = "body",
    ) -> Channel:
        """Return one component as a channel, as it would be recorded.

        Parameters
        ----------
        axis
            ``"x"``, ``"y"``, ``"z"``: forward, left, up in body axes; ``"resultant"``: the magnitude of all
            three; ``"roll_rate"``, ``"pitch_rate"``, ``"yaw_rate"``: of the body, about r, s, t [deg/s].
        cfc
            Channel frequency class (SAE J211-1), see :func:`birm3d.filters.cfc`; ``None``: not filtered.
        quantity
            ``"acceleration"`` [m/s^2], ``"velocity"`` [m/s] or ``"position"`` [m], which has world axes only.
        axes
            ``"body"`` or ``"world"`` (z up, the barrier's line along +y at heading 0).

        Raises
        ------
        ValueError
            If a word is none of these, or the output interval is too coarse for the class.
        """
        _one_of("axis", axis, (*_AXES, "resultant", *_RATES))
        _one_of("quantity", quantity, tuple(_UNITS))
        _one_of("axes", axes, ("body", "world"))
        if axis in _RATES:
            values, unit = self.angular_velocity[:, _RATES[axis]], "deg/s"
            label = f"{self.name}: {axis.replace('_', ' ')}"
        else:
            rows, unit = self._rows(quantity, axes), _UNITS[quantity]
            values = np.linalg.norm(rows, axis=1) if axis == "resultant" else rows[:, _AXES[axis]]
            label = f"{self.name}: {quantity} {axis}"
        info = {"part": self.part, "point": " ".join(f"{x:g}" for x in self.point), "axes": axes}
        channel = Channel(label, self.time, values, unit, source="BIRM3D", info=info)
        return channel if cfc is None else channel.filtered(cfc)

    def _rows(self, quantity: str, axes: str) -> Floats:
        if axes == "body":
            if quantity == "position":
                raise ValueError("axes must be 'world' for a position, got 'body', in which it does not move")
            return self.in_body_axes(quantity)
        rows: Floats = getattr(self, quantity)
        return rows

    def __repr__(self) -> str:
        x, y, z = self.point
        return f"Sensor({self.name!r} of {self.part} at ({x:g}, {y:g}, {z:g}) m, {len(self.time)} rows)"


def place_sensor(
    result: RunRecord, point: str | Sequence[Quantity], part: str | int | None, name: str = "point"
) -> Sensor:
    """Return the sensor at a point, which messages call by a name; see :meth:`birm3d.Result.sensor`."""
    units = result.scene.vehicle.units
    which = None if part is None else _unit_of(units, part)
    if not isinstance(point, str):
        if len(point) != 3:
            raise ValueError(f"{name} must be three numbers (m) or the name of a point, got {point}")
        place = [si(name, value, "length") for value in point]
        if not np.isfinite(place).all():
            raise ValueError(f"{name} must be three finite numbers (m), got {place}")
        _warn_if_far(units[which or 0], point, place, name)
        return Sensor(result, "({:g}, {:g}, {:g}) m".format(*place), np.array(place), which or 0)
    if which is None:
        having = [i for i, unit in enumerate(units) if point in unit.points]
        # Each unit has a mass_center; the leading unit's is meant.
        if len(having) > 1 and point != "mass_center":
            names = " or ".join(repr(units[i].name) for i in having)
            raise ValueError(f"part must be {names}: each has a point {point!r}, got None")
        which = having[0] if having else 0
    known = units[which].points
    if point not in known:
        named = known if part is not None else dict.fromkeys(one for unit in units for one in unit.points)
        raise ValueError(
            f"{name} must be one of {', '.join(named)}, or three numbers (m) in the axes of the vehicle's "
            f"file; got {point!r} of {units[which].name!r}"
        )
    return Sensor(result, point, np.asarray(known[point], float), which)


def _warn_if_far(unit: Vehicle, point: Sequence[Quantity], place: Sequence[float], name: str) -> None:
    """Warn of a place far outside the box about a unit's skin and its mass centre."""
    low, high = unit.skin_bounds
    box = np.minimum(low, 0.0) + unit.center_of_mass, np.maximum(high, 0.0) + unit.center_of_mass
    stated = [isinstance(value, (str, Stated)) for value in point]
    warn_if_far_from_skin(place, box[0].tolist(), box[1].tolist(), stated, name)


def _unit_of(units: Sequence[Vehicle], part: str | int) -> int:
    names = [unit.name for unit in units]
    if isinstance(part, str):
        if part not in names:
            raise ValueError(f"part must be one of {', '.join(names)}; got {part!r}")
        return names.index(part)
    return index("part", part, len(units), "units")


def _rotations(roll_pitch_yaw: Floats) -> Floats:
    """Return rotations from body to world axes (k, 3, 3) of angles (k, 3) [rad]: yaw, pitch, roll in turn."""
    (cr, cp, cy), (sr, sp, sy) = np.cos(roll_pitch_yaw).T, np.sin(roll_pitch_yaw).T
    axes = np.empty((len(roll_pitch_yaw), 3, 3))
    axes[:, 0, 0], axes[:, 0, 1], axes[:, 0, 2] = cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr
    axes[:, 1, 0], axes[:, 1, 1], axes[:, 1, 2] = sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr
    axes[:, 2, 0], axes[:, 2, 1], axes[:, 2, 2] = -sp, cp * sr, cp * cr
    return axes


def _turned(rotation: Floats, vectors: Floats) -> Floats:
    turned: Floats = np.einsum("nij,nj->ni", rotation, vectors)
    return turned


def _one_of(name: str, value: str, known: Sequence[str]) -> None:
    if value not in known:
        raise ValueError(f"{name} must be one of {', '.join(known)}; got {value!r}")
