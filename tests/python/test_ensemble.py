"""Many scenes from one call: same bits in any order and on any executor, one bad run stops no other."""

from __future__ import annotations

import gc
import tracemalloc
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

import numpy as np
import pytest
from birm3d import Barrier, Simulation, Vehicle, ensemble, scenes
from birm3d.laboratory import elastic_block

METRICS = ["dynamic_crush", "exit_speed"]


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


def test_a_bad_run_stops_no_other() -> None:
    good = scenes.w2(10)

    def bad() -> Simulation:
        return Simulation(elastic_block(10), Barrier.rigid_wall(), -1.0)

    study = ensemble([good, bad, good], metrics=METRICS)
    assert [bool(error) for error in study.error] == [False, True, False]
    assert study.error[1].startswith("ValueError: impact_speed must be")
    assert np.isnan(study["dynamic_crush"]).tolist() == [False, True, False]
    assert study.state_hash[0] == study.state_hash[2]


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


def test_bad_input() -> None:
    with pytest.raises(ValueError, match="simulations must have at least one scene, got none"):
        ensemble([])
    with pytest.raises(ValueError, match="metrics must be among"):
        ensemble([scenes.w2(1)], metrics=["crush"])
