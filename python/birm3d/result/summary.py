"""The numbers of a run that decide, with labels and units of practice."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from .. import units
from .element_loads import touched_elements

if TYPE_CHECKING:
    from .analysis import RunAnalysis

__all__ = ["ELEMENT_COLUMNS", "HEADLINES", "element_rows", "elements_in_si", "headline_rows", "outcome_rows"]

ELEMENT_COLUMNS = (
    "element",
    "peak force, unfiltered [kN]",
    "50-ms mean [kN]",
    "height then [m]",
    "overturning moment, 50-ms mean [kN m]",
)
"""Of :func:`element_rows`."""


class Row(NamedTuple):
    """A metric as tables show it: divided by ``size`` it is in ``unit``; ``form`` is its format."""

    metric: str
    label: str
    unit: str
    size: float
    form: str
    headline: bool = False  # whether a run or a study is judged by it first


_ROWS = (
    Row("dynamic_crush", "dynamic crush (greatest truss shortening)", "m", 1.0, ".3f", True),
    Row("residual_crush", "residual crush", "m", 1.0, ".3f"),
    Row("max_displacement", "travel of the mass centre towards the barrier", "m", 1.0, ".3f", True),
    Row("vehicle_penetration", "rigid body past the barrier's line", "m", 1.0, ".3f", True),
    Row("barrier_deflection", "deflection of the barrier", "m", 1.0, ".3f", True),
    Row("residual_barrier_deflection", "deflection of the barrier that stays", "m", 1.0, ".3f"),
    Row("max_overturning_ratio", "overturning / restoring moment of a segment", "", 1.0, ".2f"),
    Row("time_of_zero_velocity", "time of zero normal velocity", "ms", 1e-3, ".1f"),
    Row(
        "peak_normal_force_cfc60",
        "peak barrier force along the normal, CFC 60",
        "kN",
        1e3,
        ".0f",
        headline=True,
    ),
    Row("peak_force_50ms", "peak 50-ms mean of the force along the normal", "kN", 1e3, ".0f", True),
    Row(
        "peak_element_force_50ms", "peak 50-ms force (vector) on one element", "kN", 1e3, ".0f", headline=True
    ),
    Row("peak_overturning_moment_50ms", "peak 50-ms overturning moment of one element", "kN m", 1e3, ".0f"),
    Row("peak_deceleration_cfc60", "peak deceleration along r, CFC 60", "g", units.g, ".1f", True),
    Row("delta_v", "change of velocity", "m/s", 1.0, ".2f", True),
    Row("time_of_separation", "time of separation", "ms", 1e-3, ".1f"),
    Row("restitution", "restitution along the normal", "", 1.0, ".2f"),
    Row("exit_speed", "exit speed", "m/s", 1.0, ".2f", True),
    Row("exit_angle", "exit angle from the barrier's line", "deg", 1.0, ".1f", True),
    Row("max_roll", "greatest roll", "deg", 1.0, ".1f", True),
    Row("max_pitch", "greatest pitch", "deg", 1.0, ".1f"),
    Row("max_yaw", "greatest yaw", "deg", 1.0, ".1f"),
    Row("later_contacts", "later contacts, which count for nothing above", "", 1.0, ".0f"),
    Row("energy_residual", "energy residual / initial kinetic energy", "", 1.0, ".1e"),
    Row("momentum_residual", "momentum residual / greatest force", "", 1.0, ".1e"),
)

HEADLINES = tuple(row.metric for row in _ROWS if row.headline)
"""Metrics by which a run or a study is judged first."""


def outcome_rows(result: RunAnalysis) -> list[tuple[str, str, str]]:
    """Return label, value and unit: the outcome, then the scalars that a run has."""
    metrics = result.metrics
    return [
        ("outcome", result.outcome, ""),
        ("", result.outcome_detail, ""),
        *(
            (row.label, format(metrics[row.metric] / row.size, row.form), row.unit)
            for row in _ROWS
            if row.metric in metrics
        ),
    ]


def element_rows(result: RunAnalysis) -> list[tuple[str, ...]]:
    """Return the loads on the elements that were touched, one row each; see ``ELEMENT_COLUMNS``."""
    return [
        (
            load.name,
            f"{load.peak_force / 1e3:.0f}",
            f"{load.peak_force_50ms / 1e3:.0f}",
            f"{load.height_at_peak:.2f}",
            f"{load.peak_overturning_moment_50ms / 1e3:.0f}",
        )
        for load in touched_elements(result.element_loads)
    ]


def elements_in_si(result: RunAnalysis) -> list[dict[str, str | float]]:
    """Return the loads on the elements that were touched by name, SI."""
    numbers = (
        *("peak_force", "peak_force_50ms", "height_at_peak"),
        *("peak_overturning_moment", "peak_overturning_moment_50ms"),
    )
    return [
        {"name": load.name, **{number: getattr(load, number) for number in numbers}}
        for load in touched_elements(result.element_loads)
    ]


def headline_rows(result: RunAnalysis) -> list[tuple[str, str, str]]:
    """Return :func:`outcome_rows` without the metrics that are no headlines."""
    others = {row.label for row in _ROWS if not row.headline}
    return [row for row in outcome_rows(result) if row[0] not in others]
