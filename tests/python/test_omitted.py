"""The report says what a run left out, how much of it, and why; counts are the core's."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import birm3d
import numpy as np
import pytest
from birm3d import Barrier, FreeStanding, Result, Settings, Simulation, Vehicle, _core, scenes
from birm3d.units import Quantity

WEIGHTLESS = Settings(gravity=0.0, ground=False)
COUNTS = [name for name, value in vars(_core.StepStatistics).items() if isinstance(value, property)]


def car(name: str = "passenger_car") -> Vehicle:
    return Vehicle.preset(name, mesh_density=0.1)


def plates(wheels: bool = False) -> Vehicle:
    """Return a body with 64 nodes in front and 64 far behind: two blocks of the core."""
    y, z = np.meshgrid(np.linspace(-0.7, 0.7, 8), np.linspace(-0.7, 0.7, 8))
    inward = np.array([1.5, 0.0, 0.0])
    front, rear = (np.column_stack([np.full(64, x), y.ravel(), z.ravel()]) for x in (20.0, -20.0))
    return Vehicle.from_arrays(
        mass=1000.0,
        inertia=np.diag([500.0, 2e5, 2e5]),
        nodes=np.concatenate([front, rear]),
        anchors=np.concatenate([front - inward, rear + inward]),
        k_initial=2e4,
        k_unloading=2e5,
        mass_center_height=1.0,
        wheels=[(x, y, -0.7, 0.3) for x in (18.0, -18.0) for y in (0.6, -0.6)] if wheels else (),
    )


def run(vehicle: Vehicle, barrier: Barrier | None, speed: Quantity = 10.0, **more: Any) -> Result:
    return Simulation(vehicle, barrier, speed, **more).run()


def omitted(result: Result) -> str:
    return result.report().split("\nleft out\n")[1]


# ---- counts ------------------------------------------------------------------------------------------------


def test_nodes_that_nothing_came_near() -> None:
    """Of two plates only the one in front meets the wall."""
    result = run(plates(), Barrier.rigid_wall(), settings=WEIGHTLESS)
    assert result.statistics.skin_nodes == 64
    text = omitted(result)
    assert "64 of 128 nodes of the skin (never met by the barrier)" in text
    pressed = int((result.peak_deflection > 0.0).sum())
    assert f"the crush of {128 - pressed} of 128 trusses (never pressed)" in text
    tests = 128 * (result.statistics.steps + result.statistics.rejected)
    share = 1.0 - result.statistics.node_evaluations / tests
    assert 0.5 <= share < 1.0
    assert f"{share:.1%} of {tests:,} node tests" in text


def test_no_line_where_no_node_was_left_out() -> None:
    result = scenes.w2(64).run()
    assert result.statistics.skin_nodes == 64
    assert "nodes of the skin" not in omitted(result)
    assert "trusses" not in omitted(result)


def test_nodes_that_are_pressed_are_among_those_looked_at() -> None:
    """And the blocks that the core looked at are whole: at most 63 more for each node that moved."""
    result = run(car(), Barrier.jersey(), 20.0, impact_angle=25.0)
    skin = result.scene.vehicle.wheel_of_node < 0
    for of, looked_at in ((skin, result.statistics.skin_nodes), (~skin, result.statistics.tread_nodes)):
        pressed = int((result.peak_deflection[of] > 0.0).sum())
        assert 0 < pressed <= looked_at <= int(of.sum())
        if looked_at < int(of.sum()):
            assert f"{int(of.sum()) - looked_at} of {int(of.sum())} nodes of" in omitted(result)


@pytest.mark.parametrize("count", [3, 41])
def test_elements_that_nothing_came_near(count: int) -> None:
    """Posts 5 m apart: the one in the middle is all that a car between its neighbours can reach."""
    result = run(car(), Barrier.bollards(count=count, spacing=5.0), duration=0.1)
    assert result.statistics.near_elements == 1
    text = omitted(result)
    assert f"{count - 1} of {count} elements (never within reach of the vehicle)" in text
    assert f"histories of {count - 1} of {count} elements (never touched)" in text
    alone = omitted(run(car(), Barrier.bollards(count=1), duration=0.1))
    assert "elements (never" not in alone
    assert "its motion (fixed: 1 element)" in alone


def test_steps_before_the_barrier_is_reached() -> None:
    """1 m at 10 m/s without gravity: 0.1 s before, exactly, but for the step that meets the wall."""
    far = run(plates(), Barrier.rigid_wall(), standoff=1.0, duration=0.09, settings=WEIGHTLESS)
    steps = far.statistics.steps
    assert far.statistics.free_steps == steps
    assert far.statistics.free_time == pytest.approx(0.09, rel=1e-12)
    assert f"all its forces in all {steps} steps, 0.09 s (no node within reach" in omitted(far)
    assert "all 128 nodes of the skin" in omitted(far)
    met = run(plates(), Barrier.rigid_wall(), standoff=1.0, duration=0.12, settings=WEIGHTLESS)
    assert 0 < met.statistics.free_steps < met.statistics.steps
    assert 0.095 < met.statistics.free_time <= 0.1 + 5e-3  # the longest step
    at_once = run(plates(), Barrier.rigid_wall(), duration=0.02, settings=WEIGHTLESS)
    assert at_once.statistics.free_steps == 0
    assert "all its forces" not in omitted(at_once)


def test_steps_without_contact_of_the_rigid_body() -> None:
    """A truss of 1.5 m is closed by a crash that it can not stop."""
    soft = run(plates(), Barrier.rigid_wall(), 5.0, settings=WEIGHTLESS)
    steps = soft.statistics.steps
    assert soft.statistics.body_steps == 0
    assert f"their own contact in all {steps:,} steps (no truss was bottomed out)" in omitted(soft)
    hard = run(plates(), Barrier.rigid_wall(), "60 m/s", settings=WEIGHTLESS)
    steps, held = hard.statistics.steps, hard.statistics.body_steps
    assert 0 < held < steps
    assert f"their own contact in {steps - held:,} of {steps:,} steps" in omitted(hard)


def test_wheels_in_the_air() -> None:
    rolls = run(plates(wheels=True), None, duration=0.05)
    assert rolls.statistics.wheels_on_ground == 4 * rolls.statistics.steps
    assert "in the air" not in omitted(rolls)
    floats = run(plates(wheels=True), None, duration=0.05, settings=Settings(gravity=0.0))
    assert floats.statistics.wheels_on_ground == 0
    steps = floats.statistics.steps
    assert f"forces of tyres in all {4 * steps:,} wheel steps (in the air)" in omitted(floats)
    # Half of them: a car that is rolled so far that it falls back on its wheels.
    tips = run(car(), None, 0.0, impact_roll=30.0, duration=0.1)
    steps, loaded = tips.statistics.steps, tips.statistics.wheels_on_ground
    assert 0 < loaded < 4 * steps
    assert f"forces of tyres in {4 * steps - loaded:,} of {4 * steps:,} wheel steps" in omitted(tips)


def test_counts_are_part_of_a_checkpoint() -> None:
    simulation = Simulation(car(), Barrier.bollards(spacing=5.0), 15.0, standoff=0.3, duration=0.15)
    whole = simulation.run()
    simulation.reset()
    while simulation.time < 0.05:
        simulation.step()
    kept = simulation.snapshot()
    simulation.run()
    simulation.restore(kept)
    again = simulation.run()
    assert len(COUNTS) == 22
    for name in COUNTS:
        assert getattr(again.statistics, name) == getattr(whole.statistics, name), name
    assert again.report() == whole.report()


def test_a_loaded_result_says_the_same(tmp_path: Path) -> None:
    result = run(car(), Barrier.bollards(spacing=5.0), duration=0.05)
    result.save(tmp_path / "run.npz")
    loaded = birm3d.load(tmp_path / "run.npz")
    assert [getattr(loaded.statistics, name) for name in COUNTS] == [
        getattr(result.statistics, name) for name in COUNTS
    ]
    del loaded.__dict__["_report"]  # so that it is made anew
    assert loaded.report() == result.report()


# ---- reasons -----------------------------------------------------------------------------------------------

SMOOTH = Settings(mu_tire_barrier=0.0)
LOOSE = FreeStanding(joint="loose", ground_friction=0.0)


@pytest.mark.parametrize(
    ("line", "without", "with_it"),
    [
        ("there is no barrier", (car(), None), (car(), Barrier.pole())),
        (
            "\n    friction (its coefficient is 0)",
            (car(), Barrier.pole(friction=0.0)),
            (car(), Barrier.pole()),
        ),
        (
            "friction of tyres at the barrier (its coefficient is 0)",
            (car(), Barrier.pole(), SMOOTH),
            (car(), Barrier.pole()),
        ),
        (
            "tyres at the barrier (the vehicle has none that meet it)",
            (car().without_tire_contact(), Barrier.pole()),
            (car(), Barrier.pole()),
        ),
        (
            "indentation beside posts (indentation_length is 0)",
            (car().with_indentation_length(0.0), Barrier.bollards(diameter=0.6)),
            (car(), Barrier.bollards(diameter=0.6)),
        ),
        (
            "indentation beside posts (the barrier has no",
            (car(), Barrier.rigid_wall()),
            (car(), Barrier.pole()),
        ),
        (
            "growth of forces with the rate of crush (rate_sensitivity is 0)",
            (car(), Barrier.pole()),
            (car().with_rate_sensitivity(0.05), Barrier.pole()),
        ),
        (
            "its motion (fixed: 3 elements)",
            (car(), Barrier.jersey(length=9.0, segments=3)),
            (car(), Barrier.jersey(length=9.0, segments=3, free_standing=True)),
        ),
        (
            "each other (loose ends), and their tipping",
            (car(), Barrier.jersey(length=9.0, segments=3, free_standing=LOOSE)),
            (car(), Barrier.jersey(length=9.0, segments=3, free_standing=True)),
        ),
        (
            "friction of the segments on the ground (ground_friction is 0)",
            (car(), Barrier.jersey(length=9.0, segments=3, free_standing=LOOSE)),
            (car(), Barrier.jersey(length=9.0, segments=3, free_standing=True)),
        ),
        ("gravity (it is 0)", (car(), None, Settings(gravity=0.0)), (car(), None)),
        ("the ground: ground=False", (car(), None, Settings(ground=False)), (car(), None)),
        ("the ground: the vehicle has no wheels", (plates(), None), (plates(wheels=True), None)),
        (
            "friction of tyres on the ground (mu_tire is 0)",
            (car(), None, Settings(mu_tire=0.0)),
            (car(), None),
        ),
        ("brakes (braking is 0", (car(), None), (car(), None, Settings(braking=0.5))),
        (
            "friction of the body on the ground (mu_body is 0)",
            (car(), None, Settings(mu_body=0.0)),
            (car(), None),
        ),
        ("joints (the vehicle is one unit)", (car(), None), (car("semi_truck"), None)),
        ("contact of the two units with each other", (car("semi_truck"), None), (car(), None)),
    ],
)
def test_what_the_scene_does_not_need(line: str, without: tuple[Any, ...], with_it: tuple[Any, ...]) -> None:
    def told(vehicle: Vehicle, barrier: Barrier | None, settings: Settings | None = None) -> str:
        return "\n" + omitted(run(vehicle, barrier, duration=0.01, settings=settings))

    assert told(*without).count(line) == 1
    assert line not in told(*with_it)


def test_skin_below_the_ground_does_not_meet_it() -> None:
    low = plates(wheels=True)
    nodes = low.nodes.copy()
    nodes[:, 2] -= 0.4
    sunk = Vehicle.from_arrays(
        mass=low.mass,
        inertia=low.inertia,
        nodes=nodes,
        anchors=low.anchors,
        k_initial=2e4,
        k_unloading=2e5,
        mass_center_height=1.0,
        wheels=low.wheels.tolist(),
    )
    assert "ground under the skin of all 1 units" in omitted(run(sunk, None, duration=0.01))
    assert "ground under the skin" not in omitted(run(low, None, duration=0.01))


def test_what_was_not_asked_for() -> None:
    simulation = Simulation(car(), Barrier.pole(), 10.0, duration=0.05)
    assert "places of the skin over time (no frames were asked for)" in omitted(simulation.run())
    assert "no frames" not in omitted(simulation.run(frames=3))
    result = simulation.run()
    (line,) = (line for line in omitted(result).splitlines() if "metrics (the run" in line)
    count, names = line.split(" metrics (the run does not have them): ")
    absent = names.split(", ")
    assert "barrier_deflection" in absent
    assert not set(absent) & set(result.metrics)
    assert count.split() == [str(len(absent)), "of", str(len(absent) + len(result.metrics))]


@pytest.mark.parametrize(
    ("duration", "reason"), [(None, "a tail in which filters settle"), (0.05, "asked for")]
)
def test_how_the_run_ended(duration: float | None, reason: str) -> None:
    result = run(car(), Barrier.rigid_wall(), duration=duration)
    (line,) = (line for line in omitted(result).splitlines() if "all that comes after" in line)
    assert f"after {result.time[-1]:.4f} s" in line
    assert reason in line
    if duration is None:  # the wall pushed until then
        assert math.isclose(_core.tail_duration, 0.02)
        last = result.time[np.flatnonzero(result.barrier_normal_force)[-1]]
        # The load of the last step, of a tenth of a ms, goes straight to its end; it is over where its
        # course is zero.
        assert last <= result.time[-1] - 0.02 + 2e-4
