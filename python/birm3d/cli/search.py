"""Command line: searches for the limits of a barrier and for the worst offset."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..io.atomic_write import whole_file
from .files import PICTURE
from .scene import QuantityOption, scene_options, simulation_of
from .sweep import values

if TYPE_CHECKING:
    from ..study.limit_search import Limit
    from ..study.worst_offset import WorstOffset

__all__ = ["search"]

_JSON = click.option("--json", "as_json", is_flag=True, help="As JSON on stdout, SI.")
_PLOT = click.option("--plot", type=PICTURE, help="Write the figure to this file (.png, .pdf, .svg).")
_POINTS = click.option("--points", type=int, default=11, show_default=True, help="Of the first scan.")
_DRAWS = click.option(
    "--draws",
    type=int,
    help="Vehicles of the class for how many of which the limit holds, a power of 2; 0: none.  [default: 16]",
)


def _range(default: str, unit: str) -> Callable[[Any], Any]:
    return click.option(
        "--range",
        "limits",
        default=default,
        show_default=True,
        help=f"LEAST:GREATEST of the search ({unit}).",
    )


@click.group()
def search() -> None:
    """Search for the greatest gap, the least height, segment mass or wall of a tube, or the worst offset."""


# A gap is one between bollards, so that these are what is searched where nothing else is said.
@search.command(context_settings={"default_map": {"barrier": "bollards"}})
@scene_options
@_range("0.5:3.0", "m")
@click.option("--penetration", type=QuantityOption("length"), help="Greatest that is allowed as well.")
@_POINTS
@_DRAWS
@_JSON
@_PLOT
def gap(
    scene: Path | None,
    limits: str,
    penetration: float | None,
    points: int,
    draws: int | None,
    as_json: bool,
    plot: Path | None,
    **options: Any,
) -> None:
    """Find the greatest clear gap between bollards that still stops the vehicle at every offset."""
    from ..study.design_limits import greatest_gap

    found = greatest_gap(
        simulation_of(scene, options),
        _limits(limits, "length"),
        penetration=penetration,
        points=points,
        draws=draws,
    )
    _show(found, as_json, plot)


@search.command()
@scene_options
@click.option(
    "--range", "limits", help="LEAST:GREATEST of the search (m).  [default: 0.15:1.3, what it can have]"
)
@click.option("--penetration", type=QuantityOption("length"), help="Greatest that is allowed as well.")
@_POINTS
@_DRAWS
@_JSON
@_PLOT
def height(
    scene: Path | None,
    limits: str | None,
    penetration: float | None,
    points: int,
    draws: int | None,
    as_json: bool,
    plot: Path | None,
    **options: Any,
) -> None:
    """Find the least height of a barrier that the vehicle does not get over."""
    from ..study.design_limits import least_height

    wanted = None if limits is None else _limits(limits, "length")
    found = least_height(
        simulation_of(scene, options), wanted, penetration=penetration, points=points, draws=draws
    )
    _show(found, as_json, plot)


@search.command("segment-mass")
@scene_options
@_range("500:8000", "kg")
@click.option(
    "--deflection", type=QuantityOption("length"), required=True, help="Greatest that is allowed (m)."
)
@_POINTS
@_DRAWS
@_JSON
@_PLOT
def segment_mass(
    scene: Path | None,
    limits: str,
    deflection: float,
    points: int,
    draws: int | None,
    as_json: bool,
    plot: Path | None,
    **options: Any,
) -> None:
    """Find the least mass of a free-standing segment for a given deflection of the barrier."""
    from ..study.design_limits import least_segment_mass

    found = least_segment_mass(
        simulation_of(scene, options),
        _limits(limits, "mass"),
        deflection=deflection,
        points=points,
        draws=draws,
    )
    _show(found, as_json, plot)


@search.command("tube-thickness", context_settings={"default_map": {"barrier": "bollards"}})
@scene_options
@_range("0.004:0.03", "m")
@click.option("--deflection", type=QuantityOption("length"), help="Greatest of a post's top (m).")
@_POINTS
@_DRAWS
@_JSON
@_PLOT
def tube_thickness(
    scene: Path | None,
    limits: str,
    deflection: float | None,
    points: int,
    draws: int | None,
    as_json: bool,
    plot: Path | None,
    **options: Any,
) -> None:
    """Find the least wall of steel tubes with which a row of bollards stops the vehicle."""
    from ..study.design_limits import least_tube_thickness

    wanted = _limits(limits, "length")
    if scene is None and options["wall_thickness"] is None:
        options["wall_thickness"] = wanted[1]
    found = least_tube_thickness(
        simulation_of(scene, options), wanted, deflection=deflection, points=points, draws=draws
    )
    _show(found, as_json, plot)


@search.command()
@scene_options
@click.option("--spacings", help="Of bollards: 1.2,1.5,1.8 or FIRST:LAST:STEP (m).  [default: the scene's]")
@click.option("--metric", default="peak_overturning_moment_50ms", show_default=True, help="Worst: greatest.")
@_JSON
@_PLOT
def offset(
    scene: Path | None,
    spacings: str | None,
    metric: str,
    as_json: bool,
    plot: Path | None,
    **options: Any,
) -> None:
    """Find the worst place at which a row of bollards can be hit, for each spacing."""
    from ..study.worst_offset import worst_offset

    wanted = None if spacings is None else values("barrier.spacing", spacings)
    _show(worst_offset(simulation_of(scene, options), wanted, metric=metric), as_json, plot)


def _limits(text: str, quantity: str) -> list[float]:
    from .. import units

    parts = text.split(":")
    if len(parts) != 2:
        raise ValueError(f"--range must be LEAST:GREATEST, got {text!r}")
    return [units.parse(part, quantity, plain=True) for part in parts]


def _show(found: Limit | WorstOffset, as_json: bool, plot: Path | None) -> None:
    if as_json:
        click.echo(json.dumps(found.to_dict(), indent=2, allow_nan=False))
    else:
        click.echo(found.summary())
    if plot is not None:
        with whole_file(plot) as part:
            found.plot().savefig(part, dpi=150)
        click.echo(f"figure: {plot}", err=True)
