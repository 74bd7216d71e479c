"""Values that several metrics of a run use, for runs with and without histories."""

from __future__ import annotations

import math
from functools import cached_property

from .. import _core
from ..base.arguments import checked
from ..scene.scene import Scene
from .record import RunRecord
from .stored import Stored

__all__ = [
    "ALONG_LINE",
    "PARTS",
    "ResultOutcome",
    "RunValues",
    "Vector",
    "energy_residual",
    "parts_of",
    "relative_to_start",
    "share_of_start",
]

Vector = tuple[float, float, float]

ALONG_LINE = _core.along_line
"""Below this sine of its angle a path runs along the barrier's line."""
# Residuals of a vehicle that stands are judged against the energy it has at this speed, m/s.
_STANDSTILL = 0.1


PARTS = ("segments", "posts", "moving", "joint", "sliding")
"""What only some scenes have, and some metrics need.

Segments: free-standing segments. Posts: posts that yield. Moving: either of them. Joint: two units.
Sliding: a load bed that slides.
"""


def parts_of(scene: Scene) -> frozenset[str]:
    """Return which of :data:`PARTS` a scene has."""
    barrier, vehicle = scene.barrier, scene.vehicle
    found = {"joint"} if vehicle.joint is not None else set()
    if vehicle.slides:
        found.add("sliding")
    if barrier is not None and barrier.core.segments:
        found |= {"segments", "moving"}
    if barrier is not None and barrier.core.yielding_posts:
        found |= {"posts", "moving"}
    return frozenset(found)


class ResultOutcome:
    """What a result has in common with the outcome of a run without histories."""

    def __init__(self, result: RunRecord, extremes: _core.Extremes) -> None:
        self.extremes = extremes
        x, y, z = result.final_velocity.tolist()
        self.final_velocity: Vector = (x, y, z)
        assert isinstance(result._event, _core.Event)
        self.event: _core.Event = result._event
        self.statistics: _core.StepStatistics | Stored = result.statistics
        self.run_time = result.run_time
        self._result = result

    @cached_property
    def deflection(self) -> float:
        """At the end [m]."""
        return greatest_deflection(self._result, "deflection")

    @cached_property
    def peak_deflection(self) -> float:
        """Over the run [m]."""
        return greatest_deflection(self._result, "peak_deflection")


class RunValues:
    """Values that several metrics of a run use; those that the core has found are read from it at once."""

    normal_force: _core.ExtremeNormalForce
    motion: _core.ExtremeMotion
    attitude: _core.ExtremeAttitude
    energy: _core.ExtremeEnergy
    filtered_force: _core.ExtremeFilteredForce
    element_loads: _core.ExtremeElementLoads

    def __init__(self, scene: Scene, outcome: _core.Outcome | ResultOutcome) -> None:
        self.scene = scene
        self.outcome = outcome
        self.extremes = outcome.extremes
        self.event = outcome.event
        self.statistics = outcome.statistics
        self.barrier = scene.barrier
        vars(self).update(self.extremes.groups)

    @cached_property
    def parts(self) -> frozenset[str]:
        """Which of :data:`PARTS` the scene has."""
        return parts_of(self.scene)

    @property
    def along(self) -> bool:
        """Whether the path runs along the barrier's line."""
        return abs(math.sin(math.radians(self.scene.impact_angle))) < ALONG_LINE

    @property
    def dynamic_crush(self) -> float:
        """Greatest deflection of any truss of the skin [m]."""
        return self.outcome.peak_deflection

    @cached_property
    def reversal_time(self) -> float | None:
        """When the motion towards the barrier ends [s], if it began and anything was crushed."""
        began = self.dynamic_crush > 0.0 and self.motion.approach_speed > 0.0
        return self.motion.reversal_time if began else None

    @property
    def residual_crush(self) -> float:
        """When the vehicle had left; of one that has not, at the end."""
        left = self.event.exit_deflection
        return max(0.0, self.outcome.deflection if left is None else left)


def energy_residual(scene: Scene, energy: _core.ExtremeEnergy) -> float:
    """Greatest residual of the energy balance, relative to the initial kinetic energy."""
    return share_of_start(scene, energy.residual, energy.start)


def share_of_start(scene: Scene, energy: float, start: float) -> float:
    """Return what :func:`relative_to_start` does, of arguments that are not checked."""
    return energy / max(start, 0.5 * scene.vehicle.mass * _STANDSTILL**2)


@checked
def relative_to_start(scene: Scene, energy: float, start: float) -> float:
    """Return an energy relative to that at the start, which counts as no less than that of a standstill."""
    return share_of_start(scene, energy, start)


def greatest_deflection(result: RunRecord, name: str) -> float:
    """Greatest deflection of the skin of all units [m].

    Second trusses and the treads of tyres are left out: a segment's end or a kerb may drag
    a few of their nodes by metres.
    """
    units = enumerate(result.scene.vehicle.units)
    return max(float(getattr(result.unit(u), name)[unit.is_skin].max()) for u, unit in units)
