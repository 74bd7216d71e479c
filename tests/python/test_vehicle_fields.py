"""What dataclasses.replace() gives a vehicle is an array or number of its field, or refused by name."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest
from birm3d import Barrier, Simulation, Vehicle, scenes
from test_messages import FOREIGN, WRONG

CAR = Vehicle.preset("passenger_car", mesh_density=0.1)
SEMI = Vehicle.preset("semi_truck", mesh_density=0.1)
BLOCK = scenes.w2(20).scene.vehicle
FIELDS = [field.name for field in dataclasses.fields(Vehicle) if not field.name.startswith("_")]
OTHERS: dict[str, Any] = {
    **WRONG,
    "array (0, 3)": np.zeros((0, 3)),
    "array (0, 4)": np.zeros((0, 4)),
    "99 for each node": np.full(CAR.n_nodes, 99),
    "halves": np.full(CAR.n_nodes, 0.5),
    "ragged list": [[1.0], [2.0, 3.0]],
}
KEPT = {"name": {"text"}, "quads": {"array (0, 4)"}, "area": {"99 for each node", "halves"}}
# An empty list says that there are no tyres, second trusses or zones of wheels.
KEPT |= {name: {"empty list"} for name in ("wheel_of_node", "along_of_node", "zone_of_wheel")}


@pytest.mark.parametrize("field", FIELDS)
def test_a_wrong_field_is_refused_in_own_words(field: str) -> None:
    for label, value in OTHERS.items():
        if label in KEPT.get(field, ()):
            dataclasses.replace(CAR, **{field: value})
            continue
        with pytest.raises(ValueError) as told:  # noqa: PT011
            dataclasses.replace(CAR, **{field: value})
        assert not FOREIGN.search(str(told.value)), (label, str(told.value))
        assert field in str(told.value) or "must be" in str(told.value), (label, str(told.value))


@pytest.mark.parametrize("vehicle", [SEMI, BLOCK], ids=["semi", "block"])
@pytest.mark.parametrize("field", FIELDS)
def test_other_vehicles_never_speak_in_words_of_a_library(vehicle: Vehicle, field: str) -> None:
    for label, value in OTHERS.items():
        try:
            dataclasses.replace(vehicle, **{field: value})
        except ValueError as error:
            assert not FOREIGN.search(str(error)), (label, str(error))  # noqa: PT017


def test_a_vehicle_of_tyres_needs_its_wheels() -> None:
    with pytest.raises(ValueError, match="zone_of_wheel must have a number for each of the wheels, 0; got 4"):
        dataclasses.replace(CAR, wheels=np.empty((0, 4)))
    with pytest.raises(ValueError, match="wheels shape must be"):
        dataclasses.replace(CAR, wheels=())
    n = len(CAR.zones)
    with pytest.raises(ValueError, match=f"zone_of_wheel must be < {n}, the number of zones; got {n}"):
        dataclasses.replace(CAR, zone_of_wheel=np.full(4, n))
    with pytest.raises(ValueError, match="zones must be a mapping of names to zones, got 'abc'"):
        dataclasses.replace(CAR, zones="abc")


def test_lists_and_other_floats_become_arrays() -> None:
    given = dataclasses.replace(
        CAR, wheels=CAR.wheels.tolist(), area=CAR.area.tolist(), zone_of_node=CAR.zone_of_node.tolist()
    )
    assert given == CAR
    assert not given.wheels.flags.writeable
    assert given.zone_of_node.dtype == np.int64
    runs = [Simulation(vehicle, Barrier.rigid_wall(), 10.0).run() for vehicle in (CAR, given)]
    assert runs[0].state_hash == runs[1].state_hash
    assert dataclasses.replace(CAR, inertia=CAR.inertia.astype(np.float32)).inertia.dtype == np.float64
