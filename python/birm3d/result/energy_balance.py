"""What tells a user that a run is not to be believed."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

from ..base.arguments import caller_level
from .metrics import relative_to_start

if TYPE_CHECKING:
    from .. import _core
    from ..scene.scene import Scene

__all__ = ["ENERGY_LIMIT", "FALL_LIMIT", "MOMENTUM_LIMIT", "LedgerWarning", "warn_if_open"]

ENERGY_LIMIT = 5e-3
"""Energy residual, relative to the energy at the run's disposal, beyond which a run is wrong."""

FALL_LIMIT = 5e-3
"""Fall of a dissipated term from its highest value, relative to the energy at the run's disposal."""

MOMENTUM_LIMIT = 1e-6
"""Momentum of a step that no impulse explains, relative to the largest of the run."""


class LedgerWarning(UserWarning):
    """A ledger of a run does not close: energy, momentum, or dissipation that comes back."""


def warn_if_open(scene: Scene, ledger: _core.Ledger) -> None:
    """Warn with :class:`LedgerWarning` of each account that is out of bounds, with its size, time and place.

    - energy: the sum of all terms departs from that at the start by more than :data:`ENERGY_LIMIT` of the
      energy at disposal, which is the initial kinetic energy and what the weight has done;
    - momentum: a unit's change in a step departs from its impulses by more than :data:`MOMENTUM_LIMIT` of
      the largest momentum;
    - crush, friction or impacts fall from their highest value by more than :data:`FALL_LIMIT` of the energy
      at disposal.
    """
    residual = relative_to_start(scene, ledger.energy.size, ledger.at_disposal)
    if residual > ENERGY_LIMIT:
        _warn("energy_residual", ENERGY_LIMIT, residual, ledger.energy, _advice(scene))
    momentum = ledger.momentum.size / max(ledger.largest_momentum, scene.vehicle.mass)
    if momentum > MOMENTUM_LIMIT:
        _warn("momentum_residual", MOMENTUM_LIMIT, momentum, ledger.momentum, _advice(scene))
    for name, fall in ledger.falls.items():
        share = relative_to_start(scene, fall.size, ledger.at_disposal)
        if share > FALL_LIMIT:
            _warn(f"the fall of {name}", FALL_LIMIT, share, fall, _advice(scene))


def _advice(scene: Scene) -> str:
    settings = scene.settings
    if settings.contact_model == "along_truss":
        return "contact_model = 'along_truss' does not keep energy"
    if settings.time_step is None:
        return f"try a tolerance below {settings.tolerance:g}; if it stays, do not rely on the answer"
    return (
        f"time_step = {settings.time_step:g} s is stable and too long for an answer to rely on; "
        "time_step=None chooses steps by the tolerance"
    )


def _warn(name: str, limit: float, value: float, worst: _core.Departure, advice: str) -> None:
    x, y, z = worst.place
    warnings.warn(
        f"{name} must be at most {limit:g}, got {value:.2g} at t = {worst.time:.4g} s, mass centre at "
        f"({x:.3g}, {y:.3g}, {z:.3g}) m: {advice}",
        LedgerWarning,
        stacklevel=caller_level(),
    )
