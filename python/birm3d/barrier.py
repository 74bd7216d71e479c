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
    """A barrier fixed to the ground. Make one with :meth:`rigid_wall`.

    Its line runs along +y at heading 0 and its traffic face looks to -x; the vehicle comes from there.

    Parameters
    ----------
    friction
        Coulomb coefficient between vehicle and barrier.
    origin
        A point of the foot of the traffic face, world axes [m], shape (3,).
    heading
        Turn of the barrier's line about the vertical [deg].
    width, height
        Of the wall, its middle at the origin [m]; may be infinite.
    """

    friction: float = 0.2
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
    heading: float = 0.0
    width: float = math.inf
    height: float = math.inf

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
        if np.shape(origin) != (3,):
            raise ValueError(f"origin must have shape (3,), got {np.shape(origin)}")
        x, y, z = (float(value) for value in origin)
        return Barrier(
            friction=float(friction),
            origin=(x, y, z),
            heading=float(heading),
            width=math.inf if width is None else float(width),
            height=math.inf if height is None else float(height),
        )

    @cached_property
    def core(self) -> _core.Barrier:
        """The same barrier for the core."""
        return _core.Barrier(
            friction=self.friction,
            origin=np.asarray(self.origin, float),
            heading=math.radians(self.heading),
            width=self.width,
            height=self.height,
        )

    def __getstate__(self) -> dict[str, object]:
        return {name: value for name, value in self.__dict__.items() if name != "core"}
