"""Distributions of what was assumed of a vehicle, as :func:`birm3d.monte_carlo` takes them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .class_scatter import QUANTITIES
from .inertia import INERTIAS

if TYPE_CHECKING:
    from .mass_variants import MassVariants

__all__ = ["assumed_distributions"]


def assumed_distributions(vehicle: MassVariants) -> dict[str, Any]:
    """Return the distributions of a vehicle; see :meth:`birm3d.Vehicle.assumed_distributions`."""
    from scipy.stats import lognorm  # takes long to load

    told = {one.name: one.log_sd for unit in vehicle.units for one in unit.assumptions}
    of_units = () if vehicle.joint is None else ("wheelbase", *INERTIAS)  # two have each their own
    return {
        f"vehicle.{name}": lognorm(told[name], scale=getattr(vehicle, name))
        for name in QUANTITIES
        if name in told and name not in of_units
    }
