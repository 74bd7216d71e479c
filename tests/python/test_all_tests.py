"""The page of all given tests: its tables are what is computed now, and it is made of them."""

from __future__ import annotations

import importlib.util
import re
import sys
from pathlib import Path

import pytest
from birm3d.assessment.design_caution import _LOW

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
    ("redirection", "SWOV TB51"),
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


def test_readme_has_rows_of_the_page() -> None:
    """README.md of the package: at most ten rows, made of this page and of saved results."""
    spec = importlib.util.spec_from_file_location("tables", TESTS.parent / "docs/build/tables.py")
    assert spec is not None
    assert spec.loader is not None
    tables = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(tables)
    readme = (TESTS.parent / "README.md").read_text(encoding="utf-8")
    section = readme.split("\n## How far the numbers can be trusted\n")[1].split("\n## ")[0]
    rows = [line for line in section.splitlines() if line.startswith("|")]
    assert "\n".join(rows) == tables.trust(), "the table of README.md must be that of docs/build/tables.py"
    assert len(rows) <= 2 + 10
    names = {all_tests.kind(name).TITLE: name for name in all_tests.KINDS}
    # Each of these quantities has its error, or the page says that no test measured it.
    for quantity in ("exit angle", "greatest roll", "overturning moment"):
        assert any(re.search(rf"{quantity} \d+ of \d+.*error", row) for row in rows)
    (none,) = re.findall(r"\nNot checked, .*", section)
    for quantity in ("exit speed", "tilt of posts", "overturning moment"):
        assert quantity in none
    measured = {row.quantity for name in all_tests.KINDS for row in read(name) if row.role != "check"}
    assert {"exit angle", "greatest roll", "overturning moment"} <= measured
    assert not {"exit speed", "tilt of posts", "post tilt"} & measured
    assert set(tables.RESERVATIONS) <= {kind for kind, _, _ in tables.TRUST}
    for kind, quantities, role in tables.TRUST:
        for quantity in quantities:
            name = names[kind]
            judged = [r for r in read(name) if r.judged and r.quantity == quantity and r.role == role]
            counted = tables.counts_by_kind()[kind, quantity, role]
            assert (counted["rows"], counted["within the marks"], counted["too small"]) == (
                str(len(judged)),
                str(sum(r.met for r in judged)),
                str(sum(abs(r.predicted) < abs(r.measured) for r in judged)),
            )


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
    above = Row("a", "b", "exit angle, limit", "deg", 1.0, -1.0, 3.0, 6.04)
    assert not above.met
    assert above.error_text == "at least +5.0 deg"


def test_readme_counts_ratings_as_their_page_does() -> None:
    """Numbers of tests that are computed as contained, whose class is as published, and in the best class."""
    readme = " ".join((TESTS.parent / "README.md").read_text(encoding="utf-8").split())
    said = re.search(
        r"(\d+) of (\d+) are computed as contained, and (\d+) were.* was published of (\d+) tests, "
        r"and is as published in (\d+)\. Of (\d+) tests at posts, (\d+) are .* P1, and (\d+) were in it",
        readme,
    )
    assert said is not None
    ratings = " ".join((FOLDER / "ratings.md").read_text(encoding="utf-8").split())
    found = re.search(
        r"in \d+ of (\d+) tests\. (\d+) are computed as contained, and (\d+) were\. .* was published of "
        r"(\d+) tests, and is as published in (\d+)\. Of (\d+) tests .*, (\d+) are .* P1, and (\d+) were",
        ratings,
    )
    assert found is not None
    assert said.groups() == (found[2], found[1], *found.groups()[2:])


def test_moments_beside_finite_elements_are_told_where_loads_are() -> None:
    """The caution of heavy vehicles and README.md have the least and the greatest error of the preset."""
    rows = [row for row in read("finite_element_truck") if row.quantity == "overturning moment"]
    errors = [row.error for row in rows if row.vehicle == "cargo_truck"]
    assert len(errors) == 4
    least, most = (1.0 / (1.0 + error) for error in (max(errors), min(errors)))
    assert f"the moment was {least:.1f} to {most:.1f} times that of the preset cargo truck" in _LOW
    told = f"{-100.0 * max(errors):.0f} to {-100.0 * min(errors):.0f} % less than in four finite-element runs"
    assert told in " ".join((TESTS.parent / "README.md").read_text(encoding="utf-8").split())
