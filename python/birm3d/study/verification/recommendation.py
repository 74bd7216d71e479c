"""The cheapest setting for a wanted error, and what a study of errors says in words."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

from ...scene.settings import Settings
from .convergence import Limit
from .precision_table import AS_GIVEN, PrecisionRow, PrecisionTable

__all__ = ["Recommendation", "recommend", "report"]


@dataclass(frozen=True)
class Recommendation:
    """The cheapest setting that has a wanted error.

    Attributes
    ----------
    settings
        To be given to :class:`birm3d.Simulation`.
    row
        That of the study.
    wanted
        Relative error asked for.
    error, uncertainty
        Greatest found of the metrics asked for, and greatest uncertainty of their converged values; relative.
    text
        All this in words.
    """

    settings: Settings
    row: PrecisionRow
    wanted: float
    error: float
    uncertainty: float
    text: str

    def __str__(self) -> str:
        return self.text


def _bound(study: PrecisionTable, row: PrecisionRow, metrics: Collection[str]) -> float:
    """Greatest error of a row that is possible: found, and what is not known of the converged value."""
    if not row.errors:
        return float("inf")
    return max(row.errors.get(name, float("inf")) + study.uncertainty[name] for name in metrics)


def _held(study: PrecisionTable, rows: Sequence[PrecisionRow], metrics: Collection[str]) -> list[float]:
    """Greatest possible error of each row and all stricter ones; rows from loose to strict."""
    bounds = [_bound(study, row, metrics) for row in rows]
    return [max(bounds[i:]) for i in range(len(rows))]


def recommend(study: PrecisionTable, error: float, metrics: Collection[str] | None) -> Recommendation:
    """Return the cheapest setting; see :meth:`birm3d.study.WorkPrecision.recommend`."""
    if not 0.0 < error < float("inf"):
        raise ValueError(f"error must be finite and > 0, got {error}")
    asked = tuple(study.converged) if metrics is None else tuple(metrics)
    for name in asked:
        if name not in study.converged:
            raise ValueError(f"metrics must be among {', '.join(study.converged)}; got {name!r}")
    if not asked:
        raise ValueError("metrics must name at least one, got none")
    unknown = max(asked, key=lambda name: study.uncertainty[name])
    uncertainty = study.uncertainty[unknown]
    found: list[PrecisionRow] = []
    least = float("inf")
    for kind in ("tolerance", "time_step"):
        rows = study.of(AS_GIVEN, kind)
        bounds = _held(study, rows, asked)
        found += [row for row, bound in zip(rows, bounds, strict=True) if bound <= error]
        least = min([least, *bounds])
    if not found:
        raise ValueError(
            f"error must be at least {least:.2g}, the best that was run (the converged value "
            f"of {unknown} is known to {uncertainty:.1g}); got {error:g}"
        )
    best = min(found, key=lambda row: row.run_time)
    worst = max(asked, key=best.errors.__getitem__)
    lines = [
        f"for an error of {_percent(error)} in {_which(metrics)}: {best.setting}",
        f"  {_percent(best.errors[worst])} found ({worst}), {_cost(best)}",
    ]
    default = study.default
    if default.errors and default is not best:
        share = default.run_time / best.run_time
        lines.append(
            f"  the scene's own settings ({default.setting}) have {_percent(default.error_of(asked))} and "
            f"take {share:.2g} times as long"
        )
    other = [row for row in found if row.kind != best.kind]
    if other:
        rival = min(other, key=lambda row: row.run_time)
        lines.append(f"  {rival.setting} has it too, in {rival.run_time / best.run_time:.2g} times the time")
    lines.append(f"  the converged values themselves are known to {_percent(uncertainty)} ({unknown})")
    return Recommendation(best.settings, best, error, best.errors[worst], uncertainty, "\n".join(lines))


def report(study: PrecisionTable, error: float) -> str:
    """Return a study in words; see :meth:`birm3d.study.WorkPrecision.report`."""
    lines = [study.title, ""]
    for kind in ("tolerance", "time_step"):
        for row in study.of(AS_GIVEN, kind):
            lines.append(f"  {row.setting:20s} {_outcome(row)}")
    lines.append("")
    try:
        lines += recommend(study, error, None).text.splitlines()
    except ValueError as refused:
        lines.append(f"no setting for an error of {_percent(error)}: {refused}")
    for variant in study.of_variant:
        if variant in (AS_GIVEN, "mesh"):
            continue
        departures = study.departures(variant)
        most = max(departures, key=lambda name: abs(departures[name]))
        default = max(study.of(variant, "tolerance"), key=lambda row: -abs(row.value - study.default.value))
        lines += [
            "",
            f"{variant}: another model of the same crash; its own converged values depart by up to "
            f"{_percent(departures[most], sign=True)} ({most}), which no step changes",
            f"  {default.setting}: {_outcome(default)}",
        ]
    meshes = [row for row in study.rows if row.variant == "mesh"]
    if meshes:
        lines += ["", "mesh, at the scene's own settings, against what finer and finer meshes tend to"]
        lines += [f"  density {row.value:<11.3g} {_outcome(row)}" for row in meshes]
        limits: Mapping[str, Limit] = study.of_variant.get("mesh", {})
        if limits:
            scale = {name: max(abs(limit.value), study.scales[name]) for name, limit in limits.items()}
            least = max(limits, key=lambda name: limits[name].uncertainty / scale[name])
            known = limits[least].uncertainty / scale[least]
            lines.append(f"  what they tend to is known to {_percent(known)} ({least})")
    without = [row for row in study.rows if row.refused and row.variant not in study.of_variant]
    for text in dict.fromkeys(f"{row.variant}: refused: {row.refused}" for row in without):
        lines += ["", text]
    return "\n".join(lines)


def _outcome(row: PrecisionRow) -> str:
    if row.refused:
        return f"refused: {row.refused}"
    if not row.errors:
        return f"no converged answer to compare with, {_cost(row)}"
    energy = f"energy residual {row.energy_residual:.1e}"
    return f"{_percent(row.error):>9s} ({row.worst}), {_cost(row)}, {energy}"


def _cost(row: PrecisionRow) -> str:
    return f"{1e3 * row.run_time:.3g} ms, {row.steps} steps, {row.force_evaluations} force evaluations"


def _which(metrics: Collection[str] | None) -> str:
    return "every metric" if metrics is None else ", ".join(metrics)


def _percent(error: float, sign: bool = False) -> str:
    return f"{100.0 * error:{'+' if sign else ''}.2g} %"
