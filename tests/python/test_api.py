"""The public names, what kind of things they give, and how runs share a machine."""

from __future__ import annotations

import copy
import dataclasses
import importlib
import pickle
import signal
import subprocess
import sys
import textwrap
import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import birm3d
import numpy as np
import pytest
from birm3d import Barrier, Result, Settings, Simulation, Vehicle, Zone, _moved, scenes, units
from birm3d.metrics import METRIC_UNITS, compute_metrics
from matplotlib.figure import Figure


def test_names() -> None:
    assert {"Barrier", "Result", "Settings", "Simulation", "UnstableError", "Vehicle", "units"} <= set(
        birm3d.__all__
    )
    assert all(hasattr(birm3d, name) for name in birm3d.__all__)
    assert birm3d.__version__
    assert dir(birm3d) == sorted(birm3d.__all__)
    assert not {"annotations", "vehicle", "barrier", "simulation", "_core"} & set(dir(birm3d))
    assert issubclass(birm3d.UnstableError, ValueError)


def test_scenario_of_the_contract() -> None:
    assert {"passenger_car", "pickup", "paper_pickup"} <= set(Vehicle.presets())
    car = Vehicle.preset("passenger_car", gvw=units.lb(4500), mesh_density=0.5)
    wall = Barrier.rigid_wall(width=None, height=None, friction=0.2)
    sim = Simulation(
        car,
        wall,
        impact_speed=units.mph(59.8),
        impact_angle=24.0,
        impact_offset=0.0,
        duration=None,
        settings=Settings(),
    )
    result = sim.run()
    assert isinstance(result, Result)
    assert sim.state_hash() == result.state_hash
    assert result.end_reason == "separated"
    assert isinstance(sim.state_hash(), int)


METRICS = {
    "peak_deceleration", "peak_deceleration_cfc60", "peak_normal_force", "peak_normal_force_cfc60",
    "peak_force_50ms", "dynamic_crush", "residual_crush", "exit_speed", "exit_angle", "max_roll", "max_pitch",
    "max_yaw", "vehicle_penetration", "energy_residual", "momentum_residual", "steps", "run_time",
}  # fmt: skip


def test_metrics_of_the_contract(result_of: Callable[[str], Result]) -> None:
    metrics = result_of("oblique_24").metrics
    assert set(metrics) >= METRICS
    assert all(type(value) is float for value in metrics.values())
    with pytest.raises(TypeError):
        metrics["steps"] = 0.0  # type: ignore[index]


def test_arrays(scene_result: Result) -> None:
    r = scene_result
    n, wheels, nodes = len(r.time), len(r.scene.vehicle.wheels), r.scene.vehicle.n_nodes
    shapes: dict[str, tuple[int, ...]] = {
        "time": (n,),
        "position": (n, 3),
        "velocity": (n, 3),
        "acceleration": (n, 3),
        "angular_velocity": (n, 3),
        "roll": (n,),
        "pitch": (n,),
        "yaw": (n,),
        "barrier_force": (n, 3),
        "barrier_normal_force": (n,),
        "tire_reaction": (n, wheels),
        "tire_friction_force": (n, 3),
        "nodes": (nodes, 3),
        "deflection": (nodes,),
        "peak_deflection": (nodes,),
    }
    arrays = {name: (getattr(r, name), shape) for name, shape in shapes.items()}
    arrays.update({f"energy {name}": (values, (n,)) for name, values in r.energy.items()})
    for name, (array, shape) in arrays.items():
        assert isinstance(array, np.ndarray), name
        assert array.dtype == np.float64, name
        assert array.shape == shape, name
        assert not array.flags.writeable, name
    assert np.diff(r.time) == pytest.approx(r.scene.settings.output_interval, rel=1e-9)
    assert r.time[0] == 0.0


def test_arrays_outlive_their_result() -> None:
    position = scenes.w2(16).run().position
    again = scenes.w2(16).run()
    assert np.array_equal(position, again.position)


def vehicles() -> dict[str, Vehicle]:
    return {
        "preset": Vehicle.preset("passenger_car", mesh_density=0.1),
        "loaded": Vehicle.preset("pickup", gvw=3600.0, mesh_density=0.1),
        "zone": Vehicle.preset("pickup", mesh_density=0.1).with_zone("hood", k_unloading=3e8),
        "arrays": scenes.laboratory_block(16, k_initial=3e6, knee=0.4, k_hardening=6e6, k_unloading=6e7),
    }


def things() -> dict[str, Any]:
    return {
        **vehicles(),
        "wall": Barrier.rigid_wall(friction=0.15, heading=20.0, origin=(1.0, 2.0, 0.0)),
        "settings": Settings(time_step=1e-4, tire_model="skid"),
    }


@pytest.mark.parametrize("name", things())
def test_things_are_pickled_compared_and_copied(name: str) -> None:
    thing, twin = things()[name], things()[name]
    for other in (twin, pickle.loads(pickle.dumps(thing)), copy.copy(thing), copy.deepcopy(thing)):
        assert other == thing
        assert type(other) is type(thing)
    others = [other for key, other in things().items() if key != name]
    assert all(thing != other for other in others)
    assert thing != name
    assert repr(thing)


@pytest.mark.parametrize("name", things())
def test_things_are_immutable(name: str) -> None:
    thing = things()[name]
    for field in dataclasses.fields(thing):
        with pytest.raises(dataclasses.FrozenInstanceError):
            setattr(thing, field.name, None)


@pytest.mark.parametrize("name", vehicles())
def test_arrays_of_a_vehicle_are_read_only(name: str) -> None:
    vehicle = vehicles()[name]
    for field in ("center_of_mass", "inertia", "nodes", "anchors", "area", "wheels", "quads", "zone_of_node"):
        array = getattr(vehicle, field)
        assert not array.flags.writeable, field
    assert vehicle.inertia.shape == (3, 3)
    assert vehicle.center_of_mass.shape == (3,)
    assert vehicle.n_nodes == vehicle.n_trusses == len(vehicle.nodes)
    with pytest.raises(TypeError):
        vehicle.zones["new"] = None  # type: ignore[index]


def test_a_vehicle_does_not_hang_on_the_callers_arrays() -> None:
    nodes, inertia = np.array([[2.0, 0.0, 0.0]]), 1e3 * np.eye(3)
    wheels = np.array([[0.0, 0.0, 0.0, 0.3]])
    given = {"mass": 1e3, "anchors": [[0.0, 0.0, 0.0]], "k_initial": 1e6, "k_unloading": 1e6}
    vehicle = Vehicle.from_arrays(
        nodes=nodes, inertia=inertia, wheels=wheels, mass_center_height=0.3, **given
    )
    nodes[0, 0], inertia[0, 0], wheels[0, 3] = 7.0, 7.0, 7.0  # the caller's stay writable
    assert vehicle.nodes[0, 0] == 2.0
    assert vehicle.inertia[0, 0] == 1e3
    assert vehicle.wheels[0, 3] == 0.3


@pytest.mark.parametrize("name", vehicles())
def test_with_gvw_leaves_the_old_vehicle_alone(name: str) -> None:
    vehicle, twin = vehicles()[name], vehicles()[name]
    changed = vehicle.with_gvw(1.1 * vehicle.mass)
    assert vehicle == twin
    assert changed != vehicle
    assert changed.mass == pytest.approx(1.1 * vehicle.mass, rel=1e-12)
    # And back again, to rounding.
    assert changed.with_gvw(vehicle.mass).inertia == pytest.approx(vehicle.inertia, rel=1e-9, abs=1e-6)


def test_with_zone_leaves_the_old_vehicle_alone() -> None:
    vehicle, twin = vehicles()["preset"], vehicles()["preset"]
    law = {"k_initial": 1e6, "knee": 0.3, "k_hardening": 3e5, "f_max": 6e5, "k_unloading": 1e7}
    changed = vehicle.with_zone("hood", **law)
    assert vehicle == twin
    assert changed != vehicle
    assert dict(changed.zones["hood"]) == law
    assert {name: zone for name, zone in changed.zones.items() if name != "hood"} == {
        name: zone for name, zone in vehicle.zones.items() if name != "hood"
    }
    assert changed.with_zone("hood", **{**vehicle.zones["hood"]}) == vehicle


def test_zones_are_read_like_mappings() -> None:
    zone = Zone(k_initial=1e6, knee=0.3, k_hardening=3e5, f_max=6e5, k_unloading=1e7)
    assert zone["knee"] == zone.knee == 0.3
    assert dict(zone) == {"k_initial": 1e6, "knee": 0.3, "k_hardening": 3e5, "f_max": 6e5, "k_unloading": 1e7}
    with pytest.raises(KeyError):
        zone["colour"]


def test_a_simulation_is_pickled_with_its_scene() -> None:
    simulation = scenes.oblique(24.0, friction=0.2)
    twin = pickle.loads(pickle.dumps(simulation))
    assert twin.scene == simulation.scene
    assert twin.time == 0.0
    assert twin.run().state_hash == simulation.run().state_hash


# ---- what a result gives -----------------------------------------------------------------------------------


def test_dataframe(result_of: Callable[[str], Result]) -> None:
    result = result_of("nhtsa_10146")
    table = result.to_dataframe()
    assert table.index.name == "time [s]"
    assert np.array_equal(table.index, result.time)
    vectors = [("position", "m", "xyz"), ("velocity", "m/s", "xyz"), ("barrier_force", "N", "xyz")]
    expected = {f"{name}_{axis} [{unit}]" for name, unit, axes in vectors for axis in axes}
    expected |= {f"acceleration_{axis} [m/s^2]" for axis in "rst"}
    expected |= {"roll [deg]", "pitch [deg]", "yaw [deg]", "barrier_normal_force [N]"}
    expected |= {f"tire_reaction_{i} [N]" for i in range(4)} | {
        f"energy_{name} [J]" for name in result.energy
    }
    assert expected <= set(table.columns)
    assert np.array_equal(table["velocity_x [m/s]"], result.velocity[:, 0])
    assert np.array_equal(table["acceleration_r [m/s^2]"], result.acceleration[:, 0])
    assert not table.isna().to_numpy().any()


def test_dataframe_without_pandas(
    result_of: Callable[[str], Result], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(ImportError, match=r"pandas.*pip install 'birm3d\[table\]'"):
        result_of("w2").to_dataframe()


def test_report(scene_result: Result) -> None:
    text, scene = scene_result.report(), scene_result.scene
    assert scene.vehicle.title in text
    assert "computed" in text
    assert "left out" in text
    assert f"{scene_result.statistics.steps} steps" in text
    assert "energy residual" in text
    assert ("the ground: ground=False" in text) == (not scene.settings.ground)
    assert ("there is no barrier" in text) == (scene.barrier is None)
    assert "nan" not in text.lower()
    assert "inf " not in text.lower()


@pytest.mark.parametrize("name", ["w2", "oblique_24_friction", "parked"])
def test_plot(name: str, result_of: Callable[[str], Result], tmp_path: Path) -> None:
    figure = result_of(name).plot()
    assert isinstance(figure, Figure)
    file = tmp_path / "plot.png"
    figure.savefig(file, dpi=40)
    assert file.stat().st_size > 5000
    assert all(axes.get_xlabel() or axes.get_ylabel() for axes in figure.axes)


def test_importing_the_package_loads_no_graphics() -> None:
    heavy = ("matplotlib", "pandas", "scipy", "pydantic")
    code = f"import sys, birm3d; print([m for m in {heavy} if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


# ---- threads and signals -----------------------------------------------------------------------------------


def test_a_run_lets_other_threads_work() -> None:
    # Steps of 4 microseconds: half a second in the core.
    simulation = scenes.parked(duration=0.2, settings=Settings(time_step=4e-6, output_interval=1e-2))
    runner = threading.Thread(target=simulation.run)
    ticks = 0
    runner.start()
    start = time.perf_counter()
    while runner.is_alive():
        ticks += 1
        time.sleep(1e-3)
    elapsed = time.perf_counter() - start
    assert elapsed > 0.02  # it was long enough to tell
    # A run that held the interpreter would leave one or two ticks.
    assert ticks > 5


def test_keyboard_interrupt_stops_a_run() -> None:
    code = textwrap.dedent("""
        from birm3d import Settings, scenes
        simulation = scenes.parked(duration=1.5, settings=Settings(time_step=1e-6, output_interval=0.1))
        print("running", flush=True)
        try:
            simulation.run()
        except KeyboardInterrupt:
            print("interrupted", simulation.time > 0.0, flush=True)
    """)
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True) as child:
        try:
            assert child.stdout is not None
            assert child.stdout.readline() == "running\n"
            time.sleep(0.3)
            child.send_signal(signal.SIGINT)
            output, _ = child.communicate(timeout=10.0)
        finally:
            child.kill()
    assert output == "interrupted True\n"
    assert child.returncode == 0


def test_threads_give_what_one_thread_gives() -> None:
    car = Vehicle.preset("passenger_car", mesh_density=0.5)  # shared by all
    wall = Barrier.rigid_wall()
    cases = [(speed, angle) for speed in (8.0, 15.0, 22.0) for angle in (24.0, 60.0, 90.0)]

    def run(case: tuple[float, float]) -> Result:
        return Simulation(car, wall, *case).run()

    serial = [run(case) for case in cases]
    with ThreadPoolExecutor(4) as pool:
        parallel = list(pool.map(run, cases))
    for one, other in zip(serial, parallel, strict=True):
        assert one.state_hash == other.state_hash
        assert np.array_equal(one.velocity, other.velocity)
        assert np.array_equal(one.barrier_force, other.barrier_force)


def test_each_metric_alone_is_what_all_together_give() -> None:
    result = scenes.oblique_car(mesh_density=0.2).run()
    together = compute_metrics(result)
    assert set(together) <= set(METRIC_UNITS)
    for name in METRIC_UNITS:
        alone = {name: together[name]} if name in together else {}
        assert compute_metrics(result, (name,)) == alone


def test_short_module_paths_lead_to_the_modules_themselves() -> None:
    for short, place in _moved._SHORT.items():
        module = importlib.import_module(f"birm3d.{short}")  # a warning would be an error
        assert module is importlib.import_module(f"birm3d.{place}")


def test_module_paths_of_earlier_versions_work_and_say_what_to_write() -> None:
    for old, place in _moved._OLD.items():
        module, moved = importlib.import_module(f"birm3d.{old}"), importlib.import_module(f"birm3d.{place}")
        name = moved.__all__[0]
        with pytest.warns(DeprecationWarning, match=f"birm3d.{old} has moved: write birm3d.{place}$") as told:
            assert getattr(module, name) is getattr(moved, name)
        assert told[0].filename == __file__  # it points at the caller
    names: dict[str, Any] = {}
    with pytest.warns(DeprecationWarning, match="write birm3d.signals.channel"):
        exec("from birm3d.channel import Channel", names)
    assert names["Channel"] is birm3d.Channel
    with pytest.raises(AttributeError, match="no attribute 'chanel'"):
        _ = birm3d.chanel


def test_a_renamed_name_works_and_says_what_to_write() -> None:
    with pytest.warns(
        DeprecationWarning, match=r"birm3d\.LedgerWarning .*: write birm3d\.BalanceWarning$"
    ) as told:
        old = birm3d.LedgerWarning
    assert old is birm3d.BalanceWarning
    assert told[0].filename == __file__
