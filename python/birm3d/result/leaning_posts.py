"""Warning of posts that lean and throw the vehicle up."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING

from ..base.complaints import Complaint

if TYPE_CHECKING:
    from .. import _core
    from ..scene.scene import Scene
    from .analysis import RunAnalysis
    from .stored import Stored

__all__ = ["LeaningPostWarning", "leaning_post_lines", "leaning_posts"]

_FASTEST = 3.0  # m/s: more than a van that pitches at rigid posts has


class LeaningPostWarning(UserWarning):
    """Posts that yield leaned, and threw the vehicle up at more than 3 m/s.

    A vehicle climbs a post that leans. A front that has folded round a post holds to it; how firmly is not
    known from any test. Whether the vehicle is stopped or goes over can be wrong either way.
    """


def leaning_posts(scene: Scene, statistics: _core.StepStatistics) -> Iterator[Complaint]:
    """Yield a complaint if posts that yield threw the vehicle up."""
    if _throws(scene, statistics):
        speed = statistics.fastest_rise
        text = partial(_text, scene.vehicle.title, speed)
        yield Complaint(LeaningPostWarning, "fastest_rise", speed, text)


def leaning_post_lines(result: RunAnalysis) -> Iterator[str]:
    """Yield the warning for cautions and reports, if there is one."""
    if _throws(result.scene, result.statistics):
        yield (
            f"Leaning posts throw the vehicle up at {result.statistics.fastest_rise:.1f} m/s. How firmly a "
            "real front holds to a post that leans is not known. Do not rely on the outcome."
        )


def _throws(scene: Scene, statistics: _core.StepStatistics | Stored) -> bool:
    if scene.barrier is None or scene.barrier.yields() is None:
        return False
    rise = float(getattr(statistics, "fastest_rise", 0.0))  # results of earlier versions do not have it
    return rise > _FASTEST


def _text(title: str, speed: float) -> str:
    return (
        f"fastest_rise must be at most {_FASTEST:g} m/s to rely on the outcome, got {speed:.1f} m/s: leaning "
        f"posts throw the vehicle ({title}) up; how firmly a real front holds to them is not known"
    )
