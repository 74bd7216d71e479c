"""The scenes that a barrier is designed for: read from what the caller gives, checked, and listed."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ..barrier.barrier import Barrier
from ..base.checks import check_runs
from ..result.result import Result
from ..scene.scene import Scene
from ..simulation.parameters import varied_scene
from ..simulation.simulation import Simulation
from ..study.predict import Prediction
from ..study.table import Study
from ..unit_check import given, warn_if_any_unusual
from ..units import Quantity, si
from .element_design import System, check_system

__all__ = ["ASSUMED_PERIOD", "DesignPlan", "design_plan", "predicted_scene"]

_ARGUMENTS = {
    "impact_offset": ("offsets", "length"),
    "impact_angle": ("impact_angles", "angle"),
    "impact_speed": ("impact_speeds", "speed"),
}
"""Parameter -> argument of :func:`birm3d.design_load` that lists its values, and their quantity."""

Floats = npt.NDArray[np.float64]

ASSUMED_PERIOD = 0.1
"""Natural period of an element where none was given [s]."""


class DesignPlan(NamedTuple):
    """Scenes at one barrier, and the oscillator that stands for each of its elements."""

    cases: list[Simulation | Result]
    """The simulation or result behind each scene; results are not run again."""
    scenes: list[Scene]
    varied: Mapping[str, Sequence[float]]
    """Lists of which each scene has one value (SI, degrees), by name."""
    barrier: Barrier
    system: System
    quantile: float
    """Quantile over the scenes that is reported, > 0 and <= 1; 1 is the greatest."""
    period_is_assumed: bool

    @property
    def normal(self) -> Floats:
        """Unit vector against the barrier's normal, world axes, shape (3,)."""
        return -np.asarray(self.barrier.core.normal)

    @property
    def sources(self) -> list[Result | Scene]:
        """Of each scene its result where there is one, else the scene."""
        pairs = zip(self.cases, self.scenes, strict=True)
        return [case if isinstance(case, Result) else scene for case, scene in pairs]


def design_plan(
    cases: Simulation | Result | Study | Sequence[Simulation | Result],
    lists: Mapping[str, Iterable[Quantity] | None],
    quantile: float,
    natural_period: Quantity | None,
    ductility: float,
    damping: float,
) -> DesignPlan:
    """Return the scenes that :func:`birm3d.design_load` runs.

    lists: values of ``impact_offset``, ``impact_angle`` and ``impact_speed``; ``None``: the scene's own.

    Raises
    ------
    ValueError
        Naming the argument, its limit and the value; if there is no barrier, or the barriers differ.
    """
    listed = _listed(cases)
    if not 0.0 < quantile <= 1.0:
        raise ValueError(f"quantile must be > 0 and <= 1, got {quantile}")
    varied = {name: _values(name, values) for name, values in lists.items() if values is not None}
    barrier = _common_barrier(listed, varied)
    system = _system(listed, natural_period, ductility, damping)
    check_runs("cases", len(listed) * math.prod(map(len, varied.values())))
    pairs = list(itertools.product(listed, itertools.product(*varied.values())))
    return DesignPlan(
        cases=[case for case, _ in pairs],
        scenes=[varied_scene(case.scene, dict(zip(varied, row, strict=True))) for case, row in pairs],
        varied=varied,
        barrier=barrier,
        system=system,
        quantile=quantile,
        period_is_assumed=natural_period is None,
    )


def predicted_scene(prediction: Prediction, draws: int | None) -> tuple[Simulation, int]:
    """Return the scene of a prediction and the number of its draws."""
    study = prediction.study
    if study._scene is None:
        raise ValueError("cases must be a prediction that knows its scene, got one of a file")
    return Simulation.from_scene(study._scene), len(study) if draws is None else draws


def _listed(cases: Simulation | Result | Study | Sequence[Simulation | Result]) -> list[Simulation | Result]:
    if isinstance(cases, (Simulation, Result)):
        return [cases]
    if isinstance(cases, Study):
        return [cases.simulation(row) for row, error in enumerate(cases.error) if not error]
    return list(cases)


def _values(name: str, values: Iterable[Quantity]) -> list[float]:
    stated = list(values)
    warn_if_any_unusual(name, stated)
    argument, quantity = _ARGUMENTS[name]
    found = [si(argument, value, quantity) for value in stated]
    if not found:
        raise ValueError(f"{argument} must have at least one value, got an empty list")
    for value in found:
        if not math.isfinite(value):
            raise ValueError(f"{argument} must be finite, got {value}")
    return found


def _common_barrier(cases: Sequence[Simulation | Result], varied: Iterable[str]) -> Barrier:
    if not cases:
        raise ValueError("cases must be at least one Simulation or Result, got an empty list")
    barrier = cases[0].scene.barrier
    if barrier is None:
        raise ValueError("cases must have a barrier, got one without")
    for case in cases:
        if case.scene.barrier != barrier:
            raise ValueError(f"cases must have the same barrier, got {barrier} and {case.scene.barrier}")
        if varied and isinstance(case, Result):
            raise ValueError(f"cases must be simulations to vary {', '.join(varied)}, got a Result")
    return barrier


def _system(
    cases: Sequence[Simulation | Result], natural_period: Quantity | None, ductility: float, damping: float
) -> System:
    period = ASSUMED_PERIOD if natural_period is None else given("natural_period", natural_period)
    system = System(float(period), float(ductility), float(damping))
    check_system(system, max(case.scene.settings.output_interval for case in cases))
    return system
