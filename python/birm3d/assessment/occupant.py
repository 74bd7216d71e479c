"""Occupant risk of an impact, computed or measured."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

from .. import units
from ..base.arguments import checked
from ..result import Result
from ..signals.channel import Channel
from ..units import Quantity, si
from .criteria import Criterion, criteria_html, criteria_text
from .flail import FlailSpace, HeadImpact, flail_space, head_impact, occupant_load
from .limits import (
    ASI_CLASSES,
    FLAIL_LIMITS,
    OLC_LIMITS_G,
    PHD_LIMIT_G,
    THIV_LIMIT_KM_H,
    graded,
    severity_class,
)
from .pulse import Pulse, pulse_of_channels, pulse_of_result
from .severity import severity_index

__all__ = ["CAUTION", "OccupantRisk", "occupant_risk"]

CAUTION = (
    "Indicative. Occupants are points that fly freely within a compartment that keeps its shape; belts, bags "
    "and intrusion are left out. Of a computed run the vehicle is one rigid body: its engine does not stop "
    "before the cabin does, so that peaks of short means differ from a gauge's."
)
_VALUES = ("oiv_x", "oiv_y", "ridedown_x", "ridedown_y", "asi", "asi_1998", "thiv", "phd", "olc")


class OccupantRisk:
    """Values of occupant risk with their limits; made by :func:`occupant_risk`.

    A value that needs a channel which was not given raises a ValueError that names it; the table says so.
    """

    def __init__(self, pulse: Pulse, head_x: float, edition: int) -> None:
        self.pulse = pulse
        self.head_x = head_x
        self.edition = edition
        self._flail: FlailSpace = flail_space(pulse)

    @property
    def oiv_x(self) -> float:
        """Occupant impact velocity along the vehicle, magnitude [m/s]; MASH, NCHRP 350."""
        return self._flail.velocity_x

    @property
    def oiv_y(self) -> float:
        """Occupant impact velocity across the vehicle, magnitude [m/s]; MASH, NCHRP 350."""
        return self._flail.velocity_y

    @property
    def ridedown_x(self) -> float:
        """Greatest 10-ms mean along the vehicle after the occupant's strike, magnitude [g]."""
        return self._flail.ridedown_x

    @property
    def ridedown_y(self) -> float:
        """Greatest 10-ms mean across the vehicle after the occupant's strike, magnitude [g]."""
        return self._flail.ridedown_y

    @property
    def time_of_strike(self) -> float | None:
        """When the occupant has flown 0.6 m forward or 0.3 m sideways, after time zero [s]; or ``None``."""
        return self._flail.time

    @cached_property
    def asi(self) -> float:
        """Acceleration severity index by the edition of EN 1317-1 that was asked for (2010: 13 Hz)."""
        return severity_index(self.pulse, self.edition)

    @cached_property
    def asi_1998(self) -> float:
        """Acceleration severity index by EN 1317-1 of 1998: 50-ms means."""
        return severity_index(self.pulse, 1998)

    @cached_property
    def asi_2010(self) -> float:
        """Acceleration severity index by EN 1317-1 of 2010: low-pass of 13 Hz."""
        return severity_index(self.pulse, 2010)

    @property
    def asi_class(self) -> str | None:
        """Impact severity level of EN 1317-2 by ASI: ``"A"``, ``"B"``, ``"C"``; ``None`` beyond them."""
        return severity_class(self.asi)

    @cached_property
    def _head(self) -> HeadImpact:
        return head_impact(self.pulse, self.head_x)

    @property
    def thiv(self) -> float:
        """Theoretical head impact velocity, EN 1317-1 [m/s]."""
        return self._head.speed

    @property
    def phd(self) -> float:
        """Post-impact head deceleration, EN 1317-1 [g]."""
        return self._head.deceleration

    @property
    def time_of_flight(self) -> float | None:
        """Of the theoretical head, after time zero [s]; ``None`` where it strikes nothing."""
        return self._head.time

    @cached_property
    def olc(self) -> float:
        """Occupant load criterion: 65 mm of free flight, 235 mm of even restraint [g]."""
        return occupant_load(self.pulse)

    @cached_property
    def criteria(self) -> tuple[Criterion, ...]:
        """Each value beside its limit, by each standard; those that need a missing channel are left out."""
        found: list[Criterion] = []
        for standard, limits in FLAIL_LIMITS.items():
            found += [
                graded(f"OIV, longitudinal ({standard})", self.oiv_x, "m/s", limits.velocity),
                graded(f"OIV, lateral ({standard})", self.oiv_y, "m/s", limits.velocity),
                graded(f"ridedown, longitudinal ({standard})", self.ridedown_x, "g", limits.ridedown),
                graded(f"ridedown, lateral ({standard})", self.ridedown_y, "g", limits.ridedown),
            ]
        if self._has("z"):
            found += [_severity(f"ASI (EN 1317-1:{year})", value) for year, value in self._indices()]
        if self._has("yaw_rate"):
            speed = self.thiv / units.km_h
            limit = f"{THIV_LIMIT_KM_H:g} km/h"
            found += [
                Criterion("THIV (EN 1317-2)", speed, "km/h", limit, speed <= THIV_LIMIT_KM_H),
                Criterion(
                    "PHD (EN 1317-2:1998)", self.phd, "g", f"{PHD_LIMIT_G:g} g", self.phd <= PHD_LIMIT_G
                ),
            ]
        low, high = OLC_LIMITS_G
        grade = "low" if self.olc <= low else "medium" if self.olc <= high else "high"
        limit = f"none; car to car {low:g} to {high:g} g"
        return (*found, Criterion("OLC", self.olc, "g", limit, None, grade))

    def _indices(self) -> tuple[tuple[int, float], tuple[int, float]]:
        return (2010, self.asi_2010), (1998, self.asi_1998)

    def _has(self, name: str) -> bool:
        return name in self.pulse.known

    @property
    def missing(self) -> tuple[str, ...]:
        """Values that can not be had, with the channel that they need."""
        needs = {"asi": "z", "thiv": "yaw_rate", "phd": "yaw_rate"}
        return tuple(f"{value} needs {channel}" for value, channel in needs.items() if not self._has(channel))

    @checked
    def passed(self, standard: str) -> bool:
        """Return whether all limits of one standard are met: ``"MASH"``, ``"NCHRP 350"`` or ``"EN 1317"``.

        EN 1317: some level by ASI, and THIV.

        Raises
        ------
        ValueError
            If the standard is none of these, or a value that it needs can not be had.
        """
        if standard == "EN 1317":
            return self.asi_class is not None and self.thiv <= units.km_h(THIV_LIMIT_KM_H)
        if standard not in FLAIL_LIMITS:
            raise ValueError(f"standard must be one of {', '.join(FLAIL_LIMITS)}, EN 1317; got {standard!r}")
        return all(one.passed is True for one in self.criteria if one.name.endswith(f"({standard})"))

    def to_dict(self) -> dict[str, float]:
        """Return the values by name, SI and g; without those that need a missing channel."""
        without = {text.partition(" ")[0] for text in self.missing}
        without |= {"asi_1998"} if "asi" in without else set()
        return {name: float(getattr(self, name)) for name in _VALUES if name not in without}

    def summary(self) -> str:
        """Return values, limits and verdicts as a table of text."""
        strike = self.time_of_strike
        when = (
            "the occupant strikes nothing"
            if strike is None
            else f"the occupant strikes at {strike * 1e3:.1f} ms"
        )
        lines = [f"occupant risk: {when}", criteria_text(self.criteria), *self.missing, CAUTION]
        return "\n".join(lines)

    __str__ = summary

    def _repr_html_(self) -> str:
        return criteria_html("occupant risk", self.criteria, " ".join((*self.missing, CAUTION)))

    def __repr__(self) -> str:
        return f"OccupantRisk({', '.join(f'{name}={value:.4g}' for name, value in self.to_dict().items())})"


@checked
def occupant_risk(
    result: Result | None = None,
    *,
    x: Channel | float | None = None,
    y: Channel | float | None = None,
    z: Channel | float | None = None,
    yaw_rate: Channel | float | None = None,
    time_zero: Quantity = 0.0,
    head_x: Quantity | None = None,
    point: str | Sequence[Quantity] = "mass_center",
    part: str | int | None = None,
    edition: int = 2010,
) -> OccupantRisk:
    """Return occupant risk of a computed run, or of measured channels.

    OIV and ridedown (MASH, NCHRP 350), ASI, THIV and PHD (EN 1317-1) and OLC, each with limit, class and
    verdict. Accelerations are taken as they are: standards ask for channels of CFC 180, see
    :meth:`birm3d.Channel.filtered`. Where the record ends after the acceleration has died away, the vehicle
    is taken to go on as it is.

    Parameters
    ----------
    result
        A run with a contact; time zero is its first touch.
    x, y, z
        In place of a result: accelerations along the vehicle's own axes at its mass centre, forward, left,
        up; a braking vehicle has x below 0. ``0``: there was none. `z` is needed for ASI only.
    yaw_rate
        Positive to the left; needed for THIV and PHD only.
    time_zero
        Instant of the impact in the channels' time [s].
    head_x
        Of the theoretical head before `point` at time zero [m]; ``None``: that of the vehicle's point
        ``driver_head``, if its file has one, else 0.
    point, part
        Of a result: where the gauges are, see :meth:`birm3d.Result.sensor`.
    edition
        Of EN 1317-1 that ``asi`` follows: 2010 or 1998.

    Raises
    ------
    ValueError
        If there is neither a result nor channels, or both. If a channel is missing, measures something else
        or does not hold time zero. If nothing is hit, or the record ends while the vehicle is still pushed.
    """
    channels = {"x": x, "y": y, "z": z, "yaw_rate": yaw_rate}
    if edition not in (1998, 2010):
        raise ValueError(f"edition of EN 1317-1 must be 1998 or 2010, got {edition}")
    if result is None:
        pulse = pulse_of_channels(channels, si("time_zero", time_zero, "time"))
        ahead = 0.0 if head_x is None else si("head_x", head_x, "length")
        return OccupantRisk(pulse, ahead, edition)
    given = [name for name, value in channels.items() if value is not None]
    if given:
        raise ValueError(f"{given[0]} must be None where a result is given, got both")
    pulse = pulse_of_result(result, point, part)
    return OccupantRisk(pulse, _head_ahead(result, point, part, head_x), edition)


def _head_ahead(
    result: Result, point: str | Sequence[Quantity], part: str | int | None, head_x: Quantity | None
) -> float:
    """Return how far the head is before the gauges [m]."""
    if head_x is not None:
        return si("head_x", head_x, "length")
    gauges = result.sensor(point, part)
    unit = next(unit for unit in result.scene.vehicle.units if unit.name == gauges.part)
    head = unit.points.get("driver_head")
    return 0.0 if head is None else head[0] - float(gauges.point[0])


def _severity(name: str, value: float) -> Criterion:
    level = severity_class(value)
    limits = ", ".join(f"{level} {most:g}" for level, most in ASI_CLASSES.items())
    grade = "beyond C" if level is None else f"class {level}"
    return Criterion(name, value, "", limits, level is not None, grade)
