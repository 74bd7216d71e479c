"""Warnings of balances of energy and momentum that do not close."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING

from ..base.complaints import Complaint
from .run_values import share_of_start

if TYPE_CHECKING:
    from .. import _core
    from ..scene.scene import Scene
    from .analysis import RunAnalysis

__all__ = [
    "ENERGY_LIMIT",
    "FALL_LIMIT",
    "MOMENTUM_LIMIT",
    "BalanceWarning",
    "open_balances",
    "open_rows",
    "warn_if_open",
]

ENERGY_LIMIT = 5e-3
"""Energy residual, relative to the energy at the run's disposal, beyond which a run is wrong."""

FALL_LIMIT = 5e-3
"""Decrease of a dissipated energy from its highest value, relative to the energy at the run's disposal."""

MOMENTUM_LIMIT = 1e-6
"""Change of momentum in a step less all impulses in it, relative to the largest momentum of the run."""


class BalanceWarning(UserWarning):
    """A balance of a run does not close: of energy or momentum, or a dissipated energy decreases.

    Its number is not the metric of the same name. The warning looks at every step, and its energy is relative
    to the energy at disposal (see :func:`warn_if_open`). The metrics ``energy_residual`` and
    ``momentum_residual`` look at the output instants. They are relative to the initial kinetic energy and to
    the greatest force.
    """


def warn_if_open(scene: Scene, balances: _core.Balances) -> None:
    """Warn with :class:`BalanceWarning` of each balance that is out of bounds, with its size, time and place.

    - energy: the sum of all terms departs from that at the start by more than :data:`ENERGY_LIMIT` of the
      energy at disposal. That is the initial kinetic energy and what the weight has done;
    - momentum: a unit's change in a step departs from its impulses by more than :data:`MOMENTUM_LIMIT` of
      the largest momentum;
    - crush, friction or impacts fall from their highest value by more than :data:`FALL_LIMIT` of the energy
      at disposal.
    """
    for complaint in open_balances(scene, balances):
        complaint.warn()


def open_balances(scene: Scene, balances: _core.Balances) -> Iterator[Complaint]:
    """Yield what :func:`warn_if_open` warns of."""

    def complaint(quantity: str, limit: float, value: float, worst: _core.Departure) -> Complaint:
        return Complaint(
            BalanceWarning, quantity, value, partial(_text, scene, quantity, limit, value, worst)
        )

    energy, change, fall_of_any, at_disposal, largest_momentum = balances.sizes
    residual = share_of_start(scene, energy, at_disposal)
    if residual > ENERGY_LIMIT:
        yield complaint("energy_residual", ENERGY_LIMIT, residual, balances.energy)
    momentum = change / max(largest_momentum, scene.vehicle.mass)
    if momentum > MOMENTUM_LIMIT:
        yield complaint("momentum_residual", MOMENTUM_LIMIT, momentum, balances.momentum)
    if not share_of_start(scene, fall_of_any, at_disposal) > FALL_LIMIT:
        return
    for name, fall in balances.falls.items():
        share = share_of_start(scene, fall.size, at_disposal)
        if share > FALL_LIMIT:
            yield complaint(f"the fall of {name}", FALL_LIMIT, share, fall)


def open_rows(result: RunAnalysis) -> Iterator[Complaint]:
    """Yield a complaint if the energies of the rows do not close; a result has no balances of its steps."""
    residual = result.metrics.get("energy_residual", 0.0)
    if residual > ENERGY_LIMIT:
        text = partial(_text_of_rows, result.scene, residual)
        yield Complaint(BalanceWarning, "energy_residual", residual, text)


def _text_of_rows(scene: Scene, residual: float) -> str:
    return (
        f"energy_residual must be at most {ENERGY_LIMIT:g} of the initial kinetic energy, "
        f"got {residual:.2g}: {_advice(scene)}"
    )


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


def _text(scene: Scene, quantity: str, limit: float, value: float, worst: _core.Departure) -> str:
    x, y, z = worst.place
    return (
        f"{quantity} must be at most {limit:g}, got {value:.2g} at t = {worst.time:.4g} s, mass centre at "
        f"({x:.3g}, {y:.3g}, {z:.3g}) m: {_advice(scene)}"
    )
