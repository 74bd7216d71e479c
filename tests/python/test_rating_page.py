"""The page of published tests: it holds every case, and what it says is what is computed."""

from __future__ import annotations

import importlib
import sys
from pathlib import Path
from types import ModuleType

import pytest

FOLDER = Path(__file__).resolve().parents[1] / "validation"


@pytest.fixture(scope="module")
def module() -> ModuleType:
    sys.path.insert(0, str(FOLDER))
    try:
        return importlib.import_module("rating_page")
    finally:
        sys.path.remove(str(FOLDER))


def test_the_page_has_every_case(module: ModuleType) -> None:
    text = (FOLDER / "ratings.md").read_text(encoding="utf-8")
    for case in module.CASES:
        (row,) = [line for line in text.splitlines() if line.startswith(f"| {case.name} |")]
        assert case.published in row
        assert (" right |" in row) != ("**wrong**" in row)
        assert f"- {case.name}: {case.source}" in text
    assert f"of {len(module.CASES)} tests" in text


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
