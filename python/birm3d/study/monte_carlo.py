"""Monte Carlo: distributions of the metrics for uncertain parameters."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ..base.arguments import checked
from ..simulation.simulation import Simulation
from ..unit_check import warn_if_any_unusual
from .distributions import check_count, check_distributions, check_seed, sample
from .runner import run_study
from .table import Study

__all__ = ["monte_carlo"]


@checked
def monte_carlo(
    simulation: Simulation,
    distributions: Mapping[str, Any],
    n: int,
    seed: int = 0,
    *,
    metrics: Sequence[str] | None = None,
    executor: Any = None,
    store: str | Path | None = None,
    progress: bool | None = None,
) -> Study:
    """Run a scene n times with parameters drawn from distributions, independent of each other.

    Run i's parameters depend on (seed, i, name of the parameter) alone, see
    :func:`birm3d.study.distributions.sample`. So a greater n keeps the earlier runs, and with a ``store``
    only the new ones are run.

    Parameters
    ----------
    simulation
        The scene to vary.
    distributions
        Parameter (see :mod:`birm3d.scene_parameters`) -> frozen distribution of :mod:`scipy.stats`, in SI and
        degrees: ``{"impact_speed": norm(22.4, 0.5)}``.
    n
        Number of runs, >= 1.
    seed
        Integer >= 0.
    metrics, executor, store, progress
        See :func:`birm3d.study.runner.run_study`.

    Returns
    -------
    Study
        :meth:`birm3d.Study.summary` has means, standard deviations and quantiles. A run that fails (a draw
        may be out of a parameter's range) is a row with its reason.

    Raises
    ------
    ValueError
        Naming the argument, its limit and the value received.
    """
    check_count("n", n)
    check_seed(seed)
    check_distributions(simulation, distributions)
    for name, distribution in distributions.items():
        warn_if_any_unusual(name, [float(distribution.ppf(0.5))])
    return run_study(
        simulation,
        tuple(distributions),
        sample(distributions, n, seed),
        metrics=metrics,
        executor=executor,
        store=store,
        progress=progress,
        title="Monte Carlo",
    )
