"""Numbers of the page: histories, plan view and their axes."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from os import cpu_count
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import numpy.typing as npt

from .. import units
from ..base.plain_words import plain_words
from ..plotting.blows import readable_level
from ..plotting.energies import energy_look
from ..plotting.plan_axes import PlanAxes
from ..plotting.style import DASH_DOT, DASHED, DOTTED, LEAST_ANGLE, LEAST_RATE, SOLID, filtered
from ..result.element_loads import touched_elements
from ..result.skin import Skin, skins_at
from ..signals.filters import moving_average
from ..vehicle.silhouette import rings, silhouette
from ..vehicle.unit_shapes import unit_shapes
from .replay import replay_data

if TYPE_CHECKING:
    from ..result.result import Result

__all__ = ["page_data"]

Floats = npt.NDArray[np.float64]
Curves: TypeAlias = list[tuple[str, Floats]]

_ROWS = 3000  # histories are thinned out to this, which is more than a screen has pixels across
_DIGITS = 6
_BLOWS = ("kN", "g")  # curves in these units are cut off at short blows
_MARGIN = 0.05  # room above and below curves, as a share of their range
_ENERGIES = "Energy balance"
_LEAST = {"deg": LEAST_ANGLE, "deg/s": LEAST_RATE}
_DASHES = {SOLID: "solid", DASHED: "dash", DASH_DOT: "dashdot", DOTTED: "dot"}


def page_data(result: Result, frames: int) -> dict[str, Any]:
    """Return what the page's script draws; of long runs every so many rows."""
    every = -(-len(result.time) // _ROWS)
    ms = result.time[::every] * 1e3
    interval = result.scene.settings.output_interval
    panels: list[dict[str, Any]] = [
        {
            "title": name,
            "unit": unit,
            **_vertical(unit, curves, interval),
            "curves": [{"name": label, "y": _short(values[::every])} for label, values in curves],
        }
        for name, unit, curves in _panels(result)
    ]
    looks = energy_look(list(result.energy))
    for curve in next(panel for panel in panels if panel["title"] == _ENERGIES)["curves"]:
        color, style, _ = looks[curve["name"].replace(" ", "_")]
        curve.update(color=color, dash=_DASHES[style])
    return {
        "time": _short(ms),
        "every": every,
        "panels": panels,
        "plan": _plan(result, frames),
        "replay": replay_data(result, frames),
    }


def _vertical(unit: str, curves: Curves, interval: float) -> dict[str, Any]:
    """Return the range of a panel, ``None`` that of its curves, and which peak it cuts off.

    Angles and rates that are rounding errors have a range, and panels that a blow would flatten.
    """
    least = _LEAST.get(unit, 0.0)
    shown = [values for name, values in curves if not name.endswith("unfiltered")]
    low = min(float(values.min()) for values in shown)
    high = max(float(values.max()) for values in shown)
    if high - low < least:
        middle = 0.5 * (low + high)
        return {"range": [middle - 0.5 * least, middle + 0.5 * least]}
    levels = [readable_level(values, interval) for values in shown]
    top = max(min(float(v.max()), level) for v, level in zip(shown, levels, strict=True))
    bottom = min(max(float(v.min()), -level) for v, level in zip(shown, levels, strict=True))
    if unit not in _BLOWS or (top >= high and bottom <= low):
        return {"range": None}
    margin = _MARGIN * (top - bottom)
    peaks = (f"{peak:,.0f}" for peak, cut in ((low, bottom > low), (high, top < high)) if cut)
    return {"range": [bottom - margin, top + margin], "cut": f"peak {' and '.join(peaks)} {unit} cut off"}


def _panels(result: Result) -> list[tuple[str, str, Curves]]:
    interval = result.scene.settings.output_interval

    def curve(name: str, values: Floats, channel_class: float) -> tuple[str, Floats]:
        smooth, class_ = filtered(values, channel_class, interval)
        return f"{name}, {class_}", smooth

    panels = []
    if result.scene.barrier is not None:
        normal = result.barrier_normal_force / 1e3
        forces = [
            curve("along the normal", normal, 60),
            ("along the normal, 50-ms mean", moving_average(normal, 0.05, interval)),
        ]
        forces += [
            curve(f"{axis} (world)", result.barrier_force[:, i] / 1e3, 60) for i, axis in enumerate("xyz")
        ]
        forces.append(("along the normal, unfiltered", normal))
        panels.append(("Barrier force", "kN", forces))
        loads = touched_elements(result.element_loads)
        if len(loads) > 1:
            on_each = [
                (load.name, np.linalg.norm(filtered(load.force / 1e3, 60, interval)[0], axis=1))
                for load in loads
            ]
            panels.append(
                (
                    f"Magnitude of the force on the barrier's elements, {forces[0][0].split(', ')[1]}",
                    "kN",
                    on_each,
                )
            )
    acceleration = [curve(axis, result.acceleration[:, i] / units.g, 60) for i, axis in enumerate("rst")]
    panels.append(("Acceleration of the mass centre, body axes", "g", acceleration))
    velocity = [(axis, result.velocity[:, i]) for i, axis in enumerate("xyz")]
    speed = ("speed", np.linalg.norm(result.velocity, axis=1))
    panels.append(("Velocity of the mass centre, world axes", "m/s", [speed, *velocity]))
    names = ("roll", "pitch", "yaw")
    panels.append(("Angles", "deg", [(name, getattr(result, name)) for name in names]))
    rates = [curve(f"{name} rate", result.angular_velocity[:, i], 180) for i, name in enumerate(names)]
    panels.append(("Angular rates, body axes", "deg/s", rates))
    if result.tire_reaction.shape[1]:
        wheels = result.tire_reaction / 1e3
        tires = [curve(f"wheel {i + 1}", wheels[:, i], 60) for i in range(wheels.shape[1])]
        panels.append(("Tyre reactions", "kN", tires))
    energy = [
        (plain_words(name), values / 1e3) for name, values in result.energy.items() if name != "residual"
    ]
    panels.append((_ENERGIES, "kJ", energy))
    panels.append(("Energy residual", "J", [("residual", result.energy["residual"])]))
    return panels


def _plan(result: Result, frames: int) -> dict[str, Any]:
    if frames < 2:
        raise ValueError(f"frames must be >= 2, got {frames}")
    times = np.linspace(result.time[0], result.time[-1], frames)
    axes = PlanAxes(result)
    shapes = unit_shapes(result.scene.vehicle)
    skins = skins_at(result, times)

    def outlines_of(one: Sequence[Skin]) -> list[list[Floats]]:
        return [
            [
                axes.plan(ring)
                for ring in rings(silhouette(shape, skin.nodes, skin.center, skin.rotation, exact=False))
            ]
            for shape, skin in zip(shapes, one, strict=True)
        ]

    with ThreadPoolExecutor(cpu_count()) as pool:  # shapely works without the interpreter's lock
        outlines = list(pool.map(outlines_of, skins))
    paths = [axes.plan(result.pose(times, unit)[0]) for unit in range(len(shapes))]
    world = np.vstack([skin.world for one in (skins[0], skins[-1]) for skin in one])
    drawn = np.vstack([ring for one in outlines for unit in one for ring in unit])
    parts = axes.barrier(world, drawn)
    shown = np.vstack([drawn, *(vertices for vertices, _ in parts)])
    return {
        "labels": axes.labels,
        "time": _short(times * 1e3),
        "outlines": [[_joined(unit) for unit in one] for one in outlines],
        "paths": [_short(path.T) for path in paths],
        "barrier": [[_short(v[[*face, face[0]]].T) for face in _from_above(v, faces)] for v, faces in parts],
        "range": _short(np.stack([shown.min(axis=0), shown.max(axis=0)]).T),
    }


def _joined(parts: list[Floats]) -> list[list[float | None]]:
    """Return x and y of closed rings, ``None`` between them."""
    x: list[float | None] = []
    y: list[float | None] = []
    for ring in parts:
        gap: list[None] = [None] if x else []
        closed = np.vstack([ring, ring[:1]])
        x += [*gap, *_short(closed[:, 0])]
        y += [*gap, *_short(closed[:, 1])]
    return [x, y]


def _from_above(plan: Floats, faces: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
    """Return the triangles that look up: they cover a solid's plan once."""
    a, b, c = (plan[faces[:, i]] for i in range(3))
    u, v = b - a, c - a
    return faces[u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0] > 1e-9]


def _short(values: Floats) -> Any:
    """Return lists of numbers with as many digits as a screen can show."""
    if values.ndim > 1:
        return [_short(row) for row in values]
    return [float(f"{value:.{_DIGITS}g}") for value in values.tolist()]
