"""The architecture page: which files a new part touches, and what the files of the contact layer are for."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
FILES = [
    path
    for folder in ("python/birm3d", "cpp", "bindings")
    for path in sorted((ROOT / folder).rglob("*"))
    if path.suffix in (".py", ".cpp", ".hpp")
]

EXAMPLES = {
    "a kind of barrier": (
        r"\b[Pp]lanter\b",
        [
            "python/birm3d/barrier/barrier.py",
            "python/birm3d/barrier/kinds.py",
            "python/birm3d/barrier/planter.py",
        ],
    ),
    "a term of the truss law": (
        r"with_tail|tail_depth|tail_slope",
        [
            "python/birm3d/vehicle/zone.py",
            "cpp/include/birm3d/model/truss_law.hpp",
            "cpp/src/model/truss_law.cpp",
            "bindings/laws.cpp",
        ],
    ),
    "a metric": (r"\bmax_roll\b", ["python/birm3d/result/metric_table.py"]),
}


@pytest.mark.parametrize("part", EXAMPLES)
def test_a_part_is_named_in_few_files(part: str) -> None:
    name, expected = EXAMPLES[part]
    found = [
        path.relative_to(ROOT).as_posix()
        for path in FILES
        if re.search(name, path.read_text(encoding="utf-8"))
    ]
    assert found == expected
    page = (ROOT / "docs/pages/architecture.md").read_text(encoding="utf-8")
    section = page.split(f"### {part[0].upper()}{part[1:]}\n")[1].split("\n### ")[0]
    for file in expected:
        assert f"(../../{file}" in section


def test_each_file_of_the_contact_layer_is_on_the_architecture_page() -> None:
    page = (ROOT / "docs/pages/architecture.md").read_text(encoding="utf-8")
    files = sorted(path.name for path in (ROOT / "cpp/src/contact").glob("*.cpp"))
    assert files
    assert [name for name in files if f"(../../cpp/src/contact/{name}" not in page] == []
