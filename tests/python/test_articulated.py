"""Vehicles of two units: laws that hold whatever the truck."""

from __future__ import annotations

import copy
import dataclasses
import pickle
from functools import cache

import birm3d
import numpy as np
import pytest
from birm3d import ArticulatedVehicle, Barrier, Joint, Result, Settings, Simulation, Vehicle, scenes
from birm3d.base.fingerprint import fingerprint
from birm3d.result.report import _fold_text
from birm3d.scene_parameters import parameter_names, value_of, varied
from birm3d.vehicle import build

G = 9.80665


@cache
def semi() -> ArticulatedVehicle:
    return scenes.laboratory_semi()


@cache
def crash(angle: float, kind: str = "fifth_wheel", offset: float = 0.0) -> Result:
    vehicle = semi().with_joint(kind)
    wall = Barrier.rigid_wall(friction=0.2)
    return Simulation(vehicle, wall, 12.0, angle, offset, duration=0.5).run()


@cache
def parked() -> Result:
    return Simulation(semi(), None, 0.0, duration=2.0).run()


# ---- what it is ------------------------------------------------------------------------------------------


def test_the_whole_is_the_sum_of_its_units() -> None:
    vehicle = semi()
    leading, trailing = vehicle.units
    assert vehicle.mass == pytest.approx(leading.mass + trailing.mass, rel=1e-15)
    places = [leading.center_of_mass, trailing.center_of_mass + vehicle.joint.shift]
    moment = sum(unit.mass * place for unit, place in zip(vehicle.units, places, strict=True))
    assert vehicle.center_of_mass == pytest.approx(moment / vehicle.mass, abs=1e-12)
    # The inertia of point masses that have each unit's mass properties: 6 points on its principal axes.
    inertia = np.zeros((3, 3))
    for unit, place in zip(vehicle.units, places, strict=True):
        moments = np.diag(unit.inertia)
        reach = np.sqrt(np.maximum(0.0, (moments.sum() / 2.0 - moments) / unit.mass))  # rms, each axis
        for axis in range(3):
            for sign in (1.0, -1.0):
                point = place - vehicle.center_of_mass
                point = point + sign * np.sqrt(3.0) * reach[axis] * np.eye(3)[axis]
                inertia += unit.mass / 6.0 * (point @ point * np.eye(3) - np.outer(point, point))
    assert vehicle.inertia == pytest.approx(inertia, rel=1e-12, abs=1e-6)
    assert vehicle.n_nodes == leading.n_nodes + trailing.n_nodes
    assert len(vehicle.wheels) == 10
    # Nodes of both in one system: the trailer's front stands 0.9 m before the kingpin.
    shift = vehicle.center_of_mass - places[1]
    np.testing.assert_allclose(vehicle.nodes[leading.n_nodes :] + shift, trailing.nodes, atol=1e-12)
    assert vehicle.wheels[:, 2].max() - vehicle.wheels[:, 2].min() == pytest.approx(0.0, abs=1e-12)


def test_a_vehicle_of_one_unit_says_so() -> None:
    block = scenes.elastic_block(4)
    assert block.units == (block,)
    assert block.joint is None
    result = scenes.w1().run()
    assert "joints" not in result.energy
    assert "peak_joint_force_50ms" not in result.metrics
    with pytest.raises(ValueError, match="two units, got 'laboratory_block' of one"):
        _ = result.joint_force
    with pytest.raises(ValueError, match=r"index must be >= 0 and < 1, .*got 1"):
        result.unit(1)
    np.testing.assert_array_equal(result.unit(0).position, result.position)


def test_copies_are_equal_and_changes_are_not() -> None:
    vehicle = semi()
    for copied in (pickle.loads(pickle.dumps(vehicle)), copy.deepcopy(vehicle)):
        assert copied == vehicle
        assert fingerprint(copied) == fingerprint(vehicle)
    for other in (
        vehicle.with_joint("welded"),
        vehicle.with_gvw(30000.0),
        vehicle.with_rate_sensitivity(0.05),
        vehicle.with_unit(1, vehicle.units[1].with_gvw(20000.0)),
    ):
        assert other != vehicle
        assert fingerprint(other) != fingerprint(vehicle)
    assert vehicle != vehicle.units[0]


def test_changes_reach_the_units_that_they_concern() -> None:
    vehicle = semi()
    loaded = vehicle.with_gvw(30000.0)
    assert loaded.mass == pytest.approx(30000.0)
    assert loaded.units[0] == vehicle.units[0]
    raised = vehicle.with_mass_center_height(vehicle.mass_center_height + 0.2)
    assert raised.mass_center_height == pytest.approx(vehicle.mass_center_height + 0.2)
    for unit, was in zip(raised.units, vehicle.units, strict=True):
        ratio = raised.mass_center_height / vehicle.mass_center_height
        assert unit.mass_center_height == pytest.approx(ratio * was.mass_center_height, rel=1e-12)
    np.testing.assert_allclose(raised.nodes + raised.center_of_mass, vehicle.nodes + vehicle.center_of_mass)
    assert build(vehicle.recipe.each(rate_sensitivity=0.1)) == vehicle.with_rate_sensitivity(0.1)


def test_units_from_files_keep_their_joint_when_they_are_loaded() -> None:
    """A loaded unit's mass centre moves; the joint stays where it is on the structure."""
    car, pickup = (Vehicle.preset(name, mesh_density=0.1) for name in ("passenger_car", "pickup"))
    joint = Joint((-3.5, 0.0, 0.5), (1.5, 0.0, 0.5))
    block = scenes.laboratory_semi().units[0]
    vehicle = Vehicle.articulated([block, pickup], joint)
    loaded = vehicle.with_gvw(vehicle.mass + 500.0)
    assert loaded.units[1].mass == pytest.approx(pickup.mass + 500.0)
    assert loaded.units[1].center_of_mass[0] != pickup.center_of_mass[0]
    np.testing.assert_allclose(
        loaded.nodes + loaded.center_of_mass, vehicle.nodes + vehicle.center_of_mass, atol=1e-12
    )
    assert set(vehicle.zones) == set(pickup.zones)
    name = next(iter(pickup.zones))
    stiffer = vehicle.with_zones({name: pickup.zones[name].scaled(2.0)})
    assert stiffer.units[1].zones[name] == pickup.zones[name].scaled(2.0)
    assert not vehicle.has_file
    with pytest.raises(ValueError, match="mesh_density needs a vehicle that has a file"):
        vehicle.with_mesh_density(0.2)
    with pytest.raises(ValueError, match="names of zones must differ"):
        Vehicle.articulated([car, pickup], joint)


# ---- standing --------------------------------------------------------------------------------------------


def test_a_parked_semi_stands_still() -> None:
    result = parked()
    for index in (0, 1):
        unit = result.unit(index)
        assert np.abs(unit.position - unit.position[0]).max() < 1e-9  # m, in 2 s: rounding
        assert np.abs(unit.velocity).max() < 1e-9
        for angle in (unit.roll, unit.pitch, unit.yaw):
            assert np.abs(angle).max() < 1e-7  # deg
    settled = result.time > 0.1
    assert result.tire_reaction[settled].sum(axis=1) == pytest.approx(result.scene.vehicle.mass * G, rel=1e-9)
    assert np.ptp(result.tire_reaction[settled], axis=0).max() < 1e-6 * G * result.scene.vehicle.mass
    assert result.statistics.steps < 500  # 2 s: steps as long as they may be


def test_a_parked_semi_shares_its_weight_as_springs_do() -> None:
    """Of all reactions that carry both units those with the least sum of c f^2, c ~ 1/mass of the unit."""
    result = parked()
    vehicle = result.scene.vehicle
    wheels = [unit.wheels for unit in vehicle.units]
    n = [len(w) for w in wheels]
    # Unknown: tyre forces and the fifth wheel's force on the tractor. Force and pitching moment of each unit.
    kingpin = [
        place[0] - unit.center_of_mass[0]
        for place, unit in zip(
            (vehicle.joint.place_on_leading, vehicle.joint.place_on_trailing), vehicle.units, strict=True
        )
    ]
    balance = np.zeros((4, sum(n) + 1))
    for u, (start, sign) in enumerate(((0, 1.0), (n[0], -1.0))):
        columns = slice(start, start + n[u])
        balance[2 * u, columns], balance[2 * u + 1, columns] = 1.0, wheels[u][:, 0]
        balance[2 * u, -1], balance[2 * u + 1, -1] = sign, sign * kingpin[u]
    load = np.array([vehicle.units[0].mass * G, 0.0, vehicle.units[1].mass * G, 0.0])
    compliance = np.diag(
        [1.0 / u.mass for u, count in zip(vehicle.units, n, strict=True) for _ in range(count)] + [0.0]
    )
    system = np.block([[compliance, balance.T], [balance, np.zeros((4, 4))]])
    forces = np.linalg.solve(system, np.concatenate([np.zeros(sum(n) + 1), load]))[: sum(n) + 1]
    # The compliance is 1e-3 of the inverse mass, not infinitely small.
    assert result.tire_reaction[-1] == pytest.approx(forces[:-1], rel=5e-3)
    assert result.joint_force[-1] == pytest.approx([0.0, 0.0, forces[-1]], rel=5e-3, abs=1e-3)
    # A trailer on one axle: the lever rule, exactly.
    trailer = vehicle.units[1]
    one_axle = dataclasses.replace(trailer, wheels=trailer.wheels[:2].copy())
    alone = Simulation(vehicle.with_unit(1, one_axle), None, 0.0, duration=0.5).run()
    a, b = kingpin[1], -one_axle.wheels[0, 0]
    assert -alone.joint_force[-1, 2] == pytest.approx(trailer.mass * G * b / (a + b), rel=1e-9)


# ---- crashes ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ["fifth_wheel", "welded"])
@pytest.mark.parametrize("angle", [90.0, 40.0, 15.0])
def test_balances_close_for_each_unit(angle: float, kind: str) -> None:
    result = crash(angle, kind)
    assert result.momentum_residual < 1e-9
    assert result.metrics["energy_residual"] < 1e-3
    start = result.energy["kinetic"][0]
    # The joint works only by the error of the steps; the stops of a fifth wheel are impacts.
    assert np.abs(result.energy["joints"]).max() < 1e-4 * start
    interval = result.time[1] - result.time[0]
    forces = np.zeros_like(result.position[1:])
    for u, unit in enumerate(result.scene.vehicle.units):
        history = result.unit(u)
        force = history.barrier_force + history.tire_friction_force + history.joint_force
        force = force + np.outer(history.tire_reaction.sum(axis=1) - unit.mass * G, [0.0, 0.0, 1.0])
        momentum = unit.mass * np.diff(history.velocity, axis=0) / interval
        assert np.abs(momentum - force[1:]).max() < 1e-9 * np.abs(force).max()
        forces += force[1:]
    assert np.abs(result.unit(0).joint_force + result.unit(1).joint_force).max() == 0.0
    assert result.joint_force == pytest.approx(result.unit(0).joint_force, abs=1e-3)


@pytest.mark.parametrize("angle", [90.0, 40.0, 15.0])
def test_the_joint_stays_closed(angle: float) -> None:
    result = crash(angle)
    vehicle = result.scene.vehicle
    ends = []
    for u, place in enumerate((vehicle.joint.place_on_leading, vehicle.joint.place_on_trailing)):
        unit = result.unit(u)
        arm = place - vehicle.units[u].center_of_mass
        heading = np.radians(90.0 - angle)
        yaw, pitch, roll = np.radians(unit.yaw) + heading, np.radians(unit.pitch), np.radians(unit.roll)
        cy, sy, cp, sp, cr, sr = (f(a) for a in (yaw, pitch, roll) for f in (np.cos, np.sin))
        turn = np.array(
            [
                [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
                [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
                [-sp, cp * sr, cp * cr],
            ]
        )
        ends.append(unit.position + np.einsum("ijn,j->ni", turn, arm))
    # Between two steps the path of each unit is interpolated by itself; at the steps the gap is rounding.
    assert np.linalg.norm(ends[0] - ends[1], axis=1).max() < 1e-4


def test_the_trailer_pushes_the_tractor() -> None:
    """Head-on nothing but the joint slows the trailer: its impulse is the trailer's change of momentum."""
    result = crash(90.0)
    trailer = result.scene.vehicle.units[1]
    interval = result.time[1] - result.time[0]
    impulse = result.joint_force[1:, 0].sum() * interval
    change = trailer.mass * (result.unit(1).velocity[-1, 0] - result.unit(1).velocity[0, 0])
    assert impulse == pytest.approx(-change, rel=1e-9)
    assert result.joint_force[:, 0].max() > 5e5  # forwards on the tractor
    assert result.metrics["max_articulation_angle"] < 1e-6
    # Without it the tractor alone presses the wall much less.
    alone = Simulation(semi().units[0], Barrier.rigid_wall(), 12.0, duration=0.5).run()
    assert result.metrics["dynamic_crush"] > 1.3 * alone.metrics["dynamic_crush"]


def test_left_and_right_impacts_mirror_each_other() -> None:
    left, right = (
        Simulation(
            semi(),
            Barrier.rigid_wall(friction=0.2),
            12.0,
            angle,
            duration=0.4,
            settings=Settings(time_step=2e-4),
        ).run()
        for angle in (40.0, 140.0)
    )
    mirror = np.array([1.0, -1.0, 1.0])
    assert left.metrics["max_articulation_angle"] > 5.0
    scale = left.joint_force.max()
    for u in (0, 1):
        a, b = left.unit(u), right.unit(u)
        np.testing.assert_allclose(a.velocity, b.velocity * mirror, atol=1e-9 * 12.0)
        np.testing.assert_allclose(a.yaw, -b.yaw, atol=1e-7)
        np.testing.assert_allclose(a.roll, -b.roll, atol=1e-7)
    np.testing.assert_allclose(left.articulation_angle, -right.articulation_angle, atol=1e-7)
    np.testing.assert_allclose(left.joint_force, right.joint_force * mirror, atol=1e-6 * scale)


def test_an_oblique_impact_folds_a_fifth_wheel_and_not_a_weld() -> None:
    free, held = crash(40.0), crash(40.0, "welded")
    assert free.metrics["max_articulation_angle"] > 5.0
    assert held.metrics["max_articulation_angle"] < 1e-6
    assert np.abs(held.joint_moment).max() > 1e4
    limit = free.scene.vehicle.joint.roll_limit
    assert np.abs(free.joint_roll).max() < limit + 1e-3  # deg
    away = np.abs(free.joint_roll) < 0.5 * limit
    away = away & np.roll(away, 1) & np.roll(away, -1)
    assert np.abs(free.joint_moment[away]).max() == 0.0
    # Angles of the joint are those between the units.
    flat = np.abs(free.unit(0).roll) + np.abs(free.unit(0).pitch) < 0.05
    flat &= np.abs(free.unit(1).roll) + np.abs(free.unit(1).pitch) < 0.05
    assert flat.sum() > 10
    np.testing.assert_allclose(
        free.articulation_angle[flat], (free.unit(1).yaw - free.unit(0).yaw)[flat], atol=0.01
    )


def test_answers_converge_with_the_tolerance() -> None:
    """Without the ground, whose contacts begin and end at instants that steps only meet by chance."""

    def final(tolerance: float) -> np.ndarray:
        settings = Settings(tolerance=tolerance, ground=False, gravity=0.0)
        result = Simulation(semi(), Barrier.rigid_wall(), 12.0, 60.0, duration=0.2, settings=settings).run()
        return np.concatenate([result.unit(u).position[-1] for u in (0, 1)])

    exact = final(1e-7)
    for tolerance in (1e-2, 1e-3, 1e-4):
        assert np.abs(final(tolerance) - exact).max() < tolerance * 12.0 * 0.2


def test_a_run_goes_on_from_a_snapshot_with_the_same_bits() -> None:
    simulation = Simulation(semi(), Barrier.rigid_wall(friction=0.2), 12.0, 40.0, duration=0.1)
    for _ in range(30):
        simulation.step()
    snapshot = simulation.snapshot()
    simulation.run()
    end = simulation.state_hash()
    other = Simulation(semi(), Barrier.rigid_wall(friction=0.2), 12.0, 40.0, duration=0.1)
    other.restore(snapshot)
    other.run()
    assert other.state_hash() == end
    welded = Simulation(
        semi().with_joint("welded"), Barrier.rigid_wall(friction=0.2), 12.0, 40.0, duration=0.1
    )
    with pytest.raises(ValueError, match="snapshot"):
        welded.restore(snapshot)


def test_parameters_of_a_scene_reach_both_units() -> None:
    simulation = Simulation(semi(), Barrier.rigid_wall(), 12.0)
    assert not any(name.startswith("truss.") for name in parameter_names(simulation))
    assert value_of(simulation, "vehicle.gvw") == semi().mass
    lighter = varied(simulation, {"vehicle.gvw": 30000.0, "vehicle.rate_sensitivity": 0.05})
    vehicle = lighter.scene.vehicle
    assert vehicle.mass == pytest.approx(30000.0)
    assert [unit.rate_sensitivity for unit in vehicle.units] == [0.05, 0.05]


def test_a_sweep_has_the_scalars_of_the_joint() -> None:
    simulation = Simulation(semi(), Barrier.rigid_wall(), 8.0, 60.0, duration=0.05)
    study = birm3d.sweep(simulation, impact_speed=[4.0, 8.0])
    result = simulation.run()
    for name in ("max_articulation_angle", "peak_joint_force_50ms"):
        assert study.metrics[name][1] == result.metrics[name]


def test_the_report_and_the_table_tell_of_the_joint() -> None:
    pytest.importorskip("pandas")
    result = crash(40.0)
    assert "fifth_wheel: peak 50-ms mean of the force" in result.report()
    assert "contact of the two units with each other" in result.report()
    assert "would meet" not in result.report()
    assert "the units would meet, which is not computed" in _fold_text(93.0)
    table = result.to_dataframe()
    assert {"joint_force_x [N]", "articulation_angle [deg]", "energy_joints [J]"} <= set(table.columns)


# ---- bad input -------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"kind": "ball"}, "kind must be one of fifth_wheel, welded, sliding, got 'ball'"),
        ({"roll_limit": -1.0}, r"roll_limit must be >= 0 and < 90 deg, got -1.0"),
        ({"roll_limit": np.nan}, r"roll_limit must be >= 0 and < 90 deg, got nan"),
        ({"place_on_leading": (0.0, 0.0)}, "place_on_leading must be three finite numbers"),
        ({"place_on_trailing": (0.0, 0.0, np.inf)}, "place_on_trailing must be three finite numbers"),
        ({"place_on_trailing": (6.0, 0.0, 1.202)}, r"within 0.001 m, got 1.202 m"),
    ],
)
def test_bad_joints_are_refused(change: dict[str, object], message: str) -> None:
    given = {"place_on_leading": (-3.0, 0.0, 1.2), "place_on_trailing": (6.0, 0.0, 1.2)}
    with pytest.raises(ValueError, match=message):
        Joint(**{**given, **change})


def test_bad_vehicles_are_refused() -> None:
    vehicle = semi()
    leading, trailing = vehicle.units
    with pytest.raises(ValueError, match="units must be two, got 3"):
        Vehicle.articulated([leading, trailing, trailing], vehicle.joint)
    with pytest.raises(ValueError, match=r"units\[1\] must be a vehicle of one unit"):
        Vehicle.articulated([leading, vehicle], vehicle.joint)
    with pytest.raises(
        TypeError,
        match=r"units\[0\] must be a birm3d\.Vehicle, got 'semi_truck'; Vehicle\.preset\('semi_truck'\)",
    ):
        Vehicle.articulated(["semi_truck", trailing], vehicle.joint)
    with pytest.raises(TypeError, match=r"joint must be a birm3d\.Joint, got 'welded'"):
        Vehicle.articulated([leading, trailing], "welded")
    with pytest.raises(ValueError, match=r"gvw must be above the leading unit's mass \(8633 kg\), got 8000"):
        vehicle.with_gvw(8000.0)
    with pytest.raises(ValueError, match=r"index must be 0 \(leading\) or 1 \(trailing\), got 2"):
        vehicle.with_unit(2, leading)
    with pytest.raises(ValueError, match="truss law must be given to one of the units"):
        vehicle.with_truss_law(k_initial=1.0)
    with pytest.raises(ValueError, match="truss law must be asked of one of the units"):
        _ = vehicle.truss_law
    with pytest.raises(ValueError, match="kind must be"):
        vehicle.with_joint("ball")
    assert birm3d.Joint is Joint
