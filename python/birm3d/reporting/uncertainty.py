"""How sure it is: computing error, and the spread of a study."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from .. import units
from ..base.shown_numbers import shown_unit
from ..result.metrics import METRIC_UNITS
from ..result.summary import HEADLINES, shown_as
from ..study import Study
from ..study.history_bands import history_bands
from ..study.shown_columns import parameter_words
from .blocks import Block, Caution, Section, Table, Text
from .class_bands import class_blocks
from .figures import figure
from .numbers import percent
from .shares import cells_of_share, outcome_table, study_note
from .study_case import Case

__all__ = ["computing_error", "uncertainty_section"]

_ROUNDING = 1e-9  # angles and lengths below are rounding errors
_LEAST_RUNS, _MOST_RUNS = 8, 300  # of a study whose histories are drawn as bands
_NOTHING = 1e-6  # a metric as small as this has no relative error
# Differences of smaller values are shares of these: a millimetre of 4 cm is no error of 2.5 %.
_LEAST_SCALE = {"m": 0.5, "deg": 5.0, "m/s": 1.0, "m/s^2": units.g}


def computing_error(case: Case) -> Iterator[tuple[str, float, float, float | None]]:
    """Yield metric, value, value with a hundredth of the tolerance, and the relative difference.

    Differences of values smaller than 0.5 m, 5 degrees, 1 m/s and 1 g are relative to these.
    """
    ours, finer = case.result.metrics, case.finer.metrics
    for name in HEADLINES:
        if name in ours and name in finer:
            value, better = (0.0 if abs(x) < _ROUNDING else x for x in (ours[name], finer[name]))
            scale = max(abs(better), _LEAST_SCALE.get(METRIC_UNITS.get(name, ""), 0.0))
            error = abs(value - better) / scale if abs(better) > _NOTHING else None
            yield name, value, better, error


def uncertainty_section(case: Case) -> Section:
    """Return computing error, scatter of vehicles and what a study says."""
    settings = case.result.scene.settings
    how = (
        f"a fixed step of {settings.time_step:g} s"
        if settings.time_step
        else f"steps chosen by a tolerance of {settings.tolerance:g}"
    )
    rows = []
    for name, value, better, error in computing_error(case):
        label, size, unit = shown_as(name)
        difference = percent(0.0 if error is None else error)
        rows.append((label, f"{value / size:.5g}", f"{better / size:.5g}", unit, difference))
    blocks: list[Block] = [
        Text(
            f"Computing error: the run has {how}. The same scene was run once more with a tolerance of "
            f"{case.finer.scene.settings.tolerance:g}."
        ),
        Table(
            "Computing error of the headline numbers",
            ("quantity", "this run", "refined", "unit", "relative difference"),
            rows,
            note="Smaller values than 0.5 m, 5 deg, 1 m/s and 1 g: relative to these.",
            numbers=True,
        ),
        Caution(
            "The error of the model is larger than that of the computation. Vehicles of one class differ: "
            "displacements of tests at 56 km/h scatter by about 20 % either way. The table of given tests "
            "shows errors of this model in tests like this scene."
        ),
        *class_blocks(case.result, case.bands),
    ]
    if case.study is None:
        blocks.append(
            Text(
                "No study was given: speed, angle, mass and barrier are those of one run. Spread of these "
                "inputs comes from birm3d.monte_carlo(), birm3d.sweep() and dossier(result, folder, "
                "study=study)."
            )
        )
    else:
        blocks += _study_blocks(case, case.study)
    return Section("Uncertainty", "uncertainty", blocks)


def _study_blocks(case: Case, study: Study) -> Iterator[Block]:
    failed = f"; {len(study.failed)} runs failed" if study.failed else ""
    yield Text(f"Study: {len(study):,} runs of {study.title}{failed}. These inputs were varied:")
    rows = []
    for name, values in study.parameters.items():
        size, unit = shown_unit(study.units.get(name, ""))
        if values.dtype.kind == "f":
            low, high = float(np.min(values)) / size, float(np.max(values)) / size
            rows.append((parameter_words(name), f"{low:.5g} to {high:.5g}", unit))
        else:
            kinds = ", ".join(dict.fromkeys(str(value) for value in values.tolist()))
            rows.append((parameter_words(name), kinds, unit))
    yield Table("Inputs of the study", ("input", "range", "unit"), rows)
    yield outcome_table(study, "Outcomes of the study")
    yield _percentiles(case, study)
    yield from _bands(study)
    if case.rating_study is not None:
        rated = case.rating_study
        shares = [(name, *cells_of_share(study, count, rated.runs)) for name, count in rated.counts.items()]
        drawn = "Probability of each class" if study.grid is None else "Share of the runs in each class"
        yield Table(
            f"{drawn} by {rated.ratings[0].standard}, indicative",
            ("class", "runs", "95 % interval"),
            shares,
            note=f"{len(rated.ratings):,} of {len(study):,} runs were rated. {study_note(study)}",
            numbers=True,
        )


def _bands(study: Study) -> Iterator[Block]:
    """Yield the bands of two histories, where a study has enough runs and knows its scenes."""
    ran = len(study) - len(study.failed)
    if study._scene is None or study.grid is not None or not _LEAST_RUNS <= ran <= _MOST_RUNS:
        return
    bands = history_bands(study, progress=False)
    caption = f"Deceleration and travel over time: median and {100 * bands.share:g} % of {bands.n} runs"
    yield figure(bands.plot(), caption, raster=True)


def _percentiles(case: Case, study: Study) -> Table:
    rows = []
    for name, found in study.summary().items():
        if name not in HEADLINES:
            continue
        label, size, unit = shown_as(name)
        own = case.result.metrics.get(name) if name in case.result.metrics else None
        numbers = (own, found.p05, found.median, found.p95, found.mean, found.standard_deviation)
        cells = ("–" if number is None else _cell(number, size) for number in numbers)
        rows.append((label, *cells, unit, f"{found.n:,}"))
    return Table(
        "Percentiles of the study beside this run",
        ("quantity", "this run", "5 %", "median", "95 %", "mean", "st. dev.", "unit", "runs"),
        rows,
        numbers=True,
    )


def _cell(number: float, size: float) -> str:
    """Return a number in a unit of a size; a rounding error is 0."""
    return "0" if abs(number) < _ROUNDING else f"{number / size:.4g}"
