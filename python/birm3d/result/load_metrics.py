"""Rows of the table of metrics: peaks of decelerations, forces and moments."""

from __future__ import annotations

from collections.abc import Mapping

from .. import units
from .metric import Metric, Shown, asked, kilo

__all__ = ["LOAD_METRICS"]

LOAD_METRICS: Mapping[str, Metric] = {
    "peak_deceleration": Metric(
        unit="m/s^2",
        group="motion",
        meaning="greatest deceleration along r, unfiltered",
        needs="motion",
        value=lambda run: run.motion.deceleration,
        of="run",
        shown=asked("peak deceleration along the vehicle, unfiltered", "g", units.g),
    ),
    "peak_deceleration_cfc60": Metric(
        unit="m/s^2",
        group="motion",
        meaning="greatest deceleration along r after CFC 60",
        needs="filtered_deceleration",
        value=lambda run: run.extremes.filtered_deceleration,
        of="run",
        shown=Shown("peak deceleration along the vehicle, CFC 60", ".1f", "g", units.g, headline=True),
    ),
    "peak_normal_force": Metric(
        unit="N",
        group="load",
        meaning="greatest component of the barrier's total force on the vehicle along the barrier's normal, "
        "compression positive, see Result.barrier_normal_force",
        needs="normal_force",
        value=lambda run: run.normal_force.peak,
        shown=asked("peak barrier force along the normal, unfiltered", "kN", 1e3),
    ),
    "peak_normal_force_cfc60": Metric(
        unit="N",
        group="load",
        meaning="greatest component of the barrier's total force on the vehicle along the barrier's normal, "
        "compression positive, after CFC 60",
        needs="filtered_force",
        value=lambda run: run.filtered_force.cfc60,
        shown=kilo("peak barrier force along the normal, CFC 60", "N", headline=True),
    ),
    "peak_force_50ms": Metric(
        unit="N",
        group="load",
        meaning="greatest mean over 50 ms of the barrier's total force on the vehicle along the barrier's "
        "normal, compression positive",
        needs="filtered_force",
        value=lambda run: run.filtered_force.mean_50ms,
        shown=kilo("peak 50-ms mean of the force along the normal", "N", headline=True),
    ),
    "peak_element_force": Metric(
        unit="N",
        group="load",
        meaning="greatest magnitude of the force vector on any element",
        needs="element_loads",
        value=lambda run: run.element_loads.force,
        shown=asked("peak force (vector) on one element, unfiltered", "kN", 1e3),
    ),
    "peak_element_force_50ms": Metric(
        unit="N",
        group="load",
        meaning="greatest magnitude of the mean over 50 ms of the force vector on any element",
        needs="element_loads",
        value=lambda run: run.element_loads.force_50ms,
        shown=kilo("peak 50-ms force (vector) on one element", "N", headline=True),
    ),
    "peak_overturning_moment": Metric(
        unit="N m",
        group="load",
        meaning="greatest overturning moment of any element, see ElementLoad",
        needs="element_loads",
        value=lambda run: run.element_loads.moment,
        shown=asked("peak overturning moment of one element, unfiltered", "kN m", 1e3),
    ),
    "peak_overturning_moment_50ms": Metric(
        unit="N m",
        group="load",
        meaning="greatest mean over 50 ms of the overturning moment of any element, see ElementLoad",
        needs="element_loads",
        value=lambda run: run.element_loads.moment_50ms,
        shown=kilo("peak 50-ms overturning moment of one element", "N m"),
    ),
}
"""In the order of :data:`birm3d.metrics.METRICS`."""
