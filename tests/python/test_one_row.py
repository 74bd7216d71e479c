"""One row for each metric and for each setting: all else is made of the rows."""

from __future__ import annotations

import dataclasses
import re
from pathlib import Path
from typing import Any

import birm3d
import pytest
from birm3d import Settings, _core
from birm3d.metrics import METRIC_UNITS, METRICS
from birm3d.result import metrics, summary
from birm3d.result.metric_table import GROUPS, Metric, Shown
from birm3d.result.run_values import PARTS
from birm3d.scene_parameters import unit_of
from birm3d.simulation.scene_file import _Settings
from birm3d.study.runner import checked_metrics
from birm3d.study.verification.errors import BALANCES, BOOKKEEPING, compared_metrics

PACKAGE = Path(birm3d.__file__).parent


def test_rows_are_complete() -> None:
    for name, metric in METRICS.items():
        assert metric.meaning, name
        assert metric.group in GROUPS, name
        if metric.needs != "end":
            _core.ExtremeGroups(**{metric.needs: True})  # refuses what is none
        assert METRIC_UNITS[name] == metric.unit
        assert (name in BOOKKEEPING, name in BALANCES) == (
            metric.error == "effort",
            metric.error == "balance",
        )
    assert list(METRIC_UNITS) == list(METRICS)


def test_meanings_stand_alone() -> None:
    """The public mapping and the command line show one without the row above it."""
    unfinished = re.compile(r"(the same|of|by|at|since|its?|that|this|these|those)\b", re.IGNORECASE)
    assert [name for name, metric in METRICS.items() if unfinished.match(metric.meaning)] == []
    meanings = [metric.meaning for metric in METRICS.values()]
    assert len(set(meanings)) == len(meanings)


def test_no_metric_has_two_rows() -> None:
    tables = [PACKAGE / "result" / f"{name}.py" for name in ("metric_table", "load_metrics", "crush_metrics")]
    rows = [name for path in tables for name in re.findall(r'"(\w+)": Metric\(', path.read_text("utf-8"))]
    assert sorted(rows) == sorted(METRICS)


def test_a_metric_is_named_in_its_row_only() -> None:
    """Beside the function that makes it: nothing else in the package lists it."""
    named = [path for path in PACKAGE.rglob("*.py") if "wheel_climb" in path.read_text(encoding="utf-8")]
    assert {path.name for path in named} == {"metric_table.py", "metric_functions.py"}


def test_a_row_is_enough(monkeypatch: pytest.MonkeyPatch) -> None:
    """A planted row is computed, shown by tables, and taken by studies."""
    shown = Shown("half of the crush", ".2f", "mm", 1e-3)
    row = Metric("m", "crush", "for this test", "end", lambda run: 0.5 * run.dynamic_crush, shown=shown)
    monkeypatch.setattr(metrics, "METRICS", {**METRICS, "half_crush": row})
    monkeypatch.setattr(summary, "_ROWS", {**summary._ROWS, "half_crush": shown})
    result = birm3d.scenes.w1().run()
    found = metrics.compute_metrics(result)
    assert found["half_crush"] == 0.5 * found["dynamic_crush"] > 0.0
    assert {name: found[name] for name in result.metrics} == dict(result.metrics)


def test_what_a_scene_can_not_have_is_no_column_of_a_study() -> None:
    joint = {name for name, metric in METRICS.items() if metric.of == "joint"}
    moving = {name for name, metric in METRICS.items() if metric.of in ("segments", "posts", "moving")}
    assert joint == {"max_articulation_angle", "peak_joint_force_50ms"}
    assert len(moving) == 5
    absent = set(METRICS) - set(checked_metrics(None, ()))
    assert absent == joint | moving | {"bed_slip", "run_time"}
    assert set(METRICS) - set(checked_metrics(None, PARTS)) == {"run_time"}
    assert set(compared_metrics(METRICS)) == {
        name for name, metric in METRICS.items() if metric.error == "answer"
    }


def test_settings_reach_the_core_by_name(monkeypatch: pytest.MonkeyPatch) -> None:
    names = [field.name for field in dataclasses.fields(Settings)]
    given: dict[str, Any] = {}
    monkeypatch.setattr(_core, "Settings", given.update)
    of_vehicle = {"mu_tire_barrier": 0.5, "cornering_stiffness": 8.0, "edge_flank_factor": 0.7}
    Settings(mu_body=0.3, time_step=1e-4, **of_vehicle)
    assert sorted(given) == sorted(names)
    assert (given["mu_body"], given["mu_tire"], given["tolerance"]) == (0.3, 0.8, 1e-3)
    monkeypatch.undo()
    with pytest.raises(TypeError, match="no setting has the name mu_tyre"):
        _core.Settings({"mu_tyre": 0.8})
    for name in given:
        _core.Settings({name: given[name]})
    assert list(_Settings.model_fields) == names


def test_units_of_settings_are_in_their_rows() -> None:
    for field in dataclasses.fields(Settings):
        assert unit_of(f"settings.{field.name}") == field.metadata.get("unit", "")
    assert Settings(time_step="10 us").time_step == pytest.approx(1e-5, rel=1e-15)
    assert Settings(gravity="1 g").gravity == pytest.approx(9.80665)
    with pytest.raises(ValueError, match="time_step"):
        Settings(time_step="10 kg")
