"""Loads on the elements of a barrier: each post, each segment of a wall."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from ..signals.filters import cfc, moving_average, peak_of_cfc
from .record import RunRecord
from .unit_result import read_only

__all__ = [
    "LEAST_SHARE",
    "ElementLoad",
    "element_loads",
    "overturning",
    "resultant_height",
    "touched_elements",
]

Floats = npt.NDArray[np.float64]

LEAST_SHARE = 0.01
"""Fraction of its greatest value below which the height of a horizontal force is not computed."""

_CLASS, _LONGEST = 60.0, 0.1  # channel frequency class, and the longest interval that it takes, times it
_WINDOW = 0.05  # s


@dataclass(frozen=True, eq=False)
class ElementLoad:
    """What one element of a barrier feels, n rows; interval means.

    Forces are those of the vehicle on the element, in world axes (z up): the sum over all elements is
    ``-result.barrier_force``. Moments are about the element's foot. The foot is that of a post's axis, the
    middle of the foot of a wall segment's face, or the middle of a Jersey segment's base. A mesh has its
    moments about the barrier's origin. A free-standing segment takes its foot along; its line is that at the
    start. A moment follows the right-hand rule: a force along +x at a height has a moment about +y.

    Peaks are magnitudes of the resultant, which is the sum of the force vectors of all nodes on the element.
    50-ms values are magnitudes of the mean of that vector. Where a crush zone is used up, the rigid body
    strikes the element, and the unfiltered peak has all of that impulse in one interval. Then compare 50-ms
    means, or filter the histories.

    Attributes
    ----------
    index, name
        Place among ``barrier.element_names``, and what it says there.
    force
        Shape (n, 3) [N].
    moment
        About the foot, shape (n, 3) [N m].
    interval
        Between rows [s].
    line
        Of a wall or a Jersey barrier the unit vector along its line, about which it overturns, shape (3,);
        ``None`` for posts and meshes, which may overturn any way.
    """

    index: int
    name: str
    force: Floats
    moment: Floats
    interval: float
    line: Floats | None = None

    @cached_property
    def resultant_height(self) -> Floats:
        """Of the horizontal force above the foot, shape (n,) [m]; see :func:`resultant_height`.

        It is 0 where the horizontal force is below ``LEAST_SHARE`` of its greatest value after CFC 60. Of the
        unfiltered one a blow of the rigid body within one row may be a hundred times that.
        """
        force = self.force
        if self.interval * _CLASS <= _LONGEST and len(force):
            force = cfc(force, _CLASS, self.interval)
        least = LEAST_SHARE * float(_horizontal(force, self.line).max(initial=0.0))
        return read_only(resultant_height(self.force, self.moment, self.line, least))

    @cached_property
    def overturning_moment(self) -> Floats:
        """Magnitude of the horizontal moment, of a wall of its part about the line, shape (n,) [N m]."""
        return read_only(overturning(self.moment, self.line))

    @cached_property
    def touched(self) -> bool:
        """Whether there was any force."""
        return bool(self.force.any())

    @cached_property
    def peak_force(self) -> float:
        """Greatest magnitude of the force, unfiltered [N]."""
        return float(np.linalg.norm(self.force, axis=1).max())

    @cached_property
    def peak_force_cfc60(self) -> float:
        """Greatest magnitude of the force after CFC 60 (SAE J211-1), each component filtered [N].

        Unfiltered where the output interval is too long for this class.
        """
        fits = self.interval * _CLASS <= _LONGEST
        return peak_of_cfc(self.force, _CLASS, self.interval) if fits else self.peak_force

    @cached_property
    def peak_force_50ms(self) -> float:
        """Greatest magnitude of the mean vector of the whole force over 50 ms [N]."""
        return float(np.linalg.norm(self._mean[0], axis=1).max())

    @property
    def lateral_part(self) -> str:
        """What part of the force loads the element sideways: of a wall that across its line, in words."""
        return "horizontal part" if self.line is None else "part across the line"

    @cached_property
    def peak_lateral_force_50ms(self) -> float:
        """Greatest mean over 50 ms of the horizontal force, of a wall of its part across the line [N].

        Design loads have this force. The whole one, with its parts up and along the line, is greater.
        """
        return float(_horizontal(self._mean[0], self.line).max())

    @cached_property
    def height_at_peak(self) -> float:
        """Height of the resultant of the 50-ms mean where its horizontal force is greatest [m]; 0: none.

        Of a wall the force across its line counts. See :func:`resultant_height`.
        """
        force, moment = self._mean
        row = int(np.argmax(_horizontal(force, self.line)))
        return float(resultant_height(force, moment, self.line)[row])

    @property
    def at_height(self) -> str:
        """Return ``" at 0.57 m"``, the height of the greatest 50-ms mean; nothing where it has none."""
        return f" at {self.height_at_peak:.2f} m" if self.height_at_peak > 0.0 else ""

    @cached_property
    def peak_overturning_moment(self) -> float:
        """Greatest overturning moment, unfiltered [N m]."""
        return float(self.overturning_moment.max())

    @cached_property
    def peak_overturning_moment_50ms(self) -> float:
        """Greatest overturning moment of the mean over 50 ms [N m]."""
        return float(overturning(self._mean[1], self.line).max())

    @cached_property
    def _mean(self) -> tuple[Floats, Floats]:
        """Force and moment as means over 50 ms that end at each row."""
        return (
            moving_average(self.force, _WINDOW, self.interval),
            moving_average(self.moment, _WINDOW, self.interval),
        )

    def __repr__(self) -> str:
        force, moment = self.peak_force_50ms, self.peak_overturning_moment_50ms
        return f"ElementLoad({self.name!r}, {force:.4g} N, {moment:.4g} N m)"


def _horizontal(force: Floats, line: Floats | None) -> Floats:
    """Return the size of the horizontal force, of a wall of its part across the line, shape (n,) [N]."""
    if line is None:
        return np.asarray(np.hypot(force[:, 0], force[:, 1]))
    return np.asarray(np.abs(force @ np.array([line[1], -line[0], 0.0])))


def overturning(moment: Floats, line: Floats | None = None) -> Floats:
    """Return the magnitude of the horizontal moment, of a wall of its part about the line, shape (n,)."""
    if line is None:
        return np.asarray(np.hypot(moment[:, 0], moment[:, 1]))
    return np.abs(moment @ line)


def resultant_height(
    force: Floats, moment: Floats, line: Floats | None = None, least: float | None = None
) -> Floats:
    """Return the height at which the horizontal force alone makes its overturning moment, shape (n,) [m].

    With F_h the horizontal force and z up: height = M . (z x F_h) / |F_h|^2. It is the height of the point of
    application where the force has no vertical part, or meets the vertical through the foot. Else the moment
    of the vertical force is in it, as it is in the overturning moment. It is 0 in rows where the size of F_h
    is below ``LEAST_SHARE`` of its greatest value, and where there is none. It is 0, too, where the vertical
    force is greater than F_h, as of a truck that lies on a barrier: its moment would put the height anywhere.
    The same holds where it puts the height below the foot, as where a wheel stands on a toe.

    Parameters
    ----------
    force, moment
        Shape (n, 3) [N, N m]; z up.
    line
        Of a wall: only the force across its line and the moment about it count, shape (3,).
    least
        Size of F_h below which a row is 0 [N], in place of the share.
    """
    size, vertical = _horizontal(force, line), np.abs(force[:, 2])
    if line is not None:
        across = np.array([line[1], -line[0], 0.0])
        force, moment = np.outer(force @ across, across), np.outer(moment @ line, line)
    x, y = force[:, 0], force[:, 1]
    height = np.zeros(len(force))
    enough = size > (LEAST_SHARE * size.max(initial=0.0) if least is None else least)
    enough &= vertical <= size
    turning = moment[:, 1] * x - moment[:, 0] * y
    height[enough] = turning[enough] / size[enough] ** 2
    return np.maximum(height, 0.0)


def element_loads(result: RunRecord) -> tuple[ElementLoad, ...]:
    """Return the loads on every element of the barrier in their order, zeros where one was not touched."""
    barrier = result.scene.barrier
    if barrier is None:
        return ()
    touched = {one.element: one for one in result._history.elements}
    nothing = read_only(np.zeros((len(result.time), 3)))
    interval = result.scene.settings.output_interval
    line = None
    if barrier.is_straight:
        angle = np.radians(barrier.heading)
        line = read_only(np.array([-np.sin(angle), np.cos(angle), 0.0]))
    return tuple(
        ElementLoad(i, name, touched[i].force, touched[i].moment, interval, line)
        if i in touched
        else ElementLoad(i, name, nothing, nothing, interval, line)
        for i, name in enumerate(barrier.element_names)
    )


def touched_elements(loads: Iterable[ElementLoad]) -> list[ElementLoad]:
    """Return the loads on the elements that were touched."""
    return [load for load in loads if load.touched]
