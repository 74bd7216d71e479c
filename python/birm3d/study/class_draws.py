"""What a prediction draws: the quantities in which vehicles of a class differ, as parameters of a scene."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from ..base.checks import shown
from ..simulation.parameters import parameter_names, value_of
from ..simulation.simulation import Simulation
from ..vehicle.class_scatter import QUANTITIES, joined
from ..vehicle.scaling import SIZES
from ..vehicle.vehicle import Vehicle
from ..vehicle.zone import Zone

__all__ = ["check_draws", "drawn_parameters", "draws", "parameter_of", "zones_set"]

Floats = npt.NDArray[np.float64]

_NOT_DRAWN = (
    "camber_ratio",
    "cornering_stiffness",
    "roll_stiffness_ratio",
    "rolling_resistance",
    "steering_time",
)

_MOST = 10  # power of two of the greatest number of draws

# What a quantity of the class is called among the scene's parameters; a factor on it, where it is no law's.
_PARAMETERS = {
    "mass_center_height": "vehicle.mass_center_height",
    "barrier_friction": "barrier.friction",
    "tire_friction": "settings.mu_tire",
    "edge_flank": "settings.edge_flank_factor",
    "bed_fixings": "vehicle.bed_fixings",
    **{name: f"vehicle.{name}" for name in (*SIZES, "roll_inertia", "yaw_inertia")},
}

# Dimensions of Sobol's sequence, in the order of the quantities. Those left out are correlated with earlier
# ones where there are few points. Between these 16, correlations are at most 0.34 at 32 points, as they are
# between the first ten.
_DIMENSIONS = (*range(10), 13, 16, 27, 28, 32, 60)


def check_draws(name: str, n: int) -> int:
    """Return the power of two that a number of draws is.

    Raises
    ------
    ValueError
        If it is none, or out of range.
    """
    power = int(n).bit_length() - 1
    if isinstance(n, bool) or n != 2**power or not 3 <= power <= _MOST:
        raise ValueError(f"{name} must be a power of 2 from 8 to {2**_MOST}, got {shown(n)}")
    return power


def draws(power: int) -> Mapping[str, Floats]:
    """Return 2**power standard normal numbers of each quantity of :data:`QUANTITIES`, always the same."""
    from scipy.special import ndtri
    from scipy.stats.qmc import Sobol

    # Not scrambled, so that they are the same everywhere; in the middles of their cells, never 0 or 1.
    points = Sobol(_DIMENSIONS[-1] + 1, scramble=False).random_base2(power) + 0.5 ** (power + 1)
    return dict(zip(QUANTITIES, ndtri(points[:, _DIMENSIONS]).T, strict=True))


def parameter_of(quantity: str) -> str:
    """Return the scene's parameter that stands for a quantity of :data:`QUANTITIES`."""
    return _PARAMETERS.get(quantity, f"scatter.{quantity}")


def drawn_parameters(simulation: Simulation, power: int) -> dict[str, Floats]:
    """Return the 2**power values of each parameter of the scene that is drawn.

    Raises
    ------
    ValueError
        If the file of the vehicle says nothing of its class.
    """
    vehicle = simulation.scene.vehicle
    scatter = joined([unit.scatter for unit in vehicle.units], vehicle.zones_met)
    if not scatter:
        raise ValueError(
            "simulation must have a vehicle whose file says how its class scatters ([[scatter]]), "
            f"got {vehicle.name!r}"
        )
    normal, known = draws(power), parameter_names(simulation)
    has_edges = getattr(simulation.scene.barrier, "rounding", 0.0) > 0.0
    changed = frozenset(zones_set(vehicle))
    columns = {}
    for name, one in scatter.items():
        parameter = parameter_of(name)
        if parameter not in known or (name == "edge_flank" and not has_edges):
            continue  # no barrier, no trusses of such a zone, or no rounded edges
        present = value_of(simulation, parameter)
        if present > 0.0:
            median = one.median if changed.isdisjoint(one.zones) else 1.0
            columns[parameter] = present * (median * np.exp(one.log_sd * normal[name]))
    return columns


def zones_set(vehicle: Vehicle) -> tuple[str, ...]:
    """Return the zones whose laws differ from those of the vehicle's file."""
    return tuple(
        name
        for unit in vehicle.units
        if unit._file is not None
        for name, law in unit.zones.items()
        if _forces(law) != _forces(unit._file.laws.get(name))
    )


def _forces(law: Zone | None) -> Zone | None:
    """Return a law without the numbers of its wheels that no factor of the class is on."""
    unset: dict[str, Any] = dict.fromkeys(_NOT_DRAWN)
    return None if law is None else replace(law, **unset)
