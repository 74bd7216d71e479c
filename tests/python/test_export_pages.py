"""The pages on meshes, exports and barriers: their blocks run as they stand, one after the other."""

from __future__ import annotations

import json
import re
import shlex
from collections.abc import Callable
from pathlib import Path

import pytest
import trimesh
from birm3d import Vehicle, units
from keyword_decks import car_parts, skin_of, write_deck

PAGES = Path(__file__).resolve().parents[2] / "docs/pages/how-to"
BLOCK = re.compile(r"^```(python|sh)\n(.*?)^```$", re.S | re.M)


def run_page(name: str, command: Callable[..., int]) -> None:
    names: dict[str, object] = {}
    for kind, block in BLOCK.findall((PAGES / name).read_text(encoding="utf-8")):
        if kind == "python":
            exec(compile(block, name, "exec"), names)
            continue
        for line in block.splitlines():
            program, *words = shlex.split(line)
            assert program == "birm3d"
            assert command(*words) == 0


def test_mesh_page_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, command: Callable[..., int]) -> None:
    monkeypatch.chdir(tmp_path)
    write_deck(tmp_path / "car.k", car_parts())
    places, triangles = skin_of(Vehicle.preset("passenger_car"))
    trimesh.Trimesh(places / units.mm, triangles, process=False).export(tmp_path / "body.stl")
    run_page("mesh.md", command)
    assert Vehicle.from_file(tmp_path / "car.toml").mass == 1719.0
    assert (tmp_path / "understood.png").stat().st_size > 20_000


def test_export_page_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, command: Callable[..., int]
) -> None:
    monkeypatch.chdir(tmp_path)
    run_page("export.md", command)
    assert (tmp_path / "crash.glb").stat().st_size > 10_000
    assert len(list((tmp_path / "crash").glob("vehicle_*.vtp"))) == 101  # of the command line, the last one


def test_barrier_page_has_a_scene(
    tmp_path: Path, command: Callable[..., int], capsys: pytest.CaptureFixture[str]
) -> None:
    blocks = re.findall(
        r"^```toml\n(.*?)^```$", (PAGES / "barrier.md").read_text(encoding="utf-8"), re.S | re.M
    )
    assert len(blocks) == 2  # rigid bollards, and some that yield
    vehicle = '[vehicle]\npreset = "passenger_car"\nmesh_density = 0.05\n'
    impact = '[impact]\nspeed = "20 mph"\nduration = "20 ms"\n'
    for block in blocks:
        (tmp_path / "scene.toml").write_text(vehicle + impact + block, encoding="utf-8")
        assert command("run", tmp_path / "scene.toml", "--json") == 0
        assert "bollard 3" in [row["name"] for row in json.loads(capsys.readouterr().out)["elements"]]
