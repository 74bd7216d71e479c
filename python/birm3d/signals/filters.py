"""Channel filters of crash testing."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from ..base.arguments import checked

__all__ = ["cfc", "moving_average", "peak_of_cfc"]

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

    x, wa = _rows(signal), _corner(channel_class, interval)
    norm = 1.0 + math.sqrt(2.0) * wa + wa * wa
    numerator = np.array([1.0, 2.0, 1.0]) * (wa * wa / norm)
    denominator = np.array([1.0, 2.0 * (wa * wa - 1.0) / norm, (1.0 - math.sqrt(2.0) * wa + wa * wa) / norm])
    padding = min(len(x) - 1, _padding(channel_class, interval))
    filtered: Floats = filtfilt(numerator, denominator, x, axis=0, padtype="constant", padlen=padding)
    return filtered


@checked
def peak_of_cfc(signal: npt.ArrayLike, channel_class: float, interval: float) -> float:
    """Return the greatest magnitude of the rows of :func:`cfc`, without loading SciPy's filters.

    To load them takes as long as all else that `birm3d run` does. Here the signal is multiplied by the gain
    of the filter at each frequency f, 1 / (1 + (tan(pi f dt) / wa)^4), with wa the tangent at the corner. The
    peak is that of :func:`cfc` but for rounding: both passes at once. Records that are shorter than its
    padding are filtered by it.

    Parameters
    ----------
    signal, channel_class, interval
        As of :func:`cfc`.

    Raises
    ------
    ValueError
        As :func:`cfc`.
    """
    x, wa = _rows(signal), _corner(channel_class, interval)
    if len(x) <= _padding(channel_class, interval):
        return float(np.linalg.norm(cfc(x, channel_class, interval).reshape(len(x), -1), axis=1).max())
    padding = 4 * _padding(channel_class, interval)  # the response has died out: the ends do not meet
    padded = np.pad(x.reshape(len(x), -1), ((padding, padding), (0, 0)), mode="edge")
    half_angle = np.pi * np.fft.rfftfreq(len(padded))
    gain = 1.0 / (1.0 + (np.tan(half_angle) / wa) ** 4)
    filtered = np.fft.irfft(gain[:, None] * np.fft.rfft(padded, axis=0), len(padded), axis=0)
    return float(np.linalg.norm(filtered[padding : padding + len(x)], axis=1).max())


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


def _padding(channel_class: float, interval: float) -> int:
    """Return the rows in which the response of the filter falls to 1e-8."""
    return math.ceil(2.0 / (channel_class * interval))


def _corner(channel_class: float, interval: float) -> float:
    """Return the corner of a class, pre-warped: the tangent of half its angle per row."""
    if not channel_class > 0.0:
        raise ValueError(f"channel_class must be > 0, got {channel_class}")
    if not 0.0 < interval * channel_class <= 0.1:
        raise ValueError(
            f"interval must be > 0 and at most {0.1 / channel_class:g} s for CFC {channel_class:g}, "
            f"got {interval}"
        )
    return math.tan(math.pi * channel_class * 2.0775 * interval)


def _rows(signal: npt.ArrayLike) -> Floats:
    """Return a signal as an array, or refuse one without rows or with values that are not finite."""
    x = np.asarray(signal, float)
    if x.ndim == 0 or len(x) == 0:
        raise ValueError(f"signal must have shape (n,) or (n, k) and n > 0, got {x.shape}")
    if not np.isfinite(x).all():
        raise ValueError("signal must be finite, got a value that is not")
    return x
