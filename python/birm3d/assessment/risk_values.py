"""Values of occupant risk, each beside its limits."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import Literal

from .. import units
from ..base.arguments import checked
from ..base.complaints import Complaint
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
from .pulse import Pulse
from .severity import severity_index

__all__ = ["CAUTION", "NOT_JUDGED", "OccupantRisk"]

CAUTION = (
    "Indicative. Occupants are points that fly freely within a compartment that keeps its shape; belts, bags "
    "and intrusion are left out. Of a computed run the vehicle is one rigid body: its engine does not stop "
    "before the cabin does, so that peaks of short means differ from a gauge's."
)
NOT_JUDGED = (
    "MASH and EN 1317 do not judge this for so heavy a vehicle: limits are those for cars and pickups."
)
"""Of a vehicle from :data:`birm3d.assessment.vehicles.HEAVY_KG` on."""
_NO_BAND = (
    "No band: these are values of one vehicle. occupant_risk(birm3d.predict(simulation)) has those of others "
    "of its class."
)
_FORWARD = 0.5
"""Gain of speed along the vehicle above which it is pushed on, not braked [m/s]."""
_PUSHED_ON = (
    "The vehicle gains {gained:.1f} m/s along x: it is pushed on, not braked, and OLC does not apply. "
    "If it was braked, the channel has the wrong sign or an offset: x is positive forward."
)
_NOT_FRONTAL = (
    "OLC is for frontal pulses. Here the speed changes by {across:.1f} m/s across the vehicle and falls by "
    "{along:.1f} m/s along it: a low OLC says nothing, and it has no class."
)
_OLC_CLASS = {"pushed on": "does not apply", "not frontal": "not frontal"}
_VALUES = ("oiv_x", "oiv_y", "ridedown_x", "ridedown_y", "asi", "asi_1998", "thiv", "phd", "olc")


class OccupantRisk:
    """Values of occupant risk with their limits; made by :func:`birm3d.occupant_risk`.

    A value that needs a channel which was not given raises a ValueError that names it; the table says so.
    Values of a computed run, not of channels (``is_computed``), have no band, and the table says so. It also
    says where no standard judges the occupants of so heavy a vehicle (``is_heavy``), and what the run warned
    of (``warnings``).
    """

    def __init__(
        self,
        pulse: Pulse,
        head_x: float,
        edition: int,
        *,
        is_computed: bool = False,
        is_heavy: bool = False,
        complaints: Sequence[Complaint] = (),
    ) -> None:
        self.pulse = pulse
        self.head_x = head_x
        self.edition = edition
        self.is_computed = is_computed
        self.is_heavy = is_heavy
        self._complaints = tuple(complaints)
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
        """Occupant load criterion: 65 mm of free flight, 235 mm of even restraint [g]; of frontal pulses."""
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
        limit = f"none; car to car {low:g} to {high:g} g"
        return (*found, Criterion("OLC", self.olc, "g", limit, None, self._olc_class()))

    def _olc_class(self) -> str:
        reason = self._why_no_olc()
        if reason is not None:
            return _OLC_CLASS[reason]
        low, high = OLC_LIMITS_G
        return "low" if self.olc <= low else "medium" if self.olc <= high else "high"

    def _changes(self) -> tuple[float, float]:
        """Return the greatest loss of speed along the vehicle, and the greatest change across it [m/s]."""
        _, velocity = self.pulse.since_zero()
        return max(0.0, -float(velocity[:, 0].min())), float(abs(velocity[:, 1]).max())

    def _why_no_olc(self) -> Literal["pushed on", "not frontal"] | None:
        """Return why OLC has no class; ``None``: it has one."""
        along, across = self._changes()
        is_pushed_on = self._has("x") and self._gained() > _FORWARD
        if max(along, self._gained() if is_pushed_on else 0.0) <= across:
            return "not frontal"
        return "pushed on" if is_pushed_on else None

    def _gained(self) -> float:
        """Return the gain of speed along the vehicle from time zero to the end [m/s]."""
        return float(self.pulse.velocity[-1, 0] - self.pulse.velocity[self.pulse.zero, 0])

    def _indices(self) -> tuple[tuple[int, float], tuple[int, float]]:
        return (2010, self.asi_2010), (1998, self.asi_1998)

    def _has(self, name: str) -> bool:
        return name in self.pulse.known

    @property
    def missing(self) -> tuple[str, ...]:
        """Values that can not be had, with the channel that they need."""
        needs = {"asi": "z", "thiv": "yaw_rate", "phd": "yaw_rate"}
        return tuple(f"{value} needs {channel}" for value, channel in needs.items() if not self._has(channel))

    @property
    def notes(self) -> tuple[str, ...]:
        """What to consider before the values are used: of a computed run also what it warned of."""
        return tuple(self._notes())

    def _notes(self) -> Iterator[str]:
        if self.is_heavy:
            yield NOT_JUDGED
        yield from self.warnings
        along, across = self._changes()
        reason = self._why_no_olc()
        if reason == "pushed on":
            yield _PUSHED_ON.format(gained=self._gained())
        elif reason == "not frontal":
            yield _NOT_FRONTAL.format(along=along, across=across)

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the run warned of, each after the name of its class; of channels none."""
        return tuple(f"{one.category.__name__}: {one.text()}" for one in self._complaints)

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
        head = [f"occupant risk: {when}", *self.notes]
        return "\n".join([*head, criteria_text(self.criteria), *self._foot()])

    def _foot(self) -> list[str]:
        """Return the lines below the table."""
        return [*self.missing, CAUTION, *([_NO_BAND] if self.is_computed else [])]

    __str__ = summary

    def _repr_html_(self) -> str:
        return criteria_html(
            ". ".join(["occupant risk", *self.notes]), self.criteria, "\n".join(self._foot())
        )

    def __repr__(self) -> str:
        return f"OccupantRisk({', '.join(f'{name}={value:.4g}' for name, value in self.to_dict().items())})"


def _severity(name: str, value: float) -> Criterion:
    level = severity_class(value)
    limits = ", ".join(f"{level} {most:g}" for level, most in ASI_CLASSES.items())
    grade = "beyond C" if level is None else f"class {level}"
    return Criterion(name, value, "", limits, level is not None, grade)
