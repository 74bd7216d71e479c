"""BIRM3D: how a vehicle and a security or roadside barrier respond to an impact, in a fraction of a second.

SI units, angles in degrees, arrays read-only. Start with :class:`Vehicle`, :class:`Barrier` and
:class:`Simulation`.
"""

from __future__ import annotations

from . import calibration, filters, metrics, reference, scene_parameters, scenes, study, units
from ._core import BusyError, UnstableError
from ._version import __version__
from .articulated import ArticulatedVehicle, Joint
from .assessment import OccupantRisk, occupant_risk
from .barrier import Barrier
from .calibration import calibrate
from .channel import Channel
from .channel_checks import check_channel
from .coarse_skin import CoarseSkinWarning
from .comparison import CurveComparison, compare_curves
from .element_loads import ElementLoad
from .ensemble import ensemble
from .file_format import FileFormatError
from .fragility import fragility
from .free_standing import FreeStanding
from .impact_point import critical_impact_point
from .ledger import LedgerWarning
from .monte_carlo import monte_carlo
from .overlap import OverlapWarning
from .result import Result
from .result_file import load
from .runs import StudyInterrupted, StudyStoppedError
from .settings import Settings
from .simulation import Scene, Simulation
from .sobol import sobol
from .study import Study
from .sweep import sweep
from .test_data import read_csv_channels, read_iso_mme, read_nhtsa
from .unit_check import UnitWarning
from .vehicle import Vehicle, Zone

__all__ = [
    "ArticulatedVehicle",
    "Barrier",
    "BusyError",
    "Channel",
    "CoarseSkinWarning",
    "CurveComparison",
    "ElementLoad",
    "FileFormatError",
    "FreeStanding",
    "Joint",
    "LedgerWarning",
    "OccupantRisk",
    "OverlapWarning",
    "Result",
    "Scene",
    "Settings",
    "Simulation",
    "Study",
    "StudyInterrupted",
    "StudyStoppedError",
    "UnitWarning",
    "UnstableError",
    "Vehicle",
    "Zone",
    "__version__",
    "calibrate",
    "calibration",
    "check_channel",
    "compare_curves",
    "critical_impact_point",
    "ensemble",
    "filters",
    "fragility",
    "load",
    "metrics",
    "monte_carlo",
    "occupant_risk",
    "read_csv_channels",
    "read_iso_mme",
    "read_nhtsa",
    "reference",
    "scene_parameters",
    "scenes",
    "sobol",
    "study",
    "sweep",
    "units",
]


def __dir__() -> list[str]:
    """Public names; modules that are loaded for them are not."""
    return sorted(__all__)
