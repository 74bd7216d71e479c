"""Figures of a run. matplotlib is imported here only."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from . import units
from .filters import cfc

if TYPE_CHECKING:
    from .comparison import CurveComparison
    from .result import Result

__all__ = ["plot_comparison", "plot_result"]


def plot_result(result: Result) -> Figure:
    """Return force and deceleration, motion, angles and the energy ledger against time.

    Forces and decelerations are shown as interval means (thin) and after CFC 60 (SAE J211-1, thick).
    """
    figure = Figure(figsize=(11.0, 7.0), layout="constrained")
    (force, motion), (angles, energies) = figure.subplots(2, 2, sharex=True)
    ms = result.time * 1e3
    scene = result.scene
    interval = scene.settings.output_interval
    deceleration = -result.acceleration[:, 0] / units.g

    right = force.twinx()
    if scene.barrier is not None:
        force.plot(ms, result.barrier_normal_force / 1e3, color="C0", lw=0.6, alpha=0.5)
        force.plot(
            ms, cfc(result.barrier_normal_force, 60, interval) / 1e3, color="C0", label="normal force, CFC 60"
        )
    right.plot(ms, deceleration, color="C3", lw=0.6, alpha=0.5)
    right.plot(ms, cfc(deceleration, 60, interval), color="C3", ls="--", label="deceleration along r, CFC 60")
    force.set_ylabel("barrier normal force [kN]")
    right.set_ylabel("deceleration of the mass centre [g]")
    _legend(force, right)

    speed = np.linalg.norm(result.velocity, axis=1)
    heading = result.velocity[0] / speed[0] if speed[0] > 0.0 else np.array([1.0, 0.0, 0.0])
    motion.plot(ms, result.velocity @ heading, color="C0", label="velocity along the path")
    right = motion.twinx()
    right.plot(
        ms,
        (result.position - result.position[0]) @ heading,
        color="C2",
        ls="--",
        label="displacement along the path",
    )
    motion.set_ylabel("velocity [m/s]")
    right.set_ylabel("displacement [m]")
    _legend(motion, right, loc="center right")

    for name, style in (("roll", "-"), ("pitch", "--"), ("yaw", "-.")):
        angles.plot(ms, getattr(result, name), ls=style, label=name)
    angles.set_ylabel("angle [deg]")
    angles.set_xlabel("time [ms]")
    angles.legend(frameon=False)

    for name, values in result.energy.items():
        if name != "residual" and np.abs(values).max() > 1e-3 * np.abs(result.energy["total"]).max():
            energies.plot(ms, values / 1e3, label=name.replace("_", " "), lw=2.2 if name == "total" else 1.3)
    energies.set_ylabel("energy [kJ]")
    energies.set_xlabel("time [ms]")
    energies.legend(frameon=False, ncols=2, fontsize="small")

    for axes in (force, motion, angles, energies):
        axes.grid(alpha=0.3)
    figure.suptitle(
        f"{scene.vehicle.name}, {scene.vehicle.mass:,.0f} kg, {scene.impact_speed:.2f} m/s "
        f"({scene.impact_speed / units.mph:.1f} mph) at {scene.impact_angle:g}°"
    )
    return figure


def plot_comparison(comparison: CurveComparison) -> Figure:
    """Return both curves above, and below the residuals over the measured peak with mean ± deviation."""
    figure = Figure(figsize=(9.0, 6.0), layout="constrained")
    curves, below = figure.subplots(2, 1, sharex=True, height_ratios=(2, 1))
    measured, computed = comparison.measured, comparison.computed
    ms = measured.time * 1e3
    peak = np.abs(measured.values).max()
    curves.plot(ms, measured.values, color="0.2", label=f"measured: {measured.name}")
    curves.plot(ms, computed.values, color="C0", ls="--", label=f"computed: {computed.name}")
    class_ = f", CFC {measured.cfc:g}" if measured.cfc is not None else ""
    curves.set_ylabel(f"{measured.quantity} [{measured.unit}]{class_}")
    curves.legend(frameon=False)

    mean, deviation = comparison.residuals
    below.plot(ms, 100.0 * (measured.values - computed.values) / peak, color="C3", lw=1.0)
    below.axhline(100.0 * mean, color="C3", ls=":")
    below.axhspan(100.0 * (mean - deviation), 100.0 * (mean + deviation), color="C3", alpha=0.15)
    below.axhline(0.0, color="0.5", lw=0.6)
    below.set_ylabel("measured − computed\n[% of measured peak]")
    below.set_xlabel("time [ms]")
    magnitude, phase, _ = comparison.sprague_geers
    rating = comparison.rating
    figure.suptitle(
        f"Sprague-Geers M {magnitude:+.1%}, P {phase:.1%}; residuals {mean:+.1%} ± {deviation:.1%}; "
        f"ISO/TS 18571 {rating.overall:.2f} ({rating.grade})",
        fontsize="medium",
    )
    for axes in (curves, below):
        axes.grid(alpha=0.3)
    return figure


def _legend(left: Axes, right: Axes, loc: Literal["best", "center right"] = "best") -> None:
    """One legend for two axes that share a panel."""
    lines = [*left.get_lines(), *right.get_lines()]
    shown = [line for line in lines if not str(line.get_label()).startswith("_")]
    left.legend(shown, [str(line.get_label()) for line in shown], loc=loc, frameon=False, fontsize="small")
