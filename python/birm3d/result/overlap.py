"""Warning of a rigid body that overlaps a barrier."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING

from ..base.complaints import Complaint

if TYPE_CHECKING:
    from .. import _core
    from ..scene.scene import Scene
    from .stored import Stored

__all__ = ["OVERLAP_LIMIT", "OverlapWarning", "overlaps"]

OVERLAP_LIMIT = 0.1
"""Overlap of the rigid body with a barrier beyond which a run is not reliable [m]."""


class OverlapWarning(UserWarning):
    """The rigid body overlapped the barrier: loads and travel of the run are not reliable.

    Only anchors of bottomed-out trusses hold the rigid body at the barrier. Between them an edge of a wall or
    a post can enter the body. With the usual meshes it enters by a few centimetres; with very coarse ones it
    passes through. The overlap is the distance by which body and barrier would have to be moved apart. It is
    measured on the core boxes of the vehicle's file, whatever the mesh. Vehicles from arrays have no boxes,
    and are not warned of; the metric ``contact_overlap`` has the depth of their anchors.
    """


def overlaps(scene: Scene, statistics: _core.StepStatistics | Stored) -> Iterator[Complaint]:
    """Yield a complaint if the overlap was beyond :data:`OVERLAP_LIMIT`."""
    overlap = float(getattr(statistics, "greatest_overlap", 0.0))  # results of earlier versions have none
    if overlap > OVERLAP_LIMIT and scene.barrier is not None:
        yield Complaint(OverlapWarning, "contact_overlap", overlap, partial(_text, scene, statistics))


def _text(scene: Scene, statistics: _core.StepStatistics | Stored) -> str:
    assert scene.barrier is not None
    element = scene.barrier.element_names[statistics.greatest_overlap_element]
    return (
        f"contact_overlap must be at most {OVERLAP_LIMIT:g} m, got {statistics.greatest_overlap:.2f} m: at "
        f"{statistics.greatest_overlap_time:.3f} s the vehicle's rigid body ({scene.vehicle.title}) was "
        f"inside {element!r}; a finer mesh (with_mesh_density) or with_indentation_length holds it"
    )
