"""Time histories with their channel frequency class."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .. import units
from ..signals.filters import moving_average
from .figure import new_figure
from .style import (
    BLUE,
    DASHED,
    DOTTED,
    LEAST_ANGLE,
    LEAST_RATE,
    ORANGE,
    RED,
    at_least,
    cut_peaks,
    fit,
    legend,
    plot_filtered,
    prepare,
    title,
)
from .time_axis import limit_time

if TYPE_CHECKING:
    from ..result.result import Result

__all__ = ["plot_histories"]

# SAE J211-1: vehicle structure and barrier forces, and what is integrated to an angle.
_STRUCTURE, _INTEGRATED = 60, 180
_AXES = (("forward", BLUE), ("left", ORANGE), ("up", RED))


def plot_histories(result: Result) -> Figure:
    """Return forces, accelerations, velocities, angular rates, angles and tyre forces against time.

    Forces and accelerations after CFC 60 (vehicle structure, barrier), angular rates after CFC 180
    (integration), SAE J211-1; unfiltered interval means are thin lines behind. Velocities and angles are
    states: they are not filtered. A blow of a few milliseconds that would flatten the rest of its panel is
    cut off, and its peak is written beside it. The figure ends where force and rotation stay small, if that
    is well before the end of the run; its axes then say so.
    """
    figure = new_figure(12.0, 10.5)
    panels = figure.subplots(3, 2, sharex=True)
    (force, acceleration), (velocity, rates), (tires, angles) = panels
    prepare(*panels.flat)
    ms = result.time * 1e3
    interval = result.scene.settings.output_interval

    if result.scene.barrier is not None:
        normal = result.barrier_normal_force / 1e3
        plot_filtered(force, result, normal, _STRUCTURE, "along the normal", BLUE)
        mean = moving_average(normal, 0.05, interval)
        force.plot(ms, mean, color=RED, ls=DASHED, lw=1.8, label="50-ms mean")
    force.set_title("Barrier force on the vehicle, along the barrier's normal")
    force.set_ylabel("force [kN]")
    legend([force])

    for i, (axis, color) in enumerate(_AXES):
        channel = result.acceleration[:, i] / units.g
        plot_filtered(acceleration, result, channel, _STRUCTURE, axis, color, i)
    acceleration.set_title("Acceleration of the mass centre, body axes")
    acceleration.set_ylabel("acceleration [g]")
    legend([acceleration])

    _draw_velocity(velocity, result)
    for i, (name, (_, color)) in enumerate(zip(("roll", "pitch", "yaw"), _AXES, strict=True)):
        channel = result.angular_velocity[:, i]
        plot_filtered(rates, result, channel, _INTEGRATED, f"{name} rate", color, i)
        angles.plot(ms, getattr(result, name), label=name)
    rates.set_title("Angular rates, body axes")
    rates.set_ylabel("angular rate [deg/s]")
    legend([rates])
    angles.set_title("Angles, positive: right side down, nose down, to the left")
    at_least(angles, LEAST_ANGLE)
    angles.set_ylabel("angle [deg]")
    legend([angles])

    _draw_tires(tires, result)
    for axes in (force, acceleration, rates, tires):
        fit(axes)
    at_least(rates, LEAST_RATE)
    if result.tire_reaction.shape[1]:
        tires.set_ylim(bottom=0.0)
    limit_time(panels[-1], result)
    for axes in (force, acceleration, rates, tires):
        cut_peaks(axes)
    figure.suptitle(title(result, figure))
    return figure


def _draw_velocity(velocity: Axes, result: Result) -> None:
    ahead = _heading(result)
    left = np.array([-ahead[1], ahead[0], 0.0])
    for name, direction in (
        ("along the path", ahead),
        ("to its left", left),
        ("up", np.array([0.0, 0.0, 1.0])),
    ):
        velocity.plot(result.time * 1e3, result.velocity @ direction, label=name)
    velocity.set_title("Velocity of the mass centre from the initial path")
    velocity.set_ylabel("velocity [m/s]")
    legend([velocity])


def _draw_tires(tires: Axes, result: Result) -> None:
    if result.tire_reaction.shape[1]:
        total = result.tire_reaction.sum(axis=1) / 1e3
        plot_filtered(tires, result, total, _STRUCTURE, "all wheels", BLUE)
        weight = result.scene.vehicle.mass * result.scene.settings.gravity / 1e3
        tires.axhline(weight, color="0.4", ls=DOTTED, lw=1.4, label="weight")
    tires.set_title("Tyre reaction")
    tires.set_ylabel("force [kN]")
    legend([tires])


def _heading(result: Result) -> npt.NDArray[np.float64]:
    """Return the unit vector of the initial path; that of the vehicle where it stands."""
    velocity = np.array([*result.velocity[0, :2], 0.0])
    speed = float(np.linalg.norm(velocity))
    if speed > 0.0:
        return velocity / speed
    ahead = result.pose(0.0)[1][0] @ [1.0, 0.0, 0.0]
    return np.asarray(ahead / np.linalg.norm(ahead))
