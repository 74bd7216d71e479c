"""Several runs in one figure, and bands of histories."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import birm3d
import numpy as np
import pytest
from birm3d import Barrier, Result, Simulation, Study, Vehicle
from birm3d.study.history_bands import HistoryBands
from scipy import stats


@pytest.fixture(scope="module")
def car() -> Vehicle:
    return Vehicle.preset("passenger_car", mesh_density=0.1)


@pytest.fixture(scope="module")
def runs(car: Vehicle) -> list[Result]:
    return [Simulation(car, Barrier.rigid_wall(), speed).run() for speed in (8.0, 12.0)]


@pytest.fixture(scope="module")
def drawn(car: Vehicle) -> Study:
    unknown = {"impact_speed": stats.norm(10.0, 1.0), "zone.bumper.scale": stats.norm(1.0, 0.1)}
    return birm3d.monte_carlo(Simulation(car, Barrier.rigid_wall(), 10.0), unknown, n=20, progress=False)


def test_curves_are_those_of_the_runs(runs: list[Result]) -> None:
    figure = birm3d.plot_runs(runs, ["travel", "velocity"])
    travel, velocity = figure.axes
    for line, result in zip(travel.get_lines(), runs, strict=True):
        assert line.get_ydata() == pytest.approx(result.position[:, 0] - result.position[0, 0])
    assert velocity.get_ylabel() == "velocity [m/s]"
    assert velocity.get_lines()[1].get_ydata()[0] == pytest.approx(12.0)  # type: ignore[index]


def test_title_has_what_is_common_and_legend_what_differs(runs: list[Result], car: Vehicle) -> None:
    figure = birm3d.plot_runs(runs)
    title = figure.get_suptitle().replace("\xa0", " ")  # numbers keep their units
    assert title.startswith(f"Passenger car, {car.mass:,.0f} kg, 90°\nrigid wall")
    assert "m/s" not in title
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert [label.split()[0] for label in labels] == ["8.00", "12.00"]
    twice = birm3d.plot_runs([runs[0], runs[0]])
    assert [text.get_text() for text in twice.legends[0].get_texts()] == ["run 1", "run 2"]
    post = Simulation(car, Barrier.pole(), 8.0).run()
    others = birm3d.plot_runs([runs[0], post], labels=["wall", "pole"])
    labels = [text.get_text() for text in others.legends[0].get_texts()]
    assert labels[0] == "wall: rigid wall without end"
    assert labels[1].startswith("pole: pole, Ø")
    named = birm3d.plot_runs(runs, labels=["slow", "fast"])
    assert [text.get_text() for text in named.legends[0].get_texts()] == ["slow", "fast"]


def test_wrong_runs(runs: list[Result]) -> None:
    with pytest.raises(ValueError, match="results must be 1 to 8 runs, got 0"):
        birm3d.plot_runs([])
    with pytest.raises(ValueError, match=r"channels must be among deceleration, .*; got 'speed'"):
        birm3d.plot_runs(runs, ["speed"])
    with pytest.raises(ValueError, match="labels must be 2, one for each run, got 1"):
        birm3d.plot_runs(runs, labels=["one"])


def test_bands_are_quantiles_of_runs_made_by_hand(drawn: Study) -> None:
    bands = birm3d.history_bands(drawn, ["travel"], progress=False)
    rows = np.array([40, 300])
    travels = []
    for row in range(len(drawn)):
        result = drawn.simulation(row).run()
        assert result.time[rows[-1]] == pytest.approx(bands.time[rows[-1]])
        travels.append(result.position[rows, 0] - result.position[0, 0])
    # Of 20 runs the 10 % quantile by Hazen's rule lies midway between the second and the third.
    ordered = np.sort(travels, axis=0)
    assert bands.low["travel"][rows] == pytest.approx(0.5 * (ordered[1] + ordered[2]))
    assert bands.median["travel"][rows] == pytest.approx(0.5 * (ordered[9] + ordered[10]))
    assert bands.high["travel"][rows] == pytest.approx(0.5 * (ordered[17] + ordered[18]))


def test_bands_last_as_long_as_the_longest_run(drawn: Study) -> None:
    bands = birm3d.history_bands(drawn, progress=False)
    assert bands.time[-1] == pytest.approx(drawn["end_time"].max(), abs=2e-4)
    assert bands.n == 20
    assert set(bands.median) == {"deceleration", "travel"}
    assert np.isfinite(bands.high["deceleration"]).all()
    figure = bands.plot()
    mass = drawn._scene.vehicle.mass  # type: ignore[union-attr]
    head = f"Passenger car, {mass:,.0f}\N{NO-BREAK SPACE}kg, {drawn['impact_speed'].min():.2f} to "
    assert figure.get_suptitle().startswith(head)
    assert "at 90°: rigid wall without end" in figure.get_suptitle().replace("\n", " ")
    assert figure.axes[1].get_ylabel() == "travel [m]"
    assert "travel_high" in bands.to_dataframe().columns
    assert "<img" in bands._repr_html_()


def test_a_figure_of_bands_ends_where_they_get_calm() -> None:
    """One run that slides on for seconds must not press the crash into the first tenth of the figure."""
    time = np.linspace(0.0, 5.0, 501)
    pulse = 90.0 * np.exp(-(((time - 0.1) / 0.05) ** 2))
    runs = {"deceleration": np.array([pulse, 1.1 * pulse]), "travel": np.array([15.0 * time, 18.0 * time])}
    figure = HistoryBands(time, runs, 0.8, "two runs").plot()
    for axes in figure.axes:
        assert 150.0 < axes.get_xlim()[1] < 400.0
        assert axes.get_xlabel() == "time [ms]; calm until the run ends at 5,000 ms"
    assert figure.axes[1].get_ylim()[1] < 10.0


def test_bands_of_a_prediction(car: Vehicle) -> None:
    found = birm3d.predict(Simulation(car, Barrier.rigid_wall(), 10.0), n=8, progress=False)
    bands = birm3d.history_bands(found, ["travel"], progress=False)
    greatest = np.quantile(bands.runs["travel"].max(axis=1), 0.5, method="hazen")
    assert greatest == pytest.approx(found.median["max_displacement"], rel=1e-3)


def test_wrong_studies(drawn: Study, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="share must be > 0 and < 1, got 2"):
        birm3d.history_bands(drawn, share=2.0)
    drawn.save(tmp_path / "study.csv")
    with pytest.raises(ValueError, match="base must be the simulation that was varied"):
        birm3d.history_bands(Study.load(tmp_path / "study.csv"))


def test_command_line(
    command: Callable[..., int], capsys: pytest.CaptureFixture[str], tmp_path: Path, runs: list[Result]
) -> None:
    def call(*arguments: str) -> tuple[str, str]:
        assert command(*arguments) == 0
        return capsys.readouterr()

    for name, result in zip(("slow", "fast"), runs, strict=True):
        result.save(tmp_path / f"{name}.npz")
    files = [str(tmp_path / name) for name in ("slow.npz", "fast.npz")]
    out, _ = call("overlay", *files, "--plot", str(tmp_path / "runs.png"), "--channel", "travel")
    assert "slow" in out
    assert "dynamic crush" in out
    assert (tmp_path / "runs.png").read_bytes().startswith(b"\x89PNG")
    scene = ("--vehicle", "passenger_car", "--mesh-density", "0.1", "--speed", "8 m/s")
    _, err = call("run", *scene, "--load-map", str(tmp_path / "map.csv"))
    assert "load map" in err
    assert (tmp_path / "map.csv").read_text(encoding="utf-8").startswith("lateral from [m]")
    call("run", *scene, "--load-map", str(tmp_path / "map.png"))
    assert (tmp_path / "map.png").read_bytes().startswith(b"\x89PNG")
    _, err = call("predict", *scene, "--draws", "8", "--bands", str(tmp_path / "bands.png"))
    assert "bands:" in err
    assert (tmp_path / "bands.png").read_bytes().startswith(b"\x89PNG")
