"""Barriers that stand free on the ground: what their segments are, and how far they move."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from .. import _core
from ..base.arguments import check_fields
from ..signals.filters import moving_average
from ..units import Quantity, si

if TYPE_CHECKING:
    from ..result.result import Result
    from .base import Barrier

__all__ = ["FreeStanding", "base_corners", "is_pinned", "lateral_movement", "overturning_ratio"]

Floats = npt.NDArray[np.float64]

_CONCRETE = 2400.0  # kg/m^3
_WINDOW = 0.05  # s


@dataclass(frozen=True)
class FreeStanding:
    """Segments that stand on the ground by their weight and slide when they are hit.

    A segment moves along the ground and turns about the vertical. It does not tip: how near it comes to that
    is in :attr:`birm3d.Result.overturning_ratio`. Its mass and inertia follow from its solid. What pushes it
    down adds to its weight on the ground, evenly over its base; Coulomb friction acts at the four corners.

    Parameters
    ----------
    density
        Of the solid [kg/m^3]; ``None``: that of concrete, 2400, or what ``mass_per_length`` asks for.
    mass_per_length
        Instead of the density [kg/m].
    ground_friction
        Coulomb coefficient of the base on the ground, >= 0. The default for concrete on asphalt is an
        estimate: 0.4 to 0.6 are usual in models of such barriers. Give your own where deflection matters.
    joint
        ``"pinned"``: neighbours are held together at the middle of their ends and turn freely about the
        vertical; ``"loose"``: nothing is between them, they do not even touch each other.

    Raises
    ------
    ValueError
        If a number is out of range; the message names argument, limit and value.
    """

    density: float | None = None
    mass_per_length: float | None = None
    ground_friction: float = 0.5
    joint: str = "pinned"

    if TYPE_CHECKING:  # what dataclass makes, and the text that __post_init__ reads

        def __init__(
            self,
            density: Quantity | None = None,
            mass_per_length: Quantity | None = None,
            ground_friction: float = 0.5,
            joint: str = "pinned",
        ) -> None: ...

    def __post_init__(self) -> None:
        check_fields(self, texts=("density", "mass_per_length"))
        if self.density is not None and self.mass_per_length is not None:
            raise ValueError(
                f"mass_per_length must be None where density is given, got {self.mass_per_length}"
            )
        for name, quantity in (("density", "density"), ("mass_per_length", "mass per length")):
            value = getattr(self, name)
            if value is not None:
                value = si(name, value, quantity)
                object.__setattr__(self, name, value)
            if value is not None and not 0.0 < value < math.inf:
                raise ValueError(f"{name} must be finite and > 0, got {value}")
        if not 0.0 <= self.ground_friction < math.inf:
            raise ValueError(f"ground_friction must be finite and >= 0, got {self.ground_friction}")
        if self.joint not in _core.SegmentJoint.__members__:
            known = ", ".join(_core.SegmentJoint.__members__)
            raise ValueError(f"joint must be one of {known}; got {self.joint!r}")

    def core(self, area: float) -> _core.FreeStanding:
        """Return the same for the core; ``area`` of the section [m^2]."""
        density = _CONCRETE if self.density is None else self.density
        if self.mass_per_length is not None:
            density = self.mass_per_length / area
        return _core.FreeStanding(
            density=density,
            ground_friction=self.ground_friction,
            joint=_core.SegmentJoint.__members__[self.joint],
        )


def is_pinned(barrier: Barrier | None) -> bool:
    """Whether a barrier has segments that are pinned to each other."""
    free = getattr(barrier, "free_standing", None)
    return free is not None and free.joint == "pinned"


def base_corners(result: Result) -> Floats:
    """Return the four corners of each segment's base over time, around it, world, shape (n, k, 4, 2) [m]."""
    barrier = result.scene.barrier
    segments = [] if barrier is None else barrier.core.segments
    own = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    half = np.array([[segment.half_base, segment.half_length] for segment in segments]).reshape(-1, 1, 2)
    heading = 0.0 if barrier is None else barrier.heading
    angle = np.radians(heading + result.segment_yaw)[..., None]
    x, y = np.moveaxis(own * half, -1, 0)
    turned = np.stack([np.cos(angle) * x - np.sin(angle) * y, np.sin(angle) * x + np.cos(angle) * y], axis=-1)
    return np.asarray(result.segment_position[:, :, None] + turned)


def lateral_movement(result: Result) -> Floats:
    """Return how far the furthest corner moved square to the line, away from the traffic, (n,) [m]."""
    assert result.scene.barrier is not None  # asked for with a free-standing barrier only
    past = -np.asarray(result.scene.barrier.core.normal)[:2]
    corners = base_corners(result) @ past
    return np.asarray((corners - corners[0]).max(axis=(1, 2), initial=0.0))


def overturning_ratio(result: Result) -> Floats:
    """Return the overturning moment over the restoring one of each segment, shape (n, k).

    With M the moment of the vehicle's force about the middle of the base less that of the segment's own
    inertia, both about its long axis, F_z the vertical force on it (negative downwards) and b half its base:
    (|M| + F_z b) / (m g b), at least 0. Means over 50 ms that end at each row. Above 1 it begins to tip about
    its toe, which the model leaves out. Friction and pins are taken to act at the ground.

    Raises
    ------
    ValueError
        If there is no gravity.
    """
    scene = result.scene
    assert scene.barrier is not None
    gravity, interval = scene.settings.gravity, scene.settings.output_interval
    if not gravity > 0.0:
        raise ValueError(f"gravity must be > 0 m/s^2 for a restoring moment, got {gravity}")
    yaw, velocity = result.segment_yaw, result.segment_velocity
    ratio = np.zeros(yaw.shape)
    speed = np.abs(velocity).max(axis=(0, 2), initial=0.0)
    for i, (load, segment) in enumerate(zip(result.element_loads, scene.barrier.core.segments, strict=True)):
        if speed[i] == 0.0 and not load.touched:
            continue
        force, moment = (moving_average(mean, _WINDOW, interval) for mean in (load.force, load.moment))
        change = np.diff(velocity[:, i], axis=0, prepend=velocity[:1, i])
        acceleration = moving_average(change / interval, _WINDOW, interval)
        angle = np.radians(scene.barrier.heading + yaw[:, i])
        across, along = (
            np.stack([np.cos(angle), np.sin(angle)], 1),
            np.stack([-np.sin(angle), np.cos(angle)], 1),
        )
        inertia = segment.mass * segment.mass_center_height * (acceleration * across).sum(axis=1)
        turning = (moment[:, :2] * along).sum(axis=1) - inertia
        half = segment.half_base
        over = np.abs(turning) + force[:, 2] * half
        ratio[:, i] = np.maximum(0.0, over / (segment.mass * gravity * half))
    return ratio
