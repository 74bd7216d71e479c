"""All that a dossier is about, computed once: run, assessments, nearby tests, the same run more finely."""

from __future__ import annotations

import dataclasses
import warnings
from dataclasses import dataclass

from ..assessment import (
    DesignLoad,
    OccupantRisk,
    Rating,
    RatingStudy,
    design_load,
    occupant_risk,
    rate,
)
from ..io.made_with import code_text
from ..result.result import Result
from ..simulation import Simulation
from ..study import Study
from ..study.predict import Prediction
from .class_bands import ClassBands, class_bands
from .given_tests import Compared, nearest

__all__ = ["Asked", "Case", "case_of", "is_oblique", "why_not_rated"]

SECURITY = ("ASTM F2656", "ISO 22343-1", "IWA 14-1", "PAS 68", "SD-STD-02.01")
ROADSIDE = ("MASH", "EN 1317")
_FRAMES = 60  # instants that the replay shows
_FINER = 1e-2  # tolerance of the run that errors are measured with, over that of the run itself
_LEAST_TOLERANCE = 1e-8
_MOST_RATED = 2000  # longer studies are not rated, because each of their runs is run once more for it


@dataclass(frozen=True)
class Asked:
    """What a run is to be rated by.

    Attributes
    ----------
    standards : tuple of str or None
        ``None``: those that suit the impact and know the vehicle.
    vehicle_class : str or None
        What they call the vehicle; ``None``: by its kind and mass.
    """

    standards: tuple[str, ...] | None
    vehicle_class: str | None


@dataclass(frozen=True)
class Case:
    """What a dossier is about.

    Attributes
    ----------
    run : Result
        As it was given: its report and its capsule are part of the dossier.
    result : Result
        The same with frames.
    study : Study or None
        Runs with other inputs.
    ratings : tuple of Rating
    not_rated : mapping of str to str
        Standard -> why it does not rate the run.
    rating_study : RatingStudy or None
        Of the study, by the first standard that rates the run.
    risk : OccupantRisk or str
        Or why there is none.
    design_loads : DesignLoad or str
        Or why there are none.
    bands : ClassBands or str
        Of the vehicles of the class in the scene; or why there are none.
    tests : list of Compared
    finer : Result
        The same scene with a hundredth of the tolerance.
    warnings : list of str
        Of the run.
    """

    run: Result
    result: Result
    study: Study | None
    ratings: tuple[Rating, ...]
    not_rated: dict[str, str]
    rating_study: RatingStudy | None
    risk: OccupantRisk | str
    design_loads: DesignLoad | str
    bands: ClassBands | str
    tests: list[Compared]
    finer: Result
    warnings: list[str]


def is_oblique(result: Result) -> bool:
    """Whether the path is within 45 degrees of the barrier's line: a roadside impact."""
    return not 45.0 <= result.scene.impact_angle <= 135.0


def case_of(
    result: Result,
    study: Study | None,
    asked: Asked,
    design_loads: DesignLoad | None,
    prediction: Prediction | None = None,
    draws: int = 0,
) -> Case:
    """Return the case of a run.

    Raises
    ------
    ValueError
        If the scene does not run again to the same bits, or a standard that was asked for does not know it.
    """
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        again = Simulation.from_scene(result.scene).run()
    if again.state_hash != result.state_hash:
        raise ValueError(
            f"result must run again to the same bits, got state {again.state_hash:016x} after "
            f"{result.state_hash:016x} (result of {code_text(result.made_with)}): run its scene anew"
        )
    framed = result if result.frames is not None else result.with_frames(min(_FRAMES, len(result.time)))
    ratings, reasons = _rated(framed, asked)
    risk = _risk(framed)
    names = [rating.standard for rating in ratings if rating.is_rated]
    loads = _loads(framed) if design_loads is None else design_loads
    own = loads if design_loads is None and isinstance(loads, DesignLoad) else None
    with_risk = not isinstance(risk, str)
    return Case(
        run=result,
        result=framed,
        study=study,
        ratings=ratings,
        not_rated=reasons,
        rating_study=None
        if study is None or not ratings
        else _rated_study(study, ratings[0].standard, asked),
        risk=risk,
        design_loads=loads,
        bands=class_bands(result, prediction, draws, names, with_risk, asked.vehicle_class, own),
        tests=[] if result.scene.barrier is None else nearest(result.scene),
        finer=_finer(result),
        warnings=list(dict.fromkeys(str(one.message) for one in told)),
    )


def _rated(result: Result, asked: Asked) -> tuple[tuple[Rating, ...], dict[str, str]]:
    called = asked.vehicle_class
    if asked.standards is not None:
        return tuple(rate(result, name, vehicle_class=called) for name in asked.standards), {}
    if result.scene.barrier is None:
        return (), {}
    ratings, reasons = [], {}
    for standard in ROADSIDE if is_oblique(result) else SECURITY:
        try:
            ratings.append(rate(result, standard, vehicle_class=called))
        except ValueError as reason:  # the standard does not know the vehicle
            reasons[standard] = str(reason)
    ratings.sort(key=lambda rating: not rating.is_rated)
    return tuple(ratings), reasons


def why_not_rated(study: Study) -> str:
    """Return why no run of a study is rated, before a standard is asked; empty where runs are rated."""
    if len(study) > _MOST_RATED:
        return f"more than {_MOST_RATED:,} runs are not rated"
    if study._scene is None or not study.parameters:
        return "a study from a file or an ensemble holds no scenes to rate"
    return ""


def _rated_study(study: Study, standard: str, asked: Asked) -> RatingStudy | None:
    if why_not_rated(study):
        return None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the study has warned of its runs already
        try:
            return rate(study, standard, vehicle_class=asked.vehicle_class)
        except ValueError:  # the standard knows none of its runs
            return None


def _risk(result: Result) -> OccupantRisk | str:
    try:
        risk = occupant_risk(result)
        _ = risk.criteria
    except ValueError as reason:
        return str(reason)
    return risk


def _loads(result: Result) -> DesignLoad | str:
    if result.scene.barrier is None:
        return "there is no barrier"
    try:
        return design_load(result, draws=0, progress=False)  # class_bands adds the bands later
    except ValueError as reason:  # the rows are too far apart for the assumed period
        return str(reason)


def _finer(result: Result) -> Result:
    settings = result.scene.settings
    tolerance = max(_LEAST_TOLERANCE, _FINER * settings.tolerance)
    finer = dataclasses.replace(settings, time_step=None, tolerance=tolerance)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the run itself has warned of the same
        return Simulation.from_scene(dataclasses.replace(result.scene, settings=finer)).run()
