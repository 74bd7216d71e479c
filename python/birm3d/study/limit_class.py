"""How many vehicles of a class a limit holds for."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..simulation.simulation import Simulation
from .class_draws import check_draws, drawn_parameters
from .distributions import check_count
from .limit_question import Question
from .runner import run_study

__all__ = ["class_shares", "drawn_vehicles"]

_USUAL_DRAWS = 16
_MOST_VALUES = 5


def drawn_vehicles(simulation: Simulation, draws: int | None) -> Mapping[str, Sequence[float]]:
    """Return the parameters of vehicles of the class; none where they can not be drawn, or shall not.

    Raises
    ------
    ValueError
        If the number is none, or the vehicle's file says nothing of its class and they are asked for.
    """
    if draws is not None:
        check_count("draws", draws, least=0)
    silent = not any(unit.scatter for unit in simulation.scene.vehicle.units)
    if draws == 0 or (draws is None and silent):
        return {}
    power = check_draws("draws", _USUAL_DRAWS if draws is None else draws)
    return {name: values.tolist() for name, values in drawn_parameters(simulation, power).items()}


def class_shares(
    simulation: Simulation,
    vehicles: Mapping[str, Sequence[float]],
    values: Sequence[float],
    question: Question,
    executor: Any,
) -> dict[float, float]:
    """Return the share of the vehicles for which each value holds, up to the first that holds for all.

    Parameters
    ----------
    vehicles
        Parameter -> its value for each vehicle.
    values
        To try, the most daring one first; at most five are.
    question
        Which runs a value has, and when it holds.
    executor
        See :func:`birm3d.study.runner.run_study`.

    Raises
    ------
    StudyInterrupted
        With the finished runs of the present value.
    """
    if not vehicles:
        return {}
    count = len(next(iter(vehicles.values())))
    shares: dict[float, float] = {}
    measure = question.measure
    for value in values[:_MOST_VALUES]:
        runs = [
            (*(vehicles[name][j] for name in vehicles), given, offset)
            for j in range(count)
            for given, offset in question.rows(value)
        ]
        names = (*vehicles, question.parameter, "impact_offset")
        study = run_study(simulation, names, runs, metrics=[measure], executor=executor, progress=False)
        measures = study[measure].tolist()
        good = [
            not error and question.holds(outcome, float(one))
            for error, outcome, one in zip(study.error, study.outcome, measures, strict=True)
        ]
        shares[value] = float(np.mean(np.reshape(good, (count, -1)).all(axis=1)))
        if shares[value] == 1.0:
            break
    return shares
