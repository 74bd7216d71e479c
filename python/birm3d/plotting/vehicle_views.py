"""What a vehicle is made of, from four sides: skin by zones, rigid core, wheels, mass centre, sizes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import matplotlib as mpl
import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Patch, Rectangle

from ..vehicle.title import vehicle_text
from .figure import new_figure
from .style import RED, prepare

if TYPE_CHECKING:
    from ..vehicle.vehicle import Vehicle

__all__ = ["plot_vehicle"]

Floats = npt.NDArray[np.float64]

_WIDTH = 11.0  # inches
_MOST_LINES = 6  # assumptions that are written below the figure
_LETTERS = 150


class _View(NamedTuple):
    """One side: file axes to the right and upwards with their signs, and where it is seen from."""

    name: str
    right: int
    up: int
    toward: tuple[float, float, float]
    flip: bool = False


_VIEWS = (
    _View("left side, front to the left", 0, 2, (0.0, 1.0, 0.0), flip=True),
    _View("front", 1, 2, (1.0, 0.0, 0.0)),
    _View("from above, front to the left", 0, 1, (0.0, 0.0, 1.0), flip=True),
    _View("rear", 1, 2, (-1.0, 0.0, 0.0), flip=True),
)


def plot_vehicle(vehicle: Vehicle) -> Figure:
    """Return a figure of a vehicle: what its file, or the mesh that it was made from, was understood as.

    The skin is coloured by the zones whose laws it has; dashed boxes are the rigid core, circles the wheels,
    the cross is the mass centre. All in axes of the vehicle's file: x forward from the first axle, y left,
    z up from the ground [m]. Of a vehicle of two units they are those of the leading one.
    """
    parts = _parts(vehicle)
    names = [name for part in parts for name in part.unit.zones]
    colors = mpl.colormaps["tab20"](np.arange(max(1, len(names))) % 20)
    told = _caption(vehicle)
    figure = new_figure(_WIDTH, 8.0 if told else 7.2)
    grid = figure.add_gridspec(3, 2, width_ratios=(2.2, 1.0), height_ratios=(1.0, 1.0, 0.3 if told else 0.01))
    for number, view in enumerate(_VIEWS):
        axes = figure.add_subplot(grid[number // 2, number % 2])
        prepare(axes)
        _draw(axes, vehicle, parts, view, colors)
    size = f"{vehicle.length:.2f} x {vehicle.width:.2f} x {vehicle.height:.2f} m"
    spacing = vehicle.units[0].node_spacing
    nodes = f"{vehicle.n_nodes:,} nodes, {spacing * 1e3:.0f} mm apart"
    base = "" if vehicle.wheelbase is None else f", wheelbase {vehicle.wheelbase:.2f} m"
    figure.suptitle(
        f"{vehicle_text(vehicle)}, {size}{base}; {nodes}\n{_mass_text(vehicle)}",
        fontsize="medium",
    )
    met = [name for name in names if name in vehicle.zones_met]
    entries: list[Any] = [Patch(color=colors[names.index(name)], label=name) for name in met]
    entries.append(Patch(fill=False, ls="--", ec="k", label="rigid core"))
    figure.legend(handles=entries, loc="outside lower center", ncols=6, frameon=False, fontsize="small")
    below = figure.add_subplot(grid[2, :])
    below.set_axis_off()
    below.text(0.5, 1.0, told, fontsize="x-small", ha="center", va="top", transform=below.transAxes)
    return figure


class _Part(NamedTuple):
    """A unit, where the axes of its file begin in those of the leading one [m], and its first colour."""

    unit: Vehicle
    origin: Floats
    first: int


def _parts(vehicle: Vehicle) -> list[_Part]:
    origins = [np.zeros(3)] + ([] if vehicle.joint is None else [vehicle.joint.shift])
    counts = np.cumsum([0] + [len(unit.zones) for unit in vehicle.units])
    return [
        _Part(unit, origin, int(first))
        for unit, origin, first in zip(vehicle.units, origins, counts[:-1], strict=True)
    ]


def _draw(axes: Axes, vehicle: Vehicle, parts: list[_Part], view: _View, colors: npt.NDArray[Any]) -> None:
    """Draw each unit, mass centre and front."""
    sign = -1.0 if view.flip else 1.0
    columns = [view.right, view.up]
    for part in parts:
        _draw_unit(axes, part, view, colors)
    center = vehicle.center_of_mass[columns] * (sign, 1.0)
    axes.plot(*center, marker="P", ms=9, color=RED, mec="w", zorder=5.0)
    axes.annotate(
        "mass centre", tuple(center), (6, 5), textcoords="offset points", fontsize="x-small", zorder=5.0
    )
    axes.autoscale_view()
    leading = vehicle.units[0]
    points = leading.nodes + leading.center_of_mass
    if view.right == 0:
        front = float(points[leading.is_skin][:, 0].max())
        place = (sign * front, 0.0 if view.up == 1 else float(points[:, 2].mean()))
        style = {"arrowstyle": "-|>", "color": RED, "lw": 2.0}
        axes.annotate("", (place[0] + sign * 0.45, place[1]), place, arrowprops=style, zorder=5.0)
        low, high = axes.get_xlim()
        axes.set_xlim(min(low, place[0] + sign * 1.2), max(high, place[0] + sign * 1.2))
        axes.annotate(
            "FRONT", (place[0] + sign * 0.5, place[1]), color=RED, ha="right" if sign < 0 else "left"
        )
    if view.up == 2:
        axes.axhline(0.0, color="0.3", lw=1.2)
    axes.set_aspect("equal")
    axes.set_title(view.name, fontsize="small")
    letter = "xyz"[view.right]
    away = "rearward" if letter == "x" else "to the right"
    axes.set_xlabel(f"{letter} [m]" if sign > 0 else f"-{letter} [m], {away}")
    axes.set_ylabel(f"{'xyz'[view.up]} [m]")


def _draw_unit(axes: Axes, part: _Part, view: _View, colors: npt.NDArray[Any]) -> None:
    """Draw the faces that look this way, far ones first, and what is inside as if the skin were glass."""
    unit = part.unit
    sign = -1.0 if view.flip else 1.0
    columns = [view.right, view.up]
    points = unit.nodes + unit.center_of_mass + part.origin
    if len(unit.quads):
        corners = points[unit.quads]
        normal = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
        flat = np.linalg.norm(normal, axis=1) == 0.0
        normal[flat] = np.cross(corners[flat, 1] - corners[flat, 0], corners[flat, 2] - corners[flat, 0])
        seen = np.flatnonzero(normal @ np.array(view.toward) > 0.0)
        seen = seen[np.argsort(corners[seen].mean(axis=1) @ np.array(view.toward))]
        zone = unit.zone_of_node[unit.quads[seen, 0]]
        face = PolyCollection(
            list(corners[seen][:, :, columns] * (sign, 1.0)),
            facecolors=colors[np.maximum(zone, 0) + part.first],
            edgecolors=(0, 0, 0, 0.12),
            linewidths=0.2,
            alpha=0.75,
        )
        axes.add_collection(face)
    for box in () if unit._file is None else unit._file.core:
        limits = np.array([box.x_m, (-box.half_width_m, box.half_width_m), box.z_m]) + part.origin[:, None]
        (a, b), (c, d) = (sorted(sign * v for v in limits[view.right])), limits[view.up]
        line = ":" if box.gives_way else "--"
        axes.add_patch(Rectangle((a, c), b - a, d - c, fill=False, ls=line, ec="k", lw=1.0, zorder=4.0))
    _draw_wheels(axes, part, view, sign)


def _draw_wheels(axes: Axes, part: _Part, view: _View, sign: float) -> None:
    unit = part.unit
    widths = [wheel.width_m for wheel in unit._file.wheels] if unit._file is not None else []
    wheels = unit.wheels + np.append(unit.center_of_mass + part.origin, 0.0)
    for number, (x, y, z, radius) in enumerate(wheels.tolist()):
        center = np.array([x, y, z])
        if view.toward[1]:
            axes.add_patch(Circle((sign * x, z), radius, fill=False, ec="k", lw=1.5, zorder=4.0))
            continue
        width = widths[number] if number < len(widths) else 0.2
        half = np.array([radius, 0.5 * width, radius])[[view.right, view.up]]
        low = center[[view.right, view.up]] * (sign, 1.0) - half
        axes.add_patch(Rectangle(tuple(low), *(2.0 * half), fill=False, ec="k", lw=1.5, zorder=4.0))


def _mass_text(vehicle: Vehicle) -> str:
    x, y, z = vehicle.center_of_mass
    roll, pitch, yaw = vehicle.inertia.diagonal()
    behind = f"mass centre {-x:.2f} m behind the first axle, {y:.2f} m left of the middle, {z:.2f} m high"
    return f"{behind}; inertia in roll, pitch, yaw {roll:,.0f}, {pitch:,.0f}, {yaw:,.0f} kg m²"


def _caption(vehicle: Vehicle) -> str:
    lines = [one.text for unit in vehicle.units for one in unit.assumptions]
    lines = [line if len(line) <= _LETTERS else f"{line[:_LETTERS]}..." for line in lines]
    if len(lines) > _MOST_LINES:
        more = f"... and {len(lines) - _MOST_LINES + 1} more: vehicle.assumptions"
        lines = [*lines[-(_MOST_LINES - 1) :], more]
    return "\n".join(f"assumed: {line}" for line in lines)
