"""Runs on any executor, in chunks.

A run depends on its scene alone, so results are the same bits for every executor, number of threads, chunk
and order. Other processes get the base scene once a chunk of runs, as bytes that they unpack once.
"""

from __future__ import annotations

import math
import os
import pickle
import threading
import time
from collections.abc import Callable
from concurrent.futures import (
    FIRST_COMPLETED,
    Executor,
    Future,
    ProcessPoolExecutor,
    ThreadPoolExecutor,
    wait,
)
from functools import lru_cache, partial
from typing import Any

from .metrics import compute_metrics
from .run_store import Outcome
from .scene_parameters import varied
from .simulation import Simulation

__all__ = ["ExecutorError", "Finished", "run_all"]

# A chunk takes about this long [s]: long beside what it costs to hand it over, short to wait for or to lose.
_CHUNK_TIME = 0.2
_LONGEST_CHUNK = 64

Chunk = list[tuple[int, tuple[Any, ...]]]
Finished = list[tuple[int, Outcome]]
Timed = tuple[Finished, float]  # and what it took to run them [s]


class ExecutorError(Exception):
    """The executor died; the cause says how."""


def run_all(
    simulation: Simulation | None,
    names: tuple[str, ...],
    metrics: tuple[str, ...],
    todo: Chunk,
    executor: Any,
    finish: Callable[[Finished], None],
) -> None:
    """Run all of `todo` (number of the run, values) and hand what is finished to `finish`, in any order.

    Without a `simulation` to vary the one value of each run is its scene.

    At most two chunks a worker are under way, so that memory does not grow with the number of runs.

    Raises
    ------
    ExecutorError
        If the executor died; before that all finished runs have been handed over.
    TypeError
        If `executor` is none.
    """
    if not todo:
        return
    stop = threading.Event()
    own = ThreadPoolExecutor(os.cpu_count() or 1) if executor is None else None
    pool, workers = _pool(own or executor)
    task: tuple[Any, ...]  # a function and its arguments before the chunk
    if isinstance(pool, ThreadPoolExecutor):
        task = (partial(_run_chunk, stop=stop), simulation, names, metrics)
    else:
        packed = pickle.dumps((simulation, names, metrics), pickle.HIGHEST_PROTOCOL)
        task = (_run_packed, _shipped(executor, packed))
    pending: set[Future[Timed]] = set()
    at, done_runs, seconds = 0, 0, 0.0
    try:
        while at < len(todo) or pending:
            while at < len(todo) and len(pending) < 2 * workers:
                cost = max(seconds / done_runs, 1e-6) if done_runs else _CHUNK_TIME
                share = math.ceil((len(todo) - at) / (2 * workers))  # no worker has all of the last ones
                size = max(1, min(int(_CHUNK_TIME / cost), share, _LONGEST_CHUNK))
                pending.add(_submit(pool, *task, todo[at : at + size]))
                at += size
            for future in wait(pending, return_when=FIRST_COMPLETED).done:
                finished, spent = _result(future)
                finish(finished)
                done_runs, seconds = done_runs + len(finished), seconds + spent
                pending.discard(future)
    except BaseException:
        stop.set()
        # dask logs an error for each future that is cancelled while it runs; its few chunks run out instead.
        if isinstance(pool, (ThreadPoolExecutor, ProcessPoolExecutor)):
            for future in pending:
                future.cancel()
        if isinstance(pool, ThreadPoolExecutor):
            wait(pending)  # each thread ends with its present run
        for future in pending:
            if future.done() and not future.cancelled() and future.exception() is None:
                finish(future.result()[0])
        raise
    finally:
        if own is not None:
            own.shutdown()


def _shipped(executor: Any, packed: bytes) -> Any:
    """Return the base scene as an argument of tasks: a client of dask has it sent to each worker once."""
    if not hasattr(executor, "scatter"):
        return packed
    try:
        return executor.scatter(packed, broadcast=True)
    except Exception as error:
        raise ExecutorError from error


def _submit(pool: Executor, *task: Any) -> Future[Timed]:
    try:
        return pool.submit(*task)
    except Exception as error:
        raise ExecutorError from error


def _result(future: Future[Timed]) -> Timed:
    # A run that fails is an outcome, so whatever is raised here is of the executor.
    try:
        return future.result()
    except Exception as error:
        raise ExecutorError from error


def _pool(executor: Any) -> tuple[Executor, int]:
    """Return an executor and its number of workers, as far as it tells; more only means smaller chunks."""
    if hasattr(executor, "get_executor") and hasattr(executor, "nthreads"):
        return executor.get_executor(), max(1, sum(executor.nthreads().values()))
    if not isinstance(executor, Executor):
        raise TypeError(
            f"executor must be a concurrent.futures.Executor, a dask.distributed.Client or None, "
            f"got {type(executor).__name__}"
        )
    return executor, getattr(executor, "_max_workers", None) or os.cpu_count() or 1


def _run_packed(packed: bytes, chunk: Chunk) -> Timed:
    simulation, names, metrics = _unpacked(packed)
    return _run_chunk(simulation, names, metrics, chunk)


_unpacked = lru_cache(maxsize=2)(pickle.loads)


def _run_chunk(
    simulation: Simulation | None,
    names: tuple[str, ...],
    metrics: tuple[str, ...],
    chunk: Chunk,
    stop: threading.Event | None = None,
) -> Timed:
    start = time.perf_counter()
    finished: Finished = []
    for run, row in chunk:
        if stop is not None and stop.is_set():
            break
        finished.append((run, _outcome(simulation, names, row, metrics)))
    return finished, time.perf_counter() - start


def _scene(simulation: Simulation | None, names: tuple[str, ...], row: tuple[Any, ...]) -> Simulation:
    if simulation is not None:
        return varied(simulation, dict(zip(names, row, strict=True)))
    (given,) = row
    return varied(given if isinstance(given, Simulation) else given(), {})


def _outcome(
    simulation: Simulation | None, names: tuple[str, ...], row: tuple[Any, ...], metrics: tuple[str, ...]
) -> Outcome:
    """Run one scene; whatever goes wrong is its reason."""
    try:
        result = _scene(simulation, names, row).run()
        found = compute_metrics(result, metrics)
        for name in metrics:
            if math.isnan(found.get(name, 0.0)):
                raise ArithmeticError(f"{name} is not a number")
    except Exception as error:
        reason = f"{type(error).__name__}: {error}"
        return Outcome((math.nan,) * len(metrics), error=reason)
    values = tuple(found.get(name, math.nan) for name in metrics)
    return Outcome(values, result.end_reason, f"{result.state_hash:016x}")
