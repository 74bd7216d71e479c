"""Command line: ``birm3d sweep``."""

from __future__ import annotations

import itertools
import json
import math
import re
import shlex
import sys
import tempfile
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from .. import units
from ..result.event import outcome_words
from .files import CSV, STORE
from .scene import scene_options, simulation_of
from .table import print_table

if TYPE_CHECKING:
    from ..study import Study
    from ..study.shown_columns import ShownColumn

__all__ = ["sweep", "values"]

# Columns of the table on stdout; files and JSON have all metrics unless --metrics says which.
_SHOWN = (
    "dynamic_crush",
    "max_displacement",
    "vehicle_penetration",
    "peak_normal_force_cfc60",
    "peak_deceleration_cfc60",
    "exit_speed",
)
_DISTRIBUTION = re.compile(r"\s*(normal|lognormal|uniform)\s*\(([^,()]*),([^,()]*)\)\s*")
_MOST_VALUES = 100_000


@click.command()
@scene_options
@click.option(
    "--vary",
    multiple=True,
    required=True,
    metavar="NAME=VALUES",
    help="Values as 30mph,40mph (a speed must have its unit), as FIRST:LAST:STEP such as 10:30:5deg, or, "
    "with --random, as normal(MEAN, DEVIATION), lognormal(MEDIAN, DEVIATION OF THE LOGARITHM) or "
    "uniform(LEAST, GREATEST). Several: all combinations. Names: impact_speed, impact_angle, vehicle, "
    "barrier.friction, vehicle.gvw, zone.bumper.scale, ...",
)
@click.option("--random", "n", type=int, help="Draw this many runs from distributions instead.")
@click.option("--seed", type=int, default=0, show_default=True, help="Of --random.")
@click.option("--metrics", help="Comma-separated.  [default: all in files, some in the table]")
@click.option("--csv", "csv_path", type=CSV, help="Write all runs to this file (.csv).")
@click.option("--json", "as_json", is_flag=True, help="All runs as JSON on stdout.")
@click.option("--jobs", type=click.IntRange(min=1), help="Threads.  [default: one for each core]")
@click.option(
    "--store",
    type=STORE,
    help="Keep finished runs in this file (SQLite); the same command goes on from there.",
)
def sweep(
    scene: Path | None,
    vary: Sequence[str],
    n: int | None,
    seed: int,
    metrics: str | None,
    csv_path: Path | None,
    as_json: bool,
    jobs: int | None,
    store: Path | None,
    **options: Any,
) -> None:
    """Run a SCENE file, or --vehicle and --speed, with many values of what it has."""
    from ..study.monte_carlo import monte_carlo
    from ..study.sweep import sweep as run_sweep

    wanted = _split(vary)
    if scene is None and options["speed"] is None and n is None and "impact_speed" in wanted:
        options["speed"] = values("impact_speed", wanted["impact_speed"])[0]
    simulation = simulation_of(scene, options)
    names = None if metrics is None else [name.strip() for name in metrics.split(",")]
    with nullcontext() if jobs is None else ThreadPoolExecutor(jobs) as executor:
        shared: dict[str, Any] = {"metrics": names, "executor": executor, "store": store}
        with _kept_when_stopped(store):
            if n is None:
                lists = {name: values(name, text) for name, text in wanted.items()}
                study = run_sweep(simulation, lists, **shared)
            else:
                drawn = {name: _distribution(name, text) for name, text in wanted.items()}
                study = monte_carlo(simulation, drawn, n, seed, **shared)
    if csv_path is not None:
        study.save(csv_path)
        click.echo(f"runs: {csv_path}", err=True)
    if as_json:
        click.echo(json.dumps(_as_json(study), indent=2, allow_nan=False))
    elif n is None:
        _print_runs(study, names or _SHOWN)
    else:
        _print_summary(study)
    if study.failed:
        run, reason = next(iter(study.failed.items()))
        click.echo(f"{len(study.failed)} of {len(study)} runs failed; run {run}: {reason}", err=True)


@contextmanager
def _kept_when_stopped(store: Path | None) -> Iterator[None]:
    """Keep the finished runs of a study that is stopped, and say how to go on."""
    from ..study.runner import StudyInterrupted, StudyStoppedError

    try:
        yield
    except (StudyInterrupted, StudyStoppedError) as stopped:
        command = sys.argv[1:]
        if store is None:
            if len(stopped.study) == 0:
                raise
            store = _free_name()
            stopped.keep(store)
            command += ["--store", str(store)]
        message = str(stopped).replace("kept in the error's 'study'", f"kept in {str(store)!r}")
        text = f"{message}\ngo on with: {shlex.join(['birm3d', *command])}"
        raise type(stopped)(text, stopped.study) from None


def _free_name() -> Path:
    """Return the name of a new store, in this folder where it can be written to."""
    for folder in (Path(), Path(tempfile.gettempdir())):
        for number in itertools.count(1):
            path = folder / ("birm3d-sweep.db" if number == 1 else f"birm3d-sweep-{number}.db")
            try:
                path.touch(exist_ok=False)
            except FileExistsError:
                continue
            except OSError:
                break
            return path
    raise ValueError("store must be given: neither this folder nor that of temporary files can be written to")


def _split(vary: Sequence[str]) -> dict[str, str]:
    wanted: dict[str, str] = {}
    for text in vary:
        name, equals, values = text.partition("=")
        if not equals or not name.strip() or name.strip() in wanted:
            raise ValueError(f"--vary must be NAME=VALUES, each name once; got {text!r}")
        wanted[name.strip()] = values
    return wanted


def values(name: str, text: str) -> list[Any]:
    """Return the values of a list a,b,c or a range first:last:step, whose last unit holds for all of it."""
    if ":" not in text:
        return [_value(name, part) for part in text.split(",")]
    parts = text.split(":")
    unit = re.search(r"[A-Za-z/]*\s*$", parts[-1])
    suffix = unit[0].strip() if unit else ""
    parts = [part if re.search(r"[A-Za-z]\s*$", part) else part + suffix for part in parts]
    numbers = [_value(name, part) for part in parts]
    if len(numbers) != 3 or not all(isinstance(number, float) for number in numbers):
        raise ValueError(f"{name} must be a range FIRST:LAST:STEP of numbers, got {text!r}")
    first, last, step = numbers
    # A little over a whole number of steps, for the last value to be in it in spite of rounding.
    steps = (last - first) / step + 1e-9 if step != 0.0 else -1.0
    if not 0.0 <= steps < _MOST_VALUES:
        raise ValueError(f"{name} must have a step that leads from first to last, got {text!r}")
    return [first + i * step for i in range(math.floor(steps) + 1)]


def _value(name: str, text: str) -> Any:
    """Return a number in SI where the parameter has a unit, else a number, none, true, false or a text."""
    from ..simulation.parameters import quantity_of

    text = text.strip()
    words = {"none": None, "true": True, "false": False}
    if text.lower() in words:
        return words[text.lower()]
    if not text:
        raise ValueError(f"{name} must have values, got an empty one")
    quantity = quantity_of(name)
    if quantity is not None:
        try:
            return units.parse(text, quantity, plain=quantity != "speed")
        except ValueError as error:
            raise ValueError(f"{name}: {error}") from None
    try:
        return float(text)
    except ValueError:
        return text


def _distribution(name: str, text: str) -> Any:
    from scipy import stats

    match = _DISTRIBUTION.fullmatch(text)
    if match is None:
        raise ValueError(
            f"{name} must be normal(MEAN, DEVIATION), lognormal(MEDIAN, DEVIATION OF THE LOGARITHM) or "
            f"uniform(LEAST, GREATEST) with --random; got {text!r}"
        )
    a = _value(name, match[2])
    b = float(match[3]) if match[1] == "lognormal" else _value(name, match[3])
    if match[1] == "normal":
        return stats.norm(a, b)
    if match[1] == "lognormal":
        return stats.lognorm(b, scale=a)
    return stats.uniform(a, b - a)


def _as_json(study: Study) -> dict[str, Any]:
    columns = {
        name: [None if isinstance(value, float) and math.isnan(value) else value for value in values.tolist()]
        for name, values in study.columns().items()
    }
    summary = {name: row._asdict() for name, row in study.summary().items()}
    return {
        "vehicle": study.vehicle,
        "barrier": study.barrier,
        "units": dict(study.units),
        "runs": columns,
        "summary": summary,
    }


def _print_runs(study: Study, metrics: Sequence[str]) -> None:
    from rich.table import Table

    shown = [*study.parameters, "outcome", *(name for name in metrics if name in study.metrics)]
    table = Table(*(_heading(study, name) for name in shown), title=f"{study.scene_title}, {len(study)} runs")
    for i in range(len(study)):
        cells = [_cell(study[name][i], _column(study, name).divisor) for name in shown]
        if study.error[i]:
            cells[len(study.parameters) :] = ["failed"] + [""] * (len(shown) - len(study.parameters) - 1)
        table.add_row(*cells)
    print_table(table)


def _print_summary(study: Study) -> None:
    from rich.table import Table

    from ..study.counted import counted, is_count

    table = Table(
        *("metric", "runs", "mean", "standard deviation", "5 %", "median", "95 %"),
        title=f"{study.scene_title}, {len(study)} random runs over {', '.join(study.parameters)}",
    )
    for name, row in study.summary().items():
        if is_count(name):
            continue
        size = _column(study, name).divisor
        deviation = "" if row.standard_deviation is None else _cell(row.standard_deviation, size)
        numbers = (_cell(value, size) for value in (row.p05, row.median, row.p95))
        table.add_row(_heading(study, name), str(row.n), _cell(row.mean, size), deviation, *numbers)
    print_table(table)
    counts = Table("outcome", "runs")
    for outcome, n in study.outcomes.items():
        counts.add_row(outcome_words(outcome), str(n))
    for one in counted(study):
        counts.add_row(f"any outcome, with {one.words}", str(one.runs))
    print_table(counts)


def _heading(study: Study, name: str) -> str:
    from rich.markup import escape

    return escape(_column(study, name).label)  # rich would take [m] for a style


def _column(study: Study, name: str) -> ShownColumn:
    """Return how a column is shown; files and JSON have it in SI."""
    from ..study.shown_columns import shown_column

    return shown_column(name, study.units.get(name, ""))


def _cell(value: Any, size: float) -> str:
    """Return a value in a unit of this size."""
    if isinstance(value, float):
        value /= size
        return "" if math.isnan(value) else f"{value:,.4g}" if abs(value) < 1e4 else f"{value:,.0f}"
    return str(value)
