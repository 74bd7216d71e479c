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
from .channel import Channel
from .channel_checks import check_channel
from .comparison import CurveComparison, compare_curves
from .result import Result
from .settings import Settings
from .simulation import Scene, Simulation
from .test_data import read_csv_channels, read_iso_mme, read_nhtsa
from .vehicle import Vehicle, Zone

__all__ = [
    "Barrier",
    "Channel",
    "CurveComparison",
    "Result",
    "Scene",
    "Settings",
    "Simulation",
    "UnstableError",
    "Vehicle",
    "Zone",
    "calibrate",
    "calibration",
    "check_channel",
    "compare_curves",
    "read_csv_channels",
    "read_iso_mme",
    "read_nhtsa",
    "scenes",
    "units",
]

__version__ = _version("birm3d")
