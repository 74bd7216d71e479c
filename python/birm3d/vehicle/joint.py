"""What holds two units of a vehicle together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal, get_args

import numpy as np
import numpy.typing as npt

from ..base.arguments import checked

__all__ = ["LONGEST_SLIP", "Joint", "JointKind"]

Floats = npt.NDArray[np.float64]
Place = tuple[float, float, float]
JointKind = Literal["fifth_wheel", "welded", "sliding"]

_KINDS = get_args(JointKind)

LONGEST_SLIP = 1.5
"""A load bed that slides further leaves its frame [m]: about the length of a cab, an estimate."""

# Places of a joint on its two units may differ in height by this much [m]; the core's limit too.
_FIT = 1e-3


@checked
@dataclass(frozen=True)
class Joint:
    """How a trailing unit is attached to a leading one.

    Parameters
    ----------
    place_on_leading, place_on_trailing
        The joint on each unit in the axes of its own file, position of rest: x forward, y left, z above the
        ground [m]. Of a vehicle from arrays the origin is on the ground below its mass centre. The trailing
        unit stands where both places are one.
    kind
        ``"fifth_wheel"``: force in three directions; pitch and yaw are free, roll only within
        ``roll_limit``, beyond which the plates touch and carry a moment. ``"welded"``: all six are held.
        ``"sliding"``: as welded, but the trailing unit, a load bed, slides along the leading one's x axis
        where holding it would take more than ``slide`` says.
    roll_limit
        Greatest relative roll of a fifth wheel to either side [deg], 0 to below 90. UN Regulation 55 speaks
        of up to 3 deg for a plate that does not oscillate; the default is an estimate within that.
    slide
        Of a sliding joint: the force that it holds [N] against the slip to either side [m], as pairs of
        slip and force, the first at slip 0. Between the pairs it is linear, beyond the last one constant.
        Other kinds do not use it, but keep it for ``with_joint``.
    """

    place_on_leading: Place
    place_on_trailing: Place
    kind: JointKind = "fifth_wheel"
    roll_limit: float = 2.0
    slide: tuple[tuple[float, float], ...] = ()

    def __post_init__(self) -> None:
        for name in ("place_on_leading", "place_on_trailing"):
            place = np.asarray(getattr(self, name), float)
            if place.shape != (3,) or not np.isfinite(place).all():
                raise ValueError(f"{name} must be three finite numbers (m), got {getattr(self, name)}")
            object.__setattr__(self, name, tuple(place.tolist()))
        if self.kind not in _KINDS:
            raise ValueError(f"kind must be one of {', '.join(_KINDS)}, got {self.kind!r}")
        self._check_slide()
        if not 0.0 <= self.roll_limit < 90.0:
            raise ValueError(f"roll_limit must be >= 0 and < 90 deg, got {self.roll_limit}")
        apart = abs(self.place_on_leading[2] - self.place_on_trailing[2])
        if not apart <= _FIT:
            raise ValueError(
                f"height of the joint on the trailing unit must be that on the leading one "
                f"({self.place_on_leading[2]} m) within {_FIT} m, got {self.place_on_trailing[2]} m"
            )

    def _check_slide(self) -> None:
        if any(len(pair) != 2 for pair in self.slide):
            raise ValueError(f"slide must be pairs of slip (m) and force (N), got {self.slide}")
        slips = [slip for slip, _ in self.slide]
        if self.kind == "sliding" and not slips:
            raise ValueError(
                "slide must have a pair of slip (m) and force (N) or more if kind is 'sliding', got none"
            )
        if slips and (slips[0] != 0.0 or not np.all(np.diff(slips) > 0.0)):
            raise ValueError(f"slide must have slips (m) that increase from 0, got {slips}")
        if not all(np.isfinite(pair).all() and pair[1] >= 0.0 for pair in self.slide):
            raise ValueError(
                f"slide must have finite slips (m) and finite forces (N) of at least 0, got {self.slide}"
            )

    def scaled(self, factors: Sequence[float]) -> Joint:
        """Return the joint with its places times factors along the vehicle, across and upwards."""
        places = (self.place_on_leading, self.place_on_trailing)
        ahead, behind = (_product(factors, place) for place in places)
        return replace(self, place_on_leading=ahead, place_on_trailing=behind)

    def with_fixings(self, factor: float) -> Joint:
        """Return the joint with the force that it holds times a factor, at each slip."""
        return replace(self, slide=tuple((slip, factor * force) for slip, force in self.slide))

    @property
    def shift(self) -> Floats:
        """From the origin of the leading unit's axes to that of the trailing one's, shape (3,) [m]."""
        return np.subtract(self.place_on_leading, self.place_on_trailing)


def _product(factors: Sequence[float], place: Place) -> Place:
    x, y, z = (factor * coordinate for factor, coordinate in zip(factors, place, strict=True))
    return (x, y, z)
