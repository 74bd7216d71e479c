"""Formatting, linting, types, layering, and the generated stub: rules that a machine can hold."""

import ast
import graphlib
import os
import re
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
CPP_FILES = sorted(
    path
    for folder in ("cpp", "bindings", "tests/cpp", "examples/cpp")
    for path in (ROOT / folder).rglob("*")
    if path.suffix in {".cpp", ".hpp"}
)


def passes(*command: str | Path) -> None:
    """Run a checker in the repository; its findings are the failure message."""
    done = subprocess.run(
        [str(c) for c in command],
        cwd=ROOT, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
    )  # fmt: skip
    if done.returncode != 0:
        pytest.fail(f"{command[0]} exit status {done.returncode}\n{done.stdout}", pytrace=False)


def test_python_lint() -> None:
    passes(sys.executable, "-m", "ruff", "check", "--no-cache", ".")


def test_python_format() -> None:
    passes(sys.executable, "-m", "ruff", "format", "--check", "--diff", "--no-cache", ".")


def test_python_types(tmp_path: Path) -> None:
    passes(sys.executable, "-m", "mypy", "--strict", "--cache-dir", tmp_path, "python/birm3d")


def test_cpp_format() -> None:
    clang_format = shutil.which("clang-format", path=sysconfig.get_path("scripts"))
    assert clang_format, "clang-format is missing; pip install '.[test]' brings it"
    passes(clang_format, "--dry-run", "--Werror", *CPP_FILES)


def test_stub_is_what_the_module_says(tmp_path: Path) -> None:
    passes(sys.executable, "-m", "pybind11_stubgen", "birm3d._core", "--exit-code", "-o", tmp_path)
    generated = (tmp_path / "birm3d/_core.pyi").read_text(encoding="utf-8")
    committed = (ROOT / "python/birm3d/_core.pyi").read_text(encoding="utf-8")
    assert committed == generated, "regenerate: python -m pybind11_stubgen birm3d._core -o python"


MOST_LINES, MOST_LINES_OF_FUNCTION = 300, 60


def too_long(name: str, text: str) -> list[str]:
    """Files and functions (without their docstrings) that are long and do not say why."""
    found = []
    lines = text.splitlines()
    if len(lines) > MOST_LINES and f"# Longer than {MOST_LINES} lines: " not in text:
        found.append(f"{name} has {len(lines)} lines")
    for node in ast.walk(ast.parse(text)):
        if not isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)) or node.end_lineno is None:
            continue
        own = lines[node.lineno - 1 : node.end_lineno]
        docstring = ast.get_docstring(node, clean=False)
        length = len(own) - (0 if docstring is None else docstring.count("\n") + 1)
        reason = f"# Longer than {MOST_LINES_OF_FUNCTION} lines: "
        if length > MOST_LINES_OF_FUNCTION and not any(reason in line for line in own):
            found.append(f"{node.name}() in {name} has {length} lines")
    return found


def test_files_and_functions_are_short_or_say_why() -> None:
    """What is longer gets a comment: "# Longer than 300 lines: " or "# Longer than 60 lines: ", and why."""
    package = ROOT / "python/birm3d"
    found = []
    for path in sorted(package.rglob("*.py")):
        found += too_long(str(path.relative_to(package)), path.read_text(encoding="utf-8"))
    assert not found, "split it, or say why in a comment '# Longer than ... lines: ...': " + "; ".join(found)


def test_a_long_file_and_a_long_function_are_found() -> None:
    function = 'def f() -> None:\n    """Do."""\n' + "    pass\n" * 60
    assert too_long("a.py", function) == ["f() in a.py has 61 lines"]
    assert too_long("a.py", function.replace("pass", "# Longer than 60 lines: a list.\n    pass", 1)) == []
    assert too_long("a.py", "x = 1\n" * 301) == ["a.py has 301 lines"]
    assert too_long("a.py", "# Longer than 300 lines: a table.\n" + "x = 1\n" * 301) == []
    assert too_long("a.py", "x = 1\n" * 300 + "") == []


# Layers of the C++ code, lowest first. A file may include its own layer and those before it.
LAYERS = (
    "base",
    "geometry",
    "model",
    "state",
    "kernels",
    "scene",
    "contact",
    "step",
    "control",
    "record",
    "simulation",
    "ensemble",
)
# The one file of the kernels that others include, and that includes the loops of several of them.
SIMD_TABLE = "simd_table"
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*([<"])([^">]+)[">]', re.MULTILINE)
# Printing, files and Python belong to the layers above the core.
FOREIGN = re.compile(r"(iostream|ostream|istream|fstream|cstdio|stdio\.h|print|Python\.h|pybind11/.*)")


def layer_folders(root: Path) -> dict[str, Path]:
    """The two folders of the C++ layers: of installed headers, and of all else."""
    return {"include": root / "cpp/include/birm3d", "src": root / "cpp/src"}


def layering_errors(root: Path) -> list[str]:
    """Every include below cpp/ that points upwards, sideways between kernels, or out of the core."""
    errors = []
    folders = layer_folders(root)
    for folder in folders.values():
        for path in sorted(p for p in folder.rglob("*") if p.suffix in {".hpp", ".cpp"}):
            name = path.relative_to(folder)
            where = path.relative_to(root).as_posix()
            layer = name.parts[0]
            if layer not in LAYERS:
                errors.append(f"{where}: is in none of the layers {', '.join(LAYERS)}")
                continue
            for bracket, included in INCLUDE.findall(path.read_text(encoding="utf-8")):
                if FOREIGN.fullmatch(included):
                    errors.append(f"{where}: the core may not include {included}")
                    continue
                file = included_file(path, bracket, included, folders)
                if file is None:
                    continue
                target = next(file.relative_to(f) for f in folders.values() if file.is_relative_to(f))
                if target.parts[0] not in LAYERS or LAYERS.index(target.parts[0]) > LAYERS.index(layer):
                    errors.append(f"{where}: layer {layer} may not include {included}")
                elif layer == target.parts[0] == "kernels" and not parts_of_one(name.stem, target.stem):
                    errors.append(f"{where}: kernels may not include each other, but it includes {included}")
    return errors


def included_file(path: Path, bracket: str, included: str, folders: dict[str, Path]) -> Path | None:
    """The included file; None for the standard library and Eigen."""
    if included.startswith("birm3d/"):
        return folders["include"] / included.removeprefix("birm3d/")
    if bracket == '"':
        for candidate in (path.parent / included, folders["src"] / included):
            file = Path(os.path.normpath(candidate))
            if file.is_file() and any(file.is_relative_to(folder) for folder in folders.values()):
                return file
    return None


def parts_of_one(a: str, b: str) -> bool:
    """Files of one kernel: crush.hpp, crush.cpp, crush_simd.cpp; and the table of all *_simd.cpp."""
    by_table = b == SIMD_TABLE or (a == SIMD_TABLE and b.endswith("_simd"))
    return by_table or a.split("_")[0] == b.split("_")[0]


def test_layers_include_downwards_only() -> None:
    assert (ROOT / "cpp/include/birm3d/base").is_dir()
    assert layering_errors(ROOT) == []


# What a C++ user includes. Other installed headers are only what these are made of.
PUBLIC_HEADERS = (
    "simulation/simulation",
    "ensemble/runner",
    "scene/scene",
    "record/event",
    "record/extremes",
    "record/recorder",
    "model/vehicle",
    "model/vehicle_text",
    "model/truss_law",
    "model/mass_properties",
    "model/barrier",
    "model/settings",
    "base/error",
    "base/rotation",
)


def headers_below(root: Path, public: tuple[str, ...]) -> set[str]:
    """The headers that users include, and all that these include, relative to the installed folder."""
    found: set[str] = set()
    waiting = [f"{name}.hpp" for name in public]
    while waiting:
        name = waiting.pop()
        if name in found:
            continue
        found.add(name)
        text = (root / name).read_text(encoding="utf-8")
        for bracket, included in INCLUDE.findall(text):
            assert bracket == "<" or included.startswith("birm3d/"), f"{name} includes the private {included}"
            if bracket == '"':
                waiting.append(included.removeprefix("birm3d/"))
    return found


def test_only_headers_that_users_need_are_installed() -> None:
    """Detection, contact, stepping and step control are private: their headers stand beside the sources."""
    folder = ROOT / "cpp/include/birm3d"
    installed = {path.relative_to(folder).as_posix() for path in folder.rglob("*.hpp")}
    assert installed == headers_below(folder, PUBLIC_HEADERS)
    assert not {"kernels", "contact", "step", "control"} & {name.split("/")[0] for name in installed}


@pytest.mark.parametrize(
    ("file", "line", "finding"),
    [
        ("include/birm3d/base/a.hpp", '#include "birm3d/geometry/b.hpp"', "layer base may not include"),
        ("src/model/a.cpp", "#  include <birm3d/step/step.hpp>", "layer model may not include"),
        ("src/kernels/a.cpp", '#include "b.hpp"', "kernels may not include each other"),
        ("src/kernels/a_b.cpp", '#include "b.hpp"', "kernels may not include each other"),
        ("src/step/a.cpp", "#include <iostream>", "the core may not include iostream"),
        ("include/birm3d/state/a.hpp", "#include <pybind11/numpy.h>", "the core may not include pybind11"),
        ("src/extras/a.cpp", "", "is in none of the layers"),
        ("src/kernels/simd_table.hpp", '#include "b.hpp"', "kernels may not include each other"),
        ("src/kernels/b.cpp", '#include "birm3d/kernels/b.hpp"', None),
        ("src/step/a.cpp", '#include "birm3d/kernels/b.hpp"\n#include <Eigen/Core>\n#include <vector>', None),
    ],
)
def test_layering_check_itself(tmp_path: Path, file: str, line: str, finding: str | None) -> None:
    for name, text in (("src/kernels/b.hpp", ""), (file, line)):
        path = tmp_path / "cpp" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    errors = layering_errors(tmp_path)
    if finding is None:
        assert errors == []
    else:
        assert len(errors) == 1
        assert finding in errors[0]


def include_circle(root: Path) -> list[str]:
    """Files below cpp/ that include each other, in the order of their includes; none without a circle."""
    graph = {}
    for path in (p for p in (root / "cpp").rglob("*") if p.suffix in {".hpp", ".cpp"}):
        includes = INCLUDE.findall(path.read_text(encoding="utf-8"))
        files = (
            included_file(path, bracket, included, layer_folders(root)) for bracket, included in includes
        )
        graph[path] = {file for file in files if file is not None}
    try:
        graphlib.TopologicalSorter(graph).prepare()
    except graphlib.CycleError as error:
        return [file.relative_to(root).as_posix() for file in error.args[1]]
    return []


def test_no_cpp_files_include_each_other() -> None:
    assert include_circle(ROOT) == []


def test_a_circle_of_includes_is_found(tmp_path: Path) -> None:
    texts = {
        "include/birm3d/state/a.hpp": '#pragma once\n#include "birm3d/state/b.hpp"\n',
        "include/birm3d/state/b.hpp": '#pragma once\n#include "birm3d/state/a.hpp"\n',
        "src/state/c.cpp": "#include <vector>\n#include <birm3d/state/a.hpp>\n",
    }
    for name, text in texts.items():
        path = tmp_path / "cpp" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    assert layering_errors(tmp_path) == []  # no include points up
    assert {Path(name).name for name in include_circle(tmp_path)} == {"a.hpp", "b.hpp"}
    (tmp_path / "cpp/include/birm3d/state/b.hpp").write_text("#pragma once\n", encoding="utf-8")
    assert include_circle(tmp_path) == []


def without_texts(text: str) -> str:
    """Return C++ code without comments and literals; its lines stay where they are."""
    text = re.sub(r'"(?:[^"\\\n]|\\.)*"', '""', text)
    text = re.sub(r"'(?:[^'\\\n]|\\.)'", "' '", text)
    return re.sub(r"//[^\n]*", "", text)


def functions_of(text: str) -> list[tuple[int, int]]:
    """First line and last line of each outermost block of braces that is no namespace and no type."""
    found, blocks, line, head = [], [], 1, ""
    for sign in without_texts(text):
        line += sign == "\n"
        if sign == "{":
            is_scope = re.search(r"\b(?:namespace|struct|class|enum|union)\b[^()]*$", head) is not None
            blocks.append((line, is_scope or bool(re.search(r"[=\w]\s*$", head) and "(" not in head)))
        elif sign == "}":
            first, is_scope = blocks.pop()
            if not is_scope and all(scope for _, scope in blocks):
                found.append((first, line))
        head = "" if sign in "{};" else head + sign
    return found


def length_errors(root: Path) -> list[str]:
    """C++ files above 300 and functions above 60 lines without a comment "Over ... lines: " that says why."""
    errors = []
    for path in sorted(p for p in (root / "cpp").rglob("*") if p.suffix in {".cpp", ".hpp"}):
        text = path.read_text(encoding="utf-8")
        lines = text.splitlines()
        where = path.relative_to(root).as_posix()
        if len(lines) > 300 and not any(line.startswith("// Over 300 lines: ") for line in lines[:5]):
            errors.append(f"{where}: {len(lines)} lines")
        for first, last in functions_of(text):
            # The comment may stand above the function, whose declaration may be of several lines.
            excused = any(
                line.lstrip().startswith("// Over 60 lines: ") for line in lines[max(0, first - 7) : last]
            )
            if last - first - 1 > 60 and not excused:
                errors.append(f"{where}:{first}: a function of {last - first - 1} lines")
    return errors


def test_no_function_above_60_and_no_file_above_300_lines() -> None:
    assert length_errors(ROOT) == []


def test_no_thread_keeps_memory_of_its_own() -> None:
    """Such memory is hidden state. In a thread of Python's, ThreadSanitizer takes its end for a data race."""
    found = [
        str(path.relative_to(ROOT))
        for folder in ("cpp", "bindings")
        for path in sorted((ROOT / folder).rglob("*.?pp"))
        if "thread_local" in path.read_text(encoding="utf-8")
    ]
    assert not found


def test_names_in_the_core_are_no_prepositions() -> None:
    """A variable is called by what it is: `of` says nothing."""
    named = re.compile(r"^[^/\"\n]*[\w>&*\]] of(?: [=:]|[;,)\[{(])", re.MULTILINE)
    files = [path for path in CPP_FILES if "tests" not in path.relative_to(ROOT).parts]
    found = [path.name for path in files if named.search(path.read_text(encoding="utf-8"))]
    assert found == []


def test_length_check_itself(tmp_path: Path) -> None:
    folder = tmp_path / "cpp/src"
    folder.mkdir(parents=True)
    body = "    step();\n"
    (folder / "long_function.cpp").write_text("void a() {\n" + 61 * body + "}\n")
    (folder / "long_list_of_arguments.cpp").write_text("void a(int x,\n       int y) {\n" + 61 * body + "}\n")
    (folder / "long_member.cpp").write_text("struct A {\n    void a() {\n" + 61 * body + "    }\n};\n")
    (folder / "long_after_test.cpp").write_text("int a() try {\n" + 61 * "    if (b) { c(); }\n" + "}\n")
    (folder / "excused.cpp").write_text("// Over 60 lines: a table.\nvoid a() {\n" + 61 * body + "}\n")
    (folder / "short.cpp").write_text("namespace a {\n" + 20 * "void b() {\n    c('{', \"{\");\n}\n" + "}\n")
    (folder / "table.cpp").write_text("constexpr int a[] = {\n" + 61 * "    1,\n" + "};\n")
    (folder / "long_file.cpp").write_text(101 * "void a() {\n    step();\n}\n")
    assert length_errors(tmp_path) == [
        "cpp/src/long_after_test.cpp:1: a function of 61 lines",
        "cpp/src/long_file.cpp: 303 lines",
        "cpp/src/long_function.cpp:1: a function of 61 lines",
        "cpp/src/long_list_of_arguments.cpp:2: a function of 61 lines",
        "cpp/src/long_member.cpp:2: a function of 61 lines",
    ]
