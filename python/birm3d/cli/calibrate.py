"""``birm3d calibrate``: progress on stderr, the summary on stdout."""

from __future__ import annotations

import json
import time
from pathlib import Path

import click

from ..io.atomic_write import whole_file
from .files import JSON, PICTURE, VEHICLE

__all__ = ["calibrate_file"]


@click.command("calibrate")
@click.argument("fit_file", type=click.Path(exists=True, dir_okay=False, path_type=Path))
@click.option("--json", "as_json", is_flag=True, help="The whole result as JSON on stdout.")
@click.option(
    "--plot", type=PICTURE, help="Write measured and computed curves to this file (.png, .pdf, .svg)."
)
@click.option("--profiles", type=PICTURE, help="Write the profile of every parameter to this file.")
@click.option("--save", "save_path", type=JSON, help="Write the whole result to this file (.json).")
@click.option(
    "--save-vehicle",
    type=VEHICLE,
    help="Write the fitted vehicle of the first simulation to this file (.toml), for `birm3d run --vehicle`.",
)
@click.option("--jobs", type=click.IntRange(min=1), help="Threads.  [default: one a processor]")
@click.option("--quiet", is_flag=True, help="No progress.")
def calibrate_file(
    fit_file: Path,
    as_json: bool,
    plot: Path | None,
    profiles: Path | None,
    save_path: Path | None,
    save_vehicle: Path | None,
    jobs: int | None,
    quiet: bool,
) -> None:
    """Fit scenes to measurements: FIT_FILE names scenes, measured curves and scalars, parameters."""
    from ..calibration import CalibrationError, CalibrationInterruptedError, calibrate
    from ..calibration.fit_file import read_fit_file
    from ..vehicle.vehicle_writer import check_savable

    fit = read_fit_file(fit_file)
    if save_vehicle is not None:
        check_savable(fit.simulations[0].scene.vehicle)
    try:
        result = calibrate(
            fit.simulations,
            fit.targets,
            fit.parameters,
            jobs=jobs,
            progress=None if quiet else _Progress(),
            **fit.options,
        )
    except (CalibrationError, CalibrationInterruptedError) as error:
        labels = [parameter.label for parameter in fit.parameters]
        _tell_best(labels, error.best_values)
        if isinstance(error, CalibrationInterruptedError):
            raise
        raise click.ClickException(str(error)) from error
    finally:
        if not quiet:
            click.echo(err=True)
    if as_json:
        from ..calibration.storage import as_plain

        click.echo(json.dumps(as_plain(result), indent=1, allow_nan=False))
    else:
        click.echo(result.summary())
        for comparison in result.comparisons().values():
            click.echo(f"\n{comparison.summary()}")
    for path, make in ((plot, result.plot_fit), (profiles, result.plot_profiles)):
        if path is not None:
            with whole_file(path) as part:
                make().savefig(part, dpi=150)
            click.echo(f"figure: {path}", err=True)
    if save_path is not None:
        result.save(save_path)
        click.echo(f"result: {save_path}", err=True)
    if save_vehicle is not None:
        result.vehicle.save(save_vehicle)
        click.echo(f"vehicle: {save_vehicle}", err=True)


def _tell_best(labels: list[str], values: tuple[float, ...] | None) -> None:
    if values is not None:
        best = ", ".join(f"{label} = {value:.6g}" for label, value in zip(labels, values, strict=True))
        click.echo(f"\nbest so far: {best}", err=True)


class _Progress:
    """One line on stderr, written anew a few times a second."""

    def __init__(self) -> None:
        self._next = 0.0

    def __call__(self, count: int, best: float | None) -> None:
        now = time.monotonic()
        if now < self._next:
            return
        self._next = now + 0.2
        cost = "" if best is None else f", least chi-square {2.0 * best:.5g}"
        click.echo(f"\r{count} runs{cost}\033[K", nl=False, err=True)
