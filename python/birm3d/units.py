"""The one place that knows units other than SI.

Each unit is a number, its size in SI, that can also be called: ``units.mph(50)`` and ``50 * units.mph`` are
50 mph in m/s, and ``speed / units.mph`` goes back.
"""

from __future__ import annotations

import re

__all__ = [
    "Unit",
    "ft",
    "g",
    "inch",
    "kN",
    "kg",
    "kgf",
    "km_h",
    "lb",
    "lbf",
    "m",
    "m_s",
    "mm",
    "mph",
    "parse",
    "s",
]


class Unit(float):
    """Size of a unit in SI; calling it converts a value in that unit to SI."""

    def __call__(self, value: float) -> float:
        """Return ``value`` of this unit in SI."""
        return float(value) * float(self)


m = Unit(1.0)
mm = Unit(1e-3)
inch = Unit(0.0254)
ft = Unit(0.3048)
s = Unit(1.0)
m_s = Unit(1.0)
km_h = Unit(1.0 / 3.6)
mph = Unit(0.44704)
kg = Unit(1.0)
lb = Unit(0.45359237)
g = Unit(9.80665)
"""Standard gravity, m/s^2."""
N = Unit(1.0)
kN = Unit(1e3)  # noqa: N816
kgf = Unit(9.80665)
lbf = Unit(4.4482216152605)

_NAMES = {
    "m": m,
    "mm": mm,
    "in": inch,
    "ft": ft,
    "s": s,
    "ms": Unit(1e-3),
    "m/s": m_s,
    "km/h": km_h,
    "kmh": km_h,
    "mph": mph,
    "kg": kg,
    "t": Unit(1e3),
    "lb": lb,
    "deg": Unit(1.0),
}
_QUANTITIES = {
    "speed": ("m/s", "km/h", "kmh", "mph"),
    "mass": ("kg", "t", "lb"),
    "length": ("m", "mm", "in", "ft"),
    "time": ("s", "ms"),
    "angle": ("deg",),
}
_VALUE = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*([A-Za-z/]*)\s*")


def parse(text: str, quantity: str) -> float:
    """Read a number with a unit, such as ``"50mph"`` or ``"1719 kg"``; without one it is SI (angles: deg).

    Parameters
    ----------
    text
        The number and its unit.
    quantity
        ``"speed"``, ``"mass"``, ``"length"``, ``"time"`` or ``"angle"``.

    Returns
    -------
    float
        The value in SI; degrees for angles.

    Raises
    ------
    ValueError
        If there is no number, or the unit does not belong to the quantity.
    """
    allowed = _QUANTITIES[quantity]
    match = _VALUE.fullmatch(text)
    if match is None or (match[2] and match[2] not in allowed):
        raise ValueError(
            f"{quantity} must be a number with one of the units {', '.join(allowed)}; got {text!r}"
        )
    return float(match[1]) * (float(_NAMES[match[2]]) if match[2] else 1.0)
