"""Every argument that can not be computed with is refused by name, limit and value; nothing returns NaN."""

from __future__ import annotations

import dataclasses
import math
import re
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from birm3d import BalanceWarning, Barrier, Result, Settings, Simulation, UnstableError, Vehicle, Zone, scenes

NAN, INF = math.nan, math.inf


@contextmanager
def refused(name: str, got: float | str, limit: str = "") -> Iterator[None]:
    """A ValueError must name the argument and its limit, and end with the value received."""
    with pytest.raises(ValueError, match=r"(?s).+") as caught:
        yield
    message = str(caught.value)
    said = re.fullmatch(r"(?s)(?P<name>.*) must (?:be )?(?P<limit>.+)[,;] got (?P<value>.+)", message)
    assert said, message
    assert name in said["name"], message
    assert limit in said["limit"], message
    if isinstance(got, str):
        assert got in said["value"], message
    else:
        assert float(said["value"].split()[0]) == pytest.approx(got, nan_ok=True), message


@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("time_step", (0.0, -1e-4, NAN, INF)),
        ("tolerance", (0.0, 1e-10, 1.1, -1.0, NAN, INF)),
        ("output_interval", (0.0, -1e-4, NAN, INF)),
        ("gravity", (-9.8, NAN, INF)),
        ("mu_tire", (-0.1, NAN, INF)),
        ("cornering_stiffness", (0.0, -1.0, NAN, INF)),
        ("restitution", (-0.1, 1.1, NAN, INF)),
        ("contact_model", ("along", "", None)),
        ("tire_model", ("fiala", "", None)),
    ],
)
def test_settings(name: str, values: tuple[Any, ...]) -> None:
    for value in values:
        with refused(name, value if isinstance(value, float) else repr(value)):
            Settings(**{name: value})


def test_settings_know_no_other_name() -> None:
    with pytest.raises(TypeError, match="restituton"):
        Settings(restituton=0.1)  # type: ignore[call-arg]


@pytest.mark.parametrize(
    ("name", "value", "got"),
    [
        ("friction", -0.1, -0.1),
        ("friction", NAN, NAN),
        ("friction", INF, INF),
        ("heading", NAN, NAN),
        ("heading", INF, INF),
        ("origin", (0.0, NAN, 0.0), "a coordinate that is not"),
        ("origin", (INF, 0.0, 0.0), "a coordinate that is not"),
        ("width", 0.0, 0.0),
        ("width", NAN, NAN),
        ("height", -0.8, -0.8),
    ],
)
def test_rigid_wall(name: str, value: Any, got: float | str) -> None:
    with refused(name, got):
        Barrier.rigid_wall(**{name: value})


@pytest.mark.parametrize("origin", [(0.0, 0.0), (0.0, 0.0, 0.0, 0.0), ()])
def test_origin_has_three_coordinates(origin: tuple[float, ...]) -> None:
    with pytest.raises(ValueError, match="origin"):
        Barrier.rigid_wall(origin=origin)


@pytest.fixture
def scene() -> Callable[..., Simulation]:
    def make(**changes: Any) -> Simulation:
        given = {"vehicle": scenes.elastic_block(4), "barrier": Barrier.rigid_wall(), "impact_speed": 10.0}
        return Simulation(**{**given, **changes})

    return make


@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("impact_speed", (-1.0, NAN, INF)),
        ("impact_angle", (0.0, 180.0, -10.0, 270.0, NAN, INF)),  # the wall of the scene has no end
        ("impact_yaw", (NAN, INF)),
        ("impact_roll", (NAN, INF)),
        ("impact_offset", (NAN, INF)),
        ("standoff", (-1e-3, -1.0, NAN, INF)),
        ("duration", (0.0, -1.0, NAN, INF)),
    ],
)
def test_simulation(scene: Callable[..., Simulation], name: str, values: tuple[float, ...]) -> None:
    for value in values:
        with refused(name, value):
            scene(**{name: value})


def test_a_start_inside_the_wall_is_refused(scene: Callable[..., Simulation]) -> None:
    with refused("standoff", -0.5, "inside the barrier"):
        scene(standoff=-0.5)


def test_a_run_without_end_is_refused(scene: Callable[..., Simulation]) -> None:
    with refused("duration", "none", "no barrier"):
        scene(barrier=None)
    with refused("duration", "none", "stands still"):
        scene(impact_speed=0.0)


def arrays(**changes: Any) -> Vehicle:
    given: dict[str, Any] = {
        "mass": 1000.0,
        "inertia": np.diag([400.0, 1500.0, 1600.0]),
        "nodes": [[2.0, 0.5, 0.0], [2.0, -0.5, 0.0]],
        "anchors": [[1.0, 0.5, 0.0], [1.0, -0.5, 0.0]],
        "k_initial": 1e6,
        "k_unloading": 1e7,
    }
    return Vehicle.from_arrays(**{**given, **changes})


@pytest.mark.parametrize(
    ("changes", "name", "got"),
    [
        ({"mass": 0.0}, "mass", 0.0),
        ({"mass": -1.0}, "mass", -1.0),
        ({"mass": NAN}, "mass", NAN),
        ({"mass": INF}, "mass", INF),
        ({"inertia": np.diag([400.0, NAN, 1600.0])}, "inertia", "not"),
        ({"inertia": np.diag([400.0, -1.0, 1600.0])}, "moment of inertia", -1.0),
        ({"inertia": np.diag([400.0, 0.0, 1600.0])}, "moment of inertia", 0.0),
        ({"inertia": np.diag([100.0, 200.0, 1600.0])}, "moment of inertia", 1600.0),
        ({"inertia": [[400.0, 10.0, 0.0], [0.0, 1500.0, 0.0], [0.0, 0.0, 1600.0]]}, "inertia", "10 kg m"),
        ({"inertia": np.eye(2)}, "inertia shape", "(2, 2)"),
        ({"inertia": [400.0, 1500.0, 1600.0]}, "inertia shape", "(3)"),
        ({"nodes": [[2.0, NAN, 0.0], [2.0, -0.5, 0.0]]}, "nodes[0]", "not"),
        ({"nodes": [[2.0, 0.5], [2.0, -0.5]]}, "nodes shape", "(2, 2)"),
        ({"nodes": [2.0, 0.5, 0.0]}, "nodes shape", "(3)"),
        ({"nodes": np.empty((0, 3)), "anchors": np.empty((0, 3))}, "nodes", 0.0),
        ({"anchors": [[1.0, 0.5, INF], [1.0, -0.5, 0.0]]}, "anchors[0]", "not"),
        ({"anchors": [[1.0, 0.5, 0.0]]}, "anchors", 1.0),
        ({"anchors": [[1.0, 0.5, 0.0], [2.0, -0.5, 0.0]]}, "truss length[1]", 0.0),
        ({"k_initial": -1.0}, "k_initial", -1.0),
        ({"k_initial": NAN}, "k_initial", NAN),
        ({"k_initial": INF}, "k_initial", INF),
        ({"k_initial": [1e6, 1e6, 1e6]}, "k_initial", "(3,)"),
        ({"k_unloading": 1e5}, "k_unloading", 1e5),
        ({"k_unloading": [1e7, 1e5]}, "k_unloading", 1e5),
        ({"k_unloading": 0.0}, "k_unloading", 0.0),
        ({"k_unloading": NAN}, "k_unloading", NAN),
        ({"k_unloading": INF}, "k_unloading", INF),
        ({"knee": 0.0}, "knee", 0.0),
        ({"knee": -0.1}, "knee", -0.1),
        ({"knee": NAN}, "knee", NAN),
        ({"knee": 0.1, "k_hardening": -1.0}, "k_hardening", -1.0),
        ({"knee": 0.1, "k_hardening": NAN}, "k_hardening", NAN),
        ({"knee": 0.1, "k_hardening": 2e7}, "k_unloading", 1e7),
        ({"f_max": 0.0}, "f_max", 0.0),
        ({"f_max": -1.0}, "f_max", -1.0),
        ({"f_max": NAN}, "f_max", NAN),
        ({"mass_center_height": NAN}, "mass_center_height", NAN),
        ({"wheels": [[1.0, 0.5, 0.0, 0.0]], "mass_center_height": 1.0}, "wheels[0] radius", 0.0),
        ({"wheels": [[1.0, 0.5, 0.0, -0.3]], "mass_center_height": 1.0}, "wheels[0] radius", -0.3),
        ({"wheels": [[1.0, NAN, 0.0, 0.3]], "mass_center_height": 1.0}, "wheels[0] center", "not"),
        ({"wheels": [[1.0, 0.5, -0.4, 0.3]], "mass_center_height": 0.5}, "above the ground", -0.2),
        ({"wheels": [[1.0, 0.5, 0.0]]}, "wheels shape", "(1, 3)"),
    ],
)
def test_vehicle_from_arrays(changes: dict[str, Any], name: str, got: float | str) -> None:
    with refused(name, got):
        arrays(**changes)


@pytest.mark.parametrize("value", [0.0, -5.0, NAN, INF])
def test_gvw_and_mesh_density(value: float) -> None:
    car = Vehicle.preset("passenger_car", mesh_density=0.1)
    with refused("gvw", value):
        car.with_gvw(value)
    with refused("gvw", value):
        arrays().with_gvw(value)
    with refused("gvw", value):
        Vehicle.preset("passenger_car", gvw=value)
    with refused("density", value):
        Vehicle.preset("passenger_car", mesh_density=value)


def test_unknown_names() -> None:
    car = Vehicle.preset("passenger_car", mesh_density=0.1)
    with refused("", "'tank'", "passenger_car"):
        Vehicle.preset("tank")
    with refused("zone", "'bonnet'", "bumper"):
        car.with_zone("bonnet", knee=0.1)
    with refused("zone parameter", "'stiffness'", "k_unloading"):
        car.with_zone("bumper", stiffness=1e6)
    with refused("zone", "'bumper'", "none"):
        arrays().with_zone("bumper", knee=0.1)
    with pytest.raises(TypeError, match="colour"):
        arrays(colour="red")


KNEE = {"k_initial": 1e6, "knee": 0.3, "k_hardening": 3e5, "f_max": 6e5, "k_unloading": 1e7}
POINTS = {"envelope": ((0.0, 0.0), (0.1, 1e5), (0.3, 6e4)), "k_unloading": 1e7}


@pytest.mark.parametrize(
    ("given", "name", "got"),
    [
        ({**KNEE, "k_unloading": 1e5}, "k_unloading", 1e5),
        ({**KNEE, "k_unloading": NAN}, "k_unloading", NAN),
        ({**KNEE, "k_initial": -1.0}, "k_initial", -1.0),
        ({**KNEE, "k_initial": None}, "k_initial", "None"),
        ({**KNEE, "knee": NAN}, "knee", NAN),
        ({**KNEE, "k_hardening": None}, "k_hardening", "None"),
        ({**KNEE, "f_max": 0.0}, "f_max", 0.0),
        ({**POINTS, "k_unloading": 1e5}, "k_unloading", 1e5),
        ({**POINTS, "envelope": ((0.1, 0.0), (0.2, 1e5))}, "envelope", "(0.1, 0)"),
        ({**POINTS, "envelope": ((0.0, 0.0), (0.1, -1.0))}, "envelope", -1.0),
        ({**POINTS, "envelope": ((0.0, 0.0), (0.1, 1e5), (0.1, 2e5))}, "envelope", 0.1),
        ({**POINTS, "envelope": ((0.0, 0.0), (NAN, 1e5))}, "envelope", NAN),
        ({**POINTS, "envelope": ((0.0, 0.0),)}, "envelope", 1.0),
        ({**POINTS, "envelope": ((0.0, 0.0, 1.0), (0.1, 1e5, 1.0))}, "envelope", "(2, 3)"),
    ],
)
def test_zone_numbers(given: dict[str, Any], name: str, got: float | str) -> None:
    with refused(name, got):
        Zone(**given)


def test_a_zone_is_either_a_knee_or_an_envelope() -> None:
    with pytest.raises(ValueError, match="envelope"):
        Zone(**{**KNEE, **POINTS})


@pytest.mark.parametrize("zone", [KNEE, POINTS], ids=["knee", "points"])
def test_with_zone_does_what_it_is_told_or_refuses(zone: dict[str, Any]) -> None:
    """The contract's call: all five numbers of the knee, whatever the zone had before."""
    car = Vehicle.preset("passenger_car", mesh_density=0.1)
    car = dataclasses.replace(car, zones={**car.zones, "bumper": Zone(**zone)})
    changed = car.with_zone("bumper", **{**KNEE, "k_initial": 2e6})
    assert dict(changed.zones["bumper"]) == {**KNEE, "k_initial": 2e6}
    assert changed.zones["bumper"].curve.envelope(0.1) == pytest.approx(2e5)


def test_unknown_key_in_a_vehicle_file(tmp_path: Path) -> None:
    from birm3d.vehicle.vehicle_file import preset_path

    file = tmp_path / "car.toml"
    text = Path(preset_path("passenger_car")).read_text(encoding="utf-8")
    file.write_text(text.replace("gvw_kg", "colour = 'red'\ngvw_kg", 1), encoding="utf-8")
    with pytest.raises(ValueError, match=r"car\.toml.*(?s:.*)colour"):
        Vehicle.from_file(file)


def test_missing_vehicle_file(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"nowhere\.toml.*can not be read"):
        Vehicle.from_file(tmp_path / "nowhere.toml")


def test_a_checkpoint_of_another_scene_is_refused() -> None:
    small, large, other = scenes.w2(4), scenes.w2(400), scenes.w1(400)
    for simulation, checkpoint in ((small, large), (large, small), (large, other)):
        with pytest.raises(ValueError, match=r"snapshot"):
            simulation.restore(checkpoint.snapshot())


# ---- fixed steps -------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "make",
    [
        lambda settings: scenes.w1(100, settings),
        lambda settings: scenes.w2(100, settings),
        lambda settings: scenes.nhtsa_10146(settings, mesh_density=0.5),
        lambda settings: scenes.oblique(24.0, settings=settings),
    ],
    ids=["w1", "w2", "nhtsa_10146", "oblique"],
)
@pytest.mark.filterwarnings("ignore::birm3d.BalanceWarning")
def test_a_step_that_is_too_long_is_refused_and_a_good_one_named(
    make: Callable[[Settings], Simulation],
) -> None:
    def simulation(step: float) -> Simulation:
        return make(Settings(time_step=step, gravity=0.0, ground=False))

    with pytest.raises(
        UnstableError, match=r"time_step must be below .*got 0\.2 s.*a step of .* would do"
    ) as caught:
        simulation(0.2).run()
    assert issubclass(UnstableError, ValueError)
    found = re.search(r"a step of ([-+0-9.e]+) s would do", str(caught.value))
    assert found
    advised = float(found[1])
    assert 1e-6 < advised < 0.2
    result = simulation(advised).run()
    assert result.end_reason == "separated"
    assert result.statistics.longest_step <= advised
    # Stable, not accurate.
    assert result.metrics["energy_residual"] < 0.15


@pytest.mark.parametrize(
    "barrier", [Barrier.bollards(), Barrier.pole(), Barrier.rigid_wall(width=3.0, height=1.0)]
)
def test_a_step_that_could_jump_over_a_barrier_is_refused(barrier: Barrier) -> None:
    car = Vehicle.preset("passenger_car", mesh_density=0.1)
    simulation = Simulation(car, barrier, 15.0, settings=Settings(time_step=0.7))
    with pytest.raises(UnstableError, match=r"time_step must be below .* a quarter through an element"):
        simulation.run()


def test_a_step_that_is_stable_and_too_long_is_warned_of() -> None:
    settings = Settings(time_step=5e-3, gravity=0.0, ground=False)
    with pytest.warns(
        BalanceWarning, match=r"energy_residual must be at most 0\.005, got .*time_step = 0\.005"
    ):
        coarse = scenes.w2(4, settings).run()
    assert coarse.metrics["energy_residual"] > 5e-3


def test_the_refusal_leaves_the_state_as_it_was() -> None:
    simulation = scenes.w2(4, Settings(time_step=0.02, gravity=0.0, ground=False))
    state = []

    def run() -> None:
        state.append((simulation.state_hash(), simulation.time))
        while simulation.step():
            state.append((simulation.state_hash(), simulation.time))

    with pytest.raises(UnstableError):
        run()
    assert (simulation.state_hash(), simulation.time) == state[-1]


@pytest.mark.filterwarnings("ignore::birm3d.BalanceWarning")
def test_the_limit_is_the_root_of_three_over_omega() -> None:
    """A mass on one spring: the scheme is stable below sqrt(3) sqrt(m/k)."""
    k, mass = 1e6, 1000.0
    vehicle = arrays(nodes=[[2.0, 0.0, 0.0]], anchors=[[0.5, 0.0, 0.0]], k_initial=k, k_unloading=k)
    limit = math.sqrt(3.0) * math.sqrt(mass / k)

    def run(step: float) -> Result:
        settings = Settings(time_step=step, gravity=0.0, ground=False)
        # Slow, so that the node hardly moves: the core's bound grows with the block's size.
        return Simulation(
            vehicle, Barrier.rigid_wall(friction=0.0), 0.1, duration=0.3, settings=settings
        ).run()

    assert run(0.95 * limit).time[-1] == pytest.approx(0.3, abs=1e-4)
    with pytest.raises(UnstableError, match="critical step"):
        run(1.05 * limit)


# ---- nothing returns NaN -----------------------------------------------------------------------------------


def test_every_number_of_every_scene_is_finite(scene_result: Result) -> None:
    r = scene_result
    arrays = [r.time, r.position, r.velocity, r.acceleration, r.angular_velocity, r.roll, r.pitch, r.yaw]
    arrays += [r.barrier_force, r.barrier_normal_force, r.tire_reaction, r.tire_friction_force]
    arrays += [r.nodes, r.deflection, r.peak_deflection, *r.energy.values()]
    assert all(np.isfinite(array).all() for array in arrays)
    assert all(math.isfinite(value) for value in r.metrics.values())


def test_fixed_steps_that_can_not_be_held() -> None:
    block, wall = scenes.elastic_block(4), Barrier.rigid_wall()
    with pytest.raises(
        ValueError, match=r"time_step must be at least .* for the 100 s .* got 1e-06"
    ) as caught:
        Simulation(block, wall, 10.0, duration=100.0, settings=Settings(time_step=1e-6))
    advised = float(str(caught.value).split("at least ")[1].split()[0])
    Simulation(block, wall, 10.0, duration=100.0, settings=Settings(time_step=advised))


@pytest.mark.parametrize("duration", [0.2, None])
def test_a_run_that_takes_long_shows_a_bar(
    duration: float | None, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("birm3d.base.progress._FIRST", 1e-3)
    settings = Settings(time_step=1e-5)
    block = scenes.elastic_block(400)
    simulation = Simulation(block, Barrier.rigid_wall(), 1.0, duration=duration, settings=settings)
    quiet = simulation.run().state_hash
    assert capsys.readouterr().err == ""
    assert simulation.run(progress=True).state_hash == quiet
    bar = capsys.readouterr().err.split("\r")[1]
    of = r"\d%\|.*\| [\d.e-]+ of 0.2 s" if duration else r"[\d.e-]+ s"
    assert re.fullmatch(rf"run: {of} \[00:00.*, [\d,]+ steps, Ctrl-C stops\]", bar)


def test_a_record_is_bounded() -> None:
    block, wall = scenes.elastic_block(4), Barrier.rigid_wall()
    with pytest.raises(ValueError, match=r"output_interval must be >= .* 2e\+06 = 0\.05 s, got 1e-04"):
        Simulation(block, wall, 10.0, duration="100000 s")
    long = Settings(output_interval=1e6)
    with pytest.raises(
        ValueError, match=r"duration must be at most [\d.]+ s, where the \d+ steps end .* got 1e\+09"
    ):
        Simulation(block, wall, 10.0, duration="1e9 s", settings=long).run()


def test_output_interval_beyond_the_run() -> None:
    result = Simulation(scenes.elastic_block(4), Barrier.rigid_wall(), 10.0, duration=1e-5).run()
    with pytest.raises(ValueError, match=r"output_interval .*0\.0001"):
        _ = result.metrics


@pytest.mark.parametrize("duration", [1e-4, 3.3e-4, 1e-3])
def test_short_runs_have_no_nan(duration: float) -> None:
    result = Simulation(scenes.elastic_block(4), Barrier.rigid_wall(), 10.0, duration=duration).run()
    assert all(math.isfinite(value) for value in result.metrics.values())
    assert np.isfinite(result.acceleration).all()
    assert result.report()


def test_types_that_are_not_loaded_yet_are_checked() -> None:
    """The first call of a process knows a type of the package that nothing has loaded so far."""
    program = (
        "from birm3d import Barrier\n"
        "try:\n    Barrier.jersey(free_standing=[1.0, 2.0])\n"
        "except ValueError as error:\n    print(error)\n"
    )
    told = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout
    assert told.startswith("free_standing must be True or False or a birm3d.FreeStanding, got")
