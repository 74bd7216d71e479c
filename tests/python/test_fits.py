"""Every program that fits is on a page, and the corners' numbers are those of the least misfit."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import birm3d
import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "tests/validation"
sys.path[:0] = [str(FOLDER), str(ROOT / "tests/bench")]

import scan_corners  # noqa: E402
from scan_corners import CHOSEN, SCAN, misfit, read, with_numbers  # noqa: E402


def test_the_page_lists_every_program_that_fits() -> None:
    told = re.findall(r"`python (\S+\.py)", (FOLDER / "fits.md").read_text(encoding="utf-8"))
    fits = {
        path.relative_to(ROOT).as_posix()
        for folder in ("examples", "tests/bench", "tests/validation")
        for path in (ROOT / folder).glob("fit_*.py")
    }
    assert fits <= set(told)
    assert all((ROOT / path).is_file() for path in told)


def test_sources_that_the_page_names_are_in_vehicle_files() -> None:
    text = (FOLDER / "fits.md").read_text(encoding="utf-8").split("## Numbers set by hand")[1]
    files = "\n".join(
        path.read_text(encoding="utf-8") for path in (ROOT / "python/birm3d/data").glob("*.toml")
    )
    for source in re.findall(r"\| `([a-z0-9-]+)` \|", text):
        assert f'id = "{source}"' in files


def test_page_of_the_corners_is_what_its_table_says() -> None:
    assert (FOLDER / "corners.md").read_text(encoding="utf-8") == scan_corners.page(read())


@pytest.mark.parametrize("name", scan_corners.kind_small_overlap.VEHICLES)
def test_chosen_numbers_are_those_of_the_files(name: str) -> None:
    """The scan begins at the presets: its zones are theirs, but for rounding to three digits."""
    preset, scanned = birm3d.Vehicle.preset(name), with_numbers(name, CHOSEN)
    for zone in ("engine", "bumper", "engine_bay", "wheel_house.along"):
        assert np.array(scanned.zones[zone].envelope) == pytest.approx(
            np.array(preset.zones[zone].envelope), rel=5e-3
        )
    along = np.array(preset.zones["wheel_house.along"].envelope)[-1, 1]
    assert along / preset._file.zones_at_kg == pytest.approx(CHOSEN[scan_corners.ALONG], rel=5e-3)
    assert preset._file.zones[0].y_m == (0.0, 0.5 * CHOSEN[scan_corners.WIDTH])


@pytest.mark.parametrize("number", SCAN)
def test_chosen_numbers_have_the_least_misfit(number: str) -> None:
    rows = {row.value: row for row in read() if row.number == number}
    chosen = rows[CHOSEN[number]]
    assert chosen.together <= 1.01 * min(row.together for row in rows.values())
    assert chosen.within == chosen.rows == 36


def test_misfits_are_what_is_computed() -> None:
    kept = next(row for row in read() if (row.number, row.value) == (scan_corners.WIDTH, 0.5))
    found = misfit(kept.number, kept.value)
    for name in ("along", "across", "together"):
        assert getattr(found, name) == pytest.approx(getattr(kept, name), abs=0.03)
    assert abs(found.travel) < 0.005
