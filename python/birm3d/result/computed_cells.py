"""The load of a computed run on the cells of a grid over the front of a barrier."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ..barrier.fronts import Front
from ..base.arguments import checked
from ..scene.text import scene_text
from ..units import Quantity, si
from .barrier_fronts import front_of
from .element_loads import element_loads
from .face_grid import USUAL_CELL, cells_of, face_grid, forces_of_cells
from .face_loads import SPREAD, FaceStep, face_steps, lowest_load
from .load_map import LoadMap
from .record import RunRecord

__all__ = ["load_map"]

Floats = npt.NDArray[np.float64]

_LEAST_CELL = 0.01  # m
_REST = 0.03  # of the greatest force; what nodes do not account for below it is an error of interpolation


@checked
def load_map(
    result: RunRecord,
    cell: Quantity | None = None,
    *,
    lateral: npt.ArrayLike | None = None,
    height: npt.ArrayLike | None = None,
) -> LoadMap:
    """Return the force on the cells of a grid over the front of a fixed barrier.

    The scene is run once more. At each step the force of every node on the front counts in the cell where the
    node then is. Between steps forces are linear in time. In each row the cells are scaled to the force that
    the result has across the line, so that they add up to it. Forces of the rigid body and of tyres have no
    nodes. They count in one cell, whose place follows from the moments of the barrier's load.

    Of a sloped face the force across the line counts, not that square to the face. Of posts in one row each
    has a column of cells; a node's force is on the nearest post, at the node's height, and the column is
    scaled to the post's own force.

    No load is below the ground: one whose moments put it there, as of a wheel on a toe, is at the foot. The
    force stays, its moment about the foot is lost.

    Parameters
    ----------
    cell
        Side of the square cells [m], at least 0.01; they begin at the wall's foot and at its origin.
        ``None``: 0.25 m, doubled where the map of a long run would have more than 30 million numbers.
    lateral, height
        Increasing edges of the cells [m], instead of square ones: those of a load-cell wall.

    Raises
    ------
    ValueError
        If the barrier is a mesh, stands free or has several rows of posts. If the cells are too small, their
        edges do not increase, or are given for posts. If the scene does not run the same way again.
    """
    front = front_of(result.scene.barrier)
    side = USUAL_CELL if cell is None else si("cell", cell, "length")
    if not side >= _LEAST_CELL:
        raise ValueError(f"cell must be >= {_LEAST_CELL} m, got {side:g}")
    if front.columns is not None:
        if lateral is not None:
            raise ValueError("lateral must be None for posts, of which each has one column, got edges")
        lateral = front.columns
    steps = face_steps(result, front)
    edges = face_grid(result, steps, lateral, height, side, front.top, doubled=cell is None)
    edges_y, edges_z = edges
    shape = (len(edges_z) - 1, len(edges_y) - 1)
    spread = SPREAD if front.columns is None else 0.0
    cells = _in_time(result.time, steps, edges, front.top, spread)
    if front.columns is None:
        force = _completed(result, front, steps, cells, edges)
    else:
        force = _completed_posts(result, front, cells, edges)
    inner = force[:, :-1].reshape(-1, *shape)
    return LoadMap(result.time, edges_y, edges_z, inner, force[:, -1], scene_text(result.scene, "\n"))


def _in_time(
    time: Floats, steps: list[FaceStep], edges: tuple[Floats, Floats], top: float, spread: float
) -> Floats:
    """Return the forces of cells, and outside them, in the middles of the result's rows, (n, cells + 1)."""
    count = (len(edges[0]) - 1) * (len(edges[1]) - 1) + 1
    quarters = [(a, h) for a in (-spread, spread) for h in (-SPREAD, SPREAD)]
    at_ends = np.array([forces_of_cells(step, quarters, edges, top, count) for step in steps])
    ends = np.array([step.time for step in steps])
    middles = _middles(time)
    place = np.clip(np.searchsorted(ends, middles, side="right") - 1, 0, len(ends) - 2)
    cells = np.zeros((len(middles), count))
    for i in np.unique(place).tolist():
        if not (at_ends[i].any() or at_ends[i + 1].any()):
            continue
        rows = slice(*np.searchsorted(place, [i, i + 1]).tolist())
        share = np.clip((middles[rows] - ends[i]) / (ends[i + 1] - ends[i]), 0.0, 1.0)[:, None]
        cells[rows] = at_ends[i] * (1.0 - share) + at_ends[i + 1] * share
    return cells


def _middles(time: Floats) -> Floats:
    """Return the middles of the intervals of the rows; the first row has that which begins there."""
    return np.concatenate([[0.5 * (time[0] + time[1])], 0.5 * (time[1:] + time[:-1])])


def _completed(
    result: RunRecord,
    front: Front,
    steps: list[FaceStep],
    cells: Floats,
    edges: tuple[Floats, Floats],
) -> Floats:
    """Scale the cells in place to the result's force, and add the force without nodes at its own place."""
    force = np.zeros(len(cells))
    moments = np.zeros((len(cells), 2))  # of the force across the line: along and height [N m]
    for i, load in enumerate(element_loads(result)):
        across = load.force @ front.across
        # Forces along the line and up have a lever where the face is not above the foot.
        moments[:, 0] += front.feet[i] * across - load.moment[:, 2] + front.lever * (load.force @ front.line)
        moments[:, 1] += load.moment @ front.line + front.lever * load.force[:, 2]
        force += across
    nodes = cells.sum(axis=1)
    rest = force - nodes
    by_others = np.abs(rest) > _REST * np.abs(force).max(initial=0.0)
    known = nodes > 0.0
    scaled = known & ~by_others
    cells *= np.divide(force, nodes, out=np.ones_like(force), where=scaled)[:, None]
    alone = np.flatnonzero((by_others | ~known) & (force != 0.0))
    if len(alone):
        of_nodes = _moments_of(result.time, steps)
        turned = (moments[alone] - of_nodes[alone]) / np.where(rest[alone] == 0.0, 1.0, rest[alone])[:, None]
        all_y, all_z = (
            np.concatenate([getattr(step, name) for step in steps]) for name in ("along", "height")
        )
        limits = [
            (p.min(), p.max()) if len(p) else (e[0], e[-1])
            for p, e in zip((all_y, all_z), edges, strict=True)
        ]
        # Tyres may touch below all nodes, but not below the ground.
        limits[1] = (max(lowest_load(result), min(limits[1][0], 0.0)), limits[1][1])
        along, height = (np.clip(turned[:, k], *limits[k]) for k in range(2))
        height = np.minimum(height, np.nextafter(front.top, 0.0))
        np.add.at(cells, (alone, cells_of(along, height, edges)), rest[alone])
    return cells


def _completed_posts(result: RunRecord, front: Front, cells: Floats, edges: tuple[Floats, Floats]) -> Floats:
    """Scale the column of each post in place to the post's force; without nodes its moment has the height."""
    rows, columns = len(edges[1]) - 1, len(edges[0]) - 1
    for i, load in enumerate(element_loads(result)):
        column = np.arange(rows) * columns + i
        force = load.force @ front.across
        nodes = cells[:, column].sum(axis=1)
        known = nodes > 0.0
        cells[:, column] *= np.divide(force, nodes, out=np.zeros_like(force), where=known)[:, None]
        alone = np.flatnonzero(~known & (force != 0.0))
        turning = load.moment[alone] @ front.line + front.lever * load.force[alone, 2]
        height = np.clip(turning / force[alone], edges[1][0], np.nextafter(edges[1][-1], 0.0))
        places = cells_of(np.full(len(alone), front.feet[i]), height, edges)
        np.add.at(cells, (alone, places), force[alone])
    return cells


def _moments_of(time: Floats, steps: list[FaceStep]) -> Floats:
    """Return the moments of the nodes' forces in the middles of the rows, shape (n, 2) [N m]."""
    ends = np.array([step.time for step in steps])
    at_ends = np.array([(step.force @ step.along, step.force @ step.height) for step in steps])
    return np.column_stack([np.interp(_middles(time), ends, column) for column in at_ends.T])
