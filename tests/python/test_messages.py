"""Wrong arguments of every public callable: accepted, or refused in words of this package."""

from __future__ import annotations

import inspect
import math
import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import birm3d
import numpy as np
import pytest
from birm3d import (
    Barrier,
    Channel,
    Foundation,
    FreeStanding,
    Joint,
    Result,
    Settings,
    Simulation,
    Vehicle,
    Zone,
    calibration,
    filters,
    metrics,
    reference,
    scene_parameters,
    scenes,
    study,
    units,
)
from birm3d.base.arguments import WrongTypeError, checked
from birm3d.calibration import CurveTarget, Parameter, ScalarTarget
from scipy import stats

WRONG: dict[str, Any] = {
    "None": None,
    "text": "abc",
    "list": [1.0, "b"],
    "empty list": [],
    "nan": math.nan,
    "inf": math.inf,
    "negative": -1.0,
    "huge": 10**400,
    "complex": 1j,
    "array (2, 2)": np.zeros((2, 2)),
    "array (5,)": np.linspace(0.0, 1.0, 5),
    "bool": True,
    "object": object(),
    "mapping": {"a": None},
    "class": int,
}
# What pybind11, pydantic, NumPy, SciPy and Python itself say.
FOREIGN = re.compile(
    r"incompatible|validation error|pydantic|Invoked with|could not|ufunc|truth value|unsupported operand|"
    r"must be real number|__init__\(\)|not supported between|object (is not|has no|cannot)|has no attribute|"
    r"only (length-1|0-dim|size-1|integer)|setting an array|inhomogeneous|not iterable|not subscriptable|"
    r"unhashable|to unpack|not callable|invalid literal|int too large|expected str|dtype|object of type|"
    r"positional arg|zero-size|math domain|division|bad operand|argument of type|_core\b|vector::",
)
TIME = np.linspace(0.0, 0.1, 101)
KNEE = {"k_initial": 1e6, "knee": 0.1, "k_hardening": 1e5, "k_unloading": 4e6}
PLACES = {"place_on_leading": (0.0, 0.0, 0.5), "place_on_trailing": (0.0, 0.0, 0.5)}
TETRAHEDRON = {
    "vertices": [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    "faces": [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
}
# What takes minutes, opens windows or writes movies, or is a frozen table that only its own module makes.
ELSEWHERE = {
    *("ArticulatedVehicle", "CurveComparison", "ElementLoad", "FileFormatError", "Result", "Scene", "Study"),
    *("StudyInterrupted", "StudyStoppedError", "stability", "work_precision"),
    *("CalibrationResult", "Evaluation", "FittedParameter", "FittedTarget", "Profile", "NhtsaTest", "Unit"),
    *("PrecisionRow", "Recommendation", "Stability", "StabilityRow", "Summary", "WorkPrecision", "Measure"),
    *("Stated", "energy_residual", "extremes_for", "values_of_outcome", "preset_for", "load"),
    *("nhtsa_tests", "nhtsa_10146"),
    *(
        "HistoryBands",
        "LoadMap",
        "LoadMapComparison",
        "Limit",
        "Prediction",
        "Rating",
        "Rerun",
        "WorstOffset",
        "DesignLoadInterrupted",
        "WorkPrecisionInterrupted",
    ),
    *(
        "oblique",
        "paper_table_2",
        "parked",
        "rolling",
    ),  # scenes of presets at full size, which take longer to make
}
PATHS = ("path", "store", "executor", "progress")  # test_file_readers.py and test_sweep.py have them
WRITE_OR_READ = ("rerun", "write_capsule")  # whose paths are gone through here


def spring() -> Vehicle:
    return Vehicle.from_arrays(**lab_arrays())


def lab_arrays() -> dict[str, Any]:
    return {
        "mass": 1000.0, "inertia": 1000.0 * np.eye(3), "nodes": [[1.0, 0.0, 0.0]],
        "anchors": [[0.0, 0.0, 0.0]], "k_initial": 1e6, "k_unloading": 4e6, "mass_center_height": 0.5,
    }  # fmt: skip


def lab() -> Simulation:
    free = Settings(gravity=0.0, ground=False, output_interval=1e-3)
    return Simulation(spring(), Barrier.rigid_wall(friction=0.0), 5.0, settings=free)


Call = tuple[Callable[..., Any], dict[str, Any]]


def calls(folder: Path) -> dict[str, Call]:
    """Name -> what is called, and arguments that it accepts; files are in the folder."""
    car, sim = Vehicle.preset("passenger_car", mesh_density=0.05), lab()
    semi = scenes.laboratory_semi()
    result = sim.run()
    seen = Simulation(car, Barrier.bollards(), 10.0, 70.0, 0.3, settings=Settings(output_interval=1e-3)).run()
    force = Channel("force", TIME, np.sin(TIME), "N")
    swept = birm3d.sweep(sim, impact_speed=[4.0, 5.0], metrics=["dynamic_crush"], progress=False)
    normal = {"vehicle.gvw": stats.norm(1000.0, 10.0)}
    few: dict[str, Any] = {"simulation": sim, "distributions": normal, "n": 2}
    crush = ScalarTarget("dynamic_crush", result.metrics["dynamic_crush"], 1e-3)
    mass = Parameter("vehicle.gvw", 500.0, 2000.0)
    law = dict.fromkeys(("k_initial", "knee", "k_hardening", "f_max", "k_unloading"), 1e6)
    with_car = Simulation(car, Barrier.bollards(), 5.0)
    found: dict[str, Call] = {
        "Settings": (Settings, {}),
        "Zone": (Zone, KNEE),
        "Zone, envelope": (Zone, {"envelope": ((0.0, 0.0), (1.0, 1e5)), "k_unloading": 1e6}),
        "Zone.scaled": (Zone(**KNEE).scaled, {"factor": 1.0}),
        "FreeStanding": (FreeStanding, {}),
        "Foundation": (Foundation, {"moment": 1e5}),
        "Joint": (Joint, PLACES),
        "Barrier.rigid_wall": (Barrier.rigid_wall, {}),
        "Barrier.bollards": (Barrier.bollards, {}),
        "Barrier.pole": (Barrier.pole, {}),
        "Barrier.jersey": (Barrier.jersey, {"length": 6.0}),
        "Barrier.from_mesh": (Barrier.from_mesh, TETRAHEDRON),
        "Barrier.station": (Barrier.pole().station, {}),
        "Barrier.place": (Barrier.pole().place, {"across": 0.0, "along": 0.0}),
        "Vehicle.preset": (Vehicle.preset, {"name": "passenger_car", "mesh_density": 0.02}),
        "Vehicle.from_arrays": (Vehicle.from_arrays, lab_arrays()),
        "Vehicle.articulated": (
            Vehicle.articulated,
            {"units": [spring(), spring()], "joint": Joint(**PLACES)},
        ),
        "Vehicle.with_truss_law": (spring().with_truss_law, law),
        "Vehicle.with_zone": (car.with_zone, {"name": "bumper", **KNEE}),
        "Vehicle.with_zone, scale": (car.with_zone, {"name": "bumper", "scale": 1.0}),
        "Vehicle.with_joint": (semi.with_joint, {"joint": "welded"}),
        "Vehicle.with_unit": (semi.with_unit, {"index": 0, "unit": spring()}),
        "Simulation": (
            Simulation, {"vehicle": spring(), "barrier": Barrier.rigid_wall(), "impact_speed": 5.0}
        ),
        "Simulation.run": (lab().run, {}),
        "Simulation.restore": (lab().restore, {"snapshot": sim.snapshot()}),
        "Simulation.from_scene": (Simulation.from_scene, {"scene": sim.scene}),
        "Result.final_nodes": (seen.final_nodes, {}),
        "Result.pose": (seen.pose, {"time": 0.0}),
        "Result.unit": (seen.unit, {"index": 0}),
        "Result.with_frames": (result.with_frames, {}),
        "Result.compute_metrics": (metrics.compute_metrics, {"result": result}),
        "Channel": (Channel, {"name": "f", "time": TIME, "values": np.sin(TIME), "unit": "N"}),
        "check_channel": (birm3d.check_channel, {"channel": force}),
        "compare_curves": (birm3d.compare_curves, {"measured": force, "computed": force}),
        "cfc": (filters.cfc, {"signal": TIME, "channel_class": 60.0, "interval": 1e-3}),
        "peak_of_cfc": (filters.peak_of_cfc, {"signal": TIME, "channel_class": 60.0, "interval": 1e-3}),
        "moving_average": (filters.moving_average, {"signal": TIME, "width": 0.01, "interval": 1e-3}),
        "Study": (
            birm3d.Study,
            {
                "vehicle": "a", "run": [0], "parameters": {"x": [1.0]}, "metrics": {"dynamic_crush": [1.0]},
                "end_reason": ["stopped"], "state_hash": ["0"], "error": [""], "units": {},
            },
        ),
        "Study.simulation": (swept.simulation, {"row": 0}),
        "Study.joined": (birm3d.Study.joined, {"studies": [swept]}),
        "sweep": (birm3d.sweep, {"simulation": sim, "parameters": {"impact_speed": [4.0]}}),
        "sweep, lists": (lambda **lists: birm3d.sweep(sim, progress=False, **lists), {"impact_speed": [4.0]}),
        "monte_carlo": (birm3d.monte_carlo, few),
        "sobol": (birm3d.sobol, few),
        "fragility": (birm3d.fragility, {**few, "speeds": [4.0, 5.0], "exceeds": {"dynamic_crush": 0.16}}),
        "critical_impact_point": (
            birm3d.critical_impact_point,
            {
                "simulation": sim, "metric": "delta_v", "ranges": {"impact_speed": (4.0, 5.0)},
                "points": 3, "max_runs": 4,
            },
        ),
        "ensemble": (birm3d.ensemble, {"simulations": [sim]}),
        "ensemble, one": (lambda one: birm3d.ensemble([one], progress=False), {"one": sim}),
        "calibrate": (
            birm3d.calibrate,
            {"simulations": sim, "targets": [crush], "parameters": [mass], "starts": 1, "max_steps": 1},
        ),
        "CurveTarget": (CurveTarget, {"x": TIME, "y": TIME, "sigma": 1.0}),
        "CurveTarget.from_channel": (CurveTarget.from_channel, {"channel": force}),
        "ScalarTarget": (ScalarTarget, {"metric": "dynamic_crush", "value": 0.1, "sigma": 0.01}),
        "Parameter": (Parameter, {"names": "vehicle.gvw", "lower": 500.0, "upper": 2000.0}),
        "in_si": (scene_parameters.in_si, {"name": "impact_speed", "value": 4.0}),
        "quantity_of": (scene_parameters.quantity_of, {"name": "impact_speed"}),
        "unit_of": (scene_parameters.unit_of, {"name": "impact_speed"}),
        "parameter_names": (scene_parameters.parameter_names, {"simulation": sim}),
        "value_of": (scene_parameters.value_of, {"simulation": sim, "name": "impact_speed"}),
        "varied": (scene_parameters.varied, {"simulation": sim, "changes": {"impact_speed": 4.0}}),
        "varied_scene": (scene_parameters.varied_scene, {"base": sim.scene, "changes": {}}),
        "varied, values": (
            lambda **changes: scene_parameters.varied(
                with_car, {name.replace("__", "."): value for name, value in changes.items()}
            ),
            {
                "impact_speed": 4.0, "vehicle__gvw": 1800.0, "vehicle__mesh_density": 0.05, "vehicle": car,
                "zone__bumper__scale": 1.0, "barrier__count": 3, "barrier__diameter": 0.3,
                "settings__tolerance": 0.01, "settings__ground": True, "settings__contact_model": "projected",
            },
        ),
        "mph": (units.mph, {"value": 1.0}),
        "measure": (units.measure, {"symbol": "m"}),
        "parse": (units.parse, {"text": "5 m", "quantity": "length"}),
        "quantity_in": (units.quantity_in, {"unit": "m"}),
        "si": (units.si, {"name": "a", "value": 5.0, "quantity": "length"}),
        "elastic_block": (scenes.elastic_block, {"n": 4}),
        "laboratory_block": (scenes.laboratory_block, {"n": 4, "k_initial": 1e6, "k_unloading": 4e6}),
        "laboratory_semi": (scenes.laboratory_semi, {}),
        "nhtsa_frontal": (scenes.nhtsa_frontal, {"number": "10146", "mesh_density": 0.02}),
        "pickup_at_bollards": (scenes.pickup_at_bollards, {"clear_spacing": 1.2, "mesh_density": 0.02}),
        "w1": (scenes.w1, {"n": 4}),
        "w2": (scenes.w2, {"n": 4}),
        "w2_force": (scenes.w2_force, {"time": TIME}),
        **{
            name: (getattr(scenes, name), {"mesh_density": 0.02})
            for name in ("oblique_car", "truck_at_bollards", "truck_at_wall")
        },
    }  # fmt: skip
    for vehicle in (car, semi):
        for method, given in {
            "scaled_to": {"mass": 2000.0}, "with_gvw": {"gvw": 1800.0}, "with_payload": {"payload": 10.0},
            "with_indentation_length": {"indentation_length": 0.5},
            "with_rate_sensitivity": {"rate_sensitivity": 0.01},
            "with_mass_center_height": {"height": 0.6}, "with_mesh_density": {"mesh_density": 0.05},
            "with_zones": {"zones": {}},
        }.items():  # fmt: skip
            found[f"{vehicle.name}.{method}"] = (getattr(vehicle, method), given)
    for method, given in {
        "between": {"start": 0.0, "end": 0.05}, "filtered": {"cfc": 60.0}, "integrated": {},
        "resampled": {"time": TIME[:5]}, "shifted": {"time_zero": 0.1}, "to": {"unit": "kN"},
        "with_values": {"values": TIME}, "without_bias": {"before": 0.015},
    }.items():  # fmt: skip
        found[f"Channel.{method}"] = (getattr(force, method), given)
    found.update(assessments(car, semi, result, folder))
    return found


def assessments(car: Vehicle, semi: Vehicle, slow: Result, folder: Path) -> dict[str, Call]:
    """The same of what judges runs and searches for limits of a barrier."""
    quick, saloon = Settings(output_interval=1e-3), car.scaled_to(2100.0)
    row = Simulation(car, Barrier.bollards(count=5), 5.0, settings=quick)
    tubes = Simulation(car, Barrier.bollards(count=5, wall_thickness=0.01), 5.0, settings=quick)
    hit = Simulation(saloon, Barrier.rigid_wall(), 15.0, settings=quick).run()
    free = Barrier.jersey(length=24.0, segments=4, free_standing=FreeStanding())
    chain = Simulation(car, free, 15.0, 20.0, settings=quick)
    capsule = folder / "run.birm3d"
    birm3d.write_capsule(slow, capsule)
    likely = birm3d.predict(Simulation(saloon, Barrier.rigid_wall(), 15.0, settings=quick), 8, progress=False)
    coarse: dict[str, Any] = {"points": 2, "resolution": 1.0}
    return {
        "Vehicle.from_facts": (Vehicle.from_facts, {"kind": "car", "mass": 1400.0, "mesh_density": 0.02}),
        "Barrier.planter": (Barrier.planter, {}),
        "Result.sensor": (hit.sensor, {"point": (0.0, 0.0, 0.5)}),
        "design_load": (birm3d.design_load, {"cases": row, "offsets": [0.0]}),
        "DesignLoad.spectrum": (birm3d.design_load(row, progress=False).spectrum, {"periods": [0.1]}),
        "DesignLoad[element]": (
            lambda element: birm3d.design_load(hit, progress=False)[element],
            {"element": 0},
        ),
        "occupant_risk": (birm3d.occupant_risk, {"result": hit}),
        "occupant_risk, channels": (
            birm3d.occupant_risk,
            {
                "x": Channel("x", TIME, -200.0 * np.sin(np.pi * TIME / 0.1), "m/s2"),
                "y": 0.0,
                "z": 0.0,
                "yaw_rate": 0.0,
            },
        ),
        "OccupantRisk.passed": (birm3d.occupant_risk(hit).passed, {"standard": "MASH"}),
        "rate": (birm3d.rate, {"result": hit, "standard": "ASTM F2656"}),
        "rate, one of several": (
            lambda one: birm3d.rate([one], "MASH TL-3", vehicle_class="1100C"),
            {"one": hit},
        ),
        "RatingStudy.interval": (birm3d.rate(likely, "ASTM F2656").interval, {"share": 0.5}),
        "test_matrix": (birm3d.test_matrix, {"standard": "MASH 3-10", "mesh_density": 0.02}),
        "worst_offset": (
            birm3d.worst_offset,
            {"simulation": row, "metric": "delta_v", "points": 3, "max_runs": 4},
        ),
        "greatest_gap": (birm3d.greatest_gap, {"simulation": row, "offset_shares": (0.0,), **coarse}),
        "least_height": (birm3d.least_height, {"simulation": row, "offsets": (0.0,), **coarse}),
        "least_segment_mass": (
            birm3d.least_segment_mass,
            {"simulation": chain, "deflection": 5.0, "points": 2, "resolution": 4000.0},
        ),
        "least_tube_thickness": (
            birm3d.least_tube_thickness,
            {"simulation": tubes, "offsets": (0.0,), "thicknesses": (0.01, 0.02), **coarse},
        ),
        "predict": (birm3d.predict, {"simulation": row, "n": 8}),
        "history_bands": (birm3d.history_bands, {"study": likely, "channels": ["travel"]}),
        "plot_runs": (birm3d.plot_runs, {"results": [slow], "channels": ["travel"], "labels": ["slow"]}),
        "Result.load_map": (hit.load_map, {"cell": 0.25, "lateral": [-1.0, 0.0, 1.0]}),
        "LoadMap.at": (hit.load_map().at, {"time": 0.01}),
        "LoadMap.plot": (hit.load_map().plot, {"time": 0.01}),
        **load_cells(hit),
        "rerun": (birm3d.rerun, {"path": capsule}),
        "write_capsule": (birm3d.write_capsule, {"result": slow, "path": folder / "copy.birm3d"}),
        "dossier": (birm3d.dossier, {"result": slow, "folder": folder / "dossier"}),
        "relative_to_start": (metrics.relative_to_start, {"scene": row.scene, "energy": 1.0, "start": 1.0}),
    }


def load_cells(hit: Result) -> dict[str, Call]:
    """The same of measured load maps and their comparison."""
    one = Channel("A1", TIME, np.sin(TIME), "N")
    edges: dict[str, Any] = {"lateral": [0.0, 1.0], "height": [0.0, 1.0]}
    computed = hit.load_map()
    both = birm3d.compare_load_maps(computed, computed)
    return {
        "measured_load_map": (birm3d.measured_load_map, {"channels": {"A1": one}, **edges}),
        "compare_load_maps": (birm3d.compare_load_maps, {"measured": computed, "computed": computed}),
        "LoadMapComparison.plot": (both.plot, {"quantity": "peak"}),
        "LoadMapComparison.values": (both.values, {"quantity": "peak"}),
        "LoadMapComparison.difference": (both.difference, {"quantity": "peak"}),
    }


def test_what_can_be_gone_through_once_is_left_to_the_function() -> None:
    @checked
    def total(values: Sequence[float], *, more: Sequence[float] | None = None) -> float:
        return sum(values) + sum(more or ())

    assert total(x for x in (1.0, 2.0)) == 3.0
    assert total(np.ones(2), more=(1, np.float32(2.0))) == 5.0
    with pytest.raises(WrongTypeError, match=r"more\[1\] must be a number, got 'b'"):
        total([], more=[1.0, "b"])  # type: ignore[list-item]
    with pytest.raises(TypeError, match=r"values must be a list of numbers, got \{1: 2\}"):
        total({1: 2})  # type: ignore[arg-type]


def leak(error: Exception) -> str | None:
    """Return what is wrong with an error, if anything."""
    message = str(error)
    if not isinstance(error, (ValueError, TypeError)):
        return f"{type(error).__name__}: {message}"
    own = re.search(r"\b(must|needs|can not|has|have|is|are)\b", message) and not FOREIGN.search(message)
    return None if own else f"{type(error).__name__}: {message}"


@pytest.mark.filterwarnings("ignore")
def test_wrong_arguments_are_refused_in_own_words(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)  # where texts that are taken for a path or a folder are written
    monkeypatch.setattr("matplotlib.figure.Figure.savefig", lambda *_, **__: None)  # takes seconds a page
    leaks = []
    for name, (function, given) in calls(tmp_path).items():
        signature = inspect.signature(function).parameters
        quiet = {"progress": False} if "progress" in signature and name != "calibrate" else {}
        known = [p.name for p in signature.values() if p.kind not in (p.VAR_KEYWORD, p.VAR_POSITIONAL)]
        for argument in dict.fromkeys([*known, *given]):
            if argument in PATHS and name not in WRITE_OR_READ:
                continue
            for label, wrong in WRONG.items():
                try:
                    function(**{**quiet, **given, argument: wrong})
                except Exception as error:
                    if said := leak(error):
                        leaks.append(f"{name}({argument}={label}): {said[:200]}")
    assert leaks == []


def test_the_walk_has_every_public_callable(tmp_path: Path) -> None:
    walked = {name.split(",")[0].split(".")[0] for name in calls(tmp_path)} | {"compute_metrics"}
    modules = (birm3d, calibration, filters, metrics, reference, scene_parameters, scenes, study, units)
    public = {
        name
        for module in modules
        for name in module.__all__
        if callable(getattr(module, name)) and not isinstance(getattr(module, name), units.Unit)
    }
    errors = {name for name in public if name.endswith(("Error", "Warning"))}
    readers = {name for name in public if name.startswith("read_")}
    assert public - walked - ELSEWHERE - errors - readers == set()
