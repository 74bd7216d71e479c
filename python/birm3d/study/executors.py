"""Runs on any executor, in chunks.

A run depends on its scene alone, so results are the same bits for every executor, number of threads, chunk
and order. Other processes get the base scene once a chunk of runs, as bytes that they unpack once.

The core runs scene after scene in the same memory without the interpreter's lock. No histories are kept:
metrics are made of the extremes that the core finds.
"""

# Longer than 300 lines: threads, processes and clusters by one loop.
from __future__ import annotations

import itertools
import math
import os
import pickle
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import (
    FIRST_COMPLETED,
    Executor,
    Future,
    ProcessPoolExecutor,
    ThreadPoolExecutor,
    wait,
)
from contextlib import ExitStack
from functools import lru_cache, partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple, TypeVar

from .. import _core
from ..base.complaints import Complaints
from ..result.metrics import extremes_for, values_of_outcome
from ..result.run_warnings import complaints_of_run
from ..result.tipping import RATIO, can_tip, tipping_of_extremes
from ..scene.mesh_check import coarse_skins
from ..scene.scene import APPROACH, Scene
from ..simulation.parameters import varied_scene
from ..simulation.simulation import Simulation
from .store import Outcome

__all__ = ["ExecutorError", "Finished", "pool_of", "result_of", "run_all", "submit"]

# A chunk takes about this long [s]: long beside what it costs to hand it over, short to wait for or to lose.
_CHUNK_TIME = 0.2
_LONGEST_CHUNK = 256
_MOST_SCENES = 64  # a chunk holds its scenes until it is done

# Enumerators of the core look for their name each time.
_END_REASONS = {int(reason): name for name, reason in _core.EndReason.__members__.items()}

Found = TypeVar("Found")
Chunk = list[tuple[int, tuple[Any, ...]]]
Finished = list[tuple[int, Outcome]]


class Done(NamedTuple):
    """A chunk that was run."""

    finished: Finished
    complaints: Complaints
    seconds: float  # that it took


class ExecutorError(Exception):
    """The executor died; the cause says how."""


def run_all(
    simulation: Simulation | None,
    names: tuple[str, ...],
    metrics: tuple[str, ...],
    todo: Iterable[tuple[int, tuple[Any, ...]]],
    total: int | None,
    executor: Any,
    finish: Callable[[Finished], None],
    complaints: Complaints,
) -> None:
    """Run all of `todo` (number of the run, values) and hand what is finished to `finish`, in any order.

    What is to be said of runs is added to `complaints`, of those that were handed over.

    Without a `simulation` to vary the one value of each run is its scene. `total` is how many there are, if
    known.

    At most two chunks a worker are taken from `todo`, so that memory does not grow with the number of runs.

    Raises
    ------
    ExecutorError
        If the executor died; before that all finished runs have been handed over.
    TypeError
        If `executor` is none.
    """
    if total == 0:
        return
    stop = _core.Stop()
    own = ThreadPoolExecutor(os.cpu_count() or 1) if executor is None else None
    pool, workers = pool_of(own or executor)
    files = ExitStack()
    task: tuple[Any, ...]  # a function and its arguments before the chunk
    if isinstance(pool, ThreadPoolExecutor):
        task = (partial(_run_chunk, stop=stop), simulation, names, metrics)
    else:
        packed = pickle.dumps((_at_start(simulation), names, metrics), pickle.HIGHEST_PROTOCOL)
        todo = ((run, tuple(map(_at_start, row))) for run, row in todo)
        task = (_run_packed, _shipped(executor, packed, files))

    def take(done: Done) -> None:
        complaints.merge(done.complaints)
        finish(done.finished)

    pending: set[Future[Done]] = set()
    left = iter(todo)
    at, done_runs, seconds, more = 0, 0, 0.0, True
    longest = _LONGEST_CHUNK if simulation is not None else _MOST_SCENES
    try:
        while more or pending:
            while more and len(pending) < 2 * workers:
                cost = max(seconds / done_runs, 1e-6) if done_runs else _CHUNK_TIME
                size = max(1, min(int(_CHUNK_TIME / cost), longest))
                if total is not None:  # no worker has all of the last ones
                    size = max(1, min(size, math.ceil((total - at) / (2 * workers))))
                chunk = list(itertools.islice(left, size))
                at += len(chunk)
                more = len(chunk) == size
                if chunk:
                    pending.add(submit(pool, *task, chunk))
            if not pending:
                break
            for future in wait(pending, return_when=FIRST_COMPLETED).done:
                done = result_of(future)
                take(done)
                done_runs, seconds = done_runs + len(done.finished), seconds + done.seconds
                pending.discard(future)
    except BaseException as error:
        stop.set()
        for future in _ended(pool, pending, isinstance(error, ExecutorError)):
            take(future.result())
        raise
    finally:
        files.close()
        if own is not None:
            own.shutdown()


def _ended(pool: Any, pending: set[Future[Done]], died: bool) -> list[Future[Done]]:
    """Stop what still runs in a pool, and return what had ended well."""
    # dask logs an error for each future that is cancelled while it runs; its few chunks run out instead.
    # A pool that died marks its futures in a thread, which must not find them cancelled.
    if isinstance(pool, ThreadPoolExecutor) or (isinstance(pool, ProcessPoolExecutor) and not died):
        for future in pending:
            future.cancel()
    if isinstance(pool, ThreadPoolExecutor):
        wait(pending)  # each thread ends with its present run
    return [one for one in pending if one.done() and not one.cancelled() and one.exception() is None]


def _at_start(thing: Any) -> Any:
    """Return a simulation as it was at t = 0, or anything else: a pickle would take the steps again."""
    return thing._at_start() if isinstance(thing, Simulation) and thing.time > 0.0 else thing


def _shipped(executor: Any, packed: bytes, files: ExitStack) -> Any:
    """Return the base scene as an argument of tasks.

    A client of dask has it sent to each worker once. Processes of this machine read it from a file. It is
    larger than a pipe holds, and Python before 3.11.5 never returns from sending that much to a worker that
    died.
    """
    if isinstance(executor, ProcessPoolExecutor):
        folder = files.enter_context(TemporaryDirectory(prefix="birm3d-", ignore_cleanup_errors=True))
        path = Path(folder) / "scene.pickle"
        path.write_bytes(packed)
        return path
    if not hasattr(executor, "scatter"):
        return packed
    try:
        # A new name: the same bytes of an earlier study may be about to be released.
        return executor.scatter(packed, broadcast=True, hash=False)
    except Exception as error:
        raise ExecutorError from error


def submit(pool: Executor, *task: Any) -> Future[Any]:
    """Hand a task to the workers; an ExecutorError says that they take none any more."""
    try:
        return pool.submit(*task)
    except Exception as error:
        raise ExecutorError from error


def result_of(future: Future[Found]) -> Found:
    """Return what a task returned; an ExecutorError says that the executor died."""
    # A run that fails is an outcome, so whatever is raised here is of the executor.
    try:
        return future.result()
    except Exception as error:
        raise ExecutorError from error


def pool_of(executor: Any) -> tuple[Executor, int]:
    """Return an executor and its number of workers, as far as it tells; more only means smaller chunks."""
    if hasattr(executor, "get_executor") and hasattr(executor, "nthreads"):
        return executor.get_executor(), max(1, sum(executor.nthreads().values()))
    if not isinstance(executor, Executor):
        raise TypeError(
            f"executor must be a concurrent.futures.Executor, a dask.distributed.Client or None, "
            f"got {type(executor).__name__}"
        )
    return executor, getattr(executor, "_max_workers", None) or os.cpu_count() or 1


def _run_packed(packed: bytes | Path, chunk: Chunk) -> Done:
    simulation, names, metrics = _unpacked(packed)
    return _run_chunk(simulation, names, metrics, chunk)


@lru_cache(maxsize=2)
def _unpacked(packed: bytes | Path) -> tuple[Simulation | None, tuple[str, ...], tuple[str, ...]]:
    scene: tuple[Simulation | None, tuple[str, ...], tuple[str, ...]]
    scene = pickle.loads(packed.read_bytes() if isinstance(packed, Path) else packed)
    return scene


def _run_chunk(
    simulation: Simulation | None,
    names: tuple[str, ...],
    metrics: tuple[str, ...],
    chunk: Chunk,
    stop: _core.Stop | None = None,
) -> Done:
    start = time.perf_counter()
    stop = stop or _core.Stop()
    finished: Finished = []
    complaints = Complaints()
    runner = _core.Runner()
    for batch in _batches(simulation, names, chunk, finished, complaints, metrics):
        tips = [RATIO] if any(can_tip(scene) for _, scene, _ in batch) else []  # it is warned of
        extremes = extremes_for([*metrics, *tips])
        ended = runner.run([(core, scene.approach) for _, scene, core in batch], extremes, stop)
        # Those that were stopped are missing at the end.
        for (run, scene, _), done in zip(batch, ended, strict=False):
            finished.append((run, _outcome(run, scene, done, complaints, metrics)))
        if len(ended) < len(batch):
            break
    return Done(finished, complaints.told(), time.perf_counter() - start)


def _outcome(
    run: int, scene: Scene, done: _core.Run, complaints: Complaints, metrics: tuple[str, ...]
) -> Outcome:
    try:
        end = done.outcome()
        complaints.add(run, complaints_of_run(scene, end.statistics, end.balances, end.event))
        complaints.add(run, tipping_of_extremes(scene, end.extremes))
        values = values_of_outcome(scene, end, metrics)
        reason = _END_REASONS[int(end.end_reason)]
        return Outcome(values, reason, end.event.outcome, f"{end.state_hash:016x}")
    except Exception as error:
        return _failed(error, metrics)


def _batches(
    simulation: Simulation | None,
    names: tuple[str, ...],
    chunk: Chunk,
    finished: Finished,
    complaints: Complaints,
    metrics: tuple[str, ...],
) -> Iterator[list[tuple[int, Scene, _core.Scene]]]:
    """Yield what one call of the core runs; runs whose scene can not be made are `finished`.

    Where all that varies is how the vehicle comes, that is the chunk. Other scenes are held one at a time:
    each has a vehicle or a barrier of its own.
    """
    by_offset = simulation is not None and simulation.scene.overlap is None
    if simulation is not None and by_offset and all(name in APPROACH for name in names):
        base = simulation.scene
        core = base.core_scene()
        rows = ((run, dict(zip(names, row, strict=True))) for run, row in chunk)
        yield [(run, base.approached(numbers), core) for run, numbers in rows]
        return
    for run, row in chunk:
        try:
            scene = _scene(simulation, names, row)
            core = scene.core_scene()
            if simulation is not None:  # a given scene warned when it was made
                complaints.add(run, coarse_skins(scene))
        except Exception as error:
            finished.append((run, _failed(error, metrics)))
        else:
            yield [(run, scene, core)]


def _scene(simulation: Simulation | None, names: tuple[str, ...], row: tuple[Any, ...]) -> Scene:
    if simulation is not None:
        return varied_scene(simulation.scene, dict(zip(names, row, strict=True)))
    (given,) = row
    return (given if isinstance(given, Simulation) else given()).scene


def _failed(error: Exception, metrics: tuple[str, ...]) -> Outcome:
    """Whatever goes wrong with a run is its reason."""
    return Outcome((math.nan,) * len(metrics), error=f"{type(error).__name__}: {error}")
