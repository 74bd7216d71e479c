"""The list of slow tests names tests and fixtures that exist, in order and once."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).parent


def test_listed_tests_exist() -> None:
    names = (HERE / "slow_tests.txt").read_text(encoding="utf-8").split()
    assert names == sorted(set(names))
    found = {
        f"{path.name}::{node.name}"
        for path in HERE.glob("test_*.py")
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.FunctionDef)
    }
    # A method of a class is listed as file::Class::method.
    missing = {name for name in names if f"{name.split('::')[0]}::{name.split('::')[-1]}" not in found}
    assert not missing


def test_tests_of_a_listed_fixture_are_slow() -> None:
    """Otherwise the first test that is left would make the fixture."""
    command = [
        sys.executable,
        "-m",
        "pytest",
        "--collect-only",
        "-q",
        "-m",
        "not slow",
        "-p",
        "no:cacheprovider",
    ]
    listed = subprocess.run(
        [*command, HERE / "test_finite_element.py"], capture_output=True, text=True, cwd=HERE
    )
    assert listed.returncode == 0, listed.stdout + listed.stderr
    assert "test_mass_properties" in listed.stdout
    assert "test_committed_table_is_what_the_program_says" not in listed.stdout
