"""The front of the finite-element truck in few numbers: what fit_truck.py fits, and fewer of them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType

import birm3d
from birm3d.simulation.parameters import varied
from truck_runs import runs, scene

LEAST_RATE = 0.003  # s/m; fitted as a logarithm too


@dataclass(frozen=True)
class Number:
    """What is fitted: numbers of the scene that share one value, SI.

    Before the fit, ``likely`` is the middle of its logarithm plus and minus two standard deviations. It comes
    from the table of parts and from sections. Stresses are those at rest: at 15 m/s a rate sensitivity of
    0.05 s/m makes them 1.75 times as great. ``lower`` and ``upper`` are bounds.
    """

    name: str
    unit: str
    names: tuple[str, ...]
    likely: tuple[float, float]
    lower: float
    upper: float
    why: str
    less: Mapping[str, float] = field(default_factory=dict)  # by which some of the numbers are smaller

    @property
    def start(self) -> float:
        """Middle of what is likely."""
        return math.sqrt(self.likely[0] * self.likely[1])

    @property
    def doubt(self) -> float:
        """Standard deviation of the logarithm."""
        return 0.25 * math.log(self.likely[1] / self.likely[0])


def stresses(*zones: str, points: Sequence[int]) -> tuple[str, ...]:
    return tuple(f"zone.{zone}.stress[{i}]" for zone in zones for i in points)


_SHEET = (
    *stresses("bumper_end", "hood", "fender", points=(1, 2)),
    *stresses("engine", points=(1, 2)),
)
_TAIL, _MIDDLE_TAIL, _MIDDLE_DEPTH = "tail", "tail of the middle", "tail of the middle from"
NUMBERS = (
    Number(
        "brackets",
        "Pa",
        stresses("rails", points=(1, 2)),
        (1e6, 3.5e6),
        0.2e6,
        15e6,
        "open sections of 2.4e-3 m2 fold at a tenth to a quarter of what squashes them",
    ),
    Number(
        "rails, squashed",
        "Pa",
        stresses("rails", points=(3, 4)),
        (5e6, 14e6),
        2e6,
        30e6,
        "two sections of 2.7e-3 m2 at 450 to 650 MPa on 0.18 m2: 14 to 20 MPa; a third of that, at rest, "
        "if they buckle first",
    ),
    Number(
        "rails, folding",
        "Pa",
        stresses("rails", points=(5, 6)),
        (0.4e6, 4e6),
        0.2e6,
        12e6,
        "a twentieth to a third of that",
    ),
    Number(
        "bumper between the rails",
        "Pa",
        stresses("bumper_middle", points=(1, 2)),
        (0.2e6, 1e6),
        0.05e6,
        4e6,
        "a channel of 6 mm bends: 4 to 16 times 20 kN m over the span of 0.7 m, on 0.3 to 0.4 m2",
    ),
    Number(
        "engine",
        "Pa",
        stresses("bumper_middle", "engine", points=(3, 4)),
        (1e6, 2.5e6),
        0.3e6,
        12e6,
        "its accessories yield at 2 MPa and harden to 5 MPa, on a part of the area",
    ),
    Number(
        "behind the engine",
        "Pa",
        stresses("bumper_middle", "engine", points=(5, 6)),
        (0.3e6, 1.5e6),
        0.1e6,
        6e6,
        "mounts of 240 kN, cross members, cab; less than the engine",
    ),
    Number(
        "sheet",
        "Pa",
        _SHEET,
        (8e3, 40e3),
        4e3,
        600e3,
        "a closed box of 1 mm folds at 40 kPa on 1 m2, open panels bend at a fifth",
    ),
    Number(
        _TAIL,
        "Pa/m",
        tuple(f"zone.{zone}.tail_slope" for zone in ("rails", "bumper_end", "hood")),
        (0.5e6, 5e6),
        0.1e6,
        20e6,
        "a megapascal within 0.2 to 2 m; no run crushes them so far that it tells",
    ),
    Number(
        _MIDDLE_TAIL,
        "Pa/m",
        ("zone.bumper_middle.tail_slope", "zone.engine.tail_slope"),
        (2e6, 15e6),
        0.3e6,
        80e6,
        "bumper, radiator and cab jam on the engine between the rails: megapascals within 0.2 to 0.5 m",
    ),
    Number(
        _MIDDLE_DEPTH,
        "m",
        ("zone.bumper_middle.tail_depth", "zone.engine.tail_depth"),
        (0.95, 1.95),
        0.6,
        2.2,
        "beside the engine, a block of 1.0 m, 0.95 m are left before the second cross member and 1.95 m "
        "before the bed",
        {"zone.engine.tail_depth": 0.3},  # it begins so far behind the bumper
    ),
    Number(
        "rate sensitivity",
        "s/m",
        ("vehicle.rate_sensitivity",),
        (0.03, 0.08),
        LEAST_RATE,
        0.1,
        "vehicles N and S: 0.04 and 0.06",
    ),
    Number(
        "indentation length",
        "m",
        ("vehicle.indentation_length",),
        (0.45, 0.8),
        0.1,
        1.2,
        "vehicles N and S at a pole of 0.35 m",
    ),
    Number(
        "tyres",
        "",
        ("zone.tire_front.scale", "zone.tire.scale"),
        (1.25, 5.0),
        0.5,
        8.0,
        "rims and hangers of 75 kN beside the rubber",
    ),
)


@dataclass(frozen=True)
class Variant:
    """A front with fewer numbers, some held or driven by another one; or the truck with a bed that slides."""

    name: str
    held: Mapping[str, float] = field(default_factory=dict)
    same: Mapping[str, str] = field(default_factory=dict)
    sliding_bed: bool = False


VARIANTS = (
    Variant("all numbers"),
    Variant("all numbers, with a bed that slides", sliding_bed=True),
    Variant(
        "tail of the middle as that of the others",
        held=MappingProxyType({_MIDDLE_DEPTH: 1.6}),
        same=MappingProxyType({_MIDDLE_TAIL: _TAIL}),
    ),
)


def vehicle_with(values: Mapping[str, float], base: birm3d.Vehicle) -> birm3d.Vehicle:
    """The vehicle with the numbers' values, by their names."""
    given = {
        name: values[number.name] - number.less.get(name, 0.0) for number in NUMBERS for name in number.names
    }
    any_scene = scene(base, next(iter(runs().values())))
    return varied(any_scene, given).scene.vehicle
