"""Crush stiffness of a part of a vehicle's skin."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal, NamedTuple

import numpy as np

from .. import _core
from ..base.arguments import checked

__all__ = [
    "KNEE",
    "LAW_NUMBERS",
    "LAW_QUANTITIES",
    "OF_ENVELOPE",
    "OPTIONAL",
    "TRUSS_LAW",
    "LawNumber",
    "Zone",
    "positive",
]

KNEE = ("k_initial", "knee", "k_hardening", "f_max")
"""The numbers of the paper's loading envelope (Fig. 3)."""

TRUSS_LAW = ("k_initial", "knee", "k_hardening", "f_max", "k_unloading")
"""The numbers of the paper's law (Fig. 3)."""


class LawNumber(NamedTuple):
    """A number of a zone's law: its quantity as in :func:`birm3d.units.si`, and its limit in files.

    words: what reports call it. optional: a law may have it in addition. of_wheel: it is of the wheels of a
    zone of tyres, not of the crush law.
    """

    quantity: str
    limit: Literal["> 0", ">= 0", "in [0, 1]", "in (0, 1]"]
    words: str
    optional: bool = True
    of_wheel: bool = False


LAW_NUMBERS: Mapping[str, LawNumber] = {
    "k_initial": LawNumber("pressure per length", ">= 0", "slope", optional=False),
    "knee": LawNumber("length", "> 0", "knee", optional=False),
    "k_hardening": LawNumber("pressure per length", ">= 0", "then", optional=False),
    "f_max": LawNumber("pressure", "> 0", "plateau", optional=False),
    "k_unloading": LawNumber("pressure per length", "> 0", "unloading", optional=False),
    "elastic_recovery": LawNumber("length", "> 0", "gives back"),
    "tail_depth": LawNumber("length", "> 0", "tail from"),
    "tail_slope": LawNumber("pressure per length", ">= 0", "tail"),
    "friction_share": LawNumber("number", "in [0, 1]", "share of friction"),
    "springback": LawNumber("length", ">= 0", "cover springs back by"),
    "breakaway": LawNumber("force", "> 0", "wheels give way at", of_wheel=True),
    "breakaway_travel": LawNumber("length", "> 0", "by", of_wheel=True),
    "static_deflection": LawNumber("length", "> 0", "springs under the weight", of_wheel=True),
    "damping_ratio": LawNumber("number", "in [0, 1]", "damping ratio", of_wheel=True),
    "bump_travel": LawNumber("length", "> 0", "to the bump stop", of_wheel=True),
    "roll_stiffness_ratio": LawNumber("number", "in (0, 1]", "roll stiffness ratio", of_wheel=True),
    "cornering_stiffness": LawNumber("number", "> 0", "cornering stiffness", of_wheel=True),
    "steering_time": LawNumber("time", "> 0", "free steering follows in", of_wheel=True),
    "tread_radius": LawNumber("length", "> 0", "tread rounded by", of_wheel=True),
    "camber_ratio": LawNumber("number", "> 0", "camber ratio", of_wheel=True),
    "rolling_resistance": LawNumber("number", "> 0", "rolling resistance", of_wheel=True),
}
"""Numbers of a zone's law, in the order of files. Files, names of parameters and reports come from here."""

OPTIONAL = tuple(name for name, row in LAW_NUMBERS.items() if row.optional)
"""Numbers that a law may have in addition to Fig. 3."""

OF_ENVELOPE = tuple(name for name in OPTIONAL if not LAW_NUMBERS[name].of_wheel)
"""Optional numbers of the crush law; a new envelope starts without them."""

LAW_QUANTITIES = {name: row.quantity for name, row in LAW_NUMBERS.items()}
"""Number of a zone's law -> its quantity, as :func:`birm3d.units.si` has it."""


@checked
@dataclass(frozen=True)
class Zone(Mapping[str, Any]):
    """Crush stiffness of a part of the skin per unit of area (paper Fig. 3); also a read-only mapping.

    A truss has this curve times its node's tributary area. Either the first four numbers, or ``envelope``.

    Parameters
    ----------
    k_initial, k_hardening
        Slopes before and after the knee [N/m per m^2].
    knee
        Deflection at the knee [m].
    f_max
        Stress of the plateau [N per m^2]; ``None`` beside a knee: without end.
    k_unloading
        Slope of unloading and reloading [N/m per m^2], not below any slope of the envelope. With
        ``elastic_recovery``: the least slope where the load turns.
    envelope
        Points (deflection [m], stress [N per m^2]) from (0, 0); constant after the last.
    elastic_recovery
        Length r that an uncrushed structure gives back [m]. Crushed by d, it gives back R = r (1 - d / length
        of the truss), at most d and 5 stress / ``k_unloading``. On the way the stress falls with the fifth
        power of what is left of R. So restitution falls with speed. R is shorter where the load would else
        store more energy than it puts in. ``None``: the one slope of Fig. 3.
    tail_depth, tail_slope
        From this deflection on [m] the envelope is steeper by this [N/m per m^2], as what has been crushed is
        packed together. ``None``: no tail.
    friction_share
        Share in [0, 1] of the barrier's friction that reaches the vehicle. Folded parts stick to the barrier
        while the vehicle moves on. ``None``: all of it.
    springback
        Length by which covers spring back without force once the structure has given back what it can [m].
        It lessens ``residual_crush`` and the crush profile once the vehicle has left the barrier, and nothing
        else. ``None``: 0.
    breakaway, breakaway_travel
        Of a zone of tyres: load on the ground [N] at which springs and hangers of a wheel give way. The body
        then comes down by the travel [m] before the wheel carries it again. ``None``: they never give way.
    static_deflection, damping_ratio, bump_travel
        Of a zone of tyres: compression of the springs under the vehicle's weight [m], and damping over
        critical damping. The third is the travel of the wheel from rest to the rigid bump stop [m]. The
        wheel's own mass is neglected. ``None``: wheels are fixed to the body.
    roll_stiffness_ratio
        Of a zone of sprung tyres on beam axles: stiffness of an axle against roll over that of the same
        springs at its wheels [-], at most 1. Springs stand inside of the wheels. ``None``: 1.
    cornering_stiffness
        Of a zone of tyres: lateral force on the road per normal load and radian of slip, at small slip
        [1/rad]. ``None``: that of a car's tyres, see :attr:`birm3d.simulation.Scene.cornering_stiffness`.
    steering_time
        Of a zone of tyres: time in which the wheels ahead of the mass centre turn into their direction of
        travel, as nobody holds the steering wheel [s]. ``None``: they are held straight.
    tread_radius
        Of a zone of tyres: radius of the tread's cross-section [m], about half the width that stands on the
        road. So a tilted wheel stands towards its edge. ``None``: a wheel is a disc without width.
    camber_ratio
        Of a zone of tyres: slip angle that has the same side force as a tilt, over that tilt [-]. ``None``: a
        tilted wheel has no camber thrust.
    rolling_resistance
        Of a zone of tyres: resistance of a rolling wheel on the road per normal load [-]. ``None``: 0.
    """

    k_initial: float | None = None
    knee: float | None = None
    k_hardening: float | None = None
    f_max: float | None = None
    k_unloading: float = math.nan
    envelope: tuple[tuple[float, float], ...] | None = None
    elastic_recovery: float | None = None
    tail_depth: float | None = None
    tail_slope: float | None = None
    friction_share: float | None = None
    springback: float | None = None
    breakaway: float | None = None
    breakaway_travel: float | None = None
    static_deflection: float | None = None
    damping_ratio: float | None = None
    bump_travel: float | None = None
    roll_stiffness_ratio: float | None = None
    cornering_stiffness: float | None = None
    steering_time: float | None = None
    tread_radius: float | None = None
    camber_ratio: float | None = None
    rolling_resistance: float | None = None

    def __post_init__(self) -> None:
        if self.envelope is None:
            if self.f_max is None:
                object.__setattr__(self, "f_max", math.inf)
        else:
            rows = tuple(tuple(row) for row in self.envelope)  # lists have no hash
            object.__setattr__(self, "envelope", rows)
            for name in KNEE:
                if getattr(self, name) is not None:
                    raise ValueError(f"{name} must be None beside an envelope, got {getattr(self, name)}")
        if (self.tail_depth is None) != (self.tail_slope is None):
            given, other = ("tail_slope", "depth") if self.tail_depth is None else ("tail_depth", "slope")
            raise ValueError(f"tail_{other} must be given beside {given}, got None")
        self._check_wheels()
        _ = self.curve

    def _check_wheels(self) -> None:
        for names in (
            ("breakaway", "breakaway_travel"),
            ("static_deflection", "damping_ratio", "bump_travel"),
        ):
            given = [name for name in names if getattr(self, name) is not None]
            for name in given:
                if name != "damping_ratio":
                    positive(name, getattr(self, name))
            for name in names:
                if given and name not in given:
                    raise ValueError(f"{name} must be given beside {given[0]}, got None")
        for name in (
            "cornering_stiffness",
            "steering_time",
            "tread_radius",
            "camber_ratio",
            "rolling_resistance",
        ):
            if getattr(self, name) is not None:
                positive(name, getattr(self, name))
        ratio = self.roll_stiffness_ratio
        if ratio is not None and not 0.0 < ratio <= 1.0:
            raise ValueError(f"roll_stiffness_ratio must be > 0 and <= 1, got {ratio}")
        if ratio is not None and self.static_deflection is None:
            raise ValueError("static_deflection must be given beside roll_stiffness_ratio, got None")
        if self.damping_ratio is not None and not 0.0 <= self.damping_ratio <= 1.0:
            raise ValueError(f"damping_ratio must be in [0, 1], got {self.damping_ratio}")

    def __getitem__(self, name: str) -> Any:
        if name not in self._names:
            raise KeyError(name)
        return getattr(self, name)

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    @property
    def _names(self) -> tuple[str, ...]:
        law = ("envelope",) if self.envelope is not None else KNEE
        return (*law, "k_unloading", *self._optional)

    @property
    def _optional(self) -> dict[str, float]:
        given = {name: getattr(self, name) for name in OPTIONAL}
        return {name: value for name, value in given.items() if value is not None}

    @property
    def _of_curve(self) -> dict[str, float]:
        return {name: value for name, value in self._optional.items() if not LAW_NUMBERS[name].of_wheel}

    @cached_property
    def curve(self) -> _core.TrussCurve:
        """The law of 1 m^2 for the core."""
        if self.envelope is not None:
            points = np.asarray(self.envelope, float)
            if points.ndim != 2 or points.shape[1] != 2:
                raise ValueError(f"envelope must have shape (n, 2), got {points.shape}")
            return _core.point_curve(
                points[:, 0].tolist(), points[:, 1].tolist(), self.k_unloading, **self._of_curve
            )
        numbers = {name: getattr(self, name) for name in KNEE}
        for name, value in numbers.items():
            if value is None:
                raise ValueError(f"{name} must be given where there is no envelope, got None")
        return _core.knee_curve(**numbers, k_unloading=self.k_unloading, **self._of_curve)

    def scaled(self, factor: float, stretch: float = 1.0) -> Zone:
        """Return the zone with its stresses times a factor > 0 and its deflections times a stretch > 0.

        Slopes go with the factor over the stretch. The share of friction and all numbers of wheels stay.
        """
        factor, stretch = positive("scale", factor), positive("stretch", stretch)
        times = {"pressure": factor, "pressure per length": factor / stretch, "length": stretch}
        changes: dict[str, Any] = {}
        for name, row in LAW_NUMBERS.items():
            value = getattr(self, name)
            if value is not None and row.quantity in times and not row.of_wheel:
                changes[name] = times[row.quantity] * value
        if self.envelope is not None:
            changes["envelope"] = tuple((stretch * d, factor * stress) for d, stress in self.envelope)
        return dataclasses.replace(self, **changes)

    def with_springs(self, factor: float) -> Zone:
        """Return a zone of tyres with springs stiffer by a factor > 0; the damping ratio stays."""
        if self.static_deflection is None:
            return self
        deflection = self.static_deflection / positive("factor", factor)
        return dataclasses.replace(self, static_deflection=deflection)

    def __getstate__(self) -> dict[str, object]:
        return {name: value for name, value in self.__dict__.items() if name != "curve"}


def positive(name: str, value: float) -> float:
    """Return a number that is finite and > 0, or refuse it by name."""
    if not (math.isfinite(value) and value > 0.0):
        raise ValueError(f"{name} must be finite and > 0, got {value}")
    return float(value)
