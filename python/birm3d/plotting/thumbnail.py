"""A small plan view of start and end, drawn without running the scene again."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from ..result.skin import Skin
from ..vehicle.unit_shapes import unit_shapes
from .figure import new_figure
from .plan import Instant, draw_barrier, draw_vehicle, fit_to
from .plan_axes import PlanAxes
from .style import BLUE, prepare

if TYPE_CHECKING:
    from ..result.result import Result

__all__ = ["plot_thumbnail"]

_WIDTH, _HEIGHTS = 5.0, (2.0, 4.2)  # inches


def plot_thumbnail(result: Result) -> Figure:
    """Return outlines at start and end, path and barrier, as small as notebooks show beside a table."""
    view = PlanAxes(result)
    shapes = unit_shapes(result.scene.vehicle)
    figure = new_figure(_WIDTH, _HEIGHTS[0])
    axes = figure.subplots()
    prepare(axes)
    drawn, world = [], []
    instants = (
        Instant(0.0, "start", "0.45", "--", 1.2, 0.0),
        Instant(float(result.time[-1]), "end", BLUE, "-", 1.6, 0.12),
    )
    for k, instant in enumerate(instants):
        units = []
        for unit, shape in enumerate(shapes):
            center, rotation = (values[0] for values in result.pose([instant.time], unit))
            nodes = result.final_nodes(unit) if k else shape.nodes
            units.append(Skin(nodes, nodes - shape.nodes, center, rotation))
        drawn += draw_vehicle(axes, view.plan, shapes, units, instant, 3.0 + k)
        world += [skin.world for skin in units]
    path = view.plan(result.position)
    axes.plot(*path.T, color="k", ls="-", lw=0.8)
    drawn.append(path)
    draw_barrier(axes, view, np.vstack(world), drawn, result)
    fit_to(figure, axes, np.vstack(drawn), _WIDTH, _HEIGHTS, room=0.9)
    axes.tick_params(labelsize="x-small")
    axes.set_xlabel(view.labels[0], fontsize="x-small")
    axes.set_ylabel("[m]", fontsize="x-small")
    figure.legend(loc="outside lower center", ncols=3, frameon=False, fontsize="x-small")
    return figure
