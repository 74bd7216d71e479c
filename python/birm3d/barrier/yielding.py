"""Posts that yield: what their section and their foundation resist, and how heavy they are."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from .. import _core
from ..base.arguments import check_fields
from ..base.checks import positive_and_finite
from ..unit_check import given
from ..units import Quantity, Stated, si

__all__ = ["CONCRETE_STRENGTH", "Foundation", "Tube", "Weaker", "weaker_of"]

CONCRETE_STRENGTH = 30e6
"""Compressive strength of the filling that is only called ``"concrete"`` [Pa]: C30/37, a usual one."""

_STEEL, _CONCRETE = 7850.0, 2400.0  # kg/m^3
_LOAD_HEIGHT = 0.6  # of the bumpers of the standards' trucks above the ground, about (m)


@dataclass(frozen=True)
class Foundation:
    """What holds a post in the ground: a moment about a centre of rotation, about which post and block turn.

    It stands still until the moment of the load about that centre exceeds ``moment``. Then that resists at
    any rotation: what a block loses as it turns out of the soil is left out. Its weight does not act. The
    estimates of :meth:`in_sand` and :meth:`in_clay` are for single, short piles and deep blocks. They are not
    for pads, slabs, beams and shallow mounts, which resist by their weight and their base: give the moment of
    those yourself, best from a test.

    Parameters
    ----------
    moment
        That it resists, about the centre of rotation [N m], > 0.
    rotation_depth
        Of the centre of rotation below the ground [m], >= 0.
    mass
        Of what turns below the ground, for its inertia, as a block from the ground to that centre [kg].

    Raises
    ------
    ValueError
        If a number is out of range; the message names argument, limit and value.
    """

    moment: float
    rotation_depth: float = 0.0
    mass: float = 0.0

    if TYPE_CHECKING:  # what dataclass makes, and the text that __post_init__ reads

        def __init__(
            self, moment: Quantity, rotation_depth: Quantity = 0.0, mass: Quantity = 0.0
        ) -> None: ...

    def __post_init__(self) -> None:
        check_fields(self, texts=("moment", "rotation_depth", "mass"))
        object.__setattr__(self, "moment", given("moment", self.moment))
        object.__setattr__(self, "rotation_depth", si("rotation_depth", self.rotation_depth, "length"))
        object.__setattr__(self, "mass", si("mass", self.mass, "mass"))
        positive_and_finite("foundation moment", self.moment, "N m")
        for name in ("rotation_depth", "mass"):
            value = getattr(self, name)
            if not 0.0 <= value < math.inf:
                raise ValueError(f"foundation {name} must be finite and >= 0, got {value}")

    @staticmethod
    def in_sand(
        depth: Quantity,
        width: Quantity,
        friction_angle: Quantity,
        unit_weight: float = 18e3,
        density: float = _CONCRETE,
    ) -> Foundation:
        """Return a short, stiff pile or a deep block in sand, by Broms (1964).

        The sand resists with three times its passive pressure over the width: it engages about three widths
        of soil, so that blocks must stand further apart than that. The block turns about its toe, with the
        moment ``0.5 unit_weight width depth**3 K_p``, ``K_p = tan(45 deg + angle/2)**2``. That is the
        ultimate resistance to a slow load, without a safety factor.

        Parameters
        ----------
        depth, width
            Of the block below the ground, and across the load [m].
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
        positive_and_finite("unit_weight", unit_weight, "N/m^3")
        passive = math.tan(math.radians(45.0 + 0.5 * angle)) ** 2
        moment = 0.5 * unit_weight * wide * deep**3 * passive
        return Foundation(Stated(moment), deep, density * wide**2 * deep)

    @staticmethod
    def in_clay(
        depth: Quantity,
        width: Quantity,
        undrained_shear_strength: Quantity,
        load_height: Quantity = _LOAD_HEIGHT,
        density: float = _CONCRETE,
    ) -> Foundation:
        """Return a short, stiff pile or a deep block in clay, by Broms (1964).

        The clay resists with nine times its undrained shear strength over the width, below the upper 1.5
        widths, which resist nothing. That is the ultimate resistance to a slow load, without a safety factor.

        Parameters
        ----------
        depth, width
            Of the block below the ground, and across the load [m]; the depth above 1.5 widths.
        undrained_shear_strength
            Of the clay [Pa].
        load_height
            Of the load above the ground [m]: it moves the centre of rotation, which is above the toe.
        density
            Of the block, of square section [kg/m^3].

        Raises
        ------
        ValueError
            If a number is out of range.
        """
        deep, wide = _block(depth, width, density)
        strength = given("undrained_shear_strength", undrained_shear_strength)
        positive_and_finite("undrained_shear_strength", strength, "Pa")
        height = si("load_height", load_height, "length")
        if not 0.0 <= height < math.inf:
            raise ValueError(f"load_height must be finite and >= 0 m, got {height}")
        top, per_depth = 1.5 * wide, 9.0 * strength * wide
        if not deep > top:
            raise ValueError(f"depth must be above 1.5 widths ({top:g} m) in clay, got {deep}")
        # The reaction changes its sign at the centre of rotation z. Above z it acts against the load.
        # Forces: H = p (2 z - top - deep). Moments about the ground: H h + p (z^2 - top^2/2 - deep^2/2) = 0.
        half = 0.5 * (top**2 + deep**2) + height * (top + deep)
        center = -height + math.sqrt(height**2 + half)
        load = per_depth * (2.0 * center - top - deep)
        # The mass with which a block above the centre has the inertia of the parts above and below it.
        mass = density * wide**2 * (center**3 + (deep - center) ** 3) / center**2
        return Foundation(Stated(load * (height + center)), center, mass)


def _block(depth: Quantity, width: Quantity, density: float) -> tuple[float, float]:
    """Return depth and width of a block [m], and check its density."""
    sizes = [si(name, value, "length") for name, value in (("depth", depth), ("width", width))]
    for name, size in zip(("depth", "width"), sizes, strict=True):
        positive_and_finite(name, size)
    positive_and_finite("density", density, "kg/m^3")
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
        It is held by the tube, so that it is not reduced to 0.85 of it. Axial force: none. The value is
        nominal: no partial factors, and not the factor alpha_M (0.9) of that standard.
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
    def is_slender(self) -> bool:
        """Whether the wall may buckle before the section has its plastic moment, or soon after.

        Beyond ``D / t = 50 * 235 MPa / yield_stress``, class 1 of EN 1993-1-1, table 5.2; of a filled tube
        beyond 90 instead of 50 (EN 1994-1-1, table 6.3).
        """
        limit = (90.0 if self.concrete_strength > 0.0 else 50.0) * 235e6 / self.yield_stress
        return self.diameter > limit * self.wall_thickness

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


@dataclass(frozen=True)
class Weaker:
    """What gives way: the tube at the ground, or the foundation about its centre of rotation."""

    posts: _core.YieldingPosts
    rotation_depth: float
    """Of the centre of rotation below the ground [m]."""
    foundation_turns: bool
    switch_height: float
    """Of a load above the ground [m]: a lower one turns the foundation, a higher one bends the tube."""

    def greatest_load(self, height: float) -> float:
        """Return the steady force that a post stands at a height above the ground [m], in N."""
        arm = height + self.rotation_depth
        return self.posts.plastic_moment / arm if arm > 0.0 else math.inf


def weaker_of(tube: Tube, height: float, foundation: Foundation | None) -> Weaker:
    """Return what gives way under a load 0.6 m above the ground, or at the top of a lower post."""
    moment, depth, block = tube.plastic_moment, 0.0, 0.0
    switch = 0.0 if foundation is None else _switch_height(moment, foundation)
    turns = min(height, _LOAD_HEIGHT) < switch
    if foundation is not None and turns:
        moment, depth, block = foundation.moment, foundation.rotation_depth, foundation.mass
    length = height + depth
    mass = tube.mass_per_length * length
    inertia = mass * (length**2 / 3.0 + tube.diameter**2 / 16.0) + block * depth**2 / 3.0
    posts = _core.YieldingPosts(mass=mass + block, inertia=inertia, plastic_moment=moment)
    return Weaker(posts, depth, turns, switch)


def _switch_height(tube_moment: float, foundation: Foundation) -> float:
    """Return the height of a load under which tube and foundation give way together [m].

    That is where ``M_t / h = M_f / (h + d)``, with the depth ``d`` of the centre of rotation. A foundation
    that is weaker at any height has no such place: infinity.
    """
    stronger, depth = foundation.moment - tube_moment, foundation.rotation_depth
    if stronger > 0.0:
        return depth * tube_moment / stronger
    return math.inf if stronger < 0.0 or depth > 0.0 else 0.0  # alike: the tube
