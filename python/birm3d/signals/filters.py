"""Channel filters of crash testing."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from ..base.arguments import checked

__all__ = ["cfc", "moving_average"]

Floats = npt.NDArray[np.float64]


@checked
def cfc(signal: npt.ArrayLike, channel_class: float, interval: float) -> Floats:
    """Filter a signal by a channel frequency class of SAE J211-1.

    Two-pole Butterworth low-pass run forwards and backwards (four poles, no phase), with the corner
    2.0775 CFC as J211-1 has it (ISO 6487: 1.25 CFC / 0.6, 0.3 % higher), pre-warped for the sampling rate.
    The signal is taken as constant before its start and after its end.

    Parameters
    ----------
    signal
        Shape (n,) or (n, k), evenly spaced along the first axis.
    channel_class
        60, 180, 600 or 1000, or any other positive number.
    interval
        Sampling interval [s].

    Raises
    ------
    ValueError
        If the sampling is too coarse for the class: J211-1 asks for at least ten times the class in Hz.
    """
    from scipy.signal import filtfilt  # imported when used: it takes longer to load than a crash to run

    x = _rows(signal)
    if not channel_class > 0.0:
        raise ValueError(f"channel_class must be > 0, got {channel_class}")
    if not 0.0 < interval * channel_class <= 0.1:
        raise ValueError(
            f"interval must be > 0 and at most {0.1 / channel_class:g} s for CFC {channel_class:g}, "
            f"got {interval}"
        )
    wa = math.tan(math.pi * channel_class * 2.0775 * interval)
    norm = 1.0 + math.sqrt(2.0) * wa + wa * wa
    numerator = np.array([1.0, 2.0, 1.0]) * (wa * wa / norm)
    denominator = np.array([1.0, 2.0 * (wa * wa - 1.0) / norm, (1.0 - math.sqrt(2.0) * wa + wa * wa) / norm])
    padding = min(len(x) - 1, math.ceil(2.0 / (channel_class * interval)))
    filtered: Floats = filtfilt(numerator, denominator, x, axis=0, padtype="constant", padlen=padding)
    return filtered


@checked
def moving_average(signal: npt.ArrayLike, width: float, interval: float) -> Floats:
    """Mean over a window of `width` [s] that ends at each row; zero before the start.

    Parameters
    ----------
    signal
        Shape (n,) or (n, k), evenly spaced along the first axis.
    width, interval
        Of the window and of the sampling [s].
    """
    x = _rows(signal)
    for name, value in (("width", width), ("interval", interval)):
        if not (math.isfinite(value) and value > 0.0):
            raise ValueError(f"{name} must be finite and > 0, got {value}")
    n = max(1, round(width / interval))
    total = np.concatenate([np.zeros((n, *x.shape[1:])), np.cumsum(x, axis=0)])
    mean: Floats = (total[n:] - total[:-n]) / n
    return mean


def _rows(signal: npt.ArrayLike) -> Floats:
    """Return a signal as an array, or refuse one without rows or with values that are not finite."""
    x = np.asarray(signal, float)
    if x.ndim == 0 or len(x) == 0:
        raise ValueError(f"signal must have shape (n,) or (n, k) and n > 0, got {x.shape}")
    if not np.isfinite(x).all():
        raise ValueError("signal must be finite, got a value that is not")
    return x
