"""Force-deflection law of a truss (paper Fig. 3)."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from birm3d import Barrier, Settings, Simulation, _core, scenes
from hypothesis import given, settings
from hypothesis import strategies as st

# Knee at 0.4 m (1.2 MN), plateau of 3 MN from 0.7 m on.
KNEE = _core.knee_curve(k_initial=3e6, knee=0.4, k_hardening=6e6, f_max=3e6, k_unloading=60e6)
# Peaks, buckles, hardens.
POINTS = _core.point_curve([0.0, 0.1, 0.25, 0.5], [0.0, 6e5, 2e5, 9e5], 2e7)
CURVES = pytest.mark.parametrize("curve", [KNEE, POINTS], ids=["knee", "points"])

# Forces are sums of hinge terms of the size of the greatest force.
ROUNDING = 1e-9 * 3e6


def envelope(curve: _core.TrussCurve, deflection: float) -> float:
    if curve is KNEE:
        return float(np.interp(deflection, [0.0, 0.4, 0.7], [0.0, 1.2e6, 3e6]))
    return float(np.interp(deflection, [0.0, 0.1, 0.25, 0.5], [0.0, 6e5, 2e5, 9e5]))


@CURVES
@given(deflection=st.floats(0.0, 2.0))
def test_loading_follows_the_envelope(curve: _core.TrussCurve, deflection: float) -> None:
    expected = envelope(curve, deflection)
    assert curve.envelope(deflection) == pytest.approx(expected, abs=ROUNDING)
    assert curve.follow([deflection])[0] == pytest.approx(expected, abs=ROUNDING)
    assert curve.follow(np.linspace(0.0, deflection, 7))[-1] == pytest.approx(expected, abs=ROUNDING)


@CURVES
@pytest.mark.parametrize("turn", [0.05, 0.2, 0.39, 0.41, 0.69, 0.9])
def test_unloading_and_reloading_along_one_line(curve: _core.TrussCurve, turn: float) -> None:
    peak = envelope(curve, turn)
    residual = turn - peak / curve.k_unloading
    assert residual < turn
    halfway = 0.5 * (turn + residual)
    path = [turn, halfway, residual, residual - 0.01, residual, halfway, turn, turn + 0.01]
    expected = [peak, 0.5 * peak, 0.0, 0.0, 0.0, 0.5 * peak, peak, envelope(curve, turn + 0.01)]
    assert curve.follow(path) == pytest.approx(expected, abs=ROUNDING)


def test_a_truss_never_pulls() -> None:
    assert (KNEE.follow([0.5, 0.1, 0.0, -1.0, 0.2]) == 0.0).tolist() == [False, True, True, True, True]
    assert KNEE.follow([-0.3])[0] == 0.0


@CURVES
def test_what_was_before_the_turn_leaves_no_trace_but_the_peak(curve: _core.TrussCurve) -> None:
    direct = curve.follow([0.45, 0.44, 0.6])
    wandering = curve.follow([0.1, 0.0, 0.3, 0.29, 0.45, 0.1, 0.44, 0.6])
    assert wandering[[4, 6, 7]] == pytest.approx(direct, abs=ROUNDING)


def test_limits_of_the_knee_curve() -> None:
    law = {"k_initial": 3e6, "knee": 0.4, "k_hardening": 6e6, "f_max": 3e6, "k_unloading": 60e6}
    straight = _core.knee_curve(**{**law, "knee": math.inf, "f_max": math.inf})
    assert straight.envelope(10.0) == pytest.approx(3e7, rel=1e-12)
    endless = _core.knee_curve(**{**law, "f_max": math.inf})
    assert endless.envelope(1.4) == pytest.approx(1.2e6 + 6e6, rel=1e-12)
    # A plateau below the knee: the knee is never reached.
    early = _core.knee_curve(**{**law, "f_max": 6e5})
    assert early.follow([0.1, 0.2, 0.4, 1.0]) == pytest.approx([3e5, 6e5, 6e5, 6e5], rel=1e-12)
    # No hardening: a plateau at the knee's force, whatever f_max is.
    flat = _core.knee_curve(**{**law, "k_hardening": 0.0})
    assert flat.envelope(5.0) == pytest.approx(1.2e6, rel=1e-12)


@CURVES
@settings(max_examples=200)
@given(turns=st.lists(st.floats(0.0, 1.0), min_size=1, max_size=8))
def test_no_energy_comes_out_of_any_path(curve: _core.TrussCurve, turns: list[float]) -> None:
    n = 400
    legs = [np.linspace(a, b, n, endpoint=False) for a, b in itertools.pairwise([0.0, *turns, 0.0])]
    path = np.concatenate([*legs, [0.0]])
    force = curve.follow(path)
    work = np.concatenate([[0.0], np.cumsum(0.5 * (force[1:] + force[:-1]) * np.diff(path))])
    crushed = work - 0.5 * force**2 / curve.k_unloading
    # The trapezoid rule misses a kink of slope change k within a step h by at most k h^2 / 8; a leg meets at
    # most six kinks (four hinges, the turn, the residual deflection).
    slack = 6 * len(legs) * 2.0 * curve.k_unloading * (1.0 / n) ** 2 / 8.0
    assert work[-1] >= -slack  # the closed loop
    assert np.diff(crushed).min() >= -slack  # and crushing is never undone on the way
    assert (force >= 0.0).all()
    assert force.max() <= curve.envelope(max(turns)) + ROUNDING or curve is POINTS


@pytest.mark.parametrize("turn", [0.3, 0.6, 1.0])
def test_energy_of_a_closed_loop(turn: float) -> None:
    # Loading to `turn` and back takes the area under the envelope less the triangle under the unloading line.
    path = np.concatenate([np.linspace(0.0, turn, 100_001), np.linspace(turn, 0.0, 100_001)])
    force = KNEE.follow(path)
    x = np.linspace(0.0, turn, 100_001)
    area = np.trapezoid(np.interp(x, [0.0, 0.4, 0.7], [0.0, 1.2e6, 3e6]), x)
    expected = area - 0.5 * envelope(KNEE, turn) ** 2 / 60e6
    assert np.trapezoid(force, path) == pytest.approx(expected, rel=1e-6)  # kinks between samples


@pytest.mark.parametrize(
    ("make", "naming"),
    [
        (
            lambda: _core.knee_curve(3e6, 0.4, 6e6, 3e6, 5e6),
            "k_unloading must be >= every slope.*6e\\+0?6.*got 5",
        ),
        (
            lambda: _core.knee_curve(3e6, 0.4, 1e6, 3e6, 2e6),
            "k_unloading must be >= every slope.*3e\\+0?6.*got 2",
        ),
        (
            lambda: _core.point_curve([0.0, 0.1, 0.2], [0.0, 1e5, 4e5], 2e6),
            "k_unloading must be >= every slope",
        ),
        (lambda: _core.point_curve([0.0, 0.1], [0.0, -1.0], 2e6), "force must be finite and >= 0"),
        (
            lambda: _core.point_curve([0.0, 0.1, 0.1], [0.0, 1.0, 2.0], 2e6),
            "deflection must be finite and > 0.1",
        ),
        (lambda: _core.point_curve([0.1, 0.2], [0.0, 1.0], 2e6), "envelope.0. must be"),
    ],
)
def test_what_is_not_a_law_is_refused(make, naming: str) -> None:
    with pytest.raises(ValueError, match=naming):
        make()


def test_unloading_may_be_as_steep_as_loading() -> None:
    elastic = _core.knee_curve(3e6, math.inf, 0.0, math.inf, 3e6)
    assert elastic.follow([0.5, 0.2, 0.0]) == pytest.approx([1.5e6, 6e5, 0.0], abs=1e-3)


@pytest.mark.parametrize("angle", [90.0, 60.0])
def test_trusses_of_a_run_follow_the_same_law(angle: float) -> None:
    block = scenes.laboratory_block(
        48, k_initial=3e6, knee=0.2, k_hardening=6e6, k_unloading=60e6, stagger=0.05
    )
    law = _core.knee_curve(3e6 / 48, 0.2, 6e6 / 48, math.inf, 60e6 / 48)
    choice = Settings(gravity=0.0, ground=False)
    simulation = Simulation(block, Barrier.rigid_wall(), 15.0, angle, settings=choice)
    deflection, force = [], []
    while simulation.step():
        deflection.append(simulation._core.deflection())
        force.append(simulation._core.truss_force())
    moved = np.array(deflection)
    assert moved.max() > 0.3  # beyond the knee
    for truss in range(48):
        expected = law.follow(moved[:, truss])
        # A node that was released keeps its residual deflection, where the line's rounding may leave a trace.
        assert np.array(force)[:, truss] == pytest.approx(expected, abs=1e-9 * np.array(force).max())
