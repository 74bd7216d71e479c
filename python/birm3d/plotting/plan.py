"""Plan view of a trajectory."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import matplotlib as mpl
import numpy as np
import numpy.typing as npt
import shapely
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import Polygon

from ..barrier.surfaces import barrier_surfaces
from ..result.element_motion import element_motion
from ..result.event import outcome_words
from ..result.segment_motion import base_corners
from ..result.skin import Skin, skins_at
from ..vehicle.silhouette import rings, silhouette
from ..vehicle.unit_shapes import UnitShape, unit_shapes
from .figure import new_figure
from .plan_axes import PlanAxes, is_oblique
from .style import BLUE, RED, prepare, title, wrapped

if TYPE_CHECKING:
    from ..result.result import Result

__all__ = ["Instant", "draw_barrier", "draw_vehicle", "fit_to", "plot_plan"]

Floats = npt.NDArray[np.float64]

_INSTANTS = 5
_WIDTH = 10.0  # width of the figure, inches
_TEXTS = 2.3  # part of the figure's height that texts take, inches
_HEIGHTS = (3.4, 9.0)
_FLAT = 2.6  # below this height of a panel, inches, its label takes two lines
# Exit box of EN 1317-2 and MASH: depth A = a + width + 0.16 length over a length B. Cars (MASH: and pickups),
# here up to 3.5 t, have a = 2.2 m and B = 10 m; heavier vehicles a = 4.4 m and B = 20 m.
_STILL = 1e-3  # least movement of a post that is drawn (m)
_CAR = 3500.0


class Instant(NamedTuple):
    """When an outline is drawn, what it is called, and how it looks."""

    time: float
    name: str
    color: Any
    style: str
    width: float
    fill: float


def plot_plan(result: Result, times: Sequence[float] | None = None, *, exit_box: bool = True) -> Figure:
    """Return the plan view: outlines at some instants, path of the mass centre, barrier, exit box.

    Seen from above, in m from the barrier's origin. An oblique impact has the barrier's line level and its
    traffic side above; in one above 45 degrees the vehicle comes from the left. Endless walls are drawn as
    wide as the scene, and of a long barrier the part about the vehicle; the depth of a wall is only drawn.
    Free-standing segments are drawn where they ended, dashed where they stood. The outline of a vehicle of
    two units is drawn around both, with a thin line where one hides the other.

    Parameters
    ----------
    times
        Of the outlines [s]; ``None``: five, evenly spread over the run. Where the vehicle comes back the way
        it came, so that these would lie on each other: start, greatest travel and end.
    exit_box
        Whether the exit box of EN 1317-2 and MASH is drawn where a vehicle leaves a wall that it met at less
        than 45 degrees. The box begins at the last contact; wheel tracks should stay inside its depth over
        its length.

    Raises
    ------
    ValueError
        If an instant is outside the run.
    """
    scene = result.scene
    instants = _usual_instants(result) if times is None else _spread(np.asarray(times, float))
    view = PlanAxes(result)
    figure = new_figure(_WIDTH, _HEIGHTS[0])
    axes = figure.subplots()
    prepare(axes)
    shapes = unit_shapes(scene.vehicle)
    skins = skins_at(result, [instant.time for instant in instants])
    drawn: list[Floats] = []
    for order, (instant, units) in enumerate(zip(instants, skins, strict=True)):
        drawn += draw_vehicle(axes, view.plan, shapes, units, instant, 3.0 + 0.1 * order)
    for unit in range(len(shapes)):
        label = "_" if unit else "path of the mass centre"
        path = view.plan(result.pose(result.time, unit)[0])
        axes.plot(*path.T, color="k", ls="-", lw=1.0, label=label, zorder=4.0)
        drawn.append(path)
    around = np.vstack([skin.world for units in skins for skin in units])
    if exit_box and _redirected(result):
        drawn.append(_exit_box(axes, result, view.plan))
    places = np.vstack(drawn)
    draw_barrier(axes, view, around, drawn, result)
    axes.set_xlabel(view.labels[0])
    fit_to(figure, axes, _cropped(np.vstack(drawn), places), _WIDTH, _HEIGHTS, room=_TEXTS)
    flat = figure.get_figheight() - _TEXTS < _FLAT
    axes.set_ylabel(view.labels[1].replace("front of the", "front of\nthe") if flat else view.labels[1])
    told = wrapped(_outcome(result), figure)
    figure.suptitle(f"{title(result, figure)}\n{told}", fontsize="medium")
    figure.legend(loc="outside lower center", ncols=4, frameon=False, fontsize="small", borderaxespad=0.0)
    return figure


def _cropped(points: Floats, places: Floats) -> Floats:
    """Return points of the picture, so that a long barrier does not make the places of the vehicle small."""
    low, high = places.min(axis=0), places.max(axis=0)
    beyond = 0.5 * float((high - low).max())
    return np.clip(points, low - beyond, high + beyond)


def _spread(times: Floats) -> list[Instant]:
    colors = mpl.colormaps["viridis"](np.linspace(0.0, 0.85, len(times)))
    return [
        Instant(float(time), f"{time * 1e3:.0f} ms", tuple(color[:3]), "-", 1.5, 0.08)
        for time, color in zip(times, colors, strict=True)
    ]


def _usual_instants(result: Result) -> list[Instant]:
    """Return five instants evenly spread; of a vehicle that comes back start, greatest travel and end."""
    displacement = result.position[:, :2] - result.position[0, :2]
    path = result.velocity[0, :2]
    travel = displacement @ path
    farthest, end = int(np.argmax(travel)), len(travel) - 1
    aside = np.abs(displacement @ np.array([-path[1], path[0]])).max()
    if farthest == end or aside > 0.25 * travel[farthest]:
        return _spread(np.linspace(0.0, result.time[-1], _INSTANTS))

    def instant(row: int, name: str, color: Any, style: str, width: float, fill: float) -> Instant:
        time = float(result.time[row])
        return Instant(time, f"{name}, {time * 1e3:.0f} ms", color, style, width, fill)

    return [
        instant(0, "start", "0.45", "--", 1.4, 0.0),
        instant(farthest, "greatest travel", BLUE, "-", 2.0, 0.12),
        instant(end, "end", RED, "-.", 1.6, 0.0),
    ]


def draw_vehicle(
    axes: Axes,
    plan: Callable[[Floats], Floats],
    shapes: Sequence[UnitShape],
    units: Sequence[Skin],
    instant: Instant,
    order: float,
) -> list[Floats]:
    """Draw the outline around all units at an instant, and thin that of each; returns the points."""
    outlines = [
        silhouette(shape, skin.nodes, skin.center, skin.rotation)
        for shape, skin in zip(shapes, units, strict=True)
    ]
    color = mpl.colors.to_rgb(instant.color)
    drawn = []
    for k, ring in enumerate(rings(shapely.union_all(outlines))):
        polygon = plan(ring)
        look: dict[str, Any] = {
            "fc": (*color, instant.fill),
            "ec": color,
            "lw": instant.width,
            "ls": instant.style,
        }
        axes.add_patch(Polygon(polygon, label="_" if k else instant.name, zorder=order, **look))
        drawn.append(polygon)
    for outline, skin in zip(outlines, units, strict=True):
        if len(units) > 1:
            for ring in rings(outline):
                axes.plot(*plan(np.vstack([ring, ring[:1]])).T, color=color, ls="-", lw=0.6, label="_")
        axes.plot(*plan(skin.center), "o", color=color, mec="k", mew=0.6, ms=5.0, label="_", zorder=5.0)
    return drawn


def draw_barrier(axes: Axes, view: PlanAxes, world: Floats, drawn: list[Floats], result: Result) -> None:
    """Draw the barrier, endless ones past the points of the picture; its points are added to `drawn`."""
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
    _draw_tilted(axes, view, world, drawn, result)


def _draw_tilted(axes: Axes, view: PlanAxes, world: Floats, drawn: list[Floats], result: Result) -> None:
    """Draw posts that yielded as they ended."""
    motion = element_motion(result, result.time[-1:])
    if motion.movable == 0:
        return
    surfaces = barrier_surfaces(result.scene.barrier, world)
    label = "tilted posts at the end"
    for element, (corners, faces) in enumerate(surfaces):
        moved = motion.moved(0, element, corners)
        if np.abs(moved - corners).max() < _STILL:
            continue
        flat = view.plan(moved)
        axes.add_collection(PolyCollection(list(flat[faces]), fc="0.55", ec="0.55", label=label, zorder=1.6))
        label = "_"
        drawn.append(flat)


def _redirected(result: Result) -> bool:
    scene = result.scene
    flat = scene.barrier is not None and scene.barrier.is_straight
    return is_oblique(result) and flat and "exit_angle" in result.metrics


def _exit_box(axes: Axes, result: Result, plan: Callable[[Floats], Floats]) -> Floats:
    """Draw the exit box and the way straight on; returns their points in the plan."""
    vehicle = result.scene.vehicle
    a, b = (2.2, 10.0) if vehicle.mass <= _CAR else (4.4, 20.0)
    depth = a + vehicle.width + 0.16 * vehicle.length
    last = int(np.flatnonzero(result.sum_of_contact_forces > 0.0)[-1])
    leaving = result.position[last]
    direction = result.final_velocity / np.linalg.norm(result.final_velocity[:2])
    start = plan(leaving)[0]
    forward = float(np.sign(plan(leaving + direction)[0] - start))
    end = start + forward * b
    box = np.array([[start, 0.0], [start, depth], [end, depth], [end, 0.0]])
    name = f"exit box (EN 1317-2, MASH): {depth:.1f} m by {b:g} m"
    axes.plot(*box.T, color=RED, ls="--", lw=1.2, label=name, zorder=2.0)
    here = result.position[-1]
    reach = max(0.0, forward * (end - plan(here)[0]) / abs(plan(here + direction)[0] - plan(here)[0]))
    on = plan(np.stack([here, here + reach * direction]))
    axes.plot(*on.T, color="k", ls=":", lw=1.2, label="straight on", zorder=4.0)
    return np.vstack([box, on])


def _outcome(result: Result) -> str:
    metrics = result.metrics
    outcome = f"{outcome_words(result.outcome)}: {result.outcome_detail}"
    if "exit_angle" not in metrics:
        return outcome
    angle, separation = metrics["exit_angle"], metrics["time_of_separation"]
    side = "from" if angle >= 0.0 else "towards"
    return (
        f"{outcome}\nat separation, {separation * 1e3:.0f} ms: {metrics['exit_speed']:.1f} m/s, "
        f"{abs(angle):.1f}° {side} the barrier's line"
    )


def fit_to(
    figure: Figure, axes: Axes, points: Floats, width: float, heights: tuple[float, float], room: float
) -> None:
    """Limits with a margin, equal scales, and a figure as high as they ask for.

    ``width`` and least and greatest height of the figure, and ``room`` for texts, are in inches.
    """
    low, high = points.min(axis=0), points.max(axis=0)
    margin = 0.04 * float((high - low).max())
    axes.set_xlim(low[0] - margin, high[0] + margin)
    axes.set_ylim(low[1] - margin, high[1] + margin)
    axes.set_aspect("equal")
    ratio = (high[1] - low[1] + 2.0 * margin) / (high[0] - low[0] + 2.0 * margin)
    figure.set_size_inches(width, float(np.clip(0.9 * width * ratio + room, *heights)))
