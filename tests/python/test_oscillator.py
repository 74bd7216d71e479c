"""Equivalent static force: exact solutions, tables of dynamic load factors, limits, another integration."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
import pytest
from birm3d.assessment.oscillator import ductility_demand, elastic_force, resistance

Floats = npt.NDArray[np.float64]

PERIOD, STEP = 0.1, 1e-4
OMEGA = 2.0 * math.pi / PERIOD


def means(pulse: str, lasting: float, step: float = STEP) -> Floats:
    """Return a pulse of height 1 as means over its intervals."""
    edges = np.arange(round(lasting / step) + 1) * step / lasting
    integral = {
        "rectangle": edges,
        "falling": edges - edges**2 / 2.0,
        "half sine": (1.0 - np.cos(math.pi * edges)) / math.pi,
        "triangle": np.where(edges < 0.5, edges**2, 2.0 * edges - edges**2 - 0.5),
    }[pulse]
    return np.diff(integral) * lasting / step


@pytest.mark.parametrize("ratio", [0.05, 0.2, 0.4, 0.5, 0.8, 3.0])
def test_rectangle(ratio: float) -> None:
    exact = 2.0 * math.sin(math.pi * ratio) if ratio < 0.5 else 2.0
    assert elastic_force(means("rectangle", ratio * PERIOD), STEP, PERIOD) == pytest.approx(exact, rel=1e-9)


def falling(ratio: float) -> float:
    """Load that falls to zero (Biggs 1964, section 2.3): the greater of both phases, from their equations."""
    a = 2.0 * math.pi * ratio
    during = np.linspace(0.0, 1.0, 400_001)
    forced = 1.0 - np.cos(a * during) + np.sin(a * during) / a - during
    after = math.hypot(math.sin(a) / a - math.cos(a), math.sin(a) - (1.0 - math.cos(a)) / a)
    return max(float(forced.max()), after)


@pytest.mark.parametrize("ratio", [0.1, 0.3, 0.5, 1.0, 2.0, 10.0])
def test_load_that_falls_to_zero(ratio: float) -> None:
    step = min(STEP, ratio * PERIOD / 1000.0)
    found = elastic_force(means("falling", ratio * PERIOD, step), step, PERIOD)
    assert found == pytest.approx(falling(ratio), rel=1e-5)


@pytest.mark.parametrize(
    ("pulse", "ratio", "chart"),
    [  # read off the shock spectra of Chopra, Dynamics of Structures, chapter 4, and Biggs 1964, figure 2.7
        *(("half sine", 0.5, math.pi / 2.0), ("half sine", 1.0, 1.732), ("half sine", 0.8, 1.77)),
        *(("triangle", 0.5, 1.27), ("triangle", 1.0, 1.52), ("triangle", 2.0, 1.0)),
        *(("falling", 0.5, 1.20), ("falling", 1.0, 1.55), ("falling", 2.0, 1.76), ("falling", 10.0, 1.95)),
    ],
)
def test_charts_of_dynamic_load_factors(pulse: str, ratio: float, chart: float) -> None:
    assert elastic_force(means(pulse, ratio * PERIOD), STEP, PERIOD) == pytest.approx(chart, rel=0.012)


@pytest.mark.parametrize("pulse", ["rectangle", "falling", "half sine", "triangle"])
def test_limits_of_the_period(pulse: str) -> None:
    """A short pulse asks for impulse times circular frequency, one that grows slowly for its peak."""
    load = means(pulse, 0.01)
    impulse, long = load.sum() * STEP, 5.0
    assert elastic_force(load, STEP, long) == pytest.approx(impulse * 2.0 * math.pi / long, rel=1e-4)
    if pulse in ("half sine", "triangle"):
        assert elastic_force(means(pulse, 1.0), STEP, 0.004) == pytest.approx(1.0, rel=0.01)


@pytest.mark.parametrize("ductility", [1.0, 1.5, 2.0, 3.0, 10.0])
def test_constant_load(ductility: float) -> None:
    """Work of the load = energy of the spring: R / F = 1 / (1 - 1 / (2 mu)) (Biggs 1964, section 2.7)."""
    exact = 1.0 / (1.0 - 0.5 / ductility)
    assert resistance(np.ones(5000), STEP, PERIOD, ductility) == pytest.approx(exact, rel=1e-7)


@pytest.mark.parametrize("ductility", [1.0, 2.0, 5.0])
def test_impulse(ductility: float) -> None:
    """Kinetic energy = energy of the spring: R = I w / sqrt(2 mu - 1)."""
    load = np.array([0.0, 1e6, 0.0])
    exact = 10.0 * OMEGA / math.sqrt(2.0 * ductility - 1.0)
    assert resistance(load, 1e-5, PERIOD, ductility) == pytest.approx(exact, rel=1e-4)


def test_scales_with_the_load_and_is_the_same_both_ways() -> None:
    load = means("triangle", 0.07) + 0.5 * means("rectangle", 0.07)
    for ductility in (1.0, 3.0):
        once = resistance(load, STEP, PERIOD, ductility, 0.05)
        assert resistance(-7e5 * load, STEP, PERIOD, ductility, 0.05) == pytest.approx(7e5 * once, rel=1e-7)
        later = np.concatenate([np.zeros(300), load, np.zeros(50)])
        assert resistance(later, STEP, PERIOD, ductility, 0.05) == pytest.approx(once, rel=2e-4)


def stepped(load: Floats, strength: float, damping: float) -> float:
    """Ductility demand by steps of Euler and Cromer, ten in an interval."""
    h, u, v, plastic, greatest = STEP / 10.0, 0.0, 0.0, 0.0, 0.0
    for p in np.concatenate([load, np.zeros(1000)]).tolist():
        for _ in range(10):
            r = OMEGA**2 * (u - plastic)
            if abs(r) > strength:
                r = math.copysign(strength, r)
                plastic = u - r / OMEGA**2
            v += h * (p - r - 2.0 * damping * OMEGA * v)
            u += h * v
            greatest = max(greatest, abs(u))
    return greatest * OMEGA**2 / strength


@pytest.mark.parametrize(("damping", "ductility"), [(0.0, 3.0), (0.05, 1.0), (0.1, 2.0)])
def test_against_another_integration(damping: float, ductility: float) -> None:
    noise = np.random.default_rng(3).normal(size=600)
    load = np.abs(noise.cumsum()) * np.exp(-np.arange(600) / 150.0)
    found = resistance(load, STEP, PERIOD, ductility, damping)
    assert ductility_demand(load, STEP, PERIOD, found, damping) == pytest.approx(ductility, rel=2e-4)
    assert stepped(load, found, damping) == pytest.approx(ductility, rel=1e-3)


def test_the_greatest_of_several_resistances() -> None:
    """Where the load changes its sign, no greater resistance may yield more than the ductility."""
    load = np.concatenate([means("half sine", 0.05), -1.4 * means("half sine", 0.06)])
    found = resistance(load, STEP, PERIOD, 2.0)
    shares = np.linspace(found * 1.001, elastic_force(load, STEP, PERIOD), 60)
    assert all(ductility_demand(load, STEP, PERIOD, share) <= 2.0 for share in shares)


def test_no_load() -> None:
    assert elastic_force(np.zeros(5), STEP, PERIOD) == resistance(np.zeros(5), STEP, PERIOD, 3.0) == 0.0
