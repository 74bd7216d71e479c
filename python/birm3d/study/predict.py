"""Bands of what a scene does, from how the vehicles of a class differ."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from html import escape
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import pictures
from ..base.arguments import checked
from ..base.frozen_mapping import FrozenMapping
from ..result.event import outcome_words
from ..result.metric_table import METRICS
from ..result.summary import shown_as
from ..scene.text import scene_text
from ..simulation.simulation import Simulation
from .class_draws import check_draws, drawn_parameters, zones_set
from .counted import counted, is_count
from .runner import run_study
from .table import Study

__all__ = ["SHARE", "Prediction", "predict", "quantiles"]

Floats = npt.NDArray[np.float64]

SHARE = 0.8
"""Of the draws within a band."""
_BLOW = 2.0
"""Unfiltered over filtered peak of a force above which a rigid body has struck."""
_SMALL_OVERLAP = 0.4
"""Of the vehicle's width, as in the tests that the band was held beside."""
_NO_ANSWERS = ("balance", "effort")
"""Kinds of metrics that say how a run was computed."""
_LARGE = 1e4  # values from here on have no decimals
_ROUNDING = 1e-9

_CLASS = "The bands are those of vehicles of one class in this scene; errors of the model come on top."
_STRUCK = (
    "In {n} of {all} draws nothing was left to crush at some place and the rigid body struck: unfiltered "
    "peaks are blows of rigid bodies there. Take the 50-ms means."
)
_UNTOUCHED = "In {n} of {all} draws the vehicle does not touch the barrier."
_ACROSS = (
    "The overlap is small: of 150 tests at 25 % overlap, bands of the change of velocity across the vehicle "
    "hold 42 to 62 % from 100 ms on."
)

_SET = (
    "The law of {zones} was set by the user. Its band is centred on this vehicle and as wide as that of the "
    "class."
)


class Prediction:
    """Metrics with bands; made by :func:`predict`.

    Attributes
    ----------
    median, low, high : mapping of str to float
        Each metric that at least half of the draws have, SI and degrees. Between low and high are `share` of
        the draws, as many below as above.
    share : float
    drawn : tuple of str
        Parameters of the scene that were drawn, see :mod:`birm3d.scene_parameters`.
    study : Study
        The runs. :func:`birm3d.rate` takes the prediction and gives each class a probability.
    """

    def __init__(self, study: Study, share: float) -> None:
        self.study = study
        self.share = share
        self.drawn = tuple(study.parameters)
        bands = {}
        for name, values in study.metrics.items():
            known = values[np.isfinite(values)]
            if 2 * len(known) >= len(values):
                bands[name] = quantiles(known, share)
        self.low, self.median, self.high = (
            FrozenMapping({name: band[i] for name, band in bands.items()}) for i in range(3)
        )

    @property
    def outcomes(self) -> Mapping[str, float]:
        """Share of the draws that ended in each outcome, the greatest first."""
        counts = Counter(outcome for outcome in self.study.outcome if outcome)
        return FrozenMapping({name: n / len(self.study) for name, n in counts.most_common()})

    def summary(self) -> str:
        """Return all bands as text."""
        rows = [self._title]
        rows += [f"  {share:4.0%} {words}" for words, share in self._shares()]
        rows.append(f"  {'metric':<28}{'low':>13}{'median':>13}{'high':>13}")
        for name, *numbers in self._answers():
            _, size, unit = shown_as(name)
            cells = "".join(f"{_shown(number / size):>13}" for number in numbers)
            rows.append(f"  {name:<28}{cells} {unit}".rstrip())
        rows.append(f"  drawn: {', '.join(self.drawn)}; mass, speed and barrier as given")
        rows.append(f"  Caution: {self.caution}")
        return "\n".join(rows)

    @property
    def _title(self) -> str:
        scene = self.study._scene
        head = self.study.title if scene is None else scene_text(scene)
        return f"{head}; {100 * self.share:g} % bands of {len(self.study)} vehicles of the class"

    def _shares(self) -> Iterator[tuple[str, float]]:
        """Yield each outcome, and each event that is counted, with the share of the draws that have it."""
        yield from ((outcome_words(word), share) for word, share in self.outcomes.items())
        for one in counted(self.study):
            yield f"with {one.words}", one.runs / one.n

    def _answers(self) -> Iterator[tuple[str, float, float, float]]:
        """Yield the metrics that say what happens, with their bands; rounding errors are 0."""
        for name in self.median:
            if METRICS[name].error not in _NO_ANSWERS and not is_count(name):
                low, middle, high = (
                    0.0 if abs(band[name]) < _ROUNDING else band[name]
                    for band in (self.low, self.median, self.high)
                )
                yield name, low, middle, high

    @property
    def caution(self) -> str:
        """What the bands rest on, where it matters in this scene."""
        told = [_CLASS]
        metrics = self.study.metrics
        if {"peak_normal_force", "peak_normal_force_cfc60"} <= metrics.keys():
            raw, filtered = metrics["peak_normal_force"], metrics["peak_normal_force_cfc60"]
            struck = int(np.count_nonzero(raw > _BLOW * filtered))
            if struck:
                told.append(_STRUCK.format(n=struck, all=len(self.study)))
        scene = self.study._scene
        changed = () if scene is None else zones_set(scene.vehicle)
        if changed:
            told.append(_SET.format(zones=", ".join(changed)))
        if scene is not None and scene.barrier is not None and "peak_element_force" in metrics:
            untouched = int(np.count_nonzero(metrics["peak_element_force"] == 0.0))
            if untouched:
                told.append(_UNTOUCHED.format(n=untouched, all=len(self.study)))
        overlap = None if scene is None else scene.overlap
        if overlap is not None and overlap <= _SMALL_OVERLAP:
            told.append(_ACROSS)
        return " ".join(told)

    __str__ = summary

    def to_dict(self) -> dict[str, Any]:
        """Return all of it as plain values, SI."""
        bands = {
            name: {"low": self.low[name], "median": self.median[name], "high": self.high[name]}
            for name in self.median
        }
        return {
            "share": self.share,
            "outcomes": dict(self.outcomes),
            "metrics": bands,
            "drawn": list(self.drawn),
            "caution": self.caution,
        }

    def _repr_html_(self) -> str:
        """Return what notebooks show: shares of outcomes, bands in the units of other tables, caution."""
        rows: list[tuple[str, ...]] = [(words, "", f"{share:.0%}", "", "") for words, share in self._shares()]
        for name, *numbers in self._answers():
            label, size, unit = shown_as(name)
            rows.append((label, *(_shown(number / size) for number in numbers), unit))
        table = pictures.table_html(("metric", "low", "median", "high", "unit"), rows)
        return f"<div><b>{escape(self._title)}</b>{table}<div>Caution: {escape(self.caution)}</div></div>"

    def __repr__(self) -> str:
        return f"Prediction({len(self.study)} runs, {self.share:.0%} bands, {dict(self.outcomes)})"


@checked
def predict(
    simulation: Simulation,
    n: int = 32,
    *,
    share: float = SHARE,
    metrics: Sequence[str] | None = None,
    executor: Any = None,
    progress: bool | None = None,
) -> Prediction:
    """Run a scene with what is not known of a vehicle drawn as its class scatters.

    Drawn are forces of front, side and corner, height of the mass centre, friction and tyres. Of a vehicle
    that :meth:`birm3d.Vehicle.from_facts` made, sizes and inertias that it assumed are drawn, too. Each is
    lognormal, by the blocks ``[[scatter]]`` of the vehicle's file (:attr:`birm3d.Vehicle.scatter`). A median
    there may differ from 1, where the class differs from the vehicle that a preset was fitted to. Then the
    median of a metric is not the value of the scene itself. Laws of zones that differ from the file, as those
    of a calibrated vehicle, are known better than by their class: their median is 1. Mass, speed, angle and
    barrier are those of the scene.

    The draws are the first n points of Sobol's sequence, one dimension for each quantity, whatever the scene.
    So two predictions differ by their scenes and not by chance (common random numbers).

    Parameters
    ----------
    simulation
        The scene.
    n
        Number of draws, a power of 2 from 8 to 1,024.
    share
        Of the draws within the band, 0 < share < 1.
    metrics, executor, progress
        See :func:`birm3d.study.runner.run_study`.

    Raises
    ------
    ValueError
        If a number is out of range, or the file of the vehicle says nothing of its class.
    """
    power = check_draws("n", n)
    if not 0.0 < share < 1.0:
        raise ValueError(f"share must be > 0 and < 1, got {share}")
    columns = drawn_parameters(simulation, power)
    study = run_study(
        simulation,
        tuple(columns),
        np.column_stack(list(columns.values())),
        metrics=metrics,
        executor=executor,
        progress=progress,
        title="prediction",
    )
    return Prediction(study, share)


def _shown(value: float) -> str:
    return f"{value:,.0f}" if abs(value) >= _LARGE else f"{value:.4g}"


def quantiles(values: Floats, share: float) -> tuple[float, float, float]:
    """Return low end, median and high end of a band with a share of values that stand for equal parts."""
    ends = np.quantile(values, [0.5 - 0.5 * share, 0.5, 0.5 + 0.5 * share], method="hazen")
    return (float(ends[0]), float(ends[1]), float(ends[2]))
