"""What a run is about: a vehicle, a barrier, how the vehicle comes, and how it is computed."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from .. import _core
from ..barrier.barrier import Barrier
from ..base.arguments import checked
from ..vehicle.vehicle import Vehicle
from .settings import Settings
from .width_overlap import offset_of_overlap

__all__ = ["APPROACH", "Scene"]

APPROACH = ("impact_speed", "impact_angle", "impact_offset", "standoff", "impact_yaw", "impact_roll")
"""Numbers of a scene that say how the vehicle comes; nothing has to be made anew for others."""


@checked
@dataclass(frozen=True)
class Scene:
    """What a run is about; the arguments of :class:`birm3d.Simulation`."""

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
    overlap: float | None = None
    overlap_side: str = "left"

    @property
    def mu_tire_barrier(self) -> float:
        """Friction coefficient of tyres at the barrier: what the settings ask for, else 0.6.

        It is 0 at a barrier without friction.
        """
        return self._core_settings.mu_tire_barrier

    @property
    def cornering_stiffness(self) -> float:
        """Cornering stiffness of the tyres [1/rad]: what the settings ask for, or the mean over the wheels.

        A wheel whose zone has none, or that has no zone, counts with that of a car's tyres, 10.
        """
        return self._core_settings.cornering_stiffness

    @property
    def edge_flank_factor(self) -> float:
        """Factor of the sideways force on a wall's edge: what the settings ask for, or the (leading) unit's.

        Without one in the file it is 1.25, as for cars.
        """
        return self._core_settings.edge_flank_factor

    def approached(self, numbers: Mapping[str, float]) -> Scene:
        """Return the same scene with other numbers of ``APPROACH``; not checked."""
        scene = object.__new__(Scene)  # dataclasses.replace() takes longer than a metric
        scene.__dict__.update(self.__dict__)
        scene.__dict__.update(numbers)
        return scene

    def start(self) -> _core.Simulation:
        """Return the run of the core at t = 0, checked."""
        return _core.Simulation(self.core_scene())

    def core_scene(self) -> _core.Scene:
        """Return the same scene for the core, checked but for its start."""
        if not isinstance(self.vehicle, Vehicle):
            raise TypeError(f"vehicle must be a birm3d.Vehicle, got {type(self.vehicle).__name__}")
        if self.barrier is not None and not isinstance(self.barrier, Barrier):
            raise TypeError(f"barrier must be a birm3d.Barrier or None, got {type(self.barrier).__name__}")
        return _core.Scene(
            vehicle=self.vehicle.core,
            barriers=self._core_barriers,
            approach=self.approach,
            settings=self._core_settings,
            duration=self.duration,
        )

    @property
    def _core_settings(self) -> _core.Settings:
        """With the vehicle's numbers where nothing is asked for."""
        return _core.Settings(self.settings.given, self.vehicle.core, self._core_barriers)

    @property
    def _core_barriers(self) -> list[_core.Barrier]:
        return [] if self.barrier is None else [self.barrier.core]

    @property
    def path_offset(self) -> float:
        """Where the path meets the barrier's line [m]: ``impact_offset``, or what the overlap leads to."""
        if self.overlap is None:
            return self.impact_offset
        for name in ("impact_offset", "impact_yaw"):
            value = getattr(self, name)
            if value != 0.0:
                raise ValueError(f"{name} must be 0 where overlap is given, got {value}")
        return offset_of_overlap(
            self.vehicle, self.barrier, self.overlap, self.overlap_side, self.impact_angle
        )

    @property
    def approach(self) -> _core.Approach:
        """How the vehicle comes, for the core."""
        return _core.Approach(
            speed=self.impact_speed,
            angle=math.radians(self.impact_angle),
            offset=self.path_offset,
            standoff=self.standoff,
            yaw=math.radians(self.impact_yaw),
            roll=math.radians(self.impact_roll),
        )
