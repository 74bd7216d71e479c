"""Rows of the table of metrics: crush and travel of the vehicle, and how far the barrier moves."""

from __future__ import annotations

import math
from collections.abc import Mapping

from . import metric_functions as made
from .metric import Metric, Shown, asked, kilo, metres

__all__ = ["CRUSH_METRICS"]

CRUSH_METRICS: Mapping[str, Metric] = {
    "dynamic_crush": Metric(
        unit="m",
        group="crush",
        meaning="greatest shortening of a truss of the skin during the run",
        needs="end",
        value=lambda run: run.dynamic_crush,
        shown=metres("dynamic crush (greatest of the skin)", headline=True),
    ),
    "residual_crush": Metric(
        unit="m",
        group="crush",
        meaning="greatest shortening of a truss of the skin once the vehicle has left and its covers have "
        "sprung back, or else at the end of the run",
        needs="end",
        value=lambda run: run.residual_crush,
        shown=metres("residual crush"),
    ),
    "max_displacement": Metric(
        unit="m",
        group="crush",
        meaning="greatest travel of the mass centre towards the barrier since t = 0, less the standoff; on a "
        "path along the barrier's line, towards its end",
        needs="motion",
        value=lambda run: run.motion.travel - run.scene.standoff,
        shown=metres("travel of the mass centre towards the barrier", headline=True),
    ),
    "vehicle_penetration": Metric(
        unit="m",
        group="crush",
        meaning="how far the rigid body got past the barrier's line: the greatest distance of any anchor "
        "behind it over the run, 0 if none passed it, absent on a path along the line. The line is the foot "
        "of the traffic face, or runs through the axes of posts (of the first row). Crushed skin does not "
        "count; a body beside the end of a barrier does. ASTM F2656 measures a stated point of the vehicle "
        "from the protected side",
        needs="penetration",
        value=made.vehicle_penetration,
        shown=metres("rigid body past the barrier's line", headline=True),
    ),
    "contact_overlap": Metric(
        unit="m",
        group="crush",
        meaning="greatest overlap of the rigid body and the barrier, see OverlapWarning",
        needs="end",
        value=made.contact_overlap,
        error="balance",
        shown=asked("overlap of rigid body and barrier", "m"),
    ),
    "core_contact_force": Metric(
        unit="N",
        group="crush",
        meaning="greatest mean over 50 ms of the barrier's force on the rigid core; 0 if the core was not "
        "met, see CoreContactWarning",
        needs="end",
        value=lambda run: run.statistics.core_contact_force,
        shown=kilo("50-ms force on the rigid core", "N"),
    ),
    "barrier_deflection": Metric(
        unit="m",
        group="barrier",
        meaning="how far the furthest corner of any segment's base, or the top of any post that yields, "
        "moved square to the line, away from traffic",
        needs="segments",
        value=lambda run: run.extremes.segments.deflection,
        of="moving",
        shown=metres("deflection of the barrier", headline=True),
    ),
    "residual_barrier_deflection": Metric(
        unit="m",
        group="barrier",
        meaning="how far the furthest corner of any segment's base, or the top of any post that yields, has "
        "moved square to the line, away from traffic, at the end of the run",
        needs="segments",
        value=lambda run: run.extremes.segments.residual_deflection,
        of="moving",
        shown=metres("deflection of the barrier that stays"),
    ),
    "post_tilt": Metric(
        unit="deg",
        group="barrier",
        meaning="greatest tilt of any post that yields, from the vertical",
        needs="segments",
        value=lambda run: math.degrees(run.extremes.segments.tilt),
        of="posts",
        shown=Shown("greatest tilt of a post", ".1f", "deg", headline=True),
    ),
    "residual_post_tilt": Metric(
        unit="deg",
        group="barrier",
        meaning="greatest tilt of any post that yields, from the vertical, at the end of the run",
        needs="segments",
        value=lambda run: math.degrees(run.extremes.segments.residual_tilt),
        of="posts",
        shown=Shown("tilt of a post that stays", ".1f", "deg"),
    ),
    "max_overturning_ratio": Metric(
        unit="",
        group="barrier",
        meaning="greatest of Result.overturning_ratio, of 50-ms means; above 1 a segment would begin to tip, "
        "which is left out; absent without gravity",
        needs="segments",
        value=made.max_overturning_ratio,
        of="segments",
        shown=Shown("overturning / restoring moment of a segment", ".2f", headline=True),
    ),
}
"""In the order of :data:`birm3d.metrics.METRICS`."""
