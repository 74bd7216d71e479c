"""What is written of a run at some instants: skins, forces of trusses, places of the barrier's parts."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import numpy.typing as npt

from ..barrier.barrier_kind import Surface
from ..barrier.surfaces import barrier_surfaces
from ..result.element_motion import ElementMotion, element_motion
from ..result.frames import frame_times
from ..result.skin import Skin, skins_at
from ..vehicle.unit_shapes import UnitShape, unit_shapes

if TYPE_CHECKING:
    from ..result.result import Result

__all__ = ["Instants", "instants_of", "truss_forces"]

Floats = npt.NDArray[np.float64]


class Instants(NamedTuple):
    """A run at some instants.

    Attributes
    ----------
    time
        Shape (k,) [s].
    shapes
        Units of the vehicle, uncrushed, without nodes that no element has.
    skins
        For each instant the skin of each unit, nodes as in `shapes`.
    surfaces
        Elements of the barrier where they stood at first: corners (n, 3) [m], triangles (m, 3).
    motion
        Of the elements that move.
    """

    time: Floats
    shapes: tuple[UnitShape, ...]
    skins: list[tuple[Skin, ...]]
    surfaces: list[Surface]
    motion: ElementMotion

    def surface_at(self, k: int, element: int) -> Floats:
        """Return the corners of an element of the barrier at an instant, shape (n, 3) [m]."""
        return self.motion.moved(k, element, self.surfaces[element][0])


def instants_of(result: Result, frames: int) -> Instants:
    """Return a run at so many instants, evenly spread among its rows; runs the scene once more.

    Raises
    ------
    ValueError
        If there are fewer than two, or the scene does not run the same way again.
    """
    time = frame_times(result.time, min(frames, len(result.time)) if frames >= 2 else frames)
    skins = skins_at(result, time)
    shapes = unit_shapes(result.scene.vehicle)
    world = np.vstack([skin.world for units in skins for skin in units])
    return Instants(
        time=time,
        shapes=shapes,
        skins=skins,
        surfaces=barrier_surfaces(result.scene.barrier, world),
        motion=element_motion(result, time),
    )


def truss_forces(result: Result, times: Floats) -> list[tuple[Floats, ...]]:
    """Return the forces of all trusses at the ends of the steps that hold some instants [N].

    The scene is run once more: a list over instants of tuples over units of arrays (n,).
    """
    core = result.scene.start()
    units = range(len(result.scene.vehicle.units))
    found = []
    steps = 0
    for time in times:
        while core.time < time and steps < result.statistics.steps:
            core.step()
            steps += 1
        found.append(tuple(np.array(core.truss_force(unit)) for unit in units))
    return found
