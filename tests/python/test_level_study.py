"""Probability of a whole level, bands of its criteria, and the joint tolerance of speed and angle."""

from __future__ import annotations

import itertools
import json
import re
from functools import cache

import birm3d
import numpy as np
import pytest
from birm3d import Barrier, Prediction, Simulation, Vehicle, units
from birm3d.assessment import LevelStudy, Rating, RatingStudy
from birm3d.assessment.criteria import Criterion
from birm3d.assessment.roadside import EN_1317
from birm3d.base.intervals import wilson

LEVEL = "EN 1317 H1"


@cache
def predictions() -> tuple[Prediction, ...]:
    """A barrier at which some of the 900-kg cars meet EN 1317 and some do not."""
    barrier = Barrier.jersey(height=0.9)
    sedan = {"900-kg car": Vehicle.preset("passenger_car", mesh_density=0.3).scaled_to(900.0)}
    level = birm3d.test_matrix(LEVEL, barrier=barrier, vehicles=sedan, mesh_density=0.3)
    return tuple(birm3d.predict(test, 8) for test in level)


def test_probabilities_are_those_of_all_pairs_of_vehicles() -> None:
    level = birm3d.rate(list(predictions()), LEVEL)
    assert isinstance(level, LevelStudy)
    small, large = (
        [birm3d.rate(one.study.simulation(row).run(), LEVEL) for row in range(8)] for one in predictions()
    )
    both = [a.passed and b.passed for a, b in itertools.product(small, large)]
    passes = sum(share for name, share in level.probability.items() if name.startswith(f"{LEVEL}: pass"))
    assert passes == pytest.approx(np.mean(both))
    assert sum(level.probability.values()) == pytest.approx(1.0)
    assert level.contained == pytest.approx(1.0)
    assert list(level.tests) == ["TB11", "TB42"]
    assert level.tests["TB11"].test == "TB11"
    assert 0.0 < np.mean([one.passed for one in small]) < 1.0  # else the pairs tell nothing


def test_a_run_without_a_rating_counts_in_the_level() -> None:
    """A pass of the level takes a pass of both tests, and one that fails decides it."""

    def part(test: str, passed: bool) -> Rating:
        rows = (Criterion("upright", "", "", "", passed),)
        word = "pass" if passed else "fail"
        return Rating("EN 1317", word, 0.5, True, rows, ("c",), "car", test)

    open_run = "result must have run until the outcome is decided (duration=None), got one that ends at 5 s"
    small = RatingStudy({0: part("TB11", True), 1: part("TB11", False)}, {})
    large = RatingStudy({0: part("TB42", True)}, {1: open_run, 2: open_run, 3: open_run})
    level = LevelStudy(EN_1317, "H1", [small, large])
    expected = {f"{LEVEL}: fail": 0.5, f"{LEVEL}: no rating": 0.375, f"{LEVEL}: pass": 0.125}
    assert level.probability == pytest.approx(expected)
    assert level.contained == pytest.approx(0.25)
    assert level.interval(0.5) == wilson(0.5, 2)
    assert re.search(r"test TB42: pass +25\.0%", str(level))


def test_what_it_tells() -> None:
    level = birm3d.rate(list(predictions()), LEVEL)
    text = str(level)
    assert "EN 1317 H1, indicative: probability of each class, 95 % interval by 8 runs of each test" in text
    assert "test TB11: pass" in text
    assert "Caution: EN 1317 asks for full-scale crash tests" in text
    assert json.loads(json.dumps(level.to_dict()))["probability"] == dict(level.probability)
    assert level._repr_html_().count("<table>") == 5  # of the level, and two of each test
    assert level.interval(0.5) == wilson(0.5, 8)


def test_each_criterion_has_its_band() -> None:
    study = birm3d.rate(predictions()[0], LEVEL)
    assert isinstance(study, RatingStudy)
    rows = {row[0]: row[1:] for row in study.rows}
    values = np.sort([row.value for one in study.ratings for row in one.criteria if row.name == "THIV"])
    # Hazen: the k-th of n values stands at (k - 1/2) / n.
    low, middle, high = np.interp([0.1, 0.5, 0.9], (np.arange(8) + 0.5) / 8, values)
    assert rows["THIV"][:2] == (f"{middle:.2f} km/h", f"{low:.2f} to {high:.2f} km/h")
    assert rows["THIV"][3] == f"{np.mean(values <= 33.0):.0%}"
    assert rows["mass"][1] == "the same in all"
    assert rows["containment"][:2] == ("redirected", "the same in all")
    assert all(name in str(study) for name in rows)


def test_mixed_or_missing_tests_are_refused() -> None:
    small, large = predictions()
    run = large.study.simulation(0).run()
    with pytest.raises(ValueError, match=r"a list of birm3d\.Result or a list of"):
        birm3d.rate([small, run], LEVEL)
    with pytest.raises(ValueError, match="one study for each test of EN 1317 H1, got TB11, TB11"):
        birm3d.rate([small, small], LEVEL)
    with pytest.raises(ValueError, match="must hold all tests of EN 1317 H1"):
        birm3d.rate([small], LEVEL)


# Difference of speed [share] and of angle [deg] -> whether both together are accepted.
@pytest.mark.parametrize(
    ("faster", "steeper", "unmet"),
    [
        (0.0, 0.0, ""),
        (0.0, 1.5, ""),
        (0.05, 1.5, ""),
        (0.07, 1.0, ""),
        (0.07, -1.0, ""),
        (0.02, -1.0, ""),
        (0.0, -0.5, ""),
        (0.07, 1.5, "speed and angle together"),
        (0.06, 1.3, "speed and angle together"),
        (0.06, 1.2, ""),
        (0.0, -1.0, "speed and angle together"),
        (0.01, -0.8, "speed and angle together"),
        (0.01, -0.7, ""),
        (0.08, 1.5, "impact speed"),  # that alone is said
    ],
)
def test_speed_and_angle_together(faster: float, steeper: float, unmet: str) -> None:
    car = Vehicle.preset("passenger_car", mesh_density=0.1).scaled_to(900.0)
    speed = units.km_h(100.0 * (1.0 + faster))
    run = Simulation(car, Barrier.rigid_wall(), speed, 20.0 + steeper, duration=1.0).run()
    rating = birm3d.rate(run, "EN 1317 TB11")
    (row,) = [one for one in rating.criteria if one.name == "speed and angle together"]
    if unmet:
        assert rating.designation == f"EN 1317 TB11: no rating: {unmet}"
        assert row.passed is (None if unmet == "impact speed" else False)
    else:
        assert "no rating" not in rating.designation
        assert row.passed is True


def test_level_from_the_command_line(command, capsys) -> None:
    barrier = ["--barrier", "jersey", "--height", "0.9", "--mesh-density", "0.3"]
    arguments = ["rate", "--level", "--standard", LEVEL, *barrier]
    assert command(*arguments, "--draws", "8", "--json") == 0
    (found,) = json.loads(capsys.readouterr().out)["ratings"]
    level = birm3d.test_matrix(LEVEL, barrier=Barrier.jersey(height=0.9), mesh_density=0.3)
    of = birm3d.rate([birm3d.predict(test, 8) for test in level], LEVEL)
    assert found["probability"] == dict(of.probability)
    assert command(*arguments) == 0
    assert "test TB42" in capsys.readouterr().out
    assert command(*arguments, "--speed", "100km/h") == 2
    assert "--level has the standard's vehicles and speeds" in capsys.readouterr().err


def test_a_prediction_calls_the_intrusion_as_the_table_of_a_run_does() -> None:
    (first, *_) = birm3d.test_matrix("EN 1317 N1", barrier=Barrier.jersey(), mesh_density=0.1)
    found = birm3d.rate(birm3d.predict(first, 8, progress=False), "EN 1317 N1").summary()
    assert "vehicle intrusion, median" in found
    assert "penetration, median" not in found
