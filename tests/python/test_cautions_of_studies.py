"""Cautions of the ratings of many runs: no doubt of a few runs is lost, and none is said of all."""

from __future__ import annotations

import birm3d
import pytest
from birm3d import Barrier, Simulation, Vehicle, units
from birm3d.assessment import LevelStudy, Rating, RatingStudy
from birm3d.assessment.doubts import Doubt
from birm3d.assessment.roadside import EN_1317

MODEL = "A harmless sentence on what the model leaves out, longer than any doubt that a run may have."
RELY = "Do not rely on the outcome."


def rating(*doubts: Doubt, test: str = "", other: str = MODEL) -> Rating:
    cautions = (*(doubt.sentence for doubt in doubts), other)
    return Rating("EN 1317", "pass", 0.5, True, (), cautions, "car", test, doubts=doubts)


def lean(tilt: int) -> Doubt:
    return Doubt("post_tilt", float(tilt), f"Posts lean by {tilt} degrees. {RELY}")


def test_a_doubt_of_some_runs_is_told_with_their_number() -> None:
    """The longest text was told alone: a longer harmless one took the place of a doubt."""
    runs = [rating(lean(50)), rating(lean(63)), rating(lean(47)), *(rating(other=MODEL + MODEL),) * 2]
    study = RatingStudy(dict(enumerate(runs)), {})
    assert study.cautions == (
        f"In 3 of 5 runs, here the worst: Posts lean by 63 degrees. {RELY}",
        f"In 3 of 5 runs: {MODEL}",
        f"In 2 of 5 runs: {MODEL + MODEL}",
    )
    assert study.caution in study.summary()
    assert study.to_dict()["caution"] == study.caution == " ".join(study.cautions)


def test_runs_without_a_rating_are_not_among_those_that_are_counted() -> None:
    study = RatingStudy({0: rating(lean(50)), 2: rating()}, {1: "failed"})
    assert study.cautions == (f"In 1 of 2 rated runs: Posts lean by 50 degrees. {RELY}", MODEL)


def test_criteria_near_their_limits_are_counted_each() -> None:
    text = "Within 15 % of the limit: {names}. That is no verdict."
    doubts = [Doubt("near_limits", float(len(n)), text, n) for n in (("ASI",), ("ASI", "THIV"), ("ASI",))]
    study = RatingStudy(dict(enumerate([*map(rating, doubts), rating()])), {})
    told = "Within 15 % of the limit: ASI (in 3 of 4 runs), THIV (in 1 of 4 runs). That is no verdict."
    assert study.cautions == (told, MODEL)
    assert rating(doubts[1]).cautions[0] == "Within 15 % of the limit: ASI, THIV. That is no verdict."


def test_a_level_has_the_doubts_of_all_its_tests() -> None:
    small = RatingStudy({0: rating(lean(50), test="TB11"), 1: rating(test="TB11")}, {})
    large = RatingStudy({0: rating(test="TB42")}, {})
    level = LevelStudy(EN_1317, "H1", [small, large])
    assert level.caution == f"{MODEL} Test TB11: In 1 of 2 runs: Posts lean by 50 degrees. {RELY}"


@pytest.mark.filterwarnings("ignore::birm3d.LowBarrierWarning", "ignore::birm3d.CoreContactWarning")
def test_what_one_drawn_vehicle_causes_is_not_said_of_the_vehicle() -> None:
    """Some trucks of the class have more of their front's resistance above this row than others."""
    truck = Vehicle.preset("cargo_truck", mesh_density=0.3)
    predicted = birm3d.predict(Simulation(truck, Barrier.bollards(count=3, height=0.76), units.mph(30)), 8)
    alone = [birm3d.rate(predicted.study.simulation(row).run(), "ASTM F2656") for row in range(8)]
    own = [doubt for one in alone for doubt in one.doubts if doubt.kind == "height"]
    assert 0 < len(own) < 8
    worst = max(own, key=lambda doubt: doubt.value)
    study = birm3d.rate(predicted, "ASTM F2656")
    assert study.cautions[0].startswith(f"In {len(own)} of 8 runs")
    assert study.cautions[0].endswith(worst.text)
    assert sum(RELY in text for text in study.cautions) == 1
