"""What tells a user that a mass is far outside what the vehicle's class can have."""

from __future__ import annotations

import warnings
from typing import NamedTuple

from ..base.arguments import caller_level

__all__ = ["MassWarning", "UsualMass"]

_LEAST, _MOST = 0.5, 2.5


class MassWarning(UserWarning):
    """The mass asked for is far outside what the vehicle's class can have.

    Usual is from half of the file's empty mass, without payload, to 2.5 times the file's mass. Beyond it the
    program still answers: a mass below the empty one makes the structure lighter, one above fills the load
    space. Stiffness stays that of the file. :meth:`birm3d.Vehicle.scaled_to` changes it with the mass, and
    does not warn. Unlike :class:`birm3d.UnitWarning`, it also checks masses given as text with a unit.
    """


class UsualMass(NamedTuple):
    """Masses of a vehicle [kg] that cause no warning; name: of the vehicle."""

    name: str
    low: float
    high: float

    @classmethod
    def of(cls, name: str, empty: float, mass: float) -> UsualMass:
        """Return the range by the empty mass and the mass of a file [kg]."""
        return cls(name, _LEAST * empty, _MOST * mass)

    def holds(self, mass: float) -> bool:
        """Whether a mass [kg] is usual."""
        return self.low <= mass <= self.high

    def warn(self, argument: str, mass: float, where: str = "") -> None:
        """Warn with :class:`MassWarning` of a mass [kg] that is not usual; where: of which runs it is."""
        if self.holds(mass):
            return
        warnings.warn(
            f"{argument} = {mass:,.6g} kg{where} is far outside what {self.name!r} can have: usual is "
            f"{self.low:,.0f} to {self.high:,.0f} kg, half of its empty mass to 2.5 times the mass in its "
            "file. Stiffness stays as it is: choose another preset, or make one with scaled_to() or "
            "Vehicle.from_facts()",
            MassWarning,
            stacklevel=caller_level(),
        )
