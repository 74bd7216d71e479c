"""The one way up: what results, studies and calibrations show of themselves is drawn by layers above theirs.

The first half are methods of :class:`birm3d.Result`. No other module imports from a layer above its own; a
test holds this. Only what a picture needs is loaded, and only when it is made.
"""

# Longer than 300 lines: a function of a few lines for each picture.
from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Literal, TypeAlias

from .base.arguments import checked

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt
    from matplotlib.figure import Figure

    from .assessment.design_table import DesignLoad
    from .barrier.barrier import Barrier
    from .calibration.result import CalibrationResult
    from .result.load_map import LoadMap
    from .result.load_map_comparison import LoadMapComparison
    from .result.result import Result
    from .scene.scene import Scene
    from .signals.compare import CurveComparison
    from .study.fragility import Fragility
    from .study.history_bands import HistoryBands
    from .study.impact_point import CriticalImpactPoint
    from .study.limit_search import Limit
    from .study.sobol import SobolIndices
    from .study.table import Study
    from .study.verification.precision_result import WorkPrecision
    from .study.verification.stability_result import Stability
    from .study.worst_offset import WorstOffset
    from .vehicle.vehicle import Vehicle

__all__ = [
    "Color",
    "Side",
    "View",
    "animate",
    "barrier_html",
    "plot",
    "plot_comparison",
    "plot_critical_point",
    "plot_crush",
    "plot_design_load",
    "plot_elements",
    "plot_fit",
    "plot_fragility",
    "plot_histories",
    "plot_history_bands",
    "plot_limit",
    "plot_load_map",
    "plot_load_map_comparison",
    "plot_plan",
    "plot_profiles",
    "plot_requested_vs_achieved",
    "plot_residuals",
    "plot_runs",
    "plot_sobol",
    "plot_stability",
    "plot_study",
    "plot_vehicle",
    "plot_work_precision",
    "plot_worst_offset",
    "render",
    "result_html",
    "scene_html",
    "show",
    "study_html",
    "table_html",
    "text_html",
    "vehicle_html",
    "write_gltf",
    "write_html",
    "write_vtk",
]

View: TypeAlias = Literal["three_quarter", "side", "top", "front", "driver"]
Color: TypeAlias = Literal["crush", "zone", "plain"]
Side: TypeAlias = Literal["front", "rear", "left", "right"]


@checked
def plot(self: Result) -> Figure:
    """Return a figure of force, motion, angles and energies against time."""
    from .plotting import plot_result

    return plot_result(self)


@checked
def plot_histories(self: Result) -> Figure:
    """Return time histories with their filter class; see :func:`birm3d.plotting.plot_histories`."""
    from .plotting import plot_histories

    return plot_histories(self)


@checked
def plot_plan(self: Result, times: Sequence[float] | None = None, *, exit_box: bool = True) -> Figure:
    """Return the plan view of the trajectory; see :func:`birm3d.plotting.plot_plan`."""
    from .plotting import plot_plan

    return plot_plan(self, times, exit_box=exit_box)


@checked
def plot_crush(
    self: Result, side: Side | None = None, *, height: float | None = None, unit: int = 0
) -> Figure:
    """Return crush map and profile of one side, the struck one if none is given.

    See :func:`birm3d.plotting.plot_crush`.
    """
    from .plotting import plot_crush

    return plot_crush(self, side, height=height, unit=unit)


@checked
def plot_elements(self: Result) -> Figure:
    """Return the loads on the barrier's elements over time; see :func:`birm3d.plotting.plot_elements`."""
    from .plotting import plot_elements

    return plot_elements(self)


@checked
def render(
    self: Result,
    time: float | Sequence[float] | str | Path | None = None,
    path: str | Path | None = None,
    *,
    view: View = "three_quarter",
    color: Color = "crush",
    size: tuple[int, int] = (1280, 720),
    follow: bool = False,
) -> npt.NDArray[np.uint8]:
    """Return 3-D pictures of some instants, drawn off-screen; see :func:`birm3d.rendering.render`.

    ``render("end.png")`` writes the end to a file, as ``animate("crash.mp4")`` writes the whole run.
    """
    from .rendering import render

    return render(self, time, path, view=view, color=color, size=size, follow=follow)


@checked
def animate(
    self: Result,
    path: str | Path,
    *,
    frames: int = 100,
    fps: float = 25.0,
    view: View = "three_quarter",
    color: Color = "crush",
    size: tuple[int, int] = (1280, 720),
    follow: bool = False,
    progress: bool | None = None,
) -> None:
    """Write a movie of the whole run (.mp4, .gif, ...); see :func:`birm3d.rendering.animate`."""
    from .rendering import animate

    animate(
        self,
        path,
        frames=frames,
        fps=fps,
        view=view,
        color=color,
        size=size,
        follow=follow,
        progress=progress,
    )


@checked
def show(self: Result, *, view: View = "three_quarter", color: Color = "crush") -> None:
    """Open a window with the scene in three dimensions; see :func:`birm3d.rendering.show`."""
    from .rendering import show

    show(self, view=view, color=color)


@checked
def write_html(self: Result, path: str | Path, *, frames: int = 61, crush: bool = True) -> None:
    """Write one self-contained, interactive page; see :func:`birm3d.html_page.write_html`."""
    from .html_page import write_html

    write_html(self, path, frames=frames, crush=crush)


@checked
def write_gltf(self: Result, path: str | Path, *, frames: int = 41) -> None:
    """Write the run as glTF for Blender and browsers (.glb, .gltf); see :func:`birm3d.export.write_gltf`."""
    from .export import write_gltf

    write_gltf(self, path, frames=frames)


@checked
def write_vtk(self: Result, path: str | Path, *, frames: int = 101) -> None:
    """Write the run as a series that ParaView opens (.pvd); see :func:`birm3d.export.write_vtk`."""
    from .export import write_vtk

    write_vtk(self, path, frames=frames)


def plot_comparison(comparison: CurveComparison) -> Figure:
    """Return a figure of both curves and the residuals with their band."""
    from .plotting import plot_comparison

    return plot_comparison(comparison)


def plot_study(study: Study, x: str, y: str, by: str | None) -> Figure:
    """Return a figure of one column of a study against another."""
    from .plotting.studies import plot_study

    return plot_study(study, x, y, by)


def plot_fragility(curve: Fragility) -> Figure:
    """Return a figure of counted probabilities and the fit."""
    from .plotting.studies import plot_fragility

    return plot_fragility(curve)


def plot_critical_point(point: CriticalImpactPoint) -> Figure:
    """Return a figure of a metric over the ranges that were searched."""
    from .plotting.uncertainty import plot_critical_point

    return plot_critical_point(point)


def plot_design_load(loads: DesignLoad) -> Figure:
    """Return a figure of loads by element, histories and the response spectrum."""
    from .plotting.design_loads import plot_design_load

    return plot_design_load(loads)


def plot_load_map(map_: LoadMap, time: float | None) -> Figure:
    """Return a picture of the load on a wall by cell."""
    from .plotting.load_maps import plot_load_map

    return plot_load_map(map_, time)


def plot_load_map_comparison(comparison: LoadMapComparison, quantity: str) -> Figure:
    """Return a picture of a measured load map, a computed one and their difference."""
    from .plotting.load_map_comparison import plot_load_map_comparison

    return plot_load_map_comparison(comparison, quantity)


def plot_history_bands(bands: HistoryBands) -> Figure:
    """Return a figure of medians and bands over time."""
    from .plotting.runs import plot_history_bands

    return plot_history_bands(bands)


@checked
def plot_runs(
    results: Sequence[Result],
    channels: Sequence[str] = ("barrier_force", "deceleration", "velocity", "travel"),
    labels: Sequence[str] | None = None,
) -> Figure:
    """Return histories of several runs, laid over each other, a panel for each channel.

    The title says what the scenes have in common, the legend in what they differ.

    Parameters
    ----------
    results
        1 to 8 of them.
    channels
        Names of :data:`birm3d.result.history_channels.HISTORY_CHANNELS`: ``"deceleration"``,
        ``"barrier_force"``, ``"velocity"``, ``"travel"``, ``"roll"``, ``"pitch"``, ``"yaw"``.
    labels
        One text for each run, shown in the legend instead of the inputs that differ.

    Raises
    ------
    ValueError
        If there are no or too many results, a channel is unknown, or the labels are not as many as the runs.
    """
    from .plotting.runs import plot_runs

    return plot_runs(results, channels, labels)


def plot_limit(limit: Limit) -> Figure:
    """Return a figure of the runs of a search over what was searched, with the limit."""
    from .plotting.searches import plot_limit

    return plot_limit(limit)


def plot_worst_offset(found: WorstOffset) -> Figure:
    """Return a figure of a metric over the offset for each spacing, and of its greatest values."""
    from .plotting.searches import plot_worst_offset

    return plot_worst_offset(found)


def plot_sobol(indices: SobolIndices, metrics: Sequence[str] | None) -> Figure:
    """Return a figure of bars of first and total order."""
    from .plotting.uncertainty import plot_sobol

    return plot_sobol(indices, metrics)


def plot_work_precision(study: WorkPrecision, metrics: Collection[str] | None) -> Figure:
    """Return a figure of error against cost."""
    from .plotting.precision import plot_work_precision

    return plot_work_precision(study, metrics)


def plot_requested_vs_achieved(study: WorkPrecision, metrics: Collection[str] | None) -> Figure:
    """Return a figure of error against tolerance."""
    from .plotting.precision import plot_requested_vs_achieved

    return plot_requested_vs_achieved(study, metrics)


def plot_stability(study: Stability) -> Figure:
    """Return a figure of the energy residual of every row."""
    from .plotting.stability import plot_stability

    return plot_stability(study)


def plot_fit(calibration: CalibrationResult) -> Figure:
    """Return a figure of measured and computed curves."""
    from .plotting.calibration import plot_fit

    return plot_fit(calibration)


def plot_residuals(calibration: CalibrationResult) -> Figure:
    """Return a figure of what the fit leaves."""
    from .plotting.calibration import plot_residuals

    return plot_residuals(calibration)


def plot_profiles(calibration: CalibrationResult) -> Figure:
    """Return a figure of the profiles of all parameters."""
    from .plotting.calibration import plot_profiles

    return plot_profiles(calibration)


def plot_vehicle(vehicle: Vehicle) -> Figure:
    """Return a figure of what a vehicle is made of; see :func:`birm3d.plotting.plot_vehicle`."""
    from .plotting.vehicle_views import plot_vehicle

    return plot_vehicle(vehicle)


def result_html(result: Result) -> str:
    """Return what notebooks show of a result."""
    from .html_page.notebook import result_html

    return result_html(result)


def study_html(study: Study) -> str:
    """Return what notebooks show of a study."""
    from .html_page.notebook import study_html

    return study_html(study)


def vehicle_html(vehicle: Vehicle) -> str:
    """Return what notebooks show of a vehicle."""
    from .html_page.scene_cards import vehicle_html

    return vehicle_html(vehicle)


def barrier_html(barrier: Barrier) -> str:
    """Return what notebooks show of a barrier."""
    from .html_page.scene_cards import barrier_html

    return barrier_html(barrier)


def scene_html(scene: Scene) -> str:
    """Return what notebooks show of a simulation."""
    from .html_page.scene_cards import scene_html

    return scene_html(scene)


def table_html(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return what notebooks show of a table."""
    from .html_page.notebook import table_html

    return table_html(head, rows)


def text_html(text: str, figure: Figure | None, name: str) -> str:
    """Return what notebooks show of a text with a figure."""
    from .html_page.notebook import text_html

    return text_html(text, figure, name)
