"""Vehicles of the standards: what they are called, what they weigh, and which point of them is measured."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from ..vehicle import Vehicle

__all__ = ["A_PILLAR", "HEAVY_KG", "LOAD_BED", "StandardVehicle", "measured_point", "standard_vehicle"]

A_PILLAR = "a_pillar_base"
LOAD_BED = "load_bed_leading_edge"
HEAVY_KG = 3500.0
"""Mass from which on a vehicle counts as heavy [kg]. No standard judges the occupants of heavy vehicles."""


class StandardVehicle(NamedTuple):
    """A vehicle of a standard.

    code: as the standard has it. kinds: of :attr:`birm3d.Vehicle.kind`. mass and tolerance: [kg].
    point: named point that penetration is measured to; "" where it is not measured.
    chosen: whether a vehicle is taken for it by kind and mass alone; others have to be asked for by code.
    """

    code: str
    kinds: tuple[str, ...]
    mass: float
    tolerance: float
    point: str = ""
    chosen: bool = True

    def fits(self, vehicle: Vehicle) -> bool:
        """Whether a vehicle is of this kind and mass."""
        return vehicle.kind in self.kinds and self.weighs(vehicle)

    def weighs(self, vehicle: Vehicle) -> bool:
        """Whether its mass is within the tolerance."""
        return abs(vehicle.mass - self.mass) <= self.tolerance

    @property
    def words(self) -> str:
        """What a message calls it."""
        return f"{self.code} ({' or '.join(self.kinds)}, {self.mass:,.0f} +-{self.tolerance:,.0f} kg)"


def standard_vehicle(
    standard: str, known: Sequence[StandardVehicle], vehicle: Vehicle, code: str | None
) -> StandardVehicle:
    """Return what a standard calls a vehicle.

    Parameters
    ----------
    standard
        Its name, for messages.
    known
        Vehicles of the standard.
    vehicle
        By whose kind and mass one is found.
    code
        Takes the place of kind and mass.

    Raises
    ------
    ValueError
        If the standard does not know it; the message names those that it knows.
    """
    if code is not None:
        called = [one for one in known if one.code == code]
        if called:  # one code may stand for two masses, as N3 of PAS 68
            return next((one for one in called if one.weighs(vehicle)), called[0])
        codes = ", ".join(one.code for one in known)
        raise ValueError(f"vehicle_class must be one of {codes} for {standard}; got {code!r}")
    for one in known:
        if one.chosen and one.fits(vehicle):
            return one
    kind = vehicle.kind if vehicle.kind is not None else "no kind in its file"
    raise ValueError(
        f"vehicle must be one that {standard} knows: {', '.join(one.words for one in known if one.chosen)}; "
        f"got {vehicle.name!r} ({kind}, {vehicle.mass:,.0f} kg). vehicle_class= takes its place"
    )


def measured_point(standard: str, meant: StandardVehicle, vehicle: Vehicle) -> str:
    """Return the point to which a standard measures the penetration of a vehicle.

    Raises
    ------
    ValueError
        If the vehicle has no such point; the message names those that it has.
    """
    known = dict.fromkeys(name for unit in vehicle.units for name in unit.points)
    if meant.point in known:
        return meant.point
    raise ValueError(
        f"reference_point must be given for {vehicle.name!r}, which has no {meant.point!r}, to which "
        f"{standard} measures: one of {', '.join(known)}, or three numbers (m) in the axes of its file; "
        "got None"
    )
