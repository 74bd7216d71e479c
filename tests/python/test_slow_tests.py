"""The list of slow tests names tests that exist, in order and once."""

from __future__ import annotations

import ast
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
