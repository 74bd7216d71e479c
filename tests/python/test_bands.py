"""Bands of design loads, occupant risk and metrics over vehicles of a class, recomputed run by run."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from functools import cache

import birm3d
import numpy as np
import pytest
from birm3d import Barrier, Channel, Prediction, Simulation, Vehicle, units
from birm3d.assessment import RiskStudy
from birm3d.assessment.class_bands import bands_of
from birm3d.assessment.design_cells import load_cell, load_text
from birm3d.scene_parameters import varied
from scipy import stats

BANDED = (
    *("impulse", "peak_force", "force_50ms", "moment"),
    *("equivalent_static_force", "equivalent_static_moment", "height"),
)
POSTS = Barrier.bollards(count=3, spacing=1.2)
CRASH = Simulation(Vehicle.preset("passenger_car", mesh_density=0.1), POSTS, 14.0)
PARAPET = Simulation(Vehicle.preset("mash_1100c", mesh_density=0.1), Barrier.jersey(), 27.0, 25.0)


@cache
def prediction() -> Prediction:
    return birm3d.predict(CRASH, 16)


def results() -> list[birm3d.Result]:
    study = prediction().study
    return [study.simulation(row).run() for row in range(len(study))]


def ends(values: list[float]) -> list[float]:
    """10 % and 90 % by the rule of Hazen, written out: value k of n stands at the share (k - 1/2) / n."""
    ordered = sorted(values)
    shares = (np.arange(len(ordered)) + 0.5) / len(ordered)
    return np.interp([0.1, 0.9], shares, ordered).tolist()


def test_band_of_a_design_load_is_that_of_the_drawn_vehicles() -> None:
    loads = birm3d.design_load(CRASH, natural_period=0.06)
    assert loads.draws == 16
    middle = loads["bollard 2"]
    each = [birm3d.design_load(run, natural_period=0.06, draws=0)["bollard 2"] for run in results()]
    for name in BANDED:
        assert middle.band[name] == pytest.approx(ends([getattr(one, name) for one in each]), rel=1e-9)
    # The mean over 50 ms, from the raw history of each run.
    raw = []
    for run in results():
        force, window = run.element_loads[1].force[:, :2], round(0.05 / run.element_loads[1].interval)
        total = np.concatenate([np.zeros((1, 2)), np.cumsum(force[1:], axis=0)])
        raw.append(float(np.hypot(*((total[window:] - total[:-window]) / window).T).max()))
    assert middle.band["force_50ms"] == pytest.approx(ends(raw), rel=1e-6)


def test_band_of_an_envelope_is_that_of_each_vehicle_in_all_governing_scenes() -> None:
    """Two offsets: of each vehicle the greater value counts, before the band is taken over vehicles."""
    offsets = [0.0, 0.5]
    loads = birm3d.design_load(CRASH, offsets=offsets, draws=8)
    row = loads["bollard 3"]
    governing = sorted({number for one in loads for number in one.scene.values()})
    of_offset = [
        birm3d.predict(varied(CRASH, {"impact_offset": offsets[number]}), 8).study for number in governing
    ]
    most = [
        max(
            birm3d.design_load(study.simulation(vehicle).run(), draws=0)["bollard 3"].force_50ms
            for study in of_offset
        )
        for vehicle in range(8)
    ]
    assert row.band["force_50ms"] == pytest.approx(ends(most), rel=1e-9)


def test_a_table_shows_its_band() -> None:
    loads = birm3d.design_load(prediction())
    low, high = (end / 1e3 for end in loads["bollard 2"].band["force_50ms"])
    own = loads["bollard 2"].force_50ms / 1e3
    cell = f"{max(own, high):,.0f} [{own:,.0f}; {low:,.0f} to {high:,.0f}]"
    for text in (loads.summary(), loads.to_markdown(), loads._repr_html_()):
        assert cell in text
        assert "design 50-ms force [kN]" in text
        assert "80 % band over 16 vehicles of the class" in text
    frame = loads.to_dataframe()
    assert frame.loc["bollard 2", "force_50ms_design"] == loads["bollard 2"].design["force_50ms"]
    assert frame.loc["bollard 2", "force_50ms_high"] == loads["bollard 2"].band["force_50ms"][1]
    told = json.loads(json.dumps(loads.to_dict()))
    assert told["draws"] == 16
    assert told["elements"][1]["band"]["moment"] == list(loads["bollard 2"].band["moment"])
    assert told["elements"][1]["design"]["moment"] == loads.design["moment"][1]


LOADS = (
    *("impulse", "peak_force", "force_50ms", "height", "moment"),
    *("equivalent_static_force", "equivalent_static_moment"),
)


@pytest.mark.parametrize("factor", [0.5, 1.0, 2.0])
def test_the_first_number_of_a_cell_is_safe(factor: float) -> None:
    """Vehicles of the class may ask for more than this one: what is pasted is the greater of both."""
    loads = birm3d.design_load(CRASH, natural_period=0.06, draws=8)
    row = loads["bollard 2"]
    band = {name: (low / factor, high / factor) for name, (low, high) in row.band.items()}
    changed = replace(row, band=band)
    for name in LOADS:
        own, (low, high) = getattr(row, name), band[name]
        assert changed.design[name] == max(own, high)
        first, inside, least, most = map(number, re.split(r" \[|; | to |\]", load_cell(changed, name))[:4])
        assert first == max(inside, most)
        assert (inside, least, most) == tuple(number(load_text(name, value)) for value in (own, low, high))
    alone = replace(row, band={})
    assert dict(alone.design) == {name: getattr(row, name) for name in (*LOADS, "longitudinal_force_50ms")}
    assert load_cell(alone, "moment") == load_text("moment", row.moment)


def number(text: str) -> float:
    return float(text.replace(",", ""))


def test_the_design_impulse_is_the_one_of_the_greatest_size() -> None:
    """A post beside the path may be pushed to the traffic side."""
    row = replace(birm3d.design_load(CRASH, draws=0)["bollard 2"], impulse=610.0)
    assert replace(row, band={"impulse": (-3150.0, 1730.0)}).design["impulse"] == -3150.0
    assert replace(row, band={"impulse": (-310.0, 1730.0)}).design["impulse"] == 1730.0


def test_a_value_printed_as_the_end_of_its_band_is_not_called_outside() -> None:
    """713 beside [713 to 782] is no value below its band, though it is by 0.4 kN."""
    row = replace(birm3d.design_load(CRASH, draws=0)["bollard 2"], index=0, force_50ms=712.8e3)
    near, far = (replace(row, force_50ms=force) for force in (713.2e3, 714.2e3))
    for other, told in ((near, []), (far, ["On bollard 2, 50-ms force of this vehicle lies below the band"])):
        found = bands_of([row], [(0, ([other], False)), (1, ([other], False))], 2)
        assert [text.partition(": do not")[0] for text in found.cautions] == told
    assert load_text("force_50ms", row.force_50ms) == load_text("force_50ms", near.force_50ms) == "713"


def test_where_there_is_no_band_the_caution_says_why() -> None:
    one = birm3d.design_load(CRASH, draws=0)
    assert "No band: no vehicles of its class were drawn" in one.caution
    assert one.caution.endswith("Loads are those of this vehicle: others of its class may ask for more.")
    assert "design" not in one._head()[1]
    box = Simulation(Vehicle.preset("paper_pickup", mesh_density=0.1), POSTS, 10.0)
    loads = birm3d.design_load(box)
    assert "No band: the file of 'paper_pickup' says nothing of its class" in loads.caution
    assert loads.draws == 0
    assert not any(row.band for row in loads)
    with pytest.raises(ValueError, match="draws must be 0 where the file of 'paper_pickup' says nothing"):
        birm3d.design_load(box, draws=16)
    with pytest.raises(ValueError, match="draws must be a power of 2 from 8 to 1024, got 12"):
        birm3d.design_load(CRASH, draws=12)
    study = birm3d.monte_carlo(CRASH, {"impact_speed": stats.norm(14.0, 0.1)}, 4)
    assert "No band: the runs of a study differ already" in birm3d.design_load(study).caution


def test_a_blow_with_some_vehicles_is_told() -> None:
    """A soft front is used up at a speed at which the preset's own is not; a stiff one never is."""
    soft, hard = (varied(CRASH, {"scatter.front": factor, "impact_speed": 24.0}) for factor in (0.25, 3.0))
    for simulation, strikes in ((soft, True), (hard, False)):
        predicted = birm3d.predict(simulation, 8)
        metrics = predicted.study.metrics
        struck = metrics["peak_normal_force"] > 2.0 * metrics["peak_normal_force_cfc60"]
        assert bool(struck.any()) is strikes
        assert (f"In {struck.sum()} of 8 draws nothing was left to crush" in predicted.caution) is strikes
        assert predicted.caution in predicted.summary()
        loads = birm3d.design_load(predicted)
        assert ("of 8 vehicles of the class a crush zone is used up" in loads.caution) is strikes


def test_a_prediction_tells_answers_only() -> None:
    told = prediction().summary()
    assert "dynamic_crush" in told
    assert not any(name in told for name in ("energy_residual", "momentum_residual", "steps", "end_time"))
    assert "e-1" not in told  # rounding errors of angles are 0
    head = Simulation(CRASH.scene.vehicle, Barrier.rigid_wall(edge_radius=0.15), 17.9, overlap=0.25)
    assert "The overlap is small" in birm3d.predict(head, 8).caution
    assert "The overlap is small" not in prediction().caution


def test_occupant_risk_of_a_study_has_bands() -> None:
    predicted = birm3d.predict(PARAPET, 8)
    risk = birm3d.occupant_risk(predicted)
    assert isinstance(risk, RiskStudy)
    each = [birm3d.occupant_risk(predicted.study.simulation(row).run()) for row in range(8)]
    for name in ("oiv_x", "oiv_y", "ridedown_y", "asi", "thiv", "phd", "olc"):
        values = [float(getattr(one, name)) for one in each]
        assert [risk.low[name], risk.high[name]] == pytest.approx(ends(values), rel=1e-12)
        assert risk.median[name] == pytest.approx(np.median(values), rel=1e-12)
    assert risk.passed("MASH") == sum(one.passed("MASH") for one in each) / 8
    speeds = [one.thiv / units.km_h for one in each]
    low, high = ends(speeds)
    within = sum(speed <= 33.0 for speed in speeds) / 8
    row = next(line for line in risk.summary().splitlines() if line.startswith("THIV"))
    assert f"{np.median(speeds):.2f} km/h" in row
    assert f"{low:.2f} to {high:.2f} km/h" in row
    assert row.endswith(f"{within:.0%}")
    assert json.loads(json.dumps(risk.to_dict()))["passed"]["EN 1317"] == risk.passed("EN 1317")
    assert "<td" in risk._repr_html_()


def test_one_run_says_that_it_has_no_band() -> None:
    """Report and occupant risk of a run, as its rating does; measured channels are no run of a vehicle."""
    run = PARAPET.run()
    assert "  no band: these are numbers of one vehicle; birm3d.predict(sim) has" in run.report()
    risk = birm3d.occupant_risk(run)
    for text in (risk.summary(), risk._repr_html_()):
        assert "No band: these are values of one vehicle. occupant_risk(birm3d.predict(simulation))" in text
    time = np.arange(0.0, 0.2, 1e-4)
    pulse = Channel("a", time, np.where(time < 0.1, -20.0 * np.sin(np.pi * time / 0.1), 0.0), "g")
    assert "band" not in birm3d.occupant_risk(x=pulse, y=0.0).summary()
    assert "No band" not in birm3d.occupant_risk(birm3d.predict(PARAPET, 8)).summary()


def test_a_study_without_contact_has_no_risk() -> None:
    aside = birm3d.sweep(
        Simulation(CRASH.scene.vehicle, Barrier.bollards(count=2, spacing=6.0), 14.0), impact_speed=[5.0, 6.0]
    )
    with pytest.raises(ValueError, match="a study with a run that has occupant risk, got none: result must"):
        birm3d.occupant_risk(aside)


def test_a_channel_of_the_wrong_sign_is_told() -> None:
    """A deceleration that is given as positive: OLC does not apply, and the sign is named."""
    time = np.arange(0.0, 0.2, 1e-4)
    pulse = np.where(time < 0.1, 20.0 * np.sin(np.pi * time / 0.1), 0.0)
    wrong, right = (
        birm3d.occupant_risk(x=Channel("a", time, sign * pulse, "g"), y=0.0) for sign in (1.0, -1.0)
    )
    assert "x is positive forward" in wrong.summary()
    assert "The vehicle gains 12.5 m/s along x" in wrong._repr_html_()
    assert right.notes == ()
    assert right.olc > 10.0


@pytest.mark.parametrize("factor", [0.5, 1.0, 2.0])
def test_values_outside_their_bands_are_named_with_their_side(factor: float) -> None:
    row = replace(birm3d.design_load(CRASH, natural_period=0.06, draws=0)["bollard 2"], index=0)
    other = replace(row, **{name: getattr(row, name) / factor for name in BANDED})
    found = bands_of([row], [(0, ([other], False)), (1, ([other], False))], 2)
    side = "below the band" if factor < 1.0 else "above the band"
    told = (
        "On bollard 2, impulse, peak force, 50-ms force, 50-ms moment, equivalent static force, equivalent "
        f"static moment and height of this vehicle lie {side}"
    )
    assert [text.partition(":")[0] for text in found.cautions] == ([] if factor == 1.0 else [told])
