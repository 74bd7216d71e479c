"""Numbers with their time, unit, filter class and origin, and what is computed of them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from typing import Any

import numpy as np
import numpy.typing as npt
from typing_extensions import Self

from .. import units
from ..base.arguments import checked
from ..base.frozen_mapping import FrozenMapping
from .filters import cfc as cfc_filter

__all__ = ["Samples"]

Floats = npt.NDArray[np.float64]

# Instants of a record count as even when each is this close to its place, as a share of the interval: files
# round their time column.
_EVENNESS = 0.05
# Fewest rows before the impact whose mean is a bias.
_BIAS_ROWS = 10
_INTEGRALS = {
    "acceleration": "m/s",
    "speed": "m",
    "force": "N s",
    "angular acceleration": "deg/s",
    "angular velocity": "deg",
}


@checked
@dataclass(frozen=True, eq=False)
class Samples:
    """The values of :class:`birm3d.Channel` and what is computed of them; its parameters are said there."""

    _public_name = "Channel"  # what messages call it

    name: str
    time: Floats
    values: Floats
    unit: str
    cfc: float | None = None
    source: str = ""
    info: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        units.measure(self.unit)
        if self.cfc is not None and not (math.isfinite(self.cfc) and self.cfc > 0.0):
            raise ValueError(f"cfc must be finite and > 0, or None, got {self.cfc}")
        for name in ("time", "values"):
            array = np.array(getattr(self, name), float)
            if array.ndim != 1 or len(array) < 2:
                raise ValueError(f"{name} must have the shape (n,) with n > 1, got {array.shape}")
            if not np.isfinite(array).all():
                row = int(np.flatnonzero(~np.isfinite(array))[0])
                raise ValueError(f"{name} must be finite, got {array[row]} at row {row}")
            array.setflags(write=False)
            object.__setattr__(self, name, array)
        if len(self.time) != len(self.values):
            raise ValueError(
                f"values must be as long as time, {len(self.time)} rows, got {len(self.values)} rows"
            )
        steps = np.diff(self.time)
        if not (steps > 0.0).all():
            row = int(np.flatnonzero(steps <= 0.0)[0])
            raise ValueError(
                f"time must be strictly increasing, got {self.time[row]:g} s and then "
                f"{self.time[row + 1]:g} s at row {row + 1}"
            )
        object.__setattr__(self, "info", FrozenMapping(dict(self.info)))

    def __reduce__(self) -> tuple[Any, ...]:
        # Built anew when unpickled: pickled arrays would come back writable, and a mapping proxy not at all.
        values = {f.name: getattr(self, f.name) for f in fields(self)}
        return type(self), tuple({**values, "info": dict(self.info)}.values())

    def __len__(self) -> int:
        return len(self.time)

    def __repr__(self) -> str:
        class_ = f", CFC {self.cfc:g}" if self.cfc is not None else ""
        return (
            f"Channel({self.name!r} [{self.unit}], {len(self)} rows, "
            f"{self.time[0]:g} to {self.time[-1]:g} s{class_})"
        )

    @property
    def quantity(self) -> str:
        """What its unit measures, such as ``"force"``."""
        return units.measure(self.unit).quantity

    @property
    def is_even(self) -> bool:
        """Whether the rows are evenly spaced, within what a file's rounding does to a time column."""
        grid = np.linspace(self.time[0], self.time[-1], len(self))
        return bool(np.abs(self.time - grid).max() <= _EVENNESS * (grid[1] - grid[0]))

    @property
    def interval(self) -> float:
        """Sampling interval [s].

        Raises
        ------
        ValueError
            If the rows are not evenly spaced.
        """
        if not self.is_even:
            steps = np.diff(self.time)
            raise ValueError(
                f"time of {self.name!r} must be evenly spaced, got steps from {steps.min():g} to "
                f"{steps.max():g} s; see resampled()"
            )
        return float((self.time[-1] - self.time[0]) / (len(self) - 1))

    def with_values(self, values: npt.ArrayLike, **changes: Any) -> Self:
        """Return a channel with other values, and any other field changed as named."""
        return replace(self, values=np.asarray(values, float), **changes)

    def to_si(self) -> Self:
        """Return it in the unit used here: SI, degrees for angles."""
        measure = units.measure(self.unit)
        return self.with_values(self.values * measure.size, unit=measure.si)

    def to(self, unit: str) -> Self:
        """Return it in another unit of the same quantity."""
        mine, other = units.measure(self.unit), units.measure(unit)
        if mine.quantity != other.quantity:
            raise ValueError(f"unit must measure {mine.quantity} as {self.name!r} does, got {unit!r}")
        return self.with_values(self.values * (mine.size / other.size), unit=unit)

    def filtered(self, cfc: float) -> Self:
        """Return it filtered to a channel frequency class; see :func:`birm3d.filters.cfc`.

        A channel that is of this class already is returned as it is: run twice, the filter is narrower than
        the class.

        Raises
        ------
        ValueError
            If the rows are not evenly spaced, too far apart for the class, or have been filtered to a lower
            class: what is lost does not come back.
        """
        if self.cfc is not None and self.cfc < cfc:
            raise ValueError(f"cfc must be at most {self.cfc:g}, the class of {self.name!r}, got {cfc:g}")
        if self.cfc == cfc:
            return self
        return self.with_values(cfc_filter(self.values, cfc, self.interval), cfc=float(cfc))

    def resampled(self, time: npt.ArrayLike) -> Self:
        """Return it at other instants, by linear interpolation, without extrapolation.

        Parameters
        ----------
        time
            Shape (m,), strictly increasing, within the record [s].
        """
        instants = np.asarray(time, float)
        if instants.ndim != 1 or len(instants) < 2:
            raise ValueError(f"time must have the shape (m,) with m > 1, got {instants.shape}")
        self._within("time", instants.min(), instants.max())
        return replace(self, time=instants, values=np.interp(instants, self.time, self.values))

    def between(self, start: float, end: float) -> Self:
        """Return the rows from `start` to `end` [s], both included."""
        self._within("start", start, start)
        self._within("end", end, end)
        kept = (self.time >= start) & (self.time <= end)
        return replace(self, time=self.time[kept], values=self.values[kept])

    def _within(self, name: str, first: float, last: float) -> None:
        # Files round their time column, so the ends of a grid may lie a rounding outside.
        slack = 1e-9 + _EVENNESS * float(np.diff(self.time).min())
        if not (self.time[0] - slack <= first and last <= self.time[-1] + slack):
            raise ValueError(
                f"{name} must lie in the record of {self.name!r}, {self.time[0]:g} to {self.time[-1]:g} s, "
                f"got {first:g}" + (f" to {last:g}" if last != first else "")
            )

    def shifted(self, time_zero: float) -> Self:
        """Return it with another time zero: the instant `time_zero` [s] becomes 0."""
        if not math.isfinite(time_zero):
            raise ValueError(f"time_zero must be finite, got {time_zero}")
        return replace(self, time=self.time - time_zero)

    def flipped(self) -> Self:
        """Return it with the other sign."""
        return self.with_values(-self.values)

    def without_bias(self, before: float = 0.0) -> Self:
        """Return it less its mean over the rows before the instant `before` [s].

        Raises
        ------
        ValueError
            If there are fewer than ten such rows.
        """
        rows = self.values[self.time < before]
        if len(rows) < _BIAS_ROWS:
            raise ValueError(
                f"before must leave at least {_BIAS_ROWS} rows of {self.name!r} to average, "
                f"got {before:g} s with {len(rows)} rows"
            )
        return self.with_values(self.values - rows.mean())

    def integrated(self, initial: float = 0.0, at: float | None = None) -> Self:
        """Return its integral over time by the trapezoid rule, in the unit used here.

        Parameters
        ----------
        initial
            Value of the integral at the instant `at`, in the integral's unit here (m/s for accelerations).
        at
            Instant within the record [s]; None: its start.

        Raises
        ------
        ValueError
            If the quantity has no integral that is known here, or `at` is outside of the record.
        """
        unit = _INTEGRALS.get(self.quantity)
        if unit is None:
            raise ValueError(
                f"quantity of {self.name!r} must be one of {', '.join(_INTEGRALS)} to integrate, "
                f"got {self.quantity}"
            )
        values = self.to_si().values
        area = np.concatenate([[0.0], np.cumsum(0.5 * (values[1:] + values[:-1]) * np.diff(self.time))])
        if at is not None:
            self._within("at", at, at)
            area -= np.interp(at, self.time, area)
        return self.with_values(initial + area, unit=unit, name=f"integral of {self.name}")
