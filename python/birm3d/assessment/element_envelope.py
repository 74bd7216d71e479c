"""Of several scenes what one element of a barrier has to carry."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from ..base.frozen_mapping import FrozenMapping
from ..result.result import Result
from ..scene.scene import Scene
from .element_design import ENVELOPED, ElementDesign

__all__ = ["envelope"]


def envelope(
    rows: Mapping[int, ElementDesign], cases: Sequence[Result | Scene], quantile: float = 1.0
) -> ElementDesign:
    """Return of each value of one element the greatest over scenes, by their numbers, with its scene.

    ``cases`` has all scenes, or the results that were given for them.
    With a quantile below 1 the least value of a scene that this share of the scenes does not exceed.
    """
    place = math.ceil(quantile * len(rows) - 1e-9)  # 0.9 of 10 is the ninth, in spite of rounding
    best = {name: _scene_at(rows, name, place) for name in ENVELOPED}
    force = rows[best["force_50ms"]]
    named = {name: scene for name, scene in best.items() if rows[scene].touched}
    return ElementDesign(
        force.index,
        force.name,
        **{name: getattr(rows[scene], name) for name, scene in best.items()},
        impulse_vector=rows[best["impulse"]].impulse_vector,
        height=force.height,
        direction=force.direction,
        yield_force=rows[best["equivalent_static_force"]].yield_force,
        has_yielded=rows[best["equivalent_static_force"]].has_yielded,
        scene=FrozenMapping(named),
        touched=rows[best["equivalent_static_force"]].touched,
        case=cases[best["equivalent_static_force"]],
    )


def _scene_at(rows: Mapping[int, ElementDesign], name: str, place: int) -> int:
    """Return the scene with the value at a place of the values in order, the first of equal ones."""
    sizes = {scene: abs(getattr(row, name)) for scene, row in rows.items()}
    wanted = sorted(sizes.values())[place - 1]
    return min(scene for scene, size in sizes.items() if size == wanted)
