"""Warning of posts that lean: a vehicle that they throw up, or that meets them as they lie low."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING

from ..base.complaints import Complaint

if TYPE_CHECKING:
    from .. import _core
    from ..scene.scene import Scene
    from .stored import Stored

__all__ = ["LeaningPostWarning", "leaning_posts"]

_FASTEST = 3.0  # m/s: more than a van that pitches at rigid posts has
_STEEPEST = 45.0  # deg: a little less than where a post becomes a ramp, see kernels/indentation.hpp


class LeaningPostWarning(UserWarning):
    """Posts that yield threw the vehicle up at more than 3 m/s, or leaned beyond 45 degrees.

    A vehicle climbs a post that leans. A front that has folded round a post holds to it; how firmly is not
    known from any test. Whether the vehicle is stopped or goes over can be wrong either way: a vehicle that
    goes over posts which lie so low is warned of, too.
    """


def leaning_posts(
    scene: Scene, statistics: _core.StepStatistics | Stored, event: _core.Event | Stored
) -> Iterator[Complaint]:
    """Yield a complaint if posts that yield threw the vehicle up, or lie low where the outcome is decided."""
    title = scene.vehicle.title
    if _throws(scene, statistics):
        speed = statistics.fastest_rise
        text, advice = partial(_thrown, title, speed), partial(_thrown_advice, speed)
        yield Complaint(LeaningPostWarning, "fastest_rise", speed, text, advice)
    elif event.outcome != "undecided" and _lie_low(statistics):
        tilt = math.degrees(statistics.greatest_tilt)
        text, advice = partial(_held, title, tilt), partial(_held_advice, tilt)
        yield Complaint(LeaningPostWarning, "post_tilt", tilt, text, advice)


def _thrown_advice(speed: float) -> str:
    return (
        f"Leaning posts throw the vehicle up at {speed:.1f} m/s. How firmly a real front holds to a post "
        "that leans is not known. Do not rely on the outcome."
    )


def _held_advice(tilt: float) -> str:
    return (
        f"Posts lean by {tilt:.0f} degrees. Whether posts that lie so low hold a real vehicle is not known. "
        "Do not rely on the outcome."
    )


# Results of earlier versions do not have the numbers that these two look at.
def _throws(scene: Scene, statistics: _core.StepStatistics | Stored) -> bool:
    yields = scene.barrier is not None and scene.barrier.yields() is not None
    return yields and float(getattr(statistics, "fastest_rise", 0.0)) > _FASTEST


def _lie_low(statistics: _core.StepStatistics | Stored) -> bool:
    return math.degrees(float(getattr(statistics, "greatest_tilt", 0.0))) > _STEEPEST


def _thrown(title: str, speed: float) -> str:
    return (
        f"fastest_rise must be at most {_FASTEST:g} m/s to rely on the outcome, got {speed:.1f} m/s: leaning "
        f"posts throw the vehicle ({title}) up; how firmly a real front holds to them is not known"
    )


def _held(title: str, tilt: float) -> str:
    return (
        f"post_tilt must be at most {_STEEPEST:g} deg to rely on the outcome, got {tilt:.0f} deg: whether "
        f"posts that lie so low hold a real vehicle ({title}) is not known"
    )
