"""The last states of a dozen scenes, to the bit: changes of layout, names or speed leave each as it is.

A change of physics or of a preset alters the hashes of the scenes that use it. Then run
`python tests/python/test_state_hashes.py`, replace the lines that changed, and say why in the commit.
Where the hash of the kept capsule is one of them, make that anew: `python tests/python/test_state_hashes.py
--keep`.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import birm3d
import pytest
from birm3d import Barrier, Settings, Simulation, Vehicle, scenes
from birm3d.study.verification.triangulated import triangulated

DATA = Path(__file__).parents[1] / "data"
FITTED = DATA / "finite_element"
KEPT = DATA / "kept_run.birm3d"
"""Capsule of a run of :data:`KEPT_SCENE`, as an earlier state of the code wrote it."""
KEPT_SCENE = "coarse car, Jersey"


def car(name: str, density: float = 0.2) -> Vehicle:
    return Vehicle.preset(name, mesh_density=density)


def fitted(name: str) -> Vehicle:
    return Vehicle.from_file(FITTED / f"{name}.toml")


SCENES: dict[str, Callable[[], Simulation]] = {
    "w1": lambda: scenes.w1(),
    "w2": lambda: scenes.w2(1000),
    "paper's pickup at 30 mph": lambda: scenes.paper_table_2(30.0),
    "rolling": lambda: scenes.rolling(),
    "oblique car": lambda: scenes.oblique_car(mesh_density=0.3),
    "paper pickup, bollards": lambda: Simulation(car("paper_pickup"), Barrier.bollards(), 20.0, 80.0, 0.2),
    "pickup, bollards": lambda: Simulation(car("pickup"), Barrier.bollards(), 20.0, 80.0, 0.2),
    "car, Jersey": lambda: Simulation(car("passenger_car"), Barrier.jersey(length=30.0), 25.0, 25.0),
    KEPT_SCENE: lambda: Simulation(
        *(car("passenger_car", 0.05), Barrier.jersey(length=30.0), 25.0, 25.0),
        settings=Settings(output_interval=5e-3),
    ),
    "semi, wall": lambda: Simulation(car("semi_truck"), Barrier.rigid_wall(), 15.0, 15.0, duration=0.5),
    "truck, pole of triangles": lambda: Simulation(
        car("cargo_truck"), triangulated(Barrier.pole()), 12.0, 90.0, duration=0.3
    ),
    "free-standing": lambda: Simulation(
        car("passenger_car"), Barrier.jersey(length=18.0, segments=6, free_standing=True), 20.0, 25.0
    ),
    "minivan on its side": lambda: Simulation(
        car("minivan"),
        Barrier.rigid_wall(width=2.0, height=0.27, edge_radius=0.0),
        15.0,
        90.0,
        impact_roll=90.0,
    ),
    "car, corner of a planter": lambda: Simulation(car("passenger_car"), Barrier.planter(), 12.0, 60.0, 1.2),
    "pickup, end of a wall": lambda: Simulation(
        car("pickup"), Barrier.rigid_wall(width=4.0, height=1.0, segments=2), 17.9, overlap=0.4
    ),
    "truck, bollards that yield": lambda: Simulation(
        car("cargo_truck"),
        Barrier.bollards(count=3, diameter=0.22, wall_thickness=0.012, filling="concrete"),
        *(13.0, 80.0, 0.2),
        duration=0.4,
    ),
    "finite-element car, wall": lambda: Simulation(fitted("fitted_n"), Barrier.rigid_wall(), 10.0, 65.0),
    "finite-element truck, wall": lambda: Simulation(fitted("fitted_truck"), Barrier.rigid_wall(), 8.0),
}
HASHES = {
    "w1": "29183f9152b02fd9",
    "w2": "8c7e455abd3ff793",
    "paper's pickup at 30 mph": "c8d274cd1c275780",
    "rolling": "ce8245a7ba53575f",
    "oblique car": "22fe478f1f699dcd",
    "paper pickup, bollards": "2f038a6a3b55c0df",
    "pickup, bollards": "59c382ac71c6c3c2",
    "car, Jersey": "bacc41c48ece511a",
    "coarse car, Jersey": "2e42e567213f1567",
    "semi, wall": "c3dadea835a541a2",
    "truck, pole of triangles": "9ac309d4adfc792d",
    "free-standing": "1cb96f8c40ac6b3a",
    "minivan on its side": "c5f9a6b069c715be",
    "car, corner of a planter": "56a9bbf48f999260",
    "pickup, end of a wall": "1ea1349ef20dc18e",
    "truck, bollards that yield": "b492ce1f88a1ca77",
    "finite-element car, wall": "5233689c179a6c3c",
    "finite-element truck, wall": "530fc9f34c2d9de8",
}


@pytest.mark.filterwarnings("ignore::birm3d.LeaningPostWarning")
@pytest.mark.parametrize("name", SCENES)
@pytest.mark.filterwarnings("ignore::birm3d.TippingWarning")
def test_bits_of_the_last_state(name: str) -> None:
    assert f"{SCENES[name]().run().state_hash:016x}" == HASHES[name]


def test_no_bit_comes_from_the_processors_linear_algebra() -> None:
    """NumPy's linear algebra rounds differently on each kind of processor; this takes that of an old one."""
    printed = subprocess.run(
        [sys.executable, __file__],
        env=os.environ | {"OPENBLAS_CORETYPE": "Prescott"},
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    assert dict(re.findall(r'"(.+)": "(.+)"', printed)) == HASHES


def test_a_capsule_of_earlier_code_runs_to_the_same_bits() -> None:
    again = birm3d.rerun(KEPT)
    anew = "after a change on purpose: python tests/python/test_state_hashes.py --keep"
    assert f"{again.expected_hash:016x}" == HASHES[KEPT_SCENE], anew
    assert again.same, f"{again.summary()}\n{anew}"


if __name__ == "__main__":
    if "--keep" in sys.argv:
        SCENES[KEPT_SCENE]().run().capsule(KEPT)
        sys.exit()
    for scene, make in SCENES.items():
        print(f'    "{scene}": "{make().run().state_hash:016x}",')
