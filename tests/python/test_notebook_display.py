"""What notebooks show: figures, results, studies and progress bars, in a fresh kernel without magics."""

from __future__ import annotations

import pickle
import re
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import birm3d
import nbformat
import numpy as np
import pytest
from birm3d import Barrier, Simulation, Vehicle, scenes
from birm3d.base.progress import in_notebook, progress_bar
from birm3d.calibration.profile import Profile
from birm3d.plotting.calibration import smooth_profile
from birm3d.study import Study
from birm3d.study.sobol import SobolIndices
from matplotlib.figure import Figure
from nbclient import NotebookClient
from scipy import stats


@pytest.fixture(scope="module")
def simulation() -> Simulation:
    return scenes.w2(16)


@pytest.fixture(scope="module")
def drawn(simulation: Simulation) -> Study:
    unknown = {"impact_speed": stats.norm(10.0, 1.0), "barrier.friction": stats.uniform(0.1, 0.2)}
    return birm3d.monte_carlo(simulation, unknown, n=40, seed=1)


class Cells(HTMLParser):
    """Texts of table cells, and how many images there are; refuses tags that do not close."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.cells: list[str] = []
        self.images = 0
        self.open: list[str] = []
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.images += tag == "img"
        if tag != "img":
            self.open.append(tag)
        if tag in ("td", "th"):
            self.cells.append("")

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if self.open and self.open[-1] in ("td", "th"):
            self.cells[-1] += data


# jupyter's own event loop and temporary sockets are not ours to mend.
@pytest.mark.filterwarnings("default")
def test_a_fresh_notebook() -> None:
    cells = [
        "import birm3d\nfrom birm3d import scenes\nresult = scenes.w2(16).run()\nresult.plot()",
        "result",
        "study = birm3d.sweep(scenes.w2(16), impact_speed=[5.0, 6.0, 7.0])",
        "study",
    ]
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(cell) for cell in cells])
    NotebookClient(notebook, timeout=120).execute()
    figure, result, bar, study = (cell.outputs for cell in notebook.cells)
    assert [set(out.data) for out in figure if "data" in out] == [{"image/png", "text/plain"}]
    assert "dynamic crush" in result[0].data["text/html"]
    assert "impact speed" in study[0].data["text/html"]
    text = "".join(str(out.get("text", "")) + str(out.get("data", "")) for out in bar)
    assert "sweep" in text
    assert "3/3" in text
    assert "Warning" not in text


def test_bars_in_terminals_and_files(capsys: pytest.CaptureFixture[str]) -> None:
    assert not in_notebook()
    with progress_bar(None, "quiet", 3) as advance:
        advance(3)
    assert capsys.readouterr() == ("", "")
    with progress_bar(True, "loud", 4, done=1) as advance:
        advance(3)
    out, err = capsys.readouterr()
    assert out == ""
    assert "loud" in err
    assert "4/4" in err


def test_result_card() -> None:
    car = Vehicle.preset("passenger_car", mesh_density=0.1)
    result = Simulation(car, Barrier.rigid_wall(), 15.0, 20.0).run()
    card = Cells(result._repr_html_())
    assert card.images == 1
    place = card.cells.index("exit angle from the barrier's line")
    assert card.cells[place + 1] == f"{result.metrics['exit_angle']:.1f} deg"
    assert "rigid wall without end" in result._repr_html_()


def test_study_card(drawn: Study) -> None:
    card = Cells(drawn._repr_html_())
    assert card.images == 1
    crush = drawn.summary()["dynamic_crush"]
    place = card.cells.index("dynamic crush (greatest of the skin) [m]")
    assert card.cells[place + 1] == f"{crush.mean:.4g}"
    force = card.cells.index("peak barrier force along the normal, CFC 60 [kN]")
    assert float(card.cells[force + 1]) == pytest.approx(
        drawn["peak_normal_force_cfc60"].mean() / 1e3, rel=1e-3
    )
    assert card.cells[card.cells.index("runs") + 1] == "40"
    assert drawn.outcomes == {"stopped": 40}
    assert card.cells[card.cells.index("stopped") + 1] == "40 (100%)"
    assert "rigid wall without end; friction varied" in drawn._repr_html_()


def test_figures_of_studies_name_their_scene(tmp_path: Path) -> None:
    heads = []
    unknown = {"vehicle.gvw": stats.norm(7000.0, 10.0)}
    posts = Simulation(scenes.elastic_block(150), Barrier.bollards(count=3, spacing=0.8), 5.0)
    kept: Any = {"metrics": ["dynamic_crush"], "progress": False}
    swept = birm3d.sweep(posts, impact_speed=[4.0, 5.0], **kept)
    swept.save(tmp_path / "study.csv")
    for study in (swept, Study.load(tmp_path / "study.csv"), pickle.loads(pickle.dumps(swept))):
        heads.append(study.plot("impact_speed", "dynamic_crush").axes[0].get_title())
    heads.append(birm3d.fragility(posts, [4.0, 5.0], unknown, 2, progress=False).plot().axes[0].get_title())
    indices = birm3d.sobol(posts, unknown, n=2, **kept)
    drawn = birm3d.monte_carlo(posts, unknown, 8, **kept)
    figures = (indices.plot(), drawn.plot("vehicle.gvw", "dynamic_crush"))
    heads += [figure.get_suptitle() for figure in figures]
    point = birm3d.critical_impact_point(
        posts, "dynamic_crush", {"impact_speed": (4.0, 5.0)}, points=3, max_runs=4
    )
    heads.append(point.plot().axes[0].get_title())
    bands = birm3d.history_bands(swept, ["travel"], progress=False)
    heads.append(bands.plot().get_suptitle())
    mass, row = (
        posts.scene.vehicle.mass,
        "3 bollards, Ø 0.32 m, 1 m high, 0.8 m between axes \\(0.48 m clear\\)",
    )
    for i, head in enumerate(re.sub(r"[\n\u00a0]", " ", head) for head in heads):
        if i == 1:  # of a file, which has no scene
            assert re.match(f"Laboratory block: {row}", head)
            continue
        kg = r"[67],\d+ to 7,0\d\d" if i in (3, 4, 5) else f"{mass:,.0f}"
        speed = r"5.00 m/s \(11.2 mph\)" if i in (4, 5) else r"4.00 to 5.00 m/s \(8.9 to 11.2 mph\)"
        assert re.match(rf"Laboratory block, {kg} kg, {speed} at 90°: {row}", head), head
    assert (
        birm3d.sweep(posts, {"barrier": [Barrier.pole()]}, **kept).title
        == "Laboratory block: several barriers"
    )
    vehicles = birm3d.sweep(posts, vehicle=[scenes.elastic_block(150)], impact_angle=[60.0, 90.0], **kept)
    assert vehicles.scene_title.startswith("several vehicles, 5.00 m/s (11.2 mph) at 60 to 90°: 3 bollards")
    assert birm3d.sweep(posts, {"barrier.count": [3]}, **kept).title.endswith(
        "0.8 m between axes (0.48 m clear); count varied"
    )


def test_drawn_runs_are_a_scatter_with_marginals(drawn: Study, simulation: Simulation) -> None:
    axes, top, right = (drawn.plot("impact_speed", "peak_normal_force_cfc60").axes[i] for i in (2, 0, 3))
    (points,) = axes.get_lines()
    assert points.get_linestyle() == "None"
    assert np.array_equal(points.get_ydata(), drawn["peak_normal_force_cfc60"] / 1e3)
    assert axes.get_ylabel().endswith("[kN]")
    assert sum(patch.get_height() for patch in top.patches) == 40
    assert sum(patch.get_width() for patch in right.patches) == 40
    medians = [line.get_xdata()[0] for line in top.get_lines()]  # type: ignore[index]
    assert medians == pytest.approx(np.quantile(drawn["impact_speed"], [0.05, 0.5, 0.95]))
    grid = birm3d.sweep(simulation, impact_speed=[5.0, 6.0], metrics=["dynamic_crush"])
    (axes,) = grid.plot("impact_speed", "dynamic_crush").axes
    assert axes.get_lines()[0].get_linestyle() == "-"


def test_sobol_bars(simulation: Simulation) -> None:
    unknown = {"impact_speed": stats.norm(10.0, 1.0), "barrier.friction": stats.uniform(0.1, 0.2)}
    found = birm3d.sobol(simulation, unknown, n=8, metrics=["dynamic_crush", "max_displacement", "end_time"])
    figure = found.plot(["dynamic_crush"])
    (axes,) = figure.axes
    widths = [bar.get_width() for bar in axes.patches]
    index = found.metrics["dynamic_crush"]
    assert widths == pytest.approx([*index.first, *index.total])
    assert [text.get_text() for text in axes.get_yticklabels()] == ["impact speed", "friction at the barrier"]
    assert isinstance(found, SobolIndices)
    assert "<img" in found._repr_html_()
    with pytest.raises(ValueError, match="metrics must have indices, got 'max_yaw'"):
        found.plot(["max_yaw"])


@pytest.mark.parametrize(
    "ranges", [{"impact_offset": (-0.6, 0.6)}, {"impact_offset": (-0.6, 0.6), "impact_speed": (5.0, 6.0)}]
)
def test_critical_point_figure(ranges: dict[str, tuple[float, float]]) -> None:
    car = Vehicle.preset("passenger_car", mesh_density=0.05)
    found = birm3d.critical_impact_point(
        Simulation(car, Barrier.pole(), 6.0), "dynamic_crush", ranges, points=3, max_runs=6
    )
    figure = found.plot()
    axes = figure.axes[0]
    star = next(line for line in axes.get_lines() if line.get_label() == "critical point")
    assert star.get_xdata()[0] == found.point["impact_offset"]  # type: ignore[index]
    second = found.value if len(ranges) == 1 else found.point["impact_speed"]
    assert star.get_ydata()[0] == pytest.approx(second)  # type: ignore[index]
    assert axes.get_xlabel() == "impact offset [m]"
    assert isinstance(figure, Figure)


def test_profiles_are_smooth_and_go_through_what_was_computed() -> None:
    """Of a parabola with few points: through all of them, nowhere beyond, and a parabola between them."""
    values = np.array([0.0, 0.4, 1.0, 1.5, 2.2])
    profile = Profile("k", values, values[:, None], (values - 1.0) ** 2, 1.0, None, None)
    x, rise = smooth_profile(profile)
    assert (x[0], x[-1]) == (0.0, 2.2)
    assert len(x) >= 200
    assert rise[np.isin(x, values)] == pytest.approx(profile.rise, abs=1e-12)
    assert np.abs(rise - (x - 1.0) ** 2).max() < 1e-9


def test_cards_of_what_a_scene_is_made_of() -> None:
    car, posts = Vehicle.preset("passenger_car", mesh_density=0.05), Barrier.bollards(heading=10.0)
    card = Cells(car._repr_html_()).cells
    assert card[card.index("mass") + 1] == f"{car.mass:,.0f} kg"
    sizes = f"{car.length:.2f} x {car.width:.2f} x {car.height:.2f} m"
    assert card[card.index("length x width x height") + 1] == sizes
    card = Cells(posts._repr_html_()).cells
    assert card[card.index("kind") + 1] == "bollards"
    assert card[card.index("spacing (axis to axis)") + 1] == "1.2 m"
    assert card[card.index("heading") + 1] == "10°"
    impact = Simulation(car, posts, "50 km/h", 60.0, 0.25, duration="200 ms", impact_yaw=5.0)
    card = Cells(impact._repr_html_()).cells
    assert card[card.index("speed") + 1] == "13.89 m/s (50.0 km/h, 31.1 mph)"
    assert card[card.index("angle") + 1] == "60°"
    assert card[card.index("offset") + 1] == "0.25 m"
    assert card[card.index("yaw") + 1] == "5°"
    assert card[card.index("duration") + 1] == "0.2 s"
    assert {"passenger_car", "bollards"} <= set(card)


def test_cards_of_all_kinds() -> None:
    for barrier in (
        *(Barrier.rigid_wall(), Barrier.pole(), Barrier.planter(), Barrier.jersey()),
        Barrier.jersey(length=12.0, segments=4, free_standing=True),
    ):
        card = Cells(barrier._repr_html_()).cells
        assert card[card.index("kind") + 1] == barrier.title
    assert card[card.index("free standing") + 1] == "yes"
    semi = Vehicle.preset("semi_truck", mesh_density=0.05)
    assert any("semi_trailer" in cell for cell in Cells(semi._repr_html_()).cells)
    alone = Cells(Simulation(semi, None, 10.0, duration=0.1)._repr_html_()).cells
    assert "angle" not in alone
