"""The one place that knows units other than SI.

Each unit is a number, its size in SI, that can also be called: ``units.mph(50)`` and ``50 * units.mph`` are
50 mph in m/s, and ``speed / units.mph`` goes back.

Wherever the package takes a number that has a dimension it also takes text with a unit, as ``"50 mph"``,
``"4500 lb"`` or ``"0.5 m"``. The type is :data:`Quantity`, and :func:`parse` reads it, also for the command
line. A plain number is SI, angles are in degrees.
"""

from __future__ import annotations

import math
import re
from typing import NamedTuple, TypeAlias

from .base.arguments import checked
from .base.checks import is_number, number, shown

__all__ = [
    "Measure",
    "Quantity",
    "Stated",
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
    "measure",
    "mm",
    "mph",
    "parse",
    "quantity_in",
    "s",
    "si",
]


Quantity: TypeAlias = float | str
"""A number in SI (angles: deg), or text with a unit, as ``"50 mph"``."""


class Unit(float):
    """Size of a unit in SI; calling it converts a value in that unit to SI."""

    def __call__(self, value: float) -> float:
        """Return ``value`` of this unit in SI."""
        return number("value", value) * float(self)


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

# What measured data come in: quantity -> its unit here, and the size of each unit in that one.
_MEASURED: dict[str, tuple[str, dict[str, float]]] = {
    "time": ("s", {"s": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "sec": 1.0}),
    "length": ("m", {"m": m, "mm": mm, "cm": 1e-2, "in": inch, "ft": ft}),
    "speed": (
        "m/s",
        {"m/s": m_s, "mm/s": 1e-3, "km/h": km_h, "kmh": km_h, "kph": km_h, "mph": mph, "ft/s": ft},
    ),
    "acceleration": (
        "m/s^2",
        {**dict.fromkeys(("m/s^2", "m/s2", "m/s²"), 1.0), **dict.fromkeys(("g", "G"), g), "ft/s^2": ft},
    ),
    "mass": ("kg", {"kg": kg, "t": 1e3, "lb": lb, "lbs": lb}),
    "force": ("N", {"N": N, "kN": kN, "MN": 1e6, "kgf": kgf, "lbf": lbf, "kip": 1e3 * lbf}),
    "moment": ("N m", {"N m": 1.0, "Nm": 1.0, "N*m": 1.0, "kN m": 1e3, "kNm": 1e3}),
    "impulse": ("N s", {"N s": 1.0, "Ns": 1.0, "N*s": 1.0, "kN s": 1e3, "kNs": 1e3}),
    "angle": ("deg", {"deg": 1.0, "°": 1.0, "rad": math.degrees(1.0)}),
    "angular velocity": (
        "deg/s",
        {"deg/s": 1.0, "°/s": 1.0, "rad/s": math.degrees(1.0)},
    ),
    "angular acceleration": (
        "deg/s^2",
        {
            **dict.fromkeys(("deg/s^2", "deg/s2", "°/s²"), 1.0),
            **dict.fromkeys(("rad/s^2", "rad/s2", "rad/s²"), math.degrees(1.0)),
        },
    ),
    "energy": ("J", {"J": 1.0, "kJ": 1e3}),
    "pressure": ("Pa", {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6}),
    "voltage": ("V", {"V": 1.0, "mV": 1e-3}),
    "ratio": ("1", {"1": 1.0, "-": 1.0, "%": 1e-2}),
}


class Measure(NamedTuple):
    """What a unit measures: the quantity, the unit of it used here (SI; deg), and its size in that."""

    quantity: str
    si: str
    size: float


_SYMBOLS = {
    symbol: Measure(quantity, si, float(size))
    for quantity, (si, sizes) in _MEASURED.items()
    for symbol, size in sizes.items()
}


@checked
def measure(symbol: str) -> Measure:
    """Return what a unit of measured data measures, such as ``"kN"``, ``"g"`` or ``"deg/s"``.

    Raises
    ------
    ValueError
        If the unit is not known; the message lists those that are. Letter case counts: ``"mN"`` is no unit
        of a crash test, and nothing is guessed.
    """
    found = _SYMBOLS.get(symbol.strip())
    if found is None:
        raise ValueError(f"unit must be one of {', '.join(_SYMBOLS)}; got {symbol!r}")
    return found


# What is given to a scene and is no channel's quantity.
_GIVEN: dict[str, tuple[str, dict[str, float]]] = {
    "density": ("kg/m^3", {**dict.fromkeys(("kg/m^3", "kg/m3", "kg/m³"), 1.0), "lb/ft^3": lb / ft**3}),
    "mass per length": ("kg/m", {"kg/m": 1.0, "t/m": 1e3, "lb/ft": lb / ft}),
    "pressure per length": ("Pa/m", {"Pa/m": 1.0, "kPa/m": 1e3, "MPa/m": 1e6}),
    "time per length": ("s/m", {"s/m": 1.0}),
    "inertia": ("kg m^2", {**dict.fromkeys(("kg m^2", "kg m2", "kg m²"), 1.0), "lb ft^2": lb * ft**2}),
}
_QUANTITIES = {**_MEASURED, **_GIVEN}
_VALUE = re.compile(r"([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*)", re.DOTALL)


class Stated(float):
    """A number whose unit was stated: nobody needs to ask whether it was meant in another."""


@checked
def parse(text: str, quantity: str, *, plain: bool = True) -> float:
    """Read a number with a unit, such as ``"50mph"`` or ``"1719 kg"``; letter case counts.

    Parameters
    ----------
    text
        The number and its unit.
    quantity
        ``"speed"``, ``"mass"``, ``"length"``, ``"time"``, ``"angle"``, ``"density"``, ...
    plain
        Whether a number without a unit is taken too, as SI (angles: deg).

    Returns
    -------
    float
        The value in SI; degrees for angles. A :class:`Stated` one where the text has a unit.

    Raises
    ------
    ValueError
        If there is no number, or its unit does not belong to the quantity or is missing.
    """
    if quantity not in _QUANTITIES:
        raise ValueError(f"quantity must be one of {', '.join(_QUANTITIES)}; got {quantity!r}")
    _, allowed = _QUANTITIES[quantity]
    match = _VALUE.fullmatch(text.strip())
    if match is None or not (match[2] in allowed or (plain and not match[2])):
        raise ValueError(
            f"{quantity} must be a number with one of the units {', '.join(allowed)}; got {text!r}"
        )
    if not match[2]:
        return float(match[1])
    return Stated(float(match[1]) * float(allowed[match[2]]))


@checked
def si(name: str, value: Quantity, quantity: str) -> float:
    """Return a number, or text with a unit, in SI; degrees for angles.

    Parameters
    ----------
    name
        Of the argument, for the message.
    value
        A number, which is SI, or text, which must have a unit: ``"30"`` alone does not say which.
    quantity
        As in :func:`parse`.

    Raises
    ------
    ValueError
        If the text is no number with a unit of the quantity, or the value is neither number nor text; the
        message names the argument and the units.
    """
    if isinstance(value, str):
        try:
            return float(parse(value, quantity, plain=False))
        except ValueError:
            pass
    elif is_number(value):
        return float(value)
    unit, allowed = _QUANTITIES[quantity]
    raise ValueError(
        f"{name} must be a number in {unit}, or text with one of the {quantity} units {', '.join(allowed)}; "
        f"got {shown(value)}"
    )


@checked
def quantity_in(unit: str) -> str | None:
    """Return the quantity that a unit of this package is of, as "speed" for "m/s"; ``None`` for a number."""
    return next((name for name, (si_unit, _) in _QUANTITIES.items() if si_unit == unit and unit != "1"), None)
