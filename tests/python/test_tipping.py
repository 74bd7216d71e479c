"""A warning names free-standing segments that would begin to tip, in runs, studies and searches."""

from __future__ import annotations

import warnings
from functools import cache
from pathlib import Path
from types import SimpleNamespace

import birm3d
import numpy as np
import pytest
from birm3d import Barrier, Result, Settings, Simulation, TippingWarning, Vehicle
from birm3d.result.run_warnings import complaints_of
from birm3d.result.tipping import segments_that_tip, tipping, tipping_of_extremes


def head_on(speed: float | str, **given: object) -> Simulation:
    """A truck square to a short chain of segments of 4 m, which it pushes far."""
    chain = Barrier.jersey(length=20.0, segments=5, free_standing=True)
    return Simulation(Vehicle.preset("cargo_truck", mesh_density=0.3), chain, speed, **given)


@cache
def stopped() -> Result:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return head_on("50 km/h").run()


def test_segments_far_beyond_tipping_do_not_stop_a_truck_without_a_word() -> None:
    with pytest.warns(TippingWarning, match="max_overturning_ratio must be at most 1 for segments") as told:
        result = head_on("50 km/h").run()
    assert result.outcome == "stopped"
    ratios = result.overturning_ratio.max(axis=0)
    assert ratios.max() > 30.0
    name = result.scene.barrier.element_names[int(np.argmax(ratios))]
    (message,) = [str(one.message) for one in told]
    assert f"got {ratios.max():.3g} (50-ms mean) at {name!r}: the vehicle overturns it" in message
    assert "would begin to tip, which is not computed" in message


def test_a_ratio_little_above_the_limit_reads_as_above_it() -> None:
    scene = head_on(5.0).scene
    extremes = SimpleNamespace(segments=SimpleNamespace(overturning=1.04 * scene.settings.gravity))
    (complaint,) = tipping_of_extremes(scene, extremes)
    assert "got 1.04 (50-ms mean) at a segment" in complaint.text()
    assert complaint.advice().startswith(
        "The overturning moment of a segment is 1.04 times its restoring one"
    )


def test_warning_and_design_loads_name_segments_by_one_limit() -> None:
    result = stopped()
    names = segments_that_tip(result)
    assert names == tuple(
        np.array(result.scene.barrier.element_names)[result.overturning_ratio.max(axis=0) > 1.0]
    )
    (complaint,) = tipping(result)
    assert any(f"at {name!r}" in complaint.text() for name in names)
    caution = birm3d.design_load(result, draws=0).caution
    assert f"On {', '.join(names)} the overturning moment exceeds" in caution
    assert result.report().count(f"{complaint.value:.3g} times its restoring one") == 1


def test_report_and_occupant_risk_tell_it(tmp_path: Path) -> None:
    result = stopped()
    assert "times its restoring one: it would begin to tip, which is not computed" in result.report()
    told = birm3d.occupant_risk(result).warnings
    assert any(text.startswith("TippingWarning: max_overturning_ratio must be") for text in told)
    result.save(tmp_path / "run.npz")
    assert [one.text() for one in complaints_of(birm3d.load(tmp_path / "run.npz"))] == [
        one.text() for one in complaints_of(result)
    ]


@pytest.mark.parametrize("given", [{"settings": Settings(gravity=0.0)}, {"duration": 1e-5}])
def test_what_has_no_ratio_is_not_warned_of(given: dict[str, object]) -> None:
    """Nothing holds a segment down without gravity; a run of one row has no means."""
    head_on(5.0, **{"duration": 0.02, **given}).run()


def test_segments_that_stay_upright_are_not_warned_of() -> None:
    result = head_on(0.15, duration=0.6).run()
    assert 0.0 < result.metrics["max_overturning_ratio"] < 1.0


@pytest.mark.filterwarnings("ignore::birm3d.LowBarrierWarning", "ignore::birm3d.CoreContactWarning")
@pytest.mark.parametrize("metrics", [None, ["vehicle_penetration"]])
def test_a_study_warns_once_whatever_its_metrics(metrics: list[str] | None) -> None:
    with pytest.warns(TippingWarning) as told:
        study = birm3d.sweep(head_on(5.0), {"impact_speed": [0.1, 8.0, 12.0]}, metrics=metrics)
    (message,) = [str(one.message) for one in told if one.category is TippingWarning]
    assert "at a segment: the vehicle overturns it by more than its weight holds" in message
    assert message.endswith("(row 2, the worst of 2 in 3 runs: rows 1 to 2)")
    wanted = {"max_overturning_ratio"} if metrics is None else set(metrics)
    assert wanted <= set(study.metrics)
    assert metrics is None or set(study.metrics) == wanted


@pytest.mark.filterwarnings("ignore::birm3d.LowBarrierWarning", "ignore::birm3d.CoreContactWarning")
def test_design_loads_and_an_ensemble_warn_of_it() -> None:
    with pytest.warns(TippingWarning, match="at 'segment 3'"):
        birm3d.design_load(head_on(8.0), draws=0)
    with pytest.warns(TippingWarning, match="at a segment"):
        birm3d.ensemble([head_on(8.0)], metrics=["end_time"])


def test_a_search_for_the_mass_of_segments_says_it_in_its_answer_alone() -> None:
    chain = Barrier.jersey(length=20.0, segments=5, free_standing=True)
    car = Simulation(Vehicle.preset("passenger_car", mesh_density=0.2), chain, 8.0, 30.0)
    with warnings.catch_warnings():
        warnings.simplefilter("error", TippingWarning)
        found = birm3d.least_segment_mass(car, (2000.0, 6000.0), deflection=5.0, points=2)
    assert "max_overturning_ratio is" in found.caution
