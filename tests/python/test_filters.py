"""Channel frequency classes of SAE J211-1, and the moving average."""

from __future__ import annotations

import math

import numpy as np
import pytest
from birm3d import filters
from scipy.signal import lfilter

# SAE J211-1 (Instrumentation for impact test, part 1), appendix: y[n] = a0 x[n] + a1 x[n-1] + a2 x[n-2] +
# b1 y[n-1] + b2 y[n-2] with w_d = 2 pi CFC 2.0775, run forwards and backwards; at three samplings.
J211 = {
    (10_000, 60): (0.001452367, 0.002904735, 0.001452367, 1.889343224, -0.895152694),
    (10_000, 180): (0.011796271, 0.023592542, 0.011796271, 1.670117463, -0.717302548),
    (2000, 60): (0.029806072, 0.059612144, 0.029806072, 1.455728214, -0.574952502),
    (2000, 180): (0.185874043, 0.371748087, 0.185874043, 0.466875271, -0.210371444),
    (1000, 60): (0.097184625, 0.194369251, 0.097184625, 0.945574009, -0.33431251),
}


def gain(rate: float, channel_class: float, frequency: float) -> float:
    """Amplitude of a sine in the middle of a long record."""
    t = np.arange(0, 2.0, 1.0 / rate)
    sine = np.sin(2.0 * math.pi * frequency * t)
    filtered = filters.cfc(sine, channel_class, 1.0 / rate)
    middle = slice(len(t) // 4, -len(t) // 4)
    return float(np.linalg.norm(filtered[middle]) / np.linalg.norm(sine[middle]))


@pytest.mark.parametrize(("rate", "channel_class"), J211)
def test_impulse_response_is_that_of_the_standards_recursion(rate: int, channel_class: int) -> None:
    if rate < 10 * channel_class:
        with pytest.raises(ValueError, match="interval"):
            filters.cfc(np.zeros(9), channel_class, 1.0 / rate)
        return
    a0, a1, a2, b1, b2 = J211[rate, channel_class]
    impulse = np.zeros(2001)
    impulse[1000] = 1.0
    once = lfilter([a0, a1, a2], [1.0, -b1, -b2], impulse)
    expected = lfilter([a0, a1, a2], [1.0, -b1, -b2], once[::-1])[::-1]
    actual = filters.cfc(impulse, channel_class, 1.0 / rate)
    # The coefficients are given to nine places, and poles near 1 stretch their last place tenfold.
    assert actual == pytest.approx(expected, abs=1e-6 * expected.max())


def test_minus_three_decibels() -> None:
    # J211-1: CFC 60 is 3 dB down at 100 Hz, CFC 180 at 300 Hz, which its formula meets to a few percent.
    assert gain(10_000, 60, 100.0) == pytest.approx(10.0 ** (-3.0 / 20.0), rel=0.03)
    assert gain(10_000, 180, 300.0) == pytest.approx(10.0 ** (-3.0 / 20.0), rel=0.03)


def test_corridor_of_the_class() -> None:
    # J211-1, figure of the frequency response, CFC 60: flat within 0.5 dB to 60 Hz, -30 dB or less at 600 Hz.
    for frequency in (1.0, 10.0, 30.0, 60.0):
        assert abs(20.0 * math.log10(gain(10_000, 60, frequency))) < 0.5
    assert 20.0 * math.log10(gain(10_000, 60, 600.0)) < -30.0


@pytest.mark.parametrize("rate", [1000, 2000, 10_000, 100_000])
def test_the_answer_does_not_hang_on_the_sampling(rate: int) -> None:
    assert gain(rate, 60, 60.0) == pytest.approx(gain(1_000_000 // 5, 60, 60.0), rel=0.02)


def test_zero_phase() -> None:
    t = np.linspace(0.0, 0.2, 2001)
    pulse = np.exp(-(((t - 0.1) / 0.01) ** 2))
    filtered = filters.cfc(pulse, 60, 1e-4)
    assert t[filtered.argmax()] == pytest.approx(0.1, abs=1e-4)
    assert filtered == pytest.approx(filtered[::-1], abs=1e-9)
    # The area stays: the gain at zero frequency is 1.
    assert filtered.sum() == pytest.approx(pulse.sum(), rel=1e-6)


def test_a_constant_passes_unchanged() -> None:
    assert filters.cfc(np.full(500, -7.5), 60, 1e-4) == pytest.approx(-7.5, rel=1e-9)
    assert filters.cfc([3.0], 60, 1e-4) == pytest.approx([3.0], rel=1e-9)


def test_columns_are_filtered_one_by_one() -> None:
    rng = np.random.default_rng(1)
    signal = rng.normal(size=(400, 3))
    together = filters.cfc(signal, 60, 1e-4)
    assert together.shape == (400, 3)
    for i in range(3):
        assert together[:, i] == pytest.approx(filters.cfc(signal[:, i], 60, 1e-4), rel=1e-12, abs=1e-15)


@pytest.mark.parametrize(
    ("arguments", "naming"),
    [
        (([1.0, math.nan], 60, 1e-4), "signal must be finite"),
        (([1.0, 2.0], 0.0, 1e-4), "channel_class must be > 0, got 0"),
        (([1.0, 2.0], math.nan, 1e-4), "channel_class must be > 0, got nan"),
        (([1.0, 2.0], 60, 0.0), "interval must be > 0 and at most .* got 0"),
        (([1.0, 2.0], 60, 2e-3), "interval must be > 0 and at most 0.00166667 s for CFC 60, got 0.002"),
        (([1.0, 2.0], 60, math.nan), "interval must be .* got nan"),
    ],
)
def test_bad_arguments(arguments: tuple, naming: str) -> None:
    with pytest.raises(ValueError, match=naming):
        filters.cfc(*arguments)


def test_moving_average() -> None:
    signal = np.arange(10.0)
    averaged = filters.moving_average(signal, 0.3, 0.1)
    # The window ends at each row and reaches back before the start, where there is nothing.
    assert averaged == pytest.approx([0.0, 1.0 / 3.0, 1.0, *range(2, 9)], rel=1e-12)
    constant = filters.moving_average(np.full(1000, 4.0), 0.05, 1e-4)
    assert constant[499:] == pytest.approx(4.0, rel=1e-12)


@pytest.mark.parametrize("bad", [{"width": 0.0}, {"width": -1.0}, {"width": math.nan}, {"interval": 0.0}])
def test_moving_average_refuses(bad: dict[str, float]) -> None:
    with pytest.raises(ValueError, match=r"width|interval"):
        filters.moving_average(np.ones(5), **{"width": 0.05, "interval": 1e-4, **bad})


@pytest.mark.parametrize("interval", [1e-3, 1e-4])
@pytest.mark.parametrize("width", [0.010, 0.050])
def test_windows_of_10_and_50_ms_on_a_half_sine(width: float, interval: float) -> None:
    # The greatest mean of sin(pi t / T) over a width w is that about its peak: 2 T / (pi w) sin(pi w / 2 T).
    # (Ridedown acceleration uses 10 ms, the peak force of roadside barriers 50 ms.)
    duration = 0.1
    t = np.arange(0.0, 0.2, interval) + interval / 2.0
    pulse = np.where(t < duration, np.sin(math.pi * t / duration), 0.0)
    greatest = filters.moving_average(pulse, width, interval)
    exact = 2.0 * duration / (math.pi * width) * math.sin(math.pi * width / (2.0 * duration))
    assert greatest.max() == pytest.approx(exact, rel=1e-3)
    assert t[greatest.argmax()] == pytest.approx((duration + width) / 2.0, abs=1.5 * interval)


def test_the_corner_is_that_of_sae_j211_and_not_of_iso_6487() -> None:
    # J211-1: 2.0775 CFC; ISO 6487: 1.25 CFC / 0.6, 0.28 % higher. At the corner the two passes give 1/2.
    assert gain(100_000, 60, 60 * 2.0775) == pytest.approx(0.5, rel=1e-5)
    assert abs(gain(100_000, 60, 60 / 0.6 * 1.25) / 0.5 - 1.0) > 2e-3


@pytest.mark.parametrize("channel_class", [60, 180])
@pytest.mark.parametrize("n", [1, 9, 300, 400, 2000])
def test_the_peak_by_gains_is_that_of_the_filtered_rows(channel_class: float, n: int) -> None:
    noise = np.cumsum(np.random.default_rng(n).normal(size=(n, 3)), axis=0)
    pulse = np.sin(np.linspace(0.0, 3.0, n))[:, None] * [3.0, -2.0, 0.5]
    for signal in (noise, pulse, 1e6 * pulse[:, 0]):
        rows = filters.cfc(signal, channel_class, 1e-4).reshape(n, -1)
        peak = np.linalg.norm(rows, axis=1).max()
        assert filters.peak_of_cfc(signal, channel_class, 1e-4) == pytest.approx(peak, rel=1e-9)


def test_the_peak_by_gains_refuses_what_the_filter_refuses() -> None:
    for arguments in (([], 60, 1e-4), ([1.0], 0.0, 1e-4), ([1.0], 60, 1e-2), ([math.nan], 60, 1e-4)):
        with pytest.raises(ValueError, match=r"must (be|have)") as first:
            filters.cfc(*arguments)
        with pytest.raises(ValueError, match=r"must (be|have)") as second:
            filters.peak_of_cfc(*arguments)
        assert str(first.value) == str(second.value)
