"""The main numbers of a run, with labels and the units of practice."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..base.plain_words import plain_words
from .element_loads import touched_elements
from .event import outcome_words
from .metric_table import GROUPS, METRICS

if TYPE_CHECKING:
    from .analysis import RunAnalysis

__all__ = [
    "ELEMENT_COLUMNS",
    "HEADLINES",
    "element_rows",
    "elements_in_si",
    "headline_rows",
    "outcome_rows",
    "shown_as",
]

ELEMENT_COLUMNS = (
    "element",
    "whole force, peak, CFC 60 [kN]",
    "whole force, 50-ms mean [kN]",
    "height then [m]",
    "lateral force, 50-ms mean [kN]",
    "overturning moment, 50-ms mean [kN m]",
)
"""Of :func:`element_rows`."""


_ROWS = {
    name: metric.shown
    for group in GROUPS
    for name, metric in METRICS.items()
    if metric.group == group and metric.shown is not None and metric.shown.listed
}

HEADLINES = tuple(name for name, shown in _ROWS.items() if shown.headline)
"""Metrics by which a run or a study is judged first."""


def shown_as(name: str) -> tuple[str, float, str]:
    """Return what tables call a metric, by what its SI value is divided there, and its unit then."""
    shown = METRICS[name].shown if name in METRICS else None
    if shown is not None:
        return shown.label, shown.size, shown.unit
    unit = METRICS[name].unit if name in METRICS else ""
    return plain_words(name), 1.0, unit


def outcome_rows(result: RunAnalysis) -> list[tuple[str, str, str]]:
    """Return label, value and unit: the outcome, then the scalars that a run has."""
    metrics = result.metrics
    return [
        ("outcome", outcome_words(result.outcome), ""),
        ("", result.outcome_detail, ""),
        *(
            (shown.label, format(metrics[name] / shown.size, shown.form), shown.unit)
            for name, shown in _ROWS.items()
            if name in metrics
        ),
    ]


def element_rows(result: RunAnalysis) -> list[tuple[str, ...]]:
    """Return the loads on the elements that were touched, one row each; see ``ELEMENT_COLUMNS``."""
    return [
        (
            load.name,
            f"{load.peak_force_cfc60 / 1e3:.0f}",
            f"{load.peak_force_50ms / 1e3:.0f}",
            f"{load.height_at_peak:.2f}" if load.height_at_peak > 0.0 else "–",
            f"{load.peak_lateral_force_50ms / 1e3:.0f}",
            f"{load.peak_overturning_moment_50ms / 1e3:.0f}",
        )
        for load in touched_elements(result.element_loads)
    ]


def elements_in_si(result: RunAnalysis) -> list[dict[str, str | float]]:
    """Return the loads on the elements that were touched by name, SI."""
    numbers = (
        *("peak_force", "peak_force_50ms", "height_at_peak"),
        *("peak_overturning_moment", "peak_overturning_moment_50ms", "peak_lateral_force_50ms"),
    )
    return [
        {"name": load.name, **{number: getattr(load, number) for number in numbers}}
        for load in touched_elements(result.element_loads)
    ]


def headline_rows(result: RunAnalysis) -> list[tuple[str, str, str]]:
    """Return :func:`outcome_rows` without the metrics that are no headlines."""
    others = {shown.label for shown in _ROWS.values() if not shown.headline}
    return [row for row in outcome_rows(result) if row[0] not in others]
