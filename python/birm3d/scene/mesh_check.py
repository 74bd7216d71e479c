"""What tells a user that a barrier can pass between the nodes of a skin."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING

from ..barrier.description import SeenPart
from ..base.complaints import Complaint

if TYPE_CHECKING:
    from ..vehicle.vehicle import Vehicle
    from .scene import Scene

__all__ = ["CoarseSkinWarning", "coarse_skins", "parts_met", "warn_if_coarse"]


class CoarseSkinWarning(UserWarning):
    """A barrier is narrower than the distance between nodes of the skin, and can pass between them.

    Nodes are points. A barrier that fits between two of them meets nothing before the rigid body, and the
    number of nodes that it meets is chance. The balances close all the same. Two lengths decide, both level:

    - the distance of a node from its nearest neighbour beside it (further to the side than up or down), of
      which the median over the skin is taken. Up and down there is no way through: what stands on the ground
      and reaches the skin crosses its lowest row.
    - how wide the barrier is, seen along the vehicle's path. Seen so, a wall or a concrete barrier is as wide
      as it is long, but for a path along it: its thickness, and the joints between its segments, are no
      way through. Parts of a mesh that touch each other are one.

    Posts (poles, bollards) are left out where the vehicle has ``indentation_length``: they press the skin
    between nodes too. What triangles hold up in the air, clear of the ground, is judged by its width alone.
    """


def warn_if_coarse(scene: Scene) -> None:
    """Warn with :class:`CoarseSkinWarning` of the narrowest part of the barrier that can pass through."""
    for complaint in coarse_skins(scene):
        complaint.warn()


def parts_met(scene: Scene, unit: Vehicle) -> list[SeenPart]:
    """Return the parts of the barrier that have ends, seen along the path, and stand as high as the skin."""
    seen = [] if scene.barrier is None else scene.barrier.seen_parts(math.radians(scene.impact_angle))
    parts = [part for part in seen if part.width < math.inf]
    if not parts:
        return []
    low, high = unit.skin_bounds
    bottom, top = low[2] + unit.mass_center_height, high[2] + unit.mass_center_height
    return [part for part in parts if part.low <= top and part.high >= bottom]


def coarse_skins(scene: Scene) -> Iterator[Complaint]:
    """Yield what :func:`warn_if_coarse` warns of."""
    if scene.barrier is None:
        return
    units = scene.vehicle.units
    if scene.barrier.has_posts:
        units = tuple(unit for unit in units if unit.indentation_length == 0.0)
    for unit in units:
        met = parts_met(scene, unit)
        if not met:
            continue
        low, high = unit.skin_bounds
        narrowest = min(met, key=lambda part: part.width)
        # Nothing passes between nodes that is wider than all of the skin: no spacing is asked for at walls.
        if narrowest.width < (high - low).max() and narrowest.width < unit.node_spacing:
            share = unit.node_spacing / narrowest.width
            text = partial(_message, scene, unit, narrowest)
            yield Complaint(CoarseSkinWarning, f"width of the {narrowest.name}", share, text)
            return


def _message(scene: Scene, unit: Vehicle, part: SeenPart) -> str:
    remedies = []
    if unit.has_file:
        # Elements along an edge are whole ones: half as many more than in proportion are enough.
        enough = 1.5 * unit.mesh_density * (unit.node_spacing / part.width) ** 2
        remedies.append(f"a mesh_density of {enough:.2g}")
    else:
        remedies.append("nodes that are nearer to each other")
    if part.name == "mesh":
        remedies.append("where it is a post, Barrier.pole or bollards in its place, which indent the skin")
    elif scene.barrier is not None and scene.barrier.has_posts:
        remedies.append("with_indentation_length(0.65), by which posts indent the skin between nodes too")
    apart = "no neighbours beside them" if math.isinf(unit.node_spacing) else f"{unit.node_spacing:.3g} m"
    return (
        f"width of the {part.name} seen along the path must be above the distance between neighbouring nodes "
        f"of {unit.name!r} ({apart}), or it can pass between them; got {part.width:.3g} m. "
        f"What helps: {'; or '.join(remedies)}"
    )
