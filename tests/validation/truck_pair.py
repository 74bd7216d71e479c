"""Two posts at a frame: the most that the model's numbers bring sideways, by a small scan."""

from __future__ import annotations

from collections.abc import Iterator

import birm3d
from truck_runs import runs
from truck_tables import Row, computed, table

TEXT = """**Two posts at a frame, a small scan.** One number at a time is changed, of the file, at the offset
pair. The factor on the force at a post's flank is 0.35 for all vehicles, and is not varied. With it vehicle N
meets the sideways impulse on a pole, 0.13 of the forward one. A greater factor would miss that."""

FACTORS = {
    "rails": (0.5, 2.0, 4.0),
    "bumper_middle": (0.5, 2.0, 4.0),
    "engine": (0.5, 2.0, 4.0),
    "bumper_end": (5.0, 20.0),
    "hood": (5.0, 20.0),
    "fender": (5.0, 20.0),
    "tire_front": (0.5, 2.0),
}
LENGTHS = (0.15, 0.3, 1.0, 1.5)  # of the indentation [m]


def changed(vehicle: birm3d.Vehicle) -> Iterator[tuple[str, birm3d.Vehicle]]:
    """The vehicle as it is, then with one number changed."""
    yield "as in the file", vehicle
    for zone, factors in FACTORS.items():
        for factor in factors:
            yield f"{zone} times {factor:g}", vehicle.with_zones({zone: vehicle.zones[zone].scaled(factor)})
    for length in LENGTHS:
        yield f"indentation length {length:g} m", vehicle.with_indentation_length(length)


def section(vehicle: birm3d.Vehicle) -> list[str]:
    """Lines: text, table, and the most that is reached."""
    run = runs()["bollards2_50_offset"]
    head = (
        "what is changed",
        "impulse to the left, each post [kN s]",
        "forward",
        "error of travel",
        "error of force",
    )
    rows = [(name, computed(one, [run])[0]) for name, one in changed(vehicle)]
    right, left = 1e-3 * run.impulse
    lines = [["run", f"{right[1]:.0f}; {left[1]:.0f}", f"{right[0]:.0f}; {left[0]:.0f}", "", ""]]
    lines += [_line(name, row) for name, row in rows]
    most = [1e-3 * max(abs(row.own.impulse[post, 1]) for _, row in rows) for post in (0, 1)]
    told = (
        f"The most is {most[0]:.0f} and {most[1]:.0f} kN s, of {-right[1]:.0f} and {left[1]:.0f} in the run."
    )
    return [TEXT, "", *table(head, lines), "", told]


def _line(name: str, row: Row) -> list[str]:
    right, left = 1e-3 * row.own.impulse
    return [
        name,
        f"{right[1]:.0f}; {left[1]:.0f}",
        f"{right[0]:.0f}; {left[0]:.0f}",
        f"{100 * row.errors['travel']:+.0f} %",
        f"{100 * row.errors['force']:+.0f} %",
    ]
