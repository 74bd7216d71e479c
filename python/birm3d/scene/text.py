"""A scene in one line: vehicle, speed, angle, barrier."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .. import units
from ..barrier.text import barrier_text
from ..vehicle.title import vehicle_text

if TYPE_CHECKING:
    from .scene import Scene

__all__ = ["overlap_text", "scene_text", "varied_scene_text"]


def scene_text(scene: Scene, separator: str = ": ") -> str:
    """Return vehicle, mass, speed and angle, and after the separator kind, count and sizes of the barrier."""
    if scene.barrier is None:
        return f"{_head(scene)}, no barrier"
    return f"{_impact_text(scene)}{separator}{barrier_text(scene.barrier)}"


def _impact_text(scene: Scene) -> str:
    """Return vehicle, mass, speed and angle."""
    return f"{_head(scene)} at {scene.impact_angle:g}°{overlap_text(scene)}"


def varied_scene_text(scene: Scene, parameters: Mapping[str, npt.NDArray[Any]], barrier: str) -> str:
    """Return :func:`scene_text` of a study: what it varies has its least and greatest value.

    ``barrier`` is what the study calls its barriers.
    """

    def shown(name: str, now: float, form: str, size: float = 1.0) -> str:
        values = parameters.get(name)
        if values is None or values.dtype.kind != "f" or not len(values):
            return format(now / size, form)
        ends = (float(np.min(values)), float(np.max(values)))
        return " to ".join(dict.fromkeys(format(end / size, form) for end in ends))

    vehicle = f"{scene.vehicle.title}, {shown('vehicle.gvw', scene.vehicle.mass, ',.0f')} kg"
    speed = f"{shown('impact_speed', scene.impact_speed, '.2f')} m/s"
    mph = shown("impact_speed", scene.impact_speed, ".1f", units.mph)
    head = f"{'several vehicles' if 'vehicle' in parameters else vehicle}, {speed} ({mph} mph)"
    if scene.barrier is None and "barrier" not in parameters:
        return f"{head}, no barrier"
    angle = shown("impact_angle", scene.impact_angle, "g")
    if scene.overlap is None:
        return f"{head} at {angle}°: {barrier}"
    return f"{head} at {angle}°, {shown('overlap', scene.overlap, 'g', 0.01)} % overlap: {barrier}"


def _head(scene: Scene) -> str:
    speed = f"{scene.impact_speed:.2f} m/s ({scene.impact_speed / units.mph:.1f} mph)"
    return f"{vehicle_text(scene.vehicle)}, {speed}"


def overlap_text(scene: Scene) -> str:
    """Return the share of the width that meets the barrier, after a comma; ``""`` where it is not given."""
    if scene.overlap is None:
        return ""
    return f", {100.0 * scene.overlap:g} % overlap on the {scene.overlap_side}"
