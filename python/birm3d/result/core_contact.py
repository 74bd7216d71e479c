"""Where nothing is left to crush and the rigid body meets the barrier or the ground."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from .analysis import RunAnalysis

__all__ = ["bottomed_out", "core_lines"]

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
    if result.scene.barrier is not None and result.scene.barrier.cuts_skin:
        lines.append(
            "  the wall's sharp edges pass between nodes; rounded ones (edge_radius, say 0.05 m) do not"
        )
    return lines
