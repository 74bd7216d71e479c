"""BIRM3D: how a vehicle and a security or roadside barrier respond to an impact, in a fraction of a second.

SI units, angles in degrees, arrays read-only. Start with :class:`Vehicle`, :class:`Barrier` and
:class:`Simulation`.
"""

from __future__ import annotations

from importlib.metadata import version as _version

from . import calibration, scenes, units
from ._core import UnstableError
from .barrier import Barrier
from .calibration import calibrate
from .result import Result
from .settings import Settings
from .simulation import Scene, Simulation
from .vehicle import Vehicle, Zone

__all__ = [
    "Barrier",
    "Result",
    "Scene",
    "Settings",
    "Simulation",
    "UnstableError",
    "Vehicle",
    "Zone",
    "calibrate",
    "calibration",
    "scenes",
    "units",
]

__version__ = _version("birm3d")
