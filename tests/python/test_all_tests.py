"""The page of all given tests: its tables are what is computed now, and it is made of them."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

TESTS = Path(__file__).resolve().parents[1]
FOLDER = TESTS / "validation"
sys.path[:0] = [str(FOLDER), str(TESTS / "bench")]

import all_tests  # noqa: E402
from all_tests_page import page  # noqa: E402
from comparison import Row, about, read  # noqa: E402

RECOMPUTED = [
    ("full_width_wall", "detail"),
    ("full_width_wall", "7460"),
    ("full_width_wall", "restitution 2.24"),
    ("side_pole", "7523"),
    ("finite_element", "s_wall25_30"),
    ("finite_element_truck", "wall00_50 fitted_truck"),
    ("small_overlap", "passenger_car"),
    ("redirection", "MASH 3-11"),
    ("lateral_load", "AASHTO TL-3"),
    ("security", "DSC635 at rest"),
]


@pytest.mark.parametrize(("kind", "task"), RECOMPUTED)
def test_tables_are_what_is_computed(kind: str, task: str) -> None:
    saved = {(row.test, row.vehicle, row.quantity, row.role): row for row in read(kind)}
    for row in all_tests.computed((kind, task)):
        old = saved[row.test, row.vehicle, row.quantity, row.role]
        assert old.measured == pytest.approx(row.measured, rel=1e-4)
        width = old.high - old.low or 1.0
        assert row.predicted == pytest.approx(old.predicted, rel=0.01, abs=0.02 * width)


def test_page_is_what_the_tables_say() -> None:
    tables = {name: read(name) for name in all_tests.KINDS}
    modules = {name: all_tests.kind(name) for name in all_tests.KINDS}
    assert (FOLDER / "README.md").read_text(encoding="utf-8") == page(modules, tables)


def test_every_kind_has_rows_of_all_its_tasks() -> None:
    for name in all_tests.KINDS:
        rows = read(name)
        assert len(rows) >= len(all_tests.kind(name).tasks())
        for row in rows:
            assert row.role in ("fitted", "left out", "predicted", "check")
            assert row.low <= row.high


def test_only_calibration_tests_of_nhtsa_are_called_fitted() -> None:
    fitted = {row.test.split(",")[0] for row in read("full_width_wall") if row.role == "fitted"}
    assert fitted == {"NHTSA 10146", "NHTSA 7360", "NHTSA 7460", "NHTSA 7582"}
    fitted = {row.test.split(",")[0] for row in read("side_pole") if row.role == "fitted"}
    assert fitted == {"NHTSA 7349", "NHTSA 7455", "NHTSA 7523", "NHTSA 7584"}


def test_errors_and_marks() -> None:
    row = Row("a", "b", "travel", "m", 0.5, *about(0.5, 0.1), 0.56)
    assert row.error == pytest.approx(0.12)
    assert not row.met
    assert row.error_text == "+12 %"
    turn = Row("a", "b", "yaw", "deg", 0.0, -5.0, 5.0, 2.0)
    assert turn.met
    assert turn.error_text == "+2.0 deg"
    limit = Row("a", "b", "penetration at rest, limit", "m", 0.6, -20.0, 0.6, -3.31)
    assert limit.met
    assert limit.error_text == "-3.91 m"
