"""What stands behind the trusses: how often it is met, its force as a metric, and the warning."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import cast

import birm3d
import pytest
from birm3d import Barrier, CoreContactWarning, Settings, Simulation, Vehicle, sweep, units
from birm3d._core import StepStatistics
from birm3d.result.core_contact import core_complaints, core_doubts
from birm3d.study.verification.triangulated import triangulated
from birm3d.vehicle.test_bodies import laboratory_block
from conftest import STRIKE_THE_CORE

G = units.g(1.0)


def block(k_initial: float) -> Vehicle:
    """6.8 t behind 2 m of trusses that give way at a constant force of 0.2 m times `k_initial`."""
    return laboratory_block(6, k_initial=k_initial, k_unloading=100.0 * k_initial, knee=0.2)


def test_force_is_the_momentum_that_the_trusses_leave() -> None:
    """The blow takes what the vehicle has left, and gives back its restitution; here within one step."""
    vehicle, speed = block(1e5), 12.0
    with pytest.warns(CoreContactWarning, match=r"core_contact_force must be at most 67 kN"):
        result = Simulation(vehicle, Barrier.rigid_wall(), speed, duration=0.4).run()
    # A force of 20 kN over 2 m, less the first 0.1 m on average, takes 38 kJ.
    left = (speed**2 - 2.0 * 20e3 * 1.9 / vehicle.mass) ** 0.5
    impulse = (1.0 + Settings().restitution) * vehicle.mass * left
    assert result.metrics["core_contact_force"] == pytest.approx(impulse / 0.05, rel=0.01)
    assert result.statistics.core_contact_time == pytest.approx(2.0 / speed, rel=0.1)


def test_no_core_no_force() -> None:
    result = Simulation(block(1e7), Barrier.rigid_wall(), 12.0, duration=0.4).run()
    assert result.metrics["core_contact_force"] == 0.0
    assert result.statistics.body_steps == 0


def test_force_does_not_depend_on_where_the_scene_stands() -> None:
    """An oblique blow, in any axes: the force is the resultant."""
    vehicle, found = block(1e5), []
    for origin, heading in (((0.0, 0.0, 0.0), 0.0), ((40.0, -7.0, 0.0), 120.0)):
        wall = Barrier.rigid_wall(friction=0.3, origin=origin, heading=heading)
        with pytest.warns(CoreContactWarning):
            run = Simulation(vehicle, wall, 12.0, 85.0, duration=0.4).run()
        found.append(run.metrics["core_contact_force"])
    assert found[1] == pytest.approx(found[0], rel=1e-6)


@pytest.mark.parametrize(("share", "complaints"), [(0.0, 0), (0.99, 0), (1.01, 1)])
def test_the_limit_is_the_weight(share: float, complaints: int) -> None:
    scene = Simulation(block(1e5), Barrier.rigid_wall(), 12.0).scene
    told = SimpleNamespace(core_contact_force=share * scene.vehicle.mass * G, core_contact_time=0.1)
    assert len(list(core_complaints(scene, cast(StepStatistics, told)))) == complaints


def test_a_study_says_it_once() -> None:
    scene = Simulation(block(1e5), Barrier.rigid_wall(), 12.0, duration=0.4)
    with pytest.warns(CoreContactWarning) as said:
        study = sweep(scene, {"impact_speed": [2.0, 12.0, 14.0]})
    assert len(said) == 1
    assert "the worst of 2 in 3 runs" in str(said[0].message)
    assert study["core_contact_force"][0] == 0.0


def cause(vehicle: Vehicle, barrier: Barrier | None) -> str:
    """What the warning says of how the barrier reaches the core; the report says it too."""
    crash = Simulation(vehicle, barrier, 13.4, duration=0.3)
    with pytest.warns(CoreContactWarning) as said:
        result = crash.run()
    _, _, found = str(said[0].message).partition("a blow between rigid bodies")
    assert found.lower().removeprefix(". ") in result.report().lower()
    return found


def test_a_post_of_triangles_is_named_as_the_cause() -> None:
    """It goes twice as far in as a post, up to the core: its triangles draw in no skin beside it."""
    car = Vehicle.preset("passenger_car", mesh_density=0.3)
    assert cause(car, triangulated(Barrier.pole(diameter=0.3))) == (
        ". A part of the barrier that is narrower than the vehicle (0.3 m of 1.84 m) draws in no skin beside "
        "it (triangles make none) and is driven in to the core; bollards, poles and planters draw in skin"
    )


def test_a_sharp_edge_is_named_as_the_cause() -> None:
    assert cause(block(1e5), Barrier.planter(length=1.3, edge_radius=0.0)) == (
        ". Sharp edges of the barrier pass between nodes; rounded ones (edge_radius=0.05) do not"
    )


@pytest.mark.parametrize("barrier", [Barrier.rigid_wall(), triangulated(Barrier.rigid_wall(width=8.0))])
def test_a_wall_is_no_cause(barrier: Barrier) -> None:
    assert cause(block(1e5), barrier) == ""


@pytest.mark.parametrize(
    ("name", "speed"),
    [
        *[("small_car", 17.9), ("passenger_car", 22.35), ("pickup", 22.35), ("van_3500", 22.35)],
        *[("cargo_truck", 22.35), ("mash_10000s", 17.9), ("bus_13t", 22.35)],
    ],
)
def test_presets_do_not_meet_their_core_at_a_post(name: str, speed: float) -> None:
    """Tests at posts show no blow of meganewtons: compartment and bed are crushed before."""
    vehicle = Vehicle.preset(name, mesh_density=0.3)
    result = Simulation(vehicle, Barrier.pole(diameter=0.3), speed).run()
    assert result.metrics["core_contact_force"] == 0.0
    assert result.metrics["peak_normal_force_cfc60"] < 2.0 * result.metrics["peak_force_50ms"]


def test_zones_are_stretched_with_the_depth_that_the_file_states() -> None:
    """A longer front overhang stretches what lies before the axle, and so the part of the depth before it."""
    van = Vehicle.preset("van_3500")
    assert van.length is not None
    assert van.wheelbase is not None
    long = van.scaled_to(3500.0, length=van.length + 0.5, wheelbase=van.wheelbase)
    overhang, depth = 1.02, 1.17  # of the file, before the axle and `depth_m` of the front [m]
    beyond = van.length - van.wheelbase
    stretch = (overhang * (beyond + 0.5) / beyond + depth - overhang) / depth
    for zone in ("bumper", "engine_bay"):
        now, then = van.zones[zone].envelope, long.zones[zone].envelope
        assert [at for at, _ in then] == pytest.approx([stretch * at for at, _ in now], rel=1e-6)


def test_the_warning_is_an_error_here_and_in_all_files_but_those_listed() -> None:
    here = Path(__file__)
    assert here.name not in STRIKE_THE_CORE
    assert {path.name for path in here.parent.glob("test_*.py")} >= STRIKE_THE_CORE


def test_a_turned_vehicle_is_said_to_roll_as_the_blow_on_its_core_lifts_it() -> None:
    """One degree of yaw apart a car is upright with 7 degrees of roll, and rolls over: both say so."""
    told = "is not reliable: at a pole at 80 km/h, one degree of yaw changed it"
    car = Vehicle.preset("passenger_car")
    outcomes = []
    for yaw in (90.0, 91.0):
        with pytest.warns(CoreContactWarning, match=told):
            run = Simulation(car, Barrier.pole(diameter=0.3), "80 km/h", impact_yaw=yaw).run()
        outcomes.append(run.outcome)
        assert told in run.report()
        assert told in birm3d.design_load(run, natural_period=0.1, draws=0).caution
        rating = birm3d.rate(run, "ASTM F2656", vehicle_class="SC")
        assert [doubt.kind for doubt in rating.doubts] == ["core_contact_force"]
    assert outcomes == ["stopped", "rolled_over"]


@pytest.mark.parametrize(("yaw", "turned"), [(0.0, False), (9.0, False), (-12.0, True), (172.0, False)])
def test_only_turned_vehicles_are_in_doubt(yaw: float, turned: bool) -> None:
    scene = Simulation(block(1e5), Barrier.rigid_wall(), 12.0, impact_yaw=yaw).scene
    told = SimpleNamespace(core_contact_force=2.0 * scene.vehicle.mass * G, core_contact_time=0.1)
    (complaint,) = core_complaints(scene, cast(StepStatistics, told))
    assert (complaint.advice is not None) is turned
    assert ("rolls over" in complaint.text()) is turned
    assert len(list(core_doubts(scene, cast(StepStatistics, told)))) == turned
