"""Paths of modules that have moved into folders.

Some modules have a short path that the documentation names; it leads to the module itself. Paths of earlier
versions that were never documented go on working and warn: the warning says what to write.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from importlib import import_module
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from types import ModuleType

__all__ = ["is_old", "keep_old_paths", "keep_short_paths", "old_name"]

_SHORT = {
    "filters": "signals.filters",
    "lateral_load": "barrier.lateral_load",
    "metrics": "result.metrics",
    "readers": "signals.readers",
    "readers.csv_channels": "signals.readers.csv_channels",
    "readers.iso_mme": "signals.readers.iso_mme",
    "readers.nhtsa": "signals.readers.nhtsa",
    "reference": "signals.reference",
    "scene_parameters": "simulation.parameters",
    "scenes": "simulation.presets",
    "study.watched": "study.verification.watched",
}
"""Short path -> where the module is, both below ``birm3d``."""

_OLD = {
    "along_panel": "vehicle.second_trusses",
    "arguments": "base.arguments",
    "articulated": "vehicle.vehicle",
    "barrier.base": "barrier.barrier",
    "barrier_kinds": "barrier.kinds",
    "barrier_surfaces": "barrier.surfaces",
    "barrier_text": "barrier.text",
    "calibration.plots": "plotting.calibration",
    "channel": "signals.channel",
    "channel_checks": "signals.channel_checks",
    "checks": "base.checks",
    "closed_mesh": "barrier.closed_mesh",
    "coarse_skin": "scene.mesh_check",
    "combination_file": "vehicle.combination_file",
    "comparison": "signals.compare",
    "crush_profile": "result.crush_profile",
    "curve_metrics": "signals.curve_metrics",
    "dimensions": "vehicle.dimensions",
    "distributions": "study.distributions",
    "element_loads": "result.element_loads",
    "ensemble": "study.ensemble",
    "event": "result.event",
    "executors": "study.executors",
    "file_format": "io.file_format",
    "fingerprint": "base.fingerprint",
    "float_rows": "study.float_rows",
    "fragility": "study.fragility",
    "frames": "result.frames",
    "free_standing": "barrier.free_standing",
    "frozen_mapping": "base.frozen_mapping",
    "impact_point": "study.impact_point",
    "iso18571": "signals.iso18571",
    "laboratory": "vehicle.test_bodies",
    "ledger": "result.energy_balance",
    "left_out": "result.omitted",
    "loading": "vehicle.payload",
    "lognormal_fit": "study.lognormal_fit",
    "mass_center": "vehicle.mass_center",
    "mesher": "vehicle.mesher",
    "monte_carlo": "study.monte_carlo",
    "notebook_html": "html_page.notebook",
    "npz_arrays": "io.npz_arrays",
    "outcome": "result.summary",
    "outcome_table": "study.outcome_table",
    "overlap": "result.overlap",
    "plan_axes": "plotting.plan_axes",
    "progress": "base.progress",
    "report": "result.report",
    "result_file": "result.result_file",
    "result_table": "result.table",
    "run_store": "study.store",
    "run_warnings": "result.run_warnings",
    "runs": "study.runner",
    "scene_codec": "scene.codec",
    "scene_file": "simulation.scene_file",
    "scene_text": "scene.text",
    "settings": "scene.settings",
    "silhouette": "vehicle.silhouette",
    "skin": "result.skin",
    "sobol": "study.sobol",
    "study.convergence": "study.verification.convergence",
    "study.errors": "study.verification.errors",
    "study.plots": "plotting.studies",
    "study.precision_plots": "plotting.precision",
    "study.precision_result": "study.verification.precision_result",
    "study.precision_runs": "study.verification.precision_runs",
    "study.recommendation": "study.verification.recommendation",
    "study.stability": "study.verification.stability",
    "study.stability_cases": "study.verification.stability_cases",
    "study.stability_plots": "plotting.stability",
    "study.stability_result": "study.verification.stability_result",
    "study.triangulated": "study.verification.triangulated",
    "study.uncertainty_plots": "plotting.uncertainty",
    "study.work_precision": "study.verification.work_precision",
    "sweep": "study.sweep",
    "test_data": "signals.readers",
    "test_data.csv_channels": "signals.readers.csv_channels",
    "test_data.iso_mme": "signals.readers.iso_mme",
    "test_data.nhtsa": "signals.readers.nhtsa",
    "toml_document": "io.toml",
    "tread": "vehicle.tire_nodes",
    "unit_result": "result.unit_result",
    "unit_shapes": "vehicle.unit_shapes",
    "vehicle.articulated": "vehicle.vehicle",
    "vehicle.builder": "vehicle.vehicle",
    "vehicle_blocks": "vehicle.file_schema",
    "vehicle_changes": "vehicle.vehicle_changes",
    "vehicle_file": "vehicle.vehicle_file",
    "vehicle_guard": "vehicle.vehicle_guard",
    "vehicle_shape": "vehicle.vehicle_shape",
    "vehicle_writer": "vehicle.vehicle_writer",
    "whole_file": "io.atomic_write",
    "zone": "vehicle.zone",
    "zone_law": "vehicle.zone_law",
}
"""Path of an earlier version -> where the module is."""

_OLD_NAMES = {
    "barrier.base.Surface": "barrier.barrier_kind",
    "coarse_skin.node_spacing": "vehicle.node_spacing",
    "frames.capture": "result.capture",
    "free_standing.base_corners": "result.segment_motion",
    "free_standing.lateral_movement": "result.segment_motion",
    "free_standing.overturning_ratio": "result.segment_motion",
    "result_file.load": "result.result",
}
"""Names that are in another module than the rest of theirs."""


_RENAMED = {"LedgerWarning": ("result.energy_balance", "BalanceWarning")}
"""Public names of earlier versions -> module and name of today."""


class _OldModule(ModuleType):
    """Stands at the path of an earlier version; its names are those of the module that has moved."""

    def __init__(self, old: str, new: str) -> None:
        super().__init__(f"birm3d.{old}", f"Moved to birm3d.{new}.")
        self._new = new

    def __getattr__(self, name: str) -> object:
        if name.startswith("__"):  # asked by the import system and by whoever looks at all modules
            raise AttributeError(f"module {self.__name__!r} has no attribute {name!r}")
        old = self.__name__.removeprefix("birm3d.")
        place = _OLD_NAMES.get(f"{old}.{name}", self._new)
        value: object = getattr(import_module(f"birm3d.{place}"), name)
        _warn(f"{self.__name__} has moved: write birm3d.{place}")
        return value


class _ShortPaths(MetaPathFinder, Loader):
    """Finds a module by its short path: the module itself, which is loaded then and keeps its own name."""

    def __init__(self) -> None:
        self._spec_of: dict[str, ModuleSpec | None] = {}

    def find_spec(
        self, name: str, _path: Sequence[str] | None = None, _target: ModuleType | None = None
    ) -> ModuleSpec | None:
        package, _, short = name.partition(".")
        return ModuleSpec(name, self) if package == "birm3d" and short in _SHORT else None

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        module = import_module(f"birm3d.{_SHORT[spec.name.partition('.')[2]]}")
        self._spec_of[module.__name__] = module.__spec__  # the import system replaces it
        return module

    def exec_module(self, module: ModuleType) -> None:
        module.__spec__ = self._spec_of.pop(module.__name__)


def keep_short_paths() -> None:
    """Let documented short paths lead to their modules, in ``import`` statements too."""
    if not any(isinstance(finder, _ShortPaths) for finder in sys.meta_path):
        sys.meta_path.insert(0, _ShortPaths())


def keep_old_paths() -> None:
    """Let paths of earlier versions lead to modules that warn when a name is taken from them."""
    for old, new in _OLD.items():
        sys.modules.setdefault(f"birm3d.{old}", _OldModule(old, new))


def is_old(name: str) -> bool:
    """Whether the package had this name in an earlier version."""
    return name in _RENAMED or name in _OLD


def old_name(name: str) -> object:
    """Return what an old name of the package stands for: a module that has moved, or a name of today."""
    if name in _OLD:
        return sys.modules[f"birm3d.{name}"]
    module, new = _RENAMED[name]
    _warn(f"birm3d.{name} has a new name: write birm3d.{new}")
    return getattr(import_module(f"birm3d.{module}"), new)


def _warn(text: str) -> None:
    from .base.deprecated import warn_deprecated  # not needed to load the package

    warn_deprecated(text)
