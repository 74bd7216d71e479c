"""How accurate, how fast: the errors of every metric of the paper's cases, and what they cost.

    python tests/bench/bench_accuracy.py [--cases NAME ...] [--repeats 3] [--save]
    python tests/bench/bench_accuracy.py --quick

birm3d.study.work_precision for each case: tolerances 1 to 1e-5, fixed steps, the other contact model, the
triangulated barrier, and meshes of a quarter to four times the elements, against the case's own converged
answer.
States whether these hold, and by how much each metric misses what does not:

- at the default tolerance every metric is within 1 % of converged;
- at a tolerance a hundred times smaller within 0.01 %;
- the energy residual falls below 1e-6 when refined.

--save writes the page results/accuracy/README.md with its tables and figures. Times are those of stepping,
medians, one core.
"""

from __future__ import annotations

import argparse
import csv
import os
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from bench_birm3d import machine, use_one_core
from birm3d import Simulation, scenes
from birm3d.base.progress import progress_bar
from birm3d.metrics import METRIC_UNITS
from birm3d.study import PrecisionRow, WorkPrecision, work_precision
from matplotlib.figure import Figure

RESULTS = Path(__file__).parent / "results/accuracy"
CASES: Mapping[str, tuple[str, Callable[[], Simulation]]] = {
    "rolling": ("case 1: pickup that rolls at 30 mph", scenes.rolling),
    **{
        f"head_on_{mph}_mph": (
            f"case 2: paper's pickup head-on at {mph} mph",
            lambda mph=mph: scenes.paper_table_2(mph),
        )
        for mph in scenes.TABLE_2
    },
    "oblique": ("case 3: car at 59.8 mph and 24 deg", scenes.oblique_car),
    "truck_wall": ("case 4: truck at 50 mph into a wall", scenes.truck_at_wall),
    "truck_bollards": ("case 4: truck at 50 mph into bollards", scenes.truck_at_bollards),
    "sedan": ("NHTSA 10146: sedan at 57 km/h", scenes.nhtsa_10146),
    "w2": ("W2: block of 1,000 nodes at 50 mph, exact answer known", scenes.w2),
}
QUICK = ("head_on_60_mph", "w2")
# The claims.
DEFAULT_ERROR = 1e-2
STRICT, STRICT_ERROR = 1e-5, 1e-4
ENERGY = 1e-6
WANTED = (1e-2, 1e-3, 1e-4)


@dataclass(frozen=True)
class Claim:
    """One claim about one case; `missed`: metric -> error, of those that miss it."""

    case: str
    claim: str
    missed: Mapping[str, float]
    best: str


def study(name: str, quick: bool, repeats: int) -> WorkPrecision:
    simulation = CASES[name][1]()
    if quick:
        return work_precision(
            simulation,
            tolerances=(1e-2, 1e-3, 1e-4, 1e-5),
            time_steps=(1e-3, 2.5e-4),
            references=(1e-6, 1e-7),
            contact_models=False,
            representations=False,
            mesh_densities=(),
            repeats=repeats,
            progress=False,
        )
    return work_precision(simulation, repeats=repeats, progress=False)


def row_at(found: WorkPrecision, tolerance: float) -> PrecisionRow:
    return next(row for row in found.of(kind="tolerance") if row.value == tolerance)


def claims_of(name: str, found: WorkPrecision) -> list[Claim]:
    claims = []
    for text, row, limit in (
        ("default tolerance within 1 %", found.default, DEFAULT_ERROR),
        ("tolerance 1e-5 within 0.01 %", row_at(found, STRICT), STRICT_ERROR),
    ):
        missed = {metric: error for metric, error in row.errors.items() if error > limit}
        claims.append(Claim(name, text, missed, f"{row.error:.1e} ({row.worst})"))
    energy = min(row.energy_residual for row in found.of() if row.kind in ("tolerance", "reference"))
    missed = {} if energy < ENERGY else {"energy_residual": energy}
    claims.append(Claim(name, "energy residual below 1e-6 when refined", missed, f"{energy:.1e}"))
    return claims


def print_case(name: str, found: WorkPrecision, claims: Sequence[Claim]) -> None:
    print(f"\n{name}: {CASES[name][0]}")
    print(found.report())
    for claim in claims:
        print(f"{'MISSED' if claim.missed else 'holds '} {claim.claim}: {claim.best}")
        for metric, error in sorted(claim.missed.items(), key=lambda item: -item[1]):
            known = found.uncertainty.get(metric, 0.0)
            print(f"         {metric:32s} {error:.2e}  (converged value known to {known:.0e})")


def recommended(found: WorkPrecision, error: float) -> str:
    try:
        best = found.recommend(error).row
    except ValueError:
        return "none"
    return f"{best.setting}, {1e3 * best.run_time:.2g} ms"


def page(studies: Mapping[str, WorkPrecision], claims: Sequence[Claim], facts: Mapping[str, str]) -> str:
    cpu = f"{facts['cpu']}, core {facts['core']}, load average at the end {facts['load']}"
    lines = [
        "# How accurate, how fast",
        "",
        "Written by `python tests/bench/bench_accuracy.py --save`; do not edit. Errors are relative, against",
        "the case's own converged answer; what they are divided by where a metric is near zero is in",
        "`birm3d.study.errors`. Times are those of stepping, medians, one core.",
        "",
        f"Machine: {cpu}; BIRM3D {facts['birm3d']}, Python {facts['python']}.",
        "",
        "| case | nodes | default tolerance: error | time | 1e-5: error | converged known to |",
        "|---|---|---|---|---|---|",
    ]
    for name, found in studies.items():
        row, strict = found.default, row_at(found, STRICT)
        known = max(found.uncertainty, key=lambda metric: found.uncertainty[metric])
        nodes = found.title.split("(")[1].split(" ")[0]
        lines.append(
            f"| {CASES[name][0]} | {nodes} | {row.error:.1e} ({row.worst}) | {1e3 * row.run_time:.2g} ms "
            f"| {strict.error:.1e} ({strict.worst}) | {found.uncertainty[known]:.0e} ({known}) |"
        )
    lines += ["", "The cheapest setting for an error of every metric:", ""]
    lines += [f"| case |{'|'.join(f' {100 * e:g} % ' for e in WANTED)}|", "|---" * (1 + len(WANTED)) + "|"]
    for name, found in studies.items():
        lines.append(f"| {name} | {' | '.join(recommended(found, error) for error in WANTED)} |")
    lines += ["", "![work and precision](work_precision.png)", "", "![requested](requested.png)", ""]
    lines += ["## What is claimed", ""]
    for claim in dict.fromkeys(c.claim for c in claims):
        of = [c for c in claims if c.claim == claim]
        held = sum(not c.missed for c in of)
        lines.append(f"- {claim}: holds in {held} of {len(of)} cases.")
        for c in of:
            if c.missed:
                worst = sorted(c.missed.items(), key=lambda item: -item[1])
                told = ", ".join(f"{metric} {error:.1e}" for metric, error in worst)
                lines.append(f"  - {c.case}: {told}")
    for name, found in studies.items():
        lines += ["", f"## {CASES[name][0]}", "", "```", found.report(), "```", "", f"![{name}]({name}.png)"]
    return "\n".join(lines) + "\n"


def overview(studies: Mapping[str, WorkPrecision]) -> dict[str, Figure]:
    figures = {}
    for file in ("work_precision", "requested"):
        figure = Figure(figsize=(8.5, 5.0), layout="constrained")
        axes = figure.subplots()
        for i, (name, found) in enumerate(studies.items()):
            rows = [row for row in found.of(kind="tolerance") if row.errors]
            x = [1e3 * row.run_time if file == "work_precision" else row.value for row in rows]
            form = "o-" if i < 10 else "s--"  # there are ten colours
            axes.plot(x, [max(row.error, 1e-9) for row in rows], form, ms=3, color=f"C{i}", label=name)
        if file == "requested":
            axes.plot([1e-5, 1.0], [1e-5, 1.0], "k--", lw=1.0, label="achieved = requested")
            axes.plot([1e-5, 1.0], [1e-4, 10.0], "k:", lw=1.0, label="ten times that")
        axes.set(xscale="log", yscale="log", ylabel="greatest relative error of any metric")
        axes.set_xlabel("run time [ms]" if file == "work_precision" else "requested: tolerance")
        axes.grid(alpha=0.3)
        axes.legend(frameon=False, fontsize="small", loc="center left", bbox_to_anchor=(1.0, 0.5))
        figures[file] = figure
    return figures


def write(folder: Path, studies: Mapping[str, WorkPrecision], claims: Sequence[Claim], text: str) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "README.md").write_text(text, encoding="utf-8")
    for name, figure in overview(studies).items():
        figure.savefig(folder / f"{name}.png", dpi=80)
    for name, found in studies.items():
        found.save(folder / f"{name}.csv")
        found.plot().savefig(folder / f"{name}.png", dpi=70)
    with (folder / "converged.csv").open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        head = "case metric unit converged uncertainty order scale default default_error strict_error"
        writer.writerow(head.split())
        for name, found in studies.items():
            strict = row_at(found, STRICT)
            for metric, limit in found.converged.items():
                order = "" if limit.order is None else f"{limit.order:.2f}"
                known = [
                    f"{limit.value:.9g}",
                    f"{limit.uncertainty:.2g}",
                    order,
                    f"{found.scales[metric]:.6g}",
                ]
                errors = [f"{row.errors[metric]:.2e}" for row in (found.default, strict)]
                default = f"{found.default.values[metric]:.9g}"
                writer.writerow([name, metric, METRIC_UNITS[metric], *known, default, *errors])
    with (folder / "claims.csv").open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["case", "claim", "holds", "worst"])
        writer.writerows([c.case, c.claim, "no" if c.missed else "yes", c.best] for c in claims)


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--cases", nargs="+", choices=list(CASES), default=list(CASES))
    parser.add_argument("--repeats", type=int, default=3, help="runs of each setting (default: %(default)s)")
    parser.add_argument("--quick", action="store_true", help=f"{' and '.join(QUICK)}, few settings")
    parser.add_argument("--save", action="store_true", help="also write tests/bench/results/accuracy")
    parser.add_argument("--folder", type=Path, help="also write the page there")
    options = parser.parse_args(arguments)
    if options.repeats < 1:
        parser.error(f"--repeats must be >= 1, got {options.repeats}")
    facts = machine(use_one_core())
    studies, claims = {}, []
    chosen = [name for name in options.cases if not options.quick or name in QUICK]
    if not chosen:
        parser.error(f"--quick has only {', '.join(QUICK)}; got {', '.join(options.cases)}")
    with progress_bar(None, "accuracy", len(chosen)) as advance:
        for name in chosen:
            studies[name] = study(name, options.quick, options.repeats)
            made = claims_of(name, studies[name])
            print_case(name, studies[name], made)
            claims += made
            advance(1)
    facts["load"] = f"{os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else "not known"
    text = page(studies, claims, facts)
    for folder in [options.folder] * bool(options.folder) + [RESULTS] * options.save:
        write(folder, studies, claims, text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
