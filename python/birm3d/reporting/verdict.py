"""Verdict first: outcome, rating, loads, occupants, and how sure it is, each in one line."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Iterator, Sequence

from ..assessment import OccupantRisk, Rating
from ..assessment.criteria import Criterion
from ..result.element_loads import touched_elements
from ..result.event import outcome_words
from ..vehicle.title import kind_words
from .barrier_answers import foundation_answer, kept_words, movement_answer
from .blocks import Block, Caution, Section, Table, Text
from .class_bands import band_of, headline_table
from .evidence import beyond_tests
from .numbers import percent
from .study_case import ROADSIDE, Case, is_oblique
from .study_verdict import study_answers, study_table
from .tests_verdict import answers_of_tests
from .uncertainty import computing_error
from .verdict_cautions import rating_cautions

__all__ = ["criteria_table", "risk_section", "verdict_section"]

_KNOWS = " knows: "  # in the error of a standard that does not know the vehicle
_FIRST_UNIT = "Motion and angles are those of the leading unit; a rating has the greatest roll of any."
_NO_BARRIER = "There is no barrier in this scene: nothing is rated."


def verdict_section(case: Case) -> Section:
    """Return the summary section: outcome, rating, greatest loads."""
    result = case.result
    blocks: list[Block] = [
        Table("At a glance", ("question", "answer"), list(_glance(case))),
        headline_table(result, case.bands),
        *([Text(_FIRST_UNIT)] if len(result.scene.vehicle.units) > 1 else []),
    ]
    blocks += [Caution(f"The run gave a warning: {text}") for text in case.warnings]
    if not isinstance(case.bands, str):
        blocks.append(Caution(case.bands.prediction.caution))
    if result.scene.barrier is None:
        blocks.append(Text(_NO_BARRIER))
    blocks += [_rating_table(case, rating) for rating in case.ratings]
    table = study_table(case)
    if table is not None:
        blocks.append(table)
    if case.not_rated:
        rows = [(name, _reason(case, reason)) for name, reason in case.not_rated.items()]
        blocks.append(Table("Standards that do not rate this run", ("standard", "why"), rows))
    blocks += rating_cautions(case)
    return Section("Verdict", "verdict", blocks)


def criteria_table(caption: str, criteria: tuple[Criterion, ...]) -> Table:
    """Return values beside their limits."""
    rows = [(one.name, one.shown, one.limit, one.verdict) for one in criteria]
    return Table(caption, ("criterion", "value", "limit", "verdict"), rows)


def _rating_table(case: Case, rating: Rating) -> Table:
    """Return the criteria of a rating, with the bands of the class where there are some."""
    table = criteria_table(f"Rating, {rating.title}", rating.criteria)
    if isinstance(case.bands, str) or rating.standard not in case.bands.ratings:
        return table
    return _with_bands(table, case.bands.ratings[rating.standard].rows)


def _with_bands(table: Table, bands: Sequence[tuple[str, str, str, str, str]]) -> Table:
    """Return a table of criteria with the band of each, and the share of the vehicles that meets it."""
    found = {name: (band, share) for name, _, band, _, share in bands}
    rows = [(*row, *found.get(row[0], ("–", "–"))) for row in table.rows]
    return dataclasses.replace(
        table, head=(*table.head, "80 % of the class", "share of it within the limit"), rows=rows
    )


def _glance(case: Case) -> Iterator[tuple[str, str]]:
    result = case.result
    yield (
        "What happens to the vehicle?",
        f"{outcome_words(result.outcome)}: {result.outcome_detail}{_other_outcomes(case)}",
    )
    for rating in case.ratings:
        yield (
            f"Rating by {rating.standard}, indicative",
            f"{rating.designation} (vehicle {rating.vehicle_class}); {kept_words(result, rating)}, "
            f"{_penetration(rating)}{_chances(case, rating.standard)}",
        )
    if result.scene.barrier is not None and not case.ratings:
        yield "Rating, indicative", "none: " + "; ".join(_why_none(case))
    yield from study_answers(case)
    loads = touched_elements(result.element_loads)
    if loads:
        most = max(loads, key=lambda load: load.peak_force_50ms)
        yield (
            "What does the barrier have to carry?",
            f"up to {most.peak_force_50ms / 1e3:,.0f} kN (50-ms mean of the whole force){most.at_height} on "
            f"{most.name}, with an overturning moment of {most.peak_overturning_moment_50ms / 1e3:,.0f} kN m"
            f"{_load_band(case)}",
        )
    yield from movement_answer(case)
    yield from foundation_answer(case)
    yield "Would occupants be at risk?", _risk_line(case)
    yield "How well is it computed?", _computed_line(case)
    yield from beyond_tests(case)
    yield from answers_of_tests(case)


def _other_outcomes(case: Case) -> str:
    """Return the outcomes of the vehicles of the class, as the end of a line, where some differ."""
    if isinstance(case.bands, str):
        return ""
    outcomes = case.bands.prediction.outcomes
    if not any(word != case.result.outcome for word in outcomes):
        return ""
    shares = ", ".join(f"{outcome_words(word)} {share:.0%}" for word, share in outcomes.items())
    return f". Of {len(case.bands.prediction.study)} vehicles of the class: {shares}"


def _kind(case: Case) -> str:
    """Return kind and mass of the vehicle, by which standards know it."""
    vehicle = case.result.scene.vehicle
    return f"{kind_words(vehicle.kind or 'vehicle')} of {vehicle.mass:,.0f} kg"


def _why_none(case: Case) -> Iterator[str]:
    """Yield why no standard rates the run."""
    unknown = [name for name, reason in case.not_rated.items() if _KNOWS in reason]
    if unknown:
        yield f"{_kind(case)} is no test vehicle of {', '.join(unknown)}"
    yield from (f"{name}, see below" for name in case.not_rated if name not in unknown)
    if not case.not_rated:
        yield "no standard was asked for"


def _reason(case: Case, reason: str) -> str:
    """Return why a standard does not rate the run, without the argument that its error names."""
    text, _, vehicles = _without_value(reason).partition(_KNOWS)
    return f"it knows no {_kind(case)}, but {kind_words(vehicles)}" if vehicles else text


def _penetration(rating: Rating) -> str:
    distance = rating.penetration
    if rating.standard in ROADSIDE:
        return f"its furthest part {distance:.2f} m past the undeformed traffic face"
    if distance < 0.0:
        return f"its reference point stays {-distance:.2f} m short of the datum"
    return f"penetration {'' if rating.is_final else 'at least '}{distance:.2f} m"


def _without_value(reason: str) -> str:
    """Return the text of an error without the value that it received: the run is described elsewhere."""
    return re.split("[,;] got ", reason)[0]


def _chances(case: Case, standard: str) -> str:
    """Return what other vehicles of the class are rated, as the end of a line."""
    if isinstance(case.bands, str) or standard not in case.bands.ratings:
        return ""
    rated = case.bands.ratings[standard]
    shares = ", ".join(f"{name} {share:.0%}" for name, share in rated.probability.items())
    return f". Of {rated.runs} vehicles of the class: {shares}"


def _load_band(case: Case) -> str:
    force, moment = "peak_element_force_50ms", "peak_overturning_moment_50ms"
    if isinstance(case.bands, str) or force not in case.bands.prediction.low:
        return ""
    own, high = case.result.metrics, case.bands.prediction.high
    most = [f"{max(own[name], high[name]) / 1e3:,.0f}" for name in (force, moment)]
    return (
        f"; 80 % of the class: {band_of(case.bands, force, 1e3, ',.0f')} kN on the most loaded element; "
        f"upper ends {most[0]} kN and {most[1]} kN m"
    )


def _risk_line(case: Case) -> str:
    if isinstance(case.risk, str):
        return f"not computed: {_without_value(case.risk)}"
    asked = [one.standard for one in case.ratings if one.standard in ("MASH", "EN 1317")]
    known = "EN 1317" if is_oblique(case.result) and not case.risk.missing else "MASH"
    standard = asked[0] if asked else known
    failed = [one.name for one in case.risk.criteria if one.passed is False and _judges(standard, one)]
    others = ""
    if not isinstance(case.bands, str) and case.bands.risk is not None:
        found = case.bands.risk
        good = round(found.passed(standard) * len(found.risks))
        others = f". {good} of {len(found.risks)} vehicles of the class meet all of them"
    if case.risk.is_heavy:
        told = f"{standard} does not judge this for so heavy a vehicle"
        if failed and not asked:
            return f"{told}; its limits for cars and pickups are exceeded: {', '.join(failed)}{others}"
        return f"{told}; every value is in the section on occupants"
    if not failed:
        met = f"the limits of {standard} are met; severity and every value are in the section on occupants"
        return f"{met}{others}"
    return f"limits of {standard} are exceeded: {', '.join(failed)}{others}"


def _judges(standard: str, criterion: Criterion) -> bool:
    """Whether a standard has this criterion; limits of superseded editions are no part of the verdict."""
    return f"({standard}" in criterion.name and ":1998" not in criterion.name


def _computed_line(case: Case) -> str:
    metrics = case.result.metrics
    text = (
        f"energy closes to {percent(metrics['energy_residual'])} of the initial kinetic energy, momentum to "
        f"{percent(metrics['momentum_residual'])} of the greatest force"
    )
    worst = max((error for *_, error in computing_error(case) if error is not None), default=None)
    return text if worst is None else f"{text}; headline numbers change by at most {worst:.2%} when refined"


def risk_section(case: Case) -> Section:
    """Return what the occupants undergo."""
    from ..assessment.risk_values import CAUTION

    if isinstance(case.risk, str):
        return Section("Occupant risk", "occupants", [Text(f"Not computed: {_without_value(case.risk)}.")])
    strike = case.risk.time_of_strike
    when = (
        "The occupant strikes nothing."
        if strike is None
        else (f"The occupant strikes the compartment {strike * 1e3:.1f} ms after the first touch.")
    )
    blocks: list[Block] = [
        Text(when),
        *map(Caution, case.risk.notes),
        _risk_table(case, case.risk),
        *(Text(text) for text in case.risk.missing),
        Caution(CAUTION),
    ]
    return Section("Occupant risk", "occupants", blocks)


def _risk_table(case: Case, risk: OccupantRisk) -> Table:
    """Return the values beside their limits, with the bands of the class where there are some."""
    table = criteria_table("Occupant risk, each value beside its limit", risk.criteria)
    if isinstance(case.bands, str) or case.bands.risk is None:
        return table
    return _with_bands(table, case.bands.risk.rows)
