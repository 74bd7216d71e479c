"""Command line: ratings and occupant risk of one run."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from .scene import barrier_of, scene_options, simulation_of

if TYPE_CHECKING:
    from ..assessment import LevelStudy, OccupantRisk, Rating, RatingStudy, RiskStudy
    from ..result.result import Result
    from ..study.predict import Prediction

    Ratings = Sequence[Rating | RatingStudy | LevelStudy]
    Risk = OccupantRisk | RiskStudy | None

__all__ = ["STANDARD_HELP", "Assessed", "assessed", "rate", "result_of"]

STANDARD_HELP = (
    'Standard: "ASTM F2656", "ASTM F2656-07", "SD-STD-02.01", "IWA 14-1", "ISO 22343-1", "PAS 68", "MASH" or '
    '"EN 1317", these two also with a level or test ("MASH TL-3", "EN 1317 TB32"). Can be repeated.'
)


class Assessed(NamedTuple):
    """Ratings and occupant risk of a run, and why standards do not rate it."""

    ratings: Ratings
    risk: Risk
    not_rated: Mapping[str, str]
    """Standard -> reason."""

    def as_json(self) -> dict[str, Any]:
        """Return all of it as plain values."""
        found: dict[str, Any] = {}
        if self.ratings:
            found["ratings"] = [rating.to_dict() for rating in self.ratings]
        if self.not_rated:
            found["not_rated"] = dict(self.not_rated)
        return found if self.risk is None else {**found, "occupant_risk": self.risk.to_dict()}

    def print(self) -> None:
        """Print ratings and occupant risk as tables of text."""
        texts = [rating.summary() for rating in self.ratings]
        if self.risk is not None:
            texts.append(self.risk.summary())
        if texts:
            click.echo("\n\n".join(texts))

    def tell_reasons(self) -> None:
        """Print on stderr why standards do not rate the run.

        Raises
        ------
        ValueError
            With these reasons, if no standard rates it.
        """
        if self.not_rated and not self.ratings:
            raise ValueError("; ".join(f"no rating by {name}: {why}" for name, why in self.not_rated.items()))
        for name, why in self.not_rated.items():
            click.echo(f"birm3d: no rating by {name}: {why}", err=True)


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
        _show(Assessed(levels, None, {}), as_json)
        return
    if draws:
        from ..study.predict import predict

        result = predict(simulation_of(scene, options), draws, progress=True)
    else:
        result = result_of(scene, options)
    found = assessed(result, standards, with_risk, vehicle_class, reference_point)
    _show(found, as_json)
    found.tell_reasons()


def _show(found: Assessed, as_json: bool) -> None:
    if as_json:
        click.echo(json.dumps(found.as_json(), indent=2))
    else:
        found.print()


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
) -> Assessed:
    """Return the ratings of a run by some standards, and its occupant risk where that is asked for.

    Raises
    ------
    ValueError
        If a standard is not known, or the reference point is no point.
    """
    if not standards and not with_risk:
        return Assessed([], None, {})
    from ..assessment import occupant_risk
    from ..assessment import rate as rate_result
    from ..assessment.rate import split_standard

    point = None if reference_point is None else _point(reference_point)
    for standard in standards:
        split_standard(standard)
    ratings: list[Rating | RatingStudy] = []
    not_rated: dict[str, str] = {}
    for standard in standards:
        try:
            ratings.append(rate_result(result, standard, vehicle_class=vehicle_class, reference_point=point))
        except ValueError as reason:  # as of a vehicle that the standard does not know
            not_rated[standard] = str(reason)
    return Assessed(ratings, occupant_risk(result) if with_risk else None, not_rated)


def _point(text: str) -> str | list[float]:
    parts = text.split(",")
    if len(parts) == 1:
        return text
    try:
        return [float(part) for part in parts]
    except ValueError as error:
        raise ValueError(f"--reference-point must be a name or x,y,z in m, got {text!r}") from error
