"""``birm3d vehicles``: the vehicles that come with the package."""

from __future__ import annotations

import json

import click

from .table import print_table

__all__ = ["vehicles"]


@click.command()
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
