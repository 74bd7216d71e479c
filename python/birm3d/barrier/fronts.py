"""Fronts of barriers on which load maps stand: flat and sloped faces, and rows of posts."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

__all__ = ["FlatFront", "Front", "PostFront", "SlopedFront", "axes_of", "feet_of"]

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
        place = world - self.origin
        return place @ self.across, place @ self.line, place[:, 2]


@dataclass(frozen=True)
class FlatFront(Front):
    """A vertical front with rounded upright edges, if any."""

    half_width: float = math.inf
    radius: float = 0.0

    def pressed(self, world: Floats, push: Floats) -> tuple[Floats, Floats, Floats]:
        """Return nodes on the flat face or on a rounded edge."""
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
class SlopedFront(Front):
    """A front of plane strips that lean back; ``profile`` has depth and height of its corners, (n, 2)."""

    half_width: float = math.inf
    profile: Floats = field(default_factory=lambda: np.zeros((2, 2)))

    def pressed(self, world: Floats, push: Floats) -> tuple[Floats, Floats, Floats]:
        """Return nodes on one of the strips."""
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
        return along[here], np.maximum(height[here], level[0]), (pressing * normal_across)[here]


@dataclass(frozen=True)
class PostFront(Front):
    """Posts in a row: what a node presses is on the nearest one, also where the post draws the skin in."""

    def pressed(self, world: Floats, push: Floats) -> tuple[Floats, Floats, Floats]:
        """Return nodes that a post presses."""
        _, along, height = self.places(world)
        across = push @ self.across
        nearest = self.feet[np.argmin(np.abs(along[:, None] - self.feet), axis=1)]
        here = (across > 0.0) & (height >= 0.0)
        return nearest[here], np.minimum(height[here], self.top), across[here]


def axes_of(origin: Sequence[float], heading: float) -> tuple[Floats, Floats, Floats]:
    """Return the origin of a barrier, and unit vectors along its line and into it; heading in degrees."""
    angle = math.radians(heading)
    line = np.array([-math.sin(angle), math.cos(angle), 0.0])
    return np.asarray(origin, float), line, np.array([line[1], -line[0], 0.0])


def feet_of(width: float, segments: int) -> Floats:
    """Return the places of the feet of equal segments along the line [m]."""
    if segments == 1:
        return np.zeros(1)
    return np.asarray(width * ((np.arange(segments) + 0.5) / segments - 0.5))
