"""A scene in one line: vehicle, speed, angle, what is unusual of its pose, barrier."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
import numpy.typing as npt

from .. import units
from ..barrier.text import barrier_text
from ..vehicle.title import vehicle_text

if TYPE_CHECKING:
    from .scene import Scene

__all__ = ["Posed", "overlap_text", "pose_text", "scene_text", "varied_scene_text"]

_POSE = (("impact_offset", "offset", " m"), ("impact_yaw", "yaw", "°"), ("impact_roll", "roll", "°"))


class Posed(Protocol):
    """A scene, or another record of where a vehicle meets its barrier and how it is turned."""

    @property
    def impact_offset(self) -> float:
        """Where the path meets the barrier's line [m]."""

    @property
    def impact_yaw(self) -> float:
        """Of the nose to the left of the path [deg]."""

    @property
    def impact_roll(self) -> float:
        """To the right [deg]."""

    @property
    def overlap(self) -> float | None:
        """Share of the width that meets the barrier, 0 to 1; ``None`` where it was not given."""

    @property
    def overlap_side(self) -> str:
        """Side of the vehicle that the overlap is counted from."""


def scene_text(scene: Scene, separator: str = ": ") -> str:
    """Return vehicle, mass, speed, angle and pose; after the separator its barrier."""
    if scene.barrier is None:
        return f"{_head(scene)}{pose_text(scene)}, no barrier"
    return f"{_impact_text(scene)}{separator}{barrier_text(scene.barrier)}"


def _impact_text(scene: Scene) -> str:
    """Return vehicle, mass, speed, angle and pose."""
    return f"{_head(scene)} at {scene.impact_angle:g}°{pose_text(scene)}"


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
    turned = [
        f", {words} {text}{unit}"
        for name, words, unit in _POSE
        if (text := shown(name, getattr(scene, name), ".3g" if name in parameters else "g")) != "0"
    ]
    pose = "".join(turned)
    if scene.barrier is None and "barrier" not in parameters:
        return f"{head}{pose}, no barrier"
    angle = shown("impact_angle", scene.impact_angle, "g")
    if scene.overlap is not None:
        pose = f", {shown('overlap', scene.overlap, 'g', 0.01)} % overlap{pose}"
    return f"{head} at {angle}°{pose}: {barrier}"


def _head(scene: Scene) -> str:
    speed = f"{scene.impact_speed:.2f} m/s ({scene.impact_speed / units.mph:.1f} mph)"
    return f"{vehicle_text(scene.vehicle)}, {speed}"


def pose_text(scene: Posed) -> str:
    """Return overlap, offset, yaw and roll, each after a comma; of those that were not given ``""``."""
    turned = [
        f", {words} {value:g}{unit}" for name, words, unit in _POSE if (value := getattr(scene, name)) != 0.0
    ]
    return "".join([overlap_text(scene), *turned])


def overlap_text(scene: Posed) -> str:
    """Return the share of the width that meets the barrier, after a comma; ``""`` where it is not given."""
    if scene.overlap is None:
        return ""
    return f", {100.0 * scene.overlap:g} % overlap on the {scene.overlap_side}"
