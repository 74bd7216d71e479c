"""Shares of a study's runs with each outcome, each rating and each criterion met, with their intervals."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping

from ..assessment import RatingStudy
from ..assessment.probability import why_missing
from ..result.event import PAST, outcome_words
from ..study import Study
from .blocks import Table
from .shares import cells_of_share, interval_of_share, share_of_runs, study_note
from .study_case import Case, why_not_rated

__all__ = ["study_answers", "study_table"]


def study_answers(case: Case) -> Iterator[tuple[str, str]]:
    """Yield the outcomes and ratings of the study's runs, each as question and answer."""
    study = case.study
    if study is None:
        return
    ended = sum(study.outcomes.values())
    if ended:
        failed = f"; {len(study) - ended} runs failed and are left out" if ended < len(study) else ""
        yield (
            f"What happens in the {len(study):,} runs of the study?",
            f"{_shares(study, {outcome_words(word): n for word, n in study.outcomes.items()})}{failed}",
        )
    rated = case.rating_study
    if rated is not None:
        yield (
            f"Rating of these runs by {rated.ratings[0].standard}, indicative",
            f"{_shares(study, rated.counts)}",
        )
    elif case.ratings:
        yield "Rating of these runs", f"none: {why_not_rated(study) or 'the standard can rate none of them'}"


def study_table(case: Case) -> Table | None:
    """Return the share of the study's runs that meets each criterion, beside the verdict on this run."""
    study, rated = case.study, case.rating_study
    if study is None or rated is None:
        return None
    standard = rated.ratings[0].standard
    rating_of_run = next(one for one in case.ratings if one.standard == standard)
    bands = {name: (median, band) for name, median, band, _, _ in rated.rows}
    rows: list[tuple[str, ...]] = []
    for one in rating_of_run.criteria:
        same = [c for rating in rated.ratings for c in rating.criteria if c.name == one.name]
        judged = [c.passed for c in same if c.passed is not None]
        met = cells_of_share(study, sum(judged), len(judged)) if judged else ("reported", "–")
        rows.append((one.name, one.verdict, *bands.get(one.name, ("–", "–")), *met))
    rows += _all_of_these(study, rated, "pass" if rating_of_run.passed else "FAIL")
    return Table(
        f"The study beside the verdict by {standard}, indicative: {len(rated.ratings):,} of {len(study):,} "
        "runs are rated",
        (
            "criterion",
            "this run",
            "median of the runs",
            "80 % of the runs",
            "runs that meet it",
            "95 % interval",
        ),
        rows,
        note=f"{study_note(study)}{_of_speed(study)}",
    )


def _all_of_these(study: Study, rated: RatingStudy, word: str) -> Iterator[tuple[str, ...]]:
    """Yield the share of the runs that meet everything, and why others are not among these.

    A run that does not meet the conditions of the standard is no failure of the barrier.
    """
    judged = [rating for rating in rated.ratings if not rating.unmet]
    if judged:
        met = cells_of_share(study, sum(rating.passed for rating in judged), len(judged))
        behind = any(rating.contained and rating.outcome in PAST for rating in judged)
        kept = "contained or at rest behind the barrier" if behind else "contained"
        yield f"all of these, and {kept}", word, "–", "–", *met
    whys = Counter(", ".join(rating.unmet) for rating in rated.ratings if rating.unmet)
    whys += Counter(why_missing(reason) for reason in rated.failed.values())
    if whys:
        told = "; ".join(f"{why} {count:,}" for why, count in whys.most_common())
        yield (
            "without a verdict by the standard",
            "–",
            "–",
            "–",
            f"{whys.total():,} of {rated.runs:,}: {told}",
            "–",
        )


def _of_speed(study: Study) -> str:
    """Return why a class is no property of the barrier alone, where the speed differs."""
    if "impact_speed" not in study.parameters:
        return ""
    return " Each run is rated at the level of its own speed, so a lower level may only mean a slower run."


def _shares(study: Study, counts: Mapping[str, int]) -> str:
    n = sum(counts.values())
    parts = []
    for name, count in sorted(counts.items(), key=lambda one: -one[1]):
        interval = f" (95 % interval {interval_of_share(count, n)})" if study.grid is None else ""
        parts.append(f"{name} in {count:,} of {n:,}, {share_of_runs(count, n)}{interval}")
    return "; ".join(parts)
