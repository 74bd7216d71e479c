"""The worst place at which a row of bollards can be hit, for each of several spacings."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .. import pictures
from ..barrier.kinds import Bollards
from ..base.arguments import checked
from ..base.checks import whole_number
from ..base.shown_numbers import plain_number
from ..base.text_table import aligned
from ..result.event import outcome_words
from ..result.metrics import METRIC_UNITS
from ..simulation.parameters import varied
from ..simulation.simulation import Simulation
from ..unit_check import warn_if_any_unusual
from ..units import Quantity, si
from .impact_point import CriticalImpactPoint, critical_impact_point
from .shown_columns import metric_column, shown_metric

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

__all__ = ["SpacingPoint", "WorstOffset", "worst_offset"]

Floats = npt.NDArray[np.float64]


class SpacingPoint(NamedTuple):
    """The worst impact on a row of one spacing.

    Attributes
    ----------
    spacing : float
        Centre to centre [m].
    offset : float
        ``impact_offset`` of the worst impact [m].
    share : float
        Its distance from the nearest post over the spacing, 0 (at a post) to 0.5 (middle of a gap).
    value : float
        The metric there.
    outcome : str
        Of that run.
    search : CriticalImpactPoint
        All runs.
    """

    spacing: float
    offset: float
    share: float
    value: float
    outcome: str
    search: CriticalImpactPoint


class WorstOffset:
    """The worst impact offset of each spacing; made by :func:`birm3d.worst_offset`.

    Attributes
    ----------
    metric : str
    rows : tuple of SpacingPoint
        In the order of the spacings.
    spacing, offset, value : ndarray, shape (n,)
        Of the rows.
    resolution : tuple of float
        Between the offsets of the first scan, of each spacing [m]. A peak narrower than that can be missed.
    """

    def __init__(self, metric: str, rows: tuple[SpacingPoint, ...]) -> None:
        self.metric = metric
        self.rows = rows

    @property
    def spacing(self) -> Floats:
        """Centre to centre, shape (n,) [m]."""
        return np.array([row.spacing for row in self.rows])

    @property
    def offset(self) -> Floats:
        """``impact_offset`` of the worst impact, shape (n,) [m]."""
        return np.array([row.offset for row in self.rows])

    @property
    def value(self) -> Floats:
        """The metric there, shape (n,)."""
        return np.array([row.value for row in self.rows])

    @property
    def resolution(self) -> tuple[float, ...]:
        """Between the offsets of the first scan, of each spacing [m]."""
        return tuple(row.spacing / (len(row.search.grid) - 1) for row in self.rows)

    @property
    def worst(self) -> SpacingPoint:
        """The row with the greatest value."""
        return max(self.rows, key=lambda row: row.value)

    def to_dataframe(self) -> pd.DataFrame:
        """Return a row a spacing, SI.

        Raises
        ------
        ImportError
            If pandas is not installed.
        """
        import pandas as pd

        columns = ("spacing", "offset", "share", "value", "outcome")
        return pd.DataFrame([row[:5] for row in self.rows], columns=columns).rename(
            columns={"value": self.metric}
        )

    def to_dict(self) -> dict[str, Any]:
        """Return the table as plain values, SI."""
        names = ("spacing", "offset", "share", "value", "outcome")
        rows = [{name: getattr(row, name) for name in names} for row in self.rows]
        return {"metric": self.metric, "resolution": self.resolution, "spacings": rows}

    def summary(self) -> str:
        """Return the table and what it rests on as text."""
        size = metric_column(self.metric).divisor
        head = (
            "spacing [m]",
            "worst offset [m]",
            "from a post / spacing",
            self.label,
            "outcome",
            "runs",
        )
        cells = [head]
        for row in self.rows:
            runs = len(row.search.grid) + len(row.search.refinement)
            place = (f"{row.spacing:.4g}", f"{row.offset:.3f}", f"{row.share:.2f}")
            cells.append((*place, plain_number(row.value / size), outcome_words(row.outcome), str(runs)))
        coarsest = max(self.resolution)
        rest = f"Scanned every {coarsest:.3g} m or finer, then refined: a narrower peak can be missed."
        return "\n".join(
            [f"Scene of the greatest value: {self.worst.search.grid.scene_title}", *aligned(cells), rest]
        )

    __str__ = summary

    @property
    def words(self) -> str:
        """What tables call the metric."""
        return metric_column(self.metric).words

    @property
    def label(self) -> str:
        """The metric in words, with the unit that it is shown in."""
        return metric_column(self.metric).label

    def plot(self) -> Figure:
        """Return the metric over the offset for each spacing, and its greatest value over the spacing."""
        return pictures.plot_worst_offset(self)

    def _repr_html_(self) -> str:
        return pictures.text_html(self.summary(), self.plot(), "worst offset")

    def __repr__(self) -> str:
        worst = self.worst
        value = shown_metric(self.metric, worst.value)
        return (
            f"WorstOffset({self.metric} = {value} at spacing {worst.spacing:g} m, "
            f"offset {worst.offset:.3f} m; {len(self.rows)} spacings)"
        )


@checked
def worst_offset(
    simulation: Simulation,
    spacings: Iterable[Quantity] | None = None,
    *,
    metric: str = "peak_overturning_moment_50ms",
    points: int = 9,
    max_runs: int = 30,
    executor: Any = None,
    progress: bool | None = None,
) -> WorstOffset:
    """Return for each spacing of a row of bollards where it is worst to be hit, and how bad that is.

    At each spacing the offset is searched over one whole spacing around the row's middle, by
    :func:`birm3d.critical_impact_point`. A scan is followed by a refinement at its best point.

    Parameters
    ----------
    simulation
        A scene with a row of at least two bollards. Its own ``impact_offset`` counts for nothing.
    spacings
        Centre to centre [m]; ``None``: that of the scene.
    metric
        A name of :data:`birm3d.metrics.METRIC_UNITS` whose greatest value is the worst, as
        ``"peak_element_force_50ms"`` or ``"vehicle_penetration"``.
    points
        Offsets of the scan of each spacing, >= 3.
    max_runs
        Of the refinement of each spacing.
    executor, progress
        See :func:`birm3d.study.runner.run_study`.

    Raises
    ------
    ValueError
        Naming the argument, its limit and the value; if no run of a spacing has the metric.
    StudyInterrupted
        With the finished runs of the present spacing.

    Examples
    --------
    >>> found = birm3d.worst_offset(sim, spacings=[1.2, 1.5, 1.8], metric="vehicle_penetration")
    >>> found.offset, found.value
    """
    barrier = simulation.scene.barrier
    if not isinstance(barrier, Bollards) or barrier.count < 2:
        raise ValueError(f"simulation must have a row of at least two bollards, got {barrier}")
    if metric not in METRIC_UNITS:
        raise ValueError(f"metric must be one of {', '.join(METRIC_UNITS)}; got {metric!r}")
    points = whole_number("points", points, least=3)
    stated = [barrier.spacing] if spacings is None else list(spacings)
    wanted = [si("spacings", value, "length") for value in stated]
    warn_if_any_unusual("spacing", () if spacings is None else stated)
    if not wanted:
        raise ValueError("spacings must be at least one, got an empty list")
    for spacing in wanted:
        if not barrier.diameter < spacing < math.inf:
            raise ValueError(
                f"spacings must be finite and above the diameter ({barrier.diameter:g} m), got {spacing}"
            )
    middle = barrier.station()
    rows = []
    for spacing in wanted:
        scene = varied(simulation, {"barrier.spacing": spacing})
        search = critical_impact_point(
            scene,
            metric,
            {"impact_offset": (middle - 0.5 * spacing, middle + 0.5 * spacing)},
            points=points,
            max_runs=max_runs,
            executor=executor,
            progress=progress,
        )
        rows.append(_row(search, spacing, middle, barrier.count))
    return WorstOffset(metric, tuple(rows))


def _row(search: CriticalImpactPoint, spacing: float, middle: float, count: int) -> SpacingPoint:
    offset = search.point["impact_offset"]
    # Posts stand at whole numbers of spacings from the middle, of an even row at halves between.
    places = (offset - middle) / spacing + (0.5 if count % 2 == 0 else 0.0)
    share = abs(places - round(places))
    return SpacingPoint(spacing, offset, share, search.value, _outcome(search), search)


def _outcome(search: CriticalImpactPoint) -> str:
    """Return the outcome of the run with the value that was found."""
    for study in (search.refinement, search.grid):
        values: Floats = study[search.metric]
        at = np.flatnonzero(values == search.value)
        if len(at):
            return study.outcome[int(at[0])]
    raise AssertionError("the value that was found is that of a run")
