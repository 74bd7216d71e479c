"""Rivals side by side: W1 to W6, at equal error, one pinned core, in turn.

    pip install -r tests/bench/rivals/requirements.txt
    python tests/bench/bench_rivals.py --save           # the whole
    python tests/bench/bench_rivals.py --quick          # 100 nodes, for a look

W1 to W3: each rival's setting is chosen by a sweep so that it and all finer ones are within 1 %, 0.1 %
and 0.01 % of the answer; then all run in turn (A B A B ...) and the median counts. Time is that of
stepping. W4: 1,000 W2 runs with their own speed, mass and stiffness, two workers, building included. W5:
calibration (ours alone). W6: import, first result and memory, each in a process of its own. Rivals, their
set-up and what they do that we do not are in tests/bench/rivals. One that is not installed, or whose
physics is not that of a case, is listed so.
"""

from __future__ import annotations

import argparse
import importlib
import sys
from collections.abc import Sequence
from pathlib import Path

from bench_birm3d import machine, use_one_core
from rivals import batch, latency, oblique, precision, tables
from rivals.definition import CASES, NODES, Case, Rival

MODULES = (
    "ours", "numpy_rows", "mujoco_callback", "mujoco_contact", "bullet", "exudyn_rows", "opensees",
)  # fmt: skip
RESULTS = Path(__file__).parent / "results/rivals"
PLOTTED = 1000
CLOSEST = "MuJoCo, our law in a callback"
CONTACT = ("MuJoCo, soft", "Bullet")


def rivals(only: Sequence[str] | None) -> list[Rival]:
    chosen = [name for name in MODULES if only is None or name in only]
    return [rival for name in chosen for rival in importlib.import_module(f"rivals.{name}").RIVALS]


def answered(case: Case, n: int) -> Case:
    return case if case.exact else oblique.with_answer(case, n)


def confirm() -> float:
    """Greatest difference of the answer of W3 from that of an independent integrator."""
    case = answered(CASES["W3"], 100)
    found = oblique.independent(CASES["W3"], 100)
    return max(abs(found[name] / value - 1.0) for name, value in case.exact.items())


def marks(rows: Sequence[tables.Row]) -> list[tuple[str, bool]]:
    """Time of W2 at 0.1 %, and ratios to the closest rival and to contact solvers at equal error."""
    checks = []
    own = {(r.case, r.n, r.target): r for r in rows if r.rival == tables.OURS and r.point}
    for n, limit in ((1000, 1e-4), (10000, 1e-3)):
        row = own.get(("W2", n, 1e-3))
        if row is not None and row.point is not None:
            text = f"W2 at 0.1 %, N = {n:,}, in at most {1e3 * limit:g} ms: {1e3 * row.point.time:.3f} ms"
            checks.append((text, row.point.time <= limit))
    for rivals, called, wanted in ((CLOSEST, CLOSEST, 4), (CONTACT, "every contact solver", 100)):
        timed = [(r.times_ours, r) for r in rows if r.rival.startswith(rivals) and r.times_ours is not None]
        if timed:
            times, least = min(timed, key=lambda pair: pair[0])
            at = f"{least.rival}, {least.case}, N = {least.n:,}, {least.target:.2%}"
            checks.append(
                (f"at least {wanted} times faster than {called}: {times:.2f} times ({at})", times >= wanted)
            )
    return checks


def crashes(
    chosen: Sequence[Rival], cases: Sequence[str], nodes: Sequence[int], repeats: int, folder: Path | None
) -> list[tables.Row]:
    rows: list[tables.Row] = []
    for name in cases:
        sweep_at = PLOTTED if PLOTTED in nodes else nodes[0]
        case = answered(CASES[name], sweep_at)
        entries = precision.enter(chosen, case, sweep_at)
        points = precision.sweep(case, entries, 3)
        if folder is not None:
            tables.plot(folder / f"work_precision_{name.lower()}.png", case, sweep_at, points)
        struck = {e.rival.name: e for e in precision.judge(entries, points) if e.run is None}
        for n in nodes:
            case = answered(CASES[name], n)
            here = precision.enter([r for r in chosen if r.name not in struck], case, n)
            times = precision.at_equal_error(case, here, points, repeats)
            own = tables.rows_of(case, n, [*here, *struck.values()], times)
            print(tables.text(own), flush=True)
            for entry in here:
                if entry.build_time > 0.5:
                    print(f"  ({entry.rival.name}: built in {entry.build_time:.1f} s)")
            rows += own
    return rows


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--cases", nargs="+", choices=["W1", "W2", "W3", "W4", "W5", "W6"])
    parser.add_argument("--nodes", nargs="+", type=int, default=list(NODES))
    parser.add_argument("--only", nargs="+", choices=MODULES, help="rivals' modules")
    parser.add_argument("--repeats", type=int, default=7, help="timed runs of each line, at least one")
    parser.add_argument("--quick", action="store_true", help="100 nodes, one timed run, W1 to W3")
    parser.add_argument("--save", action="store_true", help="also write tests/bench/results/rivals")
    parser.add_argument("--folder", type=Path, default=RESULTS, help="where --save writes")
    parser.add_argument("--child", nargs=2, metavar=("MODULE", "NODES"), help=argparse.SUPPRESS)
    options = parser.parse_args(arguments)
    if options.repeats < 1:
        parser.error(f"--repeats must be >= 1, got {options.repeats}")
    if options.child:
        print(latency.measure(options.child[0], int(options.child[1])))
        return 0
    cases = options.cases or (["W1", "W2", "W3"] if options.quick else ["W1", "W2", "W3", "W4", "W5", "W6"])
    nodes, repeats = ([100], 1) if options.quick else (options.nodes, options.repeats)
    folder = options.folder if options.save else None
    if folder is not None:
        folder.mkdir(parents=True, exist_ok=True)

    chosen = rivals(options.only)
    texts = []
    if not {"W4", "W5", "W6"}.isdisjoint(cases):
        # Before this process is pinned: what it starts would be pinned with it.
        if "W6" in cases:
            texts.append(latency.table(options.only or MODULES, 10000))
        if "W4" in cases:
            texts.append(batch.table(options.only or MODULES, 3))
        if "W5" in cases:
            texts.append(batch.calibration(20))
        for text in texts:
            print(text, "\n", flush=True)
    facts = machine(use_one_core())
    for key, value in facts.items():
        print(f"{key:8s}{value}")
    for rival in chosen:
        print(f"{rival.name}: {rival.setup}" + (f" [also: {rival.does_more}]" if rival.does_more else ""))
    print(f"median of {repeats} runs in turn; stepping only", flush=True)
    if "W3" in cases:
        print(f"answer of W3, N = 100: within {confirm():.0e} of DOP853 with events")
    rows = crashes(chosen, [name for name in cases if name in CASES], nodes, repeats, folder)
    checks = marks(rows)
    print()
    for text, holds in checks:
        print(f"{'holds   ' if holds else 'MISSED  '}{text}")
    if folder is not None:
        tables.write_csv(folder / "work_precision.csv", facts, rows)
        lines = [f"{key}: {value}" for key, value in facts.items()]
        lines += [f"{'holds' if holds else 'MISSED'}: {text}" for text, holds in checks]
        head = "# Rivals\n\n" + "  \n".join(lines) + "\n"
        setups = "".join(f"- **{r.name}**: {r.setup}\n" for r in chosen)
        body = "".join(f"\n```\n{text}\n```\n" for text in texts)
        (folder / "table.md").write_text(f"{head}\n{setups}{tables.markdown(rows)}{body}", encoding="utf-8")
        print(f"written: {folder}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
