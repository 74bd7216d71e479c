"""Command line: a run that was kept, run again."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import click

__all__ = ["rerun"]


@click.command()
@click.argument("capsule", type=click.Path(exists=True, dir_okay=False, path_type=Path))
@click.option("--json", "as_json", is_flag=True, help="As JSON on stdout.")
def rerun(capsule: Path, as_json: bool) -> None:
    """Run a CAPSULE (.birm3d) or a saved result (.npz) once more and compare it bit for bit.

    Exit code 0: the same bits. 1: other bits; then which code wrote the file, and by how much the metrics
    differ.
    """
    from ..simulation.rerun import rerun as run_again

    found = run_again(capsule)
    click.echo(json.dumps(found.to_dict(), indent=2) if as_json else found.summary())
    if not found.same:
        sys.exit(1)
