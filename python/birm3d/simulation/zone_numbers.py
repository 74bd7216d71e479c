"""Numbers of a zone by their names in ``zone.<name>.<number>``; points of an envelope are counted from 1."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Mapping
from typing import Any

from ..vehicle.zone import LAW_NUMBERS, Zone

__all__ = ["PER_AREA", "changed_zone", "unit_of_number", "zone_numbers", "zone_value"]

_UNITS = {
    "pressure per length": ("N/m per m^2", "N/m"),
    "pressure": ("N per m^2", "N"),
    "length": ("m", "m"),
    "force": ("N", "N"),
}
"""Quantity -> unit of a zone's number, which is per area of the skin, and of the same number of a truss."""

_OF_POINTS = {"stress": "pressure", "deflection": "length"}

PER_AREA = {"N/m per m^2": "pressure per length", "N per m^2": "pressure"}
"""Unit per area of the skin -> its quantity."""

POINT = re.compile(r"(stress|deflection)\[(\d+)\]")


def unit_of_number(number: str, of_zone: bool) -> str:
    """Return the unit of a number of a zone, or of a truss; "" of a pure number."""
    row = LAW_NUMBERS.get(number)
    quantity = _OF_POINTS.get(number.split("[")[0]) if row is None else row.quantity
    return _UNITS.get(quantity or "", ("", ""))[0 if of_zone else 1]


def zone_numbers(zone: Zone) -> tuple[str, ...]:
    """Return the names of a zone's numbers, "scale" last."""
    if zone.envelope is None:
        return (*zone, "scale")
    points = range(1, len(zone.envelope))
    return (
        *(f"{axis}[{i}]" for i in points for axis in ("deflection", "stress")),
        *(name for name in zone if name != "envelope"),
        "scale",
    )


def zone_value(zone: Zone, number: str) -> float:
    """Return one of them."""
    if number == "scale":
        return 1.0
    point = POINT.fullmatch(number)
    if point is None:
        return float(zone[number])
    assert zone.envelope is not None  # else the name would be unknown
    return zone.envelope[int(point[2])][0 if point[1] == "deflection" else 1]


def changed_zone(zone: Zone, numbers: Mapping[str, float]) -> Zone:
    """Return the zone with other numbers; a scale comes last."""
    changes: dict[str, Any] = {}
    points = [list(point) for point in zone.envelope or ()]
    for number, value in numbers.items():
        point = POINT.fullmatch(number)
        if point is not None:
            points[int(point[2])][0 if point[1] == "deflection" else 1] = float(value)
            changes["envelope"] = tuple((d, s) for d, s in points)
        elif number != "scale":
            changes[number] = float(value)
    return dataclasses.replace(zone, **changes).scaled(numbers.get("scale", 1.0))
