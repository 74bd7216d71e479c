"""The front of the finite-element truck in few numbers: what fit_truck.py fits, and fewer of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType

import birm3d
from birm3d.scene_parameters import varied
from truck_runs import runs, scene

LEAST_RATE = 0.003  # s/m; fitted as a logarithm too


@dataclass(frozen=True)
class Number:
    """What is fitted: numbers of the scene that share one value; start and bounds, SI."""

    name: str
    unit: str
    names: tuple[str, ...]
    start: float
    lower: float
    upper: float
    why: str


def stresses(*zones: str, points: Sequence[int]) -> tuple[str, ...]:
    return tuple(f"zone.{zone}.stress[{i}]" for zone in zones for i in points)


_FRONT = ("rails", "bumper_middle", "bumper_end", "engine", "hood")
_SHEET = (
    *stresses("bumper_end", "hood", "fender", points=(1, 2)),
    *stresses("engine", points=(1, 2)),
)
NUMBERS = (
    Number(
        "brackets",
        "Pa",
        stresses("rails", points=(1, 2)),
        1.5e6,
        0.2e6,
        5e6,
        "plates that bend before the rails",
    ),
    Number(
        "rails, squashed",
        "Pa",
        stresses("rails", points=(3, 4)),
        8e6,
        2e6,
        20e6,
        "two sections of 2.7e-3 m2 at 450 to 650 MPa on 0.18 m2: 14 to 20 MPa; less if they buckle first",
    ),
    Number(
        "rails, folding",
        "Pa",
        stresses("rails", points=(5, 6)),
        1e6,
        0.3e6,
        7e6,
        "a twentieth to a third of that",
    ),
    Number(
        "bumper between the rails",
        "Pa",
        stresses("bumper_middle", points=(1, 2)),
        0.3e6,
        0.1e6,
        2e6,
        "a channel of 6 mm that bends",
    ),
    Number(
        "engine",
        "Pa",
        stresses("bumper_middle", "engine", points=(3, 4)),
        1.5e6,
        0.3e6,
        8e6,
        "accessories of the engine yield at 2 MPa, on a part of the area",
    ),
    Number(
        "behind the engine",
        "Pa",
        stresses("bumper_middle", "engine", points=(5, 6)),
        0.8e6,
        0.1e6,
        4e6,
        "mounts, cross members, cab; less than the engine",
    ),
    Number("sheet", "Pa", _SHEET, 20e3, 10e3, 300e3, "sheet of 1 mm in bending: ten to some hundred kPa"),
    Number(
        "tail",
        "Pa/m",
        tuple(f"zone.{zone}.tail_slope" for zone in _FRONT),
        3e6,
        0.3e6,
        50e6,
        "megapascals within 0.2 to 0.5 m",
    ),
    Number(
        "rate sensitivity",
        "s/m",
        ("vehicle.rate_sensitivity",),
        0.045,
        LEAST_RATE,
        0.08,
        "vehicles N and S: 0.04 and 0.06",
    ),
    Number(
        "indentation length",
        "m",
        ("vehicle.indentation_length",),
        0.6,
        0.15,
        1.0,
        "half to three diameters of a post",
    ),
    Number(
        "tyres",
        "",
        ("zone.tire_front.scale", "zone.tire.scale"),
        2.5,
        0.5,
        6.0,
        "rims and hangers of 75 kN beside the rubber",
    ),
)


@dataclass(frozen=True)
class Variant:
    """A front with fewer numbers: some held, or driven by another one."""

    name: str
    held: Mapping[str, float] = field(default_factory=dict)
    same: Mapping[str, str] = field(default_factory=dict)


VARIANTS = (
    Variant("all numbers"),
    Variant("no rate sensitivity", held=MappingProxyType({"rate sensitivity": 0.0})),
    Variant(
        "rails and engine alike",
        same=MappingProxyType(
            {
                "bumper between the rails": "brackets",
                "engine": "rails, squashed",
                "behind the engine": "rails, folding",
            }
        ),
    ),
)


def vehicle_with(values: Mapping[str, float], base: birm3d.Vehicle) -> birm3d.Vehicle:
    """The vehicle with the numbers' values, by their names."""
    given = {name: values[number.name] for number in NUMBERS for name in number.names}
    any_scene = scene(base, next(iter(runs().values())))
    return varied(any_scene, given).scene.vehicle
