"""How the four numbers of the corners were chosen: misfit to small-overlap tests about the chosen values.

    python tests/validation/scan_corners.py    # 6 s of processor time; corners.md, results/corners.csv

Each number is varied while the other three stay, for the passenger car, the minivan and the pickup together.

A wall of the front's full width does not tell the engine's width from its peak. So the height of the peak
follows both: the sum of stress times area over the front stays, and with it the fit to such a wall.
"""

from __future__ import annotations

import csv
import dataclasses
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import MappingProxyType

FOLDER = Path(__file__).parent
sys.path.insert(0, str(FOLDER))

import birm3d  # noqa: E402
import kind_small_overlap  # noqa: E402
import numpy as np  # noqa: E402
import tomlkit  # noqa: E402
from birm3d import units  # noqa: E402
from birm3d.vehicle.vehicle_file import preset_path  # noqa: E402
from comparison import write_rows  # noqa: E402

RESULTS, PAGE = FOLDER / "results/corners.csv", FOLDER / "corners.md"
FLANK, ALONG, WIDTH, SHARE = "flank", "along", "width", "share"
NUMBERS: Mapping[str, str] = MappingProxyType(
    {
        FLANK: "Factor on the flank of the wall's edge",
        ALONG: "Resistance of the wheel house along the vehicle [Pa/kg]",
        WIDTH: "Width of the engine's peak [m]",
        SHARE: "Share of the peak above the rails that is left beside the engine",
    }
)
CHOSEN: Mapping[str, float] = MappingProxyType({FLANK: 1.25, ALONG: 75.0, WIDTH: 0.6, SHARE: 0.2})
SCAN: Mapping[str, tuple[float, ...]] = MappingProxyType(
    {
        FLANK: (0.75, 1.0, 1.15, 1.25, 1.35, 1.5, 1.75),
        ALONG: (0.0, 35.0, 50.0, 75.0, 110.0, 150.0),
        WIDTH: (0.4, 0.5, 0.6, 0.7, 0.8),
        SHARE: (0.0, 0.1, 0.2, 0.35, 0.5),
    }
)
RAILS, PEAK = 2, (3, 4)  # points of the envelopes
ENGINE, BESIDE = "engine", ("bumper", "engine_bay")

INTRODUCTION = """# The four numbers of the corners

Written by `python tests/validation/scan_corners.py`. Tests: [small overlap](README.md), 25 % at 64 km/h,
medians and quartiles of 150 cars. Vehicles: passenger car, minivan and pickup, with the same four numbers.

Each number is varied while the other three stay. Misfit: root mean square of the difference from the median,
over half the distance of the quartiles, of three vehicles at six times. At 1 the vehicles are as far from the
median as the quartiles are. The least misfit of a column is bold.

The engine's peak follows its width and the share beside it, so that the front as a whole stays as strong.
"""


@dataclass(frozen=True)
class Misfit:
    """How far three vehicles are from the tests with one number changed; core: steps of core contact."""

    number: str
    value: float
    along: float
    across: float
    together: float
    within: int  # rows within the quartiles
    rows: int
    core: int
    travel: float  # greatest change at a full-width wall, relative


@cache
def preset(name: str, width: float) -> birm3d.Vehicle:
    """A preset whose engine has a width [m]."""
    path = preset_path(name)
    document = tomlkit.parse(path.read_text(encoding="utf-8"))
    document["zone"][ENGINE]["y_m"] = [0.0, 0.5 * width]
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / path.name
        file.write_text(tomlkit.dumps(document), encoding="utf-8")
        return birm3d.Vehicle.from_file(file)


def area(vehicle: birm3d.Vehicle, *zones: str) -> float:
    """Area of zones [m2]."""
    numbers = [list(vehicle.zones).index(zone) for zone in zones]
    return float(vehicle.area[np.isin(vehicle.zone_of_node, numbers)].sum())


def with_numbers(name: str, values: Mapping[str, float]) -> birm3d.Vehicle:
    """A preset with the numbers of its file, but for the flank's factor."""
    old, new = preset(name, CHOSEN[WIDTH]), preset(name, values[WIDTH])
    engine = old.zones[ENGINE].envelope
    rails, rise = engine[RAILS][1], engine[PEAK[0]][1] - engine[RAILS][1]
    whole = area(old, ENGINE) + CHOSEN[SHARE] * area(old, *BESIDE)
    rise *= whole / (area(new, ENGINE) + values[SHARE] * area(new, *BESIDE))
    stress = {ENGINE: rails + rise, **dict.fromkeys(BESIDE, rails + values[SHARE] * rise)}
    zones = {zone: with_peak(new.zones[zone], value) for zone, value in stress.items()}
    along = new.zones["wheel_house.along"]
    zones["wheel_house.along"] = along.scaled(max(values[ALONG], 1e-6) / CHOSEN[ALONG])
    return new.with_zones(zones)


def with_peak(zone: birm3d.Zone, stress: float) -> birm3d.Zone:
    """A zone with a peak [Pa]; the slope of unloading follows the steepest of the envelope."""
    points = tuple((depth, stress if i in PEAK else old) for i, (depth, old) in enumerate(zone.envelope))
    share = steepest(points) / steepest(zone.envelope)
    return dataclasses.replace(zone, envelope=points, k_unloading=zone.k_unloading * max(share, 1.0))


def steepest(points: Sequence[tuple[float, float]]) -> float:
    """Greatest slope of an envelope [Pa/m]."""
    depth, stress = np.array(points).T
    return float((np.diff(stress) / np.diff(depth)).max())


def travel(vehicle: birm3d.Vehicle) -> float:
    """Greatest displacement at a full-width wall [m]."""
    crash = birm3d.Simulation(vehicle, birm3d.Barrier.rigid_wall(), units.km_h(56.0))
    return float(crash.run().metrics["max_displacement"])


@cache
def travel_as_it_is(name: str) -> float:
    return travel(birm3d.Vehicle.preset(name))


def misfit(number: str, value: float) -> Misfit:
    """Run the three vehicles with one number changed."""
    values = {**CHOSEN, number: value}
    rows, travels = [], []
    for name in kind_small_overlap.VEHICLES:
        vehicle = with_numbers(name, values)
        crash = kind_small_overlap.simulation(vehicle, edge_flank_factor=values[FLANK])
        rows += kind_small_overlap.compared(name, crash.run())
        travels.append(travel(vehicle) / travel_as_it_is(name) - 1.0)
    compared = [row for row in rows if row.quantity != "core contact"]
    off = np.array([2.0 * (row.predicted - row.measured) / (row.high - row.low) for row in compared])
    is_along = np.array([row.quantity.endswith("along") for row in compared])
    along, across, together = (
        float(np.sqrt(np.mean(part**2))) for part in (off[is_along], off[~is_along], off)
    )
    return Misfit(
        *(number, value, along, across, together),
        within=sum(row.met for row in compared),
        rows=len(compared),
        core=sum(int(row.predicted) for row in rows if row.quantity == "core contact"),
        travel=max(travels, key=abs),
    )


def scan() -> Iterator[Misfit]:
    """Every row of the page."""
    for number, values in SCAN.items():
        for value in values:
            yield misfit(number, value)
        print(number, flush=True)


def read() -> list[Misfit]:
    """What :func:`comparison.write_rows` wrote."""
    with RESULTS.open(encoding="utf-8") as file:
        return [
            Misfit(
                number=row["number"],
                **{name: float(row[name]) for name in ("value", "along", "across", "together", "travel")},
                **{name: int(row[name]) for name in ("within", "rows", "core")},
            )
            for row in csv.DictReader(file)
        ]


def table(number: str, rows: Sequence[Misfit]) -> Iterator[str]:
    """Lines of one number's table."""
    yield f"## {NUMBERS[number]}\n"
    yield "| value | misfit along | across | together | within the quartiles |"
    yield "|" + "---|" * 5
    least = {name: min(getattr(row, name) for row in rows) for name in ("along", "across", "together")}
    for row in rows:
        cells = [f"{row.value:g}" + (", chosen" if row.value == CHOSEN[number] else "")]
        for name, value in least.items():
            told = f"{getattr(row, name):.2f}"
            cells.append(f"**{told}**" if getattr(row, name) == value else told)
        yield f"| {' | '.join(cells)} | {row.within} of {row.rows} |"
    yield ""


def page(found: Sequence[Misfit]) -> str:
    """The text of corners.md."""
    travel, core = max(abs(row.travel) for row in found), sum(row.core > 0 for row in found)
    lines = [
        INTRODUCTION,
        f"Travel at a full-width wall at 56 km/h then changes by at most {100.0 * travel:.1f} %. "
        f"The rigid core is met in {core} of {len(found)} rows.\n",
    ]
    for number in SCAN:
        lines += table(number, [row for row in found if row.number == number])
    return "\n".join(lines).rstrip() + "\n"


def main() -> int:
    write_rows(RESULTS, list(scan()))
    PAGE.write_text(page(read()), encoding="utf-8", newline="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
