"""The package and its commands load only what they need: every module costs time at each start."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import birm3d
import click
import pytest
from birm3d.cli.commands import COMMANDS, _cli

SCIENCE = ("numpy", "scipy", "matplotlib", "pydantic", "pandas", "birm3d._core", "birm3d._source")


def loaded_after(program: str) -> set[str]:
    """Names of all modules that a fresh interpreter has after a program."""
    done = subprocess.run(
        [sys.executable, "-c", f"import sys\n{program}\nprint(*sys.modules, file=sys.stderr)"],
        capture_output=True,
        text=True,
        check=True,
    )
    return set(done.stderr.split())


def test_importing_the_package_loads_nothing_heavy() -> None:
    assert not loaded_after("import birm3d") & {*SCIENCE, "click"}


def test_help_loads_no_command() -> None:
    program = "from birm3d.cli.commands import _cli\n_cli(['--help'], standalone_mode=False)"
    modules = loaded_after(program)
    assert not modules & {*SCIENCE, *(f"birm3d.cli.{place.module}" for place in COMMANDS.values())}


@pytest.mark.parametrize("form", [[], ["--json"]])
def test_a_run_loads_no_study_and_no_picture(form: list[str]) -> None:
    program = (
        "from birm3d.cli.commands import _cli\n"
        f"_cli(['run', '--vehicle', 'pickup', '--speed', '20mph', *{form}], standalone_mode=False)"
    )
    modules = loaded_after(program)
    assert "birm3d._core" in modules
    assert not modules & {
        "matplotlib",
        "pandas",
        "scipy",
        "birm3d.study",
        "birm3d.calibration",
        "birm3d.plotting",
    }


def test_help_of_all_commands_is_that_of_each_command() -> None:
    context = click.Context(_cli)
    for name, place in COMMANDS.items():
        command = _cli.get_command(context, name)
        assert command is not None
        assert (command.name, command.get_short_help_str(1000)) == (name, place.help)


def test_each_public_name_has_one_place() -> None:
    """The table that loads names agrees with the imports that type checkers read."""
    tree = ast.parse(Path(birm3d.__file__).read_text(encoding="utf-8"))
    (block,) = (node for node in tree.body if isinstance(node, ast.If))
    declared = {
        alias.asname or alias.name: (node.module or "", alias.name)
        for node in block.body
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }
    assert sorted(declared) == sorted(birm3d._WHERE) == sorted(birm3d.__all__)
    for name, (module, own) in declared.items():
        place = birm3d._WHERE[name]
        assert place in (f"{module}:{own}", f"{module}.{own}".lstrip(".")), name
        assert getattr(birm3d, name) is not None


def test_folders_are_found_and_other_names_are_not() -> None:
    assert birm3d.vehicle.__name__ == "birm3d.vehicle"
    with pytest.raises(AttributeError, match="no attribute 'vehicel'"):
        _ = birm3d.vehicel
