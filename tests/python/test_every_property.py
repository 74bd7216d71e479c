"""Every public property and method of every kind of result does what it is for, or says what it needs."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

import birm3d
import pytest
from birm3d import Barrier, FreeStanding, Settings, Simulation, Vehicle
from birm3d.calibration import CurveTarget, Parameter, ScalarTarget
from one_truss import one_truss
from scipy import stats

COARSE = Settings(output_interval=1e-3)
# They open a window or take minutes; tests of their own are in test_rendering.py.
ELSEWHERE = {"animate", "render", "show"}
OLD_NAMES = {"left_out"}
"""They warn: see test_old_names.py."""
PICTURES = {"plot", "plot_histories", "plot_plan", "plot_crush", "plot_elements", "write_html"}
# What a method needs where it has required arguments.
ARGUMENTS: dict[str, Callable[[Path], tuple[Any, ...]]] = {
    "save": lambda folder: (folder / "file.npz",),
    "save_vehicle": lambda folder: (folder / "vehicle.toml",),
    "write_html": lambda folder: (folder / "page.html",),
    "unit": lambda folder: (0,),
    "pose": lambda folder: (0.0,),
    "shifted": lambda folder: (0.1,),
    "scaled": lambda folder: (2.0,),
    "without_bias": lambda folder: (0.015,),
}
# Errors that say what a run lacks; all others fail.
LACKS = (
    r"needs a vehicle of two units|needs a vehicle with_sliding_bed|elements must have been touched|"
    r"needs a barrier|must be"
)


@cache
def car() -> Vehicle:
    return Vehicle.preset("passenger_car", mesh_density=0.1)


@cache
def spring() -> Vehicle:
    return one_truss(0.5, k_unloading=4e6)


def lab(speed: float = 5.0) -> Simulation:
    free = Settings(gravity=0.0, ground=False, output_interval=1e-3)
    return Simulation(spring(), Barrier.rigid_wall(friction=0.0), speed, settings=free)


def one_unit() -> Any:
    return Simulation(car(), Barrier.bollards(), 10.0, 70.0, 0.3, settings=COARSE).run()


def articulated() -> Any:
    semi = Vehicle.preset("semi_truck", mesh_density=0.1)
    return Simulation(semi, Barrier.rigid_wall(), 8.0, 30.0, duration=0.1, settings=COARSE).run()


def sliding_bed() -> Any:
    truck = Vehicle.preset("cargo_truck", mesh_density=0.1).with_sliding_bed()
    return Simulation(truck, Barrier.rigid_wall(), 8.0, duration=0.1, settings=COARSE).run()


def free_standing() -> Any:
    barrier = Barrier.jersey(length=12.0, segments=3, free_standing=FreeStanding())
    return Simulation(car(), barrier, 15.0, 25.0, duration=0.1, settings=COARSE).run()


def no_barrier() -> Any:
    return Simulation(car(), None, 10.0, duration=0.05, settings=COARSE).run()


def untouched() -> Any:
    return Simulation(car(), Barrier.bollards(count=2, spacing=4.0), 15.0, settings=COARSE).run()


def swept() -> Any:
    return birm3d.sweep(lab(), impact_speed=[4.0, 5.0])


def drawn() -> Any:
    return birm3d.monte_carlo(lab(), {"vehicle.gvw": stats.norm(1000.0, 10.0)}, 3)


def fragile() -> Any:
    inputs = {"vehicle.gvw": stats.norm(1000.0, 50.0)}
    return birm3d.fragility(lab(), [4.0, 5.0, 6.0], inputs, 5, exceeds={"dynamic_crush": 0.16})


def sensitivity() -> Any:
    return birm3d.sobol(lab(), {"vehicle.gvw": stats.norm(1000.0, 10.0)}, n=4, metrics=["dynamic_crush"])


def worst() -> Any:
    return birm3d.critical_impact_point(lab(), "delta_v", {"impact_speed": (4.0, 5.0)}, points=3)


def channel() -> Any:
    result = lab().run()
    return birm3d.Channel("force", result.time, result.barrier_normal_force, "N")


def compared() -> Any:
    return birm3d.compare_curves(channel(), channel())


def fitted() -> Any:
    made = lab().run()
    target = CurveTarget(made.time[1:] - 5e-4, made.barrier_normal_force[1:], sigma=1e3)
    return birm3d.calibrate(
        lab(),
        [target, ScalarTarget("dynamic_crush", made.metrics["dynamic_crush"], 1e-3)],
        [Parameter("vehicle.gvw", 500.0, 2000.0)],
    )


KINDS = {
    make.__name__: make
    for make in (
        *(one_unit, articulated, sliding_bed, free_standing, no_barrier, untouched, swept, drawn, fragile),
        *(sensitivity, worst, channel, compared, fitted),
    )
}


def public(kind: type) -> Iterator[tuple[str, Any]]:
    for name in dir(kind):
        if not name.startswith("_") and name not in ELSEWHERE | OLD_NAMES:
            yield name, inspect.getattr_static(kind, name)


def required(method: Callable[..., Any]) -> list[str]:
    parameters = inspect.signature(method).parameters.values()
    open_kinds = (inspect.Parameter.VAR_POSITIONAL, inspect.Parameter.VAR_KEYWORD)
    return [p.name for p in parameters if p.default is p.empty and p.kind not in open_kinds]


def touch(instance: Any, folder: Path, pictures: bool = True) -> set[str]:
    """Read all properties, call all methods that need no arguments or whose arguments are known."""
    seen = set()
    for name, static in public(type(instance)):
        if isinstance(static, (staticmethod, classmethod)) or (not pictures and name in PICTURES):
            continue
        try:
            value = getattr(instance, name)
            if inspect.ismethod(value):
                missing = required(value) or name in ARGUMENTS
                if missing and name not in ARGUMENTS:
                    continue
                value(*(ARGUMENTS[name](folder) if missing else ()))
        except ValueError as error:
            if not re.search(LACKS, str(error)):
                raise
        seen.add(name)
    for name in vars(instance):
        if not name.startswith("_"):
            getattr(instance, name)
            seen.add(name)
    return seen


@pytest.mark.filterwarnings("ignore::birm3d.scene.mesh_check.CoarseSkinWarning")
@pytest.mark.parametrize("name", KINDS)
@pytest.mark.filterwarnings("ignore::birm3d.TippingWarning")
def test_every_public_name_works(name: str, tmp_path: Path) -> None:
    instance = KINDS[name]()
    pictures = name not in (
        "articulated",
        "sliding_bed",
        "free_standing",
        "untouched",
    )  # they take time, and are alike
    seen = touch(instance, tmp_path, pictures)
    assert len(seen) >= 4
    assert repr(instance)
    if isinstance(instance, birm3d.Result):
        assert {"ground_force", "outcome", "outcome_detail", "metrics", "report"} <= seen
        assert (name == "sliding_bed") == instance.scene.vehicle.slides
        for unit in range(len(instance.scene.vehicle.units)):
            touch(instance.unit(unit), tmp_path)
        for load in instance.element_loads:
            touch(load, tmp_path)
        loaded = birm3d.load(tmp_path / "file.npz")
        assert touch(loaded, tmp_path, pictures=False) == seen - PICTURES


def test_the_check_finds_what_is_broken(tmp_path: Path) -> None:
    class Broken:
        @property
        def force(self) -> float:
            raise AttributeError("no such column")

    with pytest.raises(AttributeError, match="no such column"):
        touch(Broken(), tmp_path)
