"""Warning of a barrier that is lower than the structure of the front that it is said to stop."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING

from ..base.complaints import Complaint
from .event import CONTAINED

if TYPE_CHECKING:
    from .. import _core
    from ..scene.scene import Scene
    from .stored import Stored

__all__ = ["LowBarrierWarning", "low_barrier"]

_SAME = 1e-3  # m
_FORWARDS = 45.0  # deg of yaw and roll, up to which the front or its corner comes first


class LowBarrierWarning(UserWarning):
    """The barrier contains a vehicle, but is lower than most of the front that it is said to hold.

    More than a third of the front's resistance stands above the barrier's top, see
    :func:`birm3d.vehicle.front_height.strong_height`. The vehicle came forwards and upright (yaw and roll
    within 45 degrees), at any angle of impact. The computed front is held by what its lower part meets. A
    real one is bent down, or rides up and over.
    """


def low_barrier(scene: Scene, event: _core.Event | Stored) -> Iterator[Complaint]:
    """Yield a complaint if such a barrier contains a vehicle that comes forwards."""
    if event.outcome not in CONTAINED or event.manner == "rests_untouched":
        return
    found = _heights(scene)
    if found is not None:
        height, top = found
        text = partial(_text, scene.vehicle.title, height, top)
        yield Complaint(LowBarrierWarning, "height", height - top, text, partial(_advice, height, top))


def _advice(height: float, top: float) -> str:
    return (
        f"The barrier ends {top:.2f} m above the ground. A third of the front's resistance stands above "
        f"{height:.2f} m. The computed front is held by its lower part; a real one may ride over. Do not "
        "rely on the outcome."
    )


def _text(title: str, height: float, top: float) -> str:
    return (
        f"height must be at least {height:.2f} m to rely on the outcome, got {top:.2f} m: more than a third "
        f"of the front's resistance ({title}) stands above the barrier, and a real front may ride over it"
    )


def _heights(scene: Scene) -> tuple[float, float] | None:
    """Return the height of most of a front that comes first, and of a barrier that is lower [m]."""
    if scene.barrier is None or not _front_first(scene):
        return None
    height = scene.vehicle.units[0]._strong_height
    if height is None:
        return None
    top = scene.barrier._top
    return (height, top) if top < height - _SAME else None


def _front_first(scene: Scene) -> bool:
    """Whether the vehicle comes forwards and upright."""
    least = math.cos(math.radians(_FORWARDS))
    return (
        math.cos(math.radians(scene.impact_yaw)) > least and math.cos(math.radians(scene.impact_roll)) > least
    )
