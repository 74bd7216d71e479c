"""A calibration as text."""

from __future__ import annotations

from collections.abc import Sequence

from ..base.shown_numbers import plain_number, shown_unit
from ..base.text_table import aligned
from .record import CalibrationRecord

__all__ = ["summary"]


def summary(result: CalibrationRecord) -> str:
    """Return targets, values, intervals, verdict and notes; no interval where there is none."""
    lines = [_head(result), ""]
    lines += _targets(result)
    lines += ["", *_parameters(result), ""]
    condition = result.condition_number
    lines.append(
        f"Condition number: {'none: a parameter moves nothing' if condition is None else f'{condition:.3g}'}"
    )
    spread = result.spread
    source = (
        f"scatter of the fit, chi-square / dof = {spread.factor:.3g}"
        if spread.from_scatter
        else "given uncertainties"
    )
    lines.append(f"Intervals: {100 * result.confidence:g} %, {source}, quantile {spread.quantile:.3f}")
    lines.append(_starts(result))
    lines.append(f"Verdict: {result.verdict}")
    lines += [f"Note: {note}" for note in result.notes if note not in result.doubts]
    return "\n".join(lines)


def _head(result: CalibrationRecord) -> str:
    scenes = 1 + max(target.simulation for target in result.targets)
    return (
        f"Calibration of {_count(len(result.parameters), 'parameter')} on {_count(scenes, 'simulation')}, "
        f"{_count(len(result.targets), 'target')}: chi-square {result.chi_square:.4g}, "
        f"{result.spread.dof:.4g} degrees of freedom"
    )


def _targets(result: CalibrationRecord) -> list[str]:
    rows = [("target", "points", "independent", "sigma", "rms left", "unit")]
    for target in result.targets:
        size, unit = shown_unit(target.unit)
        low, high = (plain_number(end / size, 3) for end in (target.sigma.min(), target.sigma.max()))
        sigma = low if low == high else f"{low} .. {high}"
        label = target.label if target.simulation == 0 else f"{target.label} [{target.simulation}]"
        rows.append(
            (
                label,
                str(len(target.x)),
                plain_number(target.independent_points),
                sigma,
                plain_number(target.rms / size, 3),
                unit,
            )
        )
    return _table(rows)


def _parameters(result: CalibrationRecord) -> list[str]:
    rows = [("parameter", "start", "value", f"{100 * result.confidence:g} % interval", "unit", "")]
    for parameter in result.parameters:
        size, unit = shown_unit(parameter.unit)
        start, value = (plain_number(number / size, 5) for number in (parameter.start, parameter.value))
        interval = "none"
        if parameter.interval is not None:
            interval = " .. ".join(plain_number(end / size, 5) for end in parameter.interval)
        remark = (parameter.reason or "").split(":")[0]
        rows.append((parameter.label, start, value, interval, unit, remark))
    return _table(rows)


def _starts(result: CalibrationRecord) -> str:
    best = result.chi_square
    ends = [start["chi_square"] for start in result.starts]
    near = sum(end is not None and end - best <= 1e-2 * max(best, 1.0) for end in ends)
    failed = sum(end is None for end in ends)
    text = f"Starts: {near} of {len(ends)} ended at the least cost"
    if failed:
        text += f", {failed} failed"
    runs = f"{_count(len(result.history), 'run')}, {result.failed_runs} failed"
    return f"{text}; {runs}; tolerance of the steps {result.settings['tolerance']:g}"


def _table(rows: Sequence[tuple[str, ...]]) -> list[str]:
    numbers = [i for i, head in enumerate(rows[0]) if i > 0 and head not in ("unit", "")]
    return aligned(rows, right=numbers)


def _count(n: int, noun: str) -> str:
    return f"{n} {noun}" if n == 1 else f"{n} {noun}s"
