"""Which preset stands for the vehicle of a test: one rule for all kinds of tests.

The preset of the same class whose mass is nearest as a ratio, then with the mass of the test vehicle by
``with_gvw``. The paper's pickup is left out: it is a replica of the paper's, no vehicle. Nothing is chosen
row by row.
"""

from __future__ import annotations

import math
from functools import cache

import birm3d

NO_STAND_IN = ("paper_pickup",)


@cache
def _by_class() -> dict[str, tuple[birm3d.Vehicle, ...]]:
    """Presets of each class: the kind of their file, or "combination" for those of two units."""
    found: dict[str, list[birm3d.Vehicle]] = {}
    for name in birm3d.Vehicle.presets():
        if name not in NO_STAND_IN:
            vehicle = birm3d.Vehicle.preset(name)
            kind = "combination" if vehicle.joint is not None else str(vehicle.kind)
            found.setdefault(kind, []).append(vehicle)
    return {kind: tuple(vehicles) for kind, vehicles in found.items()}


def stand_in(kind: str, mass: float) -> birm3d.Vehicle:
    """The vehicle that stands for one of a class and a mass [kg].

    Of several classes, as "bus/truck", the first that has a preset counts. Classes: "car", "minivan",
    "pickup", "truck", "combination" and what other kinds the presets' files have.
    """
    presets = next(_by_class()[one] for one in kind.split("/") if one in _by_class())
    near = min(presets, key=lambda vehicle: abs(math.log(vehicle.mass / mass)))
    return near.with_gvw(mass)


def name_of(vehicle: birm3d.Vehicle) -> str:
    """Preset and mass, for tables."""
    return f"{vehicle.name} {vehicle.mass:,.0f} kg"
