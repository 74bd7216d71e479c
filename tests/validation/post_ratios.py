"""Sideways over forward impulse on a post: every vehicle's greatest ratio, and where two are from.

Computed and written by posts.py. Two runs stand beside each other: with tyres that meet the post, and with
tyres that meet the ground only. What is left then is of the skin and the rigid core; core contact is counted.
"""

from __future__ import annotations

import csv
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import birm3d
import numpy as np
from finite_element import POLE_DIAMETER
from post_runs import crash, half_width, impulse, speed, vehicle

RESULTS = Path(__file__).parent / "results"
RATIOS, PARTS = RESULTS / "post_ratios.csv", RESULTS / "post_parts.csv"
VEHICLES = ("fitted_n", "fitted_s", "fitted_truck", *birm3d.Vehicle.presets())
MARK, UP_TO = 0.35, 0.9
SHARES = np.linspace(0.0, UP_TO, 19)  # of the half width
TRUCK, VAN = "fitted_truck", "van_3500"
EXPLAINED = (TRUCK, VAN)
SHEET = ("bumper_end", "hood", "fender")
STRONGER = 5.0
# Until the platform of the truck comes to the post, 2.9 m behind the bumper. Impulses of zones end then.
PLATFORM = 0.13  # s
LEAST = 0.02  # of the forward impulse, of a zone that has a row of its own
HEAVY = 1e3  # factor on the mass of a vehicle that keeps its speed
ADDED_UP = 1e-4  # tolerance of runs whose sum is compared: at 1e-3 it is 0.5 % off


@dataclass(frozen=True)
class Ratio:
    """Impulse on a post at an offset, forward and to the left [N s]; core: steps in which it was met.

    momentum: of the vehicle at first [N s]. tires: whether they meet the post.
    """

    vehicle: str
    tires: bool
    offset_share: float
    forward: float
    left: float
    core: int
    momentum: float

    @property
    def ratio(self) -> float:
        """Sideways over forward impulse; nought where nothing is touched."""
        return abs(self.left) / self.forward if self.forward > 1.0 else 0.0


@dataclass(frozen=True)
class Part:
    """Impulse of a vehicle on the post where its ratio is greatest, of a run or of one zone alone [N s]."""

    vehicle: str
    kind: str  # "run" or "zone"
    what: str
    forward: float
    left: float


def ratios() -> Iterator[Ratio]:
    """Every crash of the table."""
    for name in VEHICLES:
        who = vehicle(name)
        for tires, met in ((True, who), (False, who.without_tire_contact())):
            for share in SHARES.tolist():
                yield ratio(name, met, tires, share)
    print("ratios", flush=True)


def ratio(name: str, who: birm3d.Vehicle, tires: bool, share: float) -> Ratio:
    """Run a vehicle at a post that stands a share of its half width to the right."""
    result = crash(who, speed(name), share * half_width(who), diameter=POLE_DIAMETER)
    forward, left = impulse(result)
    core = int(result.statistics.body_steps)
    return Ratio(name, tires, share, float(forward), float(left), core, who.mass * speed(name))


def parts(rows: Sequence[Ratio]) -> Iterator[Part]:
    """Where the impulses of the vehicles that are explained are from."""
    yield from runs_of_truck(greatest(rows, TRUCK, tires=True).offset_share)
    for name in EXPLAINED:
        yield from zones(name, greatest(rows, name, tires=True).offset_share)


def runs_of_truck(share: float) -> Iterator[Part]:
    """The truck as it is, and with changes that tell what matters."""
    truck = vehicle(TRUCK)
    sheet = truck.with_zones({zone: truck.zones[zone].scaled(STRONGER) for zone in SHEET})
    for what, who, until in (
        ("as it is", truck, np.inf),
        ("before the platform comes", truck, PLATFORM),
        ("without tyres", truck.without_tire_contact(), np.inf),
        ("with a stronger sheet", sheet, np.inf),
        ("with a stronger sheet, without tyres", sheet.without_tire_contact(), np.inf),
    ):
        yield Part(TRUCK, "run", what, *at_the_end(TRUCK, who, share, until))


def zones(name: str, share: float) -> Iterator[Part]:
    """Each zone of a vehicle that keeps its speed, alone, and all together."""
    who = vehicle(name)
    with warnings.catch_warnings():
        for doubt in (birm3d.MassWarning, birm3d.UnitWarning):  # no vehicle has this mass
            warnings.simplefilter("ignore", doubt)
        heavy = who.with_gvw(HEAVY * who.mass)
    for zone in heavy.zones:
        yield Part(name, "zone", zone, *at_the_end(name, alone(heavy, zone), share, PLATFORM, ADDED_UP))
    yield Part(name, "zone", "all together", *at_the_end(name, heavy, share, PLATFORM, ADDED_UP))


def at_the_end(
    name: str, who: birm3d.Vehicle, share: float, until: float, tolerance: float = 1e-3
) -> tuple[float, float]:
    """Impulse on a post at a share of the half width, forward and to the left [N s]."""
    result = crash(who, speed(name), share * half_width(who), diameter=POLE_DIAMETER, tolerance=tolerance)
    forward, left = impulse(result, until).tolist()
    return forward, left


def alone(who: birm3d.Vehicle, zone: str) -> birm3d.Vehicle:
    """The vehicle with one zone; the others have next to no stress."""
    return who.with_zones({name: law.scaled(1e-6) for name, law in who.zones.items() if name != zone})


def read_ratios() -> list[Ratio]:
    """What :func:`comparison.write_rows` wrote of the ratios."""
    numbers = ("offset_share", "forward", "left", "momentum")
    with RATIOS.open(encoding="utf-8") as file:
        return [
            Ratio(
                vehicle=row["vehicle"],
                tires=row["tires"] == "True",
                core=int(row["core"]),
                **{name: float(row[name]) for name in numbers},
            )
            for row in csv.DictReader(file)
        ]


def read_parts() -> list[Part]:
    """What :func:`comparison.write_rows` wrote of the parts."""
    with PARTS.open(encoding="utf-8") as file:
        return [
            Part(row["vehicle"], row["kind"], row["what"], float(row["forward"]), float(row["left"]))
            for row in csv.DictReader(file)
        ]


def greatest(rows: Sequence[Ratio], name: str, tires: bool) -> Ratio:
    """The row of a vehicle's greatest ratio."""
    own = [row for row in rows if row.vehicle == name and row.tires == tires]
    return max(own, key=lambda row: row.ratio)


def _cells(row: Ratio) -> list[str]:
    told = f"{row.ratio:.3f}" if row.ratio < MARK else f"**{row.ratio:.3f}**"
    return [told, f"{row.offset_share:.2f}", f"{1e-3 * abs(row.left):.1f}", f"{1e-3 * row.forward:.1f}"]


INTRODUCTION = """
## The greatest ratio up to {up_to:g} of the half width

Mark: below {mark:g} up to {up_to:g} of the half width, a target. It is met by {met} of {count} vehicles.
Beyond it, in bold: {beyond}. Without tyres at the post: {bare}.

Impulses stand beside, as a ratio of two small ones says little. The share is that of the vehicle's
momentum. Without tyres at the post, the load is of the skin and the rigid core. The core is met in {core} of
{runs} runs. The flank of an indentation gets steeper as the post gets deeper: vehicles that go on beside the
post have more.

Three vehicles exceed the mark by less than a tenth of it: `van_3500`, `mash_10000s` and `bus_13t`. Beside its
rails the front of the bus is soft, so that the forward impulse is small.

| vehicle | ratio | at | sideways, kN s | forward, kN s | share | no tyres: ratio | at | sideways | forward |
|---|---|---|---|---|---|---|---|---|---|"""


def section(rows: Sequence[Ratio], of_zones: Sequence[Part]) -> str:
    """The page's part on the greatest ratio of each vehicle."""
    met, bare = ({name: greatest(rows, name, tires) for name in VEHICLES} for tires in (True, False))
    beyond, skin = ([name for name in VEHICLES if of[name].ratio >= MARK] for of in (met, bare))
    numbers = {"mark": MARK, "up_to": UP_TO, "count": len(VEHICLES), "met": len(VEHICLES) - len(beyond)}
    names = {"beyond": ", ".join(beyond) or "none", "bare": ", ".join(skin) or "none"}
    core = {"core": sum(row.core > 0 for row in rows), "runs": len(rows)}
    lines = [INTRODUCTION.format(**numbers, **names, **core)]
    for name in VEHICLES:
        share = f"{100.0 * met[name].forward / met[name].momentum:.0f} %"
        lines.append(f"| {' | '.join([name, *_cells(met[name]), share, *_cells(bare[name])])} |")
    lines += ["", WHY.format(until=PLATFORM, heavy=HEAVY)]
    for name in EXPLAINED:
        share = met[name].offset_share
        lines += _why(name, share, [row for row in of_zones if row.vehicle == name])
    return "\n".join(lines)


WHY = """### Where it is from

In the tables of zones each vehicle is {heavy:,.0f} times as heavy and keeps its speed. One zone at a time has
its stress. Impulses are those until {until:g} s.
"""
RUNS = """\
The inner face of the post is {face:.2f} m from the middle. Each row is a run. The stronger sheet has
{stronger:g} times the stress in the ends of the bumper, hood and fender.
"""
OF_VAN = """\
- **Bumper and engine bay.** They are before the post, and press its flank with 0.35 of what a wedge of
  its slope gives. The slope grows with the depth. At {crush:.1f} m this is beyond the mark by itself.
- **Engine.** It stands beside the post, and presses the same flank. Its ratio is greater, as that of the
  rails of the truck is.
"""
REASONS = """- **Rails.** They stand 0.35 to 0.5 m from the middle, beside the post. The indentation is
  {length:.2f} m long and draws them in. Skin far from a post goes in by less than the post does. Both press
  the post's flank with the same share, 0.35, of what a wedge of that slope gives. So the ratio of a zone
  grows with its distance. That is the law of [`indentation.hpp`](../../cpp/src/kernels/indentation.hpp). With
  another length the ratio is beyond the mark, too.
- **Sheet.** The ends of the bumper have {stress:.0f} kPa; the lower bound of the fit is 10 kPa. No run has a
  post there. So little loads the post forward. With a stronger sheet the ratio is less.
- **Front tyre.** It stands 0.76 to 1.01 m from the middle. Its tread pushes the truck off the post, so that
  less of the front is met.
- **Platform.** It is the widest part, and comes to the post last, with its edge.
- **The runs.** In that of two posts, at 0.35 and 0.70 of the half width, ratios are 0.68 and 0.81. So the
  mark, which vehicle N meets, is not one of this truck.
"""


def _why(name: str, share: float, rows: Sequence[Part]) -> Iterator[str]:
    """Tables of a vehicle's parts, and what they say."""
    *zones, whole = (row for row in rows if row.kind == "zone")
    large = [row for row in zones if max(row.forward, abs(row.left)) >= LEAST * whole.forward]
    others = [row for row in zones if row not in large]
    sums = (sum(getattr(row, way) for row in others) for way in ("forward", "left"))
    yield f"**{name}, post at {share:.2f}**\n"
    yield from _table("zone", [*large, Part(name, "zone", "others", *sums), whole])
    if name == TRUCK:
        who = vehicle(name)
        yield RUNS.format(face=share * half_width(who) - 0.5 * POLE_DIAMETER, stronger=STRONGER)
        yield from _table("run", [row for row in rows if row.kind == "run"])
        stress = 1e-3 * who.zones[SHEET[0]].envelope[1][1]
        yield REASONS.format(length=who.indentation_length, stress=stress)
    else:
        run = crash(vehicle(name), speed(name), share * half_width(vehicle(name)), diameter=POLE_DIAMETER)
        yield OF_VAN.format(crush=run.metrics["dynamic_crush"])


def _table(head: str, rows: Sequence[Part]) -> Iterator[str]:
    yield f"| {head} | forward, kN s | sideways, kN s | ratio |"
    yield "|---|---|---|---|"
    for row in rows:
        ratio = abs(row.left) / row.forward
        yield f"| {row.what} | {1e-3 * row.forward:.1f} | {1e-3 * abs(row.left):.1f} | {ratio:.2f} |"
    yield ""
