"""Command line: design loads on the elements of a barrier."""

from __future__ import annotations

import json
from concurrent.futures import ThreadPoolExecutor
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..io.atomic_write import whole_file
from .files import CSV, PICTURE
from .rate import is_result, loaded
from .scene import QuantityOption, scene_options, simulation_of
from .sweep import values

if TYPE_CHECKING:
    from ..result.result import Result
    from ..simulation.simulation import Simulation

__all__ = ["loads"]


@click.command()
@scene_options
@click.option(
    "--period",
    type=QuantityOption("time"),
    help="Natural period of an element on its foundation: 0.05 (s) or 50ms.  [default: 0.1 s, assumed]",
)
@click.option("--ductility", type=float, default=1.0, show_default=True, help="1: elastic.")
@click.option("--damping", type=float, default=0.0, show_default=True, help="Ratio to the critical one.")
@click.option("--offsets", help="Impact offsets of the envelope: 0,0.3,0.6 or FIRST:LAST:STEP (m).")
@click.option("--angles", help="Impact angles of the envelope: 60,75,90 or FIRST:LAST:STEP (deg).")
@click.option("--speeds", help="Impact speeds of the envelope with their unit: 30mph,50mph.")
@click.option(
    "--draws",
    type=int,
    help="Vehicles of the class that the 80 % bands are made of, a power of 2; 0: no bands.  [default: 16]",
)
@click.option("--markdown", is_flag=True, help="The table as Markdown on stdout, to paste into a report.")
@click.option("--json", "as_json", is_flag=True, help="As JSON on stdout, SI.")
@click.option("--csv", "csv_path", type=CSV, help="Write the table to this file (.csv), SI.")
@click.option("--plot", type=PICTURE, help="Write the figure to this file (.png, .pdf, .svg).")
@click.option("--jobs", type=click.IntRange(min=1), help="Threads.  [default: one for each core]")
def loads(
    scene: Path | None,
    period: float | None,
    ductility: float,
    damping: float,
    offsets: str | None,
    angles: str | None,
    speeds: str | None,
    draws: int | None,
    markdown: bool,
    as_json: bool,
    csv_path: Path | None,
    plot: Path | None,
    jobs: int | None,
    **options: Any,
) -> None:
    """Compute design loads of each element: a SCENE file, a result (.npz), or --vehicle and --speed.

    Forces, heights and moments as 50-ms means, and the equivalent static force of a system with the given
    natural period and ductility. With lists of offsets, angles or speeds: the envelope of all combinations.
    """
    from ..assessment.design_load import design_load

    if markdown and as_json:
        raise click.UsageError("give --markdown or --json: both write to stdout")
    lists: dict[str, Any] = {
        argument: None if text is None else values(name, text)
        for argument, name, text in (
            ("offsets", "impact_offset", offsets),
            ("impact_angles", "impact_angle", angles),
            ("impact_speeds", "impact_speed", speeds),
        )
    }
    if scene is None and options["speed"] is None and lists["impact_speeds"]:
        options["speed"] = lists["impact_speeds"][0]
    case: Simulation | Result
    case = loaded(scene, options) if scene is not None and is_result(scene) else simulation_of(scene, options)
    with nullcontext() if jobs is None else ThreadPoolExecutor(jobs) as executor:
        found = design_load(
            case,
            natural_period=period,
            ductility=ductility,
            damping=damping,
            draws=draws,
            executor=executor,
            **lists,
        )
    if as_json:
        click.echo(json.dumps(found.to_dict(), indent=2, allow_nan=False))
    else:
        click.echo(found.to_markdown() if markdown else found.summary())
    if csv_path is not None:
        found.to_csv(csv_path)
        click.echo(f"table: {csv_path}", err=True)
    if plot is not None:
        with whole_file(plot) as part:
            found.plot().savefig(part, dpi=150)
        click.echo(f"figure: {plot}", err=True)
