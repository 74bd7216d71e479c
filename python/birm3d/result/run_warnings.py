"""Warnings about a finished run whose results are not reliable."""

from __future__ import annotations

from itertools import chain
from typing import TYPE_CHECKING

from .core_contact import core_complaints
from .energy_balance import open_balances
from .overlap import overlaps

if TYPE_CHECKING:
    from collections.abc import Iterator

    from .. import _core
    from ..base.complaints import Complaint
    from ..scene.scene import Scene

__all__ = ["complaints_of_run", "warn_of_run"]


def complaints_of_run(
    scene: Scene, statistics: _core.StepStatistics, balances: _core.Balances
) -> Iterator[Complaint]:
    """Return complaints of overlap of body and barrier, of blows on the core, and of open balances."""
    return chain(
        overlaps(scene, statistics), core_complaints(scene, statistics), open_balances(scene, balances)
    )


def warn_of_run(scene: Scene, statistics: _core.StepStatistics, balances: _core.Balances) -> None:
    """Warn of an overlap of body and barrier, of a blow on the core, and of balances that do not close.

    Raises
    ------
    OverlapWarning
        As a warning, if the overlap was beyond :data:`birm3d.result.overlap.OVERLAP_LIMIT`.
    CoreContactWarning
        As a warning, if the barrier's force on the rigid core exceeded the vehicle's weight.
    BalanceWarning
        As a warning, see :func:`birm3d.result.energy_balance.warn_if_open`.
    """
    for complaint in complaints_of_run(scene, statistics, balances):
        complaint.warn()
