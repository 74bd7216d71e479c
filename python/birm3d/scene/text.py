"""A scene in one line: vehicle, speed, angle, barrier."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .. import units
from ..barrier.text import barrier_text
from ..vehicle.title import vehicle_text

if TYPE_CHECKING:
    from .scene import Scene

__all__ = ["impact_text", "overlap_text", "scene_text"]


def scene_text(scene: Scene, separator: str = ": ") -> str:
    """Return vehicle, mass, speed and angle, and after the separator kind, count and sizes of the barrier."""
    if scene.barrier is None:
        return f"{_head(scene)}, no barrier"
    return f"{impact_text(scene)}{separator}{barrier_text(scene.barrier)}"


def impact_text(scene: Scene) -> str:
    """Return vehicle, mass, speed and angle."""
    return f"{_head(scene)} at {scene.impact_angle:g}°{overlap_text(scene)}"


def _head(scene: Scene) -> str:
    speed = f"{scene.impact_speed:.2f} m/s ({scene.impact_speed / units.mph:.1f} mph)"
    return f"{vehicle_text(scene.vehicle)}, {speed}"


def overlap_text(scene: Scene) -> str:
    """Return the share of the width that meets the barrier, after a comma; ``""`` where it is not given."""
    if scene.overlap is None:
        return ""
    return f", {100.0 * scene.overlap:g} % overlap on the {scene.overlap_side}"
