"""Overview of a run."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from .. import units
from .style import BLUE, GREEN, RED, fit, legend, plot_filtered, prepare, title

if TYPE_CHECKING:
    from ..result import Result

__all__ = ["plot_result"]


def plot_result(result: Result) -> Figure:
    """Return force and deceleration, motion, angles and the energy ledger against time.

    Forces and decelerations are shown as interval means (thin) and after CFC 60 (SAE J211-1).
    """
    figure = Figure(figsize=(11.5, 7.5), layout="constrained")
    panels = figure.subplots(2, 2, sharex=True)
    (force, motion), (angles, energies) = panels
    prepare(*panels.flat)
    ms = result.time * 1e3
    deceleration = -result.acceleration[:, 0] / units.g

    right = force.twinx()
    if result.scene.barrier is not None:
        plot_filtered(force, result, result.barrier_normal_force / 1e3, 60, "along the normal", BLUE)
    plot_filtered(right, result, deceleration, 60, "deceleration along r", RED, "--")
    force.set_ylabel("barrier force [kN]")
    right.set_ylabel("deceleration of the mass centre [g]")
    force.set_title("Force and deceleration")
    for axes in (force, right):
        fit(axes)
    legend([force, right])

    speed = np.linalg.norm(result.velocity, axis=1)
    heading = result.velocity[0] / speed[0] if speed[0] > 0.0 else np.array([1.0, 0.0, 0.0])
    motion.plot(ms, result.velocity @ heading, color=BLUE, ls="-", label="velocity along the path")
    right = motion.twinx()
    way = (result.position - result.position[0]) @ heading
    right.plot(ms, way, color=GREEN, ls="--", label="displacement along the path")
    motion.set_ylabel("velocity [m/s]")
    right.set_ylabel("displacement [m]")
    motion.set_title("Motion of the mass centre")
    legend([motion, right], loc="center right")

    for name in ("roll", "pitch", "yaw"):
        angles.plot(ms, getattr(result, name), label=name)
    angles.set_ylabel("angle [deg]")
    angles.set_title("Angles")
    legend([angles])

    for name, values in result.energy.items():
        if name != "residual" and np.abs(values).max() > 1e-3 * np.abs(result.energy["total"]).max():
            thick = 2.2 if name == "total" else 1.3
            energies.plot(ms, values / 1e3, label=name.replace("_", " "), lw=thick)
    energies.set_ylabel("energy [kJ]")
    energies.set_title("Energy ledger")
    legend([energies], columns=2)

    for axes in panels[-1]:
        axes.set_xlabel("time [ms]")
        axes.set_xlim(0.0, float(ms[-1]))
    figure.suptitle(title(result))
    return figure
