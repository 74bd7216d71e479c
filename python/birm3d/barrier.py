"""Barriers: what a vehicle runs into."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from . import _core

__all__ = ["Barrier"]


@dataclass(frozen=True)
class Barrier:
    """A barrier fixed to the ground. Make one with :meth:`rigid_wall` or :meth:`pole`.

    Its line runs along +y at heading 0 and its traffic face looks to -x; the vehicle comes from there.

    Parameters
    ----------
    friction
        Coulomb coefficient between vehicle and barrier.
    origin
        A point of the foot of the traffic face, of a pole the foot of its axis, world axes [m], shape (3,).
    heading
        Turn of the barrier's line about the vertical [deg].
    width, height
        Of the wall, its middle at the origin [m]; may be infinite.
    diameter
        Of a pole [m]; ``None``: a flat wall.
    """

    friction: float = 0.2
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
    heading: float = 0.0
    width: float = math.inf
    height: float = math.inf
    diameter: float | None = None

    def __post_init__(self) -> None:
        _ = self.core

    @staticmethod
    def rigid_wall(
        *,
        width: float | None = None,
        height: float | None = None,
        friction: float = 0.2,
        origin: Sequence[float] = (0.0, 0.0, 0.0),
        heading: float = 0.0,
    ) -> Barrier:
        """Return a flat, rigid, vertical wall.

        Parameters
        ----------
        width, height
            Of the wall, its middle at the origin [m]; ``None``: without end. The ends and the top are not
            modelled: a vehicle that meets the wall's plane beyond them is refused while running.
        friction
            Coulomb coefficient vehicle-wall, 0.15 to 0.20 for steel on concrete (paper 5.4).
        origin
            A point of the foot of the face, world axes [m], shape (3,).
        heading
            Turn of the wall about the vertical [deg]; at 0 the face looks to -x.

        Raises
        ------
        ValueError
            If a number is not finite, friction is negative, or width or height is not above 0.
        """
        return Barrier(
            friction=float(friction),
            origin=_point(origin),
            heading=float(heading),
            width=math.inf if width is None else float(width),
            height=math.inf if height is None else float(height),
        )

    @staticmethod
    def pole(
        *,
        diameter: float = 0.3,
        friction: float = 0.2,
        origin: Sequence[float] = (0.0, 0.0, 0.0),
        heading: float = 0.0,
    ) -> Barrier:
        """Return one rigid, upright cylinder, taller than any vehicle.

        Parameters
        ----------
        diameter
            [m], > 0.
        friction
            Coulomb coefficient vehicle-pole.
        origin
            Foot of the axis, world axes [m], shape (3,); the barrier's line runs through it.
        heading
            Turn of the barrier's line about the vertical [deg], from which impact angles are counted.

        Raises
        ------
        ValueError
            If a number is not finite, friction is negative, or the diameter is not above 0.
        """
        return Barrier(
            friction=float(friction), origin=_point(origin), heading=float(heading), diameter=float(diameter)
        )

    @cached_property
    def core(self) -> _core.Barrier:
        """The same barrier for the core."""
        if self.diameter is not None:
            if not (math.isfinite(self.diameter) and self.diameter > 0.0):
                raise ValueError(f"diameter must be finite and > 0, got {self.diameter}")
            for name in ("width", "height"):
                if getattr(self, name) != math.inf:
                    raise ValueError(f"{name} must be inf for a pole, got {getattr(self, name)}")
            return _core.Barrier.pole(
                friction=self.friction,
                origin=np.asarray(self.origin, float),
                heading=math.radians(self.heading),
                radius=0.5 * self.diameter,
            )
        return _core.Barrier(
            friction=self.friction,
            origin=np.asarray(self.origin, float),
            heading=math.radians(self.heading),
            width=self.width,
            height=self.height,
        )

    def __getstate__(self) -> dict[str, object]:
        return {name: value for name, value in self.__dict__.items() if name != "core"}


def _point(origin: Sequence[float]) -> tuple[float, float, float]:
    if np.shape(origin) != (3,):
        raise ValueError(f"origin must have shape (3,), got {np.shape(origin)}")
    x, y, z = (float(value) for value in origin)
    return x, y, z
