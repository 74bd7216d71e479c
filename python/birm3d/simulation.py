"""A run: a vehicle, a barrier, a speed and an angle."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from . import _core
from .barrier import Barrier
from .coarse_skin import warn_if_coarse
from .ledger import warn_if_open
from .result import Result
from .settings import MU_TIRE_BARRIER, Settings
from .vehicle import Vehicle

__all__ = ["APPROACH", "Scene", "Simulation"]

APPROACH = ("impact_speed", "impact_angle", "impact_offset", "standoff", "impact_yaw", "impact_roll")
"""Numbers of a scene that say how the vehicle comes; nothing has to be made anew for others."""


@dataclass(frozen=True)
class Scene:
    """What a run is about; the arguments of :class:`Simulation`."""

    vehicle: Vehicle
    barrier: Barrier | None
    impact_speed: float
    impact_angle: float
    impact_offset: float
    standoff: float
    impact_yaw: float
    impact_roll: float
    duration: float | None
    settings: Settings

    @property
    def mu_tire_barrier(self) -> float:
        """Friction coefficient of tyres at the barrier: what the settings ask for, or their default rule."""
        asked = self.settings.mu_tire_barrier
        if asked is not None:
            return asked
        return 0.0 if self.barrier is not None and self.barrier.friction == 0.0 else MU_TIRE_BARRIER

    def approached(self, numbers: Mapping[str, float]) -> Scene:
        """Return the same scene with other numbers of ``APPROACH``; not checked."""
        scene = object.__new__(Scene)  # dataclasses.replace() takes longer than a metric
        scene.__dict__.update(self.__dict__)
        scene.__dict__.update(numbers)
        return scene

    @property
    def approach(self) -> _core.Approach:
        """How the vehicle comes, for the core."""
        return _core.Approach(
            speed=self.impact_speed,
            angle=math.radians(self.impact_angle),
            offset=self.impact_offset,
            standoff=self.standoff,
            yaw=math.radians(self.impact_yaw),
            roll=math.radians(self.impact_roll),
        )


class Simulation:
    """A vehicle that runs into a barrier.

    The vehicle comes along a straight path, its nose ahead unless stated, and stands before the barrier at
    t = 0.

    Parameters
    ----------
    vehicle
        See :class:`birm3d.Vehicle`.
    barrier
        See :class:`birm3d.Barrier`; ``None`` for a vehicle on its own (then give ``duration``).
    impact_speed
        [m/s], >= 0.
    impact_angle
        Between the vehicle's path and the barrier's line [deg], 0 to 180; 90 is head-on. At 0 and 180 the
        barrier must have an end to meet.
    impact_offset
        Where the path of the mass centre (of the leading unit) meets the barrier's line, from its origin [m].
        At angles 0 and 180 the distance of the path from the line, positive behind it: half the thickness
        leads to the middle of a wall's end.
    standoff
        Distance of the nearest node from the barrier at t = 0 [m], >= 0.
    impact_yaw
        By which the nose points to the left of the path at t = 0 [deg]; at 90 the right side goes ahead.
    impact_roll
        At t = 0 [deg], positive to the right.
    duration
        [s]; ``None``: until the outcome is decided.
    settings
        See :class:`birm3d.Settings`.

    Raises
    ------
    ValueError
        Naming the argument, its limit and the value received.
    CoarseSkinWarning
        As a warning, if the barrier is so narrow that it can pass between the nodes of the skin.
    """

    def __init__(
        self,
        vehicle: Vehicle,
        barrier: Barrier | None,
        impact_speed: float,
        impact_angle: float = 90.0,
        impact_offset: float = 0.0,
        *,
        standoff: float = 0.0,
        impact_yaw: float = 0.0,
        impact_roll: float = 0.0,
        duration: float | None = None,
        settings: Settings | None = None,
    ) -> None:
        if not isinstance(vehicle, Vehicle):
            raise TypeError(f"vehicle must be a birm3d.Vehicle, got {type(vehicle).__name__}")
        if barrier is not None and not isinstance(barrier, Barrier):
            raise TypeError(f"barrier must be a birm3d.Barrier or None, got {type(barrier).__name__}")
        self._scene = Scene(
            vehicle,
            barrier,
            float(impact_speed),
            float(impact_angle),
            float(impact_offset),
            float(standoff),
            float(impact_yaw),
            float(impact_roll),
            duration,
            settings if settings is not None else Settings(),
        )
        self._core = _core.Simulation(
            vehicle=vehicle.core,
            barriers=[] if barrier is None else [barrier.core],
            approach=self._scene.approach,
            settings=replace(self._scene.settings, mu_tire_barrier=self._scene.mu_tire_barrier).core,
            duration=duration,
        )
        self._run_time = 0.0
        warn_if_coarse(self._scene)

    @staticmethod
    def from_scene(scene: Scene) -> Simulation:
        """Return the simulation of a scene, such as that of a loaded result."""
        return Simulation(
            scene.vehicle,
            scene.barrier,
            scene.impact_speed,
            scene.impact_angle,
            scene.impact_offset,
            standoff=scene.standoff,
            impact_yaw=scene.impact_yaw,
            impact_roll=scene.impact_roll,
            duration=scene.duration,
            settings=scene.settings,
        )

    @property
    def scene(self) -> Scene:
        """What the run is about."""
        return self._scene

    @property
    def time(self) -> float:
        """Present time of the state [s]."""
        return self._core.time

    def run(self, *, frames: int | Sequence[float] | None = None) -> Result:
        """Run from the present state to the end; a run that is over starts anew. Ctrl-C stops it.

        Parameters
        ----------
        frames
            Number or instants [s] of the skin's positions that the result keeps for pictures, see
            :meth:`birm3d.Result.with_frames`; ``None``: none, at no cost.

        Raises
        ------
        UnstableError
            If a fixed time step is beyond what the scene allows; the message names one that would do.
        LedgerWarning
            As a warning, if a fixed time step is stable and the energy ledger does not close with it.
        ValueError
            If the frames are more than the result's rows or outside the run.
        """
        if self._core.end_reason != _core.EndReason.running:
            self.reset()
        start = time.perf_counter()
        self._core.run()
        self._run_time += time.perf_counter() - start
        result = self.result()
        if self._scene.settings.time_step is not None:
            warn_if_open(result.scene, result._energy_extremes)
        return result if frames is None else result.with_frames(frames)

    def step(self) -> bool:
        """Take one accepted step; return ``False`` when the run is over and nothing was done."""
        start = time.perf_counter()
        moved = self._core.step()
        self._run_time += time.perf_counter() - start
        return moved

    def result(self) -> Result:
        """Return the result so far."""
        return Result._of(self._scene, self._core, self._run_time)

    def reset(self) -> None:
        """Go back to t = 0."""
        self._core.reset()
        self._run_time = 0.0

    def state_hash(self) -> int:
        """Return a 64-bit hash of the state: equal hashes mean equal bits."""
        return self._core.state_hash

    def snapshot(self) -> _core.Snapshot:
        """Return a checkpoint: the whole state and the record so far."""
        return self._core.snapshot()

    def restore(self, snapshot: _core.Snapshot) -> None:
        """Go back to a checkpoint of the same scene."""
        self._core.restore(snapshot)

    def __reduce__(self) -> tuple[object, ...]:
        return (Simulation.from_scene, (self._scene,))

    def __repr__(self) -> str:
        scene = self._scene
        return (
            f"Simulation({scene.vehicle.name}, {scene.barrier}, {scene.impact_speed:g} m/s, "
            f"{scene.impact_angle:g} deg)"
        )
