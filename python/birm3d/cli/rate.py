"""Command line: ratings and occupant risk of one run."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from .scene import barrier_of, scene_options, simulation_of

if TYPE_CHECKING:
    from ..assessment import LevelStudy, OccupantRisk, Rating, RatingStudy, RiskStudy
    from ..result.result import Result
    from ..study.predict import Prediction

    Ratings = Sequence[Rating | RatingStudy | LevelStudy]
    Risk = OccupantRisk | RiskStudy | None

__all__ = ["STANDARD_HELP", "assessed", "assessments_as_json", "print_assessments", "rate", "result_of"]

STANDARD_HELP = (
    'Standard: "ASTM F2656", "ASTM F2656-07", "SD-STD-02.01", "IWA 14-1", "ISO 22343-1", "PAS 68", "MASH" or '
    '"EN 1317", these two also with a level or test ("MASH TL-3", "EN 1317 TB32"). Can be repeated.'
)


@click.command()
@scene_options
@click.option("--standard", "standards", multiple=True, required=True, help=STANDARD_HELP)
@click.option("--vehicle-class", help="What the standard calls the vehicle.  [default: by kind and mass]")
@click.option(
    "--reference-point",
    help="Point of the vehicle in place of the standard's: a name, or x,y,z in its file's axes (m).",
)
@click.option("--occupant-risk", "with_risk", is_flag=True, help="Also OIV, ridedown, ASI, THIV, PHD, OLC.")
@click.option(
    "--draws",
    type=int,
    default=0,
    show_default=True,
    help="Vehicles of the class, a power of 2 from 8: probabilities and 80 % bands in place of one run.",
)
@click.option(
    "--level",
    is_flag=True,
    help="All tests of the level that --standard names, with its vehicles, at the --barrier.",
)
@click.option("--json", "as_json", is_flag=True, help="As JSON on stdout.")
def rate(
    scene: Path | None,
    standards: tuple[str, ...],
    vehicle_class: str | None,
    reference_point: str | None,
    with_risk: bool,
    draws: int,
    level: bool,
    as_json: bool,
    **options: Any,
) -> None:
    """Rate one crash by standards: a SCENE file, a result (.npz, .birm3d), or --vehicle and --speed.

    With --level all crashes of a level of MASH or EN 1317 at one barrier. Always indicative: a rating needs a
    test.
    """
    result: Result | Prediction
    if level:
        if scene is not None or options["vehicle"] is not None or options["speed"] is not None:
            raise click.UsageError("--level has the standard's vehicles and speeds: give --barrier alone")
        if vehicle_class or reference_point or with_risk:
            raise click.UsageError("--level takes no --vehicle-class, --reference-point or --occupant-risk")
        levels = [_of_level(standard, draws, options) for standard in standards]
        if as_json:
            click.echo(json.dumps(assessments_as_json(levels, None), indent=2))
        else:
            print_assessments(levels, None)
        return
    if draws:
        from ..study.predict import predict

        result = predict(simulation_of(scene, options), draws, progress=True)
    else:
        result = result_of(scene, options)
    ratings, risk = assessed(result, standards, with_risk, vehicle_class, reference_point)
    if as_json:
        click.echo(json.dumps(assessments_as_json(ratings, risk), indent=2))
    else:
        print_assessments(ratings, risk)


def _of_level(standard: str, draws: int, options: dict[str, Any]) -> Rating | LevelStudy:
    """Return the rating of a level: all its tests at the barrier of the options."""
    from ..assessment import rate as rate_results
    from ..assessment import test_matrix
    from ..study.predict import predict

    barrier = barrier_of(options)
    if barrier is None:
        raise click.UsageError("--level needs a --barrier, got none")
    tests = test_matrix(
        standard,
        barrier=barrier,
        impact_offset=options["offset"],
        mesh_density=options["mesh_density"],
        duration=options["duration"],
    )
    if draws:
        return rate_results([predict(test, draws, progress=True) for test in tests], standard)
    return rate_results([test.run(progress=True) for test in tests], standard)


def result_of(scene: Path | None, options: dict[str, Any]) -> Result:
    """Return the result of a scene file, of a file that holds a result, or of the options."""
    if scene is None or not is_result(scene):
        return simulation_of(scene, options).run(progress=True)
    return loaded(scene, options)


def is_result(scene: Path) -> bool:
    """Whether a file is a result or a capsule, by its ending."""
    return scene.suffix.lower() in (".npz", ".birm3d")


def loaded(scene: Path, options: dict[str, Any]) -> Result:
    """Return the result in a file; options of a scene beside it are refused."""
    from ..result.result import load

    given = click.get_current_context()
    source = click.core.ParameterSource.COMMANDLINE
    for name in options:
        if given.get_parameter_source(name) is source:
            raise click.UsageError(
                f"--{name.replace('_', '-')} must not be given beside a result, got {scene}"
            )
    return load(scene)


def assessed(
    result: Result | Prediction,
    standards: Sequence[str],
    with_risk: bool,
    vehicle_class: str | None = None,
    reference_point: str | None = None,
) -> tuple[Ratings, Risk]:
    """Return the ratings of a run by some standards, and its occupant risk where that is asked for."""
    if not standards and not with_risk:
        return [], None
    from ..assessment import occupant_risk
    from ..assessment import rate as rate_result

    point = None if reference_point is None else _point(reference_point)
    ratings = [
        rate_result(result, standard, vehicle_class=vehicle_class, reference_point=point)
        for standard in standards
    ]
    return ratings, occupant_risk(result) if with_risk else None


def _point(text: str) -> str | list[float]:
    parts = text.split(",")
    if len(parts) == 1:
        return text
    try:
        return [float(part) for part in parts]
    except ValueError as error:
        raise ValueError(f"--reference-point must be a name or x,y,z in m, got {text!r}") from error


def assessments_as_json(ratings: Ratings, risk: Risk) -> dict[str, Any]:
    """Return ratings and occupant risk as plain values."""
    found: dict[str, Any] = {"ratings": [rating.to_dict() for rating in ratings]} if ratings else {}
    return found if risk is None else {**found, "occupant_risk": risk.to_dict()}


def print_assessments(ratings: Ratings, risk: Risk) -> None:
    """Print ratings and occupant risk as tables of text."""
    texts = [rating.summary() for rating in ratings]
    if risk is not None:
        texts.append(risk.summary())
    click.echo("\n\n".join(texts))
