"""Bands of histories over the runs of a study."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from .. import pictures
from ..base.arguments import checked
from ..base.frozen_mapping import FrozenMapping
from ..base.progress import progress_bar
from ..result.history_channels import HISTORY_CHANNELS, checked_channels
from ..scene.scene import Scene
from ..simulation.simulation import run_scene
from .predict import Prediction
from .table import Study

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

    from ..result.result import Result

__all__ = ["HistoryBands", "history_bands"]

Floats = npt.NDArray[np.float64]

_MOST_NUMBERS = 50_000_000


class HistoryBands:
    """Median and band of histories, instant by instant; made by :func:`birm3d.history_bands`.

    No single run has the median or the end of a band as its history.

    Attributes
    ----------
    time : ndarray, shape (n,)
        [s].
    low, median, high : mapping of str to ndarray, shape (n,)
        Channel -> history, SI and degrees. Between low and high are `share` of the runs at each instant, as
        many below as above.
    runs : mapping of str to ndarray, shape (runs, n)
        The histories.
    share : float
    title : str
        Vehicle, mass, speed, angle and barrier, or the ranges of what was varied.
    """

    def __init__(self, time: Floats, runs: Mapping[str, Floats], share: float, title: str) -> None:
        self.time, self.share, self.title = time, share, title
        self.runs = FrozenMapping(dict(runs))
        ends = (0.5 - 0.5 * share, 0.5, 0.5 + 0.5 * share)
        bands = {name: np.quantile(all_, ends, axis=0, method="hazen") for name, all_ in runs.items()}
        for array in (*runs.values(), *bands.values()):
            array.setflags(write=False)
        self.low, self.median, self.high = (
            FrozenMapping({name: band[i] for name, band in bands.items()}) for i in range(3)
        )

    @property
    def n(self) -> int:
        """Number of runs."""
        return len(next(iter(self.runs.values())))

    def to_dataframe(self) -> pd.DataFrame:
        """Return columns low, median and high of each channel over the time, SI.

        Raises
        ------
        ImportError
            If pandas is not installed.
        """
        try:
            import pandas as pd
        except ImportError as error:
            raise ImportError("to_dataframe() needs pandas: pip install 'birm3d[table]'") from error
        columns = {
            f"{name}_{end}": getattr(self, end)[name]
            for name in self.runs
            for end in ("low", "median", "high")
        }
        return pd.DataFrame(columns, index=pd.Index(self.time, name="time"))

    def plot(self) -> Figure:
        """Return a panel for each channel: median, band, and some of the runs."""
        return pictures.plot_history_bands(self)

    def _repr_html_(self) -> str:
        return pictures.text_html(repr(self), self.plot(), "bands of histories")

    def __repr__(self) -> str:
        return f"HistoryBands({self.n} runs, {self.share:.0%} bands of {', '.join(self.runs)})"


@checked
def history_bands(
    study: Study | Prediction,
    channels: Sequence[str] = ("deceleration", "travel"),
    *,
    share: float = 0.8,
    progress: bool | None = None,
) -> HistoryBands:
    """Run the scenes of a study again and return how their histories scatter.

    All runs last as long as the longest of the study, so that each instant has all of them.

    Parameters
    ----------
    study
        Of :func:`birm3d.monte_carlo`, :func:`birm3d.predict` or another one that knows its scenes. Runs that
        failed are left out.
    channels
        Names of :data:`birm3d.result.history_channels.HISTORY_CHANNELS`.
    share
        Of the runs within the band, 0 < share < 1.
    progress
        Bar on stderr; ``None``: if that is a terminal.

    Raises
    ------
    ValueError
        If a channel is unknown or the share is out of range. If no run is left, or the runs have other output
        intervals. If the study was read from a file and so does not know its scenes.
    """
    names = checked_channels(channels)
    if not 0.0 < share < 1.0:
        raise ValueError(f"share must be > 0 and < 1, got {share}")
    table = study.study if isinstance(study, Prediction) else study
    rows = [row for row in range(len(table)) if not table.error[row]]
    if not rows:
        raise ValueError("study must have runs that did not fail, got none")
    with progress_bar(progress, "histories", 2 * len(rows)) as advance:
        scenes, ends = [], []
        for row in rows:
            scenes.append(table.simulation(row).scene)
            ends.append(_end(table, row, scenes[-1]))
            advance(1)
        longest = max(ends)
        intervals = {scene.settings.output_interval for scene in scenes}
        if len(intervals) > 1:
            raise ValueError(f"study must have one output interval, got {sorted(intervals)}")
        count = round(longest / intervals.pop())
        if (count + 1) * len(rows) * len(names) > _MOST_NUMBERS:
            raise ValueError(f"study must have at most {_MOST_NUMBERS:,} numbers in its histories, got more")
        histories: dict[str, list[Floats]] = {name: [] for name in names}
        time = np.empty(0)
        for scene in scenes:
            result = _lasting(scene, longest)
            rows_ = min(count + 1, len(result.time))
            time = result.time[:rows_]
            for name in names:
                histories[name].append(HISTORY_CHANNELS[name].values(result)[:rows_])
            advance(1)
    runs = {name: np.array(all_) for name, all_ in histories.items()}
    return HistoryBands(time, runs, share, table.scene_title)


def _end(table: Study, row: int, scene: Scene) -> float:
    """Return when the run of a row ended [s]."""
    if "end_time" in table.metrics:
        return float(table.metrics["end_time"][row])
    return float(run_scene(scene).time[-1])


def _lasting(scene: Scene, duration: float) -> Result:
    """Return the result of a scene that lasts so long."""
    return run_scene(replace(scene, duration=duration))
