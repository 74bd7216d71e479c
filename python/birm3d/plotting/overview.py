"""Overview of a run."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from .. import units
from .energies import plot_energies
from .figure import new_figure
from .style import (
    BLUE,
    DASHED,
    GREEN,
    LEAST_ANGLE,
    RED,
    SOLID,
    at_least,
    cut_peaks,
    fit,
    legend,
    level_zeros,
    plot_filtered,
    prepare,
    title,
)
from .time_axis import limit_time

if TYPE_CHECKING:
    from ..result.result import Result

__all__ = ["plot_result"]


def plot_result(result: Result) -> Figure:
    """Return force and deceleration, motion, angles and the energy balance against time.

    Forces and decelerations are shown as interval means (thin) and after CFC 60 (SAE J211-1). A blow of a few
    milliseconds that would flatten the rest is cut off, and its peak is written beside it.
    """
    figure = new_figure(11.5, 8.2)
    panels = figure.subplots(2, 2, sharex=True)
    (force, motion), (angles, energies) = panels
    prepare(*panels.flat)
    ms = result.time * 1e3
    deceleration = -result.acceleration[:, 0] / units.g

    slowing = force.twinx()
    if result.scene.barrier is not None:
        plot_filtered(
            force, result, result.barrier_normal_force / 1e3, 60, "barrier force along the normal", BLUE
        )
    plot_filtered(slowing, result, deceleration, 60, "deceleration along the vehicle", RED, 1)
    force.set_ylabel("barrier force [kN]")
    slowing.set_ylabel("deceleration [g]")
    force.set_title("Barrier force, and deceleration of the mass centre")
    for axes in (force, slowing):
        fit(axes)
    level_zeros(force, slowing)
    legend([force, slowing])

    speed = np.linalg.norm(result.velocity, axis=1)
    heading = result.velocity[0] / speed[0] if speed[0] > 0.0 else np.array([1.0, 0.0, 0.0])
    motion.plot(ms, result.velocity @ heading, color=BLUE, ls=SOLID, lw=2.2, label="velocity along the path")
    right = motion.twinx()
    displacement = (result.position - result.position[0]) @ heading
    right.plot(ms, displacement, color=GREEN, ls=DASHED, lw=1.6, label="displacement along the path")
    motion.set_ylabel("velocity [m/s]")
    right.set_ylabel("displacement [m]")
    motion.set_title("Motion of the mass centre")
    legend([motion, right])

    for name in ("roll", "pitch", "yaw"):
        angles.plot(ms, getattr(result, name), label=name)
    angles.set_ylabel("angle [deg]")
    angles.set_title("Angles")
    at_least(angles, LEAST_ANGLE)
    legend([angles])

    plot_energies(energies, result)

    limit_time(panels[-1], result)
    cut_peaks(force, slowing)
    figure.suptitle(title(result, figure))
    return figure
