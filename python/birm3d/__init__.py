"""BIRM3D: how a vehicle and a security or roadside barrier respond to an impact, in a fraction of a second.

SI units, angles in degrees, arrays read-only. Start with :class:`Vehicle`, :class:`Barrier` and
:class:`Simulation`.
"""

from __future__ import annotations

from importlib import import_module
from importlib.util import find_spec
from typing import TYPE_CHECKING

from . import _moved

if TYPE_CHECKING:
    from . import calibration, study, units
    from ._core import BusyError, UnstableError
    from ._version import __version__
    from .assessment import (
        DesignLoad,
        DesignLoadInterrupted,
        OccupantRisk,
        Rating,
        RatingStudy,
        occupant_risk,
        test_matrix,
    )
    from .assessment.design_load import design_load
    from .assessment.rate import rate
    from .barrier import Barrier, Foundation, FreeStanding, lateral_load
    from .calibration.calibrate import calibrate
    from .io.file_format import FileFormatError
    from .pictures import plot_runs
    from .reporting import dossier
    from .result import Result, metrics
    from .result.core_contact import CoreContactWarning
    from .result.element_loads import ElementLoad
    from .result.energy_balance import BalanceWarning
    from .result.leaning_posts import LeaningPostWarning
    from .result.load_map import LoadMap
    from .result.load_map_comparison import LoadMapComparison, compare_load_maps
    from .result.low_barrier import LowBarrierWarning
    from .result.measured_cells import measured_load_map, read_load_cells
    from .result.missed import MissedBarrierWarning
    from .result.overlap import OverlapWarning
    from .result.result import load, write_capsule
    from .result.tipping import TippingWarning
    from .scene.mesh_check import CoarseSkinWarning
    from .scene.settings import Settings
    from .signals import filters, readers, reference
    from .signals.channel import Channel
    from .signals.channel_checks import check_channel
    from .signals.compare import CurveComparison, compare_curves
    from .signals.readers import read_csv_channels, read_iso_mme, read_nhtsa
    from .simulation import Scene, Simulation
    from .simulation import parameters as scene_parameters
    from .simulation import presets as scenes
    from .simulation.rerun import Rerun, rerun
    from .study import Study
    from .study.design_limits import greatest_gap, least_height, least_segment_mass, least_tube_thickness
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
    from .vehicle.mass_check import MassWarning

__all__ = [
    "ArticulatedVehicle",
    "BalanceWarning",
    "Barrier",
    "BusyError",
    "Channel",
    "CoarseSkinWarning",
    "CoreContactWarning",
    "CurveComparison",
    "DesignLoad",
    "DesignLoadInterrupted",
    "ElementLoad",
    "FileFormatError",
    "Foundation",
    "FreeStanding",
    "HistoryBands",
    "Joint",
    "LeaningPostWarning",
    "Limit",
    "LoadMap",
    "LoadMapComparison",
    "LowBarrierWarning",
    "MassWarning",
    "MissedBarrierWarning",
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
    "TippingWarning",
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
    "compare_load_maps",
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
    "least_tube_thickness",
    "load",
    "measured_load_map",
    "metrics",
    "monte_carlo",
    "occupant_risk",
    "plot_runs",
    "predict",
    "rate",
    "read_csv_channels",
    "read_iso_mme",
    "read_load_cells",
    "read_nhtsa",
    "readers",
    "reference",
    "rerun",
    "scene_parameters",
    "scenes",
    "sobol",
    "study",
    "sweep",
    "test_matrix",
    "units",
    "worst_offset",
    "write_capsule",
]

_WHERE = {
    "ArticulatedVehicle": "vehicle:ArticulatedVehicle",
    "BalanceWarning": "result.energy_balance:BalanceWarning",
    "Barrier": "barrier:Barrier",
    "BusyError": "_core:BusyError",
    "Channel": "signals.channel:Channel",
    "CoarseSkinWarning": "scene.mesh_check:CoarseSkinWarning",
    "CoreContactWarning": "result.core_contact:CoreContactWarning",
    "CurveComparison": "signals.compare:CurveComparison",
    "DesignLoad": "assessment:DesignLoad",
    "DesignLoadInterrupted": "assessment:DesignLoadInterrupted",
    "ElementLoad": "result.element_loads:ElementLoad",
    "FileFormatError": "io.file_format:FileFormatError",
    "Foundation": "barrier:Foundation",
    "FreeStanding": "barrier:FreeStanding",
    "HistoryBands": "study.history_bands:HistoryBands",
    "Joint": "vehicle:Joint",
    "LeaningPostWarning": "result.leaning_posts:LeaningPostWarning",
    "Limit": "study.limit_search:Limit",
    "LoadMap": "result.load_map:LoadMap",
    "LoadMapComparison": "result.load_map_comparison:LoadMapComparison",
    "LowBarrierWarning": "result.low_barrier:LowBarrierWarning",
    "MassWarning": "vehicle.mass_check:MassWarning",
    "MissedBarrierWarning": "result.missed:MissedBarrierWarning",
    "NotInRangeError": "study.limit_search:NotInRangeError",
    "OccupantRisk": "assessment:OccupantRisk",
    "OverlapWarning": "result.overlap:OverlapWarning",
    "Prediction": "study.predict:Prediction",
    "Rating": "assessment:Rating",
    "RatingStudy": "assessment:RatingStudy",
    "Rerun": "simulation.rerun:Rerun",
    "Result": "result:Result",
    "Scene": "simulation:Scene",
    "Settings": "scene.settings:Settings",
    "Simulation": "simulation:Simulation",
    "Study": "study:Study",
    "StudyInterrupted": "study.runner:StudyInterrupted",
    "StudyStoppedError": "study.runner:StudyStoppedError",
    "TippingWarning": "result.tipping:TippingWarning",
    "UnitWarning": "unit_check:UnitWarning",
    "UnstableError": "_core:UnstableError",
    "Vehicle": "vehicle:Vehicle",
    "WorstOffset": "study.worst_offset:WorstOffset",
    "Zone": "vehicle:Zone",
    "__version__": "_version:__version__",
    "calibrate": "calibration.calibrate:calibrate",
    "calibration": "calibration",
    "check_channel": "signals.channel_checks:check_channel",
    "compare_curves": "signals.compare:compare_curves",
    "compare_load_maps": "result.load_map_comparison:compare_load_maps",
    "critical_impact_point": "study.impact_point:critical_impact_point",
    "design_load": "assessment.design_load:design_load",
    "dossier": "reporting:dossier",
    "ensemble": "study.ensemble:ensemble",
    "filters": "signals.filters",
    "fragility": "study.fragility:fragility",
    "greatest_gap": "study.design_limits:greatest_gap",
    "history_bands": "study.history_bands:history_bands",
    "lateral_load": "barrier.lateral_load",
    "least_height": "study.design_limits:least_height",
    "least_segment_mass": "study.design_limits:least_segment_mass",
    "least_tube_thickness": "study.design_limits:least_tube_thickness",
    "load": "result.result:load",
    "measured_load_map": "result.measured_cells:measured_load_map",
    "metrics": "result.metrics",
    "monte_carlo": "study.monte_carlo:monte_carlo",
    "occupant_risk": "assessment:occupant_risk",
    "plot_runs": "pictures:plot_runs",
    "predict": "study.predict:predict",
    "rate": "assessment.rate:rate",
    "read_csv_channels": "signals.readers:read_csv_channels",
    "read_iso_mme": "signals.readers:read_iso_mme",
    "read_load_cells": "result.measured_cells:read_load_cells",
    "read_nhtsa": "signals.readers:read_nhtsa",
    "readers": "signals.readers",
    "reference": "signals.reference",
    "rerun": "simulation.rerun:rerun",
    "scene_parameters": "simulation.parameters",
    "scenes": "simulation.presets",
    "sobol": "study.sobol:sobol",
    "study": "study",
    "sweep": "study.sweep:sweep",
    "test_matrix": "assessment:test_matrix",
    "units": "units",
    "worst_offset": "study.worst_offset:worst_offset",
    "write_capsule": "result.result:write_capsule",
}
"""Public name -> its module, or module:name. A module is loaded when one of its names is first used."""


def __dir__() -> list[str]:
    """Public names; modules that are loaded for them are not."""
    return sorted(__all__)


def __getattr__(name: str) -> object:
    """Load a public name or a module; names of earlier versions work too, see :mod:`birm3d._moved`."""
    if name in _WHERE:
        module, _, attribute = _WHERE[name].partition(":")
        value: object = import_module(f"{__name__}.{module}")
        if attribute:
            value = getattr(value, attribute)
        globals()[name] = value
        return value
    if _moved.is_old(name):
        return _moved.old_name(name)
    if not name.startswith("__") and find_spec(f"{__name__}.{name}") is not None:
        return import_module(f"{__name__}.{name}")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


_moved.keep_short_paths()
_moved.keep_old_paths()
