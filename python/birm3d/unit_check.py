"""What tells a user that a number was most likely given in another unit."""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterable, Mapping, Sequence
from types import MappingProxyType
from typing import Any, NamedTuple

from .base.arguments import caller_level
from .base.checks import is_number
from .units import Quantity, Stated, km_h, quantity_in, si

__all__ = [
    "USUAL",
    "UnitWarning",
    "Usual",
    "given",
    "warn_if_any_unusual",
    "warn_if_far_from_skin",
    "warn_if_mesh_unusual",
    "warn_if_unusual",
]


class UnitWarning(UserWarning):
    """A number is far outside what its argument has in practice: most likely it is in another unit.

    The message has the range that is accepted without it. Text with a unit, as ``"300 km/h"``, says what is
    meant and is never warned of.
    """


class Usual(NamedTuple):
    """Range of an argument that is accepted without a word, and the mistake that lies outside it.

    ``text`` says the same number in the unit that was probably meant. ``zero``: 0 is accepted beside the
    range. ``magnitude``: the range is of the magnitude. ``radians``: a round angle in radians is warned of.
    """

    low: float
    high: float
    unit: str
    text: str
    zero: bool = False
    magnitude: bool = False
    radians: bool = False


_SIZE = Usual(0.001, 20.0, "m", "mm")
_LONG = Usual(0.05, 1000.0, "m", "mm")
_TURN = Usual(0.0, math.inf, "deg", "rad", radians=True)

USUAL: Mapping[str, Usual] = MappingProxyType(
    {
        # 45 m/s is 162 km/h: above all speeds of the standards' tests (112 km/h) and of heavy vehicles.
        "impact_speed": Usual(0.0, 45.0, "m/s", "km/h"),
        "impact_angle": Usual(1.0, math.inf, "deg", "rad", zero=True, radians=True),
        "impact_yaw": _TURN,
        "impact_roll": _TURN,
        "heading": _TURN,
        "standoff": Usual(0.0, 200.0, "m", "mm"),
        "duration": Usual(0.0, 100.0, "s", "ms"),
        "natural_period": Usual(0.0, 4.0, "s", "ms"),
        "diameter": Usual(0.01, 5.0, "m", "mm"),
        "height": _SIZE,
        "thickness": _SIZE,
        "edge_radius": Usual(0.0, 5.0, "m", "mm"),
        "spacing": Usual(0.01, 100.0, "m", "mm"),
        "row_spacing": Usual(0.01, 100.0, "m", "mm"),
        "row_offset": Usual(0.0, 100.0, "m", "mm", magnitude=True),
        "width": _LONG,
        "length": _LONG,
        "wall_thickness": Usual(0.0005, 0.5, "m", "mm"),
        "yield_stress": Usual(1e7, 5e9, "Pa", "MPa"),
        "concrete_strength": Usual(1e6, 2e8, "Pa", "MPa"),
        "moment": Usual(1e3, 1e8, "N m", "kN m"),
        "undrained_shear_strength": Usual(1e3, 1e6, "Pa", "kPa"),
        "density": Usual(100.0, 20000.0, "kg/m^3", "t/m^3"),
        "payload": Usual(10.0, 100_000.0, "kg", "t", zero=True),
        "indentation_length": Usual(0.0, 5.0, "m", "mm"),
    }
)
"""Argument -> range that is accepted without a :class:`UnitWarning`."""

# Of a mesh from its foot to its top [m]; how long it is says less.
_MESH_HEIGHT = Usual(0.001, 100.0, "m", "mm")
# How far from the box about the skin a gauge may be [m]: masts and loads stand out of it.
_OUT_OF_SKIN = 1.0
# Of a round angle in radians: multiples of 5 deg, within this [rad].
_ROUND, _NEAR = math.pi / 36.0, 1e-3


def given(name: str, value: Quantity) -> float:
    """Return an argument of :data:`USUAL` in SI (angles: deg), with a word if it is an unusual number.

    Raises
    ------
    ValueError
        If it is no number and no text with a unit of its quantity.
    UnitWarning
        As a warning, if it is a number outside the range of :data:`USUAL`.
    """
    quantity = quantity_in(USUAL[name].unit)
    assert quantity is not None  # all units of USUAL are known
    number = si(name, value, quantity)
    if not isinstance(value, (str, Stated)):
        warn_if_unusual(name, number, USUAL[name])
    return number


def warn_if_any_unusual(name: str, values: Iterable[Any]) -> None:
    """Warn with :class:`UnitWarning` of the first number that is unusual for a parameter of a scene.

    ``name`` as in :mod:`birm3d.scene_parameters`; parameters without a usual range are left alone.
    """
    group, _, field = name.rpartition(".")
    usual = USUAL.get(field) if group in ("", "barrier") else None
    if usual is None:
        return
    for value in values:
        plain = is_number(value) and not isinstance(value, Stated)
        if plain and _is_unusual(float(value), usual):
            warn_if_unusual(name, float(value), usual)
            return


def _is_unusual(value: float, usual: Usual) -> bool:
    if not math.isfinite(value):
        return False
    if usual.radians and _is_round_in_radians(value):
        return True
    size = abs(value) if usual.magnitude else value
    # Zero is the same in every unit; what is below is refused by its own limit, with an error.
    return size > 0.0 and not usual.low <= size <= usual.high


def warn_if_unusual(name: str, value: float, usual: Usual) -> None:
    """Warn with :class:`UnitWarning` of a number outside its usual range; what is no number is left alone."""
    if not _is_unusual(value, usual):
        return
    guess = "in another unit"
    limits = f"{usual.low:,.6g} to {usual.high:,.6g}" if math.isfinite(usual.high) else f"above {usual.low:g}"
    accepted = f"{'0 or ' if usual.zero else ''}{limits} {usual.unit}"
    if usual.radians:
        guess = f"in radians ({math.degrees(value):.4g} deg)"
        accepted = "any angle" if usual.low == 0.0 else f"0 or {usual.low:g} to 180 deg"
        accepted += " that is not n * 5 deg in radians"
    also = f" ({value / km_h:.4g} km/h)" if usual.unit == "m/s" else ""
    _warn(
        f"{name} = {value:g} {usual.unit}{also}",
        guess,
        f"accepted without this warning is {accepted}, or text with its unit, as '{value:g} {usual.text}'",
    )


def warn_if_mesh_unusual(height: float) -> None:
    """Warn with :class:`UnitWarning` of vertices that are most likely in millimetres; height in m."""
    if not _is_unusual(height, _MESH_HEIGHT):
        return
    _warn(
        f"vertices = a mesh {height:g} m high",
        "in another unit",
        f"accepted without this warning is {_MESH_HEIGHT.low:g} to {_MESH_HEIGHT.high:g} m; vertices in "
        "millimetres are 1e-3 * vertices in m",
    )


def warn_if_far_from_skin(
    point: Sequence[float],
    low: Sequence[float],
    high: Sequence[float],
    stated: Sequence[bool],
    name: str = "point",
) -> None:
    """Warn with :class:`UnitWarning` of a point more than 1 m outside a box: the skin's, in the file's axes.

    Of the coordinates (x, y, z) [m] the first one that is outside is named. Those whose unit was stated are
    left alone.
    """
    for axis, value, least, most, meant in zip("xyz", point, low, high, stated, strict=True):
        first, last = least - _OUT_OF_SKIN, most + _OUT_OF_SKIN
        if meant or not math.isfinite(value) or first <= value <= last:
            continue
        _warn(
            f"{name} with {axis} = {value:g} m",
            "in another unit or in other axes than the vehicle's file",
            f"accepted without this warning is {axis} from {first:.2f} to {last:.2f} m, which is within "
            f"{_OUT_OF_SKIN:g} m of the skin, or text with its unit, as '{value:g} mm'",
        )
        return


def _is_round_in_radians(angle: float) -> bool:
    turns = round(abs(angle) / _ROUND)
    return turns > 0 and abs(angle) <= math.pi + _NEAR and abs(abs(angle) - turns * _ROUND) < _NEAR


def _warn(what: str, guess: str, rest: str) -> None:
    warnings.warn(f"{what} is most likely {guess}: {rest}", UnitWarning, stacklevel=caller_level())
