"""Computed quantities that a measured curve can be held against."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Literal

import numpy as np
import numpy.typing as npt

from ..signals.filters import cfc

if TYPE_CHECKING:
    from ..result.result import Result

__all__ = ["QUANTITIES", "Quantity", "computed_curve", "touch_time"]

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Quantity:
    """What a quantity is, and how it goes on once the outcome is decided.

    Attributes
    ----------
    label, unit
        For axes and messages; SI, degrees.
    interval_mean
        Whether a row is the mean over the output interval before it, and stands for the interval's middle.
    afterwards
        After a run that ended by separation or at rest: ``"zero"`` (forces), ``"constant"`` (velocities) or
        ``"linear"`` (displacement and angles go on at their last rate).
    positive
        What a positive value means.
    """

    label: str
    unit: str
    interval_mean: bool
    afterwards: Literal["zero", "constant", "linear"]
    positive: str


QUANTITIES: Mapping[str, Quantity] = MappingProxyType(
    {
        "normal_force": Quantity(
            "force along the normal", "N", True, "zero", "pushes the vehicle off the barrier"
        ),
        "acceleration_r": Quantity("acceleration along r", "m/s^2", True, "zero", "forward in the vehicle"),
        "acceleration_normal": Quantity(
            "acceleration along the normal", "m/s^2", True, "zero", "towards the barrier"
        ),
        "velocity_normal": Quantity("velocity", "m/s", False, "constant", "towards the barrier"),
        "displacement_normal": Quantity("displacement", "m", False, "linear", "towards the barrier"),
        "roll": Quantity("roll", "deg", False, "linear", "right side down"),
        "pitch": Quantity("pitch", "deg", False, "linear", "nose-down"),
        "yaw": Quantity("yaw", "deg", False, "linear", "to the left"),
    }
)
"""Of the mass centre; velocity and displacement towards the barrier, displacement from the first touch."""


def touch_time(result: Result) -> float:
    """Return when the vehicle first touches the barrier [s]: the time zero of a test."""
    scene = result.scene
    if scene.standoff == 0.0 or scene.barrier is None:
        return 0.0
    return scene.standoff / (scene.impact_speed * math.sin(math.radians(scene.impact_angle)))


def computed_curve(
    result: Result,
    quantity: str,
    at: Floats,
    against: Literal["time", "displacement"] = "time",
    channel_class: float | None = None,
) -> Floats:
    """Return a computed quantity where a measured curve has its points.

    Against time [s] it is interpolated between rows; after a run that ended by itself it goes on as
    ``Quantity.afterwards`` says. Against displacement [m] the loading branch counts, from the first touch to
    the greatest displacement, whose value is held beyond.

    Parameters
    ----------
    quantity
        One of :data:`QUANTITIES`.
    at
        Shape (n,), time since the first touch [s] or displacement [m].
    channel_class
        CFC (SAE J211-1) applied before the interpolation.

    Returns
    -------
    ndarray, shape (n,)
    """
    kind = QUANTITIES[quantity]
    values = _rows(result, quantity)
    time = result.time - touch_time(result)
    interval = result.scene.settings.output_interval
    if channel_class is not None:
        values = cfc(values, channel_class, interval)
    if against == "displacement":
        displacement = _rows(result, "displacement_normal")
        end = int(np.argmax(displacement)) + 1
        if kind.interval_mean:
            middle = 0.5 * (displacement[1:end] + displacement[: end - 1])
            return np.interp(at, middle, values[1:end])
        return np.interp(at, displacement[:end], values[:end])
    if kind.interval_mean:
        # Row 0 repeats the mean of the first interval.
        time, values = time[1:] - 0.5 * np.diff(time), values[1:]
    computed = np.interp(at, time, values)
    after = at > time[-1]
    if kind.afterwards == "zero":
        computed[after & (at > time[-1] + interval)] = 0.0
    elif kind.afterwards == "linear" and len(time) > 1:
        rate = (values[-1] - values[-2]) / (time[-1] - time[-2])
        computed[after] = values[-1] + rate * (at[after] - time[-1])
    return computed


def _rows(result: Result, quantity: str) -> Floats:
    """One value a row of the result, shape (n,)."""
    if quantity == "normal_force":
        return result.barrier_normal_force
    if quantity == "acceleration_r":
        return result.acceleration[:, 0]
    if quantity in ("roll", "pitch", "yaw"):
        return np.asarray(getattr(result, quantity))
    scene = result.scene
    if scene.barrier is None:
        raise ValueError(f"quantity {quantity!r} needs a barrier, got a scene without one")
    inward = -np.asarray(scene.barrier.core.normal)
    if quantity == "velocity_normal":
        return np.asarray(result.velocity @ inward)
    if quantity == "displacement_normal":
        return np.asarray((result.position - result.position[0]) @ inward - scene.standoff)
    # Change of velocity over each interval: the interval mean, as the accelerations of the result are.
    change = np.diff(result.velocity @ inward) / np.diff(result.time)
    return np.concatenate([change[:1], change])
