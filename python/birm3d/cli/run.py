"""``birm3d run``: one crash, its outcome, and files of it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from .. import units
from ..io.atomic_write import whole_file
from ..result.summary import ELEMENT_COLUMNS, element_rows, elements_in_si, outcome_rows
from .files import CAPSULE, GLTF, HTML, LOAD_MAP, MOVIE, PICTURE, RESULT, TABLE, VTK
from .rate import STANDARD_HELP, assessed
from .scene import scene_options, simulation_of
from .table import print_table

if TYPE_CHECKING:
    from ..result.result import Result

__all__ = ["run"]


@click.command()
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
@click.option("--gltf", type=GLTF, help="Write a 3-D animation for Blender and browsers (.glb, .gltf).")
@click.option("--vtk", type=VTK, help="Write a series for ParaView (.pvd), and a folder beside it.")
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
    gltf: Path | None,
    vtk: Path | None,
    **options: Any,
) -> None:
    """Run one crash: a SCENE file, or the options --vehicle and --speed."""
    simulation = simulation_of(scene, options)
    result = simulation.run(progress=True)
    found = assessed(result, standards, with_risk)
    if as_json:
        click.echo(json.dumps({**_as_json(result), **found.as_json()}, indent=2))
    else:
        _print_outcome(result)
        found.print()
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
    for name, path, write in (
        ("result", save, result.save),
        ("capsule", capsule, result.capsule),
        ("page", html, result.write_html),
        ("movie", movie, result.animate),
        ("animation", gltf, result.write_gltf),
        ("series", vtk, result.write_vtk),
    ):
        if path is not None:
            write(path)
            click.echo(f"{name}: {path}", err=True)
    found.tell_reasons()


def _write_load_map(result: Result, path: Path) -> None:
    cells = result.load_map()
    if path.suffix.lower() == ".csv":
        cells.to_csv(path)
    else:
        with whole_file(path) as part:
            cells.plot().savefig(part, dpi=150)
    click.echo(f"load map: {path}", err=True)


def _as_json(result: Result) -> dict[str, Any]:
    scene = result.scene
    return {
        "vehicle": scene.vehicle.name,
        "mass": scene.vehicle.mass,
        "impact_speed": scene.impact_speed,
        "impact_angle": scene.impact_angle,
        "impact_offset": scene.impact_offset,
        "impact_yaw": scene.impact_yaw,
        "impact_roll": scene.impact_roll,
        "overlap": scene.overlap,
        "overlap_side": scene.overlap_side,
        "outcome": result.outcome,
        "outcome_detail": result.outcome_detail,
        "end_reason": result.end_reason,
        "state_hash": f"{result.state_hash:016x}",
        "metrics": dict(result.metrics),
        "elements": elements_in_si(result),
    }


def _print_outcome(result: Result) -> None:
    from rich.markup import escape
    from rich.table import Table

    from ..result.report import END_REASONS
    from ..scene.text import pose_text
    from ..vehicle.title import vehicle_text

    scene = result.scene
    table = Table(
        "outcome",
        "value",
        "unit",
        title=f"{vehicle_text(scene.vehicle)}, {scene.impact_speed:.2f} m/s "
        f"({scene.impact_speed / units.mph:.1f} mph) at {scene.impact_angle:g}°{pose_text(scene)}",
        caption=f"ended at {result.time[-1] * 1e3:.0f} ms: {END_REASONS[result.end_reason]}; "
        f"{result.statistics.steps} steps in {result.run_time * 1e3:.1f} ms of computing",
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
