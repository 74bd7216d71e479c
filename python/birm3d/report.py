"""What was computed and what was left out, in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

from . import units
from .element_loads import touched_elements

if TYPE_CHECKING:
    from .barrier import Barrier
    from .result import Result

__all__ = ["END_REASONS", "report"]

END_REASONS = {
    "separated": "the vehicle has left the barrier and can not come back",
    "stopped": "the vehicle stands still at the barrier",
    "duration": "the duration asked for is over",
    "longest": "the longest event without a duration is over; the outcome is not decided",
    "running": "the run is not over yet",
}
"""Why a run ended, in words."""


def report(result: Result) -> str:
    """Return the report of a run as text."""
    scene, settings, statistics = result.scene, result.scene.settings, result.statistics
    vehicle, metrics = scene.vehicle, result.metrics
    lines = [
        f"{vehicle.name}, {vehicle.mass:.1f} kg, {vehicle.n_nodes} shell nodes, {len(vehicle.wheels)} wheels",
        f"{scene.impact_speed:.3f} m/s ({scene.impact_speed / units.mph:.1f} mph) "
        f"at {scene.impact_angle:g} deg "
        + (_barrier(scene.barrier) if scene.barrier else "without a barrier"),
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
    if vehicle.joint is not None:
        lines.append(
            f"  {vehicle.joint.kind}: peak force {metrics['peak_joint_force']:.3g} N, greatest articulation "
            f"angle {metrics['max_articulation_angle']:.1f} deg"
        )
    if "barrier_deflection" in metrics:
        lines.append(
            f"  the barrier moves by {metrics['barrier_deflection']:.3f} m at the most, "
            f"{metrics['residual_barrier_deflection']:.3f} m at the end"
        )
    for load in touched_elements(result):
        lines.append(
            f"  {load.name}: peak 50-ms mean of the force {load.peak_force_50ms / 1e3:.3g} kN at "
            f"{load.height_at_peak:.2f} m, of the overturning moment "
            f"{load.peak_overturning_moment_50ms / 1e3:.3g} kN m"
        )
    lines += [
        "",
        "left out",
        *(f"  {line}" for line in _left_out(result)),
    ]
    return "\n".join(lines)


def _barrier(barrier: Barrier) -> str:
    names = barrier.element_names
    count = f"{len(names)} elements" if len(names) > 1 else names[0]
    segments = barrier.core.segments
    if segments:
        count += f", free-standing, {segments[0].mass:.0f} kg each"
    return f"to the line of a {type(barrier).__name__} ({count}), friction {barrier.friction:g}"


def _left_out(result: Result) -> list[str]:
    scene, settings, statistics = result.scene, result.scene.settings, result.statistics
    vehicle, metrics = scene.vehicle, result.metrics
    lines = []
    if scene.barrier is None:
        lines.append(f"barrier contact of all {vehicle.n_nodes} nodes: there is no barrier")
    else:
        share = 1.0 - statistics.node_evaluations / max(1, statistics.steps * vehicle.n_nodes)
        lines.append(
            f"{max(0.0, share):.1%} of the node tests: blocks of nodes that could not reach the barrier"
        )
        units = [result.unit(u) for u in range(len(vehicle.units))]
        touched = sum(int((unit.peak_deflection > 0.0).sum()) for unit in units)
        lines.append(f"the crush of {vehicle.n_nodes - touched} nodes that never touched the barrier")
        if scene.barrier.core.segments:
            over = metrics.get("max_overturning_ratio", 0.0)
            lines.append(
                "contact of the barrier's segments with each other but through pins, and their tipping: "
                f"greatest overturning over restoring moment {over:.2f}"
            )
        if scene.barrier.friction == 0.0:
            lines.append("barrier friction: its coefficient is 0")
        if not (vehicle.wheel_of_node >= 0).any():
            lines.append("tyres at the barrier: the vehicle has none that meet it")
        elif scene.mu_tire_barrier == 0.0:
            lines.append("tyre friction at the barrier: its coefficient is 0")
    if not settings.ground:
        lines.append("the ground: ground=False")
    elif len(vehicle.wheels) == 0:
        lines.append("the ground: the vehicle has no wheels, nothing holds it up against gravity")
    else:
        airborne = float((result.tire_reaction == 0.0).mean())
        lines.append(f"tyre forces of wheels in the air: {airborne:.1%} of all wheel instants")
        if settings.mu_tire == 0.0:
            lines.append("tyre friction: mu_tire is 0")
    if settings.gravity == 0.0:
        lines.append("gravity: it is 0")
    if result.end_reason == "separated":
        lines.append("everything after the vehicle had left the barrier, but for a short tail")
    if vehicle.joint is not None:
        lines.append("contact of the two units with each other, but through their joint")
    lines.append("suspension, occupants: not part of the model")
    return lines
