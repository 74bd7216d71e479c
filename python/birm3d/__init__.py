"""BIRM3D: how a vehicle and a security or roadside barrier respond to an impact, in a fraction of a second.

SI units, angles in degrees, arrays read-only. Start with :class:`Vehicle`, :class:`Barrier` and
:class:`Simulation`.
"""

from __future__ import annotations

from . import _moved, calibration, study, units
from ._core import BusyError, UnstableError
from ._version import __version__
from .assessment import (
    DesignLoad,
    DesignLoadInterrupted,
    OccupantRisk,
    Rating,
    RatingStudy,
    design_load,
    occupant_risk,
    rate,
    test_matrix,
)
from .barrier import Barrier, FreeStanding, lateral_load
from .calibration import calibrate
from .io.file_format import FileFormatError
from .pictures import plot_runs
from .reporting import dossier
from .result import Result, metrics
from .result.element_loads import ElementLoad
from .result.energy_balance import BalanceWarning
from .result.load_map import LoadMap
from .result.overlap import OverlapWarning
from .result.result import load, write_capsule
from .scene.mesh_check import CoarseSkinWarning
from .scene.settings import Settings
from .signals import filters, reference
from .signals import readers as test_data
from .signals.channel import Channel
from .signals.channel_checks import check_channel
from .signals.compare import CurveComparison, compare_curves
from .signals.readers import read_csv_channels, read_iso_mme, read_nhtsa
from .simulation import Scene, Simulation
from .simulation import parameters as scene_parameters
from .simulation import presets as scenes
from .simulation.rerun import Rerun, rerun
from .study import Study
from .study.design_limits import greatest_gap, least_height, least_segment_mass
from .study.ensemble import ensemble
from .study.fragility import fragility
from .study.history_bands import HistoryBands, history_bands
from .study.impact_point import critical_impact_point
from .study.limit_search import Limit, NotInRangeError
from .study.monte_carlo import monte_carlo
from .study.predict import Prediction, predict
from .study.runner import StudyInterrupted, StudyStoppedError
from .study.sobol import sobol
from .study.sweep import sweep
from .study.worst_offset import WorstOffset, worst_offset
from .unit_check import UnitWarning
from .vehicle import ArticulatedVehicle, Joint, Vehicle, Zone

__all__ = [
    "ArticulatedVehicle",
    "BalanceWarning",
    "Barrier",
    "BusyError",
    "Channel",
    "CoarseSkinWarning",
    "CurveComparison",
    "DesignLoad",
    "DesignLoadInterrupted",
    "ElementLoad",
    "FileFormatError",
    "FreeStanding",
    "HistoryBands",
    "Joint",
    "Limit",
    "LoadMap",
    "NotInRangeError",
    "OccupantRisk",
    "OverlapWarning",
    "Prediction",
    "Rating",
    "RatingStudy",
    "Rerun",
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
    "WorstOffset",
    "Zone",
    "__version__",
    "calibrate",
    "calibration",
    "check_channel",
    "compare_curves",
    "critical_impact_point",
    "design_load",
    "dossier",
    "ensemble",
    "filters",
    "fragility",
    "greatest_gap",
    "history_bands",
    "lateral_load",
    "least_height",
    "least_segment_mass",
    "load",
    "metrics",
    "monte_carlo",
    "occupant_risk",
    "plot_runs",
    "predict",
    "rate",
    "read_csv_channels",
    "read_iso_mme",
    "read_nhtsa",
    "reference",
    "rerun",
    "scene_parameters",
    "scenes",
    "sobol",
    "study",
    "sweep",
    "test_data",
    "test_matrix",
    "units",
    "worst_offset",
    "write_capsule",
]


def __dir__() -> list[str]:
    """Public names; modules that are loaded for them are not."""
    return sorted(__all__)


_moved.keep_short_paths()
_moved.keep_old_paths()


def __getattr__(name: str) -> object:
    """Return a module of an earlier version by its old name, see :mod:`birm3d._moved`."""
    return _moved.old_name(name)
