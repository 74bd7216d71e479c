"""One simulation, several users; runs that fail; copies and pickles of a run under way."""

import copy
import os
import pickle
import signal
import threading
import time
from collections.abc import Callable
from typing import Any

import birm3d
import numpy as np
import pytest
from birm3d import Barrier, BusyError, Settings, Simulation, UnstableError, Vehicle, scenes


@pytest.fixture(scope="module")
def slow() -> Simulation:
    """A run of about a second: a car that slides along a rough wall with strict errors."""
    car = Vehicle.preset("passenger_car")
    wall = Barrier.rigid_wall(friction=0.3)
    return Simulation(car, wall, 15.0, 40.0, duration=3.0, settings=Settings(tolerance=1e-6))


ENTRIES: dict[str, Callable[[Simulation], Any]] = {
    "run": lambda s: s.run(),
    "step": lambda s: s.step(),
    "result": lambda s: s.result(),
    "reset": lambda s: s.reset(),
    "snapshot": lambda s: s.snapshot(),
    "state_hash": lambda s: s.state_hash(),
    "time": lambda s: s.time,
    "copy": copy.copy,
    "pickle": pickle.dumps,
}
CORE_ENTRIES = (
    "step", "run", "reset", "snapshot", "history", "nodes", "deflection", "peak_deflection", "truss_force",
    "velocity", "pose", "skin_load",
)  # fmt: skip
CORE_PROPERTIES = (
    "state_hash", "time", "end_reason", "event", "balances", "failed", "replays", "touched",
    "deepest_node", "deepest_anchor", "statistics",
)  # fmt: skip


def test_a_second_user_is_told_and_the_first_one_gets_the_same_bits(slow: Simulation) -> None:
    alone = copy.copy(slow).run()
    kept = slow.snapshot()
    found: list[birm3d.Result] = []
    thread = threading.Thread(target=lambda: found.append(slow.run()))
    thread.start()
    refused, messages = set(), set()
    while thread.is_alive():
        for name, entry in ENTRIES.items():
            if name in refused:
                continue
            try:
                entry(slow)
            except BusyError as error:
                refused.add(name)
                messages.add(str(error))
            else:  # the run has not begun, or is over
                time.sleep(1e-3)
                if name in ("run", "step", "reset"):
                    assert not thread.is_alive() or slow.time == 0.0
        if refused == set(ENTRIES):
            with pytest.raises(BusyError):
                slow.restore(kept)
            break
    thread.join()
    assert refused == set(ENTRIES)
    assert len(messages) == 1
    assert "another thread" in messages.pop()
    assert issubclass(BusyError, RuntimeError)
    assert found[0].state_hash == alone.state_hash
    assert np.array_equal(found[0].position, alone.position)
    assert slow.run().state_hash == alone.state_hash  # nothing stays taken


def core_entry(core: Any, name: str) -> None:
    member = getattr(core, name)  # of a property: the call
    if name not in CORE_PROPERTIES:
        member()


def test_every_entry_of_the_core_is_guarded(slow: Simulation) -> None:
    """The interpreter's lock is free during a run, so that each unguarded entry would read torn memory."""
    core = slow._scene.start()
    members = {name for name in dir(core) if not name.startswith("_")} - {"restore"}
    assert members == {*CORE_ENTRIES, *CORE_PROPERTIES}
    kept = core.snapshot()
    thread = threading.Thread(target=core.run)
    thread.start()
    time.sleep(0.02)
    for name in members:
        with pytest.raises(BusyError):
            core_entry(core, name)
    with pytest.raises(BusyError):
        core.restore(kept)
    assert thread.is_alive(), "the run was over too soon to tell"
    thread.join()
    assert core.end_reason.name == "duration"


def test_many_threads_hammer_one_simulation() -> None:
    simulation = scenes.w2(40)
    expected = simulation.run().state_hash
    wrong: list[BaseException] = []
    until = time.monotonic() + 0.5

    def hammer(number: int) -> None:
        random = np.random.default_rng(number)
        entries = list(ENTRIES.values())
        while time.monotonic() < until:
            try:
                entries[random.integers(len(entries))](simulation)
            except BusyError:
                pass
            except BaseException as error:
                wrong.append(error)

    threads = [threading.Thread(target=hammer, args=(i,)) for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert wrong == []
    simulation.reset()
    assert simulation.run().state_hash == expected


def test_a_study_may_use_a_simulation_that_runs(slow: Simulation) -> None:
    expected = slow.run().state_hash
    thread = threading.Thread(target=slow.run)
    thread.start()
    study = birm3d.sweep(slow, impact_speed=[2.0, 3.0], metrics=["peak_normal_force"], progress=False)
    thread.join()
    assert not study.failed
    assert slow.state_hash() == expected


@pytest.mark.skipif(os.name != "posix", reason="signals to oneself")
def test_an_interrupted_run_goes_on_and_a_handler_can_not_break_it(slow: Simulation) -> None:
    expected = slow.run().state_hash
    told: list[BaseException] = []

    def handler(number: int, frame: object) -> None:
        try:
            slow.reset()
        except BusyError as error:
            told.append(error)
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, handler)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.05)
        with pytest.raises(KeyboardInterrupt):
            slow.run()
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
    assert len(told) == 1
    assert 0.0 < slow.time < 3.0
    result = slow.run()
    assert result.state_hash == expected
    assert result.time[-1] == pytest.approx(3.0)


def test_a_run_that_failed_can_be_run_again() -> None:
    simulation = scenes.w2(4, Settings(time_step=0.02, gravity=0.0, ground=False))
    with pytest.raises(UnstableError) as first:
        simulation.run()
    at = simulation.state_hash()
    assert np.isfinite(simulation.result().energy["total"]).all()
    with pytest.raises(UnstableError) as second:
        simulation.run()
    assert str(first.value) == str(second.value)
    assert simulation.state_hash() == at
    simulation.reset()
    assert simulation.time == 0.0
    with pytest.raises(UnstableError):
        simulation.run()


def test_copies_and_pickles_of_a_run_under_way_keep_its_state() -> None:
    simulation = scenes.oblique(24.0, friction=0.2)
    for _ in range(60):
        simulation.step()
    for twin in (pickle.loads(pickle.dumps(simulation)), copy.copy(simulation), copy.deepcopy(simulation)):
        assert twin.scene == simulation.scene
        assert twin.time == simulation.time > 0.0
        assert twin.state_hash() == simulation.state_hash()
        assert np.array_equal(twin.result().position, simulation.result().position)
        twin.step()  # and is another one
        assert twin.time > simulation.time
    over = pickle.loads(pickle.dumps(twin))
    assert over.run().state_hash == simulation.run().state_hash
    assert pickle.loads(pickle.dumps(over)).result().end_reason == over.result().end_reason


def test_a_pickle_of_another_version_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    simulation = scenes.w2(4)
    simulation.step()
    function, (scene, steps, state_hash, _) = simulation.__reduce__()
    assert callable(function)
    with pytest.raises(ValueError, match=r"version that pickled it \(birm3d 9\.9\)"):
        function(scene, steps, state_hash ^ 1, "9.9")


def test_a_snapshot_is_not_pickled_in_silence() -> None:
    with pytest.raises(TypeError, match=r"pickle the Simulation, which keeps its state"):
        pickle.dumps(scenes.w2(4).snapshot())


CHANGES: dict[str, dict[str, Any]] = {
    "approach": {"impact_speed": 11.0},
    "angle": {"impact_angle": 80.0},
    "settings": {"settings": Settings(tolerance=1e-4)},
    "gravity": {"settings": Settings(gravity=1.0)},
}


@pytest.mark.parametrize("what", CHANGES)
def test_a_snapshot_of_another_approach_or_of_other_settings_is_refused(what: str) -> None:
    car, wall = Vehicle.preset("passenger_car"), Barrier.rigid_wall()
    given: dict[str, Any] = {"impact_speed": 10.0, "impact_angle": 70.0}
    simulation, other = Simulation(car, wall, **given), Simulation(car, wall, **{**given, **CHANGES[what]})
    other.step()
    before = simulation.state_hash()
    with pytest.raises(ValueError, match=r"snapshot must be of a simulation with the same (speed|settings)"):
        simulation.restore(other.snapshot())
    assert simulation.state_hash() == before


def test_a_snapshot_goes_into_a_longer_run_and_not_into_one_that_is_over() -> None:
    car, wall = Vehicle.preset("passenger_car"), Barrier.rigid_wall()
    short, long = (Simulation(car, wall, 10.0, duration=d) for d in (0.03, 0.06))
    short.run()
    long.restore(short.snapshot())
    assert long.time == pytest.approx(0.03)
    with pytest.raises(ValueError, match=r"must have come to its state by steps of its own"):
        pickle.dumps(long)
    assert long.run().time[-1] == pytest.approx(0.06)
    with pytest.raises(ValueError, match=r"snapshot must be within the duration of 0\.03 s, got 0\.06 s"):
        short.restore(long.snapshot())
    long.reset()
    assert pickle.loads(pickle.dumps(long)).scene == long.scene
