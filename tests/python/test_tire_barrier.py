"""Tyres meet barriers: where their nodes are, what they carry, how they climb a sloped face."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from birm3d import Barrier, Settings, Simulation, Vehicle, units
from birm3d.result import Result
from birm3d.vehicle.mesher import build_mesh
from birm3d.vehicle.tire_nodes import build_tread
from birm3d.vehicle.vehicle_file import VehicleFile, VehicleFileError, read_vehicle_file, unit_paths


@pytest.fixture(scope="module", params=unit_paths())
def preset(request) -> VehicleFile:
    return read_vehicle_file(unit_paths()[request.param])


def car(name: str = "passenger_car", density: float = 0.3) -> Vehicle:
    return Vehicle.preset(name, mesh_density=density)


@cache
def climb(name: str = "pickup", profile: str = "new_jersey", tires: bool = True, **settings: float) -> Result:
    """100 km/h, 25 degrees, half a second."""
    vehicle = car(name) if tires else car(name).without_tire_contact()
    return Simulation(
        vehicle,
        Barrier.jersey(profile=profile),
        units.km_h(100.0),
        25.0,
        duration=0.5,
        settings=Settings(**settings),
    ).run()


# ---- nodes ------------------------------------------------------------------------------------------------


def test_nodes_lie_on_the_outer_edge_of_the_tread(preset):
    tread = build_tread(preset)
    assert set(tread.wheel) == set(range(len(preset.wheels)))
    for index, wheel in enumerate(preset.wheels):
        nodes, anchors = tread.nodes[tread.wheel == index], tread.anchors[tread.wheel == index]
        d = nodes - np.array(wheel.center_m)
        np.testing.assert_allclose(np.hypot(d[:, 0], d[:, 2]), wheel.radius_m, rtol=1e-12)
        np.testing.assert_allclose(
            np.abs(nodes[:, 1]), abs(wheel.center_m[1]) + wheel.width_m / 2, rtol=1e-12
        )
        part = tread.area[tread.wheel == index][0] / wheel.width_m
        assert 0.05 < nodes[:, 2].min() < 0.05 + part
        # The edge that is not near the ground, whole.
        free = 2.0 * wheel.radius_m * (np.pi - np.arccos(1.0 - 0.05 / wheel.radius_m))
        assert tread.area[tread.wheel == index].sum() == pytest.approx(free * wheel.width_m, rel=1e-12)
        # Trusses stand across the vehicle: head-on the front's zones have it all.
        assert (anchors[:, 0] == nodes[:, 0]).all()
        truss = anchors - nodes
        np.testing.assert_allclose(np.linalg.norm(truss, axis=1), 3.0, rtol=1e-12)
        assert (truss[:, 1] * nodes[:, 1] < 0.0).all()
        assert (truss[:, 2] * d[:, 2] <= 0.0).all()


@pytest.mark.parametrize("density", [0.05, 1.0, 1.9])
def test_left_and_right_front_and_rear_are_mirror_images(preset, density):
    tread = build_tread(preset, density)
    for index, wheel in enumerate(preset.wheels):
        center = np.array(wheel.center_m) * [1.0, 0.0, 0.0]
        mine = tread.nodes[tread.wheel == index] - center
        np.testing.assert_allclose(mine[::-1, 0], -mine[:, 0], rtol=0.0, atol=1e-14)  # the sum's rounding
        np.testing.assert_array_equal(mine[::-1, 2], mine[:, 2])
        for other, twin in enumerate(preset.wheels):
            if twin.center_m == (wheel.center_m[0], -wheel.center_m[1], wheel.center_m[2]):
                its = tread.nodes[tread.wheel == other]
                np.testing.assert_array_equal(its * [1, -1, 1], tread.nodes[tread.wheel == index])


def test_a_tread_pressed_on_a_plane_is_as_stiff_as_its_file_says(preset):
    """20 mm of the round tread into a plane: the sum over the area of the zone's stress at each depth."""
    stated = {
        **{"passenger_car": 200e3, "minivan": 220e3, "pickup": 280e3, "paper_pickup": 280e3},
        # Scaled ones: about in proportion to the mass that a wheel carries, 0.48 MN/m a ton of it.
        **{"small_car": 110e3, "mash_1100c": 130e3, "sedan_1500": 175e3, "van_3500": 290e3},
        **{"mash_2270p": 205e3, "pickup_4x4_2500": 250e3, "heavy_pickup": 235e3},
    }
    zone = next(zone for zone in preset.zones if "tire" in zone.panels)
    depth, stress = np.array(zone.envelope).T
    for wheel in preset.wheels:
        x = np.linspace(-wheel.radius_m, wheel.radius_m, 20001)
        pressed = np.maximum(0.0, np.sqrt(wheel.radius_m**2 - x**2) - (wheel.radius_m - 0.02))
        force = wheel.width_m * np.trapezoid(np.interp(pressed, depth, stress), x)
        tires = 2 if wheel.width_m > 0.5 else 1
        limit = stated.get(preset.name, 900e3) * tires
        assert force / 0.02 == pytest.approx(limit, rel=0.15), wheel.name


def test_the_shell_stands_before_the_treads_in_every_array():
    for name in Vehicle.presets():
        for unit in Vehicle.preset(name, mesh_density=0.1).units:
            shell = int((unit.wheel_of_node < 0).sum())
            assert (unit.wheel_of_node[:shell] == -1).all()
            assert (unit.wheel_of_node[shell:] >= 0).all()
            assert unit.quads.max() < shell
            names = np.array(list(unit.zones))[unit.zone_of_node]
            assert all("tire" in zone for zone in names[shell:])
            assert not any("tire" in zone for zone in names[:shell])
            centers = unit.wheels[unit.wheel_of_node[shell:], :3]
            away = np.linalg.norm(unit.nodes[shell:] - centers, axis=1)
            assert away.max() < 1.5 * unit.wheels[:, 3].max()


def test_without_tire_contact_there_is_the_shell_alone():
    whole = car()
    bare = whole.without_tire_contact()
    assert (bare.wheel_of_node == -1).all()
    assert bare.n_nodes - (bare.along_of_node >= 0).sum() == len(build_mesh(whole._file, 0.3).nodes)
    assert bare.without_tire_contact() is bare
    # It stays so whatever is made anew.
    for again in (bare.with_gvw(1500.0), bare.with_mesh_density(0.1), bare.scaled_to(1500.0)):
        assert (again.wheel_of_node == -1).all()
    assert (whole.with_gvw(1500.0).wheel_of_node >= 0).any()
    semi = Vehicle.preset("semi_truck", mesh_density=0.1)
    assert (semi.without_tire_contact().wheel_of_node == -1).all()
    assert semi.wheel_of_node.max() == len(semi.wheels) - 1


def test_a_zone_of_tires_is_of_tires_alone(tmp_path):
    path = tmp_path / "van.toml"
    text = unit_paths()["passenger_car"].read_text()
    path.write_text(text.replace('panels = ["tire"]', 'panels = ["tire", "side"]'))
    with pytest.raises(VehicleFileError, match=r"zone\.tire.*must not go with the panel 'tire', got side"):
        read_vehicle_file(path)
    path.write_text(text.replace('panels = ["tire"]', 'panels = ["tire"]\ncore = ["chassis"]'))
    with pytest.raises(VehicleFileError, match="must not go with the panel 'tire', got chassis"):
        read_vehicle_file(path)


def test_a_wheel_in_the_middle_is_refused():
    file = read_vehicle_file(unit_paths()["passenger_car"])
    middle = file.wheels[0].model_copy(update={"center_m": (0.0, 0.1, 0.33)})
    with pytest.raises(ValueError, match=r"wheel\.front_left.*must be >= 0\.1075 m.*got 0\.1"):
        build_tread(file.model_copy(update={"wheels": (middle,)}))


def test_friction_of_tires_below_zero_is_refused():
    with pytest.raises(ValueError, match=r"mu_tire_barrier must be .*>= 0, got -0\.1"):
        Settings(mu_tire_barrier=-0.1)


# ---- runs -------------------------------------------------------------------------------------------------


def test_head_on_the_front_is_all_there_is():
    """Nodes of treads only slide along a wall from the front: to rounding, a run without them."""
    with_tires, without = (
        Simulation(vehicle, Barrier.rigid_wall(), 15.0).run()
        for vehicle in (car(), car().without_tire_contact())
    )
    np.testing.assert_allclose(with_tires.velocity, without.velocity, rtol=0.0, atol=1e-9)


@pytest.mark.parametrize("profile", ["new_jersey", "f_shape", "single_slope"])
@pytest.mark.parametrize("name", ["passenger_car", "pickup"])
def test_the_balance_closes(name, profile):
    assert climb(name, profile).metrics["energy_residual"] < 1e-3


@pytest.mark.parametrize("name", ["passenger_car", "pickup", "semi_truck"])
def test_left_and_right_mirror_each_other(name):
    """To rounding, which a crash makes grow."""
    right = Simulation(car(name), Barrier.jersey(), 25.0, 25.0, duration=0.2).run()
    left = Simulation(car(name), Barrier.jersey(), 25.0, 155.0, duration=0.2).run()
    np.testing.assert_allclose(left.velocity, right.velocity * [1.0, -1.0, 1.0], rtol=0.0, atol=1e-9)


def test_no_tread_ends_a_step_inside():
    for name in ("passenger_car", "pickup"):
        simulation = Simulation(car(name), Barrier.jersey(), units.mph(62.0), 25.0)
        deepest = 0.0
        while simulation.step():
            deepest = max(deepest, simulation._core.deepest_node)
        assert deepest < 1e-4


# The lower part of a New Jersey barrier: a pickup's skin passes above it, its wheels do not.
TOE = [(0.3048, 0.0), (0.3048, 0.0762), (0.127, 0.3302)]


@cache
def height_on_toe(speed: float, angle: float, time: float, mu: float, braking: float = 0.0) -> float:
    """Height to which the wheel that is ahead at the barrier has risen at that time after the touch [m]."""
    settings = Settings(mu_tire_barrier=mu, braking=braking)
    barrier = Barrier.jersey(profile=TOE)
    result = Simulation(car("pickup"), barrier, speed, angle, duration=time, settings=settings).run()
    wheel = result.scene.vehicle.wheels[1]  # front right: the barrier is on the right
    center, turn = result.pose([result.time[-1]])
    return float(center[0, 2] + (turn[0] @ wheel[:3])[2] - wheel[3] * np.sqrt(1.0 - turn[0][2, 1] ** 2))


# The first climb; faster or steeper, the toe is overrun and crushes the wheel.
ON_TOE = [(20.0, 10.0, 0.1), (20.0, 5.0, 0.2)]


@pytest.mark.parametrize(("speed", "angle", "time"), ON_TOE)
def test_more_friction_lifts_a_rolling_wheel_more(speed, angle, time):
    """Its tread goes down in front."""
    heights = [height_on_toe(speed, angle, time, mu) for mu in (0.0, 0.3, 0.6, 0.9)]
    assert heights[0] > 1e-3  # the slope itself
    assert (np.diff(heights) > 0.0).all(), heights
    assert heights[-1] > 1.1 * heights[0]


@pytest.mark.parametrize(("speed", "angle", "time"), ON_TOE)
def test_a_locked_wheel_climbs_less_than_a_rolling_one(speed, angle, time):
    """Friction holds down what only slides up, and lifts a tread that goes down."""
    locked = height_on_toe(speed, angle, time, 0.6, 1.0)
    assert locked < height_on_toe(speed, angle, time, 0.0)
    assert locked < 0.5 * height_on_toe(speed, angle, time, 0.6)


# Barriers of the heights in use, 32 in and 42 in for the single slope, and a vertical parapet of 32 in.
FACES = {
    "new_jersey": Barrier.jersey(profile="new_jersey"),
    "f_shape": Barrier.jersey(profile="f_shape"),
    "single_slope": Barrier.jersey(profile="single_slope"),
    "vertical": Barrier.rigid_wall(height=0.81),
}


@cache
def met(name: str, mass: float, face: str, strength: float = 1.0, mu: float = 0.6) -> Result:
    """MASH test level 3: 100 km/h, 25 degrees; wheels of so many times their file's strength."""
    vehicle = car(name).scaled_to(mass)
    zone = vehicle.zones["tire"]
    envelope = tuple((depth, strength * stress) for depth, stress in zone.envelope)
    vehicle = vehicle.with_zone("tire", envelope=envelope, k_unloading=strength * zone.k_unloading)
    settings = Settings(mu_tire_barrier=mu, output_interval=1e-3)
    return Simulation(vehicle, FACES[face], units.km_h(100.0), 25.0, settings=settings).run()


@pytest.mark.parametrize(("name", "mass"), [("pickup", 2270.0), ("passenger_car", 1100.0)])
def test_faces_stand_in_the_order_of_experience(name, mass):
    """The vertical face is the least trouble, the F-shape no more than New Jersey.

    Rollover Caused by Concrete Safety Shaped Barrier (FHWA-RD-88-219, 1989): the vertical wall offers the
    greatest reduction of rollover, the F-shape little. McDevitt, Basics of Concrete Barriers (Public
    Roads, 2000): the F-shape lifts less than New Jersey, the single slope of 10.8 deg does as New Jersey.
    Known to differ: the single slope lifts the small car more than New Jersey does (0.5 m and 0.2 m), for
    what is crushed pushes at right angles to the face. The F-shape lifts the pickup as New Jersey does,
    1.5 % more: its near wheels are highest after it has left, on wheels that castor. At the vertical
    face, too, a vehicle rolls on its springs, by 4 to 9 deg, and far wheels leave the ground by up to
    0.13 m.
    """
    lift = {face: met(name, mass, face).metrics["wheel_climb"] for face in FACES}
    roll = {face: met(name, mass, face).metrics["max_roll"] for face in FACES}
    assert lift["vertical"] < 0.25 * lift["f_shape"] < 0.25 * 1.02 * lift["new_jersey"]
    # Below 5 deg it is the springs that give way on any face.
    # The single slope here is 1.07 m high, and does not let the pickup roll either.
    assert roll["vertical"] < max(5.0, 0.8 * min(roll["new_jersey"], roll["f_shape"]))


@pytest.mark.parametrize("mu", [0.3, 0.6, 0.9])
@pytest.mark.parametrize("strength", [0.5, 1.0, 2.0])
@pytest.mark.parametrize(("name", "mass"), [("pickup", 2270.0), ("passenger_car", 1100.0)])
def test_whether_a_vehicle_stays_upright_hangs_on_no_estimate(name, mass, strength, mu):
    """Wheels' strength and friction are estimates: within twice and half of them none overturns.

    The greatest roll is 54 degrees: of the pickup at an F-shape, with twice the strength and a friction
    of 0.3. Camber thrust brings it down again; with a camber ratio of 0.06 instead of 0.1 it rolls by 75
    degrees.
    """
    for face in FACES:
        result = met(name, mass, face, strength, mu)
        assert result.outcome != "rolled_over", face
        assert result.metrics["max_roll"] < 60.0, face


def test_a_roll_goes_on_past_the_full_turn():
    """A pickup at 40 m/s and 40 degrees climbs a New Jersey barrier and rolls over: its angle counts on."""
    simulation = Simulation(car("pickup"), Barrier.jersey(), 40.0, 40.0, duration=3.0)
    deepest = 0.0
    while simulation.step():
        deepest = max(deepest, simulation._core.deepest_node)
    result = simulation.run()
    assert result.metrics["max_roll"] > 360.0
    assert np.abs(np.diff(result.roll)).max() < 5.0  # in 0.1 ms
    assert result.metrics["energy_residual"] < 1e-3
    assert deepest < 1e-4


def test_tires_are_frictionless_where_the_barrier_is_unless_asked():
    def lost(friction: float, mu: float | None) -> float:
        barrier = Barrier.jersey(friction=friction)
        scene = Simulation(car(), barrier, 25.0, 25.0, duration=0.1, settings=Settings(mu_tire_barrier=mu))
        return float(scene.run().energy["barrier_friction"][-1])

    assert lost(0.0, None) == 0.0
    assert lost(0.2, None) == lost(0.2, 0.6) > lost(0.2, 0.0) > 0.0
    assert lost(0.0, 0.6) > 0.0


@pytest.mark.parametrize("angle", [10.0, 45.0, 90.0, 155.0])
@pytest.mark.parametrize("name", Vehicle.presets())
def test_a_vehicle_with_tires_starts_where_its_nearest_node_is(name, angle):
    """Anchors of treads reach out at the other side; they are no part of it."""
    run = Simulation(car(name), Barrier.rigid_wall(), 20.0, angle)
    nearest = -np.inf
    for u, unit in enumerate(run.scene.vehicle.units):
        center, turn = run._core.pose(u)
        nearest = max(nearest, float((center + unit.nodes @ turn.T)[:, 0].max()))
    assert nearest == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("name", ["passenger_car", "minivan", "pickup", "cargo_truck"])
def test_a_wall_comes_to_the_skin_before_the_tires(name):
    """Upright, at 25 degrees: a wheel is met where the skin beside it has been crushed to it."""
    simulation = Simulation(car(name), Barrier.rigid_wall(), 20.0, 25.0, duration=0.5)
    unit = simulation.scene.vehicle
    met: dict[int, float] = {}
    while simulation.step():
        way = np.linalg.norm(simulation._core.nodes(0) - unit.nodes, axis=1)
        for wheel in set(unit.wheel_of_node[way > 0.0].tolist()).difference({-1}, met):
            x, y, _, radius = unit.wheels[wheel]
            beside = unit.wheel_of_node < 0
            beside &= (np.abs(unit.nodes[:, 0] - x) < radius + 0.1) & (unit.nodes[:, 1] * y > 0.0)
            met[wheel] = float(way[beside].max())
    assert met[1] > 0.0  # front right, where the wall is; the car has not rolled yet
    assert not {0, 2} & set(met)  # on the left, away from the wall


def test_treads_do_not_meet_the_ground():
    """A car that is rolled on a road without a barrier near runs as one without treads."""
    runs = [
        Simulation(vehicle, None, 15.0, impact_roll=30.0, duration=0.5).run()
        for vehicle in (car(), car().without_tire_contact())
    ]
    np.testing.assert_array_equal(runs[0].velocity, runs[1].velocity)


def test_wheel_climb_is_that_of_the_lowest_point():
    """A car on its way along the road climbs nothing; one that falls from its side wheels starts with it."""
    level = Simulation(car(), None, 15.0, duration=0.1).run()
    assert level.metrics["wheel_climb"] < 1e-6
    rolled = Simulation(car(), None, 15.0, impact_roll=20.0, duration=0.01).run()
    vehicle = rolled.scene.vehicle
    across = np.ptp(vehicle.wheels[:, 1]) * np.sin(np.radians(20.0))
    extended = vehicle.zones["tire"].static_deflection * np.cos(np.radians(20.0))
    assert rolled.metrics["wheel_climb"] == pytest.approx(across - extended, rel=0.05)


def test_zones_of_tires_are_changed_like_others():
    soft = car().with_zone("tire", envelope=((0.0, 0.0), (0.1, 1e3)), k_unloading=1e6)
    zone = soft.zones["tire"]
    assert zone.envelope == ((0.0, 0.0), (0.1, 1e3))
    slack = Simulation(soft, Barrier.jersey(), 25.0, 25.0, duration=0.2).run()
    assert slack.metrics["wheel_climb"] != climb("passenger_car").metrics["wheel_climb"]
