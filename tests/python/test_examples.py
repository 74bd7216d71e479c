"""The examples run as a newcomer runs them, print something, and draw what they promise."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
# Script -> figures that it writes when asked, and a word of its table.
SCRIPTS = {
    "contact_models.py": (["contact_models.png"], "along_truss"),
    "fit_fronts.py": (["fit_fronts.png"], "in the file"),
    "fit_sedan_front.py": (["fit_sedan_front.png"], "in the file"),
    "fit_truck_front.py": (["fit_truck_front.png"], "in the file"),
    "fragility.py": (["fragility.png", "sweep.png"], "dynamic_crush > 0.7 m"),
    "free_standing_jersey.py": (
        ["free_standing_jersey.png", "free_standing_jersey_plan.png"],
        "loose, friction 0.5",
    ),
    "head_on_sedan.py": (["head_on_sedan.png", "head_on_sedan_overview.png"], "peak_normal_force_cfc60"),
    "oblique_car.py": (["oblique_car.png", "oblique_car_plan.png"], "redirected at"),
    "own_vehicle.py": (["own_vehicle.png"], "trolley"),
    "paper_table_2.py": (["paper_table_2.png"], "force / (m a)"),
    "tire_reactions.py": (["tire_reactions.png"], "statics"),
    "truck_on_wall_and_bollards.py": (["truck_on_wall_and_bollards.png"], "bollards, predicted"),
}


def run(script: str, *arguments: str, folder: Path) -> str:
    """Output of an example, run in `folder`; warnings are errors there too."""
    done = subprocess.run(
        [sys.executable, "-W", "error", EXAMPLES / script, *arguments],
        cwd=folder,
        env={**os.environ, "MPLCONFIGDIR": str(folder / "matplotlib")},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    return done.stdout


def test_every_example_is_tested() -> None:
    assert {path.name for path in EXAMPLES.glob("*.py")} == set(SCRIPTS)


@pytest.mark.parametrize("script", SCRIPTS)
def test_example_prints_and_draws(script: str, tmp_path: Path) -> None:
    figures, word = SCRIPTS[script]
    output = run(script, "--output", "made/figures", folder=tmp_path)
    assert word in output
    assert "nan" not in output.lower()
    written = sorted(path.name for path in (tmp_path / "made/figures").iterdir())
    assert written == figures
    for name in figures:
        assert (tmp_path / "made/figures" / name).read_bytes().startswith(b"\x89PNG")


def test_example_without_a_folder_writes_nothing(tmp_path: Path) -> None:
    assert "sum" in run("tire_reactions.py", "--duration", "0.2", folder=tmp_path)
    assert [path.name for path in tmp_path.iterdir() if path.name != "matplotlib"] == []


def test_table_2_closes_where_the_papers_does_not(tmp_path: Path) -> None:
    rows = [line.split() for line in run("paper_table_2.py", folder=tmp_path).splitlines()]
    table = [row for row in rows if len(row) == 8 and row[0].isdigit()]
    assert [row[0] for row in table] == ["20", "30", "40", "50", "60"]
    for row in table:
        assert abs(float(row[6]) - 1.0) > 0.03, "the paper's force over its m a"
        assert float(row[7]) == pytest.approx(1.0, abs=2e-9), "ours, printed with nine decimals"


def test_projection_keeps_the_energy_where_the_papers_rule_does_not(tmp_path: Path) -> None:
    rows = [line.split() for line in run("contact_models.py", folder=tmp_path).splitlines()]
    table = {
        row[0]: (float(row[1]), float(row[2])) for row in rows if row and row[0] in {"10", "24", "45", "66"}
    }
    assert len(table) == 4
    for projected, along_truss in table.values():
        assert abs(projected) < 0.01, "% at a tolerance of 1e-4"
        assert abs(along_truss) > 1.0
