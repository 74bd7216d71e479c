"""Many scenes from one call: same bits in any order and on any executor, one bad run stops no other."""

from __future__ import annotations

import gc
import signal
import subprocess
import sys
import threading
import time
import tracemalloc
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from birm3d import (
    BalanceWarning,
    Barrier,
    Result,
    Settings,
    Simulation,
    StudyInterrupted,
    Vehicle,
    ensemble,
    scenes,
    sweep,
)
from birm3d.filters import cfc, moving_average
from birm3d.metrics import METRIC_UNITS
from birm3d.result.segment_motion import lateral_movement
from birm3d.vehicle.test_bodies import elastic_block

METRICS = ["dynamic_crush", "exit_speed"]
WEIGHTLESS = Settings(gravity=0.0, ground=False)
# run_time is never the same.
ALL = tuple(name for name in METRIC_UNITS if name != "run_time")


def few_scenes() -> list[Simulation]:
    car = Vehicle.preset("passenger_car", mesh_density=0.1)
    posts = Barrier.bollards()
    return [
        scenes.w2(100),
        Simulation(car, posts, 12.0, 90.0),
        Simulation(car, Barrier.rigid_wall(), 20.0, 25.0),
        Simulation(car, Barrier.jersey(length=40.0), 20.0, 20.0),
        Simulation(car, posts, 8.0, 60.0, 0.3),
    ]


def test_same_bits_on_any_executor_and_in_any_order() -> None:
    alone = [simulation.run() for simulation in few_scenes()]
    expected = [f"{result.state_hash:016x}" for result in alone]
    for workers in (1, 2, 3):
        with ThreadPoolExecutor(workers) as pool:
            study = ensemble(few_scenes(), metrics=METRICS, executor=pool)
        assert list(study.state_hash) == expected
    assert study["dynamic_crush"].tolist() == [result.metrics["dynamic_crush"] for result in alone]
    with ProcessPoolExecutor(2) as pool:
        assert list(ensemble(few_scenes(), metrics=METRICS, executor=pool).state_hash) == expected
    backwards = ensemble(reversed(few_scenes()), metrics=METRICS)
    assert list(backwards.state_hash) == expected[::-1]


def of_all_kinds() -> list[Simulation]:
    car = Vehicle.preset("passenger_car", mesh_density=0.1)
    loose = Barrier.jersey(length=18.0, segments=6, free_standing=True)
    return [
        *few_scenes(),
        Simulation(car, Barrier.rigid_wall(width=10.0), 12.0, 0.0, impact_yaw=90.0),
        Simulation(car, Barrier.rigid_wall(), 12.0, 40.0, standoff=1.0),
        Simulation(car, loose, 20.0, 25.0, duration=0.2),
        Simulation(Vehicle.preset("pickup", mesh_density=0.1), None, 15.0, impact_roll=170.0, duration=1.0),
        Simulation(
            Vehicle.preset("semi_truck", mesh_density=0.1), Barrier.rigid_wall(), 15.0, 15.0, duration=0.3
        ),
        scenes.w2(100, Settings(gravity=0.0, ground=False, time_step=1e-3)),
    ]


@pytest.mark.filterwarnings("ignore::birm3d.TippingWarning")
def test_metrics_without_histories_are_those_of_the_result() -> None:
    study = ensemble(of_all_kinds(), metrics=ALL)
    assert not study.failed
    for i, simulation in enumerate(of_all_kinds()):
        result = simulation.run()
        assert study.state_hash[i] == f"{result.state_hash:016x}"
        assert study.end_reason[i] == result.end_reason
        for name in ALL:
            found, expected = float(study[name][i]), result.metrics.get(name, np.nan)
            assert found == expected or (np.isnan(found) and np.isnan(expected)), (i, name)


@pytest.mark.filterwarnings("ignore::birm3d.TippingWarning")
def test_extremes_are_those_of_the_rows() -> None:
    """What the core finds is what NumPy finds in the rows; sums of three products round in either order."""
    for simulation in of_all_kinds():
        result, scene = simulation.run(), simulation.scene
        metrics, start = result.metrics, result.velocity[0]
        # The change of velocity and the yaw count until separation, which falls between two rows.
        until = result.time <= metrics.get("time_of_separation", np.inf)
        change = np.linalg.norm(result.velocity[until] - start, axis=1)
        if scene.barrier is not None:
            assert change.max() <= metrics["delta_v"] * (1.0 + 1e-14) <= change.max() * (1.0 + 1e-3)
        assert metrics["peak_deceleration"] == -result.acceleration[:, 0].min()
        for name in ("roll", "pitch", "yaw"):
            values = getattr(result, name)
            greatest = np.abs(values[until] if name == "yaw" else values).max()
            assert metrics[f"max_{name}"] == pytest.approx(greatest, rel=1e-14)
        scale = max(float(result.energy["kinetic"][0]), 0.005 * scene.vehicle.mass)
        residual = np.abs(result.energy["residual"]).max() / scale
        assert metrics["energy_residual"] == pytest.approx(residual, rel=1e-14)
        assert metrics["end_time"] == result.time[-1]
        if scene.barrier is None:
            continue
        assert metrics["peak_normal_force"] == result.barrier_normal_force.max()
        towards = -np.asarray(scene.barrier.core.normal)
        if abs(np.sin(np.radians(scene.impact_angle))) < 1e-9:
            towards = start / np.linalg.norm(start)
        way = ((result.position - result.position[0]) @ towards).max() - scene.standoff
        assert metrics["max_displacement"] == pytest.approx(way, abs=1e-13)
        if "time_of_zero_velocity" in metrics:
            begun = scene.standoff / (start @ towards)
            speeds = np.interp(
                metrics["time_of_zero_velocity"] + begun, result.time, result.velocity @ towards
            )
            assert speeds == pytest.approx(0.0, abs=1e-9)


def furthest_anchor(result: Result) -> float:
    """Of all anchors in all rows, past the barrier's line, at least 0 [m]."""
    barrier, greatest = result.scene.barrier, 0.0
    past, origin = -np.asarray(barrier.core.normal), np.asarray(barrier.origin)
    for u, unit in enumerate(result.scene.vehicle.units):
        centers, turns = result.pose(result.time, u)
        anchors = unit.anchors[(unit.wheel_of_node < 0) & (unit.along_of_node < 0)]
        reach = (np.einsum("kji,j->ki", turns, past) @ anchors.T).max(axis=1)
        greatest = max(greatest, ((centers - origin) @ past + reach).max())
    return greatest


def highest_wheel(result: Result) -> float:
    """Of the lowest points of all wheels in all rows, at least 0 [m]."""
    greatest = 0.0
    for u, unit in enumerate(result.scene.vehicle.units):
        centers, turns = result.pose(result.time, u)
        zones = list(unit.zones.values())
        for (*place, radius), zone in zip(unit.wheels, unit.zone_of_wheel, strict=True):
            extended = (zones[zone].static_deflection or 0.0) if zone >= 0 else 0.0
            place[2] -= extended
            lowest = centers[:, 2] + turns[:, 2] @ place - radius * np.sqrt(1.0 - turns[:, 2, 1] ** 2)
            greatest = max(greatest, lowest.max())
    return greatest


def from_histories(result: Result) -> dict[str, float]:
    """What the core finds without histories, made of them with NumPy and SciPy."""
    scene, interval = result.scene, result.scene.settings.output_interval
    found = {"peak_deceleration_cfc60": cfc(-result.acceleration[:, 0], 60, interval).max()}
    if scene.settings.ground and len(scene.vehicle.wheels):
        found["wheel_climb"] = highest_wheel(result)
    if scene.vehicle.joint is not None:
        found["max_articulation_angle"] = np.abs(result.articulation_angle).max()
        mean = np.column_stack([moving_average(one, 0.05, interval) for one in result.joint_force.T])
        found["peak_joint_force_50ms"] = np.linalg.norm(mean, axis=1).max()
    if scene.barrier is None:
        return found
    force = result.barrier_normal_force
    found["peak_normal_force_cfc60"] = cfc(force, 60, interval).max()
    found["peak_force_50ms"] = moving_average(force, 0.05, interval).max()
    for number in ("force", "force_50ms"):
        found[f"peak_element_{number}"] = max(getattr(of, f"peak_{number}") for of in result.element_loads)
    for number in ("overturning_moment", "overturning_moment_50ms"):
        found[f"peak_{number}"] = max(getattr(of, f"peak_{number}") for of in result.element_loads)
    if abs(np.sin(np.radians(scene.impact_angle))) > 1e-9:
        found["vehicle_penetration"] = furthest_anchor(result)
    if scene.barrier.core.segments:
        movement = lateral_movement(result)
        found["barrier_deflection"], found["residual_barrier_deflection"] = movement.max(), movement[-1]
        found["max_overturning_ratio"] = result.overturning_ratio.max()
    return found


def flat_anchors() -> Simulation:
    """All anchors on a line, along the wall."""
    side = np.linspace(-0.9, 0.9, 40)
    nodes, anchors = np.zeros((2, 40, 3))
    nodes[:, 0], nodes[:, 1], anchors[:, 1] = 1.0, side, side
    block = Vehicle.from_arrays(
        mass=1500.0,
        inertia=np.diag([400.0, 900.0, 900.0]),
        nodes=nodes,
        anchors=anchors,
        k_initial=4e4,
        k_unloading=4e5,
    )
    return Simulation(block, Barrier.rigid_wall(), 20.0, 70.0, settings=WEIGHTLESS)


@pytest.mark.filterwarnings("ignore::birm3d.TippingWarning")
def test_what_needs_no_histories_is_what_they_hold() -> None:
    beside = Barrier.bollards(count=2, spacing=3.5)
    slim = Vehicle.preset("passenger_car", mesh_density=0.1)
    through = Simulation(slim, beside, 15.0, duration=0.6)  # far past the line
    often = Settings(output_interval=2e-3)  # too seldom for the filter
    seldom = Simulation(slim, Barrier.rigid_wall(), 15.0, settings=often)
    for simulation in (*of_all_kinds(), through, flat_anchors(), seldom):
        result = simulation.run()
        if simulation is seldom:
            assert "peak_normal_force_cfc60" not in result.metrics
            assert "peak_deceleration_cfc60" not in result.metrics
            continue
        expected = from_histories(result)
        assert expected.keys() <= result.metrics.keys()
        for name, value in expected.items():
            assert result.metrics[name] == pytest.approx(value, rel=1e-11, abs=1e-9), name
    assert through.run().metrics["vehicle_penetration"] > 1.0


def test_a_sweep_of_approaches_is_an_ensemble_of_scenes() -> None:
    base = Simulation(Vehicle.preset("passenger_car", mesh_density=0.1), Barrier.rigid_wall(), 10.0)
    given = {"impact_speed": [8.0, 12.0, 16.0], "impact_angle": [90.0, 60.0, 30.0], "standoff": [0.0, 0.5, 0]}
    swept = sweep(base, mode="list", metrics=ALL, **given)
    scene = base.scene
    made = ensemble(
        [
            Simulation(scene.vehicle, scene.barrier, v, angle, standoff=standoff)
            for v, angle, standoff in zip(*given.values(), strict=True)
        ],
        metrics=ALL,
    )
    with_histories = sweep(base, mode="list", metrics=[*ALL, "momentum_residual"], **given)
    assert not swept.failed
    for other in (made, with_histories):
        assert other.state_hash == swept.state_hash
        for name in ALL:
            assert np.array_equal(other[name], swept[name], equal_nan=True), name


def test_a_bad_run_stops_no_other() -> None:
    good = scenes.w2(10)

    def bad() -> Simulation:
        return Simulation(elastic_block(10), Barrier.rigid_wall(), -1.0)

    study = ensemble([good, bad, good], metrics=METRICS)
    assert [bool(error) for error in study.error] == [False, True, False]
    assert study.error[1].startswith("ValueError: impact_speed must be")
    assert np.isnan(study["dynamic_crush"]).tolist() == [False, True, False]
    assert study.state_hash[0] == study.state_hash[2]


def test_whatever_goes_wrong_is_told_as_the_run_alone_tells_it() -> None:
    fixed = Settings(gravity=0.0, ground=False, time_step=0.2)
    for bad in ({"impact_speed": -1.0}, {"impact_angle": 190.0}, {"standoff": -0.1}, {"settings": fixed}):
        ((name, value),) = bad.items()
        base = scenes.w2(10)
        good = getattr(base.scene, name)
        # With histories and without.
        for metrics in (METRICS, [*METRICS, "momentum_residual"]):
            study = sweep(base, parameters={name: [good, value, good]}, metrics=metrics)
            assert [bool(error) for error in study.error] == [False, True, False]
            scene = {"impact_speed": 22.352, "settings": WEIGHTLESS, **bad}
            with pytest.raises(ValueError, match="must be") as alone:
                Simulation(base.scene.vehicle, base.scene.barrier, **scene).run()
            assert study.error[1] == f"{type(alone.value).__name__}: {alone.value}"
            assert study.state_hash[0] == study.state_hash[2] != ""


def test_a_fixed_step_that_is_too_long_is_warned_of() -> None:
    coarse = scenes.w2(4, Settings(time_step=5e-3, gravity=0.0, ground=False))
    with pytest.warns(BalanceWarning, match=r"energy_residual must be at most 0\.005"):
        ensemble([coarse], metrics=METRICS)


def runs_have_begun() -> bool:
    frame = sys._current_frames().get(threading.main_thread().ident or 0)
    while frame is not None and frame.f_code.co_name != "run_all":
        frame = frame.f_back
    return frame is not None


def interrupted(after: float, study_of: Simulation, speeds: list[float]) -> tuple[int, float]:
    """Press Ctrl-C a while after the start; return how many runs are finished and what the rest took [s]."""
    pressed: list[float] = []

    def press() -> None:
        while not runs_have_begun():  # a busy machine takes long to check that many speeds
            time.sleep(0.01)
        time.sleep(after)
        pressed.append(time.monotonic())
        signal.pthread_kill(threading.main_thread().ident, signal.SIGINT)

    timer = threading.Thread(target=press, daemon=True)
    timer.start()
    with pytest.raises(StudyInterrupted) as stopped:
        sweep(study_of, impact_speed=speeds, metrics=METRICS)
    timer.join()
    study = stopped.value.study
    assert not study.failed
    assert len(study.state_hash) == len(study)
    return len(study), time.monotonic() - pressed[0]


def test_ctrl_c_keeps_the_finished_runs() -> None:
    speeds = np.linspace(18.0, 26.0, 200_000).tolist()
    finished, took = interrupted(1.5, scenes.w2(10), speeds)
    assert 0 < finished < len(speeds)
    assert took < 5.0


def test_ctrl_c_ends_a_run_that_takes_long() -> None:
    endless = Settings(gravity=0.0, ground=False, time_step=1e-5)  # half a minute
    vehicle, wall = elastic_block(1000), Barrier.rigid_wall()
    slow = Simulation(vehicle, wall, 20.0, duration=10.0, settings=endless)
    finished, took = interrupted(0.5, slow, [20.0, 21.0, 22.0])
    assert finished == 0
    assert took < 5.0


def test_a_scene_is_run_from_its_start_and_not_changed() -> None:
    begun = scenes.w2(10)
    for _ in range(10):
        begun.step()
    time = begun.time
    study = ensemble([begun], metrics=METRICS)
    assert begun.time == time > 0.0
    assert study.state_hash == ensemble([scenes.w2(10)], metrics=METRICS).state_hash


def test_memory_does_not_grow_with_the_number_of_runs() -> None:
    def many(count: int) -> Iterator[Simulation]:
        block = elastic_block(1)
        wall = Barrier.rigid_wall()
        for i in range(count):
            yield Simulation(block, wall, 5.0 + i % 7, duration=0.01)

    def peak(count: int) -> int:
        gc.collect()
        tracemalloc.start()
        ensemble(many(count), metrics=["exit_speed"])
        most = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        return most

    peak(100)
    # Scenes under way, and for each run a row of one number and three texts: some 400 bytes.
    assert peak(6000) - peak(2000) < 4000 * 1000


RESIDENT = """
import re
from pathlib import Path
from birm3d import scenes, sweep

def runs(count):
    sweep(scenes.w2(200), impact_speed=[18.0 + 8.0 * i / count for i in range(count)], metrics=["exit_speed"])
    return re.search(r"VmHWM:\\s+(\\d+) kB", Path("/proc/self/status").read_text())[1]

runs(200)
print(runs(1000), runs(5000))
"""


def test_the_core_keeps_nothing_of_a_run() -> None:
    if not Path("/proc/self/status").exists():
        pytest.skip("this system does not say how much memory a process had at most")
    done = subprocess.run([sys.executable, "-c", RESIDENT], capture_output=True, text=True, check=True)
    few, many = (int(text) * 1024 for text in done.stdout.split())
    # A history of one run is 400 kB, its state 50 kB; a row of the study and what it is made of some kB.
    assert many - few < 4000 * 2000


def test_bad_input() -> None:
    with pytest.raises(ValueError, match="simulations must have at least one scene, got none"):
        ensemble([])
    with pytest.raises(ValueError, match="metrics must be among"):
        ensemble([scenes.w2(1)], metrics=["crush"])
