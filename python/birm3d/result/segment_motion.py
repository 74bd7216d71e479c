"""How far the segments of a free-standing barrier move, and how near they come to tipping."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from ..signals.filters import moving_average
from .element_loads import ElementLoad
from .record import RunRecord

__all__ = ["base_corners", "lateral_movement", "overturning_ratio"]

Floats = npt.NDArray[np.float64]

_WINDOW = 0.05  # s


def base_corners(result: RunRecord) -> Floats:
    """Return the four corners of each segment's base over time, around it, world, shape (n, k, 4, 2) [m]."""
    barrier = result.scene.barrier
    segments = [] if barrier is None else barrier.core.segments
    corner_signs = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    half = np.array([[segment.half_base, segment.half_length] for segment in segments]).reshape(-1, 1, 2)
    heading = 0.0 if barrier is None else barrier.heading
    angle = np.radians(heading + result.segment_yaw)[..., None]
    x, y = np.moveaxis(corner_signs * half, -1, 0)
    turned = np.stack([np.cos(angle) * x - np.sin(angle) * y, np.sin(angle) * x + np.cos(angle) * y], axis=-1)
    return np.asarray(result.segment_position[:, :, None] + turned)


def lateral_movement(result: RunRecord) -> Floats:
    """Return how far the furthest corner moved square to the line, away from the traffic, (n,) [m]."""
    assert result.scene.barrier is not None  # callers have a free-standing barrier
    past = -np.asarray(result.scene.barrier.core.normal)[:2]
    corners = base_corners(result) @ past
    return np.asarray((corners - corners[0]).max(axis=(1, 2), initial=0.0))


def overturning_ratio(result: RunRecord, loads: Sequence[ElementLoad]) -> Floats:
    """Return the overturning moment over the restoring one of each segment, shape (n, k).

    It is (|M| + F_z b) / (m g b), at least 0. M is a moment about the long axis through the middle of the
    base. It is that of the vehicle's force less that of the segment's own inertia. F_z is the vertical force
    on it (negative downwards), and b half its base. Means over 50 ms that end at each row. Above 1 it begins
    to tip about its toe, which the model leaves out. Friction and pins are taken to act at the ground.

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
    for i, (load, segment) in enumerate(zip(loads, scene.barrier.core.segments, strict=True)):
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
