"""Run the notebooks of designers' questions and write them with what they show.

python notebooks/execute.py
"""

from __future__ import annotations

from pathlib import Path

import nbformat
from nbclient import NotebookClient

HERE = Path(__file__).resolve().parent
QUESTIONS = ("plaza_perimeter", "bridge_parapet", "storefront", "own_test")
"""Notebooks that are kept with their outputs, to be read without running them."""


def executed(path: Path) -> nbformat.NotebookNode:
    """Return a notebook with the outputs of a fresh kernel, without traces of when it ran."""
    notebook = nbformat.read(path, as_version=4)
    NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(path.parent)}}).execute()
    for cell in notebook.cells:
        cell.metadata = {}
    return notebook


if __name__ == "__main__":
    for name in QUESTIONS:
        file = HERE / f"{name}.ipynb"
        nbformat.write(executed(file), file)
        print(f"written: {file}")
