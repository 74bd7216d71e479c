"""What holds at the extremes: the table's own judgement, and that default settings have no fault."""

from __future__ import annotations

import csv
import math
from pathlib import Path

import pytest
from birm3d import Barrier, Settings, Simulation, Vehicle, scenes
from birm3d.study import Stability, stability
from birm3d.study.verification.stability import _judged
from birm3d.study.verification.stability_cases import AXES, Case, laboratory_cases
from birm3d.study.verification.stability_result import FAULT, HELD, REFUSED
from birm3d.study.verification.watched import LIMITS, Limits

# With the scene's own, adaptive steps; fixed ones have a test of their own.
USUAL = ("stiffness", "grazing angle", "unloading", "thin posts", "contact at t = 0")


def car(barrier: Barrier, angle: float = 90.0) -> Simulation:
    return Simulation(Vehicle.preset("passenger_car", mesh_density=0.1), barrier, 15.0, angle, duration=0.3)


@pytest.fixture(scope="module")
def bollards() -> Stability:
    return stability(car(Barrier.bollards()), axes=USUAL)


def test_a_car_at_bollards_has_no_fault(bollards: Stability) -> None:
    assert {row.axis for row in bollards.rows} == set(USUAL)
    assert bollards.faults == (), bollards.report()


def test_a_car_at_a_wall_has_no_fault() -> None:
    found = stability(car(Barrier.rigid_wall(), 25.0), axes=("stiffness", "speed", "mass", "grazing angle"))
    assert {row.verdict for row in found.rows} == {HELD}, found.report()


def test_what_can_not_be_is_refused_with_its_reason(bollards: Stability) -> None:
    refused = {(row.axis, row.value): row.reason for row in bollards.rows if row.verdict == REFUSED}
    assert "k_unloading must be finite and > 0, got inf" in refused["unloading", "slope x inf"]
    assert "standoff must be" in refused["contact at t = 0", "standoff -1 mm"]
    assert all(refused.values())


def test_long_fixed_steps_are_refused() -> None:
    """Four times the advised step is the critical one; far beyond it no answer is given."""
    found = stability(scenes.w2(24), axes=["fixed step"])
    beyond = [row for row in found.rows if float(row.value[2:]) > 4.0]
    assert len(beyond) == 5
    for row in beyond:
        assert row.verdict == REFUSED
        assert row.reason.startswith("UnstableError: time_step must be below")


def test_limits_that_nothing_meets_find_faults_everywhere() -> None:
    found = stability(scenes.w2(24), axes=["speed"], limits=Limits(energy=1e-15))
    assert {(row.verdict, row.reason) for row in found.rows} == {(FAULT, "energy")}
    assert len(found.faults) == len(found.rows)
    deep = stability(car(Barrier.jersey()), axes=["stiffness"], limits=Limits(node_depth=0.0))
    assert any("node inside" in row.reason for row in deep.faults)


def beside() -> Simulation:
    return Simulation(
        Vehicle.preset("passenger_car", mesh_density=0.1),
        Barrier.pole(),
        15.0,
        impact_offset=5.0,
        duration=1.0,
    )


def test_planted_faults_are_found() -> None:
    """A vehicle beside its barrier, one that should stand and rolls, one that does not turn over."""
    missed = _judged(Case("thin posts", "", "", beside, touches=True, behind=0.0), LIMITS)
    assert missed.verdict == FAULT
    assert "the barrier was not met" in missed.reason
    assert "behind the barrier" in missed.reason
    moving = _judged(Case("rest", "", "", lambda: scenes.rolling(0.2), moves=False), LIMITS)
    assert moving.verdict == FAULT
    assert "moved by" in moving.reason
    upright = _judged(Case("rollover", "", "", lambda: scenes.rolling(0.2), turns=10.0), LIMITS)
    assert upright.reason.startswith("0.0 turns")


def broken() -> Simulation:
    raise KeyError("a fault of the program")


def test_an_error_without_a_reason_is_a_fault() -> None:
    row = _judged(Case("nodes", "", "", broken), LIMITS)
    assert row.verdict == FAULT
    assert row.reason == "KeyError: 'a fault of the program'"


@pytest.mark.filterwarnings("ignore::birm3d.UnitWarning")  # 100 m/s is meant
def test_ten_turns_and_one_node() -> None:
    cases = [case for case in laboratory_cases() if case.axis == "rollover" or case.scene == "one node"]
    assert len(cases) == 5
    for case in cases:
        row = _judged(case, LIMITS)
        assert row.verdict == HELD, row


def test_a_minute_of_rest() -> None:
    found = stability(scenes.parked(1.0, Settings()), axes=["rest"])
    assert [row.verdict for row in found.rows] == [HELD], found.report()
    assert found.rows[0].energy_residual < 1e-6


def test_table_report_and_figure(bollards: Stability, tmp_path: Path) -> None:
    assert len(bollards.to_dataframe()) == len(bollards.rows)
    report = bollards.report()
    assert "limits: energy 0.005" in report
    assert "refused: unloading slope x inf" in report
    bollards.save(tmp_path / "table.csv")
    with (tmp_path / "table.csv").open(encoding="utf-8", newline="") as file:
        assert [row["verdict"] for row in csv.DictReader(file)] == [row.verdict for row in bollards.rows]
    axes = bollards.plot().axes[0]
    assert axes.get_yscale() == "log"
    assert [tick.get_text() for tick in axes.get_xticklabels()] == list(USUAL)


def test_bad_input_is_named() -> None:
    with pytest.raises(ValueError, match=rf"axes must be among {', '.join(AXES)}; got 'heat'"):
        stability(scenes.w2(4), axes=["heat"])
    with pytest.raises(ValueError, match="energy must be >= 0, got -1"):
        Limits(energy=-1.0)
    with pytest.raises(ValueError, match="momentum must be >= 0, got nan"):
        Limits(momentum=math.nan)
