"""Command line: results on stdout, everything else on stderr."""

from __future__ import annotations

import json
import os
import sys
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from .. import units
from ..io.atomic_write import whole_file
from ..result.summary import ELEMENT_COLUMNS, element_rows, elements_in_si, outcome_rows
from .calibrate import calibrate_file
from .files import CAPSULE, HTML, LOAD_MAP, MOVIE, PICTURE, RESULT, TABLE
from .from_facts import from_facts
from .loads import loads
from .overlay import overlay
from .predict import predict
from .rate import STANDARD_HELP, assessed, assessments_as_json, print_assessments, rate
from .report import report
from .rerun import rerun
from .scene import scene_options, simulation_of
from .search import search
from .sweep import sweep
from .table import print_table

if TYPE_CHECKING:
    from ..result.result import Result

__all__ = ["main"]


@click.group(context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="birm3d")
def _cli() -> None:
    """Impact response of vehicles and security or roadside barriers."""


_cli.add_command(calibrate_file)
_cli.add_command(from_facts)
_cli.add_command(loads)
_cli.add_command(overlay)
_cli.add_command(predict)
_cli.add_command(rate)
_cli.add_command(report)
_cli.add_command(rerun)


@_cli.command()
@scene_options
@click.option("--json", "as_json", is_flag=True, help="Metrics and loads on elements as JSON on stdout.")
@click.option("--report", "with_report", is_flag=True, help="Also what was computed and what was left out.")
@click.option("--rate", "standards", multiple=True, help=f"Also the rating by a standard. {STANDARD_HELP}")
@click.option("--occupant-risk", "with_risk", is_flag=True, help="Also OIV, ridedown, ASI, THIV, PHD, OLC.")
@click.option("--plot", type=PICTURE, help="Write figures to this file (.png, .pdf, .svg).")
@click.option("--load-map", type=LOAD_MAP, help="Write the load on a wall by cell (.csv, .png, .pdf, .svg).")
@click.option("--csv", "csv_path", type=TABLE, help="Write histories to this file (.csv).")
@click.option("--save", type=RESULT, help="Write the result to this file (.npz); birm3d.load() reads it.")
@click.option("--capsule", type=CAPSULE, help="Write a capsule (.birm3d) that `birm3d rerun` runs again.")
@click.option("--html", type=HTML, help="Write an interactive page that needs no network to this file.")
@click.option("--movie", type=MOVIE, help="Write a movie to this file (.mp4, .gif, ...).")
def run(
    scene: Path | None,
    as_json: bool,
    with_report: bool,
    standards: tuple[str, ...],
    with_risk: bool,
    plot: Path | None,
    load_map: Path | None,
    csv_path: Path | None,
    save: Path | None,
    capsule: Path | None,
    html: Path | None,
    movie: Path | None,
    **options: Any,
) -> None:
    """Run one crash: a SCENE file, or the options --vehicle and --speed."""
    simulation = simulation_of(scene, options)
    result = simulation.run(progress=True)
    ratings, risk = assessed(result, standards, with_risk)
    if as_json:
        click.echo(json.dumps({**_as_json(result), **assessments_as_json(ratings, risk)}, indent=2))
    else:
        _print_outcome(result)
        if ratings or risk is not None:
            print_assessments(ratings, risk)
    if with_report:
        click.echo(result.report(), err=as_json)
    if csv_path is not None:
        with whole_file(csv_path) as part:
            result.to_dataframe().to_csv(part)
        click.echo(f"histories: {csv_path}", err=True)
    if plot is not None:
        with whole_file(plot) as part:
            result.plot().savefig(part, dpi=150)
        click.echo(f"figures: {plot}", err=True)
    if load_map is not None:
        _write_load_map(result, load_map)
    if save is not None:
        result.save(save)
        click.echo(f"result: {save}", err=True)
    if capsule is not None:
        result.capsule(capsule)
        click.echo(f"capsule: {capsule}", err=True)
    if html is not None:
        result.write_html(html)
        click.echo(f"page: {html}", err=True)
    if movie is not None:
        result.animate(movie)
        click.echo(f"movie: {movie}", err=True)


def _write_load_map(result: Result, path: Path) -> None:
    cells = result.load_map()
    if path.suffix.lower() == ".csv":
        cells.to_csv(path)
    else:
        with whole_file(path) as part:
            cells.plot().savefig(part, dpi=150)
    click.echo(f"load map: {path}", err=True)


@_cli.command()
@click.option("--json", "as_json", is_flag=True, help="As JSON on stdout.")
def vehicles(as_json: bool) -> None:
    """List the vehicles that come with the package."""
    from rich.markup import escape
    from rich.table import Table

    from ..vehicle.vehicle import Vehicle

    rows = {name: Vehicle.preset(name) for name in Vehicle.presets()}
    if as_json:
        facts = {
            name: {
                "mass": v.mass,
                "length": v.length,
                "width": v.width,
                "height": v.height,
                "wheelbase": v.wheelbase,
                "track": v.track,
                "center_of_mass": v.center_of_mass.tolist(),
                "inertia": v.inertia.tolist(),
                "n_elements": v.n_elements,
                "n_trusses": v.n_trusses,
                "zones": {zone: dict(law) for zone, law in v.zones.items()},
            }
            for name, v in rows.items()
        }
        click.echo(json.dumps(facts, indent=2))
        return
    names = ("mass", "length", "width", "height", "wheelbase", "track", "CG height")
    table = Table("vehicle")
    for name in names:
        table.add_column(escape("mass [kg]" if name == "mass" else f"{name}\n[m]"), justify="right")
    table.add_column(escape("Ixx, Iyy, Izz\n[t m²]"))
    table.add_column("elements", justify="right")
    for column in table.columns:
        column.no_wrap = True
    for name, v in rows.items():
        sizes = (v.length, v.width, v.height, v.wheelbase, v.track, v.mass_center_height)
        cells = ("none" if size is None else f"{size:.3f}" for size in sizes)
        inertia = ", ".join(f"{1e-3 * value:.3g}" for value in v.inertia.diagonal())
        table.add_row(name, f"{v.mass:,.0f}", *cells, inertia, f"{v.n_elements:,}")
    print_table(table)
    for name, v in rows.items():
        click.echo(f"zones of {name}: {', '.join(v.zones)}")


def _as_json(result: Result) -> dict[str, Any]:
    scene = result.scene
    return {
        "vehicle": scene.vehicle.name,
        "mass": scene.vehicle.mass,
        "impact_speed": scene.impact_speed,
        "impact_angle": scene.impact_angle,
        "outcome": result.outcome,
        "outcome_detail": result.outcome_detail,
        "end_reason": result.end_reason,
        "state_hash": f"{result.state_hash:016x}",
        "metrics": dict(result.metrics),
        "elements": elements_in_si(result),
    }


_cli.add_command(search)
_cli.add_command(sweep)


def _print_outcome(result: Result) -> None:
    from rich.markup import escape
    from rich.table import Table

    from ..scene.text import overlap_text

    scene = result.scene
    table = Table(
        "outcome",
        "value",
        "unit",
        title=f"{scene.vehicle.name}, {scene.vehicle.mass:,.0f} kg, {scene.impact_speed:.2f} m/s "
        f"({scene.impact_speed / units.mph:.1f} mph) at {scene.impact_angle:g}°{overlap_text(scene)}",
        caption=f"{result.end_reason} after {result.time[-1] * 1e3:.0f} ms; {result.statistics.steps} steps "
        f"in {result.run_time * 1e3:.1f} ms of computing",
    )
    for row in outcome_rows(result):
        table.add_row(*row)
    print_table(table)
    elements = element_rows(result)
    if scene.barrier is None or len(scene.barrier.element_names) < 2 or not elements:
        return  # the loads on the only element are in the first table
    loads = Table(
        *(escape(name) for name in ELEMENT_COLUMNS), title="elements of the barrier that were touched"
    )
    for numbers in elements:
        loads.add_row(*numbers)
    print_table(loads)


def _show_warning(message: Warning | str, *_: object) -> None:
    """Show a warning as one line, without the line of this package that it comes from."""
    click.echo(f"birm3d: warning: {message}", err=True)


def main() -> None:
    """Entry point: errors that users can mend end with one line on stderr and exit code 2."""
    from .._core import UnstableError
    from ..study.runner import StudyStoppedError

    warnings.showwarning = _show_warning  # type: ignore[assignment]
    try:
        _cli(standalone_mode=False)
    except click.ClickException as error:
        error.show()
        sys.exit(error.exit_code)
    except (click.Abort, KeyboardInterrupt) as error:
        # click turns Ctrl-C into Abort; a study says in it what is finished.
        click.echo(str(error.__cause__ or error) or "stopped", err=True)
        sys.exit(130)
    except StudyStoppedError as error:
        click.echo(f"birm3d: {error}", err=True)
        sys.exit(1)
    except (ValueError, UnstableError, ImportError) as error:  # the last: an extra is missing
        click.echo(f"birm3d: {error}", err=True)
        sys.exit(2)
    except BrokenPipeError:  # who reads stdout has seen enough, as head
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(1)
    except OSError as error:  # a disk that is full, a file that went away
        place = "" if error.filename is None else f"{error.filename}: "
        click.echo(f"birm3d: {place}{error.strerror or error}", err=True)
        sys.exit(1)
