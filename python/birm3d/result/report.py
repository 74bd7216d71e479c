"""What was computed and what was left out, in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .. import units
from ..barrier.text import barrier_text
from ..base.shown_numbers import kilo_number
from ..scene.text import pose_text
from ..vehicle.joint import LONGEST_SLIP
from ..vehicle.title import vehicle_text
from .core_contact import core_lines
from .element_loads import touched_elements
from .event import outcome_words
from .omitted import omitted_lines
from .run_warnings import doubt_lines

if TYPE_CHECKING:
    from ..barrier.barrier import Barrier
    from ..scene.scene import Scene
    from .analysis import RunAnalysis

__all__ = ["END_REASONS", "report"]

END_REASONS = {
    "separated": "the vehicle has left the barrier and can not come back",
    "stopped": "the vehicle stands still at the barrier",
    "sliding": "the vehicle slides along the barrier, where nothing can change any more",
    "duration": "the duration asked for is over",
    "longest": "the longest event without a duration is over",
    "running": "the run is not over yet",
}
"""Why a run ended, in words."""

_NO_BAND = "no band: these are numbers of one vehicle; birm3d.predict(sim) has the bands over its class"
_UNITS_MEET = 90.0  # deg between tractor and trailer: a side of the one stands before the front of the other


def report(result: RunAnalysis) -> str:
    """Return the report of a run as text."""
    scene, settings, statistics = result.scene, result.scene.settings, result.statistics
    vehicle, metrics = scene.vehicle, result.metrics
    lines = [
        f"{outcome_words(result.outcome)}: {result.outcome_detail}",
        f"{vehicle_text(vehicle, 1)}, {vehicle.n_nodes} shell nodes, {len(vehicle.wheels)} wheels",
        *(f"  assumed: {one.text}" for unit in vehicle.units for one in unit.assumptions),
        f"{scene.impact_speed:.3f} m/s ({scene.impact_speed / units.mph:.1f} mph) " + _impact(scene),
        f"ended at {result.time[-1]:.4f} s: {END_REASONS[result.end_reason]}",
        "",
        "computed",
        f"  {statistics.steps} steps of {statistics.shortest_step:.2e} to {statistics.longest_step:.2e} s "
        + (
            f"(fixed at {settings.time_step:g} s)"
            if settings.time_step
            else f"(tolerance {settings.tolerance:g}, {statistics.rejected} redone)"
        ),
    ]
    if statistics.least_critical_step < float("inf"):
        lines.append(
            f"  critical step of the trusses in contact: at least {statistics.least_critical_step:.2e} s"
        )
    lines += [
        f"  contact model: {settings.contact_model}; energy residual {metrics['energy_residual']:.1e} of the "
        f"initial kinetic energy, momentum residual {metrics['momentum_residual']:.1e}",
    ]
    lines += core_lines(result)
    lines += [f"  {line}" for line in doubt_lines(result)]
    if vehicle.joint is not None:
        lines.append(
            f"  {vehicle.joint.kind}: peak 50-ms mean of the force "
            f"{kilo_number(metrics['peak_joint_force_50ms'])} kN, greatest articulation angle "
            f"{metrics['max_articulation_angle']:.1f} deg{_fold_text(metrics['max_articulation_angle'])}"
            + (_slip_text(metrics["bed_slip"]) if vehicle.slides else "")
        )
    if "barrier_deflection" in metrics:
        lines.append(
            f"  the barrier moves by {metrics['barrier_deflection']:.3f} m at the most, "
            f"{metrics['residual_barrier_deflection']:.3f} m at the end"
        )
    for load in touched_elements(result.element_loads):
        lines.append(
            f"  {load.name}: peak 50-ms mean of the whole force {kilo_number(load.peak_force_50ms)} kN"
            f"{load.at_height}, of its {load.lateral_part} "
            f"{kilo_number(load.peak_lateral_force_50ms)} kN, of the overturning moment "
            f"{kilo_number(load.peak_overturning_moment_50ms)} kN m"
        )
    lines += [
        f"  {_NO_BAND}",
        "",
        "left out",
        *(f"  {line}" for line in omitted_lines(result)),
    ]
    return "\n".join(lines)


def _fold_text(angle: float) -> str:
    return ", so that the units would meet, which is not computed" if angle > _UNITS_MEET else ""


def _slip_text(slip: float) -> str:
    beyond = f", beyond {LONGEST_SLIP:g} m the bed would have left the frame" if slip > LONGEST_SLIP else ""
    return f", greatest slip {slip:.3f} m{beyond}"


def _impact(scene: Scene) -> str:
    pose = pose_text(scene)
    if scene.barrier is None:
        return f"without a barrier{pose}"
    return f"at {scene.impact_angle:g}° to the line of the barrier{pose}: {_barrier(scene.barrier)}"


def _barrier(barrier: Barrier) -> str:
    moving = barrier.core.segments or barrier.core.yielding_posts
    each = f", {moving[0].mass:,.0f} kg each" if moving else ""
    return f"{barrier_text(barrier)}{each}, friction {barrier.friction:g}"
