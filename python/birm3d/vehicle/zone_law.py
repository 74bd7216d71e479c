"""A zone's stiffness as vehicle files have it, and as a saved vehicle has it where it was changed."""

from __future__ import annotations

import math
from typing import Annotated, Any, TypeAlias

from pydantic import Field

from ..io.toml import Strict, reject
from .zone import Zone

__all__ = ["NonNegative", "Positive", "ZoneLaw"]

Positive: TypeAlias = Annotated[float, Field(gt=0.0)]
NonNegative: TypeAlias = Annotated[float, Field(ge=0.0)]
EnvelopePoint: TypeAlias = tuple[NonNegative, NonNegative]

# Key of the file: field of the zone.
_KEYS = {
    "k_initial_Pa_per_m": "k_initial",
    "knee_m": "knee",
    "k_hardening_Pa_per_m": "k_hardening",
    "f_max_Pa": "f_max",
    "envelope_m_Pa": "envelope",
    "k_unloading_Pa_per_m": "k_unloading",
    "elastic_recovery_m": "elastic_recovery",
    "tail_depth_m": "tail_depth",
    "tail_slope_Pa_per_m": "tail_slope",
    "friction_share": "friction_share",
    "breakaway_N": "breakaway",
    "breakaway_travel_m": "breakaway_travel",
}


class ZoneLaw(Strict):
    """Stiffness per unit of area, see :class:`birm3d.Zone`; without ``f_max_Pa`` the plateau has no end.

    Either k_initial, knee, k_hardening and f_max (Fig. 3), or a general envelope with rows [deflection in m,
    stress in Pa] from [0, 0].
    """

    k_initial_Pa_per_m: NonNegative | None = None  # noqa: N815
    knee_m: Positive | None = None
    k_hardening_Pa_per_m: NonNegative | None = None  # noqa: N815
    f_max_Pa: Positive | None = None  # noqa: N815
    envelope_m_Pa: Annotated[tuple[EnvelopePoint, ...], Field(min_length=2)] | None = None  # noqa: N815
    k_unloading_Pa_per_m: Positive  # noqa: N815
    elastic_recovery_m: Positive | None = None
    tail_depth_m: Positive | None = None
    tail_slope_Pa_per_m: NonNegative | None = None  # noqa: N815
    friction_share: Annotated[float, Field(ge=0.0, le=1.0)] | None = None
    breakaway_N: Positive | None = None  # noqa: N815
    breakaway_travel_m: Positive | None = None

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
