"""Whatever a call hands back pickles and deep-copies: other processes, caches and notebooks need it."""

from __future__ import annotations

import copy
import pickle
import re
from collections.abc import Callable
from functools import cache
from typing import Any

import birm3d
import numpy as np
import pytest
from birm3d import Barrier, Channel, Settings, Simulation, Vehicle
from birm3d.base.frozen_mapping import FrozenMapping
from birm3d.calibration import CalibrationError, Parameter, ScalarTarget
from birm3d.study import stability, work_precision
from scipy.stats import norm, uniform

GVW = {"vehicle.gvw": norm(1800.0, 30.0)}
ANGLES = {"impact_angle": uniform(70.0, 10.0)}


@cache
def sim() -> Simulation:
    car = Vehicle.preset("passenger_car", mesh_density=0.05)
    return Simulation(car, Barrier.rigid_wall(), 10.0, duration=0.05, settings=Settings(tolerance=0.05))


@cache
def result() -> birm3d.Result:
    return sim().run(frames=3)


def channels() -> tuple[Channel, Channel]:
    time = np.arange(200) * 1e-3
    return tuple(Channel(str(k), time, np.sin(k * time), "kN", 60) for k in (30, 31))


def calibrated() -> Any:
    targets = [ScalarTarget("delta_v", 9.0, 0.1), ScalarTarget("dynamic_crush", 0.3, 0.1)]
    return birm3d.calibrate(sim(), targets, Parameter("zone.bumper.scale", 0.5, 2.0), starts=1, max_steps=2)


MADE: dict[str, Callable[[], Any]] = {
    "result": result,
    "unit of a result": lambda: result().unit(0),
    "element loads": lambda: result().element_loads,
    "frames": lambda: result().frames,
    "energy": lambda: result().energy,
    "sweep": lambda: birm3d.sweep(sim(), {"vehicle": [sim().scene.vehicle], "impact_speed": [5.0, 6.0]}),
    "summary": lambda: birm3d.sweep(sim(), impact_speed=[5.0, 6.0]).summary(),
    "monte carlo": lambda: birm3d.monte_carlo(sim(), GVW, 2, metrics=["delta_v"]),
    "sobol": lambda: birm3d.sobol(sim(), {**GVW, **ANGLES}, 2, metrics=["delta_v"]),
    "fragility": lambda: birm3d.fragility(sim(), [8.0, 11.0], ANGLES, 4, exceeds={"dynamic_crush": 0.3}),
    "critical point": lambda: birm3d.critical_impact_point(
        sim(), "delta_v", {"impact_angle": (60.0, 80.0)}, points=3, max_runs=6
    ),
    "ensemble": lambda: birm3d.ensemble([sim()], metrics=["delta_v"]),
    "calibration": calibrated,
    "calibration error": lambda: CalibrationError("why", (1.0,)),
    "comparison": lambda: birm3d.compare_curves(*channels()),
    "channel": lambda: channels()[0],
    "findings": lambda: birm3d.check_channel(channels()[0]),
    "work precision": lambda: work_precision(
        sim(), tolerances=(0.1, 0.05), references=(1e-3, 1e-4), repeats=1, representations=False,
        contact_models=False, progress=False,
    ),
    "stability": lambda: stability(sim(), axes=["speed"], progress=False),
    "vehicle": lambda: sim().scene.vehicle,
    "zones": lambda: sim().scene.vehicle.zones,
    "two units": lambda: Vehicle.preset("semi_truck", mesh_density=0.05),
    "scene": lambda: sim().scene,
    "simulation": sim,
    "barrier": lambda: Barrier.jersey(length=6.0, segments=2, free_standing=True),
    "interrupted": lambda: birm3d.StudyInterrupted("stopped", birm3d.ensemble([sim()], metrics=["delta_v"])),
    "died": lambda: birm3d.StudyStoppedError("died", birm3d.ensemble([sim()], metrics=["delta_v"])),
}  # fmt: skip


@pytest.mark.parametrize("name", MADE)
def test_pickled_and_deep_copied(name: str) -> None:
    made = MADE[name]()
    for again in (pickle.loads(pickle.dumps(made)), copy.deepcopy(made), copy.copy(made)):
        assert type(again) is type(made)
        assert_same(made, again)


def plain(text: str) -> str:
    """A representation without the place in memory."""
    return re.sub(r" at 0x[0-9a-f]+", "", text)


def assert_same(a: Any, b: Any, depth: int = 0) -> None:
    """Values alike all the way down; arrays bit for bit, and as read-only as they were."""
    assert type(a) is type(b)
    if isinstance(a, np.ndarray):
        assert a.dtype == b.dtype
        assert np.array_equal(a, b, equal_nan=a.dtype.kind == "f")
        return
    if isinstance(a, (str, int, float, type(None))):
        assert a == b or a != a
        return
    if isinstance(a, (dict, FrozenMapping)):
        assert list(a) == list(b)
        for key in a:
            assert_same(a[key], b[key], depth + 1)
    elif isinstance(a, (list, tuple)):
        assert len(a) == len(b)
        for one, other in zip(a, b, strict=True):
            assert_same(one, other, depth + 1)
    elif not callable(a):
        assert plain(repr(a)) == plain(repr(b))
        own = getattr(a, "__dict__", {}) if depth < 4 else {}
        names = [n for n in own if not n.startswith("_") and n in getattr(b, "__dict__", {})]
        for name in names:
            assert_same(getattr(a, name), getattr(b, name), depth + 1)


def test_arrays_of_a_copied_study_are_read_only() -> None:
    study = pickle.loads(pickle.dumps(birm3d.sweep(sim(), impact_speed=[5.0], metrics=["delta_v"])))
    for array in (study.run, study["delta_v"], study["impact_speed"]):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1
    with pytest.raises(TypeError):
        study.metrics["delta_v"] = np.zeros(1)
