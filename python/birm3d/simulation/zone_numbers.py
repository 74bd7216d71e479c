"""Numbers of a zone by their names in ``zone.<name>.<number>``; points of an envelope are counted from 1."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Mapping
from typing import Any

from ..vehicle.zone import Zone

__all__ = ["PER_AREA", "ZONE_UNITS", "changed_zone", "zone_numbers", "zone_value"]

ZONE_UNITS = {
    "k_initial": "N/m",
    "knee": "m",
    "k_hardening": "N/m",
    "f_max": "N",
    "k_unloading": "N/m",
    "elastic_recovery": "m",
    "tail_depth": "m",
    "tail_slope": "N/m",
    "friction_share": "",
    "breakaway": "N",
    "breakaway_travel": "m",
    "stress": "N",
    "deflection": "m",
}
"""Unit of a number, of a zone per area of the skin; "" is a pure number."""

PER_AREA = {"N/m per m^2": "pressure per length", "N per m^2": "pressure"}
"""Unit per area of the skin -> its quantity."""

POINT = re.compile(r"(stress|deflection)\[(\d+)\]")


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
