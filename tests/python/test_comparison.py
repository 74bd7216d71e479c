"""Sprague-Geers, residuals, ISO/TS 18571, and what compare_curves does before it measures."""

from __future__ import annotations

import itertools
import math

import birm3d
import numpy as np
import pytest
from birm3d import Channel, compare_curves
from birm3d.reference import nhtsa_10146
from birm3d.signals.curve_metrics import residuals, sprague_geers
from birm3d.signals.iso18571 import ObjectiveRating, objective_rating, warping_path
from hypothesis import given
from hypothesis import strategies as st

TIME = np.linspace(0.0, 0.2, 2001)
OMEGA = 2.0 * math.pi / 0.05  # four whole periods
SINE = np.sin(OMEGA * TIME)


def channel(values: np.ndarray, *, time: np.ndarray = TIME, unit: str = "N", **more: object) -> Channel:
    return Channel("curve", time, values, unit, **more)  # type: ignore[arg-type]


def test_equal_curves_have_no_error() -> None:
    assert sprague_geers(TIME, SINE, SINE) == (0.0, 0.0, 0.0)
    assert residuals(SINE, SINE) == (0.0, 0.0)
    rating = objective_rating(SINE, SINE)
    assert rating == ObjectiveRating(1.0, 1.0, 1.0, 1.0, 0.0)
    assert rating.overall == pytest.approx(1.0, rel=1e-15)
    assert rating.grade == "excellent"


@pytest.mark.parametrize("factor", [0.5, 0.9, 1.2, 3.0])
def test_a_factor_is_magnitude_only(factor: float) -> None:
    m, p, c = sprague_geers(TIME, SINE, factor * SINE)
    assert m == pytest.approx(factor - 1.0, rel=1e-12)
    assert p == pytest.approx(0.0, abs=1e-12)
    assert c == pytest.approx(abs(factor - 1.0), rel=1e-12)


@pytest.mark.parametrize("lag", [1e-9, 1e-4, 0.3, 1.0, math.pi / 2.0, 3.0])
def test_a_lag_is_phase_only(lag: float) -> None:
    m, p, c = sprague_geers(TIME, SINE, np.sin(OMEGA * TIME - lag))
    assert m == pytest.approx(0.0, abs=1e-12)
    assert p == pytest.approx(lag / math.pi, rel=1e-6)
    assert c == pytest.approx(p, rel=1e-9)


def test_the_other_sign_is_all_phase() -> None:
    assert sprague_geers(TIME, SINE, -SINE).phase == pytest.approx(1.0, rel=1e-12)


def test_magnitude_is_that_of_the_energies() -> None:
    # Constant against ramp over [0, 1]: the integrals of 1, t^2 and t are 1, 1/3 and 1/2.
    t = np.linspace(0.0, 1.0, 20_001)
    m, p, _ = sprague_geers(t, np.ones_like(t), t)
    assert m == pytest.approx(math.sqrt(1.0 / 3.0) - 1.0, abs=1e-8)
    assert p == pytest.approx(math.acos(0.5 * math.sqrt(3.0)) / math.pi, abs=1e-8)


def test_uneven_sampling_has_the_same_integrals() -> None:
    uneven = 0.2 * np.linspace(0.0, 1.0, 4001) ** 1.5
    curves = [np.sin(OMEGA * t) * np.exp(-t / 0.1) for t in (TIME, uneven)]
    lagging = [1.1 * np.sin(OMEGA * t - 0.2) * np.exp(-t / 0.1) for t in (TIME, uneven)]
    assert sprague_geers(uneven, curves[1], lagging[1]) == pytest.approx(
        sprague_geers(TIME, curves[0], lagging[0]), rel=1e-3
    )


@given(
    scale=st.floats(1e-160, 1e160),
    stretch=st.floats(1e-6, 1e6),
    factor=st.floats(0.1, 10.0),
    lag=st.floats(0, 1),
)
def test_units_do_not_matter(scale: float, stretch: float, factor: float, lag: float) -> None:
    other = factor * np.sin(OMEGA * TIME - lag) + 0.1
    expected = sprague_geers(TIME, SINE, other)
    assert sprague_geers(stretch * TIME, scale * SINE, scale * other) == pytest.approx(
        expected, rel=1e-9, abs=1e-12
    )
    assert residuals(scale * SINE, scale * other) == pytest.approx(
        residuals(SINE, other), rel=1e-9, abs=1e-12
    )


def test_residuals_of_an_offset_and_of_a_saw() -> None:
    offset = residuals(10.0 * SINE, 10.0 * SINE - 0.4)
    assert offset == pytest.approx((0.04, 0.0), abs=1e-12)
    # Plus and minus 2 in turn about a peak of 8: deviation 2/8 with n - 1.
    measured = np.array([8.0, 0.0, 0.0, 0.0])
    saw = residuals(measured, measured - np.array([2.0, -2.0, 2.0, -2.0]))
    assert saw == pytest.approx((0.0, 0.25 * math.sqrt(4.0 / 3.0)), rel=1e-12)
    assert residuals(-measured, -measured + 1.0).mean == pytest.approx(-0.125, rel=1e-12)


# Scores that objective-rating-metrics 1.3 of TU Graz gives for these curves at 10 kHz: corridor, phase,
# magnitude, slope, overall.
U = np.linspace(0.0, 1.0, 501)


def bump(centre: float, width: float, size: float = 1.0) -> np.ndarray:
    return np.asarray(size * np.exp(-(((U - centre) / width) ** 2)))


PUBLISHED = {
    "early": (
        bump(0.5, 0.1), bump(0.42, 0.12, 0.8),
        (0.695991641452, 0.600798403194, 0.891035222748, 0.836369328148, 0.744037247398),
    ),
    "two pulses": (
        bump(0.3, 0.1) + bump(0.6, 0.08, 0.6), bump(0.33, 0.12, 0.9) + bump(0.57, 0.07, 0.7),
        (0.749716131753, 0.98003992016, 0.841600551475, 0.7421145408, 0.812637455188),
    ),
    "other sign": (
        bump(0.5, 0.1), -bump(0.5, 0.1), (0.68928325716, 0.001996007984, 0.0, 0.34960357851, 0.346033220163),
    ),
    "ripple": (
        bump(0.4, 0.1), bump(0.42, 0.1) + 0.05 * np.sin(300.0 * U),
        (0.910415915134, 0.900199600798, 0.797317447846, 0.618425663002, 0.827354908383),
    ),
    "box": (
        np.where((U > 0.2) & (U < 0.7), 1.0, 0.0), np.where((U > 0.25) & (U < 0.75), 0.9, 0.0),
        (0.806362583475, 0.750499001996, 0.8, 0.95, 0.822644833789),
    ),
    "ten rows": (
        np.arange(10.0) ** 2, np.arange(10.0) ** 1.9,
        (0.872688895654, 1.0, 0.652239953476, 0.89786950089, 0.859097449135),
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", PUBLISHED)
def test_scores_are_those_of_the_published_implementation(case: str) -> None:
    measured, computed, expected = PUBLISHED[case]
    rating = objective_rating(measured, computed)
    assert (*rating[:4], rating.overall) == pytest.approx(expected, abs=1e-11)


def test_corridor_by_hand() -> None:
    # A constant distance d from a curve with peak 1: ((0.5 - d) / 0.45)^2 between the corridors.
    base = bump(0.5, 0.1)
    base = base / base.max()
    for distance, score in ((0.04, 1.0), (0.275, 0.25), (0.5, 0.0), (2.0, 0.0)):
        assert objective_rating(base, base + distance).corridor == pytest.approx(score, abs=1e-9)


@pytest.mark.parametrize("rows", [-60, -1, 0, 1, 25, 60])
def test_phase_by_hand(rows: int) -> None:
    rating = objective_rating(bump(0.5, 0.05), bump(0.5 + rows / 500.0, 0.05))
    assert rating.shift == pytest.approx(rows * 1e-4, abs=1e-12)
    assert rating.phase == pytest.approx(1.0 - abs(rows) / (0.2 * 501), rel=1e-12)
    # What is left after the shift is equal.
    assert (rating.magnitude, rating.slope) == pytest.approx((1.0, 1.0), abs=1e-4)


def test_slope_by_hand() -> None:
    # Ramps of slope 1 and 1.5: half of the slope is missed, of which 2 is the worst.
    assert objective_rating(U, 1.5 * U).slope == pytest.approx(1.0 - 0.5 / 2.0, rel=1e-9)


@given(st.lists(st.tuples(st.floats(-1, 1), st.floats(-1, 1)), min_size=1, max_size=5), st.integers(1, 5))
def test_warping_is_the_best_of_all_paths(rows: list[tuple[float, float]], band: int) -> None:
    x, y = (np.array(column) for column in zip(*rows, strict=True))
    i, j = warping_path(x, y, band)
    assert (i[0], j[0], i[-1], j[-1]) == (0, 0, len(x) - 1, len(x) - 1)
    assert set(zip(np.diff(i), np.diff(j), strict=True)) <= {(1, 0), (0, 1), (1, 1)}
    assert (abs(i - j) < band).all()
    found = float(((x[i] - y[j]) ** 2).sum())
    assert found == pytest.approx(min(costs_of_all_paths(x, y, band)), rel=1e-12, abs=1e-15)


def costs_of_all_paths(x: np.ndarray, y: np.ndarray, band: int) -> list[float]:
    """By trying all of them, however foolish."""

    def go(i: int, j: int) -> list[float]:
        if abs(i - j) >= band or max(i, j) >= len(x):
            return []
        here = float((x[i] - y[j]) ** 2)
        if i == j == len(x) - 1:
            return [here]
        return [here + rest for di, dj in ((1, 0), (0, 1), (1, 1)) for rest in go(i + di, j + dj)]

    return go(0, 0)


def test_compare_curves_brings_both_to_one_footing() -> None:
    # 10 kHz in kN against 4 kHz in N, both a lone 5 Hz wave that CFC 60 passes.
    coarse = np.linspace(-0.05, 0.15, 801)
    measured = channel(2.0 * np.sin(10.0 * math.pi * TIME), unit="kN")
    computed = channel(2000.0 * np.sin(10.0 * math.pi * coarse), time=coarse)
    comparison = compare_curves(measured, computed, cfc=60)
    assert comparison.measured.unit == comparison.computed.unit == "N"
    assert comparison.measured.cfc == comparison.computed.cfc == 60.0
    assert comparison.interval == pytest.approx(1e-4, rel=1e-9)
    assert comparison.measured.time[[0, -1]] == pytest.approx([0.0, 0.15], abs=1e-12)
    assert comparison.notes == (
        "measured: converted from kN",
        "measured: filtered to CFC 60, from no class",
        "computed: filtered to CFC 60, from no class",
        "measured: interpolated, from 0.0001 s apart",
        "computed: interpolated, from 0.00025 s apart",
    )
    assert comparison.passed
    assert abs(comparison.sprague_geers.magnitude) < 0.01
    assert comparison.rating.grade == "excellent"


def test_a_finer_grid_changes_nothing() -> None:
    pulse = np.sin(math.pi * TIME / 0.2)
    other = 1.1 * np.sin(math.pi * TIME / 0.2) ** 1.2
    results = [compare_curves(channel(pulse), channel(other), interval=step) for step in (1e-3, 1e-4, 2e-5)]
    for a, b in itertools.pairwise(results):
        assert a.sprague_geers == pytest.approx(b.sprague_geers, rel=2e-3)
        assert a.rating.overall == pytest.approx(b.rating.overall, abs=2e-3)


def test_a_span_may_miss_the_records_by_a_rounding() -> None:
    comparison = compare_curves(channel(SINE), channel(SINE), start=-1e-12, end=0.2 + 1e-12)
    assert comparison.measured.time[[0, -1]].tolist() == [0.0, 0.2]
    assert comparison.notes == ()


def test_verdicts_follow_the_limits() -> None:
    by_name = {c.name: c for c in compare_curves(channel(SINE), channel(1.41 * SINE)).criteria}
    assert not by_name["Sprague-Geers magnitude"].passed
    assert by_name["Sprague-Geers phase"].passed
    limits = {name: criterion.limit for name, criterion in by_name.items()}
    assert limits == {
        "Sprague-Geers magnitude": 0.40,
        "Sprague-Geers phase": 0.40,
        "mean residual": 0.05,
        "deviation of residuals": 0.35,
        "overall rating": 0.58,
    }
    low = {c.name: c for c in compare_curves(channel(SINE), channel(SINE + 0.051)).criteria}
    assert not low["mean residual"].passed
    assert low["mean residual"].value == pytest.approx(-0.051, rel=1e-9)


def test_summary_says_every_number_and_verdict() -> None:
    comparison = compare_curves(channel(SINE, cfc=60.0), channel(1.5 * SINE, cfc=60.0))
    text = comparison.summary()
    assert "0 to 0.2 s, every 0.0001 s, CFC 60" in text
    lines = text.splitlines()
    magnitude = next(line for line in lines if line.startswith("Sprague-Geers magnitude"))
    assert "50.0%" in magnitude
    assert "NOT met (NCHRP W179)" in magnitude
    for criterion in comparison.criteria:
        assert any(
            line.startswith(criterion.name) and f"{100 * criterion.value:.1f}%" in line for line in lines
        )
    assert f"overall {comparison.rating.overall:.3f}" in text
    assert not comparison.passed
    assert "not met" in repr(comparison)


def test_plot_shows_curves_residuals_and_band() -> None:
    comparison = compare_curves(channel(SINE), channel(0.9 * SINE))
    above, below = comparison.plot().axes
    # Forces are in N, figures show kN.
    assert above.get_lines()[0].get_ydata() == pytest.approx(comparison.measured.values / 1e3)
    assert above.get_lines()[1].get_ydata() == pytest.approx(comparison.computed.values / 1e3)
    assert above.get_ylabel().endswith("[kN]")
    assert below.get_lines()[0].get_ydata() == pytest.approx(10.0 * SINE, abs=1e-9)
    mean, deviation = comparison.residuals
    low, high = below.patches[0].get_extents().transformed(below.transData.inverted()).intervaly
    assert (low, high) == pytest.approx((100 * (mean - deviation), 100 * (mean + deviation)), abs=1e-6)


def test_the_sedan_against_its_test() -> None:
    data = nhtsa_10146()
    result = birm3d.scenes.nhtsa_10146().run()
    touch = result.scene.standoff / result.scene.impact_speed
    wall = Channel("wall force", data["time"], data["wall_force"], "N", cfc=60.0)
    force = Channel("normal force", result.time, result.barrier_normal_force, "N").shifted(touch)
    comparison = compare_curves(wall, force, cfc=60)
    assert comparison.passed
    assert abs(comparison.sprague_geers.magnitude) < 0.05
    assert comparison.sprague_geers.phase < 0.10
    assert comparison.rating.grade == "good"


@pytest.mark.parametrize(
    ("other", "options", "naming"),
    [
        (channel(SINE, unit="m"), {}, r"computed must measure force as 'curve' does, got length \[m\]"),
        (
            channel(SINE, cfc=60.0),
            {},
            "cfc must be given where the classes differ, got no class .* and CFC 60",
        ),
        (channel(SINE, cfc=60.0), {"cfc": 180}, "cfc must be at most 60, the class of 'curve', got 180"),
        (channel(SINE, time=TIME + 1.0), {}, "must overlap in time, got 0 to 0.2 s and 1 to 1.2 s"),
        (channel(SINE), {"end": 0.3}, "start and end must lie in both records, 0 to 0.2 s, got 0 to 0.3 s"),
        (channel(SINE), {"start": 0.1, "end": 0.1}, "start and end must .* got 0.1 to 0.1 s"),
        (channel(SINE), {"start": math.nan}, "start and end must .* got nan to 0.2 s"),
        (channel(SINE), {"interval": 0.0}, "interval must be > 0 and leave 10 rows .* got 0 s"),
        (channel(SINE), {"interval": 0.05}, "interval must be > 0 and leave 10 rows .* got 0.05 s"),
        (channel(0.0 * SINE), {}, "computed must not be zero throughout, got 0 from 0 to 0.2 s"),
    ],
)
def test_what_can_not_be_compared_is_refused(other: Channel, options: dict[str, float], naming: str) -> None:
    with pytest.raises(ValueError, match=naming):
        compare_curves(channel(SINE), other, **options)


@pytest.mark.parametrize(
    ("function", "arguments", "naming"),
    [
        (sprague_geers, (TIME, SINE, SINE[:-1]), r"computed must have the shape \(2001,\)"),
        (sprague_geers, (TIME[::-1], SINE, SINE), "time must be strictly increasing"),
        (sprague_geers, (TIME, 0.0 * SINE, SINE), "measured must not be zero throughout"),
        (sprague_geers, (TIME, SINE, SINE * math.nan), "computed must be finite, got nan"),
        (residuals, ([1.0], [1.0]), r"measured must have the shape \(n,\) with n > 1"),
        (residuals, ([0.0, 0.0], [1.0, 1.0]), "measured must not be zero throughout"),
        (
            objective_rating,
            (SINE[:9], SINE[:9]),
            r"measured must have the shape \(n,\) with n > 9, got \(9,\)",
        ),
        (objective_rating, (SINE, SINE[1:]), "computed must have the shape"),
        (objective_rating, (SINE, np.ones_like(SINE)), "computed must change over the record, got 1"),
        (objective_rating, (SINE, np.full_like(SINE, math.inf)), "computed must be finite, got inf"),
    ],
)
def test_numbers_of_nonsense_are_refused(function: object, arguments: tuple, naming: str) -> None:
    with pytest.raises(ValueError, match=naming):
        function(*arguments)  # type: ignore[operator]
