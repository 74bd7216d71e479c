"""Trucks head-on at bollards and walls: penetration, containment, pitch."""

from __future__ import annotations

from collections.abc import Sequence

import birm3d
from birm3d import scenes, units
from comparison import Row, facts
from stand_in import name_of, stand_in

NAME = "security"
TITLE = "Trucks at bollards and walls, head-on"
TEXT = """Vehicles: the stand-in for a truck of the test's mass; pitch rows are
`birm3d.scenes.truck_at_wall` and `truck_at_bollards`. Rigid posts. Penetration: of the load bed's leading
lower edge, as `birm3d.rate` has it by ASTM F2656; a limit is met at or below it. A negative
reading is before the rear face. Contained: 1, else 0.

Left out: MIL-8IN-B and -C and JERSEY-4000 (their foundations or sections failed; posts of this table are
rigid),
TT203, TT210, DSC7000 and RSA-SM (no size of what was hit was found).

Posts are rigid here, although the program can let them yield: no foundation's moment is published. In
DSC635 post and foundation moved. So these rows are checks. "With a sliding bed" is `cargo_truck` by
`with_sliding_bed()`: its fixings hold 17 times the weight of bed and load. At these posts it slides by
0.2 to 0.3 m, and the reading stays 2.2 to 2.4 m below the limits, which are met for the wrong reason.
"Weak fixings" hold a
quarter of that. The bed then slides by metres, further than a frame carries it, and the truck tips
over its nose: these rows show a trend only."""

BED = "load_bed_leading_edge"
PENETRATION_BELOW = -20.0  # m: what is short of the barrier meets an upper limit


def tasks() -> Sequence[str]:
    """Tests with a penetration, then those with other figures."""
    return [*(fact["test"] for fact in facts("security_barriers")), *_OTHERS]


def rows(task: str) -> list[Row]:
    """What one task is compared in."""
    if task in _OTHERS:
        return _other(task)
    (fact,) = (fact for fact in facts("security_barriers") if fact["test"] == task)
    truck, most = stand_in("truck", float(fact["mass_kg"])), float(fact["penetration_m"])
    found = []
    for bed, vehicle in _beds(truck).items():
        result = _bollards(task, vehicle).run()
        at_rest = float(result.sensor(BED).position[-1, 0]) - 0.5 * float(fact["diameter_m"])
        who, quantity = f"{name_of(truck)}{bed}", "penetration at rest, limit"
        found.append(Row(task, who, quantity, "m", most, PENETRATION_BELOW, most, at_rest, "check"))
    rating = birm3d.rate(_bollards(task, truck).run(), "ASTM F2656")
    contained = Row(task, name_of(truck), "contained", "-", 1.0, 1.0, 1.0, float(rating.contained), "check")
    return [*found, contained]


def _beds(truck: birm3d.Vehicle) -> dict[str, birm3d.Vehicle]:
    """The truck with its bed fixed, with one that slides, and with fixings of a quarter of the force."""
    slides = truck.with_sliding_bed()
    weak = [(slip, 0.25 * force) for slip, force in slides.joint.slide]
    return {
        "": truck,
        ", with a sliding bed": slides,
        ", with weak fixings": truck.with_sliding_bed(weak),
    }


def _bollards(task: str, truck: birm3d.Vehicle | None = None) -> birm3d.Simulation:
    (fact,) = (fact for fact in facts("security_barriers") if fact["test"] == task)
    number = {name: float(fact[f"{name}_m"]) for name in ("diameter", "height", "spacing")}
    posts = birm3d.Barrier.bollards(count=int(fact["count"]), **number)
    vehicle = stand_in("truck", float(fact["mass_kg"])) if truck is None else truck
    return birm3d.Simulation(vehicle, posts, units.km_h(float(fact["speed_km_h"])))


_OTHERS = ("truck at a wall", "truck at five bollards", "DSC635")


def _other(task: str) -> list[Row]:
    found = []
    for fact in facts("head_on_trucks"):
        if fact["test"] != task:
            continue
        value, scatter = float(fact["value"]), float(fact["scatter"])
        if task == "DSC635":
            result = _bollards("DSC635 at rest").run()
            own = float(birm3d.rate(result, "ASTM F2656").penetration)
        else:
            simulation = scenes.truck_at_wall if task == "truck at a wall" else scenes.truck_at_bollards
            result = simulation().run()
            own = float(result.metrics["max_pitch"])
        role = "fitted" if fact["fitted"] == "yes" else "predicted"
        who, unit = name_of(result.scene.vehicle), fact["unit"]
        bounds = (value - scatter, value + scatter)
        found.append(Row(task, who, fact["quantity"], unit, value, *bounds, own, role))
    return found
