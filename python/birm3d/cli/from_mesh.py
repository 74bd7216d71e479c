"""Command line: a vehicle whose skin is a mesh."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from ..io.atomic_write import whole_file
from .files import PICTURE, VEHICLE

__all__ = ["from_mesh"]

_UNIT = 'With a unit, as "0.9 m".'


@click.command()
@click.argument("mesh", type=click.Path(dir_okay=False, path_type=Path))
@click.option("--mass", required=True, help='As it crashes, with a unit, as "1.8 t".')
@click.option("--kind", help="car, minivan, pickup, van, truck, cab_over_truck or bus.")
@click.option("--like", help="In place of --kind: a preset that has all but the skin.")
@click.option("--unit", help="Of the mesh: m, mm, cm, in or ft.")
@click.option("--forward", default="+x", show_default=True, help="Axis of the mesh that looks ahead.")
@click.option("--up", default="+z", show_default=True, help="Axis of the mesh that looks up.")
@click.option(
    "--holes",
    type=click.Choice(["refuse", "close", "wrap"]),
    help="What to do about holes. Default: wrap for keyword files, refuse for others.",
)
@click.option("--part", "parts", multiple=True, help="Part to take: its number, or a piece of its title.")
@click.option("--without-part", "without_parts", multiple=True, help="Part to leave out, as --part.")
@click.option("--clearance", default="0 m", show_default=True, help="Of the mesh above the ground.")
@click.option("--element-size", help=f"Distance of nodes. {_UNIT}")
@click.option("--wheelbase", help=_UNIT)
@click.option("--front-overhang", help=_UNIT)
@click.option("--wheel-radius", help=_UNIT)
@click.option("--track", help=_UNIT)
@click.option("--mass-center-height", help=_UNIT)
@click.option(
    "--use-densities",
    is_flag=True,
    help="Mass centre and inertia by the keyword file's densities, brought to --mass.",
)
@click.option("--plot", type=PICTURE, help="Write a figure of what was understood (.png, .pdf, .svg).")
@click.option("-o", "--save", type=VEHICLE, required=True, help="Vehicle file (.toml); --vehicle takes it.")
def from_mesh(mesh: Path, plot: Path | None, save: Path, **options: Any) -> None:
    """Make the file of a vehicle whose skin is a MESH; prints what was assumed.

    MESH: LS-DYNA keyword file, STL, OBJ, PLY, glTF, VTK, ...
    """
    from ..vehicle.vehicle import Vehicle

    parts = _numbers(options.pop("parts"))
    options["without_parts"] = _numbers(options["without_parts"])
    made = Vehicle.from_mesh(mesh, parts=parts or None, **options)
    made.save(save)
    for one in made.assumptions:
        click.echo(f"assumed: {one.text}")
    if plot is not None:
        with whole_file(plot) as part:
            made.plot().savefig(part, dpi=150)
        click.echo(f"figure: {plot}", err=True)


def _numbers(names: tuple[str, ...]) -> list[int | str]:
    return [int(name) if name.isdecimal() else name for name in names]
