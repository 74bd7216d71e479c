"""Walls with rounded upright edges, and impacts that overlap a share of the vehicle's width."""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Callable
from pathlib import Path

import birm3d
import numpy as np
import pytest
import shapely
from birm3d import Barrier, Result, Settings, Simulation, Vehicle, sweep, units
from birm3d.barrier.text import barrier_text
from birm3d.simulation.parameters import varied
from birm3d.simulation.scene_file import read_scene_file

SPEED = units.km_h(64.4)


@pytest.fixture(scope="module")
def car() -> Vehicle:
    return Vehicle.preset("passenger_car", mesh_density=0.5)


def crash(car: Vehicle, wall: Barrier, side: str = "left", overlap: float = 0.25) -> Result:
    return Simulation(car, wall, SPEED, overlap=overlap, overlap_side=side, duration=0.15).run()


def change(result: Result) -> np.ndarray:
    return np.asarray(result.velocity[-1] - result.velocity[0])


def test_left_and_right_are_mirror_images(car: Vehicle) -> None:
    wall = Barrier.rigid_wall(edge_radius=0.15)
    left, right = (crash(car, wall, side) for side in ("left", "right"))
    assert change(left) == pytest.approx(change(right) * [1.0, -1.0, 1.0], rel=1e-3, abs=5e-3)
    assert left.yaw[-1] == pytest.approx(-right.yaw[-1], rel=2e-3)
    at = int(np.searchsorted(left.time, 0.08))
    assert left.velocity[at, 1] < -2.5, "pushed off to the right; half of 150 tests have -3.2 to -4.5 m/s"
    assert left.yaw[-1] > 1.0, "turned to the left"


def test_impulse_does_not_hang_on_a_small_radius(car: Vehicle) -> None:
    """Rounded edges draw in the skin beside them, however small they are; a sharp edge (0 m) cuts it."""
    thin, nearly, small = (
        change(crash(car, Barrier.rigid_wall(width=4.0, edge_radius=radius)))
        for radius in (0.001, 0.005, 0.02)
    )
    assert nearly == pytest.approx(thin, rel=0.02, abs=0.1)
    assert np.linalg.norm(small - thin) < 1.0


@pytest.mark.parametrize("name", ["passenger_car", "minivan", "pickup"])
def test_small_overlap_is_within_the_quartiles_and_meets_no_core(name: str) -> None:
    """150 tests of IIHS, 64 km/h: quartiles of the change of velocity along; masses are not recorded."""
    wall = Barrier.rigid_wall(edge_radius=0.15, height=1.524)
    vehicle = Vehicle.preset(name, mesh_density=0.5)
    result = Simulation(vehicle, wall, SPEED, overlap=0.25, duration=0.15).run()
    assert result.statistics.body_steps == 0
    along = np.cumsum(result.acceleration[1:, 0]) * result.scene.settings.output_interval
    quartiles = {0.06: (-6.18, -4.84), 0.08: (-9.54, -7.62), 0.1: (-12.95, -10.28), 0.12: (-15.11, -11.88)}
    for time, (low, high) in quartiles.items():
        assert low < np.interp(time, result.time[1:], along) < high, time


def test_load_of_the_wall_has_that_of_its_edges(car: Vehicle) -> None:
    result = crash(car, Barrier.rigid_wall(edge_radius=0.15))
    (wall,) = result.element_loads
    assert wall.name == "wall"
    assert wall.force[1:] == pytest.approx(-result.barrier_force[1:], rel=1e-9, abs=1e-3)
    assert result.metrics["peak_element_force"] == pytest.approx(np.linalg.norm(wall.force, axis=1).max())


def test_energy_and_momentum_close(car: Vehicle) -> None:
    result = crash(car, Barrier.rigid_wall(edge_radius=0.15))
    assert abs(result.metrics["energy_residual"]) < 2e-3
    assert result.metrics["momentum_residual"] < 1e-9


def test_impulse_goes_over_the_edge_without_a_jump(car: Vehicle) -> None:
    """The offset leads the car from the face over the seam and round the arc to nothing.

    Between 5 and 6 % the edge comes from beside the front to before it, and takes the front's skin along.
    """
    wall = Barrier.rigid_wall(width=4.0, edge_radius=0.15)
    shares = np.linspace(0.02, 0.22, 21)
    found = [change(crash(car, wall, overlap=float(share))) for share in shares]
    assert max(float(np.linalg.norm(b - a)) for a, b in itertools.pairwise(found)) < 3.0
    assert np.linalg.norm(found[0]) < 0.1 * SPEED
    assert np.linalg.norm(found[-1]) > 3.0


def test_overlap_of_the_whole_width_is_the_full_wall(car: Vehicle) -> None:
    whole = crash(car, Barrier.rigid_wall(width=4.0, edge_radius=0.0), overlap=1.0)
    wall = Simulation(car, Barrier.rigid_wall(), SPEED, duration=0.15).run()
    assert whole.metrics["max_displacement"] == pytest.approx(wall.metrics["max_displacement"], rel=1e-3)


@pytest.mark.parametrize("angle", [90.0, 60.0, 120.0])
@pytest.mark.parametrize("side", ["left", "right"])
def test_barrier_ends_inside_the_width_by_that_share(car: Vehicle, side: str, angle: float) -> None:
    wall = Barrier.rigid_wall(width=3.0, thickness=0.4, edge_radius=0.1, origin=(3.0, 1.0, 0.0), heading=10.0)
    scene = Simulation(car, wall, SPEED, angle, overlap=0.4, overlap_side=side).scene
    line = np.array([-np.sin(np.radians(10.0)), np.cos(np.radians(10.0))])
    yaw = np.radians(10.0 + 90.0 - angle)
    left = np.array([-np.sin(yaw), np.cos(yaw)])
    # A point of the path, on the line; the line is a ruler whose zero is nearest to the world's origin.
    past = np.array([np.cos(np.radians(10.0)), np.sin(np.radians(10.0))])
    point = (np.array([3.0, 1.0]) @ past) * past + scene.path_offset * line
    low, high = car.skin_bounds
    edge = (high if side == "left" else low)[1] - 0.4 * (high - low)[1] * (1 if side == "left" else -1)
    # Outermost place of the wall: the axis of an arc and its radius.
    axes = [
        np.array([3.0, 1.0]) + across * past + along * line for across in (0.1, 0.3) for along in (-1.4, 1.4)
    ]
    reach = [axis @ left for axis in axes]
    end = min(reach) - 0.1 if side == "left" else max(reach) + 0.1
    assert point @ left + edge == pytest.approx(end, abs=1e-3)


def test_moved_scene_is_the_same(car: Vehicle) -> None:
    here = crash(car, Barrier.rigid_wall(edge_radius=0.15))
    there = crash(car, Barrier.rigid_wall(edge_radius=0.15, origin=(12.0, -7.0, 0.0), heading=25.0))
    turn = np.radians(25.0)
    back = np.array([[np.cos(turn), np.sin(turn), 0.0], [-np.sin(turn), np.cos(turn), 0.0], [0.0, 0.0, 1.0]])
    assert back @ change(there) == pytest.approx(change(here), rel=1e-4, abs=1e-3)


def test_wall_with_rounded_edges_is_four_metres_wide_unless_told() -> None:
    assert Barrier.rigid_wall(edge_radius=0.15).width == 4.0
    assert Barrier.rigid_wall(edge_radius=0.15, width=2.0).width == 2.0
    assert Barrier.rigid_wall(edge_radius="6 in").edge_radius == pytest.approx(0.1524)
    assert "edges rounded by 0.15 m" in barrier_text(Barrier.rigid_wall(edge_radius=0.15))
    assert "edges" not in barrier_text(Barrier.rigid_wall(width=3.0))
    assert "sharp edges" in barrier_text(Barrier.rigid_wall(width=3.0, edge_radius=0.0))
    assert "sharp edges" in barrier_text(Barrier.planter(edge_radius=0.0))


@pytest.mark.parametrize(
    ("wall", "message"),
    [
        ({"edge_radius": 0.3}, "edge_radius must be >= 0 m and at most half of thickness and width"),
        ({"edge_radius": -0.1}, "edge_radius"),
        (
            {"edge_radius": 0.2, "width": 0.9, "segments": 3},
            "at most half of thickness and the width of a segm",
        ),
    ],
)
def test_edges_that_are_none_are_refused(wall: dict[str, float], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        Barrier.rigid_wall(**wall)


def test_overlaps_that_are_none_are_refused(car: Vehicle) -> None:
    wall = Barrier.rigid_wall(edge_radius=0.15)
    for overlap in (0.0, 1.5, float("nan"), -0.2):
        with pytest.raises(ValueError, match="overlap must be > 0 and <= 1"):
            Simulation(car, wall, SPEED, overlap=overlap)
    with pytest.raises(ValueError, match="overlap_side must be one of left, right"):
        Simulation(car, wall, SPEED, overlap=0.3, overlap_side="top")
    with pytest.raises(ValueError, match="overlap must be None for a barrier without end"):
        Simulation(car, Barrier.rigid_wall(), SPEED, overlap=0.3)
    with pytest.raises(ValueError, match="overlap must be None where there is no barrier"):
        Simulation(car, None, SPEED, overlap=0.3, duration=0.1)
    with pytest.raises(ValueError, match="impact_offset must be 0 where overlap is given"):
        Simulation(car, wall, SPEED, impact_offset=0.1, overlap=0.3)
    with pytest.raises(ValueError, match="impact_yaw must be 0 where overlap is given"):
        Simulation(car, wall, SPEED, impact_yaw=5.0, overlap=0.3)


def test_overlap_can_be_swept_and_survives_a_file(car: Vehicle, tmp_path: Path) -> None:
    wall = Barrier.rigid_wall(edge_radius=0.15)
    base = Simulation(car, wall, SPEED, overlap=0.25, duration=0.02, settings=Settings(tolerance=1e-2))
    table = sweep(base, overlap=[0.2, 0.6], metrics=["delta_v"])
    weak, strong = (float(value) for value in table.to_dataframe()["delta_v"])
    assert strong > weak > 0.0
    result = base.run()
    result.save(tmp_path / "run.npz")
    scene = birm3d.load(tmp_path / "run.npz").scene
    assert (scene.overlap, scene.overlap_side, scene.barrier.edge_radius) == (0.25, "left", 0.15)
    assert dataclasses.replace(scene, overlap=None).path_offset == 0.0


def test_scene_file_and_page(tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    path.write_text(
        "[vehicle]\npreset = 'minivan'\nmesh_density = 0.5\n"
        "[barrier]\nkind = 'rigid_wall'\nedge_radius_m = 0.15\n"
        "[impact]\nspeed = '40 mph'\noverlap = 0.3\noverlap_side = 'right'\nduration = '10 ms'\n",
        encoding="utf-8",
    )
    simulation = read_scene_file(path)
    assert (simulation.scene.overlap, simulation.scene.overlap_side) == (0.3, "right")
    page = tmp_path / "page.html"
    simulation.run().write_html(page)
    assert "30 % of the width, right side" in page.read_text(encoding="utf-8")


def test_command_line(command: Callable[..., int], capsys: pytest.CaptureFixture[str]) -> None:
    options = [
        "run",
        "--vehicle",
        "minivan",
        "--mesh-density",
        "0.5",
        "--speed",
        "40mph",
        "--duration",
        "5ms",
    ]
    assert command(*options, "--edge-radius", "0.15", "--overlap", "0.3") == 0
    assert "30 % overlap on the left" in " ".join(capsys.readouterr().out.split())
    assert command(*options, "--overlap", "0.3") == 2
    assert "overlap must be None" in capsys.readouterr().err


@pytest.mark.parametrize("name", ["passenger_car", "pickup"])
@pytest.mark.parametrize("overlap", [0.05, 0.15, 0.25, 0.5])
def test_energy_closes_at_every_overlap(name: str, overlap: float) -> None:
    """Skin before the wall's face is held by that and not by the edge: else the edge releases it in rebound.

    The tolerance is a tenth of what a warning is given for. Before, half of the width opened 0.26 %.
    """
    car = Vehicle.preset(name, mesh_density=0.3)
    wall = Barrier.rigid_wall(width=4.0, height=1.5, edge_radius=0.15)
    result = Simulation(car, wall, units.km_h(64.4), overlap=overlap, overlap_side="left", duration=0.2).run()
    assert result.metrics["energy_residual"] < 5e-4


@pytest.mark.filterwarnings("ignore::birm3d.CoreContactWarning")
@pytest.mark.parametrize(
    ("name", "mesh", "width", "thickness", "speed", "angle", "offset", "yaw"),
    [
        pytest.param("passenger_car", 0.2, 0.58, 0.76, 11.5, 12.0, -0.49, -139.8, id="narrow, yawed car"),
        pytest.param("cargo_truck", 0.3, 0.72, 0.78, 26.2, 90.0, -0.65, 0.0, id="narrow, truck"),
        pytest.param("passenger_car", 0.3, 3.49, 0.14, 28.0, 53.1, -1.55, -5.6, id="wide, oblique"),
        pytest.param("minivan", 0.3, 0.82, 0.61, 34.3, 76.0, 0.13, 0.0, id="narrow, fast"),
    ],
)
def test_energy_closes_at_narrow_walls_and_corners(
    name: str,
    mesh: float,
    width: float,
    thickness: float,
    speed: float,
    angle: float,
    offset: float,
    yaw: float,
) -> None:
    """Both edges come before the panel, or a corner leads: 0.7 to 3.6 % were lost as a side drove the skin.

    The limit is that of sharp edges: 0.25 % at the most in 600 random scenes.
    """
    wall = Barrier.rigid_wall(width=width, thickness=thickness, height=1.5, edge_radius=0.05)
    car = Vehicle.preset(name, mesh_density=mesh)
    result = Simulation(car, wall, speed, angle, offset, impact_yaw=yaw, duration=0.5).run()
    assert result.metrics["energy_residual"] < 2.5e-3


def test_edges_are_rounded_unless_told_otherwise() -> None:
    """By 0.05 m, or half of what is thinner; there are none where the wall has no end."""
    assert Barrier.rigid_wall(width=3.0).rounding == Barrier.planter().rounding == 0.05
    assert Barrier.rigid_wall(width=3.0, segments=2).rounding == 0.05
    assert Barrier.rigid_wall(width=3.0, thickness=0.08).rounding == 0.04
    assert Barrier.planter(length=0.06).rounding == 0.03
    for wall in (
        Barrier.rigid_wall(),
        Barrier.rigid_wall(height=1.0),
        Barrier.rigid_wall(width=3.0, edge_radius=0.0),
        Barrier.planter(edge_radius=0.0),
    ):
        assert wall.rounding == 0.0
    with pytest.raises(ValueError, match=r"edge_radius must be >= 0 m and at most half of width and length"):
        Barrier.planter(length=2.0, width=0.4, edge_radius=0.3)


def test_the_usual_radius_follows_a_change_of_the_barrier(car: Vehicle) -> None:
    """A study may make the wall thinner, give it segments, or an end."""
    wall = Simulation(car, Barrier.rigid_wall(width=3.0), 10.0)
    assert varied(wall, {"barrier.thickness": 0.08}).scene.barrier.rounding == 0.04
    assert varied(wall, {"barrier.segments": 3}).scene.barrier.rounding == 0.05
    endless = Simulation(car, Barrier.rigid_wall(), 10.0)
    assert varied(endless, {"barrier.width": 3.0}).scene.barrier.rounding == 0.05
    assert dataclasses.replace(Barrier.planter(), width=0.06).rounding == 0.03


def test_segments_of_a_rounded_wall_are_the_wall(car: Vehicle) -> None:
    """Each has its loads; their sum is that of the wall in one piece, whose back is cut otherwise."""
    one, three = (
        crash(car, Barrier.rigid_wall(width=4.0, height=1.2, segments=count), overlap=0.6) for count in (1, 3)
    )
    np.testing.assert_allclose(three.barrier_force, one.barrier_force, rtol=0.0, atol=1.0)
    loads = [load.force for load in three.element_loads]
    assert [load.name for load in three.element_loads] == ["segment 1", "segment 2", "segment 3"]
    np.testing.assert_allclose(sum(loads), -three.barrier_force, rtol=0.0, atol=1e-3)
    assert abs(loads[0]).max() > 1e4


def test_plans_of_segments_fill_the_plan_of_the_wall() -> None:
    wall = Barrier.rigid_wall(width=3.0, thickness=0.4, height=1.0, edge_radius=0.1, segments=4)
    surfaces = wall.surfaces(2.0, (-5.0, 5.0))
    assert len(surfaces) == 4
    whole = shapely.Polygon(wall.outline())
    plans = [shapely.MultiPoint(vertices[:, :2]).convex_hull for vertices, _ in surfaces]
    assert sum(plan.area for plan in plans) == pytest.approx(whole.area, rel=1e-12)
    assert shapely.union_all(plans).symmetric_difference(whole).area < 1e-9


def test_a_planter_is_a_wall_of_its_sizes(car: Vehicle) -> None:
    """To the last bit, with rounded edges too."""
    planter = Barrier.planter(length=1.5, width=0.8, height=0.9)
    wall = Barrier.rigid_wall(width=1.5, thickness=0.8, height=0.9)
    ends = [Simulation(car, barrier, 12.0, 60.0, 0.4, duration=0.1).run() for barrier in (planter, wall)]
    assert ends[0].state_hash == ends[1].state_hash


def test_a_face_without_its_edges_is_the_endless_wall(car: Vehicle) -> None:
    """Where no edge is in reach, the parts behind the face change nothing, and hardly a step is added."""
    finite, endless = (
        Simulation(car, wall, 15.0, duration=0.2).run()
        for wall in (Barrier.rigid_wall(width=6.0, edge_radius=0.05), Barrier.rigid_wall())
    )
    np.testing.assert_allclose(finite.barrier_force, endless.barrier_force, rtol=0.0, atol=1e-3)
    np.testing.assert_allclose(finite.velocity, endless.velocity, rtol=0.0, atol=1e-9)
    assert finite.statistics.steps < 1.2 * endless.statistics.steps


@pytest.mark.parametrize("angle", [30.0, 60.0, 90.0])
def test_a_rounded_corner_spares_the_core(car: Vehicle, angle: float) -> None:
    """At 60 degrees a sharp corner reaches the core and has 2,078 kN; rounded ones have 133 to 142 kN."""
    forces = [
        Simulation(car, Barrier.planter(edge_radius=radius), 12.0, angle, 1.2, duration=0.3).run().metrics
        for radius in (0.03, 0.05, 0.1)
    ]
    assert all(metrics["core_contact_force"] == 0.0 for metrics in forces)
    peaks = [metrics["peak_force_50ms"] for metrics in forces]
    assert max(peaks) < 1.15 * min(peaks)


@pytest.mark.filterwarnings("ignore::birm3d.CoreContactWarning")
def test_a_wall_that_enters_the_side_is_the_same_in_segments() -> None:
    """Its block once threw out the anchors that had passed the edge: 4,000 times the energy.

    In five segments the blocks threw them at each other, which made 18 % of the energy.
    """
    # Held straight: wheels that castor while the car slides sideways follow each quiver of the core.
    pickup = Vehicle.preset("pickup")
    held = dataclasses.replace(pickup.zones["tire"], steering_time=None, camber_ratio=None)
    car = pickup.with_zones({"tire": held})
    places = []
    for segments in (1, 3, 5):
        wall = Barrier.rigid_wall(width=4.0, height=0.8, edge_radius=0.25, segments=segments)
        scene = Simulation(car, wall, 25.6, 166.0, -1.6, impact_yaw=90.0, duration=0.3)
        result = scene.run()
        assert result.statistics.body_steps > 0
        assert result.statistics.steps < 500  # measured: 397
        kinetic, impacts = result.energy["kinetic"], result.energy["impacts"]
        assert kinetic.max() < (1.0 + 1e-6) * kinetic[0]
        assert (np.maximum.accumulate(impacts) - impacts).max() < 1e-4 * kinetic[0]
        assert result.metrics["energy_residual"] < 1e-3
        precise = varied(scene, {"settings.tolerance": 1e-5}).run()
        places.append(precise.position[precise.time >= 0.1][0])
    # Later the wall's end stops the car by its rigid body, which quivers: 1 m/s more or less at 0.3 s.
    np.testing.assert_allclose(places[1:], [places[0], places[0]], rtol=0.0, atol=0.005)
