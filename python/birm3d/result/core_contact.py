"""Where nothing is left to crush and the rigid body meets the barrier or the ground."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from .. import units
from ..base.complaints import Complaint
from ..scene.mesh_check import parts_met

if TYPE_CHECKING:
    from .. import _core
    from ..scene.scene import Scene
    from .analysis import RunAnalysis
    from .stored import Stored

__all__ = ["CoreContactWarning", "bottomed_out", "core_complaints", "core_doubts", "core_lines"]

# Yaw from straight ahead or back beyond which a blow on the core makes the vehicle roll [deg].
_TURNED = 10.0
_ROLLS = (
    "Whether a vehicle that comes turned rolls over after a blow on its core is not reliable: at a pole at "
    "80 km/h, one degree of yaw changed it"
)


class CoreContactWarning(UserWarning):
    """The barrier met the rigid core with more than the vehicle's weight, as a mean over 50 ms.

    Behind trusses that have bottomed out nothing is left to crush; a sharp edge can also meet the core
    between trusses. The report says which. Peaks of force and of deceleration are then those of a blow
    between rigid bodies. Under a blunt barrier a structure would go on to crush: travel is too small.

    A body of triangles that is narrower than the vehicle draws in no skin beside it, whatever its shape. Few
    trusses resist it, and it is driven in to the core. Beside such a body travel and force are too great.
    Posts (poles, bollards) and planters draw in skin.

    Whether a vehicle that comes turned by more than 10 degrees rolls over after such a blow is not reliable.
    At a pole at 80 km/h, one degree of yaw changed it.
    """


def core_complaints(scene: Scene, statistics: _core.StepStatistics | Stored) -> Iterator[Complaint]:
    """Yield a complaint if the barrier's force on the rigid core exceeded the vehicle's weight."""
    force = float(getattr(statistics, "core_contact_force", 0.0))  # results of earlier versions have none
    limit = scene.vehicle.mass * units.g(1.0)
    if force > limit:
        causes = (cause[0].upper() + cause[1:] for cause in _causes(scene))
        further, advice = ((_ROLLS,), _advice) if _comes_turned(scene) else ((), None)
        sentences = (*causes, *further)
        text = partial(_text, scene.vehicle.title, limit, force, statistics.core_contact_time, sentences)
        yield Complaint(CoreContactWarning, "core_contact_force", force, text, advice)


def core_doubts(scene: Scene, statistics: _core.StepStatistics | Stored) -> Iterator[Complaint]:
    """Yield the same complaint where whether the vehicle rolls over rests on that force."""
    if _comes_turned(scene):
        yield from core_complaints(scene, statistics)


def _comes_turned(scene: Scene) -> bool:
    return abs(math.sin(math.radians(scene.impact_yaw))) > math.sin(math.radians(_TURNED))


def _advice() -> str:
    return f"The barrier reaches the rigid core. {_ROLLS}."


def _text(title: str, limit: float, force: float, time: float, sentences: tuple[str, ...]) -> str:
    found = (
        f"core_contact_force must be at most {1e-3 * limit:,.0f} kN, the vehicle's weight ({title}), got "
        f"{1e-3 * force:,.0f} kN as a mean over 50 ms until {time:.3f} s: the barrier met what "
        "is not crushed, and peaks of force and deceleration are those of a blow between rigid bodies"
    )
    return ". ".join([found, *sentences])


def _causes(scene: Scene) -> Iterator[str]:
    """Yield what about the barrier lets it reach the core, and what helps."""
    barrier = scene.barrier
    if barrier is None:
        return
    if barrier.cuts_skin:
        yield "sharp edges of the barrier pass between nodes; rounded ones (edge_radius=0.05) do not"
    elif not barrier.draws_in_skin:
        vehicle = scene.vehicle.units[0]
        low, high = vehicle.skin_bounds
        widths = [part.width for part in parts_met(scene, vehicle)]
        if widths and min(widths) < high[1] - low[1]:
            yield (
                f"a part of the barrier that is narrower than the vehicle ({min(widths):.3g} m of "
                f"{high[1] - low[1]:.3g} m) draws in no skin beside it ({barrier.why_no_indentation}) and is "
                "driven in to the core; bollards, poles and planters draw in skin"
            )


# A truss is bottomed out where its node is as near to its anchor [m].
_GAP = 1e-4


def bottomed_out(result: RunAnalysis) -> dict[str, int]:
    """Return the zones whose trusses have bottomed out, and how many of them; vehicles of arrays have ``""``.

    Behind such a truss nothing is left to crush: the rigid body stands against the barrier or the ground.
    Then loads are those of rigid bodies, far above what a structure carries.
    """
    if result.statistics.body_steps == 0:
        return {}
    found: dict[str, int] = {}
    for u, unit in enumerate(result.scene.vehicle.units):
        length = np.linalg.norm(unit.nodes - unit.anchors, axis=1)
        closed = result.unit(u).peak_deflection >= length - _GAP
        names = tuple(unit.zones)
        for node in np.flatnonzero(closed):
            name = names[unit.zone_of_node[node]] if names else ""
            found[name] = found.get(name, 0) + 1
    return found


def core_lines(result: RunAnalysis) -> list[str]:
    """Return the lines of a report on the rigid core; none where it was not met."""
    if result.statistics.body_steps == 0:
        return []
    zones = [
        f"{count:,} of {name!r}" if name else f"{count:,}" for name, count in bottomed_out(result).items()
    ]
    behind = f" behind bottomed-out trusses ({', '.join(zones)})" if zones else " between trusses"
    steps = result.statistics.body_steps
    lines = [f"  the rigid core was met{behind} in {steps:,} steps: loads then are those of rigid bodies"]
    return [*lines, *(f"  {cause}" for cause in _causes(result.scene))]
