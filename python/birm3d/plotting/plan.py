"""Plan view of a trajectory."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import Polygon

from ..barrier_kinds import Jersey, RigidWall
from ..free_standing import base_corners
from ..plan_axes import PlanAxes, is_oblique
from ..silhouette import silhouette
from ..skin import skins_at
from ..unit_shapes import unit_shapes
from .style import RED, prepare, title

if TYPE_CHECKING:
    from ..result import Result

__all__ = ["plot_plan"]

Floats = npt.NDArray[np.float64]

_INSTANTS = 5
_WIDTH = 10.0  # of the figure, inches
_HEIGHTS = (4.5, 9.0)
# Exit box of EN 1317-2 and MASH: depth A = a + width + 0.16 length over a length B. Cars (MASH: and pickups),
# here up to 3.5 t, have a = 2.2 m and B = 10 m; heavier vehicles a = 4.4 m and B = 20 m.
_CAR = 3500.0


def plot_plan(result: Result, times: Sequence[float] | None = None, *, exit_box: bool = True) -> Figure:
    """Return the plan view: outlines at some instants, path of the mass centre, barrier, exit box.

    Seen from above, in m from the barrier's origin. An oblique impact has the barrier's line level and its
    traffic side above; in one above 45 degrees the vehicle comes from the left. Endless walls are drawn as
    wide as the scene; the depth of a wall is only drawn. Free-standing segments are drawn where they ended,
    dashed where they stood.

    Parameters
    ----------
    times
        Of the outlines [s]; ``None``: five, evenly spread over the run.
    exit_box
        Whether the exit box of EN 1317-2 and MASH is drawn where a vehicle leaves a wall that it met at less
        than 45 degrees: from the last contact over its length, wheel tracks should stay inside its depth.

    Raises
    ------
    ValueError
        If an instant is outside the run.
    """
    scene = result.scene
    instants = np.linspace(0.0, result.time[-1], _INSTANTS) if times is None else np.asarray(times, float)
    view = PlanAxes(result)
    plan = view.plan
    figure = Figure(layout="constrained")
    axes = figure.subplots()
    prepare(axes)
    shapes = unit_shapes(scene.vehicle)
    skins = skins_at(result, instants)
    drawn = []
    colors = mpl.colormaps["viridis"](np.linspace(0.0, 0.85, len(instants)))
    for time, color, units in zip(instants, colors, skins, strict=True):
        for unit, (shape, skin) in enumerate(zip(shapes, units, strict=True)):
            polygon = plan(silhouette(shape, skin.nodes, skin.center, skin.turn))
            label = "_" if unit else f"{time * 1e3:.0f} ms"
            axes.add_patch(Polygon(polygon, fc=(*color[:3], 0.08), ec=color, lw=1.5, label=label, zorder=3.0))
            axes.plot(*plan(skin.center), "o", color=color, mec="k", mew=0.6, ms=5.0, label="_", zorder=5.0)
            drawn.append(polygon)
    for unit in range(len(shapes)):
        label = "_" if unit else "path of the mass centre"
        path = plan(result.pose(result.time, unit)[0])
        axes.plot(*path.T, color="k", ls="-", lw=1.0, label=label, zorder=4.0)
        drawn.append(path)
    around = np.vstack([skin.world for units in skins for skin in units])
    if exit_box and _redirected(result):
        drawn.append(_exit_box(axes, result, plan))
    _draw_barrier(axes, view, around, drawn, result)
    axes.set_xlabel(view.labels[0])
    axes.set_ylabel(view.labels[1])
    _fit(figure, axes, np.vstack(drawn))
    axes.set_title(f"{title(result)}\n{_outcome(result)}", fontsize="medium")
    figure.legend(loc="outside lower center", ncols=6, frameon=False, fontsize="small")
    return figure


def _draw_barrier(axes: Axes, view: PlanAxes, world: Floats, drawn: list[Floats], result: Result) -> None:
    if result.segment_yaw.shape[1]:
        corners = view.plan(base_corners(result)[[0, -1]])
        looks: tuple[dict[str, Any], ...] = (
            {"fc": "none", "ec": "0.4", "ls": "--", "lw": 0.8, "label": "barrier at the start"},
            {"fc": "0.75", "ec": "0.5", "lw": 0.6, "label": "barrier at the end"},
        )
        for base, look in zip(corners, looks, strict=True):
            axes.add_collection(PolyCollection(list(base), zorder=1.5, **look))
            drawn.extend(base)
        return
    for part, (flat, faces) in enumerate(view.barrier(world, np.vstack(drawn))):
        label = "_" if part else "barrier"
        axes.add_collection(
            PolyCollection(list(flat[faces]), fc="0.75", ec="0.75", lw=0.6, label=label, zorder=1.5)
        )
        drawn.append(flat)


def _redirected(result: Result) -> bool:
    scene = result.scene
    flat = isinstance(scene.barrier, (RigidWall, Jersey))
    return is_oblique(result) and flat and "exit_angle" in result.metrics


def _exit_box(axes: Axes, result: Result, plan: Callable[[Floats], Floats]) -> Floats:
    """Draw the exit box and the way straight on; returns their points in the plan."""
    rest = np.vstack([shape.nodes for shape in unit_shapes(result.scene.vehicle)])
    length, width = (float(np.ptp(rest[:, i])) for i in (0, 1))
    a, b = (2.2, 10.0) if result.scene.vehicle.mass <= _CAR else (4.4, 20.0)
    depth = a + width + 0.16 * length
    last = int(np.flatnonzero(result.sum_of_contact_forces > 0.0)[-1])
    leaving = result.position[last]
    way = result.final_velocity / np.linalg.norm(result.final_velocity[:2])
    start = plan(leaving)[0]
    forward = float(np.sign(plan(leaving + way)[0] - start))
    end = start + forward * b
    box = np.array([[start, 0.0], [start, depth], [end, depth], [end, 0.0]])
    name = f"exit box (EN 1317-2, MASH): {depth:.1f} m by {b:g} m"
    axes.plot(*box.T, color=RED, ls="--", lw=1.2, label=name, zorder=2.0)
    here = result.position[-1]
    reach = max(0.0, forward * (end - plan(here)[0]) / abs(plan(here + way)[0] - plan(here)[0]))
    on = plan(np.stack([here, here + reach * way]))
    axes.plot(*on.T, color="k", ls=":", lw=1.2, label="straight on", zorder=4.0)
    return np.vstack([box, on])


def _outcome(result: Result) -> str:
    metrics = result.metrics
    if "exit_angle" not in metrics:
        return f"{result.end_reason} after {result.time[-1] * 1e3:.0f} ms at {metrics['exit_speed']:.1f} m/s"
    return (
        f"leaves at {metrics['exit_speed']:.1f} m/s, {metrics['exit_angle']:.1f}° from the barrier's line; "
        f"turned by {round(result.yaw[-1], 1) + 0.0:.1f}° after {result.time[-1] * 1e3:.0f} ms"
    )


def _fit(figure: Figure, axes: Axes, points: Floats) -> None:
    """Limits with a margin, equal scales, and a figure as high as they ask for."""
    low, high = points.min(axis=0), points.max(axis=0)
    margin = 0.04 * float((high - low).max())
    axes.set_xlim(low[0] - margin, high[0] + margin)
    axes.set_ylim(low[1] - margin, high[1] + margin)
    axes.set_aspect("equal")
    ratio = (high[1] - low[1] + 2.0 * margin) / (high[0] - low[0] + 2.0 * margin)
    figure.set_size_inches(_WIDTH, float(np.clip(0.9 * _WIDTH * ratio + 1.6, *_HEIGHTS)))
