"""What must not change an answer: repetition, place, direction, mirror, order, mesh, interruption."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np
import pytest
from birm3d import Barrier, Result, Settings, Simulation, Vehicle, scenes, units

FREE = {"gravity": 0.0, "ground": False}
# Metrics that count or time the computation, or that are rounding themselves.
NOT_PHYSICS = {"run_time", "steps", "momentum_residual", "energy_residual"}


def car(density: float = 1.0) -> Vehicle:
    return Vehicle.preset("passenger_car", gvw=units.lb(4500), mesh_density=density)


def block() -> Vehicle:
    return scenes.laboratory_block(
        100, k_initial=3e6, knee=0.4, k_hardening=6e6, k_unloading=60e6, stagger=0.05
    )


Point = tuple[float, float, float]


def box_mesh(depth: float, width: float, height: float) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and faces of a block whose front is at x = 0."""
    corners = np.array(
        [(x, y, z) for x in (0.0, depth) for y in (-width / 2, width / 2) for z in (0.0, height)]
    )
    quads = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (1, 5, 7, 3), (0, 2, 6, 4))
    return corners, np.array([(q[0], q[i], q[i + 1]) for q in quads for i in (1, 2)])


def assert_same_metrics(a: Mapping[str, float], b: Mapping[str, float], tolerance: float) -> None:
    assert set(a) == set(b)
    for name in set(a) - NOT_PHYSICS:
        # Angles that symmetry keeps at zero are rounding: they are judged against a degree.
        floor = 1.0 if name.startswith("max_") and name != "max_displacement" else 0.0
        assert b[name] == pytest.approx(a[name], rel=tolerance, abs=tolerance * floor), name


ORDINARY: Mapping[str, Callable[[], Simulation]] = {
    "w2": lambda: scenes.w2(100),
    "head-on": lambda: Simulation(car(0.5), Barrier.rigid_wall(), 15.0),
    "oblique": lambda: Simulation(car(0.5), Barrier.rigid_wall(), 26.7, 24.0),
    "staggered": lambda: Simulation(block(), Barrier.rigid_wall(), 22.0, 65.0, settings=Settings(**FREE)),
    "rolling": lambda: scenes.rolling(0.5),
}
SCENE = pytest.mark.parametrize("scene", ORDINARY.values(), ids=ORDINARY.keys())


def histories(result: Result) -> list[np.ndarray]:
    arrays = [result.time, result.position, result.velocity, result.acceleration, result.angular_velocity]
    arrays += [result.roll, result.pitch, result.yaw, result.barrier_force, result.barrier_normal_force]
    arrays += [result.tire_reaction, result.tire_friction_force, result.nodes, result.deflection]
    return arrays + list(result.energy.values())


def assert_same_bits(a: Result, b: Result) -> None:
    assert a.state_hash == b.state_hash
    assert all(np.array_equal(x, y) for x, y in zip(histories(a), histories(b), strict=True))


@SCENE
def test_the_same_scene_twice(scene: Callable[[], Simulation]) -> None:
    first, second = scene(), scene()
    a, b = first.run(), second.run()
    assert_same_bits(a, b)
    assert first.state_hash() == a.state_hash
    assert_same_bits(first.run(), a)  # a run that is over starts anew


@SCENE
def test_the_hash_sees_a_difference(scene: Callable[[], Simulation]) -> None:
    simulation = scene()
    seen = {simulation.state_hash()}
    for _ in range(5):
        simulation.step()
        seen.add(simulation.state_hash())
    assert len(seen) == 6


@SCENE
def test_step_by_step(scene: Callable[[], Simulation]) -> None:
    whole, stepped = scene(), scene()
    expected = whole.run()
    steps = 0
    while stepped.step():
        steps += 1
    assert not stepped.step()
    assert steps == expected.statistics.steps
    assert_same_bits(stepped.result(), expected)


@SCENE
@pytest.mark.parametrize("share", [0.0, 0.3, 0.6, 0.95])
def test_restart_in_the_middle(scene: Callable[[], Simulation], share: float) -> None:
    simulation = scene()
    expected = simulation.run()
    simulation.reset()
    for _ in range(int(share * expected.statistics.steps)):
        simulation.step()
    checkpoint = simulation.snapshot()
    at = simulation.state_hash(), simulation.time
    assert checkpoint.time == simulation.time
    simulation.run()
    simulation.restore(checkpoint)
    assert (simulation.state_hash(), simulation.time) == at
    assert_same_bits(simulation.run(), expected)
    # A checkpoint survives its use, and serves another simulation of the same scene.
    other = scene()
    other.restore(checkpoint)
    assert_same_bits(other.run(), expected)


@SCENE
def test_reset(scene: Callable[[], Simulation]) -> None:
    simulation = scene()
    start = simulation.state_hash()
    simulation.run()
    simulation.reset()
    assert simulation.state_hash() == start
    assert simulation.time == 0.0


@pytest.mark.parametrize("interval", [1e-3, 1e-4, 1.3e-5])
def test_the_output_interval_changes_nothing_but_rows(interval: float) -> None:
    usual = Simulation(car(0.5), Barrier.rigid_wall(), 15.0).run()
    other = Simulation(
        car(0.5), Barrier.rigid_wall(), 15.0, settings=Settings(output_interval=interval)
    ).run()
    assert other.state_hash == usual.state_hash
    assert np.diff(other.time) == pytest.approx(interval, rel=1e-9)
    assert other.time[-1] == pytest.approx(usual.time[-1], abs=interval + 1e-4)


# ---- place and direction -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("make", "angle", "choice", "tolerance"),
    [
        (block, 90.0, Settings(**FREE), 1e-9),
        (block, 65.0, Settings(**FREE), 1e-9),
        (car, 90.0, Settings(), 1e-9),
        (car, 65.0, Settings(**FREE), 1e-9),
        (car, 24.0, Settings(**FREE), 1e-9),
        (car, 24.0, Settings(), 1e-9),
    ],
)
@pytest.mark.parametrize(
    ("heading", "origin"), [(0.0, (300.0, -80.0, 0.0)), (37.0, (0.0, 0.0, 0.0)), (-170.0, (12.0, 5.0, 0.0))]
)
def test_the_world_has_no_place_and_no_direction(
    make: Callable[[], Vehicle],
    angle: float,
    choice: Settings,
    tolerance: float,
    heading: float,
    origin: tuple[float, float, float],
) -> None:
    # Up to the instant at which the outcome of an ordinary crash is decided.
    here = Simulation(make(), Barrier.rigid_wall(), 20.0, angle, duration=0.15, settings=choice).run()
    wall = Barrier.rigid_wall(heading=heading, origin=origin)
    there = Simulation(make(), wall, 20.0, angle, wall.station(), duration=0.15, settings=choice).run()
    assert_same_metrics(here.metrics, there.metrics, tolerance)
    h = math.radians(heading)
    turn = np.array([[math.cos(h), -math.sin(h), 0.0], [math.sin(h), math.cos(h), 0.0], [0.0, 0.0, 1.0]])
    for name, shift in (("velocity", 0.0), ("position", np.array(origin)), ("barrier_force", 0.0)):
        expected = getattr(here, name) @ turn.T + shift
        worst = np.abs(getattr(there, name) - expected).max()
        assert worst <= tolerance * max(1.0, np.abs(expected).max()), name
    for name in ("roll", "pitch", "yaw"):
        # A turned world costs an angle of 180 deg its rounding.
        assert np.abs(getattr(there, name) - getattr(here, name)).max() < 60.0 * tolerance, name


def test_offset_along_the_barrier_changes_nothing() -> None:
    a = Simulation(block(), Barrier.rigid_wall(), 20.0, 65.0, settings=Settings(**FREE)).run()
    b = Simulation(block(), Barrier.rigid_wall(), 20.0, 65.0, 7.5, settings=Settings(**FREE)).run()
    assert_same_metrics(a.metrics, b.metrics, 1e-8)
    assert np.abs(b.position - a.position - [0.0, 7.5, 0.0]).max() < 1e-8


@pytest.mark.parametrize("heading", [0.0, 65.0])
def test_the_vehicle_keeps_its_path_when_a_pole_is_moved_along_its_line(heading: float) -> None:
    """A pole 0.6 m to the left is met as a path 0.6 m to the right of a pole that stands at the origin."""
    h = math.radians(heading)
    line, across = np.array([-math.sin(h), math.cos(h), 0.0]), np.array([math.cos(h), math.sin(h), 0.0])
    short = {"duration": 0.06, "settings": Settings(**FREE)}

    def at(pole: Barrier, offset: float = 0.0) -> Result:
        return Simulation(car(), pole, 12.0, 80.0, offset, **short).run()

    moved = at(Barrier.pole(heading=heading, origin=tuple(0.6 * line)))
    aimed = at(Barrier.pole(heading=heading), -0.6)
    assert_same_metrics(moved.metrics, aimed.metrics, 1e-7)
    assert np.abs(moved.position - aimed.position - 0.6 * line).max() < 1e-7
    middle = at(Barrier.pole(heading=heading))
    assert abs(aimed.yaw[-1] - middle.yaw[-1]) > 0.1  # it is no hit in the middle
    behind = at(Barrier.pole(heading=heading, origin=tuple(0.6 * line + 3.0 * across)))
    assert np.abs(behind.position - moved.position - 3.0 * across).max() < 1e-7


def test_a_site_plan_is_aimed_at_by_stations() -> None:
    """Vehicle and barrier moved together, by a point of the plan: the same crash."""
    here = Barrier.bollards(count=3, spacing=1.3, heading=20.0)
    there = Barrier.bollards(count=3, spacing=1.3, heading=20.0, origin=(40.0, -7.0, 0.0))
    aim = there.place(0.0, 0.4)  # 0.4 m beside the middle bollard
    assert there.station() + 0.4 == pytest.approx(there.station(aim), abs=1e-12)
    assert here.station((40.0, -7.0)) == there.station()
    short = {"duration": 0.05, "settings": Settings(**FREE)}
    a = Simulation(car(), here, 12.0, 75.0, 0.4, **short).run()
    b = Simulation(car(), there, 12.0, 75.0, there.station(aim), **short).run()
    assert_same_metrics(a.metrics, b.metrics, 1e-7)
    assert np.abs(b.position - a.position - [40.0, -7.0, 0.0]).max() < 1e-7
    for wrong in ((1.0,), (math.nan, 0.0)):
        with pytest.raises(ValueError, match="point must be two or three finite numbers"):
            there.station(wrong)


FAR: Mapping[str, tuple[str, Callable[[Point], Barrier], float, float]] = {
    "car at a wall": ("passenger_car", lambda at: Barrier.rigid_wall(origin=at), 25.0, 0.3),
    "truck at bollards": ("cargo_truck", lambda at: Barrier.bollards(origin=at, heading=30.0), 65.0, 0.3),
    "semi at Jersey": (
        "semi_truck",
        lambda at: Barrier.jersey(length=12.0, segments=4, origin=at, heading=30.0),
        40.0,
        0.3,
    ),
    "semi at segments": (
        "semi_truck",
        lambda at: Barrier.jersey(length=12.0, segments=4, free_standing=True, origin=at),
        90.0,
        0.0,
    ),
    "pickup at a mesh": (
        "pickup",
        lambda at: Barrier.from_mesh(*box_mesh(0.6, 4.0, 1.0), origin=at),
        80.0,
        0.3,
    ),
}


@pytest.mark.parametrize(("vehicle", "barrier", "angle", "beside"), FAR.values(), ids=FAR.keys())
@pytest.mark.filterwarnings("ignore::birm3d.TippingWarning")
def test_a_scene_far_away_has_the_same_bits(
    vehicle: str, barrier: Callable[[Point], Barrier], angle: float, beside: float
) -> None:
    """Places far from zero are rounded more, and a crash of many contacts makes that grow."""
    truck = Vehicle.preset(vehicle, mesh_density=0.3)

    def crash(at: Point) -> Result:
        stands = barrier(at)
        there = Simulation(truck, stands, 20.0, angle, stands.station() + beside, duration=0.3)
        assert np.subtract(there._core.pose()[0], at) == pytest.approx(here_at, abs=1e-9)
        return there.run()

    stands = barrier((0.0, 0.0, 0.0))
    here_at = Simulation(truck, stands, 20.0, angle, beside, duration=0.3)._core.pose()[0]
    here = crash((0.0, 0.0, 0.0))
    for at in ((1000.0, 0.0, 0.0), (0.0, -1000.0, 0.0), (1000.1, 999.7, 0.0), (1e5, -1e5, 0.0)):
        there = crash(at)
        assert there.state_hash == here.state_hash
        assert np.abs(there.position - at - here.position).max() < 1e-10
        moved = there.segment_position - np.array(at[:2]) - here.segment_position
        assert np.abs(moved).max(initial=0.0) < 1e-10
        assert_same_metrics(here.metrics, there.metrics, 1e-9)
        for a, b in zip(here.element_loads, there.element_loads, strict=True):
            assert np.array_equal(a.force, b.force)
            assert np.array_equal(a.moment, b.moment)


def test_an_endless_barrier_is_the_same_everywhere_along_its_line() -> None:
    """Its foot, about which moments are counted, stays at the origin."""
    truck = Vehicle.preset("semi_truck", mesh_density=0.3)
    short = {"duration": 0.2}
    here = Simulation(truck, Barrier.jersey(), 20.0, 65.0, 0.0, **short).run()
    there = Simulation(truck, Barrier.jersey(), 20.0, 65.0, -1000.0, **short).run()
    assert there.state_hash == here.state_hash
    assert np.abs(there.position - here.position - [0.0, -1000.0, 0.0]).max() < 1e-10
    (a,), (b,) = here.element_loads, there.element_loads
    assert np.array_equal(a.force, b.force)
    arm = np.cross([0.0, -1000.0, 0.0], a.force)
    assert np.abs(arm).max() > 1e6
    assert np.abs(b.moment - a.moment - arm).max() < 1e-12 * np.abs(arm).max()


def test_standoff_only_delays() -> None:
    near = Simulation(block(), Barrier.rigid_wall(), 20.0, settings=Settings(**FREE)).run()
    far = Simulation(block(), Barrier.rigid_wall(), 20.0, standoff=3.0, settings=Settings(**FREE)).run()
    gap = -(far.position[0] + [3.0, 0.0, 0.0])[0]
    assert gap == pytest.approx(3.0, abs=1e-9)
    for name in (
        "peak_normal_force",
        "dynamic_crush",
        "exit_speed",
        "max_displacement",
        "time_of_zero_velocity",
    ):
        # Other steps, hence the default tolerance.
        assert far.metrics[name] == pytest.approx(near.metrics[name], rel=1e-3), name
    assert far.metrics["end_time"] - near.metrics["end_time"] == pytest.approx(3.0 / 20.0, rel=1e-2)


# ---- mirror ------------------------------------------------------------------------------------------------


def symmetric_block() -> Vehicle:
    base = block()
    y = base.nodes[:, 1]
    # The same stagger left and right, one by one.
    depth = 0.05 * np.abs(y) / 1.2 + 0.01 * (base.nodes[:, 2] > 0.0)
    nodes = base.nodes.copy()
    nodes[:, 0] = 3.0 - depth
    return Vehicle.from_arrays(
        mass=base.mass,
        inertia=base.inertia,
        nodes=nodes,
        anchors=nodes - [2.0, 0.0, 0.0],
        k_initial=3e4,
        knee=0.4,
        k_hardening=6e4,
        k_unloading=6e5,
    )


@pytest.mark.parametrize(
    ("make", "angle", "choice", "duration", "tolerance"),
    [
        (symmetric_block, 65.0, Settings(**FREE), 0.15, 1e-9),
        (symmetric_block, 25.0, Settings(**FREE), 0.06, 1e-9),
        (car, 65.0, Settings(**FREE), 0.15, 1e-9),
        (car, 24.0, Settings(**FREE), 0.3, 1e-9),
        (car, 24.0, Settings(), 0.3, 1e-8),
    ],
)
def test_mirror(
    make: Callable[[], Vehicle], angle: float, choice: Settings, duration: float, tolerance: float
) -> None:
    wall = Barrier.rigid_wall()
    left = Simulation(make(), wall, 20.0, angle, duration=duration, settings=choice).run()
    right = Simulation(make(), wall, 20.0, 180.0 - angle, duration=duration, settings=choice).run()
    assert_same_metrics(left.metrics, right.metrics, tolerance)
    mirror = [1.0, -1.0, 1.0]
    for name in ("position", "velocity", "acceleration", "barrier_force"):
        expected = getattr(left, name) * mirror
        worst = np.abs(getattr(right, name) - expected).max()
        assert worst <= tolerance * max(1.0, np.abs(expected).max()), name
    for name, sign in (("roll", -1.0), ("pitch", 1.0), ("yaw", -1.0)):
        worst = np.abs(getattr(right, name) - sign * getattr(left, name)).max()
        assert worst <= 60.0 * tolerance, name  # deg


def test_head_on_stays_straight() -> None:
    metrics = Simulation(car(), Barrier.rigid_wall(), 20.0).run().metrics
    assert metrics["max_roll"] < 1e-9
    assert metrics["max_yaw"] < 1e-9


# ---- order and mesh ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.parametrize("angle", [90.0, 65.0])
def test_the_order_of_nodes_does_not_matter(seed: int, angle: float) -> None:
    base = block()
    rng = np.random.default_rng(seed)
    order = rng.permutation(base.n_nodes)
    k = rng.uniform(0.5, 1.5, base.n_nodes) * 3e4
    given = {"mass": base.mass, "inertia": base.inertia, "knee": 0.4}

    def run(which: np.ndarray) -> Result:
        vehicle = Vehicle.from_arrays(
            **given,
            nodes=base.nodes[which],
            anchors=base.anchors[which],
            k_initial=k[which],
            k_hardening=2.0 * k[which],
            k_unloading=20.0 * k[which],
        )
        wall = Barrier.rigid_wall()
        return Simulation(vehicle, wall, 20.0, angle, duration=0.15, settings=Settings(**FREE)).run()

    straight, mixed = run(np.arange(base.n_nodes)), run(order)
    assert_same_metrics(straight.metrics, mixed.metrics, 1e-9)
    # What belongs to a node comes back in the caller's order.
    assert mixed.deflection == pytest.approx(straight.deflection[order], abs=1e-9)
    assert mixed.peak_deflection == pytest.approx(straight.peak_deflection[order], abs=1e-9)
    assert mixed.nodes == pytest.approx(straight.nodes[order], abs=1e-9)


def test_finer_meshes_converge() -> None:
    """Stiffness per unit of area: a finer mesh is the same vehicle."""

    def run(density: float) -> Mapping[str, float]:
        vehicle = Vehicle.preset("passenger_car", mesh_density=density)
        return (
            Simulation(vehicle, Barrier.rigid_wall(), 15.0, settings=Settings(tolerance=1e-5)).run().metrics
        )

    metrics = [run(density) for density in (0.5, 1.0, 2.0, 4.0)]
    for name in ("peak_normal_force_cfc60", "dynamic_crush", "max_displacement"):
        values = np.array([m[name] for m in metrics])
        differences = np.abs(np.diff(values)) / values[-1]
        # Meshes are laid out anew at each density, so convergence is not smooth; each doubling beyond the
        # default changes less than the one before it, and less than 1 %.
        assert differences[-1] < differences[0], f"{name}: {values}"
        assert differences[-1] < 0.01, f"{name}: {values}"
