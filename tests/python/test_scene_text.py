"""Texts, pages and pictures of a run say how the vehicle is turned and aimed, where that is not head-on."""

from __future__ import annotations

import json
from pathlib import Path
from types import SimpleNamespace

import birm3d
import numpy as np
import pytest
from birm3d import Barrier, Result, Simulation, Vehicle
from birm3d.plotting.style import title
from birm3d.reporting.scene_part import scene_section
from birm3d.scene.text import pose_text, scene_text
from html_reader import Page
from matplotlib.figure import Figure

POSE = ", offset 0.25 m, yaw 90°, roll 3°"
TURNED = {"impact_offset": 0.25, "impact_yaw": 90.0, "impact_roll": 3.0}

# The skin is coarse to be quick; only words are looked at.
pytestmark = pytest.mark.filterwarnings("ignore::birm3d.CoarseSkinWarning")


@pytest.fixture(scope="module")
def car() -> Vehicle:
    return Vehicle.preset("passenger_car", mesh_density=0.2)


@pytest.fixture(scope="module")
def side_on(car: Vehicle) -> Result:
    return Simulation(car, Barrier.rigid_wall(width=2.0), 5.0, duration=0.1, **TURNED).run()


def one_line(figure: Figure) -> str:
    """The title of a figure, without its line breaks."""
    return figure.get_suptitle().replace("\n", " ").replace("\N{NO-BREAK SPACE}", " ")


def head_on(car: Vehicle, **given: float) -> Simulation:
    return Simulation(car, Barrier.rigid_wall(width=2.0), 5.0, duration=0.1, **given)


@pytest.mark.parametrize(
    ("given", "text"),
    [
        ({}, ""),
        ({"impact_yaw": -90.0}, ", yaw -90°"),
        ({"impact_roll": 4.5}, ", roll 4.5°"),
        ({"impact_offset": -0.4}, ", offset -0.4 m"),
        ({"overlap": 0.25}, ", 25 % overlap on the left"),
        (TURNED, POSE),
    ],
)
def test_only_what_was_given_is_said(car: Vehicle, given: dict[str, float], text: str) -> None:
    scene = head_on(car, **given).scene
    assert pose_text(scene) == text
    assert f" at 90°{text}: rigid wall" in scene_text(scene)
    assert repr(head_on(car, **given)).endswith(f" 90 deg{text})")


def test_a_vehicle_without_a_barrier_is_turned_too(car: Vehicle) -> None:
    alone = Simulation(car, None, 5.0, impact_yaw=20.0, duration=0.1).run()
    assert scene_text(alone.scene).endswith("5.00 m/s (11.2 mph), yaw 20°, no barrier")
    assert "(11.2 mph) without a barrier, yaw 20°\n" in alone.report()


def test_the_report_and_titles_have_the_pose(side_on: Result) -> None:
    assert f"at 90° to the line of the barrier{POSE}: rigid wall" in side_on.report()
    assert f"at 90°{POSE}\nrigid wall" in title(side_on)
    assert f"at 90°{POSE} rigid wall" in one_line(side_on.plot())


def test_the_page_has_the_pose(side_on: Result, tmp_path: Path) -> None:
    side_on.write_html(tmp_path / "run.html", frames=2, crush=False)
    page = Page((tmp_path / "run.html").read_text(encoding="utf-8"))
    assert POSE in page.texts["title"][0]
    cells = page.texts["td"]
    assert [cells[cells.index(name) + 1] for name in ("yaw", "roll")] == ["90°", "3°"]


def test_the_dossier_has_the_overlap_and_where_the_path_lies(car: Vehicle) -> None:
    simulation = head_on(car, overlap=0.25)
    rows = dict(scene_section(SimpleNamespace(result=simulation.run())).blocks[1].rows)
    at = f"{simulation.scene.path_offset:.4g} m along the barrier's line, 25 % overlap on the left"
    assert rows["impact offset"] == at


def test_design_loads_list_the_pose(car: Vehicle, side_on: Result) -> None:
    assert POSE in birm3d.design_load(side_on, draws=0).title
    several = birm3d.design_load(head_on(car, impact_yaw=90.0), offsets=[0.0, 0.25], draws=0)
    assert str(several.scenes[0]).endswith(", 90°, yaw 90°")
    assert str(several.scenes[1]).endswith(", 90°, offset 0.25 m, yaw 90°")
    assert several.to_dict()["scenes"][1]["impact_yaw"] == 90.0


def test_the_runs_of_a_figure_have_the_pose(car: Vehicle, side_on: Result) -> None:
    other = head_on(car, **{**TURNED, "impact_yaw": 180.0}).run()
    both = birm3d.plot_runs([side_on, other], ["travel"])
    assert "90°, offset 0.25 m, roll 3° rigid wall" in one_line(both)
    assert [text.get_text() for text in both.legends[0].get_texts()] == ["yaw 90°", "yaw 180°"]


def test_the_title_of_a_study_has_the_range_of_the_pose(car: Vehicle) -> None:
    study = birm3d.sweep(head_on(car, impact_roll=3.0), {"impact_yaw": np.array([0.0, 90.0])})
    assert " at 90°, yaw 0 to 90°, roll 3°: " in study.scene_title


def test_the_command_line_prints_the_pose(command, capsys) -> None:
    args = ["run", "--vehicle", "passenger_car", "--mesh-density", "0.2", "--speed", "5m/s", "--yaw", "90"]
    assert command(*args, "--duration", "50ms") == 0
    assert "yaw 90°" in capsys.readouterr().out
    assert command(*args, "--duration", "50ms", "--json") == 0
    assert json.loads(capsys.readouterr().out)["impact_yaw"] == 90.0
