"""What one element of a barrier has to carry: its values, and how they are read."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ..result.element_loads import ElementLoad
from ..result.result import Result
from ..scene.scene import Scene
from ..signals.filters import moving_average
from ..simulation.simulation import run_scene
from .oscillator import LEAST_INTERVALS

__all__ = [
    "BANDED",
    "DESIGNED",
    "ENVELOPED",
    "WINDOW",
    "ElementDesign",
    "System",
    "check_system",
    "degrees_between",
    "design_direction",
    "lateral_level",
    "peak_filter",
]

Floats = npt.NDArray[np.float64]

ENVELOPED = (
    "impulse",
    "peak_force",
    "force_50ms",
    "longitudinal_force_50ms",
    "moment",
    "equivalent_static_force",
    "equivalent_static_moment",
)
"""Values of which the greatest over all scenes counts, each from a scene of its own."""

DESIGNED = (*ENVELOPED, "height")
"""Values that have a design value: the greater asks for more."""

BANDED = (*DESIGNED, "direction", "dynamic_load_factor")
"""Values that have a band over the vehicles of a class."""

_CLASS = 60.0
_MOST_DUCTILITY = 100.0
WINDOW = 0.05
"""Over which 50-ms means are taken [s]."""


class System(NamedTuple):
    """The element as a system with one degree of freedom."""

    natural_period: float
    ductility: float
    damping: float


@dataclass(frozen=True, eq=False)
class ElementDesign:
    """A row of a :class:`birm3d.assessment.DesignLoad`: what one element has to carry.

    Forces are horizontal: of walls and Jersey barriers the part across their line, of posts and meshes the
    resultant. Moments are about the element's foot, as in :class:`birm3d.ElementLoad`. An element that no
    scene touches has zeros.

    Attributes
    ----------
    index : int
        Place among ``barrier.element_names``.
    name : str
    impulse : float
        Along the barrier's normal, positive into the barrier [N s]. It is that of the impact: until the
        vehicle separated from the barrier for good, or came to rest at it (slower than 0.25 m/s from then
        on). All other values count what follows, too.
    impulse_vector : ndarray, shape (3,)
        In world axes, of the same scene [N s].
    peak_force : float
        After CFC 60 (SAE J211-1), filtered before the resultant is taken [N]; unfiltered where the output
        interval is too long for it.
    force_50ms : float
        Greatest mean over 50 ms [N].
    longitudinal_force_50ms : float
        Greatest mean over 50 ms of the horizontal force along the barrier's line, its size either way [N].
    height : float
        Of ``force_50ms`` above the foot [m]; 0 where it has none, see :class:`birm3d.ElementLoad`.
    direction : float
        Of ``force_50ms`` from the barrier's normal, positive to the left seen along it [deg].
    moment : float
        Greatest 50-ms mean of the overturning moment about the foot, at ground level, without a dynamic load
        factor [N m].
    equivalent_static_force : float
        Static force that asks as much of a system of the given period, ductility and damping as the
        unfiltered load along ``direction`` [N]; it acts at ``height``. Of a post that has yielded it is
        ``yield_force``, or twice ``peak_force`` if that is less. Of one that could yield and has not, the
        system is elastic; see ``exceeds_yield``.
    equivalent_static_moment : float
        Static moment about the foot that asks as much of the same system as the unfiltered overturning
        moment [N m]: what the foot gets together with ``equivalent_static_force``. An element that turns
        about its foot is driven by that moment. So it is exact for one, where the force times ``height`` has
        one arm for all of the impact. Of a post that has yielded it is the force times ``height``, or
        ``moment`` where the load has no height.
    yield_force : float
        Of posts that yield: the moment that resists over the height of the 50-ms force above the point about
        which the post turns, in the scene of ``equivalent_static_force`` [N]. Infinite of all others.
    has_yielded : bool
        Whether the post yields in that scene.
    scene : mapping of str to int
        Each of the values above that are enveloped -> number of the scene that it comes from.
    band : mapping of str to (float, float)
        Each enveloped value, the height, the direction and the dynamic load factor -> what 10 % of the
        vehicles of the class stay below, and what 10 % exceed. Empty where none were drawn.
    touched : bool
        Whether the scene of ``equivalent_static_force`` loads it.
    case : Result, Scene or None
        That result, or the scene where no result was given.
    """

    index: int
    name: str
    impulse: float = 0.0
    impulse_vector: Floats = field(default_factory=lambda: np.zeros(3))
    peak_force: float = 0.0
    force_50ms: float = 0.0
    longitudinal_force_50ms: float = 0.0
    height: float = 0.0
    direction: float = 0.0
    moment: float = 0.0
    equivalent_static_force: float = 0.0
    equivalent_static_moment: float = 0.0
    yield_force: float = math.inf
    has_yielded: bool = False
    scene: Mapping[str, int] = field(default_factory=dict)
    band: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    touched: bool = False
    case: Result | Scene | None = None

    @property
    def design(self) -> Mapping[str, float]:
        """Design value of each enveloped value and of the height, SI: the upper end of its band.

        The value itself where that is greater, or where there is no band: check ``draws`` of the design load.
        About one vehicle of the class in ten exceeds the upper end. Errors of the model and partial factors
        are not in it. Of the impulse the size counts, with its sign.
        """
        ends = {name: (getattr(self, name), *self.band.get(name, ())) for name in DESIGNED}
        return {name: float(max(values, key=abs)) for name, values in ends.items()}

    @property
    def dynamic_load_factor(self) -> float:
        """``equivalent_static_force`` over ``peak_force``; 0 without load."""
        return self.equivalent_static_force / self.peak_force if self.peak_force > 0.0 else 0.0

    @property
    def exceeds_yield(self) -> bool:
        """Whether a post that has not yielded would yield as the elastic system of the static force.

        It resists ``yield_force``. The equivalent static force is greater: it is what a stronger one would
        pass on to its foundation.
        """
        return not self.has_yielded and self.equivalent_static_force > self.yield_force

    @property
    def can_yield(self) -> bool:
        """Whether it is a post that could yield, whether it does or not."""
        return math.isfinite(self.yield_force)

    @cached_property
    def load(self) -> ElementLoad | None:
        """Histories in the scene of ``equivalent_static_force``; ``None`` if nothing touches it there.

        Histories of many scenes would take much memory: this scene is run again, to the same bits.
        """
        if not self.touched or self.case is None:
            return None
        result = self.case if isinstance(self.case, Result) else run_scene(self.case)
        return result.element_loads[self.index]

    def to_dict(self) -> dict[str, object]:
        """Return all values as plain ones, SI."""
        return {
            "element": self.name,
            "impulse": self.impulse,
            "impulse_vector": self.impulse_vector.tolist(),
            **{name: getattr(self, name) for name in ENVELOPED if name != "impulse"},
            **{name: getattr(self, name) for name in ("height", "direction", "dynamic_load_factor")},
            "has_yielded": self.has_yielded,
            "exceeds_yield": self.exceeds_yield,
            "scene": dict(self.scene),
            "band": {name: list(ends) for name, ends in self.band.items()},
            "design": dict(self.design),
        }

    def __repr__(self) -> str:
        force, moment = self.design["equivalent_static_force"], self.design["equivalent_static_moment"]
        design = f"; design: {force:.4g} N, {moment:.4g} N m" if self.band else ""
        return (
            f"ElementDesign({self.name!r}, force_50ms={self.force_50ms:.4g} N at {self.height:.2f} m, "
            f"moment={self.moment:.4g} N m, "
            f"equivalent_static_force={self.equivalent_static_force:.4g} N, "
            f"equivalent_static_moment={self.equivalent_static_moment:.4g} N m{design})"
        )


def check_system(system: System, interval: float, name: str = "natural_period") -> None:
    """Refuse a system that has no response, or whose period is too short for loads at an interval [s].

    Raises
    ------
    ValueError
        Naming the argument (``name``: that of the period), its limit and the value.
    """
    least = LEAST_INTERVALS * interval
    if not least <= system.natural_period < math.inf:
        raise ValueError(
            f"{name} must be finite and >= {least:g} s ({LEAST_INTERVALS} output intervals), "
            f"got {system.natural_period}"
        )
    if not 1.0 <= system.ductility <= _MOST_DUCTILITY:
        raise ValueError(f"ductility must be >= 1 and <= {_MOST_DUCTILITY:g}, got {system.ductility}")
    if not 0.0 <= system.damping < 1.0:
        raise ValueError(f"damping must be >= 0 and < 1, got {system.damping}")


def peak_filter(interval: float) -> str:
    """Return how peaks are filtered at an output interval [s]: ``"CFC 60"`` or ``"unfiltered"``."""
    return f"CFC {_CLASS:g}" if interval * _CLASS <= 0.1 else "unfiltered"


def design_direction(load: ElementLoad, normal: Floats) -> Floats:
    """Return the horizontal unit vector along which an element is designed, shape (3,).

    Of a wall the normal; else that of the greatest 50-ms mean of the horizontal force.
    """
    if load.line is not None:
        return normal
    mean = moving_average(load.force[:, :2], WINDOW, load.interval)
    x, y = mean[int(np.argmax(np.hypot(*mean.T)))]
    size = math.hypot(x, y)
    return np.array([x / size, y / size, 0.0]) if size > 0.0 else normal


def lateral_level(force: Floats, load: ElementLoad, normal: Floats) -> Floats:
    """Return the size of the horizontal force, of a wall across its line, shape (n,)."""
    if load.line is not None:
        return np.abs(force @ normal)
    return np.asarray(np.hypot(force[:, 0], force[:, 1]))


def degrees_between(normal: Floats, direction: Floats) -> float:
    """Return the angle from a normal to a direction, seen from above, positive to the left [deg]."""
    across = normal[0] * direction[1] - normal[1] * direction[0]
    return math.degrees(math.atan2(across, float(normal @ direction)))
