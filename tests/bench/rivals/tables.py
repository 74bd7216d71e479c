"""Tables and plots of the rivals' benchmark: text, CSV, markdown, and error against time on logarithmic
scales."""

from __future__ import annotations

import csv
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from .definition import TARGETS, Case
from .precision import Entry, Point

OURS = "BIRM3D"
HEAD = (
    "case",
    "nodes",
    "rival",
    "target",
    "setting",
    "steps",
    "error",
    "of",
    "time_ms",
    "best_ms",
    "times_ours",
    "note",
)


@dataclass(frozen=True)
class Row:
    """One rival at one number of nodes and one error; without a time its note says why."""

    case: str
    n: int
    rival: str
    target: float
    point: Point | None
    times_ours: float | None
    note: str = ""

    def cells(self) -> tuple[str, ...]:
        p = self.point
        if p is None:
            return (self.case, str(self.n), self.rival, f"{self.target:g}", *[""] * 7, self.note)
        ratio = "" if self.times_ours is None else f"{self.times_ours:.3g}"
        best = "" if p.extrapolated else f"{1e3 * p.best:.4g}"
        return (
            self.case, str(self.n), self.rival, f"{self.target:g}", f"{p.setting:.3g}", str(p.steps),
            f"{p.error:.1e}", p.worst, f"{1e3 * p.time:.4g}", best, ratio, self.note,
        )  # fmt: skip


def rows_of(
    case: Case, n: int, entries: Sequence[Entry], times: Mapping[tuple[str, float], Point | None]
) -> list[Row]:
    rows = []
    for entry in entries:
        name = entry.rival.name
        if entry.run is None:
            rows.append(Row(case.name, n, name, 0.0, None, None, entry.reason))
            continue
        for target in TARGETS:
            point, ours = times[name, target], times.get((OURS, target))
            if point is None:
                rows.append(Row(case.name, n, name, target, None, None, "not reached"))
                continue
            note = "time from a coarser run by its steps" if point.extrapolated else ""
            if point.error > target:
                note = f"{note}; its error here is above the target".lstrip("; ")
            rows.append(
                Row(case.name, n, name, target, point, point.time / ours.time if ours else None, note)
            )
    return rows


def text(rows: Sequence[Row]) -> str:
    """One line a rival, a time and its ratio to ours for each target."""
    lines = []
    for case, n in dict.fromkeys((row.case, row.n) for row in rows):
        heads = "".join(f"{f'{target:.2%}':>22s}" for target in TARGETS)
        lines.append(f"\n{case}, N = {n:,}: time [ms] (times ours) at an error of\n{'':60s}{heads}")
        for name in dict.fromkeys(row.rival for row in rows if (row.case, row.n) == (case, n)):
            own = [row for row in rows if (row.case, row.n, row.rival) == (case, n, name)]
            if own[0].target == 0.0:
                lines.append(f"{name:60s}  {own[0].note}")
                continue
            lines.append(f"{name:60s}" + "".join(f"{cell(row):>22s}" for row in own))
    return "\n".join(lines)


def cell(row: Row) -> str:
    if row.point is None:
        return row.note
    about = "~" if row.point.extrapolated else ""
    ratio = "" if row.times_ours is None else f" ({row.times_ours:.3g})"
    return f"{about}{1e3 * row.point.time:.4g}{ratio}"


def markdown(rows: Sequence[Row]) -> str:
    lines = []
    for case, n in dict.fromkeys((row.case, row.n) for row in rows):
        targets = " | ".join(f"{target:.2%}" for target in TARGETS)
        lines += [
            f"\n**{case}, N = {n:,}**, ms (times ours)\n",
            f"| rival | {targets} |",
            "|---|---|---|---|",
        ]
        for name in dict.fromkeys(row.rival for row in rows if (row.case, row.n) == (case, n)):
            own = [row for row in rows if (row.case, row.n, row.rival) == (case, n, name)]
            cells = [own[0].note, "", ""] if own[0].target == 0.0 else [cell(row) for row in own]
            lines.append(f"| {name} | {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def write_csv(path: Path, facts: Mapping[str, str], rows: Sequence[Row]) -> None:
    with path.open("w", encoding="utf-8", newline="") as file:
        for key, value in facts.items():
            file.write(f"# {key}: {value}\n")
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(HEAD)
        writer.writerows(row.cells() for row in rows)


def plot(path: Path, case: Case, n: int, points: Mapping[str, Sequence[Point]]) -> None:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8.0, 5.5), layout="constrained")
    axes = figure.add_subplot()
    for name, own in points.items():
        ours = name.startswith(OURS)
        axes.loglog(
            [1e3 * point.time for point in own],
            [max(point.error, 1e-9) for point in own],
            "o-" if ours else ".--",
            linewidth=2.0 if ours else 1.0,
            label=name,
        )
    axes.set_xlabel("time of stepping [ms]")
    axes.set_ylabel("greatest error of crush, peak force, rebound")
    axes.set_title(f"{case.name}, {n:,} nodes, one core")
    axes.grid(which="both", alpha=0.3)
    axes.legend(fontsize="small")
    figure.savefig(path, dpi=110)
