"""What tells a user that a run is not to be believed."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

from .metrics import energy_residual

if TYPE_CHECKING:
    from . import _core
    from .simulation import Scene

__all__ = ["ENERGY_LIMIT", "LedgerWarning", "warn_if_open"]

ENERGY_LIMIT = 5e-3
"""Energy residual, relative to the initial kinetic energy, beyond which a run is wrong."""


class LedgerWarning(UserWarning):
    """The energy ledger of a run does not close: its steps are stable and too long for its answer."""


def warn_if_open(scene: Scene, energy: _core.ExtremeEnergy) -> None:
    """Warn with :class:`LedgerWarning` if the energy residual is beyond :data:`ENERGY_LIMIT`."""
    residual = energy_residual(scene, energy)
    if residual > ENERGY_LIMIT:
        step = scene.settings.time_step
        warnings.warn(
            f"energy_residual must be at most {ENERGY_LIMIT:g}, got {residual:.2g}: time_step = {step:g} s "
            f"is stable and too long for an answer to rely on; time_step=None chooses steps by the tolerance",
            LedgerWarning,
            stacklevel=3,
        )
