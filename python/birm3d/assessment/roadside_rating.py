"""Ratings of roadside barriers by MASH and EN 1317."""

# Longer than 300 lines: two standards side by side, which share their criteria.
from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .. import units
from ..result.event import gets_past, has_rolled_over, is_open, longer_run, outcome_words
from ..result.segment_motion import base_corners
from .criteria import Criterion
from .doubts import doubts_of_run
from .limits import FLAIL_LIMITS, THIV_LIMIT_KM_H, graded, severity_class
from .measures import (
    ExitBox,
    across_barrier,
    barrier_extent,
    check_side_on,
    exit_box,
    heading_rows,
    vehicle_intrusion,
)
from .occupant import occupant_risk
from .rating import Rating, first_reached
from .rating_caution import (
    fails_clearly,
    level_cautions,
    model_cautions,
    risk_doubts,
    roadside_doubts,
    roadside_lines,
)
from .roadside import RoadsideStandard, RoadsideTest
from .vehicles import HEAVY_KG, StandardVehicle, standard_vehicle

if TYPE_CHECKING:
    from ..result import Result

__all__ = ["rate_roadside"]

_STILL = 0.5  # m/s into the barrier, of a vehicle that slides along it
_MOST_ROLL = 75.0  # deg; MASH criterion F, also of pitch
_MOST_AT_END = 45.0  # deg; a vehicle that is left further over lies on the barrier, or is about to fall
_UPRIGHT = (
    f"not rolled over; roll and pitch within {_MOST_ROLL:g} deg, roll at the end within {_MOST_AT_END:g} deg"
)
_NO_ANGLE = "; EN 1317 gives no angle: the first is MASH's for light vehicles, the second chosen"
_HEAVY_UPRIGHT = "G: upright"
_SLACK = 1e-9  # rounding of the units
_LEAST_SEVERITY = 0.92  # of the nominal impact severity, MASH
_WIDTHS = (0.6, 0.8, 1.0, 1.3, 1.7, 2.1, 2.5, 3.5)
"""Greatest working width, and vehicle intrusion, of the classes 1 to 8 of EN 1317-2 [m]."""


def rate_roadside(
    result: Result, standard: RoadsideStandard, asked: str | None, vehicle_class: str | None
) -> Rating:
    """Return the rating of a run by one test of a standard; see :func:`birm3d.rate`.

    Parameters
    ----------
    asked
        A test or a level of the standard; ``None``: the test that the run comes nearest to.
    """
    check_side_on(result)
    test = _test_of(result, standard, asked, vehicle_class)
    conditions = _conditions(result, standard, test)
    light = test.vehicle.mass < HEAVY_KG
    intrusion = vehicle_intrusion(result)
    judged = (_mash if standard.name == "MASH" else _european)(result, light, intrusion)
    rows = (*conditions, *judged.rows)
    failed = any(row.passed is False for row in judged.rows)
    is_clear = not failed or fails_clearly(judged.rows)
    unmet = [row.name for row in conditions if row.passed is False]
    levels = [level for level, tests in standard.levels.items() if test.name in tests]
    barrier = roadside_doubts(result, standard, test)
    doubts = (*doubts_of_run(result), *risk_doubts(judged.rows), *barrier)
    return Rating(
        standard.name,
        f"no rating: {', '.join(unmet)}" if unmet else _verdict(failed, is_clear, judged.classes),
        intrusion,
        judged.contained.passed is True,
        (*rows, Criterion("levels with this test", ", ".join(levels), "", "", None)),
        (
            *(doubt.sentence for doubt in doubts),
            standard.caution,
            *roadside_lines(result, test),
            *model_cautions(result.scene.barrier),
        ),
        test.vehicle.code,
        test.name,
        is_rated=not unmet,
        is_clear=is_clear,
        unmet=tuple(unmet),
        doubts=doubts,
        outcome=result.outcome,
    )


def _verdict(failed: bool, is_clear: bool, classes: str) -> str:
    if not failed:
        return f"pass{classes}"
    return "fail" if is_clear else "fail, within the model's error"


def _test_of(
    result: Result, standard: RoadsideStandard, asked: str | None, vehicle_class: str | None
) -> RoadsideTest:
    """Return the test of a run: the vehicle decides, then the nearest nominal speed and angle."""
    if asked is not None and asked not in (*standard.tests, *standard.levels):
        raise ValueError(
            f"standard must name a test ({', '.join(standard.tests)}) or a level "
            f"({', '.join(standard.levels)}) of {standard.name}, or neither; got {asked!r}"
        )
    names = standard.levels.get(asked, (asked,)) if asked is not None else tuple(standard.tests)
    tests = [standard.tests[name] for name in names]
    known: dict[str, StandardVehicle] = {}
    for test in tests:  # of a level or test that is named all vehicles may be meant
        known[test.vehicle.code] = test.vehicle._replace(chosen=test.vehicle.chosen or asked is not None)
    title = standard.name if asked is None else f"{standard.name} {asked}"
    vehicle = standard_vehicle(title, tuple(known.values()), result.scene.vehicle, vehicle_class)
    speed, angle = result.scene.impact_speed / units.km_h, _angle(result)
    fitting = [test for test in tests if test.vehicle.code == vehicle.code]
    return min(
        fitting, key=lambda test: abs(speed - test.speed) / test.speed + abs(angle - test.angle) / 90.0
    )


def _angle(result: Result) -> float:
    """Return the acute angle between path and barrier [deg]."""
    angle = result.scene.impact_angle
    return min(angle, 180.0 - angle)


def _conditions(result: Result, standard: RoadsideStandard, test: RoadsideTest) -> tuple[Criterion, ...]:
    vehicle, speed = test.vehicle, result.scene.impact_speed / units.km_h
    least, most = standard.speed(test.speed)
    below, above = standard.angle
    angle = _angle(result)
    return (
        Criterion(
            "mass",
            result.scene.vehicle.mass,
            "kg",
            f"{vehicle.mass:,.0f} +-{vehicle.tolerance:g} kg",
            vehicle.weighs(result.scene.vehicle),
        ),
        Criterion(
            "impact speed",
            speed,
            "km/h",
            f"{least:.4g} to {most:.4g} km/h",
            least - _SLACK <= speed <= most + _SLACK,
        ),
        Criterion(
            "impact angle",
            angle,
            "deg",
            f"{test.angle - below:g} to {test.angle + above:g} deg",
            test.angle - below - _SLACK <= angle <= test.angle + above + _SLACK,
        ),
        *heading_rows(result, above),
        *([_severity(result, test)] if standard.name == "MASH" else []),
        *([_together(speed, angle, standard, test)] if standard.together else []),
    )


def _even(value: float) -> float:
    """Return a number without its rounding error, which may be the sign of a zero."""
    return round(float(value), 6) + 0.0


def _together(speed: float, angle: float, standard: RoadsideStandard, test: RoadsideTest) -> Criterion:
    """Return whether speed and angle are accepted together; not judged where one of them alone is not."""
    place = np.array([speed / test.speed - 1.0, angle - test.angle])
    corners = np.array(standard.together)
    sides = np.roll(corners, -1, axis=0) - corners
    way = place - corners
    inside = bool((sides[:, 0] * way[:, 1] - sides[:, 1] * way[:, 0] >= -_SLACK).all())
    alone = bool(
        (corners.min(axis=0) - _SLACK <= place).all() and (place <= corners.max(axis=0) + _SLACK).all()
    )
    return Criterion(
        "speed and angle together",
        f"{_even(place[0]):+.1%}, {_even(place[1]):+.1f} deg",
        "",
        "at 0 % from -0.5 to 1.5 deg, at 2 to 5 % from -1 to 1.5 deg, at 7 % from -1 to 1 deg",
        inside if alone else None,
        "" if alone else "not judged",
    )


def _severity(result: Result, test: RoadsideTest) -> Criterion:
    """Return the impact severity beside the least that MASH accepts (its table 2-2)."""
    severity = float(result.metrics["impact_severity"]) / 1e3
    least = _LEAST_SEVERITY * test.severity / 1e3
    return Criterion("impact severity", severity, "kJ", f"at least {least:.1f} kJ", severity >= least)


def _containment(result: Result, name: str) -> Criterion:
    """Return whether the vehicle was kept on its side of the barrier.

    A run that ends while the vehicle slides along the barrier decides this, too. One that ends while it moves
    into the barrier does not.

    Raises
    ------
    ValueError
        If the outcome of the run is not decided and some unit moves into the barrier, or is behind it.
    """
    limit = "contained or redirected"
    if not is_open(result):
        return Criterion(name, outcome_words(result.outcome), "", limit, not gets_past(result))
    barrier = result.scene.barrier
    assert barrier is not None  # check_side_on has refused None
    parts = [result.unit(i) for i in range(len(result.scene.vehicle.units))]
    inward = max(float(part.final_velocity @ np.asarray(barrier._past)) for part in parts)
    furthest = max(float(across_barrier(result, part.position[-1])) for part in parts)
    if inward > _STILL or furthest > 0.0:
        raise ValueError(
            f"result must have run until the outcome is decided ({longer_run(result)}), got one that ends at "
            f"{result.time[-1]:g} s with {inward:.2f} m/s into the barrier: {result.outcome_detail}"
        )
    return Criterion(name, "still beside the barrier", "", limit, True)


def _upright(result: Result) -> tuple[str, bool]:
    """Return what became of the vehicle in words, and whether it stayed upright, wherever it went.

    A run ends at separation or later, so that the roll at its end is the last that is known.
    """
    if has_rolled_over(result):
        return "rolled over", False
    became, within = outcome_words(result.outcome), max(_attitude(result)) <= _MOST_ROLL
    upright = within and _roll_at_end(result) <= _MOST_AT_END
    return became if upright else f"{became}, not upright", upright


def _roll_at_end(result: Result) -> float:
    """Return the greatest roll of all units when the run ends [deg]."""
    return max(abs(float(result.unit(i).roll[-1])) for i in range(len(result.scene.vehicle.units)))


def _attitude(result: Result) -> tuple[float, float]:
    """Return the greatest roll and pitch of all units [deg]."""
    parts = [result.unit(i) for i in range(len(result.scene.vehicle.units))]
    roll = max(float(np.abs(part.roll).max()) for part in parts)
    return roll, max(float(np.abs(part.pitch).max()) for part in parts)


def _roll_name(result: Result) -> str:
    """Return what the roll is called; the metric of that name is of the first unit alone."""
    return "greatest roll" + (" of any unit" if len(result.scene.vehicle.units) > 1 else "")


def _working_width(result: Result) -> float:
    """Return how far the barrier reaches at most behind its undeformed traffic face [m]."""
    barrier = result.scene.barrier
    assert barrier is not None  # check_side_on has refused None
    extent = barrier_extent(barrier)
    rear = extent.rear
    if barrier.stands_free() is not None:
        across = np.asarray(barrier._past)[:2]
        corners = (base_corners(result) - np.asarray(barrier.origin)[:2]) @ across
        rear = max(rear, float(corners.max()))
    return rear - extent.front


def _deflection(result: Result) -> float:
    """Return the dynamic deflection of the barrier [m]; 0 where it is fixed and rigid."""
    return float(result.metrics.get("barrier_deflection", 0.0))


def _box_row(box: ExitBox, judged: bool, contained: bool) -> Criterion:
    """Return how far wheels get within the exit box; it says nothing of a vehicle that is not contained."""
    limit = f"within {box.width:.2f} m over {box.length:g} m"
    grade = "not contained" if not contained else "" if judged else "inside" if box.inside else "outside"
    met = box.inside if judged and contained else None
    return Criterion("exit box, wheels from the face", box.reached, "m", limit, met, grade)


class _Judged(NamedTuple):
    contained: Criterion
    others: tuple[Criterion, ...]
    classes: str = ""  # of a run that passes, as the verdict has them

    @property
    def rows(self) -> tuple[Criterion, ...]:
        return self.contained, *self.others


def _mash(result: Result, light: bool, intrusion: float) -> _Judged:
    risk = occupant_risk(result)
    limits = FLAIL_LIMITS["MASH"]
    roll, pitch = _attitude(result)
    became, upright = _upright(result)
    contained = _containment(result, "A: contained, redirected or stopped")
    rows = [Criterion("D: compartment", "not computed", "", "", None)]
    if light:
        rows += [
            Criterion("F: upright", became, "", _UPRIGHT, upright),
            Criterion("F: greatest roll", roll, "deg", f"{_MOST_ROLL:g} deg", roll <= _MOST_ROLL),
            Criterion("F: greatest pitch", pitch, "deg", f"{_MOST_ROLL:g} deg", pitch <= _MOST_ROLL),
            graded("H: OIV, longitudinal", risk.oiv_x, "m/s", limits.velocity),
            graded("H: OIV, lateral", risk.oiv_y, "m/s", limits.velocity),
            graded("I: ridedown, longitudinal", risk.ridedown_x, "g", limits.ridedown),
            graded("I: ridedown, lateral", risk.ridedown_y, "g", limits.ridedown),
        ]
    else:
        rows += [
            Criterion(
                _HEAVY_UPRIGHT,
                became,
                "",
                "preferable",
                None,
                "yes" if upright else "no",
            ),
            Criterion(_roll_name(result), roll, "deg", "", None),
        ]
    rows.append(Criterion("roll at the end", _roll_at_end(result), "deg", "", None))
    # MASH measures to the furthest part of the barrier or of the vehicle, EN 1317 to that of the barrier.
    width = max(_working_width(result), intrusion)
    rows += [
        _box_row(exit_box(result, not light), judged=False, contained=contained.passed is True),
        Criterion("dynamic deflection", _deflection(result), "m", "", None),
        Criterion("working width", width, "m", "none; of barrier and vehicle", None),
        Criterion("vehicle intrusion", intrusion, "m", "", None),
        Criterion("ASI", risk.asi, "", "", None),
        Criterion("THIV", risk.thiv / units.km_h, "km/h", "", None),
    ]
    return _Judged(contained, tuple(rows))


def _european(result: Result, light: bool, intrusion: float) -> _Judged:
    roll, _ = _attitude(result)
    became, upright = _upright(result)
    width = _working_width(result)
    contained = _containment(result, "containment")
    rows = [
        Criterion("upright", became, "", _UPRIGHT + _NO_ANGLE, upright),
        Criterion(_roll_name(result), roll, "deg", "", None),
        Criterion("roll at the end", _roll_at_end(result), "deg", "", None),
        _box_row(exit_box(result, not light), judged=True, contained=contained.passed is True),
    ]
    classes = []
    if light:
        risk = occupant_risk(result)
        level = severity_class(risk.asi)
        speed = risk.thiv / units.km_h
        limit = f"{THIV_LIMIT_KM_H:g} km/h"
        rows += [
            Criterion(
                "ASI", risk.asi, "", "A 1, B 1.4, C 1.9", level is not None, f"class {level}" if level else ""
            ),
            Criterion("THIV", speed, "km/h", limit, speed <= THIV_LIMIT_KM_H),
            Criterion("PHD", risk.phd, "g", "", None),
        ]
        classes.append(f"severity {level}")
    rows += [
        Criterion("dynamic deflection", _deflection(result), "m", "", None),
        _class_row("working width", width, "W"),
        _class_row("vehicle intrusion", intrusion, "VI"),
    ]
    classes += [row.grade for row in rows[-2:] if row.grade]
    return _Judged(contained, tuple(rows), f"; {', '.join(classes)}" if classes else "")


def _class_row(name: str, value: float, letter: str) -> Criterion:
    steps = [(f"{letter}{i + 1}", most) for i, most in enumerate(_WIDTHS)]
    beyond = f"{letter}{len(steps) + 1}" if letter == "VI" else f"beyond {letter}{len(steps)}"
    grade = first_reached(round(value, 2), steps) or beyond
    return Criterion(
        name, value, "m", f"{letter}1 {_WIDTHS[0]:g} to {letter}8 {_WIDTHS[-1]:g} m", None, grade
    )


def level_rating(standard: RoadsideStandard, level: str, ratings: Sequence[Rating]) -> Rating:
    """Return the rating of a level from those of its tests.

    Raises
    ------
    ValueError
        If a test of the level is missing.
    """
    if level not in standard.levels:
        raise ValueError(
            f"standard must name a level of {standard.name} ({', '.join(standard.levels)}) for several runs, "
            f"got {level!r}"
        )
    by_test = {rating.test: rating for rating in ratings}
    missing = [name for name in standard.levels[level] if name not in by_test]
    if missing:
        raise ValueError(
            f"results must hold all tests of {standard.name} {level} ({', '.join(standard.levels[level])}), "
            f"got none of {', '.join(missing)}"
        )
    parts = [by_test[name] for name in standard.levels[level]]
    rows = tuple(
        Criterion(f"test {name}", _outcome_of(part), "", "pass", part.passed)
        for name, part in zip(standard.levels[level], parts, strict=True)
    )
    failed = not all(part.passed for part in parts)
    is_clear = not failed or any(part.is_clear for part in parts if not part.passed)
    return Rating(
        standard.name,
        _verdict(failed, is_clear, _worst_classes(parts)),
        max(part.penetration for part in parts),
        all(part.contained for part in parts),
        rows,
        level_cautions({name: by_test[name].cautions for name in standard.levels[level]}),
        ", ".join(part.vehicle_class for part in parts),
        level,
        is_clear=is_clear,
    )


def _outcome_of(part: Rating) -> str:
    """Return what became of a test, and which criteria it failed."""
    failed = [f"{row.name} ({row.shown})" for row in part.criteria if row.passed is False]
    verdict = part.verdict
    for row in part.criteria:
        if row.name == _HEAVY_UPRIGHT and row.grade == "no":
            verdict += ", rolled over" if row.value == "rolled over" else ", not upright"
    return f"{verdict} by {', '.join(failed)}" if failed and part.is_rated else verdict


def _worst_classes(parts: Sequence[Rating]) -> str:
    """Return the worst class of each kind over the tests of a level, as the designation has it."""
    kinds = ("ASI", "working width", "vehicle intrusion")
    worst = []
    for kind in kinds:
        found = [row for part in parts for row in part.criteria if row.name == kind and row.grade]
        if found:
            most = max(found, key=lambda row: float(row.value))
            worst.append(most.grade.replace("class", "severity"))
    return f"; {', '.join(worst)}" if worst else ""
