"""Runs whose histories are needed: each is run, evaluated by a function, and deleted."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from functools import partial
from os import cpu_count
from typing import Any, Generic, NamedTuple, TypeVar

from ..base.complaints import Complaints
from ..base.progress import progress_bar
from ..result.result import Result
from ..result.run_warnings import told_of_run
from ..scene.mesh_check import coarse_skins
from ..scene.scene import Scene
from .executors import ExecutorError, pool_of, result_of, submit
from .table import Study

__all__ = ["Look", "look_at_runs", "look_at_study", "require_found"]

Found = TypeVar("Found")


class Look(NamedTuple, Generic[Found]):
    """What was found in one run, or why there is nothing."""

    run: int
    found: Found | None
    error: str
    complaints: Complaints


def look_at_runs(
    scenes: Sequence[Scene],
    look: Callable[[Result], Found],
    *,
    executor: Any = None,
    progress: bool | None = None,
    title: str = "runs",
) -> Iterator[Look[Found]]:
    """Run scenes and yield what a function finds in their results, in any order; then warn once for all.

    The result of a run is gone when the function has looked at it. A run that fails is yielded with its
    reason.

    Parameters
    ----------
    scenes
        To run.
    look
        Called with each result, by the worker that ran it; for processes it must be one that pickles.
    executor, progress
        See :func:`birm3d.study.runner.run_study`.
    title
        Of the progress bar.

    Raises
    ------
    ExecutorError
        If the executor died.
    TypeError
        If `executor` is none.
    """
    own = ThreadPoolExecutor(max(1, min(len(scenes), cpu_count() or 1))) if executor is None else None
    pool, workers = pool_of(own or executor)
    complaints = Complaints()
    pending: set[Future[Look[Found]]] = set()
    left = iter(enumerate(scenes))
    task = partial(_look_at, look)
    try:
        with progress_bar(progress, title, len(scenes)) as advance:
            more = True
            while more or pending:
                while more and len(pending) < 2 * workers:
                    run, scene = next(left, (0, None))
                    more = scene is not None
                    if more:
                        pending.add(submit(pool, task, run, scene))
                if not pending:
                    break
                for future in wait(pending, return_when=FIRST_COMPLETED).done:
                    pending.discard(future)
                    done: Look[Found] = result_of(future)
                    complaints.merge(done.complaints)
                    advance(1)
                    yield done
    except BaseException as error:
        if not isinstance(error, ExecutorError):
            for future in pending:
                future.cancel()
        raise
    finally:
        if own is not None:
            own.shutdown()
    complaints.warn(len(scenes))


def look_at_study(
    study: Study, look: Callable[[Result], Found], *, progress: bool | None = None, title: str = "runs"
) -> tuple[dict[int, Found], dict[int, str]]:
    """Run the scenes of a study once more, for their histories, and return what a function finds.

    Returns
    -------
    found : dict of int to Found
        Number of each run -> what was found in it, in order.
    failed : dict of int to str
        Number of each run that failed, now or in the study -> its reason.

    Raises
    ------
    ValueError
        If the study does not know its scenes.
    """
    failed = dict(study.failed)
    rows = [row for row, run in enumerate(study.run.tolist()) if run not in failed]
    runs = [int(study.run[row]) for row in rows]
    scenes = [study.simulation(row).scene for row in rows]
    found: dict[int, Found] = {}
    for seen in look_at_runs(scenes, look, progress=progress, title=title):
        if seen.found is None:
            failed[runs[seen.run]] = seen.error.removeprefix("ValueError: ")
        else:
            found[runs[seen.run]] = seen.found
    return {run: found[run] for run in runs if run in found}, failed


def require_found(found: Mapping[int, Any], failed: Mapping[int, str], what: str) -> None:
    """Require a value of at least one run of a study.

    Parameters
    ----------
    found
        Number of each run -> its value.
    failed
        Number of each run without a value -> its reason.
    what
        What a run with a value does, as "can be rated".

    Raises
    ------
    ValueError
        If there is none; the message has the reason of the first.
    """
    if not found:
        reason = next(iter(failed.values()), "it has no runs")
        raise ValueError(f"result must be a study with a run that {what}, got none: {reason}")


def _look_at(look: Callable[[Result], Found], run: int, scene: Scene) -> Look[Found]:
    complaints = Complaints()
    try:
        complaints.add(run, coarse_skins(scene))
        core = scene.start()
        with core:
            core.run()
            result = Result._of(scene, core, 0.0)
            complaints.add(run, told_of_run(result, core.balances))
        return Look(run, look(result), "", complaints)
    except Exception as error:  # whatever goes wrong with a run is its reason
        return Look(run, None, f"{type(error).__name__}: {error}", complaints)
