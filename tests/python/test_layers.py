"""Imports of the Python package point down, form no circle, and go up in one module only.

Imports inside functions and those for the type checker count: they are dependencies for whoever reads.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[2] / "python/birm3d"

# From the bottom to the top. A module imports from its own folder and from lines above its own in this list.
# The result is below the simulation, which makes it: a result knows the scene, not what ran it.
LAYERS = (
    ("_core", "_version", "_source", "base"),
    ("units",),
    ("io", "unit_check"),
    ("signals",),
    ("vehicle",),
    ("barrier",),
    ("scene",),
    ("result",),
    ("simulation",),
    ("study", "calibration"),
    ("assessment",),
    ("plotting",),
    ("rendering", "html_page", "export"),
    ("reporting",),
    ("cli",),
    ("__main__",),
)
LEVEL = {name: level for level, names in enumerate(LAYERS) for name in names}
WAY_UP = "pictures"
"""Every layer may import it; inside its functions, and for types, it imports any layer."""
DOOR = ("", "_moved")
"""``birm3d/__init__.py`` and the table of old paths: they know all modules, and no module imports them."""

Edges = dict[str, dict[str, bool]]
"""Module -> modules that it imports, and whether any of these imports is made when it is loaded."""


def modules_of(package: Path) -> dict[str, Path]:
    """Return the modules by their dotted names below the package."""
    found = {}
    for path in package.rglob("*.py"):
        parts = path.relative_to(package).with_suffix("").parts
        found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


def imports_of(name: str, path: Path, modules: dict[str, Path]) -> Iterator[tuple[str, bool]]:
    """Yield what a module imports from the package, and whether it does when it is loaded."""
    here = name.split(".") if path.name == "__init__.py" else name.split(".")[:-1]

    def look(node: ast.AST, loaded: bool) -> Iterator[tuple[str, bool]]:
        for child in ast.iter_child_nodes(node):
            deferred = isinstance(child, (ast.FunctionDef, ast.AsyncFunctionDef)) or (
                isinstance(child, ast.If) and "TYPE_CHECKING" in ast.unparse(child.test)
            )
            if isinstance(child, ast.ImportFrom):
                parts = child.module.split(".") if child.module else []
                if child.level:
                    base = ".".join([*here[: len(here) - child.level + 1], *parts]).lstrip(".")
                elif parts[0] == "birm3d":
                    base = ".".join(parts[1:])
                else:
                    continue
                for alias in child.names:
                    full = f"{base}.{alias.name}".lstrip(".")
                    yield (full if full in modules or full == "_core" else base), loaded
            elif isinstance(child, ast.Import):
                for alias in child.names:
                    if alias.name.split(".")[0] == "birm3d":
                        yield alias.name.partition(".")[2], loaded
            yield from look(child, loaded and not deferred)

    return look(ast.parse(path.read_text(encoding="utf-8")), True)


def edges_of(package: Path) -> Edges:
    modules = modules_of(package)
    edges: Edges = {}
    for name, path in modules.items():
        if name not in DOOR:
            mine = edges.setdefault(name, {})
            for target, loaded in imports_of(name, path, modules):
                mine[target] = mine.get(target, False) or loaded
    return edges


def upward(edges: Edges) -> list[str]:
    """Return the imports that do not point down."""
    found = []
    for name, targets in edges.items():
        own = name.split(".")[0]
        if own != WAY_UP and own not in LEVEL:
            found.append(f"{name} is in no layer of LAYERS")
            continue
        for target, loaded in targets.items():
            other = target.split(".")[0]
            if other in (own, WAY_UP):
                continue
            if own == WAY_UP:
                down = not loaded or LEVEL.get(other) == 0
            else:
                down = other in LEVEL and LEVEL[other] < LEVEL[own]
            if not down:
                found.append(f"{name} imports {target or 'birm3d'}")
    return found


def circles(edges: Edges) -> list[list[str]]:
    """Return the groups of modules that import each other, by whatever way round; Tarjan's algorithm."""
    order: dict[str, int] = {}
    lowest: dict[str, int] = {}
    open_: list[str] = []
    found = []

    def visit(name: str) -> None:
        order[name] = lowest[name] = len(order)
        open_.append(name)
        for target, loaded in edges.get(name, {}).items():
            if not loaded and name == WAY_UP:
                continue
            if target not in order:
                visit(target)
                lowest[name] = min(lowest[name], lowest[target])
            elif target in open_:
                lowest[name] = min(lowest[name], order[target])
        if lowest[name] == order[name]:
            group = open_[open_.index(name) :]
            del open_[open_.index(name) :]
            if len(group) > 1:
                found.append(sorted(group))

    for name in edges:
        if name not in order:
            visit(name)
    return found


def test_imports_point_down() -> None:
    assert upward(edges_of(PACKAGE)) == []


def test_no_modules_import_each_other() -> None:
    assert circles(edges_of(PACKAGE)) == []


@pytest.mark.parametrize(
    "line",
    [
        "from ..result.high import x",
        "from birm3d.result.high import x",
        "import birm3d.result.high",
        "def f() -> None:\n    from ..result.high import x",
        "if TYPE_CHECKING:\n    from ..result import high",
        "from .. import Vehicle",
    ],
)
def test_an_import_that_points_up_is_found(tmp_path: Path, line: str) -> None:
    files = {"base/low.py": "", "result/high.py": "from ..base.low import y", "barrier/middle.py": line}
    write(tmp_path, files)
    assert upward(edges_of(tmp_path)) in (
        ["barrier.middle imports result.high"],
        ["barrier.middle imports birm3d"],
    )


def test_a_circle_is_found_and_the_way_up_is_none(tmp_path: Path) -> None:
    up = "from .base.low import y\ndef f():\n    from .plotting.figure import draw"
    files = {
        "base/low.py": "",
        "pictures.py": up,
        "result/result.py": "from .. import pictures",
        "plotting/figure.py": "from ..result.result import Result",
    }
    write(tmp_path, files)
    assert upward(edges_of(tmp_path)) == circles(edges_of(tmp_path)) == []
    write(
        tmp_path,
        {"result/result.py": "from .table import z", "result/table.py": "def f():\n    from . import result"},
    )
    assert circles(edges_of(tmp_path)) == [["result.result", "result.table"]]
    write(tmp_path, {"pictures.py": "from .plotting.figure import draw"})  # when it is loaded
    assert upward(edges_of(tmp_path)) == ["pictures imports plotting.figure"]


@pytest.mark.parametrize(
    "line",
    [
        "from .kinds import Wall",
        "def f() -> None:\n    from .kinds import Wall",
        "if TYPE_CHECKING:\n    from .kinds import Wall",
    ],
)
def test_a_circle_of_an_import_in_a_function_or_for_types_is_found(tmp_path: Path, line: str) -> None:
    write(tmp_path, {"barrier/makers.py": line, "barrier/kinds.py": "from .makers import Base"})
    assert circles(edges_of(tmp_path)) == [["barrier.kinds", "barrier.makers"]]


def test_a_folder_without_a_layer_is_found(tmp_path: Path) -> None:
    write(tmp_path, {"drawer/things.py": ""})
    assert upward(edges_of(tmp_path)) == ["drawer.things is in no layer of LAYERS"]


def write(package: Path, files: dict[str, str]) -> None:
    for name, text in files.items():
        (package / name).parent.mkdir(exist_ok=True)
        (package / name).write_text(text, encoding="utf-8")
