"""Command line: bands of a scene's metrics."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import click

from ..io.atomic_write import whole_file
from .files import PICTURE
from .scene import scene_options, simulation_of

__all__ = ["predict"]


@click.command()
@scene_options
@click.option("--draws", default=32, show_default=True, help="Number of runs, a power of 2 from 8 to 1024.")
@click.option("--share", default=0.8, show_default=True, help="Of the draws within the band.")
@click.option(
    "--bands", type=PICTURE, help="Write bands of deceleration and travel over time (.png, .pdf, ...)."
)
@click.option("--json", "as_json", is_flag=True, help="As JSON on stdout.")
def predict(
    scene: Path | None, draws: int, share: float, bands: Path | None, as_json: bool, **options: Any
) -> None:
    """Metrics with bands: a SCENE file, or --vehicle and --speed; what is not known is drawn.

    Forces, height of the mass centre, friction and tyres are drawn as the class of the vehicle scatters.
    """
    from ..study.history_bands import history_bands
    from ..study.predict import predict as bands_of

    found = bands_of(simulation_of(scene, options), draws, share=share, progress=True)
    click.echo(json.dumps(found.to_dict(), indent=2) if as_json else found.summary())
    if bands is not None:
        with whole_file(bands) as part:
            history_bands(found, share=share, progress=True).plot().savefig(part, dpi=150)
        click.echo(f"bands: {bands}", err=True)
