"""Equivalent static force: what a load history asks of a system with one degree of freedom.

The system has the natural period T, the circular frequency w = 2 pi / T and the damping ratio z:

    u'' + 2 z w u' + f(u) / m = p(t) / m,    f(u) = m w^2 u, elastic, or bounded by +-R, elastic-plastic

(Biggs, Introduction to Structural Dynamics, 1964, chapter 2; Chopra, Dynamics of Structures, chapters 4
and 7). The elastic force is m w^2 max|u|: the greatest load times its dynamic load factor. The
elastic-plastic one is the yield resistance R at which max|u| is the ductility times R / (m w^2), the yield
displacement.

Loads are means over their intervals, so each interval is solved exactly for a constant load. After the last
one the load is zero, and the system vibrates freely.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable

import numpy as np
import numpy.typing as npt

__all__ = ["LEAST_INTERVALS", "ductility_demand", "elastic_force", "resistance"]

Floats = npt.NDArray[np.float64]

LEAST_INTERVALS = 4
"""Intervals of the load in a natural period, at the least."""

# Intervals of a load are put together up to this share of the period: it changes a force by less than 1e-4.
_SHARE = 1.0 / 200.0
_STEP = 0.93  # the search for the resistance goes down by this factor each time
_LEAST = 1e-4  # share of the elastic force at which the search ends


def elastic_force(load: Floats, interval: float, period: float, damping: float = 0.0) -> float:
    """Return the greatest force in the spring of an elastic system, [N] for a load in N.

    The state is one complex number s (the integral of Duhamel): s' = L s + p, L = -z w + i w_d, and m w_d u =
    Im s. Between two reversals of the velocity, Im(L s + p) = 0, no displacement is greater.

    Parameters
    ----------
    load
        Means over intervals of equal length, shape (n,) [N].
    interval, period
        Of the load and of the system [s].
    damping
        Ratio to the critical one, >= 0 and < 1.
    """
    from scipy.signal import lfilter

    omega = 2.0 * math.pi / period
    free = omega * math.sqrt(1.0 - damping * damping)
    pole = complex(-damping * omega, free)
    step = cmath.exp(pole * interval)
    gain = (step - 1.0) / pole
    ends = lfilter([gain], [1.0, -step], np.asarray(load, complex))
    starts = np.concatenate([[0.0], ends])
    loads = np.concatenate([load, [0.0]])
    # w = L s + p is the complex velocity: w(t) = w(0) exp(L t) while the load does not change.
    velocity = pole * starts + loads
    reversal = np.mod(-np.angle(velocity), math.pi) / free
    # After the end of the load the reversal may come at any time.
    reversal[:-1] = np.minimum(reversal[:-1], interval)
    greatest = np.abs((starts + (np.exp(pole * reversal) - 1.0) / pole * velocity).imag).max(initial=0.0)
    return float(max(greatest, np.abs(ends.imag).max(initial=0.0)) * omega * omega / free)


def resistance(
    load: Floats, interval: float, period: float, ductility: float = 1.0, damping: float = 0.0
) -> float:
    """Return the greatest resistance R at which the demand is the ductility, [N] for a load in N.

    Solves ``ductility_demand(R) = ductility`` (scipy's ``brentq``). With a little more resistance the system
    yields less. Under loads that change their sign lower resistances may be solutions, too; these are not
    used. At ductility 1 it is :func:`elastic_force`.

    Parameters
    ----------
    load, interval, period, damping
        See :func:`elastic_force`.
    ductility
        Displacement over yield displacement, >= 1.
    """
    from scipy.optimize import brentq

    elastic = elastic_force(load, interval, period, damping)
    if ductility == 1.0 or elastic == 0.0:
        return elastic
    demand = _demand(load, interval, period, damping)

    def excess(share: float) -> float:
        return demand(share * elastic) - ductility

    high = 1.0
    while high > _LEAST:
        low = high * _STEP
        if excess(low) >= 0.0:
            return float(elastic * brentq(excess, low, high, xtol=1e-9, rtol=1e-9))
        high = low
    raise ValueError(f"ductility must be one that the load can ask for, at most {demand(_LEAST * elastic):g}")


def ductility_demand(
    load: Floats, interval: float, period: float, strength: float, damping: float = 0.0
) -> float:
    """Return max|u| over the yield displacement of an elastic-plastic system of a strength [N]."""
    return _demand(load, interval, period, damping)(strength)


def _demand(load: Floats, interval: float, period: float, damping: float) -> Callable[[float], float]:
    """Return the ductility demand as a function of the resistance."""
    loads, step = _rebinned(np.asarray(load, float), interval, _SHARE * period)
    return lambda strength: _SoftSystem(period, damping, strength).demand(loads.tolist(), step)


def _rebinned(load: Floats, interval: float, wanted: float) -> tuple[Floats, float]:
    """Return the load without zeros at its ends, and its interval, near the wanted one."""
    acting = np.flatnonzero(load)
    load = load[acting[0] : acting[-1] + 1] if len(acting) else load[:0]
    if interval > wanted:
        parts = math.ceil(interval / wanted)
        return np.repeat(load, parts), interval / parts
    several = int(wanted / interval)
    padded = np.concatenate([load, np.zeros(-len(load) % several)])
    return padded.reshape(-1, several).mean(axis=1), several * interval


class _SoftSystem:
    """Elastic-plastic system of unit mass; exact between the instants at which it yields or turns.

    ``strain`` is the elastic part of the displacement, ``plastic`` the other.
    """

    def __init__(self, period: float, damping: float, strength: float) -> None:
        self.omega = 2.0 * math.pi / period
        self.drag = 2.0 * damping * self.omega
        self.free = self.omega * math.sqrt(1.0 - damping * damping)
        self.strength = strength
        self.yield_strain = strength / self.omega**2
        self.strain = self.velocity = self.plastic = 0.0
        self.greatest = 0.0

    def demand(self, loads: list[float], step: float) -> float:
        """Return the greatest displacement over the yield displacement."""
        swing = self._swing(step)
        for load in loads:
            if abs(self.strain) >= self.yield_strain and self.strain * self.velocity > 0.0:
                self._yield(load, step)
                continue
            strain, velocity = self.strain, self.velocity
            still = load / self.omega**2
            self.strain, self.velocity = _moved(swing, strain - still, velocity, still)
            if abs(self.strain) > self.yield_strain:
                self.strain, self.velocity = strain, velocity
                self._reach(load, step)
            else:
                self._note()
        # After the load it vibrates freely: the second period is as the first.
        swing = self._swing(step)
        for _ in range(math.ceil(2.0 * math.pi / (self.omega * step)) + 1):
            if abs(self.strain) >= self.yield_strain and self.strain * self.velocity > 0.0:
                self._yield(0.0, math.inf)
                continue
            strain, velocity = self.strain, self.velocity
            self.strain, self.velocity = _moved(swing, strain, velocity, 0.0)
            if abs(self.strain) > self.yield_strain:
                self.strain, self.velocity = strain, velocity
                self._reach(0.0, step)
            else:
                self._note()
        return self.greatest / self.yield_strain

    def _note(self) -> None:
        self.greatest = max(self.greatest, abs(self.strain + self.plastic))

    def _swing(self, time: float) -> tuple[float, float, float, float]:
        """Return the matrix of strain and velocity over a time of elastic motion."""
        decay = math.exp(-0.5 * self.drag * time)
        cosine, sine = math.cos(self.free * time), math.sin(self.free * time)
        ratio = 0.5 * self.drag / self.free
        return (
            decay * (cosine + ratio * sine),
            decay * sine / self.free,
            -decay * self.omega**2 / self.free * sine,
            decay * (cosine - ratio * sine),
        )

    def _reach(self, load: float, time: float) -> None:
        """Move elastically to the strain at which it yields, then on for the rest of the time."""
        still = load / self.omega**2
        low, high = 0.0, time
        for _ in range(40):
            middle = 0.5 * (low + high)
            strain, _velocity = _moved(self._swing(middle), self.strain - still, self.velocity, still)
            low, high = (middle, high) if abs(strain) <= self.yield_strain else (low, middle)
        self.strain, self.velocity = _moved(self._swing(high), self.strain - still, self.velocity, still)
        self.strain = math.copysign(self.yield_strain, self.strain)
        self._yield(load, time - high)

    def _yield(self, load: float, time: float) -> None:
        """Move at the yield strain until the velocity is zero, then elastically for the rest of the time."""
        push = load - math.copysign(self.strength, self.strain)
        drag, velocity = self.drag, self.velocity
        if drag > 0.0:
            last = push / drag  # velocity that it tends to
            reverses = last * velocity < 0.0
            stop = math.log1p(-velocity / last) / drag if reverses else math.inf
        else:
            reverses = push * velocity < 0.0
            stop = -velocity / push if reverses else math.inf
        lasting = min(time, stop)
        if drag > 0.0:
            gone = -math.expm1(-drag * lasting)
            self.plastic += last * lasting + (velocity - last) * gone / drag
            self.velocity = velocity + (last - velocity) * gone
        else:
            self.plastic += velocity * lasting + 0.5 * push * lasting**2
            self.velocity = velocity + push * lasting
        self._note()
        if stop <= time:
            self.velocity = 0.0
            if math.isfinite(time):
                still = load / self.omega**2
                swing = self._swing(time - stop)
                self.strain, self.velocity = _moved(swing, self.strain - still, 0.0, still)


def _moved(
    swing: tuple[float, float, float, float], strain: float, velocity: float, still: float
) -> tuple[float, float]:
    """Return strain and velocity after an elastic motion about the strain at which the load is carried."""
    a, b, c, d = swing
    return still + a * strain + b * velocity, c * strain + d * velocity
