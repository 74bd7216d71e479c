"""A computed curve against a measured one: made comparable, then judged by its errors."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from .. import pictures
from ..base.arguments import checked
from .channel import Channel
from .curve_metrics import Residuals, SpragueGeers, residuals, sprague_geers
from .iso18571 import INTERVAL, ObjectiveRating, objective_rating

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["Criterion", "CurveComparison", "compare_curves"]

# NCHRP Web-Only Document 179 (2010), single channels: magnitude and phase, mean and deviation of residuals.
_SPRAGUE_GEERS_LIMIT = 0.40
_MEAN_LIMIT, _DEVIATION_LIMIT = 0.05, 0.35
# Lowest overall rating that ISO/TS 18571 calls fair.
_FAIR = 0.58
_FEWEST_ROWS = 10
# Instants closer than this are one [s].
_ROUNDING = 1e-9


@dataclass(frozen=True)
class Criterion:
    """One number, its limit and the verdict."""

    name: str
    value: float
    limit: float
    passed: bool
    rule: str
    """Whose limit it is."""


@checked
@dataclass(frozen=True, eq=False)
class CurveComparison:
    """The two curves, made comparable, and how far they are apart.

    Attributes
    ----------
    measured, computed : Channel
        At the same instants, evenly spaced, in the units used here (SI; deg) and of one filter class.
    notes : tuple of str
        What was done to bring them there.
    """

    measured: Channel
    computed: Channel
    notes: tuple[str, ...]

    @property
    def interval(self) -> float:
        """Sampling interval of both [s]."""
        return self.measured.interval

    @cached_property
    def sprague_geers(self) -> SpragueGeers:
        """Magnitude, phase, comprehensive error; see :func:`birm3d.signals.curve_metrics.sprague_geers`."""
        return sprague_geers(self.measured.time, self.measured.values, self.computed.values)

    @cached_property
    def residuals(self) -> Residuals:
        """Mean and deviation over the measured peak; see :func:`birm3d.signals.curve_metrics.residuals`."""
        return residuals(self.measured.values, self.computed.values)

    @cached_property
    def rating(self) -> ObjectiveRating:
        """Scores of ISO/TS 18571 (:mod:`birm3d.signals.iso18571`), of both curves interpolated to 10 kHz."""
        start, end = self.measured.time[[0, -1]]
        rows = math.floor((end - start) / INTERVAL * (1.0 + 1e-12)) + 1
        instants = np.minimum(start + INTERVAL * np.arange(rows), end)
        return objective_rating(
            *(np.interp(instants, c.time, c.values) for c in (self.measured, self.computed))
        )

    @cached_property
    def criteria(self) -> tuple[Criterion, ...]:
        """Every number that has a limit."""
        m, p, _ = self.sprague_geers
        mean, deviation = self.residuals
        rating = self.rating.overall
        w179 = "NCHRP W179"
        return (
            Criterion(
                "Sprague-Geers magnitude", m, _SPRAGUE_GEERS_LIMIT, abs(m) <= _SPRAGUE_GEERS_LIMIT, w179
            ),
            Criterion("Sprague-Geers phase", p, _SPRAGUE_GEERS_LIMIT, p <= _SPRAGUE_GEERS_LIMIT, w179),
            Criterion("mean residual", mean, _MEAN_LIMIT, abs(mean) <= _MEAN_LIMIT, w179),
            Criterion(
                "deviation of residuals", deviation, _DEVIATION_LIMIT, deviation <= _DEVIATION_LIMIT, w179
            ),
            Criterion("overall rating", rating, _FAIR, rating > _FAIR, "ISO/TS 18571, fair"),
        )

    @property
    def passed(self) -> bool:
        """Whether every criterion is met."""
        return all(criterion.passed for criterion in self.criteria)

    def summary(self) -> str:
        """Return the numbers with their limits and verdicts, and what was done to the curves, as text."""
        start, end = self.measured.time[[0, -1]]
        class_ = f"CFC {self.measured.cfc:g}" if self.measured.cfc is not None else "unfiltered"
        lines = [
            f"{self.computed.name} against {self.measured.name} [{self.measured.unit}]",
            f"{start:g} to {end:g} s, every {self.interval:g} s, {class_}",
            *(f"  {note}" for note in self.notes),
            "",
            f"{'':26}{'value':>9}{'limit':>9}  verdict",
        ]
        for c in self.criteria:
            sign, verdict = (">", "fair or better") if "rating" in c.name else ("<=", "met")
            numbers = f"{100.0 * c.value:8.1f}%{sign + f' {100.0 * c.limit:.0f}%':>9}"
            lines.append(f"{c.name:26}{numbers}  {verdict if c.passed else 'NOT met'} ({c.rule})")
        r = self.rating
        lines += [
            f"{'Sprague-Geers C':26}{100.0 * self.sprague_geers.comprehensive:8.1f}%",
            f"scores: corridor {r.corridor:.3f}, phase {r.phase:.3f} (computed curve {1e3 * r.shift:+.1f} "
            f"ms), magnitude {r.magnitude:.3f}, slope {r.slope:.3f}; overall {r.overall:.3f}, {r.grade}",
            f"peaks: measured {_peak(self.measured)}, computed {_peak(self.computed)}",
        ]
        return "\n".join(lines)

    def plot(self) -> Figure:
        """Return a figure of both curves and of the residuals with their band."""
        return pictures.plot_comparison(self)

    def __repr__(self) -> str:
        m, p, _ = self.sprague_geers
        verdict = "met" if self.passed else "not met"
        return f"CurveComparison(M {m:+.1%}, P {p:.1%}, rating {self.rating.overall:.3f}, criteria {verdict})"


@checked
def compare_curves(
    measured: Channel,
    computed: Channel,
    *,
    cfc: float | None = None,
    start: float | None = None,
    end: float | None = None,
    interval: float | None = None,
) -> CurveComparison:
    """Compare a computed curve with a measured one.

    Both are converted to the units used here, filtered to one class over their whole records, and
    interpolated to common instants.

    Parameters
    ----------
    measured, computed
        Of one quantity. Time zeros must agree: see :meth:`Channel.shifted`.
    cfc
        Channel frequency class to filter both to; None: they must be of one class already.
    start, end
        Span to compare [s]; None: what both records have.
    interval
        Between the common instants [s]; None: the shorter one of the two records.

    Returns
    -------
    CurveComparison

    Raises
    ------
    ValueError
        If the quantities or classes differ, the records do not overlap or do not reach `start` or `end`,
        fewer than ten rows are left, or a curve is zero throughout.
    """
    notes = []
    if measured.quantity != computed.quantity:
        raise ValueError(
            f"computed must measure {measured.quantity} as {measured.name!r} does, got "
            f"{computed.quantity} [{computed.unit}]"
        )
    curves = []
    for role, channel in (("measured", measured), ("computed", computed)):
        curve = channel.to_si()
        if curve.unit != channel.unit:
            notes.append(f"{role}: converted from {channel.unit}")
        if cfc is not None and channel.cfc != cfc:
            curve = curve.filtered(cfc)
            notes.append(f"{role}: filtered to CFC {cfc:g}, from {_class(channel)}")
        curves.append(curve)
    m, c = curves
    if m.cfc != c.cfc:
        raise ValueError(
            f"cfc must be given where the classes differ, got {_class(m)} of measured {m.name!r} and "
            f"{_class(c)} of computed {c.name!r}"
        )
    start, end = _span(m, c, start, end)
    step = min(float(np.diff(y.time).min()) for y in (m, c)) if interval is None else interval
    if not (math.isfinite(step) and 0.0 < step <= (end - start) / (_FEWEST_ROWS - 1)):
        raise ValueError(
            f"interval must be > 0 and leave {_FEWEST_ROWS} rows between {start:g} and {end:g} s, "
            f"got {step:g} s"
        )
    instants = np.linspace(start, end, round((end - start) / step) + 1)
    for role, curve in (("measured", m), ("computed", c)):
        if len(curve) != len(instants) or np.abs(curve.time - instants).max() > _ROUNDING:
            notes.append(f"{role}: interpolated, from {np.median(np.diff(curve.time)):g} s apart")
    m, c = m.resampled(instants), c.resampled(instants)
    for role, curve in (("measured", m), ("computed", c)):
        if not np.abs(curve.values).max() > 0.0:
            raise ValueError(f"{role} must not be zero throughout, got 0 from {start:g} to {end:g} s")
    return CurveComparison(m, c, tuple(notes))


def _span(m: Channel, c: Channel, start: float | None, end: float | None) -> tuple[float, float]:
    """Return the span to compare [s], within both records."""
    first, last = max(m.time[0], c.time[0]), min(m.time[-1], c.time[-1])
    if not first < last:
        raise ValueError(
            f"measured and computed must overlap in time, got {m.time[0]:g} to {m.time[-1]:g} s and "
            f"{c.time[0]:g} to {c.time[-1]:g} s"
        )
    start, end = float(first if start is None else start), float(last if end is None else end)
    # An end that is meant to be the record's may miss it by a rounding.
    start, end = (
        first if abs(start - first) < _ROUNDING else start,
        last if abs(end - last) < _ROUNDING else end,
    )
    if not first <= start < end <= last:
        raise ValueError(
            f"start and end must lie in both records, {first:g} to {last:g} s, got {start:g} to {end:g} s"
        )
    return start, end


def _class(channel: Channel) -> str:
    return "no class" if channel.cfc is None else f"CFC {channel.cfc:g}"


def _peak(channel: Channel) -> str:
    row = int(np.abs(channel.values).argmax())
    return f"{channel.values[row]:.5g} {channel.unit} at {1e3 * channel.time[row]:.1f} ms"
