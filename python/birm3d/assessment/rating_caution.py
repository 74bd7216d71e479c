"""Cautions about ratings: what the model leaves out that bears on a verdict."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from .. import units
from ..barrier.barrier import Barrier
from ..barrier.kinds import Jersey
from ..result.tipping import tipping
from .criteria import Criterion
from .doubts import Doubt, doubt_of
from .limits import ASI_CLASSES, FLAIL_LIMITS, THIV_LIMIT_KM_H
from .vehicles import HEAVY_KG

if TYPE_CHECKING:
    from ..result import Result
    from .roadside import RoadsideStandard, RoadsideTest

__all__ = [
    "fails_clearly",
    "level_cautions",
    "model_cautions",
    "risk_doubts",
    "roadside_doubts",
    "roadside_lines",
    "tipping_doubts",
]

_BODY = (
    "Indicative: computed, not tested. The vehicle is one rigid body, or two, with a crushable skin: a load "
    "bed is fixed to the frame unless it was let go, the engine can not stop before the cab, wheels stay on."
)
_RIGID = (
    "Barriers that are modelled as rigid do not give way, so that tests read more penetration and deflection."
)
_FREE = "Segments slide and turn, but do not tip or break."
_YIELDING = "Posts yield at the ground, or where their foundations turn, but do not buckle or tear."
_LIMITS = (
    "Limits and tolerances are those that are commonly reported of the standard: check them in its text."
)

_ROLLS_LITTLE = (
    "Springs, steering and camber thrust are estimates: computed vehicles may roll too little. At a New "
    "Jersey barrier of 0.81 m the 10000S overturns at 16 deg, but stays upright at 15 deg. Its camber "
    "thrust was set by a test at 16 deg, so that this supports nothing. A heavy vehicle that is computed "
    "upright may roll over in a test."
)
_TANK = (
    "Test 6-12 asks for a tractor with a tank trailer. A van trailer in its place, as the package has it, "
    "rolls otherwise, and meets tall barriers with its box."
)
_LOW = (
    "The barrier ends {top:.2f} m above the ground; at least {least:.2f} m is commonly reported for {level} "
    "({inches:g} in{older}), of AASHTO LRFD section 13 and MASH: check the text. A vehicle that is computed "
    "upright at a lower barrier may go over it in a test."
)
_SLOPED = (
    "The barrier has sloped faces. How a light vehicle climbs and rolls there is an estimate: do not choose "
    "a profile or its height by it."
)
_LEAST_INCHES = {"TL-1": 27.0, "TL-2": 27.0, "TL-3": 29.0, "TL-4": 36.0, "TL-5": 42.0, "TL-6": 90.0}
"""Least height of a rail, commonly reported of AASHTO LRFD section 13 and MASH: check the text.

EN 1317 has none.
"""
_LIKE = {"TB51": ("H2", "TL-4"), "TB81": ("H4b", "TL-5")}
"""Tests of EN 1317 with a bus or a heavy truck -> their level, and the level of MASH that is like it."""
_LOW_LIKE = (
    "The barrier ends {top:.2f} m above the ground. EN 1317 asks for no height. By analogy alone, taking "
    "{level} as MASH {like}, at least {least:.2f} m ({inches:g} in) is commonly reported. A vehicle that is "
    "computed upright at a lower barrier may go over it in a test."
)
_SPEED_ERROR = 0.15  # of OIV in the two tests of tests/validation/ratings.md: -2 and +15 %
_RISK_LIMITS = {
    "ASI": ASI_CLASSES["C"],
    "THIV": THIV_LIMIT_KM_H,
    "H: OIV, longitudinal": FLAIL_LIMITS["MASH"].velocity[1],
    "H: OIV, lateral": FLAIL_LIMITS["MASH"].velocity[1],
}
_NEAR = (
    f"Within {100.0 * _SPEED_ERROR:.0f} % of the limit: {{names}}. That is the greater error of computed OIV "
    "in two tests, taken for all of these. A pass or a fail by that is no verdict."
)
_RIDEDOWN = (
    "Computed ridedown was 76 and 171 % above two tests: a fail by {names} is no verdict. It rests on peaks "
    "of 10 ms."
)
_OLDER = {"TL-4": "; 32 in by NCHRP 350"}
_ROUNDED = 0.01  # m; heights are given in whole centimetres, as 0.91 m for 36 in


def model_cautions(barrier: Barrier | None) -> tuple[str, ...]:
    """Return what the model leaves out of every rating at a barrier."""
    if barrier is not None and barrier.stands_free() is not None:
        return _BODY, _FREE, _LIMITS
    if barrier is not None and barrier.yields() is not None:
        return _BODY, _YIELDING, _LIMITS
    return _BODY, _RIGID, _LIMITS


def tipping_doubts(result: Result) -> Iterator[Doubt]:
    """Yield a doubt if a free-standing segment would begin to tip."""
    yield from map(doubt_of, tipping(result))


def roadside_doubts(result: Result, standard: RoadsideStandard, test: RoadsideTest) -> Iterator[Doubt]:
    """Yield why a roadside barrier may do less well in a test: it is low, or its segments would tip."""
    assert result.scene.barrier is not None  # without one there is no rating
    yield from _low_rail(result.scene.barrier, standard, test)
    yield from tipping_doubts(result)


def roadside_lines(result: Result, test: RoadsideTest) -> Iterator[str]:
    """Yield what bears on a rating as a test of a roadside barrier, whatever becomes of the vehicle."""
    assert result.scene.barrier is not None
    if test.vehicle.mass >= HEAVY_KG:
        yield _ROLLS_LITTLE
    elif _is_sloped(result.scene.barrier):
        yield _SLOPED
    if test.vehicle.code == "36000T":
        yield _TANK


def risk_doubts(rows: Iterable[Criterion]) -> Iterator[Doubt]:
    """Yield what the criteria of occupant risk are worth, where the model's error decides on them."""
    judged = [row for row in rows if row.passed is not None]
    near = tuple(row.name for row in judged if _is_near_limit(row))
    beyond = tuple(row.name for row in judged if _fails_ridedown(row))
    if near:
        yield Doubt("near_limits", float(len(near)), _NEAR, near)
    if beyond:
        yield Doubt("ridedown", float(len(beyond)), _RIDEDOWN, beyond)


def fails_clearly(rows: Iterable[Criterion]) -> bool:
    """Whether a criterion fails by more than the model's error in tests."""
    return any(row.passed is False and not (_is_near_limit(row) or _fails_ridedown(row)) for row in rows)


def _is_near_limit(row: Criterion) -> bool:
    limit = _RISK_LIMITS.get(row.name)
    return limit is not None and isinstance(row.value, float) and abs(row.value / limit - 1.0) < _SPEED_ERROR


def _fails_ridedown(row: Criterion) -> bool:
    return "ridedown" in row.name and row.passed is False


def _is_sloped(barrier: Barrier) -> bool:
    """Whether a barrier is a Jersey barrier whose faces are not upright."""
    return isinstance(barrier, Jersey) and float(np.ptp(barrier.half_profile()[:, 0])) > 0.0


def _low_rail(barrier: Barrier, standard: RoadsideStandard, test: RoadsideTest) -> Iterator[Doubt]:
    """Yield a doubt if the barrier is lower than what is required of the lowest level with this test."""
    levels = [level for level, tests in standard.levels.items() if test.name in tests]
    known = [level for level in levels if standard.name == "MASH" and level in _LEAST_INCHES]
    own, like = _LIKE.get(test.name, ("", ""))
    if not known and not like:
        return
    level = like or min(known, key=lambda one: _LEAST_INCHES[one])
    inches, top = _LEAST_INCHES[level], barrier._top
    least = units.inch(inches)
    if top < least - _ROUNDED:
        numbers = {"top": top, "least": least, "inches": inches}
        text = (
            _LOW_LIKE.format(level=own, like=like, **numbers)
            if like
            else _LOW.format(level=level, older=_OLDER.get(level, ""), **numbers)
        )
        yield Doubt("rail_height", least - top, text)


def level_cautions(cautions: Mapping[str, Sequence[str]], noun: str = "Test") -> tuple[str, ...]:
    """Return the cautions of a level: each once, after the tests that it is about if not of all.

    Parameters
    ----------
    cautions
        Test -> cautions of its rating.
    noun
        What a test is called, in the singular.
    """
    tests: dict[str, list[str]] = {}
    for test, of_test in cautions.items():
        for caution in of_test:
            tests.setdefault(caution, []).append(test)
    groups: dict[tuple[str, ...], list[str]] = {}
    for caution, names in tests.items():
        groups.setdefault(tuple(names), []).append(caution)
    common = groups.pop(tuple(cautions), [])
    own = (
        f"{noun}{'s' if len(names) > 1 else ''} {', '.join(names)}: {' '.join(of_tests)}"
        for names, of_tests in groups.items()
    )
    return (*common, *own)
