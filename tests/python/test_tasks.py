"""The page of designers' tasks: every block runs by itself in an empty folder, in at most five lines."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import numpy as np
import pytest
from birm3d import Vehicle

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs/pages/tasks.md"
TASKS = re.findall(r"^## (\d+\. .+?)$(.*?)(?=^## |\Z)", PAGE.read_text(encoding="utf-8"), re.S | re.M)
BLOCK = re.compile(r"^```python\n(.*?)^```$", re.S | re.M)
MOST_LINES, WIDTH = 5, 110
# Task -> what it must leave behind: files, and words that it prints.
EXPECTED = {
    "1": (["first.png"], "shell nodes"),
    "2": (["two.png"], ""),
    "3": ([], "bollard 3"),
    "4": (["angles.png"], ""),
    "5": ([], "gap"),
    "6": (["loads.csv"], "bollard 3"),
    "7": ([], "M50"),
    "8": ([], "OIV"),
    "9": ([], "scatter.front"),
    "10": (["bands.png"], "."),
    "11": (["crash.gif", "dossier"], ""),
    "12": (["crush.png", "van.png"], "truck"),
}


def number(title: str) -> str:
    return title.split(".")[0]


def code_lines(block: str) -> list[str]:
    """Lines that are not empty and no comment; the import counts."""
    return [line for line in block.splitlines() if line.strip() and not line.lstrip().startswith("#")]


def test_there_are_twelve() -> None:
    assert [number(title) for title, _ in TASKS] == [str(i) for i in range(1, 13)]
    assert set(EXPECTED) == {number(title) for title, _ in TASKS}


@pytest.mark.parametrize(("title", "text"), TASKS, ids=[number(title) for title, _ in TASKS])
def test_a_task_takes_five_plain_lines(title: str, text: str) -> None:
    blocks = BLOCK.findall(text)
    assert blocks, title
    for block in blocks:
        assert block.startswith("import birm3d\n"), "a block runs by itself"
        lines = code_lines(block)
        assert len(lines) <= MOST_LINES, f"{title}: {len(lines)} lines"
        assert not any(";" in line.split("#")[0] or len(line) > WIDTH for line in lines), "plain lines"


@pytest.mark.parametrize(("title", "text"), TASKS, ids=[number(title) for title, _ in TASKS])
def test_a_task_runs(
    title: str,
    text: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    files, word = EXPECTED[number(title)]
    if "pulse.csv" in text:
        shutil.copy(ROOT / "examples/nhtsa_10146.csv", tmp_path / "pulse.csv")
    if "van.stl" in text:
        write_mesh(tmp_path / "van.stl")
    before = set(tmp_path.iterdir())
    monkeypatch.chdir(tmp_path)
    for block in BLOCK.findall(text):
        exec(compile(block, f"{PAGE.name}: {title}", "exec"), {})
    printed = capsys.readouterr().out
    assert word in printed
    assert "nan" not in re.findall(r"[a-z]+", printed.lower())
    assert {path.name for path in set(tmp_path.iterdir()) - before} == set(files)


def write_mesh(path: Path) -> None:
    """Write the skin of a preset in millimetres, as a user has a mesh of a vehicle."""
    trimesh = pytest.importorskip("trimesh", reason="no trimesh to write a mesh with: pip install '.[mesh]'")
    van = Vehicle.preset("van_3500")
    triangles = np.vstack([van.quads[:, [0, 1, 2]], van.quads[:, [0, 2, 3]]])
    trimesh.Trimesh(1e3 * van.nodes, triangles).export(path)
