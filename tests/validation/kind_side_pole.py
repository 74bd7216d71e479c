"""Rigid poles into the side: NHTSA's oblique pole tests, and a pickup broadside."""

from __future__ import annotations

from collections.abc import Sequence

import birm3d
import fit_sides
from birm3d import units
from birm3d.reference import nhtsa_tests
from comparison import Row, about, facts
from stand_in import name_of, stand_in

NAME = "side_pole"
TITLE = "Rigid pole into the side"
TEXT = """Vehicles: NHTSA as in `tests/validation/fit_sides.py`, the preset of the class, scaled to the mass
of the test; the broadside pickup by `with_gvw`, aimed at its mass centre. Marks: 15 % in crush, one standard
deviation of 15 cars (pickups scatter by twice that); 20 % in load and occupant risk of the one broadside
test.

What the model can not do here: one truss law stands for sill, cross members and frame. So the
result does not depend on whether the pole meets the frame. One crush is measured, at one
speed: force and history are not."""

CRUSH, LOAD = 0.15, 0.20


def tasks() -> Sequence[str]:
    """Numbers of NHTSA tests, then the broadside pickup."""
    return [*(test.test for split in ("CALIBRATE", "EXTRA") for test in fit_sides.rows(split)), "broadside"]


def rows(task: str) -> list[Row]:
    """What one task is compared in."""
    if task == "broadside":
        return _broadside()
    test = nhtsa_tests()[task]
    result = fit_sides.scene(test, 1.0).run()
    assert test.static_crush is not None  # the table has it of every pole test
    return [
        Row(
            f"NHTSA {task}, {test.make} {test.model} {test.year}",
            name_of(result.scene.vehicle),
            "static crush",
            "m",
            test.static_crush,
            *about(test.static_crush, CRUSH),
            float(result.metrics["residual_crush"]),
            "fitted" if test.split == "CALIBRATE" else "predicted",
        )
    ]


def broadside() -> birm3d.Simulation:
    """The pickup of FHWA's test, its side at the pole."""
    pole = birm3d.Barrier.pole(diameter=fit_sides.POLE)
    return birm3d.Simulation(stand_in("pickup", 2000.0), pole, units.km_h(52.8), impact_yaw=-90.0)


def _broadside() -> list[Row]:
    result = broadside().run()
    risk = birm3d.occupant_risk(result)
    predicted = (float(result.metrics["peak_normal_force_cfc60"]), risk.oiv_y, risk.ridedown_y)
    return [
        Row(
            "FOIL C2500 broadside",
            name_of(result.scene.vehicle),
            fact["quantity"],
            fact["unit"],
            float(fact["value"]),
            *about(float(fact["value"]), LOAD),
            value,
        )
        for fact, value in zip(facts("broadside_pole"), predicted, strict=True)
    ]
