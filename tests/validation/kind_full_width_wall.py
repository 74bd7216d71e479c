"""Full-width rigid walls, head-on: NHTSA's frontal tests, test 10146 in detail, restitution at low speed."""

from __future__ import annotations

from collections.abc import Sequence

import birm3d
from birm3d import scenes
from birm3d.reference import nhtsa_tests
from comparison import Row, about, facts
from stand_in import name_of, stand_in

NAME = "full_width_wall"
TITLE = "Full-width rigid wall, head-on"
TEXT = """Vehicles: `birm3d.scenes.nhtsa_frontal`, the preset of the class, scaled to the mass of the test;
at low speeds the stand-in for a car of 1,719 kg. Marks: travel 12 % and static crush 13 %, one standard
deviation of the 20 cars of the class: a preset knows the class, not the car. Test 10146 has what its own
channels scatter by. Restitution at low speed: 0.1, the fit's own scatter is not recorded.

What the model can not do here: the compartment and the mass centre are one. In a test the engine stops
early and the compartment goes on by another 10 % (0.741 and 0.677 m in test 10146). The compartment is
what is measured. So a preset that is fitted to the compartment has its force too low.
Static crush is measured at bumper height after the vehicle has been towed away. Bumper covers have sprung
back then: by 8 cm without force in the model, whatever the speed."""

TRAVEL, CRUSH, LOW_SPEED = 0.12, 0.13, 0.1
SPRINGBACK = ("10146", "7460")  # the springback of all fronts comes from these two


def tasks() -> Sequence[str]:
    """Numbers of NHTSA tests with a usable pulse, then rows of the other tables."""
    numbers = [
        number
        for number, test in nhtsa_tests().items()
        if test.kind == "frontal" and test.quality in ("A", "B")
    ]
    return [*numbers, "detail", *(f"restitution {row['speed_m_s']}" for row in facts("restitution"))]


def rows(task: str) -> list[Row]:
    """What one task is compared in."""
    if task == "detail":
        return _detail()
    if task.startswith("restitution"):
        return [_restitution(float(task.split()[1]))]
    test = nhtsa_tests()[task]
    result = scenes.nhtsa_frontal(task).run()
    role = "fitted" if test.split == "CALIBRATE" else "predicted"
    who, told = name_of(result.scene.vehicle), f"NHTSA {task}, {test.make} {test.model} {test.year}"
    found = []
    # The car's front is fitted to the momentum centre of test 10146: see the rows of its detail.
    travel, crush = test.dynamic_displacement, test.static_crush
    if travel is not None and task != "10146":
        found.append(
            Row(
                told,
                who,
                "travel",
                "m",
                travel,
                *about(travel, TRAVEL),
                _of(result, "max_displacement"),
                role,
            )
        )
    if crush is not None:
        predicted = _of(result, "residual_crush")
        role = "fitted" if task in SPRINGBACK else "predicted"
        found.append(Row(told, who, "static crush", "m", crush, *about(crush, CRUSH), predicted, role))
    return found


def _of(result: birm3d.Result, metric: str) -> float:
    if metric == "mean_deceleration_50ms":
        return float(result.metrics["peak_force_50ms"]) / result.scene.vehicle.mass
    return float(result.metrics[metric])


def _detail() -> list[Row]:
    result = scenes.nhtsa_10146().run()
    found = []
    for fact in facts("nhtsa_10146"):
        value, predicted = float(fact["value"]), _of(result, fact["metric"])
        bounds = about(value, float(fact["scatter"]))
        role = "fitted" if fact["fitted"] == "yes" else "predicted"
        who = name_of(result.scene.vehicle)
        found.append(
            Row("NHTSA 10146, detail", who, fact["quantity"], fact["unit"], value, *bounds, predicted, role)
        )
    return found


def _restitution(speed: float) -> Row:
    (value,) = [float(row["restitution"]) for row in facts("restitution") if float(row["speed_m_s"]) == speed]
    vehicle = stand_in("car", 1719.0)
    result = birm3d.Simulation(vehicle, birm3d.Barrier.rigid_wall(), speed).run()
    return Row(
        f"Cipriani fit at {speed:g} m/s",
        name_of(vehicle),
        "restitution at low speed",
        "-",
        value,
        value - LOW_SPEED,
        value + LOW_SPEED,
        _of(result, "restitution"),
    )
