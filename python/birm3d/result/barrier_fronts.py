"""Fronts of barriers on which load maps stand: flat and sloped faces, and rows of posts."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from ..barrier.base import Barrier
from ..barrier.kinds import Bollards, Jersey, Planter, Pole, RigidWall

__all__ = ["Front", "front_of"]

Floats = npt.NDArray[np.float64]

_NEAR = 1e-3  # of the face: a node that pushes and is as near stands on it [m]


@dataclass(frozen=True)
class Front(ABC):
    """Where a load map looks.

    Attributes
    ----------
    origin, line, across
        Of the barrier's line, world; unit vectors along it and into the barrier, shape (3,).
    top
        Of the barrier [m].
    feet
        Place of each element's foot along the line [m].
    lever
        Depth of the loaded face from the feet [m], negative towards the traffic.
    columns
        Edges of the columns where each element has one of its own, else ``None`` [m].
    """

    origin: Floats
    line: Floats
    across: Floats
    top: float
    feet: Floats
    lever: float = 0.0
    columns: Floats | None = None

    @abstractmethod
    def pressed(self, world: Floats, push: Floats) -> tuple[Floats, Floats, Floats]:
        """Return place along the line, height, and force across it of the nodes that press on the front.

        world: nodes that push, shape (n, 3) [m]. push: force of the truss of each, shape (n, 3) [N].
        """

    def places(self, world: Floats) -> tuple[Floats, Floats, Floats]:
        """Return depth behind the line, place along it, and height, each of shape (n,) [m]."""
        way = world - self.origin
        return way @ self.across, way @ self.line, way[:, 2]


@dataclass(frozen=True)
class _Flat(Front):
    """A vertical front with rounded upright edges, if any."""

    half_width: float = math.inf
    radius: float = 0.0

    def pressed(self, world: Floats, push: Floats) -> tuple[Floats, Floats, Floats]:
        depth, along, height = self.places(world)
        # The force along the truss, projected on the face's normal.
        across = push @ self.across
        here = self._on_it(depth, along) & (across > 0.0)
        return along[here], height[here], across[here]

    def _on_it(self, depth: Floats, along: Floats) -> npt.NDArray[np.bool_]:
        flat = (np.abs(depth) <= _NEAR) & (np.abs(along) <= self.half_width + _NEAR)
        if self.radius == 0.0:
            return flat
        beyond = np.abs(along) - (self.half_width - self.radius)
        circle = np.hypot(beyond, depth - self.radius)
        rounded = (beyond > 0.0) & (depth < self.radius) & (np.abs(circle - self.radius) <= _NEAR)
        return np.asarray((flat & (beyond <= 0.0)) | rounded)


@dataclass(frozen=True)
class _Sloped(Front):
    """A front of plane strips that lean back; ``profile`` has depth and height of its corners, (n, 2)."""

    half_width: float = math.inf
    profile: Floats = field(default_factory=lambda: np.zeros((2, 2)))

    def pressed(self, world: Floats, push: Floats) -> tuple[Floats, Floats, Floats]:
        depth, along, height = self.places(world)
        deep, level = self.profile.T
        strip = np.clip(np.searchsorted(level, height, side="right") - 1, 0, len(level) - 2)
        run, rise = np.diff(deep)[strip], np.diff(level)[strip]
        size = np.hypot(run, rise)
        normal_across, normal_up = rise / size, -run / size
        off = (depth - deep[strip]) * normal_across + (height - level[strip]) * normal_up
        pressing = push @ self.across * normal_across + push[:, 2] * normal_up
        here = (np.abs(off) <= _NEAR) & (np.abs(along) <= self.half_width + _NEAR) & (pressing > 0.0)
        here &= (height <= self.top + _NEAR) & (height >= level[0] - _NEAR)
        return along[here], height[here], (pressing * normal_across)[here]


@dataclass(frozen=True)
class _Posts(Front):
    """Posts in a row: what a node presses is on the nearest one, also where the post draws the skin in."""

    def pressed(self, world: Floats, push: Floats) -> tuple[Floats, Floats, Floats]:
        _, along, height = self.places(world)
        across = push @ self.across
        nearest = self.feet[np.argmin(np.abs(along[:, None] - self.feet), axis=1)]
        here = (across > 0.0) & (height >= 0.0)
        return nearest[here], np.minimum(height[here], self.top), across[here]


def front_of(barrier: Barrier | None) -> Front:
    """Return the front of a barrier.

    Raises
    ------
    ValueError
        If it is a kind that has no load map, or moves.
    """
    if not isinstance(barrier, (RigidWall, Jersey, Planter, Pole, Bollards)):
        got = "none" if barrier is None else type(barrier).__name__
        raise ValueError(
            f"barrier must be a wall, a Jersey barrier, a planter or posts to have a load map, got {got}"
        )
    if barrier.stands_free() is not None:
        raise ValueError("barrier must be fixed to have a load map, got one that stands free")
    angle = math.radians(barrier.heading)
    line = np.array([-math.sin(angle), math.cos(angle), 0.0])
    axes = (np.asarray(barrier.origin, float), line, np.array([line[1], -line[0], 0.0]))
    if isinstance(barrier, RigidWall):
        feet = _feet(barrier.width, barrier.segments)
        return _Flat(*axes, barrier.height, feet, half_width=0.5 * barrier.width, radius=barrier.edge_radius)
    if isinstance(barrier, Planter):
        return _Flat(*axes, barrier.height, np.zeros(1), half_width=0.5 * barrier.length)
    if isinstance(barrier, Jersey):
        half, level = barrier.half_profile().T
        deep = half[0] - half
        lever = float(np.interp(0.5 * level[-1], level, deep)) - float(half[0])
        feet, profile = _feet(barrier.length, barrier.segments), np.column_stack([deep, level])
        width = 0.5 * barrier.length
        return _Sloped(*axes, float(level[-1]), feet, lever, half_width=width, profile=profile)
    return _posts(barrier, axes)


def _posts(barrier: Pole | Bollards, axes: tuple[Floats, Floats, Floats]) -> Front:
    if isinstance(barrier, Pole):
        edges = np.array([-0.5, 0.5]) * barrier.diameter
        return _Posts(*axes, math.inf, np.zeros(1), -0.5 * barrier.diameter, edges)
    if barrier.rows > 1:
        raise ValueError(f"barrier must have one row of posts to have a load map, got {barrier.rows} rows")
    feet = np.array([along for _, along in barrier.places()])
    half = 0.5 * (barrier.spacing if barrier.count > 1 else barrier.diameter)
    edges = np.append(feet - half, feet[-1] + half)
    return _Posts(*axes, barrier.height, feet, -0.5 * barrier.diameter, edges)


def _feet(width: float, segments: int) -> Floats:
    """Return the places of the feet of equal segments along the line [m]."""
    if segments == 1:
        return np.zeros(1)
    return np.asarray(width * ((np.arange(segments) + 0.5) / segments - 0.5))
