"""The outcome of many runs: a labelled table."""

# Longer than 300 lines: one class: the table of a study.
from __future__ import annotations

import csv
import json
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .. import pictures
from .._version import __version__
from ..barrier.text import varied_barrier_text
from ..base.arguments import checked
from ..base.frozen_mapping import FrozenMapping
from ..base.near_names import did_you_mean
from ..result.event import OUTCOMES
from ..scene.text import varied_scene_text
from ..simulation.parameters import unit_of
from ..vehicle.title import title_of_name
from .float_rows import FloatRows

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.figure import Figure

    from ..scene.scene import Scene
    from ..simulation.simulation import Simulation
    from .outcome_table import OutcomeTable

__all__ = ["Study", "Summary"]

_FORMAT = "birm3d study 2"
_OLD_FORMAT = "birm3d study 1"  # had no checksum
_TEXTS = ("outcome", "end_reason", "state_hash", "error")
_WORDS = {"None": None, "True": True, "False": False}  # values of parameters as a file shows them


class Summary(NamedTuple):
    """Of a metric over n runs, in its unit. ``standard_deviation`` and ``standard_error`` need n >= 2."""

    n: int
    mean: float
    standard_deviation: float | None
    standard_error: float | None
    p05: float
    median: float
    p95: float


@checked
class Study:
    """Parameters, metrics and the end of n runs; immutable, in the order in which the runs were asked for.

    Attributes
    ----------
    vehicle : str
        Name of the vehicle that was varied.
    barrier : str
        Kind, count and sizes of the barrier; empty for an ensemble and for files of older versions.
    run : ndarray of int, shape (n,)
        Numbers of the runs; not all of them when the study was stopped.
    parameters : mapping of str to ndarray, shape (n,)
        Numbers are float, SI and degrees; other values are shown as text.
    metrics : mapping of str to ndarray, shape (n,)
        SI and degrees. NaN: the run failed (then ``error`` says why) or does not have this metric, as an exit
        angle of a vehicle that stands.
    outcome, end_reason, state_hash, error : tuple of str
        ``outcome`` is a word of :data:`birm3d.result.event.OUTCOMES`, empty for a run that failed. ``error``
        is empty for a run that did not fail, else the type and message of the exception.
    units : mapping of str to str
        Of parameters and metrics; ``""`` for pure numbers.
    grid : mapping of str to tuple, or None
        The values of each parameter, if the runs are a grid; the last parameter changes fastest.
    version : str
        Of the package that made the runs.

    Notes
    -----
    :meth:`simulation` makes the simulation of a row anew.
    """

    def __init__(
        self,
        *,
        vehicle: str,
        barrier: str = "",
        run: npt.ArrayLike,
        parameters: Mapping[str, Sequence[Any] | npt.NDArray[Any]],
        metrics: Mapping[str, npt.ArrayLike],
        end_reason: Sequence[str],
        state_hash: Sequence[str],
        error: Sequence[str],
        outcome: Sequence[str] | None = None,
        units: Mapping[str, str],
        grid: Mapping[str, Sequence[Any]] | None = None,
        version: str = __version__,
        scene: Scene | None = None,
        given: Mapping[str, Sequence[Any]] | None = None,
    ) -> None:
        self.vehicle = vehicle
        self.barrier = barrier
        if np.ndim(run) != 1:
            raise ValueError(f"run must have shape (n,), got {np.shape(run)}")
        self.run = _read_only(run, np.int64)
        self.parameters = FrozenMapping({name: _read_only(v) for name, v in parameters.items()})
        self.metrics = FrozenMapping({name: _read_only(v, float) for name, v in metrics.items()})
        self.outcome = ("",) * len(self.run) if outcome is None else tuple(outcome)
        self.end_reason = tuple(end_reason)
        self.state_hash = tuple(state_hash)
        self.error = tuple(error)
        self.units = FrozenMapping(dict(units))
        self.grid = None if grid is None else FrozenMapping({k: tuple(v) for k, v in grid.items()})
        self.version = version
        self._scene = scene  # that was varied
        self._given = {name: tuple(values) for name, values in (given or {}).items()}  # that are no numbers

    @classmethod
    def _of(
        cls,
        scene: Scene | None,
        names: Sequence[str],
        rows: Sequence[Sequence[Any]],
        metric_units: Mapping[str, str],
        outcomes: OutcomeTable,
        grid: Mapping[str, Sequence[Any]] | None = None,
    ) -> Study:
        runs = outcomes.runs
        values = {name: _column_of(rows, runs, i) for i, name in enumerate(names)}
        return cls(
            vehicle="ensemble" if scene is None else scene.vehicle.name,
            barrier="" if scene is None else varied_barrier_text(scene.barrier, names),
            run=runs,
            parameters=values,
            metrics=dict(zip(metric_units, outcomes.metrics(), strict=True)),
            outcome=outcomes.outcomes(),
            end_reason=outcomes.end_reasons(),
            state_hash=outcomes.state_hashes(),
            error=outcomes.errors(),
            units={**{name: unit_of(name) for name in names}, **metric_units},
            grid=None if grid is None else {name: _column(values).tolist() for name, values in grid.items()},
            scene=scene,
            given={
                name: [rows[run][i] for run in runs.tolist()]
                for i, name in enumerate(names)
                if values[name].dtype.kind != "f"
            },
        )

    @staticmethod
    def joined(studies: Sequence[Study]) -> Study:
        """Return the runs of several studies of the same columns, one after the other, numbered anew."""
        if len(studies) == 0:
            raise ValueError("studies must be at least one, got none")
        first = studies[0]

        def column(name: str) -> npt.NDArray[Any]:
            return np.concatenate([study[name] for study in studies])

        return Study(
            vehicle=first.vehicle,
            barrier=first.barrier if len({study.barrier for study in studies}) == 1 else "several barriers",
            run=np.arange(sum(len(study) for study in studies)),
            parameters={name: column(name) for name in first.parameters},
            metrics={name: column(name) for name in first.metrics},
            outcome=[text for study in studies for text in study.outcome],
            end_reason=[text for study in studies for text in study.end_reason],
            state_hash=[text for study in studies for text in study.state_hash],
            error=[text for study in studies for text in study.error],
            units=first.units,
            version=first.version,
            scene=first._scene if all(study._scene is first._scene for study in studies) else None,
            given={
                name: [value for study in studies for value in study._given.get(name, study[name].tolist())]
                for name in first.parameters
                if any(name in study._given for study in studies)
            },
        )

    def __len__(self) -> int:
        return len(self.run)

    def __getitem__(self, name: str) -> npt.NDArray[Any]:
        """Return a column: a parameter, a metric, or ``outcome`` as text, shape (n,)."""
        if name == "outcome":
            return _read_only(self.outcome, object)
        for columns in (self.parameters, self.metrics):
            if name in columns:
                return columns[name]
        raise KeyError(
            f"column must be one of {', '.join((*self.parameters, *self.metrics, 'outcome'))}; got {name!r}"
        )

    @property
    def title(self) -> str:
        """Vehicle and barrier: what tables of the study are headed with."""
        name = title_of_name(self.vehicle) if self._scene is None else self._scene.vehicle.title
        return f"{name}: {self.barrier}" if self.barrier else name

    @property
    def scene_title(self) -> str:
        """Vehicle, mass, speed, angle and barrier, or the ranges of what varies; of a file :attr:`title`."""
        if self._scene is None:
            return self.title
        return varied_scene_text(self._scene, self.parameters, self.barrier)

    @property
    def outcomes(self) -> Mapping[str, int]:
        """Each outcome that runs have -> how many, ordered as :data:`birm3d.result.event.OUTCOMES`."""
        return {word: n for word in OUTCOMES if (n := self.outcome.count(word))}

    def simulation(self, row: int, base: Simulation | None = None) -> Simulation:
        """Return the simulation of a row, at t = 0: its run ends in the row's ``state_hash``.

        Parameters
        ----------
        row
            Place in the columns, 0 to n - 1; of a study that was stopped not the number of the run.
        base
            The simulation that was varied. A study that was read from a file needs it.

        Raises
        ------
        ValueError
            If there is no such row, or the study needs a base and has none. If the row's scene can not be
            made, as ``error`` says too.
        """
        from ..simulation.parameters import varied
        from ..simulation.simulation import Simulation

        if isinstance(row, bool) or not isinstance(row, (int, np.integer)) or not 0 <= row < len(self):
            raise ValueError(f"row must be a whole number from 0 to {len(self) - 1}, got {row!r}")
        if not self.parameters:
            raise ValueError(
                "row must be of a study over parameters, got one of an ensemble, whose caller has it"
            )
        if base is None and self._scene is None:
            raise ValueError(
                "base must be the simulation that was varied where a study is from a file, got None"
            )
        origin = Simulation.from_scene(self._scene) if base is None and self._scene is not None else base
        if not isinstance(origin, Simulation):
            raise ValueError(f"base must be a birm3d.Simulation, got {type(base).__name__}")
        return varied(origin, {name: self._value(name, int(row)) for name in self.parameters})

    def _value(self, name: str, row: int) -> Any:
        """Return a parameter of a row as it was given; of a study from a file as far as its text tells."""
        if name in self._given:
            return self._given[name][row]
        value = self.parameters[name][row]
        try:
            return float(value)  # also where a column has texts beside numbers
        except ValueError:
            return _WORDS.get(value, value)

    def __reduce__(self) -> tuple[Any, ...]:
        names = ("vehicle", "barrier", "run", "parameters", "metrics", *_TEXTS, "units", "grid", "version")
        content = {name: getattr(self, name) for name in names}
        return (_rebuild, ({**content, "scene": self._scene, "given": self._given},))

    @property
    def failed(self) -> Mapping[int, str]:
        """Number of each run that failed -> its reason."""
        return {int(run): error for run, error in zip(self.run, self.error, strict=True) if error}

    def summary(self) -> dict[str, Summary]:
        """Return mean, spread and quantiles of each metric that a run has, over the runs that have it."""
        rows = {name: values[np.isfinite(values)] for name, values in self.metrics.items()}
        return {name: _summary(values) for name, values in rows.items() if len(values)}

    def columns(self) -> dict[str, npt.NDArray[Any]]:
        """Return all columns: parameters, metrics, outcome, end_reason, state_hash, error."""
        texts = {name: np.array(getattr(self, name), dtype=object) for name in _TEXTS}
        return {**self.parameters, **self.metrics, **texts}

    def to_dataframe(self) -> pd.DataFrame:
        """Return a table, one row a run, indexed by its number; units are in ``attrs["units"]``."""
        try:
            import pandas as pd
        except ImportError as error:
            raise ImportError("to_dataframe() needs pandas: pip install 'birm3d[table]'") from error
        table = pd.DataFrame(self.columns(), index=pd.Index(self.run, name="run"))
        table.attrs["units"] = dict(self.units)
        return table

    def to_xarray(self) -> xr.Dataset:
        """Return a labelled data set: over the parameters of the grid, or over ``run`` if there is none."""
        try:
            import xarray as xr
        except ImportError as error:
            raise ImportError("to_xarray() needs xarray: pip install 'birm3d[studies]'") from error
        grid = {"run": tuple(self.run)} if self.grid is None else dict(self.grid)
        dims = tuple(grid)
        shape = tuple(len(values) for values in grid.values())
        data = xr.Dataset(coords={name: (name, list(values)) for name, values in grid.items()})
        for name, values in self.columns().items():
            if name not in grid:
                data[name] = (dims, values.reshape(shape))
        for name, unit in self.units.items():
            data[name].attrs["units"] = unit
        data.attrs.update(vehicle=self.vehicle, barrier=self.barrier, birm3d_version=self.version)
        return data

    def save(self, path: str | Path) -> None:
        """Write a CSV file whose first line is a comment with units and the rest, as JSON; see :meth:`load`.

        Numbers are written with all their digits; a metric that a run does not have is an empty cell.
        """
        from ..io.atomic_write import whole_file
        from ..io.file_format import checksum

        columns = self.columns()
        head = {
            "format": _FORMAT,
            "version": self.version,
            "vehicle": self.vehicle,
            "barrier": self.barrier,
            "units": dict(self.units),
            "parameters": {name: values.dtype.kind for name, values in self.parameters.items()},
            "grid": None if self.grid is None else dict(self.grid),
        }
        names = ["run", *columns]
        lines = [
            [str(int(run)), *(_text(column[i]) for column in columns.values())]
            for i, run in enumerate(self.run)
        ]
        head["checksum"] = checksum([head, names, lines])
        with whole_file(path) as part, part.open("w", encoding="utf-8", newline="") as file:
            file.write("# " + json.dumps(head) + "\n")
            csv.writer(file, lineterminator="\n").writerows([names, *lines])

    @staticmethod
    def load(path: str | Path) -> Study:
        """Read a file of :meth:`save`: the same study, bit for bit.

        Raises
        ------
        FileFormatError
            With the line, if the file is no study, is damaged, or was changed after it was written.
        """
        from .table_file import read_table

        return Study(**read_table(Path(path), (_FORMAT, _OLD_FORMAT), _TEXTS))

    def plot(self, x: str, y: str, by: str | None = None) -> Figure:
        """Return a figure of column `y` against `x`, a line for each value of `by`, without failed runs."""
        known = (*self.parameters, *self.metrics, "outcome")
        for axis, name in (("x", x), ("y", y), ("by", by)):
            if name is not None and name not in known:
                raise ValueError(
                    f"{axis} must be one of {', '.join(known)}; got {name!r}{did_you_mean(name, known)}"
                )
        return pictures.plot_study(self, x, y, by)

    def _repr_html_(self) -> str:
        """Return what notebooks show: outcomes, parameters, the spread of the metrics, a scatter."""
        return pictures.study_html(self)

    def __repr__(self) -> str:
        failed = len(self.failed)
        return (
            f"Study({self.vehicle}, {len(self)} runs over {', '.join(self.parameters)}"
            f"{f', {failed} failed' if failed else ''}; metrics: {', '.join(self.metrics)})"
        )


def _rebuild(content: dict[str, Any]) -> Study:
    return Study(**content)


def _summary(values: npt.NDArray[np.float64]) -> Summary:
    n = len(values)
    deviation = float(np.std(values, ddof=1)) if n > 1 else None
    error = None if deviation is None else deviation / math.sqrt(n)
    p05, median, p95 = np.quantile(values, [0.05, 0.5, 0.95]).tolist()
    return Summary(n, float(np.mean(values)), deviation, error, p05, median, p95)


def _column(values: Sequence[Any]) -> npt.NDArray[Any]:
    """Numbers as float; anything else as text, a vehicle by its name."""
    if all(isinstance(value, float) for value in values):
        return np.array(values, float)
    return np.array([str(getattr(value, "name", value)) for value in values], dtype=object)


def _column_of(rows: Sequence[Sequence[Any]], runs: npt.NDArray[np.int64], i: int) -> npt.NDArray[Any]:
    """Return parameter `i` of some runs."""
    if isinstance(rows, FloatRows):
        column: npt.NDArray[np.float64] = rows.array[runs, i]
        return column
    return _column([rows[run][i] for run in runs.tolist()])


def _read_only(values: npt.ArrayLike, kind: Any = None) -> npt.NDArray[Any]:
    if isinstance(values, np.ndarray) and not values.flags.writeable and kind in (None, values.dtype):
        return values  # nobody changes it: columns of a million runs are not copied
    array = np.array(values, kind)
    array.setflags(write=False)
    return array


def _text(value: Any) -> str:
    if isinstance(value, float):
        return "" if math.isnan(value) else repr(float(value))
    return str(value)
