"""A verdict at a barrier that is lower than most of the front is warned of: a real front may ride over."""

from __future__ import annotations

import warnings
from pathlib import Path

import birm3d
import numpy as np
import pytest
from birm3d import Barrier, LowBarrierWarning, Simulation, Vehicle, units
from birm3d.barrier.kinds import Bollards
from birm3d.vehicle.test_bodies import laboratory_block

TRUCK = Vehicle.preset("cargo_truck", mesh_density=0.3)
SPEED = units.mph(30)
ROW = 0.15  # m, between rows of nodes of this mesh


def low_warnings(sim: Simulation) -> list[str]:
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("ignore")
        warnings.simplefilter("always", LowBarrierWarning)
        sim.run()
    return [str(one.message) for one in told]


def test_the_height_of_a_front_is_found_from_its_stresses() -> None:
    """Recomputed node by node: what the front takes up in its first 0.3 m, below and above the height."""
    for name in ("passenger_car", "pickup", "cargo_truck", "semi_truck"):
        unit = Vehicle.preset(name, mesh_density=0.3).units[0]
        height = unit._strong_height
        assert height is not None
        total, below = 0.0, {-ROW: 0.0, ROW: 0.0}
        depths = np.linspace(0.0, 0.3, 601)
        for i in np.flatnonzero(unit.is_skin):
            inward = unit.anchors[i] - unit.nodes[i]
            if not -inward[0] >= abs(inward[1:]).max():
                continue
            curve = unit.zones[list(unit.zones)[unit.zone_of_node[i]]].curve
            work = unit.area[i] * np.trapezoid([curve.envelope(d) for d in depths], depths)
            total += work
            for way in below:
                below[way] += work * (unit.nodes[i, 2] + unit.mass_center_height < height + way)
        assert below[-ROW] < 2.0 / 3.0 * total < below[ROW]


@pytest.mark.parametrize(
    ("barrier", "warned"),
    [
        (Barrier.bollards(count=3, height=0.5), True),
        (Barrier.bollards(count=3, height=0.9), False),
        (Barrier.rigid_wall(height=0.5), True),
        (Barrier.rigid_wall(), False),
        (Barrier.planter(length=4.0, width=1.0, height=0.5), True),
        (Barrier.bollards(count=3, height=0.2), False),  # driven over, and so the outcome says
    ],
)
def test_low_barriers_that_contain_are_warned_of(barrier: Barrier, warned: bool) -> None:
    told = low_warnings(Simulation(TRUCK, barrier, SPEED))
    assert len(told) == warned
    if warned:
        assert "height must be at least 0.78 m" in told[0]
        assert "more than a third of the front's resistance (Cargo truck) stands above" in told[0]


@pytest.mark.parametrize("scene", [{"impact_yaw": 90.0}, {"impact_roll": 180.0}])
def test_only_fronts_that_come_first_are_judged(scene: dict[str, float]) -> None:
    wall = Barrier.rigid_wall(height=0.5)
    assert low_warnings(Simulation(TRUCK, wall, 8.0, **{"impact_angle": 90.0, **scene})) == []


def test_a_low_wall_that_redirects_is_warned_of_too() -> None:
    """At 70 km/h and 15 degrees a wall of 0.46 m passed EN 1317 with a 10-t truck, without a word."""
    truck = Vehicle.preset("mash_10000s")
    told = low_warnings(Simulation(truck, Barrier.rigid_wall(height=0.5), units.km_h(70), 15.0))
    assert len(told) == 1
    assert "height must be at least 0.72 m" in told[0]


def test_a_barrier_on_a_step_is_as_high_as_it_stands() -> None:
    """Heights count from the ground, not from the barrier's foot."""
    low = Barrier.bollards(count=3, height=0.5)
    assert low_warnings(Simulation(TRUCK, low, SPEED))
    stands = Barrier.bollards(count=3, height=0.5, origin=(0.0, 0.0, 0.4))
    assert low_warnings(Simulation(TRUCK, stands, SPEED)) == []


def test_vehicles_from_arrays_have_no_zones_to_judge() -> None:
    block = laboratory_block(24, k_initial=1e6, k_unloading=1e7)
    assert block._strong_height is None


@pytest.mark.filterwarnings("ignore::birm3d.LowBarrierWarning")
def test_verdicts_loads_and_reports_say_it() -> None:
    truck = Vehicle.preset("cargo_truck")
    result = Simulation(truck, Barrier.bollards(count=3, height=0.6), units.mph(50)).run()
    said = "A third of the front's resistance stands above 0.69 m."
    assert said in birm3d.rate(result, "ASTM F2656").caution
    assert said in result.report()
    high = Simulation(truck, Barrier.bollards(count=3), units.mph(50)).run()
    assert "The barrier ends" not in birm3d.rate(high, "ASTM F2656").caution + high.report()
    loads = birm3d.design_load(Simulation(TRUCK, Barrier.bollards(count=1, height=0.5), SPEED))
    assert "The barrier ends 0.50 m above the ground" in loads.caution


def test_studies_name_their_rows() -> None:
    crash = Simulation(TRUCK, Barrier.bollards(count=3), SPEED)
    with pytest.warns(LowBarrierWarning, match=r"may ride over it \(row 0\)"):
        birm3d.sweep(crash, {"barrier.height": [0.5, 1.0]}, metrics=["max_pitch"])


def test_the_search_for_a_height_tells_where_to_stop() -> None:
    crash = Simulation(TRUCK, Barrier.bollards(count=1), SPEED)
    with warnings.catch_warnings():
        warnings.simplefilter("error", LowBarrierWarning)
        found = birm3d.least_height(crash, (0.3, 1.0), points=3, resolution=0.2, offsets=[0.0], draws=0)
    assert "do not go below 0.78 m" in found.caution
    assert "The barrier does not give way under it." in found.caution


@pytest.mark.filterwarnings("ignore")  # of weak barriers that are tried on purpose
@pytest.mark.parametrize(
    ("barrier", "told"),
    [
        (Barrier.bollards(count=1, wall_thickness=0.03), "Posts that yield lean, and are lower then"),
        (Barrier.jersey(length=12.0, segments=4, free_standing=True), "Segments slide under it"),
    ],
)
def test_the_search_for_a_height_says_how_the_barrier_gives_way(barrier: Barrier, told: str) -> None:
    """Tubes that yield were said not to give way."""
    angle = 90.0 if isinstance(barrier, Bollards) else 20.0
    crash = Simulation(TRUCK, barrier, 8.0, angle)
    found = birm3d.least_height(crash, (0.8, 1.0), points=2, resolution=0.2, offsets=[0.0], draws=0)
    assert told in found.caution
    assert "does not give way" not in found.caution


def test_the_validation_page_has_the_heights_of_fronts() -> None:
    page = Path(__file__).resolve().parents[2] / "docs/pages/validation.md"
    text = " ".join(page.read_text(encoding="utf-8").split())
    for name in ("cargo_truck", "pickup", "van_3500", "passenger_car"):
        height = Vehicle.preset(name).units[0]._strong_height
        assert f"{height:.2f} m for `{name}`" in text


@pytest.mark.parametrize(
    "barrier",
    [
        Barrier.rigid_wall(width=4.0, height=0.8, heading=30.0),
        Barrier.rigid_wall(width=4.0, height=0.6, edge_radius=0.0, origin=(1.0, 2.0, 0.3)),
        Barrier.bollards(count=3, height=0.7),
        Barrier.bollards(count=2, height=0.9, wall_thickness=0.016),
        Barrier.jersey(profile="f_shape", length=6.0),
        Barrier.planter(height=0.75),
    ],
    ids=lambda barrier: barrier.text,
)
def test_the_top_is_that_of_what_is_drawn(barrier: Barrier) -> None:
    surfaces = barrier.surfaces(100.0, (-1.0, 1.0))
    assert barrier._top == pytest.approx(max(float(points[:, 2].max()) for points, _ in surfaces), abs=1e-12)
