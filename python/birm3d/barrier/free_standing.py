"""Barriers that stand free on the ground: what their segments are."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from .. import _core
from ..base.arguments import check_fields
from ..units import Quantity, si

__all__ = ["FreeStanding"]

_CONCRETE = 2400.0  # kg/m^3


@dataclass(frozen=True)
class FreeStanding:
    """Segments that stand on the ground by their weight and slide when they are hit.

    A segment moves along the ground and turns about the vertical. It does not tip: how near it comes to that
    is in :attr:`birm3d.Result.overturning_ratio`; beyond 1 there is a :class:`birm3d.TippingWarning`. Its
    mass and inertia follow from its solid. What pushes it down adds to its weight on the ground, evenly over
    its base; Coulomb friction acts at the four corners.

    Parameters
    ----------
    density
        Of the solid [kg/m^3]; ``None``: that of concrete, 2400, or what ``mass_per_length`` asks for.
    mass_per_length
        Instead of the density [kg/m].
    ground_friction
        Coulomb coefficient of the base on the ground, >= 0. The default for concrete on asphalt is an
        estimate: 0.4 to 0.6 are usual in models of such barriers. Give your own where deflection matters.
    joint
        ``"pinned"``: neighbours are held together at the middle of their ends and turn freely about the
        vertical; ``"loose"``: nothing is between them, they do not even touch each other.

    Raises
    ------
    ValueError
        If a number is out of range; the message names argument, limit and value.
    """

    density: float | None = None
    mass_per_length: float | None = None
    ground_friction: float = 0.5
    joint: str = "pinned"

    if TYPE_CHECKING:  # what dataclass makes, and the text that __post_init__ reads

        def __init__(
            self,
            density: Quantity | None = None,
            mass_per_length: Quantity | None = None,
            ground_friction: float = 0.5,
            joint: str = "pinned",
        ) -> None: ...

    def __post_init__(self) -> None:
        check_fields(self, texts=("density", "mass_per_length"))
        if self.density is not None and self.mass_per_length is not None:
            raise ValueError(
                f"mass_per_length must be None where density is given, got {self.mass_per_length}"
            )
        for name, quantity in (("density", "density"), ("mass_per_length", "mass per length")):
            value = getattr(self, name)
            if value is not None:
                value = si(name, value, quantity)
                object.__setattr__(self, name, value)
            if value is not None and not 0.0 < value < math.inf:
                raise ValueError(f"{name} must be finite and > 0, got {value}")
        if not 0.0 <= self.ground_friction < math.inf:
            raise ValueError(f"ground_friction must be finite and >= 0, got {self.ground_friction}")
        if self.joint not in _core.SegmentJoint.__members__:
            known = ", ".join(_core.SegmentJoint.__members__)
            raise ValueError(f"joint must be one of {known}; got {self.joint!r}")

    def core(self, area: float) -> _core.FreeStanding:
        """Return the same for the core; ``area`` of the section [m^2]."""
        density = _CONCRETE if self.density is None else self.density
        if self.mass_per_length is not None:
            density = self.mass_per_length / area
        return _core.FreeStanding(
            density=density,
            ground_friction=self.ground_friction,
            joint=_core.SegmentJoint.__members__[self.joint],
        )
