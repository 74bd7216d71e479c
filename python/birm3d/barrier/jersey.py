"""Concrete barriers with sloped faces."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from types import MappingProxyType
from typing import ClassVar

import numpy as np
import numpy.typing as npt
from typing_extensions import override

from .. import _core
from .barrier_kind import BarrierKind, Surface
from .blocks import FOOT, along_line, numbered, positive, seen_block
from .description import SeenPart, Size, height_text, length_text, segments_text
from .free_standing import FreeStanding
from .fronts import SlopedFront, axes_of, feet_of
from .surfaces import ends, extruded

__all__ = ["PROFILES", "JerseyKind"]

Floats = npt.NDArray[np.float64]

# Half widths and heights of concrete barriers [in] with the slope of the upper face [deg]: 3 in vertical,
# 55 deg to the break, 84 deg above (FHWA; the break is at 13 in for New Jersey, at 10 in for the F-shape);
# Texas single slope 10.8 deg from the vertical, base 24 in.
_INCH = 0.0254
PROFILES = MappingProxyType(
    {
        "new_jersey": ((12.0, 0.0), (12.0, 3.0), (12.0 - 10.0 / math.tan(math.radians(55.0)), 13.0)),
        "f_shape": ((12.0, 0.0), (12.0, 3.0), (12.0 - 7.0 / math.tan(math.radians(55.0)), 10.0)),
        "single_slope": ((12.0, 0.0),),
    }
)
"""Lower points (half width, height) of the named profiles [in]; the upper face follows."""
_UPPER_SLOPE = {"new_jersey": 84.0, "f_shape": 84.0, "single_slope": 90.0 - 10.8}
_USUAL_HEIGHT = {"new_jersey": 32.0, "f_shape": 32.0, "single_slope": 42.0}
_TITLES = {
    "new_jersey": "New Jersey barrier",
    "f_shape": "F-shape barrier",
    "single_slope": "single-slope barrier",
}


@dataclass(frozen=True)
class JerseyKind(BarrierKind):
    """A concrete barrier with sloped faces, the same on both sides; its line is the traffic face's foot."""

    profile: str | tuple[tuple[float, float], ...] = "new_jersey"
    height: float | None = None
    length: float = math.inf
    segments: int = 1
    free_standing: FreeStanding | None = None

    _counts: ClassVar = ("segments",)
    title: ClassVar = "Jersey barrier"
    sizes: ClassVar = (
        Size("profile", "choice", choices=tuple(PROFILES)),
        Size("height"),
        Size("length", hint="[default: without end]"),
        Size("segments", "count", "where it has ends"),
        Size("free_standing", "flag", "segments slide on the ground, pinned end to end"),
        Size("density", "density", "where it is free-standing, kg/m^3  [default: 2400]"),
    )
    is_straight: ClassVar = True

    def half_profile(self) -> Floats:
        """Return half width and height of the face's corners from the foot to the top, shape (n, 2) [m]."""
        if not isinstance(self.profile, str):
            if self.height is not None:
                raise ValueError(f"height must be None for a profile of points, got {self.height}")
            points = np.array(self.profile, float)
            if points.ndim != 2 or points.shape[1] != 2 or len(points) < 2:
                raise ValueError(f"profile must have shape (n, 2) with n >= 2, got {points.shape}")
            if not np.isfinite(points).all():
                raise ValueError(f"profile must be finite, got {points.tolist()}")
            rises = points[0, 1] == 0.0 and (np.diff(points[:, 1]) > 0.0).all()
            if not (rises and (points[:, 0] > 0.0).all()):
                raise ValueError(
                    f"profile must begin at height 0, rise, and have half widths > 0, got {points.tolist()}"
                )
            return points
        if self.profile not in PROFILES:
            raise ValueError(f"profile must be one of {', '.join(PROFILES)}, or points; got {self.profile!r}")
        lower = np.array(PROFILES[self.profile]) * _INCH
        top = _USUAL_HEIGHT[self.profile] * _INCH if self.height is None else self.height
        slope = math.tan(math.radians(_UPPER_SLOPE[self.profile]))
        half, height = lower[-1]
        highest = height + half * slope
        if not height < top < highest:
            raise ValueError(f"height must be above {height:.3f} and below {highest:.3f} m, got {top}")
        return np.vstack([lower, [half - (top - height) / slope, top]])

    def elements(self) -> list[_core.Element]:
        """Return the segments, from low y to high y."""
        positive("length", self.length)
        if math.isinf(self.length) and self.segments > 1:
            raise ValueError(f"segments must be 1 for a barrier of infinite length, got {self.segments}")
        half = self.half_profile()
        base = half[0, 0]
        left = half[::-1] * [-1.0, 1.0]
        corners = np.vstack([[-base, -FOOT], [base, -FOOT], half, left])
        # Segments that turn open gaps, into which their ends look.
        fixed = self.free_standing is None
        return along_line(self, corners, base, self.length, self.segments, abutting=fixed)

    @property
    def is_pinned(self) -> bool:
        """Whether it has free-standing segments that are pinned to each other."""
        return self.free_standing is not None and self.free_standing.joint == "pinned"

    def stands_free(self) -> _core.FreeStanding | None:
        """Return how its segments stand free, for the core; ``None`` where they are fixed."""
        if self.free_standing is None:
            return None
        if math.isinf(self.length):
            raise ValueError(f"length must be finite where the barrier is free-standing, got {self.length}")
        if self.origin[2] != 0.0:
            raise ValueError(f"origin must be on the ground (z = 0 m) where free-standing, got {self.origin}")
        half, level = self.half_profile().T
        return self.free_standing.core(2.0 * float(np.trapezoid(half, level)))

    @property
    def element_names(self) -> tuple[str, ...]:
        """``barrier``, or its segments from low y to high y."""
        return numbered("barrier", "segment", self.segments)

    @property
    def text(self) -> str:
        """Profile and sizes in a few words."""
        kind = _TITLES.get(self.profile) if isinstance(self.profile, str) else None
        name = f"{kind or 'concrete barrier'}, {height_text(float(self.half_profile()[-1, 1]))}"
        free = "" if self.free_standing is None else ", free-standing"
        return f"{name}, {length_text(self.length)}{segments_text(self.segments)}{free}"

    def load_front(self) -> SlopedFront:
        """Return the profile; loads are at half of its height."""
        half, level = self.half_profile().T
        deep = half[0] - half
        lever = float(np.interp(0.5 * level[-1], level, deep)) - float(half[0])
        return SlopedFront(
            *axes_of(self.origin, self.heading),
            float(level[-1]),
            feet_of(self.length, self.segments),
            lever,
            half_width=0.5 * self.length,
            profile=np.column_stack([deep, level]),
        )

    @override
    def surfaces(self, top: float, seen: tuple[float, float]) -> list[Surface]:
        """Return closed segments."""
        half, level = self.half_profile().T
        return extruded(self, half[0] - half, half[0] + half, level, ends(self.length, self.segments, seen))

    def seen_parts(self, angle: float) -> Iterator[SeenPart]:
        """Yield the barrier as one part."""
        half, height = self.half_profile().T
        yield seen_block(self, angle, "barrier", 2.0 * half.max(), self.length, height.max())
