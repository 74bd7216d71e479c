"""Reference of the public C++ headers: declarations with their comments, read by a parser of C++."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import tree_sitter_cpp
from mkdocs.structure.files import File
from tree_sitter import Language, Node, Parser

INCLUDE = Path(__file__).resolve().parents[2] / "cpp/include"
PAGE = "reference/cpp.md"
SHOWN = {
    *("struct_specifier", "class_specifier", "enum_specifier", "declaration", "function_definition"),
    *("alias_declaration", "template_declaration", "type_definition"),
}
HEAD = """# C++ reference

Headers that `cmake --install` puts into `include/birm3d`, in the order of the layers. Everything is in the
namespace `birm3d`. [`main.cpp`](../../../examples/cpp/main.cpp) is a whole program; see
[Use the C++ library](../how-to/cpp.md). Lengths are in m, forces in N, angles in rad unless stated.
"""
# The layers, lowest first, as tests/python/test_style.py holds them; others come last.
LAYERS = (
    *("base", "geometry", "model", "state", "kernels", "scene", "contact", "step", "control", "record"),
    *("simulation", "ensemble"),
)


def text_of(node: Node) -> str:
    """Return the source text of a node."""
    assert node.text is not None
    return node.text.decode("utf-8")


def comment_of(lines: list[str]) -> str:
    """Return comment lines as text; indented lines stay as they are, as code."""
    out: list[str] = []
    inside = False
    for line in (re.sub(r"^// ?", "", line) for line in lines):
        indented = line.startswith("  ") and line.strip() != ""
        if indented != inside and (indented or line.strip()):
            out.append("```text" if indented else "```")
            inside = indented
        out.append(line if inside else re.sub(r"([*_<>\[\]])", r"\\\1", line))
    if inside:
        out.append("```")
    return "\n".join(_apart(out))


def _apart(lines: list[str]) -> Iterator[str]:
    """Fences of code have an empty line before and after them."""
    for line in lines:
        if line == "```text":
            yield ""
        yield line
        if line == "```":
            yield ""


def declarations(node: Node) -> Iterator[tuple[list[str], Node]]:
    """Yield each declaration of a scope with the comment lines right above it."""
    comments: list[str] = []
    last_line = -1
    for child in node.named_children:
        if child.type == "comment":
            if child.start_point[0] > last_line + 1:
                comments = []
            comments.append(text_of(child))
            last_line = child.end_point[0]
            continue
        if child.type in {"namespace_definition", "linkage_specification"}:
            body = child.child_by_field_name("body")
            if body is not None:
                yield from declarations(body)
        elif child.type in SHOWN:
            yield (comments if last_line == child.start_point[0] - 1 else []), child
        comments = []
        last_line = child.end_point[0]


def head_of(node: Node) -> str:
    """Return the declaration without the bodies of functions and without private members."""
    text = text_of(node)
    start = node.start_byte
    cuts: list[tuple[int, int]] = []

    def walk(part: Node) -> None:
        if part.type == "function_definition":
            body = part.child_by_field_name("body")
            if body is not None:
                first = next((c for c in part.children if c.type == "field_initializer_list"), body)
                cuts.append((first.start_byte - start, body.end_byte - start))
                return
        for child in part.children:
            walk(child)

    walk(node)
    raw = text.encode("utf-8")
    for first, last in sorted(cuts, reverse=True):
        raw = raw[:first].rstrip() + b";" + raw[last:]
    shown = raw.decode("utf-8")
    shown = re.sub(r"\n\s*private:.*?(?=\n\s*(?:public:|\};?$|\}$))", "", shown, flags=re.DOTALL)
    return shown


def reference(include: Path = INCLUDE) -> str:
    """Return the page."""
    parser = Parser(Language(tree_sitter_cpp.language()))
    folder = include / "birm3d"
    parts = [HEAD]
    layers = sorted(p.name for p in folder.iterdir() if p.is_dir())
    for layer in sorted(layers, key=lambda name: LAYERS.index(name) if name in LAYERS else len(LAYERS)):
        headers = sorted((folder / layer).glob("*.hpp"))
        if headers:
            parts.append(f"## {layer}")
        for path in headers:
            source = path.read_text(encoding="utf-8")
            name = path.relative_to(include).as_posix()
            lines = source.splitlines()
            top = next((i for i, line in enumerate(lines) if not line.startswith("//")), len(lines))
            parts += [f"### `{name}`", comment_of(lines[:top])]
            root = parser.parse(source.encode("utf-8")).root_node
            for comments, node in declarations(root):
                if "template_instantiation" in node.type:
                    continue
                parts.append(comment_of(comments))
                parts.append(f"```cpp\n{head_of(node)}\n```")
    return "\n\n".join(part for part in parts if part) + "\n"


def on_files(files: Any, *, config: Any) -> Any:
    """Add the page."""
    files.append(File.generated(config, PAGE, content=reference()))
    return files
