"""Ratings of runs, of whole levels and of studies."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from typing import overload

from ..base.arguments import checked
from ..base.near_names import did_you_mean
from ..result import Result
from ..scene.scene import Scene
from ..study import Study
from ..study.predict import Prediction
from ..units import Quantity
from .level_study import LevelStudy, level_study
from .probability import RatingStudy, rate_study
from .rating import Rating
from .roadside import EN_1317, MASH
from .roadside_rating import level_rating, rate_roadside
from .security import SECURITY, rate_security

__all__ = ["STANDARDS", "rate", "split_standard"]

_ROADSIDE = {one.name: one for one in (MASH, EN_1317)}
STANDARDS = (*SECURITY, *_ROADSIDE)
"""Names of the standards that :func:`rate` knows."""
_LEVELS = tuple(f"{name} {one}" for name, rules in _ROADSIDE.items() for one in (*rules.levels, *rules.tests))


@overload
def rate(
    result: Result | Sequence[Result],
    standard: str,
    *,
    vehicle_class: str | None = None,
    reference_point: str | Sequence[Quantity] | None = None,
    part: str | int | None = None,
) -> Rating: ...


@overload
def rate(
    result: Study | Prediction,
    standard: str,
    *,
    vehicle_class: str | None = None,
    reference_point: str | Sequence[Quantity] | None = None,
    part: str | int | None = None,
) -> RatingStudy: ...


@overload
def rate(
    result: Sequence[Study | Prediction],
    standard: str,
    *,
    vehicle_class: str | None = None,
    reference_point: str | Sequence[Quantity] | None = None,
    part: str | int | None = None,
) -> LevelStudy: ...


@checked
def rate(
    result: Result | Study | Prediction | Sequence[Result] | Sequence[Study | Prediction],
    standard: str,
    *,
    vehicle_class: str | None = None,
    reference_point: str | Sequence[Quantity] | None = None,
    part: str | int | None = None,
) -> Rating | RatingStudy | LevelStudy:
    """Return what a standard would call a run. Always indicative: a rating needs a test.

    Parameters
    ----------
    result
        A run until its outcome is decided. A study or a prediction: every run of it is rated, and each class
        has its share of the runs as a probability. Several runs, or several predictions: one for each test of
        a level.
    standard
        ``"ASTM F2656"``, ``"ASTM F2656-07"``, ``"SD-STD-02.01"``, ``"IWA 14-1"``, ``"ISO 22343-1"``,
        ``"PAS 68"``, ``"MASH"`` or ``"EN 1317"``. The last two may name a level or test, as
        ``"MASH TL-3"``, ``"MASH 3-11"``, ``"EN 1317 N2"``, ``"EN 1317 TB32"``; else it follows from the run.
    vehicle_class
        What the standard calls the vehicle, as ``"M"``; ``None``: by the kind and the mass of the vehicle.
    reference_point, part
        Of the vehicle, in place of the point that the standard measures penetration to, see
        :meth:`birm3d.Result.sensor`; security barriers only.

    Raises
    ------
    ValueError
        If the standard or the vehicle is not known, or the vehicle has no such point. If the run has no
        barrier, has a path along it, or is not over. If the tests of a level are at different barriers.
    """
    name, rest = split_standard(standard)
    for argument, value in (("reference_point", reference_point), ("part", part)):
        if value is not None and name in _ROADSIDE:
            raise ValueError(f"{argument} must be None for {name}, which measures to no point; got {value!r}")
    if isinstance(result, Prediction):
        result = result.study
    if isinstance(result, Study):
        return rate_study(result, lambda run: _of_run(run, name, rest, vehicle_class, reference_point, part))
    if isinstance(result, Result):
        return _of_run(result, name, rest, vehicle_class, reference_point, part)
    if name not in _ROADSIDE or rest is None:
        raise ValueError(
            f"standard must name a level, as 'MASH TL-3', where several runs are given; got {standard!r}"
        )
    _check_one_barrier(result)
    studies = [one for one in result if isinstance(one, (Study, Prediction))]
    if studies:
        return level_study(
            _ROADSIDE[name], rest, [rate(one, standard, vehicle_class=vehicle_class) for one in studies]
        )
    runs = [one for one in result if isinstance(one, Result)]
    ratings = [_of_run(run, name, rest, vehicle_class, reference_point, part) for run in runs]
    return level_rating(_ROADSIDE[name], rest, ratings)


def _check_one_barrier(results: Sequence[Result] | Sequence[Study | Prediction]) -> None:
    """Refuse tests of a level at different barriers, wherever these stand and however rough they are.

    Of studies from files the scene is not known.
    """
    scenes = [one.scene if isinstance(one, Result) else _scene_of(one) for one in results]
    barriers = [scene.barrier for scene in scenes if scene is not None and scene.barrier is not None]
    alike = [replace(barrier, friction=0.0, origin=(0.0, 0.0, 0.0), heading=0.0) for barrier in barriers]
    for one, barrier in zip(alike, barriers, strict=True):
        if one != alike[0]:
            raise ValueError(f"results must be of one barrier for a level, got {barriers[0]} and {barrier}")


def _scene_of(study: Study | Prediction) -> Scene | None:
    return (study.study if isinstance(study, Prediction) else study)._scene


def split_standard(standard: str) -> tuple[str, str | None]:
    """Return the standard, and the level or test that is named beside it."""
    for name in sorted(STANDARDS, key=len, reverse=True):
        if standard == name:
            return name, None
        if standard.startswith(f"{name} "):
            return name, standard.removeprefix(f"{name} ").strip()
    meant = [name for name in _LEVELS if _plain(standard) in (_plain(name), _plain(name.split(" ")[-1]))]
    near = f", did you mean {' or '.join(map(repr, meant))}?" if meant else did_you_mean(standard, STANDARDS)
    raise ValueError(
        f"standard must be one of {', '.join(STANDARDS)}; got {standard!r}{near or '.'} Levels of security "
        "barriers are named beside the standard in a matrix ('ASTM F2656 M50'), and follow from the run in a "
        "rating"
    )


def _plain(text: str) -> str:
    return re.sub(r"[^a-z0-9]", "", text.lower())


def _of_run(
    run: Result,
    name: str,
    rest: str | None,
    vehicle_class: str | None,
    point: str | Sequence[Quantity] | None,
    part: str | int | None,
) -> Rating:
    if name in SECURITY:
        if rest is not None:
            raise ValueError(
                f"standard must be {name!r} alone: the level follows from the run; got {rest!r} too"
            )
        return rate_security(run, SECURITY[name], vehicle_class, point, part)
    return rate_roadside(run, _ROADSIDE[name], rest, vehicle_class)
