"""How engineers read numbers: in kN and MPa, without powers of ten."""

from __future__ import annotations

import math

__all__ = ["kilo_number", "plain_number", "shown_unit", "shown_value"]

_SHOWN_UNITS = {
    "N": (1e3, "kN"),
    "N m": (1e3, "kN m"),
    "J": (1e3, "kJ"),
    "N s": (1e3, "kN s"),
    "N/m": (1e3, "kN/m"),
    "N per m^2": (1e6, "MPa"),
    "N/m per m^2": (1e6, "MPa/m"),
}
_LEAST, _MOST = 1e-6, 1e9  # beyond them a number has a power of ten


def shown_unit(unit: str) -> tuple[float, str]:
    """Return by what numbers in an SI unit are divided to be shown, and the unit they have then."""
    return _SHOWN_UNITS.get(unit, (1.0, unit))


def plain_number(value: float, digits: int = 4) -> str:
    """Return a number with so many significant digits, without a power of ten from 1e-6 to 1e9."""
    text = f"{value:.{digits}g}"
    if "e" not in text or not _LEAST <= abs(value) < _MOST:
        return text
    rounded = float(text)
    decimals = max(0, digits - 1 - math.floor(math.log10(abs(rounded))))
    return f"{rounded:,.{decimals}f}"


def kilo_number(value: float) -> str:
    """Return a load in thousands of its SI unit, whole from 100 on: 1,038,300 N is ``"1,038"``."""
    kilo = value / 1e3
    return f"{kilo:,.0f}" if abs(kilo) >= 100.0 else f"{kilo:.3g}"


def shown_value(value: float, unit: str, digits: int = 4) -> str:
    """Return a number in an SI unit as it is read, with its unit: 60,100 N is ``"60.1 kN"``."""
    size, shown = shown_unit(unit)
    return f"{plain_number(value / size, digits)} {shown}".rstrip()
