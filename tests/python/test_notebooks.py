"""Every notebook runs from top to bottom; those of designers' questions are kept with what they show."""

from __future__ import annotations

import sys
from pathlib import Path

import nbformat
import pytest

FOLDER = Path(__file__).resolve().parents[2] / "notebooks"
sys.path.insert(0, str(FOLDER))
from execute import QUESTIONS, executed  # noqa: E402

sys.path.remove(str(FOLDER))

NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))
STRIPPED = [path for path in NOTEBOOKS if path.stem not in QUESTIONS]
SHOWN = [FOLDER / f"{name}.ipynb" for name in QUESTIONS]


def test_there_are_notebooks() -> None:
    assert NOTEBOOKS


@pytest.mark.parametrize("path", STRIPPED, ids=lambda path: path.stem)
def test_outputs_are_stripped(path: Path) -> None:
    for cell in nbformat.read(path, as_version=4).cells:
        if cell.cell_type == "code":
            assert cell.outputs == []
            assert cell.execution_count is None


@pytest.mark.parametrize("path", SHOWN, ids=lambda path: path.stem)
def test_questions_are_kept_with_what_they_show(path: Path) -> None:
    """`python notebooks/execute.py` writes them: each cell shows something, in order, and none an error."""
    cells = [cell for cell in nbformat.read(path, as_version=4).cells if cell.cell_type == "code"]
    assert [cell.execution_count for cell in cells] == list(range(1, len(cells) + 1))
    for cell in cells:
        assert cell.outputs, cell.source
        assert all(out.output_type != "error" for out in cell.outputs)
    pictures = [out for cell in cells for out in cell.outputs if "image/png" in out.get("data", {})]
    assert pictures
    text = path.read_text(encoding="utf-8")
    assert str(FOLDER) not in text
    assert len(text) < 1_500_000


# jupyter's own event loop and temporary sockets are not ours to mend.
@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_runs(path: Path) -> None:
    printed = [out for cell in executed(path).cells if cell.cell_type == "code" for out in cell.outputs]
    assert any(out.output_type == "stream" for out in printed)
    assert not any("Warning" in str(out.get("text", "")) for out in printed)
