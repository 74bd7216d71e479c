"""Vehicles of another size: where places go, and what becomes of solids, skin and stiffness.

Along each axis of the file places go by a piecewise linear map, so that boxes stay boxes. What is crushed is
stretched with the structure that it is a part of, and its stress follows from the mass:

    deflection' = s * deflection,    stress' = stress * (m' / m) / (a * s)

m is the mass that the zones hold for, a the factor of a panel's area, and s that of the depth behind it.
For front and rear it is the depth of the structure before the compartment or the load: ``depth_m`` of the
file, or up to the rigid core. For sides it is the width, for roof and underside the height. So a similar
vehicle at the same speed is crushed by the same fraction of its length. If its size stays, it is crushed by
the same depth. NHTSA's tests at 56 km/h agree: within a class, displacement goes with length to the power
1.33 (+-0.50, 20 cars) and 0.87 (+-0.40, 12 sport utility vehicles); over all classes, with mass to the
power 0.09 (+-0.08, 40 vehicles).
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from ..units import Quantity, si
from .zone import positive

__all__ = [
    "SIZES",
    "Extent",
    "Factors",
    "PlaceMap",
    "Scaling",
    "factors_of",
    "panel_factors",
    "scaling_between",
    "sizes_given",
]

SIZES = ("length", "width", "height", "wheelbase")
"""Names of the dimensions that a vehicle can be scaled to."""

# A dimension beyond these fractions of the vehicle's is most likely in another unit.
_LEAST, _MOST = 0.25, 4.0


@dataclass(frozen=True)
class PlaceMap:
    """Where places along an axis go [m]: linear between increasing knots, and on with the last slopes."""

    old: tuple[float, ...] = (0.0, 1.0)
    new: tuple[float, ...] = (0.0, 1.0)

    def __call__(self, place: float) -> float:
        """Return where a place goes."""
        i = min(max(bisect_right(self.old, place), 1), len(self.old) - 1)
        slope = (self.new[i] - self.new[i - 1]) / (self.old[i] - self.old[i - 1])
        return self.new[i - 1] + slope * (place - self.old[i - 1])

    def stretch(self, low: float, high: float) -> float:
        """Return the factor by which the distance of two different places grows."""
        return (self(high) - self(low)) / (high - low)


@dataclass(frozen=True)
class Scaling:
    """Where places of a file go along its axes: maps of x and z, and a factor of y."""

    x: PlaceMap = field(default_factory=PlaceMap)
    y: float = 1.0
    z: PlaceMap = field(default_factory=PlaceMap)

    def indentation(self, extent: Extent) -> float:
        """Return the factor of an indentation's length, which runs along sides and across ends."""
        return math.sqrt(self.length(extent) * self.y)

    def length(self, extent: Extent) -> float:
        """Return the factor of the overall length."""
        return self.x.stretch(extent.rear, extent.front)

    def front_depth(self, extent: Extent) -> float:
        """Return the factor of the depth of the front's structure."""
        return self.x.stretch(*_depth(extent.crushed_front, extent.front, extent))

    def rear_depth(self, extent: Extent) -> float:
        """Return the factor of the depth of the rear's structure."""
        return self.x.stretch(*_depth(extent.rear, extent.crushed_rear, extent))

    def height(self, extent: Extent) -> float:
        """Return the factor of the overall height."""
        return self.z.stretch(0.0, extent.top)

    def volume(self, extent: Extent) -> float:
        """Return the factor of the volume of the box around the vehicle."""
        return self.length(extent) * self.y * self.height(extent)


class Extent(NamedTuple):
    """Where a vehicle's skin and wheels end, and the structure of its ends; file axes [m]."""

    rear: float
    front: float
    width: float
    top: float
    axles: tuple[float, float] | None  # the first one's place and the last one's, where they differ
    crushed_rear: float  # inner end of the structure that is crushed from the rear
    crushed_front: float
    wheel: float | None  # greatest radius

    @property
    def length(self) -> float:
        """From end to end [m]."""
        return self.front - self.rear

    @property
    def sizes(self) -> Mapping[str, float | None]:
        """Dimension by its name in :data:`SIZES` [m]."""
        wheelbase = None if self.axles is None else self.axles[0] - self.axles[1]
        return dict(zip(SIZES, (self.length, self.width, self.top, wheelbase), strict=True))


class Factors(NamedTuple):
    """Of a zone's law, beside that of its mass: of stress, and of deflection."""

    stress: float
    deflection: float

    @staticmethod
    def mean(factors: Iterable[Factors]) -> Factors:
        """Return the geometric mean."""
        stress, deflection = zip(*factors, strict=True)
        return Factors(_mean(stress), _mean(deflection))


def sizes_given(**sizes: Quantity | None) -> dict[str, float | None]:
    """Return dimensions as numbers > 0 [m]; ``None`` stays ``None``."""
    return {
        name: None if value is None else positive(name, si(name, value, "length"))
        for name, value in sizes.items()
    }


def panel_factors(scaling: Scaling, extent: Extent, panel: str) -> Factors:
    """Return the factors of the law of a panel, by the one of its area and the one of the depth behind it."""
    along, up = scaling.length(extent), scaling.height(extent)
    front, rear = scaling.front_depth(extent), scaling.rear_depth(extent)
    radius = up if extent.wheel is None else scaling.z(extent.wheel) / extent.wheel
    area, depth = {
        "front": (scaling.y * up, front),
        "rear": (scaling.y * up, rear),
        "side": (along * up, scaling.y),
        "top": (along * scaling.y, up),
        "bottom": (along * scaling.y, up),
        "tire": (scaling.y * radius, radius),
        "along": (along * up, along),
    }[panel]
    return Factors(1.0 / (area * depth), depth)


def scaling_between(extent: Extent, factors: Mapping[str, float]) -> Scaling:
    """Return the scaling by factors of dimensions, named as in :data:`SIZES`; others stay.

    The wheelbase goes in proportion to the length, or as its own factor says. Then places between the first
    and the last axle scale with the wheelbase. Places beyond scale with the rest of the length.

    Raises
    ------
    ValueError
        If the wheelbase would not be shorter than the length, or there is no second axle.
    """
    y, z = factors.get("width", 1.0), factors.get("height", 1.0)
    up = PlaceMap((0.0, 1.0), (0.0, z))
    if "wheelbase" not in factors:
        return Scaling(PlaceMap((0.0, 1.0), (0.0, factors.get("length", 1.0))), y, up)
    if extent.axles is None:
        raise ValueError("wheelbase needs a vehicle of at least two axles, got one with fewer")
    longer = extent.length * factors.get("length", 1.0)
    first, last = extent.axles
    between = (first - last) * factors["wheelbase"]
    if not between < longer:
        raise ValueError(f"wheelbase must be shorter than the length, {longer:.4g} m; got {between:g}")
    left = (longer - between) / (extent.length - (first - last))
    front, rear = first + left * (extent.front - first), first - between - left * (last - extent.rear)
    old = (extent.rear, last, first, extent.front)
    return Scaling(PlaceMap(old, (rear, first - between, first, front)), y, up)


def factors_of(
    wanted: Mapping[str, float | None], present: Mapping[str, float | None], name: str
) -> dict[str, float]:
    """Return the factors from present dimensions [m] to those that are wanted, ``None`` where they may stay.

    Raises
    ------
    ValueError
        If a dimension is far from that of the vehicle (a quarter to four times), or it has none.
    """
    factors = {}
    for key, value in wanted.items():
        if value is None:
            continue
        now = present[key]
        if now is None:
            raise ValueError(f"{key} needs a vehicle of at least two axles, got {name!r}")
        if not _LEAST * now <= value <= _MOST * now:
            limit = f"{_LEAST * now:.4g} to {_MOST * now:.4g} m, a quarter to four times that of {name!r}"
            raise ValueError(f"{key} must be {limit}; got {value:g}")
        factors[key] = value / now
    return factors


def _depth(low: float, high: float, extent: Extent) -> tuple[float, float]:
    """Return the range of what can be crushed; all of the vehicle where the core reaches to its end."""
    return (low, high) if low < high else (extent.rear, extent.front)


def _mean(values: Sequence[float]) -> float:
    if all(value == values[0] for value in values):
        return values[0]
    return math.exp(math.fsum(map(math.log, values)) / len(values))
