"""The page of published tests: it holds every case, and what it says is what is computed."""

from __future__ import annotations

import csv
import importlib
import io
import re
import sys
from html import unescape
from importlib.resources import files
from pathlib import Path
from types import ModuleType

import pytest
from birm3d.reporting.blocks import Text
from birm3d.reporting.given_tests import nearest
from birm3d.reporting.published_class import judged_class

FOLDER = Path(__file__).resolve().parents[1] / "validation"


@pytest.fixture(scope="module")
def module() -> ModuleType:
    sys.path.insert(0, str(FOLDER))
    try:
        return importlib.import_module("rating_page")
    finally:
        sys.path.remove(str(FOLDER))


def _cells(page: str, name: str) -> list[str]:
    """Return the row of a test on the page."""
    (row,) = [line for line in page.splitlines() if line.startswith(f"| {name} |")]
    return [cell.strip() for cell in row.split("|")[1:-1]]


def test_every_row_of_the_published_tests_has_the_fields_of_the_head() -> None:
    """A comma in a note once cut it short without a word."""
    text = (files("birm3d") / "data" / "published_tests.csv").read_text(encoding="utf-8")
    head, *rows = csv.reader(line for line in io.StringIO(text) if not line.startswith("#"))
    assert {row[0]: len(row) for row in rows if len(row) != len(head)} == {}


def test_the_page_has_every_case(module: ModuleType) -> None:
    text = (FOLDER / "ratings.md").read_text(encoding="utf-8")
    for case in module.CASES:
        row = _cells(text, case.name)
        assert row[4] == case.published
        assert row[5] in ("right", "**wrong**")
        assert (row[6] == "not published") == (not case.published_class)
        assert f"- {case.name}: {case.source}" in text
    assert f"of {len(module.CASES)} tests" in text


def test_published_classes_are_those_of_the_published_penetration(module: ModuleType) -> None:
    """ASTM F2656: P1 up to 1 m, P2 up to 7 m, P3 up to 30 m, of the dynamic penetration."""
    told = [case for case in module.CASES if case.penetration is not None]
    assert len(told) >= 5
    for case in told:
        assert case.standard == "ASTM F2656"
        assert case.penetration_kind in ("dynamic", "limit", "")
        limits = {"P1": 1.0, "P2": 7.0, "P3": 30.0}
        assert case.published_class == next(name for name, most in limits.items() if case.penetration <= most)
    (shallow,) = [case for case in told if case.name.startswith("DSC635")]
    assert (shallow.penetration, shallow.penetration_kind, shallow.published_class) == (1.87, "dynamic", "P2")


def test_a_class_is_right_if_each_published_part_is_computed(module: ModuleType) -> None:
    (shallow,) = [case for case in module.CASES if case.name.startswith("DSC635")]
    rating = module.rated(shallow)
    assert rating.contained is shallow.measured  # containment alone would call the row right
    assert rating.penetration < 0.0
    assert judged_class(shallow.published_class, rating) == "wrong"
    assert judged_class("P1", rating) == "right"
    assert judged_class("", rating) == "not published"
    (car,) = [case for case in module.CASES if case.name.startswith("TB11")]
    rating = module.rated(car)
    assert judged_class("pass; severity B", rating) == "right"
    assert judged_class("pass; severity A", rating) == "wrong"
    assert judged_class("fail", rating) == "wrong"


def test_each_test_that_is_left_out_has_its_reason(module: ModuleType) -> None:
    text = (FOLDER / "ratings.md").read_text(encoding="utf-8")
    assert len(dict(module.LEFT_OUT)) == len(module.LEFT_OUT)
    for name, reason in module.LEFT_OUT:
        assert _cells(text, name) == [name, reason]
        assert reason
        assert name not in {case.name for case in module.CASES}


@pytest.mark.parametrize(
    ("name", "designation"),
    [
        ("DSC720-1M, fixed bollard", "M50-P1"),
        ("RSA surface-mount bollards", "K12-L3"),
        ("8-in posts with a rail, 43.5 mph", "M40-P1"),  # it penetrated by 6 m: the posts gave way
    ],
)
def test_security_cases(module: ModuleType, name: str, designation: str) -> None:
    (case,) = [case for case in module.CASES if case.name == name]
    rating = module.rated(case)
    assert rating.designation == designation
    assert rating.penetration < 0.0  # rigid posts: the load bed stays before them


@pytest.mark.filterwarnings("ignore:core_contact_force must be")  # a truck falls on the barrier with its load
def test_every_case_runs_and_the_page_is_fresh(module: ModuleType) -> None:
    """Verdict beside the published one, computed anew; a rating that changed is written by the command."""
    text = (FOLDER / "ratings.md").read_text(encoding="utf-8")
    right = 0
    for case in module.CASES:
        rating = module.rated(case)
        row = _cells(text, case.name)
        assert row[2] == ("contained" if rating.contained else "not contained")
        assert row[3] == f"{rating.penetration:.2f}"
        assert row[6].strip("*") == judged_class(case.published_class, rating)
        right += rating.contained == case.measured
    assert f"as published in {right} of {len(module.CASES)} tests" in text


def test_dossier_of_a_case_has_both_verdicts(module: ModuleType, tmp_path: Path) -> None:
    (case,) = [case for case in module.CASES if case.name == "8-in posts with a rail, 43.5 mph"]
    page = module.write_dossier(case, tmp_path).read_text(encoding="utf-8")
    assert "published penetrated by 6.0 m" in page
    assert module.rated(case).designation in page
    assert "WRONG" in page  # in its own table of given tests
    assert {path.name for path in tmp_path.iterdir()} == {"8-in-posts-with-a-rail-43-5-mph"}


def test_both_pages_run_the_same_scenes(module: ModuleType, monkeypatch: pytest.MonkeyPatch) -> None:
    """What is named alike here and on the page of all tests is one scene."""
    monkeypatch.syspath_prepend(str(FOLDER))
    monkeypatch.syspath_prepend(str(FOLDER.parent / "bench"))
    redirection = importlib.import_module("kind_redirection")
    side_pole = importlib.import_module("kind_side_pole")
    facts = {fact["test"]: fact for fact in redirection.facts("redirections")}
    pairs = {
        "MASH 4-11, 32-in New Jersey": redirection.simulation(facts["NJ32-4-11"]),
        "TL5CMB-2, 42-in median barrier": redirection.simulation(facts["TL5CMB-2"]),
        "TTI 7069-13, 42-in vertical parapet": redirection.simulation(facts["TTI 7069-13"]),
        "FHWA FOIL, C2500 broadside into a pole": side_pole.broadside(),
    }
    for name, other in pairs.items():
        (case,) = [case for case in module.DOSSIERS if case.name == name]
        assert case.simulation().scene == other.scene


def test_notes_have_what_the_page_of_all_tests_has(module: ModuleType) -> None:
    """Another car stands for TB11 there, and its severity is not the published one."""
    text = (FOLDER / "ratings.md").read_text(encoding="utf-8")
    other = (FOLDER / "README.md").read_text(encoding="utf-8")
    for case in module.CASES:
        row = _cells(text, case.name)
        assert row[7] == module.note_of(case)
        assert ("page of all tests" in row[7]) == (case.name.split(",")[0] in module.REPEATED)
    note = next(module.note_of(case) for case in module.CASES if case.name.startswith("TB11"))
    (there,) = [
        line for line in other.splitlines() if line.startswith("| SWOV TB11 |") and "redirected" in line
    ]
    assert f"ASI {there.split('|')[-2].strip()}, class C: **wrong**" in note


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:core_contact_force must be")  # it is part of the dossier
@pytest.mark.parametrize("place", range(16))
def test_dossier_of_each_published_test(
    module: ModuleType, place: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each can be made, its verdict is that of rate(), and no number in it is missing."""
    monkeypatch.setattr("birm3d.reporting.build.find_spec", lambda name: None)  # no second page
    monkeypatch.setattr("birm3d.reporting.study_case.nearest", lambda scene: nearest(scene, 1))
    for part in ("page", "loads", "evidence", "scene_part"):  # pictures are looked at in other tests
        monkeypatch.setattr(f"birm3d.reporting.{part}.figure", lambda *one, **more: Text("a figure"))
    assert len(module.DOSSIERS) == 16
    case = module.DOSSIERS[place]
    page = unescape(module.write_dossier(case, tmp_path, draws=0).read_text(encoding="utf-8"))
    cells = [unescape(cell).strip() for cell in re.findall(r"<td[^>]*>(.*?)</td>", page, re.DOTALL)]
    assert not {"nan", "inf", "-inf"} & {cell.lower() for cell in cells}
    result = case.simulation().run()
    assert f"{result.outcome.replace('_', ' ')}: {result.outcome_detail}" in cells
    if not case.standard:
        return
    rating = module.rated(case)
    contained = "contained" if rating.contained else "NOT contained"
    told = cells[cells.index(f"Rating by {rating.standard}, indicative") + 1]
    assert told.startswith(f"{rating.designation} (vehicle {rating.vehicle_class}); {contained}, ")
    for one in rating.criteria:
        assert one.name in cells
