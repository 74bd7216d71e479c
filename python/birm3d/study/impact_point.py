"""Critical impact point: the offset, angle or anything else that makes a metric greatest."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .. import pictures
from ..base.arguments import checked
from ..simulation.parameters import in_si, unit_of, value_of
from ..simulation.simulation import Simulation
from ..units import Quantity
from .distributions import check_count
from .runner import run_study
from .table import Study

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["CriticalImpactPoint", "critical_impact_point"]

Floats = npt.NDArray[np.float64]


@checked
@dataclass(frozen=True, eq=False)
class CriticalImpactPoint:
    """Where a metric is greatest (or least) inside given ranges.

    Attributes
    ----------
    metric : str
    value : float
        The metric there.
    point : mapping of str to float
        Parameter -> value there; the scene's own (or the nearest in range) where it has no effect.
    no_effect : tuple of str
        Parameters along which the metric changes by less than the tolerance.
    at_bound : tuple of str
        Parameters whose best value lies at an end of the range: beyond it may be worse still.
    effect : mapping of str to float
        Parameter -> greatest change of the metric along it on the grid, relative to the metric's greatest
        magnitude.
    tolerance : float
        Relative change below which a parameter has no effect.
    grid, refinement : Study
        All runs; those that failed have their reason.
    """

    metric: str
    value: float
    point: Mapping[str, float]
    no_effect: tuple[str, ...]
    at_bound: tuple[str, ...]
    effect: Mapping[str, float]
    tolerance: float
    grid: Study
    refinement: Study

    def plot(self) -> Figure:
        """Return the metric over the ranges that were searched, with the critical point."""
        return pictures.plot_critical_point(self)

    def _repr_html_(self) -> str:
        return pictures.text_html(repr(self), self.plot(), "critical impact point")

    def __repr__(self) -> str:
        notes = {name: ", no effect" for name in self.no_effect}
        notes.update({name: ", at its bound" for name in self.at_bound})
        where = "; ".join(
            f"{name} = {value:.6g} {unit_of(name)}".rstrip() + notes.get(name, "")
            for name, value in self.point.items()
        )
        runs = len(self.grid) + len(self.refinement)
        return f"CriticalImpactPoint({self.metric} = {self.value:.6g} at {where}; {runs} runs)"


@checked
def critical_impact_point(
    simulation: Simulation,
    metric: str,
    ranges: Mapping[str, tuple[Quantity, Quantity]],
    *,
    minimize: bool = False,
    points: int = 9,
    tolerance: float | None = None,
    max_runs: int = 100,
    executor: Any = None,
    store: str | Path | None = None,
    progress: bool | None = None,
) -> CriticalImpactPoint:
    """Return where in given ranges a metric is greatest: a grid, then a search around its best point.

    Metrics are piecewise smooth with small steps, so the search uses no derivatives (Nelder and Mead 1965,
    with bounds, through scipy). The same call gives the same answer. A peak narrower than the grid's spacing
    can be missed.

    Parameters
    ----------
    simulation
        The scene to vary.
    metric
        A name of :data:`birm3d.metrics.METRIC_UNITS`. Runs that lack it are never the best.
    ranges
        Parameter -> (least, greatest), as ``{"impact_offset": (-2, 2), "impact_angle": (15, 90)}``; SI and
        degrees, or text with a unit.
    minimize
        Whether the least value is wanted.
    points
        Of the grid along each range, >= 3.
    tolerance
        Relative change of the metric that counts as an effect, and at which the search ends; ``None``: the
        tolerance of the scene's settings.
    max_runs
        Of the search.
    executor, store, progress
        See :func:`birm3d.study.runner.run_study`; the store keeps the grid.

    Raises
    ------
    ValueError
        Naming the argument, its limit and the value; if no run of the grid has the metric.
    """
    names = tuple(ranges)
    low, high = _bounds(simulation, ranges)
    check_count("points", points, least=3, each=points ** (len(names) - 1) if isinstance(points, int) else 1)
    check_count("max_runs", max_runs)
    if tolerance is None:
        tolerance = simulation.scene.settings.tolerance
    if not 0.0 < tolerance < 1.0:
        raise ValueError(f"tolerance must be between 0 and 1, got {tolerance}")
    grid = _grid(simulation, metric, names, low, high, points, executor, store, progress)
    values = grid[metric]
    sign = 1.0 if minimize else -1.0
    effect = _effects(names, values.reshape((points,) * len(names)))
    free = [i for i, name in enumerate(names) if effect[name] >= tolerance]
    idle = tuple(name for name in names if effect[name] < tolerance)
    best = int(np.nanargmin(sign * values))
    value, point = float(values[best]), np.array([grid[name][best] for name in names])
    start = point.copy()
    for i, name in enumerate(names):
        now = value_of(simulation, name)
        if name in idle and isinstance(now, (int, float)):
            start[i] = min(max(float(now), low[i]), high[i])
    refinement = _refined(
        simulation, metric, sign, names, start, free, low, high, points, tolerance, max_runs
    )
    found = sign * np.where(np.isnan(refinement[metric]), sign * math.inf, refinement[metric])
    at = int(np.argmin(found))
    # Parameters without effect went to the scene's own values, which costs less than the tolerance.
    if found[at] <= sign * value + tolerance * abs(value):
        value, point = float(refinement[metric][at]), np.array([refinement[name][at] for name in names])
    near = tolerance * (high - low)
    at_bound = tuple(names[i] for i in free if point[i] <= low[i] + near[i] or point[i] >= high[i] - near[i])
    return CriticalImpactPoint(
        metric,
        value,
        dict(zip(names, point.tolist(), strict=True)),
        idle,
        at_bound,
        effect,
        tolerance,
        grid,
        refinement,
    )


def _grid(
    simulation: Simulation,
    metric: str,
    names: tuple[str, ...],
    low: Floats,
    high: Floats,
    points: int,
    executor: Any,
    store: str | Path | None,
    progress: bool | None,
) -> Study:
    """Return the runs of the grid, at least one of which has the metric."""
    axes = [np.linspace(a, b, points).tolist() for a, b in zip(low, high, strict=True)]
    grid = run_study(
        simulation,
        names,
        list(itertools.product(*axes)),
        metrics=[metric],
        executor=executor,
        store=store,
        progress=progress,
        grid=dict(zip(names, axes, strict=True)),
        title="grid of impact points",
    )
    if np.isnan(grid[metric]).all():
        reason = next(iter(grid.failed.values()), "no run has it")
        raise ValueError(f"metric must be one that the scene has, got {metric!r}: {reason}")
    return grid


def _bounds(simulation: Simulation, ranges: Mapping[str, tuple[Quantity, Quantity]]) -> tuple[Floats, Floats]:
    if not ranges:
        raise ValueError("ranges must name at least one parameter, got none")
    listed = []
    for name, given in ranges.items():
        value_of(simulation, name)
        limits = [in_si(name, limit) for limit in given]
        listed.append(limits)
        if len(limits) != 2 or not -math.inf < limits[0] < limits[1] < math.inf:
            raise ValueError(
                f"ranges[{name!r}] must be (least, greatest), finite and increasing; got {given}"
            )
    low, high = np.array(listed, float).T
    return low, high


def _effects(names: tuple[str, ...], values: Floats) -> dict[str, float]:
    """Greatest change along each axis of the grid, relative to the greatest magnitude of all."""
    size = float(np.nanmax(np.abs(values))) or 1.0
    effects = {}
    for axis, name in enumerate(names):
        lines = np.moveaxis(values, axis, -1).reshape(-1, values.shape[axis])
        lines = lines[np.isfinite(lines).any(axis=1)]
        effects[name] = float((np.nanmax(lines, axis=1) - np.nanmin(lines, axis=1)).max()) / size
    return effects


def _refined(
    simulation: Simulation,
    metric: str,
    sign: float,
    names: tuple[str, ...],
    start: Floats,
    free: list[int],
    low: Floats,
    high: Floats,
    points: int,
    tolerance: float,
    max_runs: int,
) -> Study:
    """All runs of a local search over the free parameters, in units of their ranges."""
    from scipy.optimize import minimize

    studies: list[Study] = []

    def objective(share: Floats) -> float:
        point = start.copy()
        point[free] = low[free] + share * (high - low)[free]
        study = run_study(simulation, names, [point.tolist()], metrics=[metric], progress=False)
        studies.append(study)
        value = float(study[metric][0])
        return math.inf if math.isnan(value) else sign * value

    first = (start[free] - low[free]) / (high - low)[free]
    size = abs(objective(first))
    if not free:
        return studies[0]
    step = 0.5 / (points - 1)
    simplex = np.tile(first, (len(free) + 1, 1))
    for i, share in enumerate(first):
        simplex[i + 1, i] = share + (step if share + step <= 1.0 else -step)
    minimize(
        objective,
        first,
        method="Nelder-Mead",
        bounds=[(0.0, 1.0)] * len(free),
        options={
            "initial_simplex": simplex,
            "xatol": 1e-4,
            "fatol": 0.1 * tolerance * size,
            "maxfev": max_runs,
        },
    )
    return Study.joined(studies)
