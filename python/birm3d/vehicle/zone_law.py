"""A zone's stiffness as vehicle files have it, and as a saved vehicle has it where it was changed."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Annotated, Any, TypeAlias

from pydantic import Field, create_model

from ..io.toml import Strict, reject
from .zone import LAW_NUMBERS, Zone

__all__ = ["OF_WHEELS", "NonNegative", "Positive", "ZoneLaw"]

Positive: TypeAlias = Annotated[float, Field(gt=0.0)]
NonNegative: TypeAlias = Annotated[float, Field(ge=0.0)]
EnvelopePoint: TypeAlias = tuple[NonNegative, NonNegative]

_SUFFIX = {
    "pressure per length": "_Pa_per_m",
    "pressure": "_Pa",
    "length": "_m",
    "force": "_N",
    "time": "_s",
    "number": "",
}
_LIMITS = {
    "> 0": Field(gt=0.0),
    ">= 0": Field(ge=0.0),
    "in [0, 1]": Field(ge=0.0, le=1.0),
    "in (0, 1]": Field(gt=0.0, le=1.0),
}


def _fields() -> Iterator[tuple[str, str, Any]]:
    """Yield key of the file, field of the zone, and what stands there, in the order of files."""
    for name, row in LAW_NUMBERS.items():
        kind = Annotated[float, _LIMITS[row.limit]]
        key = name + _SUFFIX[row.quantity]
        if name == "k_unloading":
            points = Annotated[tuple[EnvelopePoint, ...], Field(min_length=2)]
            yield "envelope_m_Pa", "envelope", (points | None, None)
            yield key, name, (kind, ...)
        else:
            yield key, name, (kind | None, None)


_KEYS = {key: name for key, name, _ in _fields()}
OF_WHEELS = tuple(key for key, name in _KEYS.items() if name in LAW_NUMBERS and LAW_NUMBERS[name].of_wheel)
"""Keys of a zone of tyres that say how its wheels are held."""
_Numbers: Any = create_model("_Numbers", __base__=Strict, **{key: field for key, _, field in _fields()})


class ZoneLaw(_Numbers):  # type: ignore[misc]
    """Stiffness per unit of area, see :class:`birm3d.Zone`; without ``f_max_Pa`` the plateau has no end.

    Either k_initial, knee, k_hardening and f_max (Fig. 3), or a general envelope with rows [deflection in m,
    stress in Pa] from [0, 0]. The keys are the numbers of :data:`birm3d.vehicle.zone.LAW_NUMBERS` with their
    units.
    """

    @property
    def law(self) -> Zone:
        """The zone that the numbers make; refuses those that are no law."""
        return Zone(**{name: getattr(self, key) for key, name in _KEYS.items()})

    def require_law(self) -> None:
        """Reject numbers that make no law."""
        try:
            _ = self.law
        except ValueError as error:
            reject("k_unloading_Pa_per_m", str(error))

    @staticmethod
    def numbers_of(zone: Zone) -> dict[str, Any]:
        """Return the entries of a file for a zone."""
        numbers = {key: getattr(zone, name) for key, name in _KEYS.items()}
        endless = numbers["f_max_Pa"] is not None and math.isinf(numbers["f_max_Pa"])
        return {**numbers, "f_max_Pa": None} if endless else numbers
