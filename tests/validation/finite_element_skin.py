"""The skin of the finite-element vehicles N and S: zones where their parts are, and the numbers to fit.

A front has two zones: what stands beside the rails and sides (outer), and what is between (inner). Each has
an envelope with few points, and a tail that begins where the parts behind it do. Side panels ahead of the
passenger cell are a third zone, which resists across and along the vehicle. All give back the same short
length. The rate of deflection and the reach of a post's indentation are numbers of the whole vehicle.

Six or seven runs do not tell every number. Each has a value that is expected before a run is seen, and a
width: a fit counts a departure by one width as one residual.
"""

from __future__ import annotations

import math
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import birm3d
import numpy as np
import numpy.typing as npt
import tomlkit
from birm3d.vehicle import build
from birm3d.vehicle.zone_law import ZoneLaw

Floats = npt.NDArray[np.float64]

DATA = Path(__file__).resolve().parents[1] / "data/finite_element"
# Of what lies beside the zones that are fitted: thin panels, order of magnitude.
SKIN = {
    "panels": ["front", "rear", "side", "top", "bottom"],
    "k_initial_Pa_per_m": 0.5e6,
    "knee_m": 0.1,
    "k_hardening_Pa_per_m": 0.0,
    "f_max_Pa": 0.05e6,
    "k_unloading_Pa_per_m": 1.0e7,
    "source": ["soft-skin"],
    "status": "estimated",
}
FENDER_KNEE = 0.05  # m
ALONG_KNEE = 0.1  # m
STRESS_WIDTH = 1.0  # natural logarithm: the factor e, of sheets whose folds are not known


@dataclass(frozen=True)
class Unknown:
    """A number to be fitted: its bounds, what is expected of it, and how far it may be from that.

    log: its logarithm is what is varied, and the width is one of a natural logarithm.
    """

    name: str
    low: float
    high: float
    expected: float
    width: float = STRESS_WIDTH
    unit: str = "Pa"
    log: bool = True

    def value(self, share: float) -> float:
        """Between the bounds, by its share of the way."""
        if self.log:
            return float(self.low * (self.high / self.low) ** share)
        return float(self.low + share * (self.high - self.low))

    def share(self, value: float) -> float:
        if self.log:
            return math.log(value / self.low) / math.log(self.high / self.low)
        return (value - self.low) / (self.high - self.low)

    def shift(self, departure: float) -> float:
        """The value that departs from what is expected by so many widths."""
        away = departure * self.width
        return self.expected * math.exp(away) if self.log else self.expected + away

    def departure(self, value: float) -> float:
        """From what is expected, in widths."""
        away = math.log(value / self.expected) if self.log else value - self.expected
        return away / self.width


@dataclass(frozen=True)
class Skin:
    """Where the zones of a vehicle are (m, file axes), and what is known of their numbers.

    split: distance from the middle plane where the outer zone of the front begins. outer, inner: points of
    the envelopes, depth and expected stress [m, Pa]. fender: range of x. fender_stress: expected, across and
    along the vehicle [Pa]. tail_depths: bounds and expected value [m]. fit_density: relative number of
    elements while fitting. expected: text of the file, where the expected values come from.
    """

    key: str
    element_size: float
    split: float
    outer: tuple[tuple[float, float], ...]
    inner: tuple[tuple[float, float], ...]
    fender: tuple[float, float]
    fender_stress: tuple[float, float]
    tail_depths: tuple[float, float, float]
    tail_width: float
    tail_slopes: tuple[float, float]
    half_width: float
    structure: str
    expected: str
    fit_density: float = 1.0

    @property
    def unknowns(self) -> tuple[Unknown, ...]:
        low, high, depth = self.tail_depths
        outer_slope, inner_slope = self.tail_slopes
        return (
            *(Unknown(f"outer stress at {d:g} m", 1e4, 2e7, stress) for d, stress in self.outer),
            *(Unknown(f"inner stress at {d:g} m", 1e4, 1e7, stress) for d, stress in self.inner),
            Unknown("fender stress", 5e3, 5e6, self.fender_stress[0]),
            Unknown("fender stress along", 5e3, 5e6, self.fender_stress[1]),
            Unknown("outer tail depth", low, high, depth, self.tail_width, "m", log=False),
            Unknown("inner tail depth", low, high, depth, self.tail_width, "m", log=False),
            Unknown("outer tail slope", 3e5, 1e8, outer_slope, 1.0, "Pa/m"),
            Unknown("inner tail slope", 3e5, 1e8, inner_slope, 1.0, "Pa/m"),
            Unknown("elastic recovery", 3e-3, 0.12, 0.01, 0.7, "m"),
            Unknown("rate sensitivity", 0.0, 0.12, 0.04, 0.02, "s/m", log=False),
            Unknown("indentation length", 0.1, 1.5, self.half_width, 0.2, "m", log=False),
        )

    def values(self, shares: Floats) -> dict[str, float]:
        return {u.name: u.value(float(s)) for u, s in zip(self.unknowns, shares, strict=True)}

    def departures(self, shares: Floats) -> Floats:
        """From what is expected, in widths, shape (n,)."""
        values = self.values(shares)
        return np.array([unknown.departure(values[unknown.name]) for unknown in self.unknowns])

    def start(self, departures: Floats) -> Floats:
        """Shares of the unknowns that depart from what is expected by so many widths; within the bounds."""
        pairs = zip(self.unknowns, departures, strict=True)
        wanted = [(u, u.shift(float(d))) for u, d in pairs]
        return np.array([u.share(min(max(value, u.low), u.high)) for u, value in wanted])


# Least slope of unloading over the steepest of loading. With 5/3 a curve of degree 5 gives back what a line
# of the slope of loading would.
LEAST = 1.01 * 5.0 / 3.0


SKINS = {
    "n": Skin(
        "n",
        element_size=0.1,
        split=0.55,
        outer=((0.03, 4e6), (0.15, 8e5), (0.35, 8e5), (0.7, 8e5), (1.0, 8e5)),
        inner=((0.1, 2e5), (0.5, 2e5), (1.0, 2e5)),
        fender=(-1.0, 0.9),
        fender_stress=(8e5, 3e5),
        tail_depths=(0.7, 1.15, 0.93),
        tail_width=0.1,
        tail_slopes=(5e6, 5e6),
        half_width=0.7,
        structure="""
Bounds of the zones by the parts of the model: bumper (3 mm) over the whole width, 0.11 m deep, grille (1 mm)
behind it; side panels (2 mm) from there on. The hood ends 1.0 m behind the front, where the tail may begin
""",
        expected="""
Expected before a run is seen, chosen by hand with a factor of 2.7 either way: sheets over the area of their
zone, with a yield stress of 250 MPa. Ends of the bumper reach 4 MPa before they fold. Side panels have 3.3
MPa, and fold at a quarter. Hood and floor have 1.2 MPa, and buckle at a sixth, as wide plates do. Along the
sides a fold of 0.4 m has 0.3 MPa. Tail: 0.93 +/- 0.1 m, 5 MPa/m within a factor of 2.7. Both vehicles:
recovery 1 cm within a factor of 2, rate sensitivity 0.04 +/- 0.02 s/m, indentation half the width +/- 0.2 m
""",
        fit_density=0.5,
    ),
    "s": Skin(
        "s",
        element_size=0.1,
        split=0.55,
        outer=((0.05, 6e5), (0.25, 6e5)),
        inner=((0.05, 6e5), (0.25, 6e5)),
        fender=(-0.4, 0.7),
        fender_stress=(6e5, 3e5),
        tail_depths=(0.2, 0.45, 0.3),
        tail_width=0.05,
        tail_slopes=(5e6, 5e6),
        half_width=0.825,
        structure="""
Bounds of the zones by the parts of the model: bumper (1.5 mm), fenders from 0.1 to 1.1 m behind the front.
A solid engine 0.76 m wide and wheels begin at 0.43 m; tails begin before, as what is between is packed
""",
        expected="""
Expected before a run is seen, chosen by hand with a factor of 2.7 either way: mean forces at walls of 0.26
to 0.76 MN over the 0.72 m2 of the front are 0.4 to 1 MPa, and 0.6 MPa stands everywhere. Along the sides half
of that. Tail: 0.3 +/- 0.05 m, 5 MPa/m within a factor of 2.7. Both vehicles: recovery 1 cm within a factor
of 2, rate sensitivity 0.04 +/- 0.02 s/m, indentation half the width +/- 0.2 m
""",
    ),
}


def _law(depths: Sequence[float], values: Mapping[str, float], side: str) -> birm3d.Zone:
    """An envelope with its tail; the least slope of unloading follows the law's steepest of loading."""
    points = ((0.0, 0.0), *((d, values[f"{side} stress at {d:g} m"]) for d in depths))
    depth, slope = values[f"{side} tail depth"], values[f"{side} tail slope"]
    steepest = 0.0
    for (d0, s0), (d1, s1) in pairwise(points):
        steepest = max(steepest, (s1 - s0) / (d1 - d0) + (slope if d1 > depth else 0.0))
    return birm3d.Zone(
        envelope=points,
        k_unloading=LEAST * max(steepest, slope),
        elastic_recovery=values["elastic recovery"],
        tail_depth=depth,
        tail_slope=slope,
    )


def zones(skin: Skin, values: Mapping[str, float]) -> dict[str, birm3d.Zone]:
    """Laws of the zones that are fitted."""
    found = {}
    for side, points in (("outer", skin.outer), ("inner", skin.inner)):
        found[f"front_{side}"] = _law([depth for depth, _ in points], values, side)
    stress = values["fender stress"]
    found["fender"] = birm3d.Zone(
        k_initial=stress / FENDER_KNEE,
        knee=FENDER_KNEE,
        k_hardening=0.0,
        f_max=stress,
        k_unloading=LEAST * stress / FENDER_KNEE,
        elastic_recovery=values["elastic recovery"],
    )
    along = values["fender stress along"]
    found["fender.along"] = birm3d.Zone(
        envelope=((0.0, 0.0), (ALONG_KNEE, along)),
        k_unloading=LEAST * along / ALONG_KNEE,
        elastic_recovery=values["elastic recovery"],
    )
    return found


def changed(vehicle: birm3d.Vehicle, skin: Skin, values: Mapping[str, float]) -> birm3d.Vehicle:
    """A vehicle of :func:`vehicle_with` with other numbers, without a look at its file."""
    recipe = vehicle.recipe.with_zones(zones(skin, values))
    numbers = {
        "rate_sensitivity": values["rate sensitivity"],
        "indentation_length": values["indentation length"],
    }
    return build(recipe.each(**numbers))


def vehicle_with(skin: Skin, values: Mapping[str, float], fit: str) -> birm3d.Vehicle:
    """The vehicle of the base file with the skin; `fit` is the text of its source."""
    document = _document(skin, values, fit)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "vehicle.toml"
        file.write_text(tomlkit.dumps(document), encoding="utf-8")
        vehicle = birm3d.Vehicle.from_file(file)
    return vehicle.with_rate_sensitivity(values["rate sensitivity"])


def _document(skin: Skin, values: Mapping[str, float], fit: str) -> dict[str, Any]:
    document = tomlkit.parse((DATA / f"finite_element_{skin.key}.toml").read_text(encoding="utf-8")).unwrap()
    document["name"] = f"fitted_{skin.key}"
    document["title"] += ", fitted"
    document["description"] += " Its skin is fitted to all given runs by tests/validation."
    document["source"] = [each for each in document["source"] if each["id"] != "to-be-fitted"]
    document["source"].append({"id": "structure", "text": skin.structure, "status": "published"})
    document["source"].append({"id": "expected", "text": skin.expected, "status": "estimated"})
    document["source"].append({"id": "fit", "text": fit, "status": "calibrated"})
    document["exterior"]["element_size_m"] = skin.element_size
    document["indentation"] = {
        "length_m": values["indentation length"],
        "source": ["fit"],
        "status": "calibrated",
    }
    front = {"panels": ["front"], "blocks": ["body"]}
    places = {
        "front_outer": {**front, "y_m": [skin.split, 10.0]},
        "front_inner": front,
        "fender": {"panels": ["side"], "blocks": ["body"], "x_m": list(skin.fender)},
    }
    document["zone"] = {}
    cited = {"source": ["structure", "expected", "fit"], "status": "calibrated"}
    laws = {
        name: {key: value for key, value in ZoneLaw.numbers_of(law).items() if value is not None} | cited
        for name, law in zones(skin, values).items()
    }
    for name, place in places.items():
        document["zone"][name] = {**place, **laws[name]}
    document["zone"]["fender"]["along"] = laws["fender.along"]
    document["zone"]["skin"] = SKIN
    return document
