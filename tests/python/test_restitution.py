"""Restitution of the presets at a rigid wall, against speed."""

from __future__ import annotations

import numpy as np
import pytest
from birm3d import Barrier, CoreContactWarning, Simulation, Vehicle
from birm3d.reference import nhtsa_tests
from birm3d.vehicle.vehicle_file import read_vehicle_file, unit_paths

CARS = ("passenger_car", "minivan", "pickup")
PRESETS = (*CARS, "cargo_truck", "semi_truck")
SPEEDS = (3.0, *np.arange(4.0, 15.5), 15.9, *np.arange(17.0, 25.5))  # m/s
RISE = 0.005  # where an engine or a pitching load comes in; tests tell restitution to 0.01


def restitution(vehicle: Vehicle, speed: float) -> float:
    return Simulation(vehicle, Barrier.rigid_wall(), speed).run().metrics["restitution"]


# The paper's pickup keeps Fig. 3's single slope of unloading, with which restitution is nearly constant.
@pytest.mark.parametrize("name", [name for name in Vehicle.presets() if name != "paper_pickup"])
def test_restitution_falls_with_speed(name: str) -> None:
    vehicle = Vehicle.preset(name)
    found = np.array([restitution(vehicle, speed) for speed in SPEEDS])
    assert (found - np.minimum.accumulate(found) <= RISE).all()
    for speed in (2.0, 2.5, 3.0):  # car-to-car tests: 0.38 at a closing speed of 2.2 m/s
        assert 0.35 <= restitution(vehicle, speed) <= 0.50
    assert 0.10 <= found[SPEEDS.index(15.9)] <= 0.22  # NHTSA test 10146: 0.17 and 0.20
    assert 0.375 <= found[0] < 0.475  # the page of validation has these ranges
    assert 0.065 <= found[-1] < 0.155


@pytest.mark.parametrize("name", unit_paths())
def test_every_zone_has_a_recovery_and_those_of_front_side_and_rear_a_tail(name: str) -> None:
    file = read_vehicle_file(unit_paths()[name])
    for zone in file.zones:
        tire = zone.panels == ("tire",)
        assert (zone.law.elastic_recovery is not None) == (not tire and name != "paper_pickup")
        upright = {"front", "side", "rear"} & set(zone.panels)
        assert (zone.law.tail_depth is not None) == (bool(upright) and name != "paper_pickup")


@pytest.mark.parametrize("name", [*PRESETS, "van_3500"])
def test_the_core_is_not_met_head_on(name: str) -> None:
    """At 25 m/s, which is two and a half times the energy of the fastest test that was fitted."""
    assert {test.speed < 16.0 for test in nhtsa_tests().values()} == {True}
    result = Simulation(Vehicle.preset(name), Barrier.rigid_wall(), 25.0).run()
    assert result.statistics.body_steps == 0


def test_a_zone_with_a_new_law_has_no_recovery_but_that_which_is_given() -> None:
    car = Vehicle.preset("passenger_car", mesh_density=0.1)
    fig_3 = {"k_initial": 1e6, "knee": 0.1, "k_hardening": 2e6, "k_unloading": 7e6}
    for zone in ("bumper", "rear"):
        law = car.with_zone(zone, **fig_3).zones[zone]
        assert law.elastic_recovery is None
        assert law.tail_depth is None
    assert car.with_zone("rear", **fig_3, elastic_recovery=0.02).zones["rear"].elastic_recovery == 0.02
    assert car.with_zone("rear", k_unloading=9e6).zones["rear"].tail_depth is not None  # one number changes


def test_the_report_says_that_the_core_was_met() -> None:
    """At a pole a 33-t truck at 80 km/h has nothing left to crush."""
    truck = Vehicle.preset("semi_truck", mesh_density=0.3)
    with pytest.warns(CoreContactWarning, match="core_contact_force must be at most 320 kN"):
        met = Simulation(truck, Barrier.pole(), 22.35, duration=0.4).run().report()
    assert "the rigid core was met between trusses in" in met
    pickup = Vehicle.preset("paper_pickup", mesh_density=0.3)
    with pytest.warns(CoreContactWarning):
        met = Simulation(pickup, Barrier.pole(), 40.0, duration=0.4).run().report()
    assert "the rigid core was met behind bottomed-out trusses (" in met
    assert "of 'bumper'" in met
    wall = Simulation(truck, Barrier.rigid_wall(), 15.0, duration=0.2).run().report()
    assert "rigid core was met" not in wall
