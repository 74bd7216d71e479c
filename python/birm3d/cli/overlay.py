"""Command line: several runs laid over each other."""

from __future__ import annotations

from pathlib import Path

import click

from ..io.atomic_write import whole_file
from ..result.history_channels import HISTORY_CHANNELS
from .files import PICTURE
from .table import print_table

__all__ = ["overlay"]


@click.command()
@click.argument(
    "results", nargs=-1, required=True, type=click.Path(exists=True, dir_okay=False, path_type=Path)
)
@click.option("--plot", required=True, type=PICTURE, help="Write the figure to this file (.png, .pdf, .svg).")
@click.option(
    "--channel",
    "channels",
    multiple=True,
    type=click.Choice(list(HISTORY_CHANNELS)),
    default=("barrier_force", "deceleration", "velocity", "travel"),
    help="What is drawn; may be given several times. [default: force, deceleration, velocity, travel]",
)
def overlay(results: tuple[Path, ...], plot: Path, channels: tuple[str, ...]) -> None:
    """Histories of several RESULTS (.npz of `birm3d run --save`, or capsules) in one figure.

    Their headline numbers are printed side by side, too.
    """
    from rich.markup import escape
    from rich.table import Table

    from ..pictures import plot_runs
    from ..result.result import load
    from ..result.summary import headline_rows

    runs = [load(path) for path in results]
    labels = [path.stem for path in results]
    figure = plot_runs(runs, channels, labels if len(set(labels)) == len(labels) else None)
    with whole_file(plot) as part:
        figure.savefig(part, dpi=150)
    rows: dict[tuple[str, str], dict[int, str]] = {}
    for i, run in enumerate(runs):
        for name, value, unit in headline_rows(run):
            if name:
                rows.setdefault((name, unit), {})[i] = value
    table = Table("value", *(escape(label) for label in labels), "unit")
    for (name, unit), values in rows.items():
        table.add_row(escape(name), *(values.get(i, "") for i in range(len(runs))), escape(unit))
    print_table(table)
    click.echo(f"figure: {plot}", err=True)
