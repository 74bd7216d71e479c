"""Thousands of scenes, each its own, from one call."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence, Sized
from typing import TYPE_CHECKING, Any

from ..base.arguments import checked
from ..base.complaints import Complaints
from ..base.progress import progress_bar
from ..result.metrics import METRIC_UNITS
from ..result.run_values import PARTS
from ..simulation.simulation import Simulation
from .runner import StudyInterrupted, StudyStoppedError, checked_metrics
from .table import Study

if TYPE_CHECKING:
    from .executors import Finished

__all__ = ["ensemble"]


@checked
def ensemble(
    simulations: Iterable[Simulation | Callable[[], Simulation]],
    *,
    metrics: Sequence[str] | None = None,
    executor: Any = None,
    progress: bool | None = None,
) -> Study:
    """Run many scenes on all cores and return their metrics, in the order of the scenes.

    A run depends on its scene alone: the same bits come out for any executor, number of threads and order. If
    the scenes are made one by one, as by a generator, a finished run keeps only a row of numbers in memory.

    No histories are made: a chunk of runs is one call of the core, which finds what the metrics are made of;
    the numbers are the same bits. Scenes that differ only in the approach of the vehicle are faster as a
    :func:`birm3d.sweep` with ``mode="list"``, which makes vehicle and barrier only once.

    Parameters
    ----------
    simulations
        The scenes; each is run from its start and not changed. A scene can also be a function without
        arguments that makes it: what it raises is the error of that run.
    metrics
        Names of the metrics wanted; ``None``: all but ``run_time``, which is not the same twice.
    executor
        Any :class:`concurrent.futures.Executor`, or a ``dask.distributed.Client``; ``None``: a thread for
        each core of the machine.
    progress
        Bar on stderr; ``None``: if that is a terminal.

    Returns
    -------
    Study
        One row a scene. A run that fails does not stop the others: it is a row with its reason in ``error``
        and NaN as metrics.

    Raises
    ------
    ValueError
        If there are no scenes, or a metric is unknown.
    StudyStoppedError
        If the executor dies. Finished runs are in its ``study``.
    StudyInterrupted
        A KeyboardInterrupt, with the finished runs in its ``study``.
    OverlapWarning, CoreContactWarning, BalanceWarning, MissedBarrierWarning, LowBarrierWarning,
    LeaningPostWarning, TippingWarning
        As warnings, each once: how many and which rows are not reliable, and what is wrong with the worst.

    Examples
    --------
    >>> scenes = (birm3d.Simulation(car, posts, speed, 90.0) for speed in speeds)
    >>> birm3d.ensemble(scenes, metrics=["vehicle_penetration"])["vehicle_penetration"]
    """
    from .executors import ExecutorError, run_all
    from .outcome_table import OutcomeTable

    wanted = checked_metrics(metrics, PARTS)
    units = {name: METRIC_UNITS[name] for name in wanted}
    total = len(simulations) if isinstance(simulations, Sized) else None
    outcomes = OutcomeTable(len(wanted), total)

    def study() -> Study:
        return Study._of(None, (), [], units, outcomes)

    def told() -> str:
        return "".join(f"; {text}" for _, text in complaints.summaries(len(outcomes)))

    complaints = Complaints()
    todo = ((run, (scene,)) for run, scene in enumerate(simulations))
    try:
        with progress_bar(progress, "ensemble", total) as advance:

            def finish(finished: Finished) -> None:
                outcomes.update(finished)
                advance(len(finished))

            run_all(None, (), wanted, todo, total, executor, finish, complaints)
    except KeyboardInterrupt:
        message = f"stopped: {len(outcomes)} runs are finished and kept in the error's 'study'{told()}"
        raise StudyInterrupted(message, study()) from None
    except ExecutorError as died:
        cause = died.__cause__
        message = (
            f"the executor died ({type(cause).__name__}: {cause}); {len(outcomes)} runs are finished{told()}"
        )
        raise StudyStoppedError(message, study()) from cause
    if not outcomes:
        raise ValueError("simulations must have at least one scene, got none")
    complaints.warn(len(outcomes))
    return study()
