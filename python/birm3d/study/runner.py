"""Many runs of varied scenes: checked, run on any executor, kept on disk, put in a table."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping, Sequence
from contextlib import closing
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .._version import __version__
from ..base.checks import is_number
from ..base.complaints import Complaints
from ..base.progress import progress_bar
from ..result.metrics import METRIC_UNITS, METRICS
from ..result.run_values import PARTS, parts_of
from ..simulation.parameters import value_of, varied
from ..simulation.simulation import Simulation
from .float_rows import FloatRows
from .table import Study

if TYPE_CHECKING:
    from .executors import Finished
    from .store import RunStore

__all__ = ["StudyInterrupted", "StudyStoppedError", "checked_metrics", "run_study"]

# The wall time of a run is no property of the scene: it would make every study differ from every other.
_STUDY_METRICS = tuple(name for name in METRIC_UNITS if name != "run_time")


Keep = Callable[[Path], None]


class _Unfinished(BaseException):
    """The finished runs of a study that was stopped."""

    def __init__(self, message: str, study: Study, keep: Keep | None = None) -> None:
        super().__init__(message)
        self.study = study
        self._keep = keep

    def keep(self, path: str | Path) -> None:
        """Write the finished runs to a store; the same call with ``store=path`` goes on from there.

        Raises
        ------
        ValueError
            If the study can have no store, as an ensemble, or the file can be none.
        """
        if self._keep is None:
            raise ValueError(
                f"keep() needs a study over parameters that has just stopped, got {self.study!r}"
            )
        self._keep(Path(path))

    def __reduce__(self) -> tuple[Any, ...]:
        return (type(self), (self.args[0], self.study))


class StudyStoppedError(_Unfinished, RuntimeError):
    """The executor died, or the store can not be written; ``study`` has the finished runs.

    A store has them too, but for those that it could not take.
    """


class StudyInterrupted(_Unfinished, KeyboardInterrupt):
    """Ctrl-C; ``study`` has the finished runs, which a store has too."""


def run_study(
    simulation: Simulation,
    names: Sequence[str],
    rows: Sequence[Sequence[Any]] | npt.NDArray[np.float64],
    *,
    metrics: Sequence[str] | None = None,
    executor: Any = None,
    store: str | Path | None = None,
    progress: bool | None = None,
    grid: Mapping[str, Sequence[Any]] | None = None,
    title: str = "runs",
) -> Study:
    """Run a scene with many sets of parameters.

    Parameters
    ----------
    simulation
        The scene to vary.
    names, rows
        Parameters (see :mod:`birm3d.scene_parameters`) and their values, one row a run; SI, degrees.
    metrics
        Names of the metrics wanted; ``None``: all but ``run_time``, which is not the same twice.
    executor
        Any :class:`concurrent.futures.Executor`, or a ``dask.distributed.Client``; ``None``: a thread for
        each core of the machine. The C++ core releases the interpreter's lock; making a vehicle and its
        metrics does not. So processes are faster where there are more than a few cores.
    store
        File for finished runs (SQLite), written as they finish. If it has runs of this study already, they
        are taken from there. More rows than it has are welcome: they are added.
    progress
        Bar on stderr; ``None``: if that is a terminal.
    grid
        Parameter -> values when the rows are the grid of them, last one fastest.
    title
        Of the progress bar.

    Returns
    -------
    Study
        In the order of the rows. A run that fails is a row with its reason in ``error`` and NaN as metrics.

    Raises
    ------
    ValueError
        If there are no rows, a parameter or metric is unknown, a value is NaN, or the store is of another
        study.
    StudyStoppedError
        If the executor dies, or the store can not be written any more: the disk is full or gone. Finished
        runs are in its ``study``, and those before that in the store.
    StudyInterrupted
        A KeyboardInterrupt, with the finished runs in its ``study`` and in the store.
    MassWarning
        As a warning, once, if the vehicle's class can not have the mass in some rows.
    OverlapWarning, CoreContactWarning, BalanceWarning, CoarseSkinWarning, MissedBarrierWarning,
    LowBarrierWarning, LeaningPostWarning, TippingWarning
        As warnings, each once for all runs that were run now: how many and which rows are not reliable, and
        what is wrong with the worst.
    """
    # Longer than 60 lines: whichever way a study stops, what is finished is handed out, and said.
    # What only a study needs, such as sqlite3 and multiprocessing, is loaded by the first one.
    from ..base.fingerprint import fingerprint
    from .executors import ExecutorError, run_all
    from .outcome_table import OutcomeTable
    from .store import RunStore, StoreError

    names = tuple(names)
    parts = set(parts_of(simulation.scene))
    if "vehicle" in names:
        parts |= {"joint", "sliding"}
    if "barrier" in names:
        parts |= {"segments", "posts", "moving"}
    wanted = checked_metrics(metrics, parts)
    table: Sequence[tuple[Any, ...]]
    if isinstance(rows, np.ndarray):
        table = FloatRows(np.asarray(rows, float))
    else:
        table = [tuple(_plain(value) for value in row) for row in rows]
    _check_rows(simulation, names, table)
    _warn_of_masses(simulation, names, table)
    units = {name: METRIC_UNITS[name] for name in wanted}
    study = partial(Study._of, simulation.scene, names, table, units)

    def open_store(path: str | Path) -> RunStore:
        key = fingerprint(simulation.scene, names, wanted, __version__)
        return RunStore(path, study=key, version=__version__, names=names, rows=table, units=units)

    def keep(path: Path) -> None:
        with closing(open_store(path)) as new:
            new.add(outcomes)

    def told() -> str:
        return "".join(f"; {text}" for _, text in complaints.summaries(len(outcomes)))

    complaints = Complaints()
    kept = None if store is None else open_store(store)
    outcomes = OutcomeTable(len(wanted), len(table))
    where = f"kept in {str(store)!r}" if store is not None else "kept in the error's 'study'"
    try:
        if kept is not None:
            outcomes.update(kept.finished())
        with progress_bar(progress, title, len(table), len(outcomes)) as advance:

            def finish(finished: Finished) -> None:
                new = dict(finished)
                outcomes.update(new)
                if kept is not None:
                    kept.add(new)
                advance(len(new))

            # Asked for when they are needed: none is finished before.
            todo = ((run, row) for run, row in enumerate(table) if run not in outcomes)
            run_all(simulation, names, wanted, todo, len(table) - len(outcomes), executor, finish, complaints)
    except StoreError as full:
        cause = full.__cause__
        stored = len(outcomes) - (0 if kept is None else len(kept.lost))
        message = (
            f"store {str(store)!r} can not be written ({cause}): it has {stored} of {len(table)} runs and "
            f"can be gone on with; {len(outcomes)} are finished and kept in the error's 'study'"
            f"{told()}"
        )
        raise StudyStoppedError(message, study(outcomes)) from cause
    except KeyboardInterrupt:
        message = f"stopped: {len(outcomes)} of {len(table)} runs are finished and {where}{told()}"
        raise StudyInterrupted(message, study(outcomes), keep) from None
    except ExecutorError as died:
        cause = died.__cause__
        message = (
            f"the executor died ({type(cause).__name__}: {cause}); {len(outcomes)} of {len(table)} runs are "
            f"finished and {where}{told()}"
        )
        raise StudyStoppedError(message, study(outcomes), keep) from cause
    finally:
        if kept is not None:
            kept.close()
    complaints.warn(len(table))
    if grid is not None:
        grid = {name: [_plain(value) for value in values] for name, values in grid.items()}
    return study(outcomes, grid=grid)


def checked_metrics(metrics: Sequence[str] | None, parts: Collection[str]) -> tuple[str, ...]:
    """Return the metrics of a study; those of joints and segments by themselves only where there may be.

    ``parts``: of :data:`birm3d.result.run_values.PARTS`, those that some run may have.
    """
    absent = set(PARTS) - set(parts)
    usual = tuple(name for name in _STUDY_METRICS if METRICS[name].of not in absent)
    wanted = usual if metrics is None else tuple(dict.fromkeys(metrics))
    if not wanted:
        raise ValueError("metrics must name at least one, got none")
    for name in wanted:
        if name not in METRIC_UNITS:
            raise ValueError(f"metrics must be among {', '.join(METRIC_UNITS)}; got {name!r}")
    return wanted


def _plain(value: Any) -> Any:
    """Numbers as float, so that 20 and 20.0 and numpy's are the same run."""
    if type(value) is float:
        return value
    return float(value) if is_number(value) else value


def _warn_of_masses(simulation: Simulation, names: tuple[str, ...], rows: Sequence[tuple[Any, ...]]) -> None:
    """Warn once of the masses that no vehicle of the class can have, by the one furthest from the usual."""
    usual = simulation.scene.vehicle._description.usual_mass
    if "vehicle.gvw" not in names or "vehicle" in names or usual is None:
        return
    column = names.index("vehicle.gvw")
    masses = [float(row[column]) for row in rows]
    odd = [mass for mass in masses if mass > 0.0 and not usual.holds(mass)]  # others are refused
    if odd:
        worst = max(odd, key=lambda mass: max(usual.low / mass, mass / usual.high))
        usual.warn("vehicle.gvw", worst, f" (the worst of {len(odd)} of {len(rows)} runs)")


def _check_rows(simulation: Simulation, names: tuple[str, ...], rows: Sequence[tuple[Any, ...]]) -> None:
    if not rows:
        raise ValueError("a study must have at least one run, got none")
    base = simulation
    parts = [name for name in ("vehicle", "barrier", "settings") if name in names]
    if parts:  # the first row tells what names the varied scenes have
        base = varied(simulation, {name: rows[0][names.index(name)] for name in parts})
    for name in names:
        value_of(base, name)
    for run, row in enumerate(rows):
        for name, value in zip(names, row, strict=True):
            if isinstance(value, float) and math.isnan(value):
                raise ValueError(f"{name} must be a number, got nan in run {run}")
