"""Writes finite_element.md beside this file from the tables in results.

python tests/validation/page.py
"""

from __future__ import annotations

import csv
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from statistics import median

FOLDER = Path(__file__).parent
sys.path.insert(0, str(FOLDER.parent / "bench"))

from finite_element import VEHICLES  # noqa: E402

YAW_MARK = 5.0  # deg
KINDS = ("before", "fitted", "left out")
HEAD = (
    "run",
    "crush, m",
    "error",
    "CFC60 force, kN",
    "error",
    "yaw at the end, deg",
    "error",
    "lateral over normal impulse",
)

INTRODUCTION = """# Finite-element vehicles N and S

Tables are written by `python tests/validation/page.py` from `results`.

`python tests/validation/fit_finite_element.py n` (or `s`) fits the skin of a vehicle to all its given runs
together and saves it as `tests/data/finite_element/fitted_n.toml`. Then it fits it without each run in turn.
Runs were made with OpenRadioss on public training models. The last number of a name is the speed in mph.
`wall25` is 25 degrees from head-on, left front corner first; `pole350` is a pole 0.35 m to the right of the
centre line. Barriers are without friction.

- before: the law of `tests/bench/bench_finite_element.py`, one even front, fitted to walls at 20 and 40 mph.
- fitted: the saved vehicle; all runs of its table were fitted.
- left out: the same fit without the run of the row.

Fits start from what is expected of a skin of such sheets before a run is seen, and from values drawn about
it. No fit starts from another. Two choices of the law of N were made with all runs in view: see the end.

Marks: crush within 10 % (N) or 5 % (S), force within 15 % or 10 %, yaw within 5 degrees. An error beyond its
mark is bold. Repeats of the same finite-element run differ by as much as the marks of crush and force.
"""

NUMBERS = """### What the runs tell of the numbers

The last column is the standard deviation of a number after the fit, over that before it. Before the fit the
standard deviation is one width. Near 1 the runs do not determine the number; near 0 they do. "Range of all
fits" is that of the fit to all runs and of those that leave a run out.
"""

TRADE_OFF = """### N, wall at 25 degrees: yaw, crush and force

Written by `python tests/validation/yaw_trade_off.py`: fits that give the yaw of this run more and more
weight, and one to this run alone. The second column is the error of this yaw that counts as one residual. It
is a weight and no error that is reached. The last columns count all runs. The saved vehicle uses 5 degrees.
"""


def rows_of(name: str) -> list[dict[str, str]]:
    """A table of results: "n" or "s" of the runs, "n_numbers" of what was fitted, "yaw" of the trade-off."""
    with (FOLDER / f"results/finite_element_{name}.csv").open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


def errors(row: dict[str, str]) -> tuple[float, float, float]:
    """Of crush and force relative to the run, of yaw in degrees."""
    crush, force = (
        float(row[name]) / float(row[f"{name}_measured"]) - 1.0 for name in ("crush", "peak_force")
    )
    return crush, force, float(row["yaw"]) - float(row["yaw_measured"])


def marks(row: dict[str, str]) -> tuple[float, float, float]:
    vehicle = VEHICLES[row["vehicle"].lower()]
    return vehicle.crush_trust, vehicle.force_trust, YAW_MARK


def within(row: dict[str, str]) -> tuple[bool, ...]:
    return tuple(abs(error) <= mark for error, mark in zip(errors(row), marks(row), strict=True))


def _cells(row: dict[str, str]) -> list[str]:
    told = [f"{100.0 * error:+.1f} %" for error in errors(row)[:2]] + [f"{errors(row)[2]:+.1f}"]
    crush, force, yaw = (text if ok else f"**{text}**" for text, ok in zip(told, within(row), strict=True))
    value = {name: float(text) for name, text in row.items() if name not in ("vehicle", "run", "what")}
    lateral = (
        f"{round(value['lateral'], 3) + 0.0:.3f} ({value['lateral_measured']:.3f})"
        if "pole" in row["run"]
        else ""
    )
    return [
        row["run"],
        f"{value['crush']:.3f} ({value['crush_measured']:.3f})",
        crush,
        f"{1e-3 * value['peak_force']:.0f} ({1e-3 * value['peak_force_measured']:.0f})",
        force,
        f"{round(value['yaw'], 1) + 0.0:.1f} ({value['yaw_measured']:.1f})",
        yaw,
        lateral,
    ]


def _summary(tables: dict[str, list[dict[str, str]]]) -> Iterator[str]:
    yield "### How many are within their marks\n"
    yield "| vehicle | law | runs | crush | force | yaw | all | median error of crush | of force |"
    yield "|" + "---|" * 9
    for key, table in tables.items():
        for kind in KINDS:
            chosen = [row for row in table if row["what"] == kind]
            good = [sum(each) for each in zip(*(within(row) for row in chosen), strict=True)]
            crush, force = (median(abs(errors(row)[i]) for row in chosen) for i in (0, 1))
            counts = " | ".join(f"{n} of {len(chosen)}" for n in good)
            share = f"{sum(good)} of {3 * len(chosen)}"
            medians = f"{100 * crush:.1f} % | {100 * force:.1f} %"
            yield f"| {key.upper()} | {kind} | {len(chosen)} | {counts} | {share} | {medians} |"
    yield ""
    yield from _straight_runs(
        [row for table in tables.values() for row in table if row["what"] == "left out"]
    )


def _straight_runs(rows: Sequence[dict[str, str]]) -> Iterator[str]:
    """How many yaws are met because the scene is the same on both sides, where the model has none."""
    met = [row for row in rows if within(row)[2]]
    straight, easy = ([r for r in of if r["run"].startswith(("wall00", "pole000"))] for of in (rows, met))
    yield (
        f"{len(straight)} of the {len(rows)} runs are the same on both sides, where the model has no yaw. "
        f"Of the {len(met)} yaws\nthat are met with the run left out, {len(easy)} are of these runs.\n"
    )


def _table(key: str, kind: str, rows: Sequence[dict[str, str]]) -> Iterator[str]:
    yield f"### {key.upper()}, {kind}: computed (run)\n"
    yield f"| {' | '.join(HEAD)} |"
    yield "|" + "---|" * len(HEAD)
    for row in rows:
        yield f"| {' | '.join(_cells(row))} |"
    yield ""


def _numbers(key: str) -> Iterator[str]:
    """What was fitted, and what the runs tell of it."""
    yield f"### {key.upper()}: the numbers\n"
    yield (
        "| number | unit | expected | one width away | fitted | range of all fits "
        "| standard deviation after the fit, over that before |"
    )
    yield "|" + "---|" * 7
    for row in rows_of(f"{key}_numbers"):
        value = {name: f"{float(row[name]):.3g}" for name in list(row)[3:]}
        away = f"{value['expected_low']} to {value['expected_high']}"
        others = f"{value['low']} to {value['high']}"
        told = f"{float(row['deviation']):.2f}"
        cells = (row["name"], row["unit"], value["expected"], away, value["value"], others, told)
        yield f"| {' | '.join(cells)} |"
    yield ""


def _trade_off() -> Iterator[str]:
    """The wall at 25 degrees by fits that hold its yaw more and more firmly."""
    yield TRADE_OFF
    yield (
        "| fitted runs | weight of yaw: degrees per unit residual | error of crush | of force | of yaw, deg "
        "| crush within | force within | yaw within |"
    )
    yield "|" + "---|" * 8
    for row in rows_of("yaw"):
        crush, force, yaw = errors(row)
        counts = " | ".join(f"{row[f'{name}_within']} of {row['of']}" for name in ("crush", "force", "yaw"))
        yield (
            f"| {row['runs']} | {float(row['sigma']):g} | {100.0 * crush:+.1f} % "
            f"| {100.0 * force:+.1f} % | {yaw:+.1f} | {counts} |"
        )
    yield ""


def page() -> str:
    """The text of finite_element.md."""
    tables = {key: rows_of(key) for key in VEHICLES}
    lines = [INTRODUCTION, *_summary(tables)]
    for key, table in tables.items():
        for kind in KINDS:
            lines += _table(key, kind, [row for row in table if row["what"] == kind])
    closed = max(
        float(row["closed"]) for table in tables.values() for row in table if row["what"] != "before"
    )
    lines.append(
        f"The rigid core is never met: no truss loses more than {100.0 * closed:.0f} % of its length.\n"
    )
    lines.append(NUMBERS)
    for key in tables:
        lines += _numbers(key)
    lines += _trade_off()
    notes = FOLDER / "finite_element_notes.md"
    return "\n".join(lines) + "\n" + notes.read_text(encoding="utf-8")


if __name__ == "__main__":
    (FOLDER / "finite_element.md").write_text(page(), encoding="utf-8", newline="\n")
