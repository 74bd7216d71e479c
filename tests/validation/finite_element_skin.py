"""The skin of the finite-element vehicles N and S: zones where their parts are, and the numbers to fit.

A front has two zones: what stands beside the rails and sides (outer), and what is between (inner). Each has
an envelope with few points, and a tail that begins where the parts behind it do. Side panels ahead of the
passenger cell are a third zone. All give back the same short length. The rate of deflection and the reach of
a post's indentation are numbers of the whole vehicle.
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


@dataclass(frozen=True)
class Unknown:
    """A number to be fitted: its bounds, and whether its logarithm is what is varied."""

    name: str
    low: float
    high: float
    start: float
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


@dataclass(frozen=True)
class Skin:
    """Where the zones of a vehicle are (m, file axes), and what is known of their numbers.

    split: distance from the middle plane where the outer zone of the front begins. outer, inner: depths of
    the points of the envelopes. fender: range of x. start: stresses that a fit begins with, of the inner zone
    and of the rest [Pa]. fit_density: relative number of elements while fitting. second: values in the order
    of the unknowns where an earlier fit to all runs ended; fits begin there instead.
    """

    key: str
    element_size: float
    split: float
    outer: tuple[float, ...]
    inner: tuple[float, ...]
    fender: tuple[float, float]
    start: tuple[float, float]
    others: tuple[Unknown, ...]
    structure: str
    fit_density: float = 1.0
    second: tuple[float, ...] = ()

    @property
    def unknowns(self) -> tuple[Unknown, ...]:
        return (
            *(Unknown(f"outer stress at {d:g} m", 1e4, 1e7, self.start[1]) for d in self.outer),
            *(Unknown(f"inner stress at {d:g} m", 1e4, 1e7, self.start[0]) for d in self.inner),
            Unknown("fender stress", 5e3, 2e6, self.start[1]),
            *self.others,
        )

    def values(self, shares: Floats) -> dict[str, float]:
        return {u.name: u.value(float(s)) for u, s in zip(self.unknowns, shares, strict=True)}

    def unevenness(self, shares: Floats) -> Floats:
        """Logarithms of ratios of what is alike unless runs say otherwise: neighbouring stresses of an
        envelope, mean stresses of the zones, and, with half the weight, slopes of the tails."""
        values = self.values(shares)
        outer = np.log([values[f"outer stress at {d:g} m"] for d in self.outer])
        inner = np.log([values[f"inner stress at {d:g} m"] for d in self.inner])
        tails = np.log(values["outer tail slope"] / values["inner tail slope"])
        zones = [outer.mean() - inner.mean(), np.log(values["fender stress"]) - outer.mean(), 0.5 * tails]
        return np.concatenate([np.diff(outer), np.diff(inner), zones])


def _of_whole(tail_depths: tuple[float, float], depth: float, reach: float) -> tuple[Unknown, ...]:
    return (
        Unknown("outer tail depth", *tail_depths, depth, "m", log=False),
        Unknown("inner tail depth", *tail_depths, depth, "m", log=False),
        Unknown("outer tail slope", 3e5, 6e7, 5e6, "Pa/m"),
        Unknown("inner tail slope", 3e5, 6e7, 5e6, "Pa/m"),
        Unknown("elastic recovery", 3e-3, 0.12, 0.012, "m"),
        Unknown("rate sensitivity", 0.0, 0.09, 0.05, "s/m", log=False),
        Unknown("indentation length", 0.1, 1.2, reach, "m", log=False),
    )


# Least slope of unloading over the steepest of loading. With 5/3 a curve of degree 5 gives back what a line
# of the slope of loading would.
LEAST = 1.01 * 5.0 / 3.0


SKINS = {
    "n": Skin(
        "n",
        element_size=0.1,
        split=0.4,
        outer=(0.03, 0.15, 0.35, 0.7, 1.0),
        inner=(0.1, 0.5, 1.0),
        fender=(-1.0, 0.9),
        start=(3e5, 1e6),
        others=_of_whole((0.8, 1.15), 0.93, 0.7),
        structure="""
Bounds of the zones by the parts of the model: bumper (3 mm) over the whole width, 0.11 m deep, grille (1 mm)
behind it; side panels (2 mm) from there on. The hood ends 1.0 m behind the front, where the tail may begin
""",
        fit_density=0.5,
        second=(
            *(3.9e6, 0.95e6, 0.41e6, 0.72e6, 3.0e6),
            *(0.18e6, 0.23e6, 0.51e6),
            *(0.58e6, 0.83, 0.84, 4.2e6, 3.6e6),
            *(3.06e-3, 0.021, 0.65),
        ),
    ),
    "s": Skin(
        "s",
        element_size=0.1,
        split=0.55,
        outer=(0.05, 0.25),
        inner=(0.05, 0.25),
        fender=(-0.4, 0.7),
        start=(6e5, 6e5),
        others=_of_whole((0.2, 0.45), 0.3, 0.75),
        structure="""
Bounds of the zones by the parts of the model: bumper (1.5 mm), fenders from 0.1 to 1.1 m behind the front.
A solid engine 0.76 m wide and wheels begin at 0.43 m; tails begin before, as what is between is packed
""",
    ),
}


def _law(
    depths: Sequence[float], stresses: Sequence[float], values: Mapping[str, float], side: str
) -> birm3d.Zone:
    """An envelope with its tail; the least slope of unloading follows the law's steepest of loading."""
    points = ((0.0, 0.0), *zip(depths, stresses, strict=True))
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
    for side, depths in (("outer", skin.outer), ("inner", skin.inner)):
        stresses = [values[f"{side} stress at {d:g} m"] for d in depths]
        found[f"front_{side}"] = _law(depths, stresses, values, side)
    stress = values["fender stress"]
    found["fender"] = birm3d.Zone(
        k_initial=stress / FENDER_KNEE,
        knee=FENDER_KNEE,
        k_hardening=0.0,
        f_max=stress,
        k_unloading=LEAST * stress / FENDER_KNEE,
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
    for name, law in zones(skin, values).items():
        numbers = {key: value for key, value in ZoneLaw.numbers_of(law).items() if value is not None}
        cited = {"source": ["structure", "fit"], "status": "calibrated"}
        document["zone"][name] = {**places[name], **numbers, **cited}
    document["zone"]["skin"] = SKIN
    return document
