"""The program that compares bits: equal ones pass, a single other one is found."""

from __future__ import annotations

import csv
import importlib
import json
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest
from test_state_hashes import HASHES

PROGRAM = Path(__file__).resolve().parents[1] / "bench/bench_determinism.py"


@pytest.fixture
def program(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    monkeypatch.syspath_prepend(str(PROGRAM.parent))
    return importlib.import_module("bench_determinism")


def test_quick_choice_has_the_same_bits() -> None:
    """Alone, on one and two threads, backwards, and restored at three instants."""
    done = subprocess.run(
        [sys.executable, "-W", "error", PROGRAM, "--quick"],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    *scenes, verdict = done.stdout.splitlines()
    assert verdict == "the same bits"
    assert len(scenes) == 3
    for line in scenes:
        assert " 5 rows: " in line
        int(line.split(": ")[1], 16)  # one hash


@pytest.mark.parametrize("way", ["two threads", "restored"])
def test_one_other_bit_is_found(
    way: str, program: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    same = {"w2": "00", "car": "01"}
    found = {name: dict(same) for name in ("alone", "two threads", "restored")}
    monkeypatch.setattr(program, "run", lambda *_: json.dumps(found))
    assert program.main(["--quick"]) == 0
    found[way]["car"] = "11"
    assert program.main(["--quick"]) == 1
    text = capsys.readouterr().out
    assert "3 rows: 01 11" in text
    assert text.endswith("DIFFERENT in 1 scenes\n")


def test_a_build_that_fails_ends_the_program_with_its_words(program: ModuleType) -> None:
    with pytest.raises(SystemExit, match="no such file"):
        program.run([sys.executable, "-c", "raise SystemExit('no such file')"])


def test_the_table_of_all_builds_has_the_hashes_that_the_test_holds() -> None:
    """A change of physics or of a preset replaces both: the table and the constants."""
    with (PROGRAM.parent / "results/determinism/hashes.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len({row["build"] for row in rows}) >= 5
    wrong = {row["scene"]: row["hash"] for row in rows if HASHES[row["scene"]] != row["hash"]}
    assert not wrong, "run bench_determinism.py --save, or replace the constants"


def test_pages_say_how_many_rows_and_builds_the_table_has() -> None:
    with (PROGRAM.parent / "results/determinism/hashes.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    builds = {7: "seven", 8: "eight"}[len({row["build"] for row in rows})]
    readme = (PROGRAM.parents[2] / "README.md").read_text(encoding="utf-8")
    page = (PROGRAM.parent / "README.md").read_text(encoding="utf-8")
    assert f"the same state in all {len(rows)} runs of {builds} builds" in readme
    assert f"The table has {builds} builds" in page
    assert f"in all {len(rows)} rows" in page
