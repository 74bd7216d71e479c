"""Measured curves and scalars to hold a result against."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources
from types import MappingProxyType
from typing import Literal

import numpy as np
import numpy.typing as npt

__all__ = ["NhtsaTest", "nhtsa_10146", "nhtsa_tests"]

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True)
class NhtsaTest:
    """A row of ``data/nhtsa_tests.csv``, whose head gives the sources; SI.

    Attributes
    ----------
    test
        Number in the NHTSA vehicle crash test database.
    kind
        ``"frontal"``: rigid wall, head-on, full width. ``"side_pole"``: rigid pole of 254 mm into the left
        side beside the front seat, 75 deg from the direction of travel.
    vehicle_class
        ``"car"``, ``"minivan"``, ``"suv"``, ``"pickup_half_ton"``, ...
    make, model, year
        Of the vehicle.
    mass, speed
        As tested [kg], [m/s].
    length, width, wheelbase, cg_behind_front_axle
        [m].
    static_crush
        Greatest, after the test [m]; ``None``: not measured.
    dynamic_displacement
        Greatest displacement of the compartment towards the wall [m]; ``None``: not measured.
    quality
        Of the pulse: ``"A"`` two channels, ``"B"`` one, ``"C"`` not to be used, ``"N"`` none.
    split
        ``"CALIBRATE"``: zones of the presets are fitted to it; ``"EXTRA"``: predicted.
    """

    test: str
    kind: Literal["frontal", "side_pole"]
    vehicle_class: str
    make: str
    model: str
    year: int
    mass: float
    speed: float
    length: float
    width: float
    wheelbase: float
    cg_behind_front_axle: float
    static_crush: float | None
    dynamic_displacement: float | None
    quality: Literal["A", "B", "C", "N"]
    split: Literal["CALIBRATE", "EXTRA"]


def _rows(name: str) -> list[list[str]]:
    file = resources.files("birm3d") / "data" / name
    lines = file.read_text(encoding="utf-8").splitlines()
    return list(csv.reader(line for line in lines if not line.startswith("#")))


@cache
def nhtsa_tests() -> Mapping[str, NhtsaTest]:
    """Return the barrier tests of light vehicles, by their numbers: 49 frontal ones and 38 side poles.

    The compartment's displacement is not that of the momentum centre, which a vehicle of one rigid body has.
    In test 10146, the only one with wall forces, they are 0.741 and 0.677 m. Where there is no wall force the
    compartment's is what there is.
    """
    head, *rows = _rows("nhtsa_tests.csv")
    tests = {}
    for row in rows:
        cell = dict(zip(head, row, strict=True))
        tests[cell["test"]] = NhtsaTest(
            test=cell["test"],
            kind="frontal" if cell["kind"] == "frontal" else "side_pole",
            vehicle_class=cell["vehicle_class"],
            make=cell["make"],
            model=cell["model"],
            year=int(cell["year"]),
            mass=float(cell["mass_kg"]),
            speed=float(cell["speed_m_s"]),
            length=float(cell["length_m"]),
            width=float(cell["width_m"]),
            wheelbase=float(cell["wheelbase_m"]),
            cg_behind_front_axle=float(cell["cg_behind_front_axle_m"]),
            static_crush=_optional(cell["static_crush_m"]),
            dynamic_displacement=_optional(cell["dynamic_displacement_m"]),
            quality=cell["quality"],  # type: ignore[arg-type]  # one of the four, see the tests
            split=cell["split"],  # type: ignore[arg-type]
        )
    return MappingProxyType(tests)


def _optional(cell: str) -> float | None:
    return float(cell) if cell else None


def nhtsa_10146() -> dict[str, Floats]:
    """Return the curves of NHTSA test 10146, one row a millisecond.

    A 2018 Toyota Camry of 1,719 kg at 57.09 km/h into a rigid load-cell wall (NHTSA vehicle crash test
    database; a work of the United States government). The scene is :func:`birm3d.scenes.nhtsa_10146`.

    The motion is that of the momentum centre: the wall force, integrated over the mass. This is the signal
    that a vehicle of one rigid body owns. The accelerometers in the compartment show another one, as engine
    and cabin do not move as one body. The engine stops after 38 ms and 0.46 m while the cabin goes on to 0.74
    m. The wall force over that distance makes 15 % more work than there was energy.

    Returns
    -------
    dict of ndarray, shape (n,), read-only
        ``time`` since the first touch [s]; ``wall_force``, sum of 176 load cells, SAE J211 CFC 60 [N];
        ``velocity`` [m/s] and ``displacement`` [m] of the momentum centre towards the wall.
    """
    rows = _rows("nhtsa_10146.csv")
    names = {
        "time_s": "time",
        "wall_force_N": "wall_force",
        "velocity_m_s": "velocity",
        "displacement_m": "displacement",
    }
    table = np.array(rows[1:], float)
    table.setflags(write=False)
    return {names[head]: table[:, i] for i, head in enumerate(rows[0])}
