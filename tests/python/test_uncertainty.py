"""Monte Carlo, Sobol indices and fragility against exact answers.

The block of W1 on an elastic front has crush = v sqrt(m / k), so that with independent lognormal v, m and k
the logarithm of the crush is normal, and every answer below is known.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import Any

import birm3d
import numpy as np
import pytest
from birm3d import Barrier, Settings, Simulation, scenes
from birm3d.base.intervals import wilson
from birm3d.study.distributions import sample, uniforms
from birm3d.study.fragility import _stopped
from birm3d.study.sobol import SobolDesign
from scipy.stats import binomtest, ks_1samp, lognorm, norm, uniform

SPEED, MASS, STIFFNESS = 22.352, 6804.0, 3e6
CRUSH = SPEED * math.sqrt(MASS / STIFFNESS)
SIGMA = 0.05
INPUTS = {
    "impact_speed": lognorm(SIGMA, scale=SPEED),
    "vehicle.gvw": lognorm(SIGMA, scale=MASS),
    "truss.k_initial": lognorm(SIGMA, scale=STIFFNESS),
}


@pytest.fixture(scope="module")
def block() -> Simulation:
    """Elastic until it turns; steep unloading leaves the stiffness free to vary."""
    vehicle = scenes.laboratory_block(24, k_initial=STIFFNESS, k_unloading=10 * STIFFNESS)
    # Rows every 1 ms: only crush is looked at, which does not depend on them.
    settings = Settings(gravity=0.0, ground=False, output_interval=1e-3)
    return Simulation(vehicle, Barrier.rigid_wall(friction=0.0), SPEED, settings=settings)


# ---- sampling ---------------------------------------------------------------------------------------------


def test_a_longer_sample_begins_with_the_shorter_one() -> None:
    short, long = sample(INPUTS, 50, seed=7), sample(INPUTS, 100, seed=7)
    assert long[:50].tobytes() == short.tobytes()
    assert len(np.unique(long)) == long.size
    assert not np.isin(sample(INPUTS, 50, seed=8), short).any()
    assert not np.isin(sample(INPUTS, 50, seed=7, stream="@1.0"), short).any()


def test_a_parameter_does_not_depend_on_its_neighbours() -> None:
    all_three = sample(INPUTS, 20, seed=7)
    for i, name in reversed(list(enumerate(INPUTS))):
        assert sample({name: INPUTS[name]}, 20, seed=7)[:, 0].tobytes() == all_three[:, i].tobytes()


def test_sampled_numbers_are_written_down() -> None:
    """A change of generator or key would change the answers of stored studies."""
    assert uniforms("impact_speed", 3, 0).tolist() == [
        0.1208807696475972,
        0.7489159985207939,
        0.7809258353675587,
    ]


def test_samples_follow_their_distributions() -> None:
    drawn = sample(INPUTS, 20_000, seed=1)
    for i, distribution in enumerate(INPUTS.values()):
        assert ks_1samp(drawn[:, i], distribution.cdf).pvalue > 0.01
    # Independent: correlations of logarithms within 3.5 standard errors of 0.
    correlation = np.corrcoef(np.log(drawn).T)[np.triu_indices(3, 1)]
    assert np.abs(correlation).max() < 3.5 / math.sqrt(20_000)
    shares = uniforms("x", 100_000, 1)
    assert 0.0 < shares.min() < shares.max() < 1.0


# ---- Monte Carlo ------------------------------------------------------------------------------------------


def test_mean_and_deviation_of_the_crush(block: Simulation) -> None:
    """ln(crush) has deviation SIGMA sqrt(1 + 1/4 + 1/4); within 3.5 standard errors of both moments."""
    n = 1000
    study = birm3d.monte_carlo(block, INPUTS, n, seed=3, metrics=["dynamic_crush"])
    s2 = 1.5 * SIGMA**2
    mean = CRUSH * math.exp(s2 / 2.0)
    deviation = mean * math.sqrt(math.exp(s2) - 1.0)
    crush = study.summary()["dynamic_crush"]
    assert crush.n == n
    assert crush.standard_error == pytest.approx(deviation / math.sqrt(n), rel=0.1)
    assert abs(crush.mean - mean) < 3.5 * deviation / math.sqrt(n)
    assert abs(crush.standard_deviation - deviation) < 3.5 * deviation / math.sqrt(2 * n)
    # And run by run, where no chance is left: within the tolerance of the settings.
    exact = study["impact_speed"] * np.sqrt(study["vehicle.gvw"] / study["truss.k_initial"])
    assert np.abs(study["dynamic_crush"] / exact - 1.0).max() < 1e-3


def test_more_runs_keep_the_earlier_ones(block: Simulation, tmp_path: Path) -> None:
    few = birm3d.monte_carlo(block, INPUTS, 20, seed=5, store=tmp_path / "runs.db")
    many = birm3d.monte_carlo(block, INPUTS, 40, seed=5, store=tmp_path / "runs.db")
    straight = birm3d.monte_carlo(block, INPUTS, 40, seed=5)
    assert many.state_hash == straight.state_hash
    assert many.state_hash[:20] == few.state_hash
    for name in few.metrics:
        assert many[name][:20].tobytes() == few[name].tobytes()
        assert many[name].tobytes() == straight[name].tobytes()


def test_draws_out_of_range_are_rows(block: Simulation) -> None:
    study = birm3d.monte_carlo(block, {"barrier.friction": norm(0.0, 0.1)}, 30, metrics=["dynamic_crush"])
    negative = np.flatnonzero(study["barrier.friction"] < 0.0)
    assert 5 < len(negative) < 25
    assert list(study.failed) == negative.tolist()
    assert "friction must be" in study.failed[int(negative[0])]
    assert study.summary()["dynamic_crush"].n == 30 - len(negative)


# ---- Sobol indices ----------------------------------------------------------------------------------------


def test_sobol_indices_of_the_crush(block: Simulation) -> None:
    """Shares 1 : 1/4 : 1/4 of the variance, exact for lognormal inputs below.

    For a product of independent lognormals with log-variances w_i, S_i = (exp(w_i) - 1) / (exp(sum w) - 1)
    and ST_i = exp(sum of the others) (exp(w_i) - 1) / (exp(sum w) - 1).
    """
    indices = birm3d.sobol(block, INPUTS, n=256, seed=1, metrics=["dynamic_crush", "vehicle_penetration"])
    assert len(indices.study) == 256 * 5
    w = SIGMA**2 * np.array([1.0, 0.25, 0.25])
    first = np.expm1(w) / np.expm1(w.sum())
    total = first * np.exp(w.sum() - w)
    found = indices.metrics["dynamic_crush"]
    # 95 % intervals of six numbers: twice their half widths leave room for chance, 0.2 % in all.
    assert (np.abs(found.first - first) < 2.0 * found.first_confidence).all()
    assert (np.abs(found.total - total) < 2.0 * found.total_confidence).all()
    assert found.first_confidence.max() < 0.2
    assert found.total_confidence.max() < 0.15
    table = indices.to_dataframe()
    assert table.loc[("dynamic_crush", "vehicle.gvw"), "total"] == found.total[1]


def test_a_constant_metric_has_no_indices_and_says_so(block: Simulation) -> None:
    indices = birm3d.sobol(block, INPUTS, n=4, metrics=["dynamic_crush", "vehicle_penetration"])
    assert list(indices.metrics) == ["dynamic_crush"]
    assert indices.omitted == {"vehicle_penetration": "constant, 0: no variance to share"}
    assert "no variance to share" in repr(indices)
    short = birm3d.scene_parameters.varied(block, {"duration": 0.05})
    missing = birm3d.sobol(short, INPUTS, n=4, metrics=["exit_angle", "delta_v"]).omitted
    assert missing == {"exit_angle": "missing from 20 of 20 runs"}


def test_sobol_is_the_same_twice_and_grows(block: Simulation, tmp_path: Path) -> None:
    options: dict[str, Any] = {"seed": 0, "metrics": ["dynamic_crush"]}
    once = birm3d.sobol(block, INPUTS, n=4, store=tmp_path / "runs.db", **options)
    again = birm3d.sobol(block, INPUTS, n=4, **options)
    assert np.array_equal(once.metrics["dynamic_crush"], again.metrics["dynamic_crush"])
    more = birm3d.sobol(block, INPUTS, n=8, store=tmp_path / "runs.db", **options)
    assert more.study["dynamic_crush"][:20].tobytes() == once.study["dynamic_crush"].tobytes()


def test_sobol_needs_every_run(block: Simulation) -> None:
    with pytest.raises(
        ValueError, match=r"distributions must give runs that all succeed.* of 12 failed.*friction"
    ):
        birm3d.sobol(block, {"barrier.friction": norm(0.0, 0.1)}, n=4)


def test_design_holds_sampler_and_analyser() -> None:
    """The Ishigami function, indices from Saltelli et al. (2000), without any crash."""
    angles = {name: uniform(-math.pi, 2.0 * math.pi) for name in "abc"}
    design = SobolDesign(angles, 1024, seed=2)
    a, b, c = design.sample().T
    found = design.analyze(np.sin(a) + 7.0 * np.sin(b) ** 2 + 0.1 * c**4 * np.sin(a))
    assert found.first == pytest.approx([0.3139, 0.4424, 0.0], abs=0.05)
    assert found.total == pytest.approx([0.5576, 0.4424, 0.2437], abs=0.05)


# ---- fragility --------------------------------------------------------------------------------------------


def test_probability_of_exceeding_a_crush(block: Simulation) -> None:
    """Mass alone uncertain: P(crush > c) = Phi((ln v - ln(c sqrt(k / m))) / (s / 2)), a lognormal curve."""
    s, limit = 0.3, 1.0
    speeds = [18.0, 20.0, 22.0, 24.0, 26.0]
    curve = birm3d.fragility(
        block, speeds, {"vehicle.gvw": lognorm(s, scale=MASS)}, 150, 2, exceeds={"dynamic_crush": limit}
    )
    median, dispersion = limit * math.sqrt(STIFFNESS / MASS), s / 2.0
    exact = norm.cdf(np.log(np.array(speeds) / median) / dispersion)
    assert curve.runs.tolist() == [150] * 5
    # Counts against the crush by hand, then both against the exact curve within 3.5 standard errors.
    crush = speeds[2] * np.sqrt(curve.study["vehicle.gvw"][2::5] / STIFFNESS)
    assert curve.events[2] == (crush > limit).sum()
    assert (np.abs(curve.probability - exact) < 3.5 * np.sqrt(exact * (1.0 - exact) / 150)).all()
    assert (curve.low < curve.probability).all()
    assert (curve.probability < curve.high).all()
    assert curve.fit is not None
    errors = curve.fit.standard_errors
    assert abs(curve.fit.median - median) < 3.5 * errors[0] < 1.0
    assert abs(curve.fit.dispersion - dispersion) < 3.5 * errors[1] < 0.1
    assert curve.fit.lack_of_fit is not None
    assert curve.fit.lack_of_fit > 0.01
    low, high = curve.fit.band(speeds, 0.999)
    assert ((low < exact) & (exact < high)).all()
    table = curve.to_dataframe()
    assert table.index.tolist() == speeds
    assert len(curve.plot().axes[0].get_lines()) >= 2
    assert "dynamic_crush > 1 m" in repr(curve)


def test_fit_has_the_errors_it_says() -> None:
    """200 draws of binomial counts: 95 % intervals of the median cover it 95 % of the time, give or take."""
    from birm3d.study.lognormal_fit import fit_lognormal

    speeds = np.array([8.0, 9.0, 10.0, 11.0, 12.0])
    p = norm.cdf(np.log(speeds / 10.0) / 0.15)
    source = np.random.default_rng(4)
    covered = 0
    for _ in range(200):
        fit, why = fit_lognormal(speeds, source.binomial(60, p), np.full(5, 60))
        assert fit is not None, why
        covered += abs(fit.median - 10.0) < 1.96 * fit.standard_errors[0]
    assert 180 <= covered <= 198


@pytest.mark.parametrize("noise", [0.0, 0.1])
def test_fit_has_the_errors_it_says_where_speeds_share_their_draws(noise: float) -> None:
    """300 studies of 40 draws: as if all runs were independent, the interval covers 80 % instead of 95."""
    from birm3d.study.lognormal_fit import Draws, fit_lognormal

    speeds = np.array([8.0, 9.0, 10.0, 11.0, 12.0])
    source = np.random.default_rng(4)
    covered = rejected = 0
    for _ in range(300):
        limit = 10.0 * np.exp(
            0.15 * source.standard_normal((40, 1)) + noise * source.standard_normal((40, 5))
        )
        happened = speeds > limit
        draws = Draws(happened, np.ones_like(happened))
        fit, why = fit_lognormal(speeds, happened.sum(axis=0), np.full(5, 40), draws)
        assert fit is not None, why
        covered += abs(fit.median - 10.0) < 1.96 * fit.standard_errors[0]
        rejected += fit.lack_of_fit < 0.05
    assert 270 <= covered <= 297
    assert 3 <= rejected <= 36  # 5 % of 300, and some more for so few draws


def test_a_lack_of_fit_is_seen_where_speeds_share_their_draws() -> None:
    """Two kinds of cases, whose limits are far apart, are no lognormal curve."""
    from birm3d.study.lognormal_fit import Draws, fit_lognormal

    speeds = np.array([6.0, 8.0, 10.0, 13.0, 16.0])
    limit = np.where(np.arange(200) % 2, 7.0, 15.0)[:, None] * np.exp(
        0.05 * np.random.default_rng(2).standard_normal((200, 1))
    )
    happened = speeds > limit
    fit, why = fit_lognormal(
        speeds, happened.sum(axis=0), np.full(5, 200), Draws(happened, np.ones_like(happened))
    )
    assert fit is not None, why
    assert fit.lack_of_fit < 1e-3


def test_a_flat_curve_has_no_median() -> None:
    from birm3d.study.lognormal_fit import fit_lognormal

    fit, why = fit_lognormal(np.array([8.0, 10.0, 12.0]), np.array([30, 31, 30]), np.full(3, 60))
    assert fit is None
    assert why == "the probability changes with speed by no more than chance would"


def test_wilson_interval_is_the_published_one() -> None:
    """Newcombe (1998), table I: 81 of 263 has 0.2553 to 0.3662; 0 of 20 has 0 to 0.1611."""
    assert wilson(81 / 263, 263) == pytest.approx((0.2553, 0.3662), abs=5e-5)
    assert wilson(0.0, 20) == pytest.approx((0.0, 0.1611), abs=5e-5)


@pytest.mark.parametrize("confidence", [0.5, 0.8, 0.95, 0.999])
@pytest.mark.parametrize(("events", "runs"), [(0, 1), (1, 1), (1, 3), (0, 20), (81, 263), (5000, 5000)])
def test_wilson_interval_is_that_of_scipy(events: int, runs: int, confidence: float) -> None:
    expected = binomtest(events, runs).proportion_ci(confidence, method="wilson")
    low, high = wilson(events / runs, runs, confidence)
    assert (low, high) == pytest.approx((expected.low, expected.high), rel=1e-12, abs=1e-15)
    assert 0.0 <= low <= events / runs <= high <= 1.0


def test_wilson_interval_refuses() -> None:
    with pytest.raises(ValueError, match=r"share must be >= 0 and <= 1, got 1\.5"):
        wilson(1.5, 8)
    with pytest.raises(ValueError, match="n must be >= 1, got 0"):
        wilson(0.5, 0)
    with pytest.raises(ValueError, match=r"confidence must be between 0 and 1, got 95"):
        wilson(0.5, 8, 95.0)


def test_more_runs_for_each_speed_keep_the_earlier_ones(block: Simulation, tmp_path: Path) -> None:
    few, many = (
        birm3d.fragility(
            block,
            [10.0, 20.0],
            {"vehicle.gvw": norm(MASS, 100.0)},
            n,
            exceeds={"delta_v": 1.0},
            store=tmp_path / "r",
        )
        for n in (3, 6)
    )
    assert many.study["vehicle.gvw"][:6].tobytes() == few.study["vehicle.gvw"].tobytes()
    draws = many.study["vehicle.gvw"].reshape(6, 2)
    assert len(np.unique(draws)) == 6
    assert (draws[:, 0] == draws[:, 1]).all()  # every speed has the same ones


@pytest.mark.parametrize(
    ("speeds", "limit", "why"),
    [
        ([10.0, 12.0], 5.0, "no run"),
        ([10.0, 12.0], 0.1, "every run"),
        ([10.0, 40.0], 1.0, "do not overlap"),
    ],
)
def test_no_fit_where_the_runs_tell_none(
    block: Simulation, speeds: list[float], limit: float, why: str
) -> None:
    mass = {"vehicle.gvw": lognorm(0.02, scale=MASS)}
    curve = birm3d.fragility(block, speeds, mass, 10, exceeds={"dynamic_crush": limit})
    assert curve.plot().axes[0].get_ylabel() == f"probability: dynamic crush > {limit:g} m"
    assert curve.fit is None
    assert why in curve.no_fit
    assert why in repr(curve)
    assert len(curve.plot().axes[0].get_lines()) >= 1


def test_a_rigid_wall_stops_and_a_short_run_does_not_tell(block: Simulation) -> None:
    mass = {"vehicle.gvw": lognorm(0.02, scale=MASS)}
    curve = birm3d.fragility(block, [10.0, 20.0], mass, 8)
    assert curve.event == "stopped"
    assert curve.probability.tolist() == [1.0, 1.0]
    assert curve.low[0] == pytest.approx(8.0 / (8.0 + norm.ppf(0.975) ** 2))  # Wilson's, at 8 of 8
    # Zero velocity is at pi/2 sqrt(m/k) = 75 ms: a run of 60 ms ends before it, one of 90 ms undecided.
    for duration in (0.06, 0.09):
        short = birm3d.scene_parameters.varied(block, {"duration": duration})
        assert birm3d.fragility(short, [10.0, 20.0], mass, 8).probability.tolist() == [0.0, 0.0]


@pytest.mark.parametrize(
    ("outcome", "end_reason", "turned", "counted"),
    [
        ("stopped", "separated", 0.1, True),
        ("redirected", "duration", 0.1, True),  # decided before the given duration was over
        ("rolled_over", "separated", 0.1, True),
        ("rolled_over", "duration", math.nan, False),
        ("passed", "stopped", 0.1, False),  # it came to rest behind the barrier
        ("overridden", "stopped", 0.1, False),
        ("undecided", "duration", 0.1, False),
        ("", "", math.nan, False),  # failed
    ],
)
def test_what_counts_as_stopped(outcome: str, end_reason: str, turned: float, counted: bool) -> None:
    study = birm3d.Study(
        vehicle="car", run=[0], parameters={"impact_speed": [10.0]},
        metrics={"time_of_zero_velocity": [turned]},
        outcome=[outcome], end_reason=[end_reason], state_hash=[""], error=[""], units={},
    )  # fmt: skip
    assert _stopped(study).tolist() == [counted]


# ---- bad input --------------------------------------------------------------------------------------------

GOOD = {"impact_speed": norm(20.0, 1.0)}


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda s: birm3d.monte_carlo(s, {}, 10), "distributions must name at least one"),
        (lambda s: birm3d.monte_carlo(s, {"impact_sped": norm(1.0)}, 10), "got 'impact_sped'"),
        (lambda s: birm3d.monte_carlo(s, {"impact_speed": 3.0}, 10), r"\['impact_speed'\].*got 3.0"),
        (lambda s: birm3d.monte_carlo(s, {"impact_speed": norm}, 10), "frozen distribution"),
        (lambda s: birm3d.monte_carlo(s, {"impact_speed": norm(20.0, -1.0)}, 10), "finite quartiles.*nan"),
        (lambda s: birm3d.monte_carlo(s, GOOD, 0), "n must be an integer >= 1, got 0"),
        (lambda s: birm3d.monte_carlo(s, GOOD, 2.5), "n must be a whole number, got 2.5"),
        (lambda s: birm3d.monte_carlo(s, GOOD, 2, seed=-1), "seed must be an integer >= 0, got -1"),
        (lambda s: birm3d.monte_carlo(s, GOOD, 10**12), "n must make at most 5,000,000 runs, got 1,000,000,"),
        (lambda s: birm3d.sobol(s, GOOD, 2**40), "n must make at most 5,000,000 runs, got 3,298,534,883,328"),
        (
            lambda s: birm3d.fragility(s, [5.0, 6.0], {"vehicle.gvw": norm(MASS)}, 10**12),
            "n must make at most 5,000,000 runs, got 2,000,000,000,000",
        ),
        (
            lambda s: birm3d.critical_impact_point(s, "delta_v", {"impact_offset": (0, 1)}, points=10**12),
            "points must make at most 5,000,000 runs",
        ),
        (lambda s: birm3d.sobol(s, GOOD, 10), "n must be a power of 2.*got 10"),
        (lambda s: birm3d.sobol(s, GOOD, 4, confidence=95.0), "confidence must be between 0 and 1, got 95.0"),
        (lambda s: birm3d.fragility(s, [], {}, 3), "speeds must have at least two"),
        (lambda s: birm3d.fragility(s, ["fast", 2.0], {}, 3), "^speeds must be a number in m/s"),
        (lambda s: birm3d.fragility(s, [5.0, 4.0], GOOD, 3), r"increasing, got \[5.0, 4.0\]"),
        (lambda s: birm3d.fragility(s, [5.0, math.nan], GOOD, 3), "finite and increasing.*nan"),
        (lambda s: birm3d.fragility(s, [5.0, 6.0], GOOD, 3), "leave impact_speed to speeds"),
        (
            lambda s: birm3d.fragility(s, [5.0, 6.0], {"vehicle.gvw": norm(MASS)}, 3, exceeds={"crush": 1.0}),
            "metrics must be among.*'crush'",
        ),
        (
            lambda s: birm3d.fragility(
                s, [5.0, 6.0], {"vehicle.gvw": norm(MASS)}, 3, exceeds={"delta_v": math.inf}
            ),
            r"exceeds\['delta_v'\] must be finite, got inf",
        ),
        (
            lambda s: birm3d.fragility(s, [5.0, 6.0], {"barrier.friction": norm(-5.0)}, 3),
            "all 3 at 5 m/s failed: ValueError: friction",
        ),
    ],
)  # fmt: skip
def test_bad_input_names_argument_and_value(block: Simulation, call: Any, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        call(block)


def test_missing_extra_is_named(monkeypatch: pytest.MonkeyPatch, block: Simulation) -> None:
    monkeypatch.setitem(sys.modules, "SALib.sample.sobol", None)
    with pytest.raises(ImportError, match=r"pip install 'birm3d\[studies\]'"):
        birm3d.sobol(block, GOOD, 4)
