"""Command line: a vehicle of which few facts are known."""

from __future__ import annotations

from pathlib import Path

import click

__all__ = ["from_facts"]

_UNIT = 'With a unit, as "4.3 m".'


@click.command()
@click.argument("kind")
@click.option("--mass", required=True, help='As it crashes, with a unit, as "2.5 t".')
@click.option("--length", help=_UNIT)
@click.option("--width", help=_UNIT)
@click.option("--height", help=_UNIT)
@click.option("--wheelbase", help=_UNIT)
@click.option("--mass-center-height", help=_UNIT)
@click.option(
    "-o",
    "--save",
    type=click.Path(dir_okay=False, path_type=Path),
    required=True,
    help="Vehicle file to write (.toml); --vehicle takes it.",
)
def from_facts(
    kind: str,
    mass: str,
    length: str | None,
    width: str | None,
    height: str | None,
    wheelbase: str | None,
    mass_center_height: str | None,
    save: Path,
) -> None:
    """Make the file of a vehicle by its KIND and what is known of it; prints what was assumed.

    KIND: car, minivan, pickup, van, truck, cab_over_truck, bus.
    """
    from ..vehicle.vehicle import Vehicle

    made = Vehicle.from_facts(
        kind,
        mass=mass,
        length=length,
        width=width,
        height=height,
        wheelbase=wheelbase,
        mass_center_height=mass_center_height,
    )
    made.save(save)
    for one in made.assumptions:
        click.echo(f"assumed: {one.text}")
