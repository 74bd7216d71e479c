"""Ratings of security barriers: ASTM F2656, SD-STD-02.01, IWA 14-1 and ISO 22343-1, PAS 68.

Masses and penetration classes of ASTM F2656, K and L levels and code strings are from public summaries of the
standards and makers' certificates. IWA 14-1 measures from the front of the barrier, PAS 68 from its back
(Heald, "What is IWA 14?"). Speed windows, tolerances of masses and reference points of the vehicles are
as commonly reported: the standards are not at hand.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .. import _core, units
from ..result.event import gets_past, is_open, longer_run, outcome_words
from ..vehicle.joint import LONGEST_SLIP
from .criteria import Criterion
from .doubts import Doubt, doubts_of_run
from .measures import barrier_extent, check_side_on, heading_rows, movement_rows, penetration_history
from .rating import Rating, first_reached
from .rating_caution import model_cautions, tipping_doubts
from .vehicles import A_PILLAR, LOAD_BED, StandardVehicle, measured_point, standard_vehicle

if TYPE_CHECKING:
    from ..result import Result
    from ..units import Quantity

__all__ = ["SECURITY", "SecurityStandard", "rate_security"]

_HEAD_ON = 3.0  # deg by which a head-on test may be oblique

_ASTM = (
    StandardVehicle("SC", ("car",), 1100.0, 25.0, A_PILLAR),
    StandardVehicle("FS", ("car",), 2100.0, 50.0, A_PILLAR),
    StandardVehicle("PU", ("pickup",), 2300.0, 50.0, LOAD_BED),
    StandardVehicle("M", ("truck",), 6800.0, 140.0, LOAD_BED),
    StandardVehicle("C7", ("cab_over_truck",), 7200.0, 140.0, LOAD_BED),
    StandardVehicle("H", ("truck", "cab_over_truck", "tractor_semitrailer"), 29_500.0, 590.0, LOAD_BED),
)
_ASTM_07 = tuple(
    one._replace(code={"SC": "C", "PU": "P"}.get(one.code, one.code))
    for one in _ASTM
    if one.code not in ("FS", "C7")
)
_K_TRUCK = (StandardVehicle("15,000-lb truck", ("truck",), 6804.0, 140.0, LOAD_BED),)
_IWA = (
    StandardVehicle("M1", ("car",), 1500.0, 75.0, A_PILLAR),
    StandardVehicle("N1G", ("pickup",), 2500.0, 125.0, LOAD_BED),
    StandardVehicle("N1", ("van",), 3500.0, 100.0, LOAD_BED),
    StandardVehicle("N3C", ("cab_over_truck",), 7200.0, 140.0, LOAD_BED),
    StandardVehicle("N2A", ("cab_over_truck", "truck"), 7200.0, 140.0, LOAD_BED, chosen=False),
    StandardVehicle("N2B", ("cab_over_truck", "truck"), 7200.0, 140.0, LOAD_BED, chosen=False),
    StandardVehicle("N3G", ("truck", "cab_over_truck"), 30_000.0, 600.0, LOAD_BED),
)
_PAS = (
    *_IWA[:3],
    StandardVehicle("N2", ("cab_over_truck",), 7500.0, 150.0, LOAD_BED),
    StandardVehicle("N3", ("cab_over_truck",), 7500.0, 150.0, LOAD_BED, chosen=False),
    StandardVehicle("N3", ("truck", "cab_over_truck"), 30_000.0, 600.0, LOAD_BED),
)

# Least and greatest speeds of a level, in the unit in which they are rounded to tenths.
_Window = tuple[str, float, float]
_KM_H_HEAVY: tuple[_Window, ...] = (("30", 45.0, 60.0), ("40", 60.1, 75.0), ("50", 75.1, math.inf))
_KM_H_LIGHT: tuple[_Window, ...] = (
    *_KM_H_HEAVY[:2],
    ("50", 75.1, 90.0),
    ("60", 90.1, math.inf),
)
_K_MPH: tuple[_Window, ...] = (("K4", 28.0, 37.9), ("K8", 38.0, 46.9), ("K12", 47.0, math.inf))
_NOMINAL_KM_H = (16.0, 32.0, 48.0, 64.0, 80.0, 96.0, 112.0)
_SPEED_SLACK = 1.0  # km/h by which a nominal speed may be missed

_ASTM_CLASSES = (("P1", 1.0), ("P2", 7.0), ("P3", 30.0))
_L_CLASSES = (("L3", units.ft(3.0)), ("L2", units.ft(20.0)), ("L1", units.ft(50.0)))
_FURTHEST = 25.0  # beyond which ISO 22343-1 does not apply [m]


class SecurityStandard(NamedTuple):
    """How a standard rates: its vehicles, the face of the barrier it measures from, its own caution."""

    name: str
    vehicles: tuple[StandardVehicle, ...]
    datum: str  # "front" or "rear"
    style: str  # "levels", "K" or "code"
    caution: str


_ASTM_CAUTION = "The scope of ASTM F2656 strongly discourages to field a product on a simulation alone."
_CODE_CAUTION = (
    "A performance rating needs the impact test by an accredited laboratory; this is its notation only."
)
SECURITY = {
    one.name: one
    for one in (
        SecurityStandard("ASTM F2656", _ASTM, "rear", "levels", _ASTM_CAUTION),
        SecurityStandard("ASTM F2656-07", _ASTM_07, "rear", "levels", _ASTM_CAUTION),
        SecurityStandard(
            "SD-STD-02.01",
            _K_TRUCK,
            "rear",
            "K",
            "Withdrawn; since the revision of 2003 only penetration up to 1 m was certified.",
        ),
        SecurityStandard("IWA 14-1", _IWA, "front", "code", _CODE_CAUTION),
        SecurityStandard("ISO 22343-1", _IWA, "front", "code", _CODE_CAUTION),
        SecurityStandard("PAS 68", _PAS, "rear", "code", f"{_CODE_CAUTION} Debris is not computed."),
    )
}


_GOES_ON = "the vehicle goes on past the barrier"
_COASTS = _core.coasting_speed
"""Speed [m/s] from which a rolling resistance of a hundredth of the weight stops a vehicle within 0.4 m.

Presets resist with 0.012 to 0.015 of the weight.
"""


class _Penetration(NamedTuple):
    greatest: float  # m
    final: bool  # whether it can not grow any more
    note: str


def rate_security(
    result: Result,
    standard: SecurityStandard,
    vehicle_class: str | None,
    point: str | Sequence[Quantity] | None,
    part: str | int | None,
) -> Rating:
    """Return the rating of a run by a standard for security barriers; see :func:`birm3d.rate`."""
    check_side_on(result)
    vehicle = standard_vehicle(standard.name, standard.vehicles, result.scene.vehicle, vehicle_class)
    extent = barrier_extent(result.scene.barrier) if result.scene.barrier is not None else None
    assert extent is not None  # check_side_on has refused None
    if point is None:
        point = measured_point(standard.name, vehicle, result.scene.vehicle)
    found = _penetration(result, point, part, getattr(extent, standard.datum))
    measured = Criterion(
        f"penetration past the {standard.datum} face",
        found.greatest,
        "m",
        "see class",
        None,
        found.note,
    )
    mass = Criterion(
        "mass",
        result.scene.vehicle.mass,
        "kg",
        f"{vehicle.mass:,.0f} +-{vehicle.tolerance:g} kg",
        vehicle.weighs(result.scene.vehicle),
    )
    became = Criterion("outcome", outcome_words(result.outcome), "", "", None, result.outcome_detail)
    rate = {"levels": _astm, "K": _dos, "code": _code}[standard.style]
    verdict, contained, rows = rate(result, standard, vehicle, found)
    rows = (*rows[:-1], *heading_rows(result, _HEAD_ON), rows[-1])
    failed = [
        row.name if found.final or row is not rows[-1] else _GOES_ON
        for row in (mass, *rows)
        if row.passed is False
    ]
    doubts = (*doubts_of_run(result), *tipping_doubts(result), *_bed_doubts(result))
    return Rating(
        standard.name,
        f"no rating: {', '.join(failed)}" if failed else verdict,
        found.greatest,
        contained,
        (mass, *rows[:-1], measured, rows[-1], *movement_rows(result), became),
        (
            *(doubt.sentence for doubt in doubts),
            standard.caution,
            *model_cautions(result.scene.barrier),
        ),
        vehicle.code,
        is_rated=not failed,
        is_final=found.final,
        unmet=tuple(row.name for row in (mass, *rows[:-1]) if row.passed is False),
        doubts=doubts,
        outcome=result.outcome,
    )


def _bed_doubts(result: Result) -> Iterator[Doubt]:
    """Yield a doubt where the load bed would have left its frame."""
    slip = result.metrics.get("bed_slip", 0.0)
    if slip > LONGEST_SLIP:
        text = (
            f"The load bed slid by {slip:.2f} m. Beyond {LONGEST_SLIP:g} m it would have left the frame, so "
            "that the penetration is not to be relied on."
        )
        yield Doubt("bed_slip", slip, text)


def _penetration(
    result: Result, point: str | Sequence[Quantity], part: str | int | None, datum: float
) -> _Penetration:
    past = penetration_history(result, point, part, datum)
    greatest = float(past.max())
    moving_in = float(result.final_velocity @ np.asarray(result.scene.barrier._past))  # type: ignore[union-attr]
    turning_in = not gets_past(result) and result.end_reason == "duration"
    if (is_open(result) and moving_in > 0.0) or (turning_in and moving_in > _COASTS):
        raise ValueError(
            f"result must have run until the vehicle is stopped or has left ({longer_run(result)}), got one "
            f"that ends at {result.time[-1]:g} s with {moving_in:.2f} m/s into the barrier"
        )
    if (gets_past(result) or result.end_reason == "longest") and moving_in > _COASTS:
        return _Penetration(
            greatest, False, f"{result.outcome}, goes on at {moving_in:.1f} m/s: at least this"
        )
    coasts = gets_past(result) and moving_in > 0.0
    return _Penetration(greatest, True, f"dynamic; it coasts at {moving_in:.2f} m/s" if coasts else "dynamic")


def _level(speed: float, windows: Sequence[_Window]) -> str | None:
    """Return the level of a speed, which is rounded to tenths as windows are."""
    rounded = round(speed, 1)
    return next((name for name, least, most in windows if least <= rounded <= most), None)


def _speed_row(speed: float, unit: str, windows: Sequence[_Window], level: str | None) -> Criterion:
    texts = [
        f"{name}: {least:g} to {most:g}".replace(" to inf", " and above") for name, least, most in windows
    ]
    limit = f"level {'; '.join(texts)} [{unit}]"
    return Criterion("impact speed", speed, unit, limit, level is not None, level or "no level")


def _angle_row(result: Result) -> Criterion:
    angle = result.scene.impact_angle
    off = abs(90.0 - angle)
    return Criterion("impact angle", angle, "deg", f"90 +-{_HEAD_ON:g} deg", off <= _HEAD_ON)


def _class_row(found: _Penetration, steps: Sequence[tuple[str, float]]) -> tuple[str | None, Criterion]:
    """Return the class of a penetration, which is rounded to centimetres as the classes are."""
    name = first_reached(round(found.greatest, 2), steps) if found.final else None
    limit = ", ".join(
        f"{step} <= {most:.3g}" if most < math.inf else f"{step} beyond" for step, most in steps
    )
    value = name or ("beyond all classes" if found.final else _GOES_ON)
    return name, Criterion("penetration class", value, "", f"{limit} m", name is not None)


_Rated = tuple[str, bool, tuple[Criterion, ...]]


def _astm(
    result: Result, standard: SecurityStandard, vehicle: StandardVehicle, found: _Penetration
) -> _Rated:
    windows = _KM_H_HEAVY if vehicle.code in ("M", "C7", "H") else _KM_H_LIGHT
    speed = result.scene.impact_speed / units.km_h
    level = _level(speed, windows)
    steps = (*_ASTM_CLASSES, ("P4", math.inf)) if standard.name.endswith("07") else _ASTM_CLASSES
    name, row = _class_row(found, steps)
    rows = (_speed_row(speed, "km/h", windows, level), _angle_row(result), row)
    contained = name in ("P1", "P2", "P3")
    return f"{vehicle.code}{level}-{name}", contained, rows


def _dos(result: Result, standard: SecurityStandard, vehicle: StandardVehicle, found: _Penetration) -> _Rated:
    speed = result.scene.impact_speed / units.mph
    level = _level(speed, _K_MPH)
    name, row = _class_row(found, _L_CLASSES)
    revised = found.final and round(found.greatest, 2) <= 1.0
    limit = Criterion("revision of 2003", found.greatest, "m", "1 m", None, "met" if revised else "not met")
    rows = (_speed_row(speed, "mph", _K_MPH, level), _angle_row(result), limit, row)
    return f"{level}-{name}", name is not None, rows


def _code(
    result: Result, standard: SecurityStandard, vehicle: StandardVehicle, found: _Penetration
) -> _Rated:
    speed = result.scene.impact_speed / units.km_h
    nominal = [v for v in _NOMINAL_KM_H if v <= speed + _SPEED_SLACK]
    texts = ", ".join(f"{v:g}" for v in _NOMINAL_KM_H[:-1])
    limit = f"{texts} or {_NOMINAL_KM_H[-1]:g} km/h, at most {_SPEED_SLACK:g} below"
    level = f"{nominal[-1]:g}" if nominal else None
    angle = min(result.scene.impact_angle, 180.0 - result.scene.impact_angle)
    stopped = found.final and found.greatest <= _FURTHEST
    distance = max(0.0, found.greatest)
    value = f"{distance:.1f} m" if stopped else "beyond" if found.final else _GOES_ON
    rows = (
        Criterion("impact speed", speed, "km/h", limit, level is not None, level or "no level"),
        Criterion("penetration distance", value, "", f"reported up to {_FURTHEST:g} m", stopped),
    )
    debris = "/debris not computed" if standard.name == "PAS 68" else ""
    code = f"V/{vehicle.mass:.0f}[{vehicle.code}]/{level}/{angle:.0f}:{distance:.1f}{debris}"
    return code, stopped, rows
