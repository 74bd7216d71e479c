"""Posts beside the middle: what they do not touch does nothing, and nothing jumps from place to place."""

from __future__ import annotations

import numpy as np
import pytest
from birm3d import Barrier, Result, Simulation, Vehicle, units


def at_post(name: str, offset: float, diameter: float, speed: float, density: float = 0.5) -> Result:
    post = Barrier.bollards(count=1, diameter=diameter, height=1.2, origin=(0.0, offset, 0.0))
    return Simulation(Vehicle.preset(name, mesh_density=density), post, speed).run()


def lost_speed(result: Result) -> float:
    """Change of velocity by the barrier, forward [m/s]."""
    interval = result.scene.settings.output_interval
    return float(-result.barrier_force[1:, 0].sum() * interval / result.scene.vehicle.mass)


def test_a_post_that_misses_the_bumper_does_not_crush_the_front() -> None:
    """The bumper ends at 1.00 m, the body at 1.22 m. The inner edge of the post goes from 1.12 to 1.05 m."""
    inner_edges = (1.12, 1.1, 1.08, 1.05)
    lost = [lost_speed(at_post("cargo_truck", edge + 0.15, 0.3, 15.6, 1.0)) for edge in inner_edges]
    assert lost == sorted(lost)
    assert lost[-1] < 1.0


def test_a_post_off_the_middle_does_not_meet_the_anchors_of_trusses_beside_it() -> None:
    """At 0.4 of the half width it stands where the fender's trusses are anchored. It meets none of these."""
    peaks = []
    for share in (0.0, 0.2, 0.3, 0.4, 0.5, 0.6):
        result = at_post("mash_2270p", 0.99 * share, 0.3, 21.0)
        assert result.metrics["core_contact_force"] == 0.0
        peaks.append(result.metrics["peak_normal_force_cfc60"])
    assert peaks == pytest.approx(np.full(len(peaks), np.mean(peaks)), rel=0.1)


def test_a_pole_in_a_door_does_not_meet_the_anchors_of_the_front() -> None:
    car = Vehicle.preset("passenger_car", mesh_density=0.5)
    peaks = []
    for ahead in (0.0, 0.12, 0.24, 0.36, 0.48):
        result = Simulation(car, Barrier.pole(diameter=0.254), 8.9, 90.0, ahead, impact_yaw=-90.0).run()
        assert result.metrics["core_contact_force"] == 0.0
        peaks.append(result.metrics["peak_normal_force_cfc60"])
    assert max(peaks) < 1.1 * peaks[0]


@pytest.mark.parametrize("name", ["cargo_truck", "mash_2270p"])
def test_a_post_thinner_than_the_mesh_is_felt_wherever_it_stands(name: str) -> None:
    """The vehicle is placed before the post, not beyond it: between columns of nodes a post touches none."""
    offsets = np.linspace(0.2, 0.4, 11)
    lost = np.array([lost_speed(at_post(name, float(at), 0.05, 15.6)) for at in offsets])
    assert lost.min() > 12.0
    assert np.abs(np.diff(lost)).max() < 1.0


@pytest.mark.parametrize(("name", "speed"), [("minivan", 25.0), ("mash_1100c", 22.4), ("cargo_truck", 8.2)])
def test_a_run_does_not_end_while_the_vehicle_tilts_further(name: str, speed: float) -> None:
    scene = Simulation(Vehicle.preset(name, mesh_density=0.5), Barrier.rigid_wall(), speed)
    longer = Simulation(scene.scene.vehicle, Barrier.rigid_wall(), speed, duration=1.0)
    by_itself, with_time = (one.run().metrics["max_pitch"] for one in (scene, longer))
    assert by_itself == pytest.approx(with_time, abs=0.1)


@pytest.mark.parametrize(("name", "gap"), [("small_car", 1.418), ("small_car", 1.40), ("cargo_truck", 2.03)])
def test_posts_that_the_vehicle_has_passed_hold_it_no_more(name: str, gap: float) -> None:
    """Scraping through between two posts: its panels follow no post that is behind all of their depth."""
    vehicle = Vehicle.preset(name)
    barrier = Barrier.bollards(count=2, spacing=gap + 0.32, diameter=0.32)
    result = Simulation(vehicle, barrier, units.mph(30)).run()
    force = np.linalg.norm(result.barrier_force, axis=1)
    behind = result.position[:, 0] > 0.6 * vehicle.length  # the mass centre: the rear is past the posts, too
    assert force.max() > 5e3
    assert behind.any()
    assert force[behind].max() == 0.0
    assert result.outcome == "passed"
