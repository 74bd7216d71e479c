"""Lateral design loads of bridge rails, beside the loads of the vehicles that they are designed for."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import birm3d
from birm3d import units
from comparison import Row, about, facts
from stand_in import name_of, stand_in

NAME = "lateral_load"
TITLE = "Lateral design loads of rails"
TEXT = """AASHTO's bridge specifications give each test level (TL-1 and up) a sideways design force for rails.
Vehicles: the stand-in of the class with the mass of the level's design vehicle, at a rigid
vertical wall of the least height of the table. Compared: greatest mean force over 50 ms, and the height of
its resultant, with the design force and its effective height. Marks: 25 % in force (a later proposal for
the same vehicle is 1.3 times AASHTO's), 0.15 m in height. A design value is no measurement: it bounds
tests, and a rigid wall should give at least AASHTO's. AASHTO's heights of TL-4 and TL-5 equal the
rail's top, above any possible resultant on a wall of that height. Proposals of NCHRP 22-20(2) for the
vehicles of MASH are shown as commonly reported. Their source is not at hand, and they are not judged.

At 0.91 m the front of the 10-t truck acts lower than its rear, which strikes 0.15 s later. The greater of the
two forces is compared, at its own height.

What the model can not do here: the load of a truck shifts towards the wall. Frame, floor and load are one
rigid body, so that they strike together, each with its own zone's law."""

FORCE, HEIGHT = 0.25, 0.15


def tasks() -> Sequence[str]:
    """Test levels."""
    return [fact["level"] for fact in facts("lateral_design_loads")]


def simulation(fact: Mapping[str, str]) -> birm3d.Simulation:
    """The design impact of a level."""
    vehicle = stand_in(fact["vehicle"], float(fact["mass_kg"]))
    wall = birm3d.Barrier.rigid_wall(height=float(fact["wall_height_m"]))
    return birm3d.Simulation(vehicle, wall, units.km_h(float(fact["speed_km_h"])), float(fact["angle_deg"]))


def rows(task: str) -> list[Row]:
    """What one task is compared in."""
    (fact,) = (fact for fact in facts("lateral_design_loads") if fact["level"] == task)
    result = simulation(fact).run()
    who, force = name_of(result.scene.vehicle), 1e3 * float(fact["force_kN"])
    own = float(result.metrics["peak_force_50ms"])
    judged = fact["status"] != "source not at hand"
    found = [Row(task, who, "force over 50 ms", "N", force, *about(force, FORCE), own, judged=judged)]
    if fact["height_m"]:
        height = float(fact["height_m"])
        at = float(result.element_loads[0].height_at_peak)
        marks = height - HEIGHT, height + HEIGHT
        found.append(Row(task, who, "height of the force", "m", height, *marks, at, judged=judged))
    return found
