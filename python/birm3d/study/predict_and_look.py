"""A prediction whose runs are looked at while they are there, so that none is run twice."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import TypeVar

import numpy as np

from ..result.metrics import METRIC_UNITS
from ..result.result import Result
from ..result.run_values import parts_of
from ..simulation.parameters import varied_scene
from ..simulation.simulation import Simulation
from .class_draws import check_draws, drawn_parameters
from .float_rows import FloatRows
from .outcome_table import OutcomeTable
from .predict import SHARE, Prediction
from .runner import checked_metrics
from .store import Outcome
from .table import Study
from .whole_runs import look_at_runs

__all__ = ["predict_and_look"]

Found = TypeVar("Found")


def predict_and_look(
    simulation: Simulation, n: int, look: Callable[[Result], Found]
) -> tuple[Prediction, dict[int, Found], dict[int, str]]:
    """Return the prediction of a scene, and what a function finds in each of its runs: each is run once.

    Parameters
    ----------
    simulation, n
        See :func:`predict`.
    look
        Called with the result of each run, which is then deleted.

    Returns
    -------
    prediction : Prediction
    found : dict of int to Found
        Number of each run -> what was found in it.
    failed : dict of int to str
        Number of each run that failed -> its reason.
    """
    columns = drawn_parameters(simulation, check_draws("n", n))
    scene, rows = simulation.scene, np.column_stack(list(columns.values()))
    wanted = checked_metrics(None, parts_of(scene))
    scenes = [varied_scene(scene, dict(zip(columns, map(float, row), strict=True))) for row in rows]
    outcomes = OutcomeTable(len(wanted), len(rows))
    found: dict[int, Found] = {}
    failed: dict[int, str] = {}
    for seen in look_at_runs(scenes, partial(_outcome_and, look, wanted), progress=False):
        if seen.found is None:
            failed[seen.run] = seen.error.removeprefix("ValueError: ")
            outcomes.update({seen.run: Outcome((math.nan,) * len(wanted), error=seen.error)})
        else:
            outcome, found[seen.run] = seen.found
            outcomes.update({seen.run: outcome})
    units = {name: METRIC_UNITS[name] for name in wanted}
    study = Study._of(scene, tuple(columns), FloatRows(rows), units, outcomes)
    return Prediction(study, SHARE), dict(sorted(found.items())), failed


def _outcome_and(
    look: Callable[[Result], Found], wanted: tuple[str, ...], result: Result
) -> tuple[Outcome, Found]:
    values = tuple(result.metrics.get(name, math.nan) for name in wanted)
    outcome = Outcome(values, result.end_reason, result.outcome, f"{result.state_hash:016x}")
    return outcome, look(result)
