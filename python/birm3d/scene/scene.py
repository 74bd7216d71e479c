"""What a run is about: a vehicle, a barrier, how the vehicle comes, and how it is computed."""

from __future__ import annotations

import math
import statistics
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache

from .. import _core
from ..barrier.barrier import Barrier
from ..base.arguments import checked
from ..vehicle.vehicle import Vehicle
from .settings import CORNERING_STIFFNESS, EDGE_FLANK_FACTOR, MU_TIRE_BARRIER, Settings
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
        """Friction coefficient of tyres at the barrier: what the settings ask for, or their default rule."""
        asked = self.settings.mu_tire_barrier
        if asked is not None:
            return asked
        return 0.0 if self.barrier is not None and self.barrier.friction == 0.0 else MU_TIRE_BARRIER

    @property
    def cornering_stiffness(self) -> float:
        """Cornering stiffness of the tyres [1/rad]: what the settings ask for, or the mean over the wheels.

        A wheel whose zone has none, or that has no zone, counts with that of a car's tyres.
        """
        asked = self.settings.cornering_stiffness
        if asked is not None:
            return asked
        zones = list(self.vehicle.zones.values())
        numbers = [zones[i].cornering_stiffness if i >= 0 else None for i in self.vehicle.zone_of_wheel]
        return statistics.fmean(CORNERING_STIFFNESS if one is None else one for one in numbers or [None])

    @property
    def edge_flank_factor(self) -> float:
        """Factor of the sideways force on a wall's edge: what the settings ask for, or the (leading) unit's.

        Without one in the file it is 1.25, as for cars.
        """
        asked = self.settings.edge_flank_factor
        if asked is not None:
            return asked
        file = self.vehicle.units[0]._file
        own = None if file is None or file.indentation is None else file.indentation.edge_flank_factor
        return EDGE_FLANK_FACTOR if own is None else own

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
            barriers=[] if self.barrier is None else [self.barrier.core],
            approach=self.approach,
            settings=self._settings.core,
            duration=self.duration,
        )

    @property
    def _settings(self) -> Settings:
        """With the vehicle's numbers where nothing is asked for."""
        own = (self.mu_tire_barrier, self.cornering_stiffness, self.edge_flank_factor)
        return _with_numbers(self.settings, *own)

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


@lru_cache(maxsize=16)
def _with_numbers(
    settings: Settings, mu_tire_barrier: float, cornering_stiffness: float, edge_flank_factor: float
) -> Settings:
    return replace(
        settings,
        mu_tire_barrier=mu_tire_barrier,
        cornering_stiffness=cornering_stiffness,
        edge_flank_factor=edge_flank_factor,
    )
