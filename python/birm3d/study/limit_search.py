"""The greatest or least value of a parameter at which a barrier still meets its criterion.

A coarse scan of the whole range comes first, then bisection of the change that governs. An outcome need not
be monotonic. Therefore the answer counts from the safe end of the range: all values tried up to it hold.
"""

# Longer than 300 lines: one search with its answer, its table and its text.
from __future__ import annotations

import math
import warnings
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from .. import pictures
from ..base.frozen_mapping import FrozenMapping
from ..base.plain_words import plain_words
from ..base.text_table import aligned
from ..result.event import outcome_words
from ..result.run_warnings import worst_doubts
from ..simulation.parameters import varied
from ..simulation.simulation import Simulation
from ..units import Quantity, si
from .distributions import check_count
from .limit_class import class_shares, drawn_vehicles
from .limit_question import Question
from .runner import StudyInterrupted, run_study
from .table import Study

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

__all__ = ["Effort", "Limit", "NotInRangeError", "Question", "SearchRun", "search_limit"]


class SearchRun(NamedTuple):
    """A run of a search.

    Attributes
    ----------
    value : float
        Of what is searched.
    impact_offset : float
        [m].
    outcome : str
        See :mod:`birm3d.result.event`.
    measure : float
        What has a limit, as the penetration [m]; NaN where the run has none.
    holds : bool
        Whether the barrier did what it should.
    """

    value: float
    impact_offset: float
    outcome: str
    measure: float
    holds: bool


class Effort(NamedTuple):
    """How closely a search looks, and where its runs are made; :func:`birm3d.greatest_gap` explains each."""

    points: int
    resolution: Quantity | None
    draws: int | None
    executor: Any
    progress: bool | None


class NotInRangeError(ValueError):
    """No value of the range holds from its safe end on; ``runs`` has all runs, ``study`` their table."""

    def __init__(self, message: str, runs: tuple[SearchRun, ...], study: Study) -> None:
        super().__init__(message)
        self.runs = runs
        self.study = study

    def __reduce__(self) -> tuple[Any, ...]:
        return (type(self), (self.args[0], self.runs, self.study))


class Limit:
    """The greatest (or least) value at which a barrier still meets its criterion.

    Attributes
    ----------
    question : Question
        What was asked, see :mod:`birm3d.study.limit_question`.
    name : str
        What was searched, as ``"clear gap"``.
    unit : str
    value : float
        The last value that holds, counted from the safe end of the range; all that were tried on the way
        hold.
    fails_at : float or None
        The nearest value tried beyond it, which does not hold; ``None``: all of the range holds, and the
        limit lies beyond it.
    resolution : float
        Width that the bisection stops at, >= ``abs(fails_at - value)``.
    monotonic : bool
        Whether no value tried beyond ``fails_at`` holds again. Where one does, it is in ``exceptions``.
    exceptions : tuple of float
        Values beyond ``fails_at`` that hold again.
    criterion : str
        When a value holds.
    caution : str
        What the model leaves out that bears on the answer.
    class_shares : mapping of float to float
        The limit, and values tried on its safe side -> share of the vehicles of the class for which it holds.
        It ends at the first that holds for all, or after five. Empty where none were drawn.
    draws : int
        Number of those vehicles.
    greatest : bool
        Whether the greatest value was sought.
    runs : tuple of SearchRun
        All of them, by value and offset.
    study : Study
        The same with their metrics, in the order in which they were made.
    """

    def __init__(
        self,
        question: Question,
        value: float,
        fails_at: float | None,
        resolution: float,
        runs: tuple[SearchRun, ...],
        study: Study,
        class_shares: Mapping[float, float] | None = None,
        draws: int = 0,
        remark: str = "",
    ) -> None:
        self.question, self._remark = question, remark
        self.class_shares, self.draws = FrozenMapping(dict(class_shares or {})), draws
        self.value, self.fails_at, self.resolution = value, fails_at, resolution
        self.runs, self.study = runs, study
        holds = _held(runs)
        beyond = [v for v, held in holds.items() if held and (v > value if question.greatest else v < value)]
        self.exceptions = tuple(beyond)
        self.monotonic = not beyond

    @property
    def name(self) -> str:
        """What was searched."""
        return self.question.name

    @property
    def unit(self) -> str:
        """Of the values."""
        return self.question.unit

    @property
    def greatest(self) -> bool:
        """Whether the greatest value was sought."""
        return self.question.greatest

    @property
    def criterion(self) -> str:
        """When a value holds."""
        return self.question.criterion

    @property
    def measure(self) -> str:
        """Metric that may have a limit."""
        return self.question.measure

    @property
    def most(self) -> float | None:
        """Its greatest value that holds; ``None``: any."""
        return self.question.most

    @property
    def caution(self) -> str:
        """What the model leaves out that bears on the answer."""
        return self.question.caution + self._remark

    @property
    def at_bound(self) -> bool:
        """Whether all of the range holds: the limit lies beyond it."""
        return self.fails_at is None

    def to_dataframe(self) -> pd.DataFrame:
        """Return all runs, SI.

        Raises
        ------
        ImportError
            If pandas is not installed.
        """
        import pandas as pd

        names = [self.name.replace(" ", "_"), "impact_offset", "outcome", self.measure, "holds"]
        return pd.DataFrame(list(self.runs), columns=names)

    def to_dict(self) -> dict[str, Any]:
        """Return all of it as plain values, SI; what a run does not have is ``None``."""
        names = ("name", "unit", "value", "fails_at", "resolution", "monotonic", "exceptions", "criterion")
        shares = [[value, share] for value, share in self.class_shares.items()]
        runs = [run._asdict() for run in self.runs]
        for run in runs:
            run["measure"] = None if math.isnan(run["measure"]) else run["measure"]
        return {
            **{name: getattr(self, name) for name in names},
            "class_shares": shares,
            "draws": self.draws,
            "caution": self.caution,
            "runs": runs,
        }

    def summary(self) -> str:
        """Return the answer, how sure it is, and the worst run of each value as text."""
        head = (
            f"{self.name} [{self.unit}]",
            "runs that hold",
            "worst offset [m]",
            "outcome",
            self.question.measure_label,
            "",
        )
        cells = [head]
        for value, runs in _by_value(self.runs).items():
            worst = min(runs, key=lambda run: (run.holds, -run.measure if run.measure >= 0.0 else -math.inf))
            cells.append(
                (
                    f"{value:.6g}",
                    f"{sum(run.holds for run in runs)} of {len(runs)}",
                    f"{worst.impact_offset:.4g}",
                    outcome_words(worst.outcome),
                    "" if math.isnan(worst.measure) else f"{worst.measure:.3f}",
                    "holds" if worst.holds else "fails",
                )
            )
        return "\n".join([self.headline, self.study.scene_title, *self.remarks, "", *aligned(cells)])

    __str__ = summary

    @property
    def headline(self) -> str:
        """The answer in one line."""
        word = "greatest" if self.greatest else "least"
        shown = f"{self._rounded(self.value)} {self.unit}"
        if self.fails_at is None:
            bound = "at least" if self.greatest else "at most"
            return f"{word} {self.name}: {bound} {shown}, the end of the range"
        return (
            f"{word} {self.name}: {shown} holds, {self._rounded(self.fails_at, fails=True)} {self.unit} fails"
        )

    def _rounded(self, value: float, *, fails: bool = False) -> str:
        """Return a value to a quarter of the resolution or finer: what holds to the safe side."""
        digits = max(0, math.ceil(-math.log10(0.25 * self.resolution)))
        scaled = value * 10.0**digits
        rounded = math.floor(scaled + 1e-6) if self.greatest != fails else math.ceil(scaled - 1e-6)
        return f"{rounded / 10.0**digits:.{digits}f}"

    @property
    def remarks(self) -> list[str]:
        """What the answer depends on, a sentence each."""
        values = len(_held(self.runs))
        lines = [f"Holds: {self.criterion}. {len(self.runs)} runs at {values} values."]
        if self.exceptions:
            those = ", ".join(f"{value:.6g}" for value in self.exceptions)
            lines.append(
                f"Not monotonic: {those} {self.unit} holds again. The answer is before the first failure."
            )
        else:
            lines.append(
                "Monotonic at the values tried. A change and its reverse between two of them can be missed."
            )
        past = [run.measure for run in self.runs if run.value == self.value and run.measure > 0.0]
        if self.measure == "vehicle_penetration" and past:
            lines.append(
                f"At {self._rounded(self.value)} {self.unit} the rigid body gets up to {max(past):.2f} m "
                "past the barrier's line, or behind its end. `penetration` limits that."
            )
        ends = sum(run.holds and run.outcome == "passed" for run in self.runs)
        if ends:
            lines.append(
                f"In {ends} of the runs that hold the vehicle passes the barrier's end: give it more length."
            )
        return [*lines, self.band, f"Caution: {self.caution}"]

    @property
    def band(self) -> str:
        """A sentence: for how many vehicles of the class the limit holds, and from where on for all."""
        if not self.class_shares:
            return "No band: the answer is that of this one vehicle."
        texts = [
            f"{share:.0%} at {self._rounded(value)} {self.unit}" for value, share in self.class_shares.items()
        ]
        return f"Of {self.draws} vehicles of the class it holds for {', '.join(texts)}."

    def plot(self) -> Figure:
        """Return all runs over what was searched, and the limit."""
        return pictures.plot_limit(self)

    def _repr_html_(self) -> str:
        return pictures.text_html(self.summary(), self.plot(), self.name)

    def __repr__(self) -> str:
        return f"Limit({self.headline}; {len(self.runs)} runs)"


def search_limit(
    simulation: Simulation, question: Question, limits: Sequence[Quantity], effort: Effort
) -> Limit:
    """Scan a range, then bisect between the last value that holds and the first that does not.

    Raises
    ------
    ValueError
        If the range, the number of points or the resolution is none, or a run can not be made.
    NotInRangeError
        If the safe end of the range does not hold.
    StudyInterrupted
        With the finished runs.
    """
    low, high = _range(question, limits)
    check_count("points", effort.points, least=2)
    resolution = (high - low) / 100.0
    if effort.resolution is not None:
        resolution = si("resolution", effort.resolution, question.quantity)
    if not 0.0 < resolution < math.inf:
        raise ValueError(f"resolution must be finite and > 0 {question.unit}, got {resolution}")
    vehicles = drawn_vehicles(simulation, effort.draws)
    studies: list[Study] = []
    runs: list[SearchRun] = []

    def tried(values: Sequence[float]) -> list[bool]:
        """Run values and return which of them hold."""
        rows = [(value, offset) for value in values for offset in question.offsets(value)]
        try:
            study = run_study(
                simulation,
                (question.parameter, "impact_offset"),
                [(question.of_value(value), offset) for value, offset in rows],
                metrics=[question.measure],
                executor=effort.executor,
                progress=effort.progress if len(values) > 1 else False,
                title=question.name,
            )
        except StudyInterrupted as stopped:
            raise StudyInterrupted(str(stopped), Study.joined([*studies, stopped.study])) from None
        studies.append(study)
        new = [_judged(question, row, study, i) for i, row in enumerate(rows)]
        runs.extend(new)
        held = _held(new)
        return [held[value] for value in values]

    grid = np.linspace(low, high, effort.points).tolist()
    order = grid if question.greatest else grid[::-1]
    flags = dict(zip(grid, tried(grid), strict=True))
    first = next((i for i, value in enumerate(order) if not flags[value]), None)
    if first == 0:
        raise _not_in_range(question, order, flags, tuple(sorted(runs)), Study.joined(studies))
    value, fails_at = order[-1 if first is None else first - 1], None if first is None else order[first]
    while fails_at is not None and abs(fails_at - value) > resolution:
        middle = 0.5 * (value + fails_at)
        if middle in (value, fails_at):
            break  # nothing is between two neighbours
        if tried([middle])[0]:
            value = middle
        else:
            fails_at = middle
    shares = _shares(simulation, question, vehicles, value, order, effort.executor)
    all_runs, joined = tuple(sorted(runs)), Study.joined(studies)
    draws = len(next(iter(vehicles.values()), ()))
    remark = _doubts(simulation, question, value)
    if question.remark is not None:
        remark = question.remark(simulation, question, value, effort.executor) + remark
    return Limit(question, value, fails_at, resolution, all_runs, joined, shares, draws, remark)


def _doubts(simulation: Simulation, question: Question, value: float) -> str:
    """Return why the outcomes at a value can not be relied on, as sentences that go on from a caution."""
    runs = (
        varied(simulation, {question.parameter: question.of_value(value), "impact_offset": offset}).run()
        for offset in question.offsets(value)
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the search has given them
        return "".join(f" At {value:.6g} {question.unit}: {line}" for line in worst_doubts(runs))


def _shares(
    simulation: Simulation,
    question: Question,
    vehicles: Mapping[str, Sequence[float]],
    value: float,
    order: Sequence[float],
    executor: Any,
) -> dict[float, float]:
    """Return for how many vehicles of the class the limit holds, and values of the scan on its safe side."""
    safer = [one for one in reversed(order) if (one < value if question.greatest else one > value)]
    try:
        return class_shares(
            simulation,
            vehicles,
            [value, *safer],
            question,
            executor,
        )
    except StudyInterrupted:
        return {}  # the search itself is done


def _judged(question: Question, row: tuple[float, float], study: Study, run: int) -> SearchRun:
    value, offset = row
    if study.error[run]:
        raise ValueError(
            f"{question.argument} must be values that can be run, got {value:g} {question.unit}: "
            f"{study.error[run]}"
        )
    measure = float(study[question.measure][run])
    return SearchRun(value, offset, study.outcome[run], measure, question.holds(study.outcome[run], measure))


def _by_value(runs: Sequence[SearchRun]) -> dict[float, list[SearchRun]]:
    found: dict[float, list[SearchRun]] = {}
    for run in runs:
        found.setdefault(run.value, []).append(run)
    return found


def _held(runs: Sequence[SearchRun]) -> dict[float, bool]:
    """Return which values hold at all their offsets."""
    return {value: all(run.holds for run in those) for value, those in _by_value(runs).items()}


def _not_in_range(
    question: Question,
    order: Sequence[float],
    flags: dict[float, bool],
    runs: tuple[SearchRun, ...],
    study: Study,
) -> NotInRangeError:
    end = "least" if question.greatest else "greatest"
    others = [f"{value:.6g}" for value in order if flags[value]]
    also = f"; {', '.join(others)} {question.unit} hold, which is not monotonic" if others else ""
    worst = next(run for run in runs if run.value == order[0] and not run.holds)
    where = f"{outcome_words(worst.outcome)} at offset {worst.impact_offset:.4g} m"
    measured = ""
    if not math.isnan(worst.measure):
        measured = f", {plain_words(question.measure)} {question.measured(worst.measure, '.3f')}"
    return NotInRangeError(
        f"{question.argument} must have a {end} value that holds ({question.criterion}), got "
        f"{order[0]:.6g} {question.unit}: {where}{measured}{also}",
        runs,
        study,
    )


def _range(question: Question, given: Sequence[Quantity]) -> tuple[float, float]:
    limits = [si(question.argument, value, question.quantity) for value in given]
    if len(limits) != 2 or not 0.0 < limits[0] < limits[1] < math.inf:
        shown = tuple(limits)
        raise ValueError(
            f"{question.argument} must be (least, greatest), finite, > 0 {question.unit} and increasing; "
            f"got {shown}"
        )
    return float(limits[0]), float(limits[1])
