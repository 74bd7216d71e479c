"""Command line: the dossier of a run."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from .rate import STANDARD_HELP, result_of
from .scene import scene_options

__all__ = ["report"]


class _Folder(click.ParamType):  # type: ignore[type-arg,unused-ignore]
    """A folder for a dossier: refused at once where that can not be."""

    name = "folder"

    def convert(self, value: Any, _param: click.Parameter | None, _ctx: click.Context | None) -> Path:
        """Return the path; a ValueError says why no dossier can be written there."""
        from ..reporting.folder import check_folder

        try:
            return check_folder(value)
        except ValueError as error:
            raise ValueError(str(error).replace("folder must", "--output must", 1)) from error


@click.command()
@scene_options
@click.option(
    "--output", "-o", type=_Folder(), required=True, help="Folder: new, empty, or of an earlier dossier."
)
@click.option("--standard", "standards", multiple=True, help=f"{STANDARD_HELP}  [default: those that suit]")
@click.option("--vehicle-class", help="What the standards call the vehicle.  [default: by kind and mass]")
@click.option(
    "--study",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    help="File of Study.save(): its percentiles beside this run.",
)
@click.option(
    "--draws",
    default=16,
    show_default=True,
    help="Vehicles of the class that the bands are made of, a power of 2 from 8; 0: no bands.",
)
@click.option("--title", help="Of the page.  [default: the scene]")
@click.option("--project", default="", help="In the title block.")
@click.option("--client", default="", help="In the title block: prepared for.")
@click.option("--author", default="", help="In the title block: prepared by.")
@click.option("--date", help="In the title block.  [default: today]")
def report(
    scene: Path | None,
    output: Path,
    standards: tuple[str, ...],
    vehicle_class: str | None,
    study: Path | None,
    draws: int,
    title: str | None,
    project: str,
    client: str,
    author: str,
    date: str | None,
    **options: Any,
) -> None:
    """Write the dossier of one crash: a SCENE file, a result (.npz, .birm3d), or --vehicle and --speed.

    A folder with one page (index.html) that opens offline and prints to PDF, a capsule that `birm3d rerun`
    runs again, and tables.
    """
    from ..reporting import dossier
    from ..study import Study

    beside = None if study is None else Study.load(study)
    page = dossier(
        result_of(scene, options),
        output,
        study=beside,
        draws=draws,
        standards=standards or None,
        vehicle_class=vehicle_class,
        title=title,
        project=project,
        client=client,
        author=author,
        date=date,
    )
    click.echo(str(page))
