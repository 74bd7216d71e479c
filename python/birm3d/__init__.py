"""BIRM3D: how a vehicle and a security or roadside barrier respond to an impact, in a fraction of a second.

SI units, angles in degrees, arrays read-only. Start with :class:`Vehicle`, :class:`Barrier` and
:class:`Simulation`.
"""

from __future__ import annotations

from . import scenes, units
from ._core import UnstableError
from ._version import __version__
from .barrier import Barrier
from .fragility import fragility
from .impact_point import critical_impact_point
from .monte_carlo import monte_carlo
from .result import Result
from .runs import StudyInterrupted, StudyStoppedError
from .settings import Settings
from .simulation import Scene, Simulation
from .sobol import sobol
from .study import Study
from .sweep import sweep
from .vehicle import Vehicle, Zone

__all__ = [
    "Barrier",
    "Result",
    "Scene",
    "Settings",
    "Simulation",
    "Study",
    "StudyInterrupted",
    "StudyStoppedError",
    "UnstableError",
    "Vehicle",
    "Zone",
    "__version__",
    "critical_impact_point",
    "fragility",
    "monte_carlo",
    "scenes",
    "sobol",
    "sweep",
    "units",
]
