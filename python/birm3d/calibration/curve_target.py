"""A measured curve that a calibration is held against."""

# Longer than 300 lines: one class with its checks, arguments explained for users.
from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

from .. import units
from ..base.arguments import checked
from ..base.checks import is_number, pair
from ..result.event import DECIDED
from ..signals.filters import cfc
from .quantities import QUANTITIES, computed_curve, touch_time
from .scalar_target import check_positive

if TYPE_CHECKING:
    from ..result.result import Result
    from ..signals.channel import Channel

__all__ = ["CurveTarget"]

Floats = npt.NDArray[np.float64]

# Points count as evenly spaced when each is this close to its place, as a share of the interval.
_EVEN = 0.05
# Curves whose cosine is below this point in opposite directions.
_OPPOSITE = -0.5


@checked
@dataclass(frozen=True, eq=False)
class CurveTarget:
    r"""A measured curve.

    Residuals are :math:`r_i = \sqrt{w\,m/n}\;(f_i - y_i)/\sigma_i` for n points of which m are independent.
    If all of them are (m = n, w = 1), half their sum of squares is the negative logarithm of the likelihood.
    Neighbouring points of a filtered curve are correlated. Counting them as independent makes every interval
    too narrow by sqrt(n/m). m is the smaller of

    * the filter's: white noise through a filter of noise bandwidth B has m = 2 B T in a record of length T.
      Its integrated correlation time is 1/(2 B). A CFC is a two-pole Butterworth filter, run twice, with the
      corner fc = 2.0775 CFC Hz. It has B = 3 pi fc / (8 sqrt 2) = 1.73 CFC Hz;
    * the residuals' own: m = n / (1 + 2 sum rho_k), with the autocorrelation rho_k of what the fitted model
      leaves. The sum ends at a window of five correlation times (Sokal) and is corrected for what the
      parameters took away. A model that can not follow the curve leaves slow residuals, and this widens the
      intervals.

    The second needs a fit, so that the fit is repeated until m settles.

    Parameters
    ----------
    x
        Shape (n,), increasing: time since the first touch [s], or displacement of the mass centre towards the
        barrier [m].
    y
        Shape (n,), SI; degrees for angles. Signs as :data:`birm3d.calibration.QUANTITIES` has them.
    quantity
        ``"normal_force"``, ``"acceleration_r"``, ``"acceleration_normal"``, ``"velocity_normal"``,
        ``"displacement_normal"``, ``"roll"``, ``"pitch"`` or ``"yaw"``.
    against
        What x is: ``"time"`` or ``"displacement"`` (of the loading branch).
    sigma
        Standard deviation of a point, in the unit of y, scalar or shape (n,); ``None``: estimated from what
        the fit leaves.
    cfc
        Channel frequency class applied to the computed curve, and to the measured one unless ``filtered``.
    filtered
        Whether y has been filtered already.
    independent_points
        m; ``None``: as above; ``"all"``: n.
    weight
        Counts the curve as so many (w).
    window
        First and last x that count.
    name
        For reports; ``None``: the quantity.

    Raises
    ------
    ValueError
        Naming the argument, its limit and the value received.
    """

    x: npt.ArrayLike
    y: npt.ArrayLike
    quantity: str = "normal_force"
    against: Literal["time", "displacement"] = "time"
    sigma: npt.ArrayLike | None = None
    cfc: float | None = None
    filtered: bool = False
    independent_points: float | Literal["all"] | None = None
    weight: float = 1.0
    window: tuple[float, float] | None = None
    name: str | None = None
    _x: Floats = field(init=False, repr=False)
    _y: Floats = field(init=False, repr=False)
    _sigma: Floats | None = field(init=False, repr=False)

    def __post_init__(self) -> None:
        if self.quantity not in QUANTITIES:
            raise ValueError(f"quantity must be one of {', '.join(QUANTITIES)}; got {self.quantity!r}")
        if self.against not in ("time", "displacement"):
            raise ValueError(f"against must be 'time' or 'displacement', got {self.against!r}")
        x, y = _vector("x", self.x), _vector("y", self.y)
        if len(x) != len(y):
            raise ValueError(f"y must have the length of x, {len(x)}; got {len(y)}")
        if len(x) < 2:
            raise ValueError(f"x must have at least 2 points, got {len(x)}")
        backward = np.flatnonzero(np.diff(x) <= 0.0)
        if len(backward):
            i = int(backward[0])
            raise ValueError(f"x must increase, got {x[i]:g} and then {x[i + 1]:g} (points {i} and {i + 1})")
        sigma = None
        if self.sigma is not None:
            sigma = (
                np.broadcast_to(np.asarray(self.sigma, float), x.shape)
                if np.ndim(self.sigma) == 0
                else (_vector("sigma", self.sigma))
            )
            if len(sigma) != len(x):
                raise ValueError(
                    f"sigma must be one number or have the length of x, {len(x)}; got {len(sigma)}"
                )
            if not (np.isfinite(sigma) & (sigma > 0.0)).all():
                raise ValueError(f"sigma must be finite and > 0, got {_worst(sigma)}")
        check_positive("weight", self.weight)
        if self.cfc is not None:
            check_positive("cfc", self.cfc)
            y = y if self.filtered else self._filter(x, y)
        points = self.independent_points
        if not (points is None or points == "all" or (is_number(points) and 1.0 <= points <= len(x))):
            raise ValueError(f"independent_points must be 'all' or 1 to {len(x)}, got {points!r}")
        keep = x >= 0.0  # before the touch a scene has nothing to be held against
        if self.window is not None:
            first, last = pair("window", self.window)
            if not first < last:
                raise ValueError(f"window must be first < last, got {self.window}")
            keep &= (x >= first) & (x <= last)
        if keep.sum() < 2:
            raise ValueError(
                f"window must leave at least 2 points with x >= 0; x runs from {x[0]:g} to {x[-1]:g} and "
                f"the window is {self.window}"
            )
        object.__setattr__(self, "_x", _frozen(x[keep]))
        object.__setattr__(self, "_y", _frozen(y[keep]))
        object.__setattr__(self, "_sigma", None if sigma is None else _frozen(sigma[keep]))

    def _filter(self, x: Floats, y: Floats) -> Floats:
        assert self.cfc is not None
        if self.against != "time":
            raise ValueError(
                "filtered must be True against displacement: a channel filter works in time; got False"
            )
        steps = np.diff(x)
        interval = float(x[-1] - x[0]) / (len(x) - 1)
        if np.abs(x - np.linspace(x[0], x[-1], len(x))).max() > _EVEN * interval:
            raise ValueError(
                f"x must be evenly spaced where a filter is asked for, got steps from {steps.min():g} to "
                f"{steps.max():g} s"
            )
        return cfc(y, self.cfc, interval)

    @classmethod
    def from_channel(cls, channel: Channel, quantity: str = "normal_force", **options: Any) -> CurveTarget:
        """Return a target from a measured channel, converted to SI.

        A channel of a filter class is held against a computed curve of the same class; ``cfc`` among the
        options filters an unfiltered one too.

        Parameters
        ----------
        channel
            Time zero at the first touch; see :meth:`birm3d.Channel.shifted`.
        quantity, options
            Of :class:`CurveTarget`.

        Raises
        ------
        ValueError
            If the channel's unit does not measure the quantity.
        """
        if quantity not in QUANTITIES:
            raise ValueError(f"quantity must be one of {', '.join(QUANTITIES)}; got {quantity!r}")
        wanted = units.measure(QUANTITIES[quantity].unit).quantity
        if channel.quantity != wanted:
            raise ValueError(
                f"unit of {channel.name!r} must measure {wanted} for {quantity}, got {channel.unit!r}"
            )
        si = channel.to_si()
        if si.cfc is not None:
            options = {"cfc": si.cfc, "filtered": True, **options}
        return cls(si.time, si.values, quantity, **{"name": channel.name, **options})

    @property
    def label(self) -> str:
        """Name for reports."""
        return self.name or self.quantity

    @property
    def points(self) -> Floats:
        """X of the points that count, shape (m,)."""
        return self._x

    @property
    def measured(self) -> Floats:
        """Measured values, filtered, shape (m,)."""
        return self._y

    @property
    def given_sigma(self) -> Floats | None:
        """Standard deviations, shape (m,), or ``None`` where they are to be estimated."""
        return self._sigma

    @property
    def filter_points(self) -> float:
        """Number of independent points that the filter's bandwidth leaves, at most all."""
        n = float(len(self._x))
        if self.cfc is None or self.against != "time":
            return n
        bandwidth = 3.0 * math.pi / (8.0 * math.sqrt(2.0)) * 2.0775 * self.cfc
        length = float(self._x[-1] - self._x[0]) * n / (n - 1.0)
        return min(n, max(2.0, 2.0 * bandwidth * length))

    def computed(self, result: Result) -> Floats:
        """Return the computed curve at the points, shape (m,)."""
        return computed_curve(result, self.quantity, self._x, self.against, self.cfc)

    def check(self, result: Result) -> list[str]:
        """Hold the curve against a first run; return what a reader should know.

        Raises
        ------
        ValueError
            If run and curve do not overlap, or point in opposite directions.
        """
        notes = []
        if self.against == "time":
            end = float(result.time[-1]) - touch_time(result)
            by_itself = result.end_reason in DECIDED
            if self._x[0] >= end or (not by_itself and self._x[-1] > end + 1e-9):
                raise ValueError(
                    f"{self.label}: x must lie within the computed run, which ends at {end:g} s after the "
                    f"first touch ({result.end_reason}); got {self._x[0]:g} to {self._x[-1]:g} s: give the "
                    "simulation a longer duration or the curve a window"
                )
            if by_itself and self._x[-1] < end - 1e-3:
                notes.append(
                    f"{self.label}: the curve ends at {self._x[-1] * 1e3:.1f} ms, the computed event at "
                    f"{end * 1e3:.1f} ms: what comes later is not seen"
                )
        computed = self.computed(result)
        ratio = _ratio(computed, self._y)
        if not 1e-2 < ratio < 1e2:
            notes.append(
                f"{self.label}: measured values are {ratio:.2g} times the computed ones: check the unit"
            )
            return notes
        size = float(np.linalg.norm(computed) * np.linalg.norm(self._y))
        if float(computed @ self._y) < _OPPOSITE * size:
            kind = QUANTITIES[self.quantity]
            raise ValueError(
                f"{self.label}: y must be positive where it {_verb(kind.positive)}; the computed curve peaks "
                f"at {_peak(computed):+.4g} {kind.unit}, the measured one at {_peak(self._y):+.4g}: "
                "turn its sign"
            )
        return notes


def _vector(name: str, values: npt.ArrayLike) -> Floats:
    array = np.array(values, float)
    if array.ndim != 1:
        raise ValueError(f"{name} must have shape (n,), got {array.shape}")
    wrong = np.flatnonzero(~np.isfinite(array))
    if len(wrong):
        raise ValueError(f"{name} must be finite, got {array[wrong[0]]} at point {wrong[0]}")
    return array


def _frozen(array: Floats) -> Floats:
    copy = np.array(array)
    copy.setflags(write=False)
    return copy


def _worst(sigma: Floats) -> float:
    return float(sigma[~(np.isfinite(sigma) & (sigma > 0.0))][0])


def _peak(values: Floats) -> float:
    return float(values[np.abs(values).argmax()])


def _ratio(computed: Floats, measured: Floats) -> float:
    size = float(np.abs(computed).max())
    return float(np.abs(measured).max()) / size if size > 0.0 else 1.0


def _verb(positive: str) -> str:
    return positive if positive.startswith("pushes") else f"points {positive}"
