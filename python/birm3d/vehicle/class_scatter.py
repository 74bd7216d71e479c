"""How vehicles of one class differ from the vehicle of a file."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from typing import Literal, NamedTuple, TypeAlias, get_args

__all__ = ["QUANTITIES", "STIFFNESSES", "Z_80", "ClassScatter", "ScatterName", "joined"]

Z_80 = 1.2816
"""Standard deviations from the median of a normal distribution to the ends of its 80 % band."""

STIFFNESSES = ("front", "side", "corner", "tires", "springs")
"""Quantities that are factors on zones: on their forces, or on the stiffness of their wheels' springs."""
ScatterName: TypeAlias = Literal[
    "front",
    "side",
    "corner",
    "tires",
    "mass_center_height",
    "barrier_friction",
    "tire_friction",
    "springs",
    "edge_flank",
    "bed_fixings",
    "length",
    "width",
    "height",
    "wheelbase",
    "roll_inertia",
    "yaw_inertia",
]
QUANTITIES: tuple[ScatterName, ...] = get_args(ScatterName)
"""What may differ, in the order in which it is drawn. The pitch inertia follows from that in yaw."""


class ClassScatter(NamedTuple):
    """Of one quantity: a factor on that of the file's vehicle, lognormal over the vehicles of its class.

    median: of the factor. log_sd: standard deviation of its logarithm. zones: that it is a factor on.
    """

    median: float
    log_sd: float
    zones: tuple[str, ...] = ()


def joined(units: Iterable[Mapping[str, ClassScatter]], zones: Collection[str]) -> dict[str, ClassScatter]:
    """Return the scatter of a vehicle by that of its units, in the order of :data:`QUANTITIES`.

    What both units say is one quantity: of the first, for the zones of both. Only those of `zones` count.
    """
    found: dict[str, ClassScatter] = {}
    for unit in units:
        for name, one in unit.items():
            own = tuple(zone for zone in one.zones if zone in zones)
            if name in found:
                found[name] = found[name]._replace(zones=(*found[name].zones, *own))
            else:
                found[name] = one._replace(zones=own)
    return {name: found[name] for name in QUANTITIES if name in found}
