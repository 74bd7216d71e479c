"""Posts that yield: what their section and their foundation hold, and how heavy they are."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from .. import _core
from ..base.arguments import check_fields
from ..units import Quantity, si

__all__ = ["CONCRETE_STRENGTH", "Foundation", "Tube", "weaker_of"]

CONCRETE_STRENGTH = 30e6
"""Compressive strength of the filling that is only called ``"concrete"`` [Pa]: C30/37, a usual one."""

_STEEL, _CONCRETE = 7850.0, 2400.0  # kg/m^3
_LOAD_HEIGHT = 0.6  # of the bumpers of the standards' trucks above the ground, about (m)


@dataclass(frozen=True)
class Foundation:
    """What holds a post in the ground: a moment about a point below it, about which post and foundation turn.

    It stands still until the moment of the load about that point exceeds ``moment``, which then resists at
    any rotation. Its own weight does not act. See :meth:`in_sand` and :meth:`in_clay` for estimates.

    Parameters
    ----------
    moment
        That it resists, about the turning point [N m], > 0.
    depth
        Of the turning point below the ground [m], >= 0.
    mass
        Of what turns below the ground, for its inertia: a block from the ground to the turning point [kg].

    Raises
    ------
    ValueError
        If a number is out of range; the message names argument, limit and value.
    """

    moment: float
    depth: float = 0.0
    mass: float = 0.0

    if TYPE_CHECKING:  # what dataclass makes, and the text that __post_init__ reads

        def __init__(self, moment: Quantity, depth: Quantity = 0.0, mass: Quantity = 0.0) -> None: ...

    def __post_init__(self) -> None:
        check_fields(self, texts=("moment", "depth", "mass"))
        for name, quantity in (("moment", "moment"), ("depth", "length"), ("mass", "mass")):
            value = si(f"foundation {name}", getattr(self, name), quantity)
            object.__setattr__(self, name, value)
            least_fits = value > 0.0 if name == "moment" else value >= 0.0
            if not (math.isfinite(value) and least_fits):
                limit = "> 0" if name == "moment" else ">= 0"
                raise ValueError(f"foundation {name} must be finite and {limit}, got {value}")

    @staticmethod
    def in_sand(
        depth: Quantity,
        width: Quantity,
        friction_angle: Quantity = 32.0,
        unit_weight: float = 18e3,
        density: float = _CONCRETE,
    ) -> Foundation:
        """Return a short, stiff pile or block in sand, by Broms (1964).

        The sand resists with three times its passive pressure over the width. The block turns about its
        toe: the moment is ``0.5 unit_weight width depth**3 K_p``, with ``K_p = tan(45 deg + angle/2)**2``.
        That is a resistance to slow loads; what sand resists in an impact is more.

        Parameters
        ----------
        depth, width
            Of the block below the ground, and across the push [m].
        friction_angle
            Of the sand [deg].
        unit_weight
            Of the sand [N/m^3]; about 10e3 below the water table.
        density
            Of the block, of square section [kg/m^3].

        Raises
        ------
        ValueError
            If a number is out of range.
        """
        deep, wide = _block(depth, width, density)
        angle = si("friction_angle", friction_angle, "angle")
        if not 0.0 < angle < 60.0:
            raise ValueError(f"friction_angle must be > 0 and < 60 deg, got {angle}")
        if not (math.isfinite(unit_weight) and unit_weight > 0.0):
            raise ValueError(f"unit_weight must be finite and > 0 N/m^3, got {unit_weight}")
        passive = math.tan(math.radians(45.0 + 0.5 * angle)) ** 2
        moment = 0.5 * unit_weight * wide * deep**3 * passive
        return Foundation(moment, deep, density * wide**2 * deep)

    @staticmethod
    def in_clay(
        depth: Quantity,
        width: Quantity,
        shear_strength: Quantity,
        load_height: Quantity = _LOAD_HEIGHT,
        density: float = _CONCRETE,
    ) -> Foundation:
        """Return a short, stiff pile or block in clay, by Broms (1964).

        The clay resists with nine times its undrained shear strength over the width, below the upper 1.5
        widths, which resist nothing. That is a resistance to slow loads; in an impact it is more.

        Parameters
        ----------
        depth, width
            Of the block below the ground, and across the push [m]; the depth above 1.5 widths.
        shear_strength
            Undrained, of the clay [Pa].
        load_height
            Of the push above the ground [m]: it moves the turning point.
        density
            Of the block, of square section [kg/m^3].

        Raises
        ------
        ValueError
            If a number is out of range.
        """
        deep, wide = _block(depth, width, density)
        strength = si("shear_strength", shear_strength, "pressure")
        if not (math.isfinite(strength) and strength > 0.0):
            raise ValueError(f"shear_strength must be finite and > 0 Pa, got {strength}")
        height = si("load_height", load_height, "length")
        if not (math.isfinite(height) and height >= 0.0):
            raise ValueError(f"load_height must be finite and >= 0 m, got {height}")
        top, per_depth = 1.5 * wide, 9.0 * strength * wide
        if not deep > top:
            raise ValueError(f"depth must be above 1.5 widths ({top:g} m) in clay, got {deep}")
        # The reaction changes its sign at the turning point z. Above it the clay pushes against the load.
        # Forces: H = p (2 z - top - deep). Moments about the ground: H h + p (z^2 - top^2/2 - deep^2/2) = 0.
        half = 0.5 * (top**2 + deep**2) + height * (top + deep)
        turning = -height + math.sqrt(height**2 + half)
        push = per_depth * (2.0 * turning - top - deep)
        return Foundation(push * (height + turning), turning, density * wide**2 * deep)


def _block(depth: Quantity, width: Quantity, density: float) -> tuple[float, float]:
    """Return depth and width of a block [m], and check its density."""
    sizes = []
    for name, value in (("depth", depth), ("width", width)):
        size = si(name, value, "length")
        if not (math.isfinite(size) and size > 0.0):
            raise ValueError(f"{name} must be finite and > 0 m, got {size}")
        sizes.append(size)
    if not (math.isfinite(density) and density > 0.0):
        raise ValueError(f"density must be finite and > 0 kg/m^3, got {density}")
    return sizes[0], sizes[1]


@dataclass(frozen=True)
class Tube:
    """A round steel tube, empty or filled with concrete; SI units."""

    diameter: float
    wall_thickness: float
    yield_stress: float
    concrete_strength: float = 0.0
    """0: empty."""

    @property
    def plastic_moment(self) -> float:
        """The moment at which all of the section yields [N m].

        An empty tube has ``yield_stress (D**3 - d**3) / 6``, with its outer and inner diameter. In a filled
        one (EN 1994-1-1, 6.7.3.2, round) the concrete carries its strength in compression and no tension.
        It is held by the tube, so that it is not reduced to 0.85 of it. Axial force: none.
        """
        outer = 0.5 * self.diameter
        inner = outer - self.wall_thickness
        if self.concrete_strength == 0.0 or inner <= 0.0:
            return 4.0 / 3.0 * self.yield_stress * (outer**3 - max(inner, 0.0) ** 3)
        from scipy.optimize import brentq

        # The neutral axis is at y. Above it all is compressed. The areas' first moments about the middle are
        # 2/3 (r^2 - y^2)^(3/2) above y, and the opposite below it.
        def pushed(y: float) -> float:
            steel = _area_above(outer, y) - _area_above(inner, y)
            whole = math.pi * (outer**2 - inner**2)
            of_steel = self.yield_stress * (2.0 * steel - whole)
            return of_steel + self.concrete_strength * _area_above(inner, y)

        axis = float(brentq(pushed, 0.0, outer, xtol=1e-12 * outer, rtol=1e-14))
        steel = _moment_above(outer, axis) - _moment_above(inner, axis)
        return 2.0 * self.yield_stress * steel + self.concrete_strength * _moment_above(inner, axis)

    @property
    def mass_per_length(self) -> float:
        """Steel and filling [kg/m]."""
        outer = 0.5 * self.diameter
        inner = max(outer - self.wall_thickness, 0.0)
        filling = _CONCRETE if self.concrete_strength > 0.0 else 0.0
        return math.pi * (_STEEL * (outer**2 - inner**2) + filling * inner**2)


def _area_above(radius: float, y: float) -> float:
    """Return the area of a disc above a chord [m^2]."""
    if y >= radius:
        return 0.0
    return radius**2 * math.acos(y / radius) - y * math.sqrt(radius**2 - y**2)


def _moment_above(radius: float, y: float) -> float:
    """Return the first moment of that area about the disc's middle [m^3]."""
    return 2.0 / 3.0 * math.sqrt(max(radius**2 - y**2, 0.0)) ** 3


def weaker_of(tube: Tube, height: float, foundation: Foundation | None) -> tuple[_core.YieldingPosts, float]:
    """Return what gives way at a push 0.6 m above the ground (or at the top of a lower post), for the core.

    That is the tube at the ground, or the foundation about its turning point. Also returns the depth of the
    point about which the post turns [m].
    """
    lever = min(height, _LOAD_HEIGHT)
    bends = foundation is None or tube.plastic_moment / lever <= foundation.moment / (
        lever + foundation.depth
    )
    if foundation is None or bends:
        moment, depth, block = tube.plastic_moment, 0.0, 0.0
    else:
        moment, depth, block = foundation.moment, foundation.depth, foundation.mass
    length = height + depth
    mass = tube.mass_per_length * length
    inertia = mass * (length**2 / 3.0 + tube.diameter**2 / 16.0) + block * depth**2 / 3.0
    posts = _core.YieldingPosts(mass=mass + block, inertia=inertia, plastic_moment=moment)
    return posts, depth
