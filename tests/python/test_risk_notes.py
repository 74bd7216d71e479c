"""Occupant risk says what its run warned of, and that OLC is for frontal pulses."""

from __future__ import annotations

import pickle
import warnings
from functools import cache
from pathlib import Path
from types import SimpleNamespace

import birm3d
import numpy as np
import pytest
from birm3d import Barrier, Channel, OccupantRisk, Result, Simulation, Vehicle
from birm3d.assessment.risk_study import RiskStudy
from birm3d.reporting.blocks import Caution
from birm3d.reporting.verdict import risk_section
from birm3d.result.run_warnings import complaints_of

pytestmark = pytest.mark.filterwarnings("ignore::birm3d.CoreContactWarning")

OF_CORE = "CoreContactWarning: core_contact_force must be at most 18 kN"


@cache
def simulation(yaw: float = 90.0) -> Simulation:
    """A car against a pole: sideways the pole reaches its rigid core."""
    car = Vehicle.preset("passenger_car", mesh_density=0.6)
    return Simulation(car, Barrier.pole(diameter=0.3), "80 km/h", impact_yaw=yaw)


@cache
def run(yaw: float = 90.0) -> Result:
    return simulation(yaw).run()


def olc_row(risk: OccupantRisk) -> object:
    return next(row for row in risk.criteria if row.name == "OLC")


def test_the_warnings_of_the_run_are_told() -> None:
    again = Simulation.from_scene(simulation().scene)
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        result = again.run()
    given = tuple(f"{one.category.__name__}: {one.message}" for one in told)
    risk = birm3d.occupant_risk(result)
    assert risk.warnings == given
    assert given[0].startswith(OF_CORE)
    for text in (risk.summary(), risk._repr_html_()):
        assert given[0].replace("'", "&#x27;") in text or given[0] in text
    assert pickle.loads(pickle.dumps(risk)).warnings == given


def test_a_result_of_a_file_has_its_warnings(tmp_path: Path) -> None:
    run().save(tmp_path / "run.npz")
    loaded = birm3d.load(tmp_path / "run.npz")
    assert birm3d.occupant_risk(loaded).warnings == birm3d.occupant_risk(run()).warnings


def test_results_of_earlier_versions_have_what_they_know() -> None:
    old = birm3d.load(Path(__file__).parents[1] / "data" / "results" / "bollards_0_1_0.npz")
    assert all(one.text() for one in complaints_of(old))


def test_a_run_without_warnings_has_none() -> None:
    car = Vehicle.preset("passenger_car", mesh_density=0.6)
    risk = birm3d.occupant_risk(Simulation(car, Barrier.rigid_wall(), 12.0).run())
    assert risk.warnings == risk.notes == ()


def test_energy_that_does_not_close_is_told() -> None:
    result = run(0.0)
    open_one = SimpleNamespace(
        scene=result.scene, statistics=result.statistics, _event=None, metrics={"energy_residual": 0.02}
    )
    told = [one.text() for one in complaints_of(open_one) if one.quantity == "energy_residual"]
    assert told == [
        "energy_residual must be at most 0.005 of the initial kinetic energy, got 0.02: "
        "try a tolerance below 0.001; if it stays, do not rely on the answer"
    ]


def test_a_study_tells_the_worst_warning_with_its_runs() -> None:
    study = birm3d.occupant_risk(birm3d.sweep(simulation(), {"impact_speed": [8.0, 21.0, 22.0]}))
    (told,) = study.warnings
    assert told.startswith(OF_CORE)
    assert told.endswith("(row 2, the worst of 2 in 3 runs: rows 1 to 2)")
    assert told in study.summary()
    assert study.to_dict()["notes"] == list(study.notes)
    assert "OLC is for frontal pulses: in 3 of 3 runs" in study.summary()


def test_the_dossier_has_the_notes_of_occupant_risk() -> None:
    case = SimpleNamespace(risk=birm3d.occupant_risk(run()), bands="none")
    cautions = [block.text for block in risk_section(case).blocks if isinstance(block, Caution)]
    assert cautions[0].startswith(OF_CORE)
    assert cautions[1].startswith("OLC is for frontal pulses")


@pytest.mark.parametrize(
    ("yaw", "frontal"), [(0.0, True), (30.0, True), (60.0, False), (90.0, False), (-90.0, False)]
)
def test_olc_has_a_class_in_frontal_impacts_only(yaw: float, frontal: bool) -> None:
    wall = Barrier.rigid_wall()
    risk = birm3d.occupant_risk(Simulation(run().scene.vehicle, wall, 12.0, impact_yaw=yaw).run())
    assert (olc_row(risk).grade in ("low", "medium", "high")) is frontal
    told = any(note.startswith("OLC is for frontal pulses") for note in risk.notes)
    assert told is not frontal


def test_the_larger_change_of_speed_decides_for_channels() -> None:
    time = np.arange(0.0, 0.2, 1e-4)
    pulse = np.where(time < 0.1, 20.0 * np.sin(np.pi * time / 0.1), 0.0)

    def of(along: float, across: float) -> OccupantRisk:
        return birm3d.occupant_risk(
            x=Channel("x", time, -along * pulse, "g"), y=Channel("y", time, across * pulse, "g")
        )

    assert olc_row(of(1.0, 0.9)).grade == "low"
    assert olc_row(of(1.0, -1.1)).grade == "not frontal"
    assert olc_row(of(-1.0, 0.0)).grade == "does not apply"  # pushed on
    assert "by 13.7 m/s across the vehicle and falls by 12.5 m/s along it" in of(1.0, -1.1).notes[0]
    assert of(1.0, -1.1).olc == pytest.approx(of(1.0, 0.0).olc)  # the value stays


@pytest.mark.parametrize(
    ("fall", "across", "net", "grade"),
    [
        (5.0, 4.0, 0.7, "does not apply"),
        (5.0, 4.0, 0.3, "low"),
        (3.0, 4.0, 0.7, "not frontal"),
        (0.0, 4.0, 0.7, "not frontal"),
        (0.0, 4.0, 6.0, "does not apply"),
    ],
)
def test_class_and_note_name_the_same_reason(fall: float, across: float, net: float, grade: str) -> None:
    """The speed along falls, and ends at a net gain; the speed across changes meanwhile."""
    time = np.arange(0.0, 0.25, 1e-4)
    first = np.where(time < 0.1, 10.0 * np.pi / 2.0 * np.sin(np.pi * time / 0.1), 0.0)  # changes speed by 1
    second = np.interp(time - 0.1, time, first, left=0.0)
    x, y = (fall + net) * second - fall * first, across * first
    risk = birm3d.occupant_risk(x=Channel("x", time, x, "m/s^2"), y=Channel("y", time, y, "m/s^2"))
    assert olc_row(risk).grade == grade
    note = "".join(risk.notes)
    assert ("OLC does not apply" in note) is (grade == "does not apply")
    assert ("OLC is for frontal pulses" in note) is (grade == "not frontal")


def test_a_study_counts_runs_that_are_pushed_on_apart() -> None:
    def of(x: float, y: float) -> OccupantRisk:
        time = np.arange(0.0, 0.2, 1e-4)
        pulse = np.where(time < 0.1, 20.0 * np.sin(np.pi * time / 0.1), 0.0)
        return birm3d.occupant_risk(
            x=Channel("x", time, x * pulse, "g"), y=Channel("y", time, y * pulse, "g")
        )

    study = RiskStudy(dict(enumerate([of(-1.0, 0.0), of(0.5, 1.0), of(1.0, 0.0)])), {})
    side, rear = study.notes
    assert side.startswith("OLC is for frontal pulses: in 1 of 3 runs")
    assert rear.startswith("OLC does not apply in 1 of 3 runs")
