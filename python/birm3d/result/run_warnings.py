"""What a user is told of a run that is over and not to be believed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .energy_balance import warn_if_open
from .overlap import warn_if_overlapping

if TYPE_CHECKING:
    from .. import _core
    from ..scene.scene import Scene

__all__ = ["warn_of_run"]


def warn_of_run(scene: Scene, statistics: _core.StepStatistics, ledger: _core.Ledger) -> None:
    """Warn of an overlap of body and barrier, and of accounts that do not close.

    Raises
    ------
    OverlapWarning
        As a warning, see :func:`birm3d.result.overlap.warn_if_overlapping`.
    LedgerWarning
        As a warning, see :func:`birm3d.result.energy_balance.warn_if_open`.
    """
    warn_if_overlapping(scene, statistics)
    warn_if_open(scene, ledger)
