"""First answers of a dossier where the barrier gives way, or the vehicle comes to rest behind it."""

from __future__ import annotations

import itertools
import math
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import birm3d
import numpy as np
import pytest
import shapely
from birm3d import Barrier, Result, Simulation, Vehicle, units
from birm3d.reporting.barrier_answers import kept_words
from birm3d.reporting.class_bands import ClassBands
from birm3d.reporting.given_tests import nearest
from birm3d.reporting.study_verdict import study_table
from birm3d.reporting.verdict_cautions import has_doubts, rating_cautions
from birm3d.result.segment_motion import base_corners
from scipy import stats
from test_dossier import Page

pytestmark = pytest.mark.filterwarnings(
    "ignore::birm3d.LeaningPostWarning",
    "ignore::birm3d.LowBarrierWarning",
    "ignore::birm3d.CoreContactWarning",
    "ignore::birm3d.TippingWarning",
)
TRUCK = Vehicle.preset("cargo_truck", mesh_density=0.3)
RELY = "Do not rely on the outcome."


@pytest.fixture(autouse=True)
def _few_files(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("birm3d.reporting.build.find_spec", lambda name: None)
    monkeypatch.setattr("birm3d.reporting.study_case.nearest", lambda scene: nearest(scene, 1))


@pytest.fixture(scope="module")
def behind() -> Result:
    """A truck that went over posts that lean, and came to rest behind them."""
    return Simulation(TRUCK, Barrier.bollards(count=3, wall_thickness=0.007), 13.41).run()


@pytest.fixture(scope="module")
def blocks() -> Result:
    """Pinned blocks that a van pushes out of their line by more than their length."""
    row = Barrier.jersey(profile=[(0.4, 0.0), (0.4, 0.8)], length=12, segments=8, free_standing=True)
    return Simulation(Vehicle.preset("van_3500", mesh_density=0.3), row, "48 km/h").run()


def test_a_vehicle_behind_the_barrier_is_not_called_contained(behind: Result, tmp_path: Path) -> None:
    rating = birm3d.rate(behind, "ASTM F2656")
    assert (behind.outcome, rating.contained, rating.verdict) == ("overridden", True, "M30-P2")
    page = Page(birm3d.dossier(behind, tmp_path / "report", draws=0))
    answers = dict(page.table("At a glance"))
    answer = answers["Rating by ASTM F2656, indicative"]
    assert f"came to rest behind the barrier, penetration {rating.penetration:.2f} m" in answer
    assert "contained" not in answer
    tilt, deflection = behind.metrics["post_tilt"], behind.metrics["barrier_deflection"]
    gives_way = answers["How far does the barrier give way?"]
    assert f"posts lean by up to {tilt:.0f} degrees" in gives_way
    assert f"{deflection:.2f} m away from traffic" in gives_way
    assert "do not rely on the outcome" in gives_way
    headlines = {row[0]: row[1] for row in page.table("Headline numbers")}
    assert headlines["greatest tilt of a post"] == f"{tilt:.1f}"
    rows = {row[0]: row[1] for row in page.table("Rating, ASTM F2656")}
    assert rows["dynamic deflection"] == f"{deflection:.2f} m"
    assert rows["greatest tilt of a post"] == f"{tilt:.2f} deg"
    assert sum(text.startswith("Posts lean by") for text in page.texts["p"]) == 1  # for both standards once


def test_a_vehicle_that_moves_on_is_not_said_to_rest(behind: Result) -> None:
    held = Simulation(TRUCK, Barrier.bollards(count=3), 13.41).run()
    assert kept_words(held, birm3d.rate(held, "ASTM F2656")) == "contained"
    through = Simulation(TRUCK, Barrier.bollards(count=3, wall_thickness=0.007), 22.35).run()
    assert kept_words(through, birm3d.rate(through, "ASTM F2656")) == "NOT contained"


def test_segments_without_a_foundation_have_their_friction_told(blocks: Result, tmp_path: Path) -> None:
    page = Page(birm3d.dossier(blocks, tmp_path / "report", draws=0))
    answers = dict(page.table("At a glance"))
    assert "What does its foundation have to carry?" not in answers
    friction = 0.5 * 1.5 * 0.8 * 0.8 * 2400.0 * 9.80665 / 1e3  # kN, of 0.5 on the ground
    held = answers["What holds the segments in their place?"]
    assert f"{friction:.1f} kN for each segment" in held
    gives_way = answers["How far does the barrier give way?"]
    ratio = blocks.metrics["max_overturning_ratio"]
    assert ratio > 1.0
    assert f"by up to {blocks.metrics['barrier_deflection']:.2f} m away from traffic" in gives_way
    assert f"{ratio:.3g} times its restoring one: it would begin to tip" in gives_way
    rows = {row[0]: row[1] for row in page.table("Rating, IWA 14-1")}
    assert rows["dynamic deflection"] == f"{blocks.metrics['barrier_deflection']:.2f} m"
    verdict = {row[0]: row[-1] for row in page.table("Verification")}["warnings of the run"]
    assert verdict == "see the section on warnings"
    assert any(
        text.startswith(
            f"max_overturning_ratio must be at most 1 for segments that stay upright, got {ratio:.3g}"
        )
        for text in page.texts["li"]
    )
    assert "Ratings have doubts: see the cautions of the verdict." in page.texts["p"]
    assert any("square ends overlap on the inner side" in text for text in page.texts["figcaption"])


def test_square_ends_overlap_at_a_pin_by_their_kink_alone(blocks: Result) -> None:
    """Two of half width b about one pin at the kink k share b² tan(k / 2); pins keep together."""
    ends = base_corners(blocks)[-1]
    kink = np.radians(np.abs(np.diff(blocks.segment_yaw[-1])))
    assert kink.max() > math.radians(40.0)
    shared = [shapely.Polygon(a).intersection(shapely.Polygon(b)).area for a, b in itertools.pairwise(ends)]
    assert shared == pytest.approx(0.4**2 * np.tan(kink / 2.0), rel=0.01)
    upper, lower = ends[:-1, 2:].mean(axis=1), ends[1:, :2].mean(axis=1)
    assert np.linalg.norm(upper - lower, axis=1).max() < 1e-3


def test_doubts_of_a_study_are_on_the_page(tmp_path: Path) -> None:
    """The run itself gave no warning, and its page passed that as good."""
    crash = Simulation(TRUCK, Barrier.bollards(count=3, height=0.785), units.mph(30))
    study = birm3d.monte_carlo(crash, {"barrier.height": stats.uniform(0.72, 0.12)}, 8, progress=False)
    page = Page(birm3d.dossier(study, tmp_path / "report", draws=0))
    rated = birm3d.rate(study, "ASTM F2656")
    doubtful = sum(bool(rating.doubts) for rating in rated.ratings)
    assert 0 < doubtful < 8
    assert not birm3d.rate(crash.run(), "ASTM F2656").doubts
    told = [text for text in page.texts["p"] if RELY in text]
    assert [text.partition(",")[0] for text in told] == [f"In {doubtful} of 8 runs of the study"]
    number, _, verdict = page.table("Verification")[-1][1:]
    assert (number, verdict.partition(":")[0]) == ("0", "see the cautions of the verdict")


def test_doubts_of_the_class_are_told_once_for_all_standards() -> None:
    crash = Simulation(TRUCK, Barrier.bollards(count=3, height=0.76), units.mph(30))
    predicted = birm3d.predict(crash, 8, progress=False)
    names = ("ASTM F2656", "SD-STD-02.01")
    ratings = {name: birm3d.rate(predicted, name) for name in names}
    run = crash.run()
    case: Any = SimpleNamespace(
        result=run,
        ratings=[birm3d.rate(run, name) for name in names],
        bands=ClassBands(predicted, ratings, None),
        rating_study=None,
    )
    texts = [caution.text for caution in rating_cautions(case)]
    some = sum(bool(rating.doubts) for rating in ratings["ASTM F2656"].ratings)
    assert 0 < some < 8
    assert sum(text.startswith(f"In {some} of 8 vehicles of the class") for text in texts) == 1
    assert sum(RELY in text for text in texts) == 2  # of the run, and of its class
    assert has_doubts(case)


def test_runs_outside_the_conditions_are_no_failures_of_the_barrier() -> None:
    """They were counted against the barrier: 81 of 128 met it all where 128 of 128 were stopped."""
    crash = Simulation(TRUCK, Barrier.bollards(count=3), units.mph(30))
    study = birm3d.monte_carlo(crash, {"impact_angle": stats.norm(90.0, 3.0)}, 16, progress=False)
    rated = birm3d.rate(study, "ASTM F2656")
    outside = sum(rating.unmet == ("impact angle",) for rating in rated.ratings)
    assert 0 < outside < 16
    assert [rating.is_rated for rating in rated.ratings] == [not rating.unmet for rating in rated.ratings]
    case: Any = SimpleNamespace(
        study=study, rating_study=rated, ratings=[birm3d.rate(crash.run(), "ASTM F2656")]
    )
    table = study_table(case)
    assert table is not None
    rows = {row[0]: row[1:] for row in table.rows}
    fitting = 16 - outside
    assert rows["all of these, and contained"][3].startswith(f"{fitting} of {fitting}, 100")
    assert rows["without a verdict by the standard"][3] == f"{outside} of 16: impact angle {outside}"
