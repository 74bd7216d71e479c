"""The command line: results on stdout, the rest on stderr, errors that name the argument."""

from __future__ import annotations

import errno
import json
import os
import re
import shlex
import signal
import sqlite3
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest
from birm3d import Result, Simulation, Study, load, units
from birm3d.cli.commands import COMMANDS

SEDAN = [
    "run",
    "--vehicle",
    "passenger_car",
    "--gvw",
    "1719kg",
    "--speed",
    "57.09km/h",
    "--mesh-density",
    "0.3",
]


LINUX = pytest.mark.skipif(
    sys.platform != "linux", reason="/proc is a folder that not even root can write to"
)


def test_run_prints_a_table(command, capsys):
    assert command(*SEDAN) == 0
    out, err = capsys.readouterr()
    assert "dynamic crush" in out
    assert "1,719 kg" in out
    assert err == ""


def test_python_m_birm3d_is_the_command() -> None:
    def run(*words: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, "-m", "birm3d", *words], capture_output=True, text=True, check=False
        )

    told = run("--help")
    assert told.returncode == 0
    assert told.stdout.startswith("Usage: python -m birm3d [OPTIONS] COMMAND")
    assert all(f"\n  {name} " in told.stdout for name in COMMANDS)
    wrong = run("run", "--vehicle", "no_such_vehicle", "--speed", "10m/s")
    assert (wrong.returncode, wrong.stdout) == (2, "")
    assert "no_such_vehicle" in wrong.stderr


def test_run_as_json_with_files(command, capsys, tmp_path):
    figure, table = tmp_path / "crash.png", tmp_path / "crash.csv"
    assert command(*SEDAN, "--json", "--report", "--plot", str(figure), "--csv", str(table)) == 0
    out, err = capsys.readouterr()
    outcome = json.loads(out)
    assert outcome["mass"] == pytest.approx(1719.0)
    assert outcome["impact_speed"] == pytest.approx(57.09 / 3.6)
    # The walk of one value: the speed of the command line is the speed of the first row.
    assert table.read_text().splitlines()[1].split(",")[4] == str(outcome["impact_speed"])
    assert 0.6 < outcome["metrics"]["dynamic_crush"] < 0.8
    assert figure.stat().st_size > 10_000
    assert "left out" in err


def test_run_with_result_page_and_movie(monkeypatch, command, capsys, tmp_path):
    animate = Result.animate  # smaller and shorter
    monkeypatch.setattr(Result, "animate", lambda self, path: animate(self, path, frames=3, size=(160, 90)))
    kept, page, movie = (tmp_path / name for name in ("crash.npz", "crash.html", "crash.gif"))
    files = ["--save", str(kept), "--html", str(page), "--movie", str(movie)]
    assert command(*SEDAN, "--json", *files) == 0
    out, err = capsys.readouterr()
    assert load(kept).metrics == json.loads(out)["metrics"]
    assert page.read_text(encoding="utf-8").endswith("</html>\n")
    assert movie.read_bytes().startswith(b"GIF89a")
    assert [line.split(":")[0] for line in err.splitlines()] == ["result", "page", "movie"]


@pytest.mark.parametrize(
    ("option", "name", "message"),
    [
        ("--plot", "crash.xyz", "--plot must end in .png, "),
        ("--plot", "crash", "--plot must end in .png, "),
        ("--csv", "crash.npz", "--csv must end in .csv, "),
        ("--save", "crash.csv", "--save must end in .npz, "),
        ("--html", "crash.png", "--html must end in .html or .htm, "),
        ("--movie", "crash.mpg", "--movie must end in .mp4, "),
        ("--plot", "none/crash.png", "--plot must be in a folder that exists, "),
        ("--csv", "folder.csv", "--csv must be a file, got the folder "),
        pytest.param(
            "--save", "/proc/crash.npz", "--save must be in a folder that can be written to, ", marks=LINUX
        ),
        pytest.param(
            "--html", "/proc/crash.html", "--html must be in a folder that can be written to, ", marks=LINUX
        ),
        pytest.param(
            "--movie", "/proc/crash.gif", "--movie must be in a folder that can be written to, ", marks=LINUX
        ),
    ],
)
def test_files_that_can_not_be_written_are_told_before_the_run(
    monkeypatch, command, capsys, tmp_path, option, name, message
):
    def run(self):
        raise AssertionError("it ran")

    monkeypatch.setattr(Simulation, "run", run)
    (tmp_path / "folder.csv").mkdir()
    assert command(*SEDAN, option, str(tmp_path / name)) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith(f"birm3d: {message}")
    assert str(tmp_path / name) in err
    assert err.count("\n") == 1


def test_one_file_for_two_outputs_is_refused(command, capsys, tmp_path):
    page = str(tmp_path / "x.csv.txt")
    table = ["--csv", page, "--vary", "impact_speed=5"]
    assert command(*SWEEP, *table, "--store", page) == 2
    assert "--store must be another file than --csv" in capsys.readouterr().err


def test_a_disk_that_fills_is_one_line(monkeypatch, command, capsys, tmp_path):
    def full(self, path):
        raise OSError(errno.ENOSPC, "No space left on device", str(path))

    monkeypatch.setattr(Result, "save", full)
    kept = tmp_path / "crash.npz"
    assert command(*SEDAN, "--json", "--save", str(kept)) == 1
    assert capsys.readouterr().err == f"birm3d: {kept}: No space left on device\n"


def test_a_duration_that_can_not_be_held_is_one_line(command, capsys):
    assert command(*SEDAN, "--duration", "100000s") == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("birm3d: output_interval must be >= duration / 2e+06 = 0.05 s")
    assert err.count("\n") == 1
    few = ["--duration", "0.2s", "--output-interval", "1ms"]
    assert command(*SEDAN, *few, "--csv", "/dev/null") == 0


def test_missing_extra_is_one_line(monkeypatch, command, capsys, tmp_path):
    monkeypatch.setitem(sys.modules, "pyvista", None)
    assert command(*SEDAN, "--movie", str(tmp_path / "crash.gif")) == 2
    assert capsys.readouterr().err == "birm3d: 3-D pictures need pyvista: pip install 'birm3d[render]'\n"


def test_vehicles(command, capsys):
    assert command("vehicles", "--json") == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts["passenger_car"]["mass"] == pytest.approx(1814.37)
    assert "bumper" in facts["pickup"]["zones"]
    sizes = {name: facts["passenger_car"][name] for name in ("length", "width", "height")}
    assert sizes == pytest.approx({"length": 4.896, "width": 1.837, "height": 1.445}, abs=2e-3)
    assert facts["semi_truck"]["wheelbase"] == pytest.approx(18.455, abs=1e-9)
    assert command("vehicles") == 0
    out = capsys.readouterr().out
    assert "paper_pickup" in out
    assert "mass [kg]" in out
    assert "wheelbase" in out
    assert "4.266" in out  # the pickup's
    assert "zones of pickup: engine" in out


@pytest.mark.parametrize(
    ("arguments", "parts"),
    [
        (["--vehicle", "pickup"], ["--speed", "missing"]),
        (["--vehicle", "pikcup", "--speed", "5m/s"], ["preset", "pickup", "'pikcup'"]),
        (["--vehicle", "pickup", "--speed", "5 knots"], ["speed", "mph", "5 knots"]),
        (["--vehicle", "pickup", "--speed", "30"], ["speed", "m/s, mm/s, km/h, kmh, kph, mph, ft/s", "'30'"]),
        (["--vehicle", "pickup", "--speed", "-3m/s"], ["impact_speed", ">= 0", "-3"]),
        (["--vehicle", "pickup", "--speed", "5m/s", "--angle", "190"], ["impact_angle", "180", "190"]),
        (["--vehicle", "pickup", "--speed", "5m/s", "--friction", "-1"], ["friction", ">= 0", "-1"]),
        (["--vehicle", "pickup", "--speed", "5m/s", "--barrier", "none"], ["duration", "no barrier"]),
        (["--vehicle", "missing.toml", "--speed", "5m/s"], ["missing.toml", "can not be read"]),
        (
            ["--vehicle", "pickup", "--speed", "15m/s", "--time-step", "0.2"],
            ["time_step", "critical step", "0.2"],
        ),
    ],
)
def test_errors_say_what_is_wrong(command, capsys, arguments, parts):
    assert command("run", *arguments) == 2
    out, err = capsys.readouterr()
    assert out == ""
    for part in parts:
        assert part in err


SCENE = """
[vehicle]
preset = "passenger_car"
gvw = "4500 lb"
mesh_density = 0.3

[barrier]
kind = "rigid_wall"
friction = 0.0

[impact]
speed = "30 mph"
angle = "45 deg"
"""


def scene_file(folder: Path, text: str) -> str:
    path = folder / "scene.toml"
    path.write_text(text)
    return str(path)


def test_scene_file(command, capsys, tmp_path):
    assert command("run", scene_file(tmp_path, SCENE), "--json") == 0
    outcome = json.loads(capsys.readouterr().out)
    assert outcome["impact_angle"] == 45.0
    assert outcome["mass"] == pytest.approx(4500 * 0.45359237)


def test_a_pole_from_file_and_from_options(command, capsys, tmp_path):
    text = SCENE.replace('"rigid_wall"', '"pole"\ndiameter_m = 0.4').replace("45 deg", "90 deg")
    assert command("run", scene_file(tmp_path, text), "--json") == 0
    by_file = json.loads(capsys.readouterr().out)
    arguments = (
        "--vehicle",
        "passenger_car",
        "--gvw",
        "4500lb",
        "--mesh-density",
        "0.3",
        "--barrier",
        "pole",
    )
    options = ("--diameter", "0.4m", "--friction", "0", "--speed", "30mph")
    assert command("run", *arguments, *options, "--json") == 0
    by_options = json.loads(capsys.readouterr().out)
    assert by_file["state_hash"] == by_options["state_hash"]
    assert by_file["metrics"]["dynamic_crush"] > 0.3


def test_the_example_scene_is_read(command, capsys):
    example = Path(__file__).parents[2] / "examples" / "scene.toml"
    assert command("run", str(example), "--json") == 0
    assert json.loads(capsys.readouterr().out)["end_reason"] == "separated"


@pytest.mark.parametrize(
    ("wrong", "line", "parts"),
    [
        (("friction", "fricton"), 9, ["fricton", "unknown key"]),
        (("0.0", "-0.5"), 9, ["friction", "greater than or equal to 0", "-0.5"]),
        (('"30 mph"', "30"), 12, ["speed", "string", "30"]),
        (('"45 deg"', '"45 m"'), 13, ["angle", "deg", "45 m"]),
        (('preset = "passenger_car"', ""), 2, ["preset or file"]),
        (("[barrier]", "[barrier"), 7, ["TOML"]),
        (('"rigid_wall"', '"pole"\nwidth_m = 2.0'), 9, ["width_m", "rigid_wall", "pole"]),
    ],
)
def test_scene_file_errors(command, capsys, tmp_path, wrong, line, parts):
    path = scene_file(tmp_path, SCENE.replace(*wrong, 1))
    assert command("run", path) == 2
    err = capsys.readouterr().err
    for part in parts:
        assert part in err
    assert f"{path}:{line}:" in err or f"line {line}" in err


def test_options_beside_a_scene_file_are_refused(command, capsys, tmp_path):
    assert command("run", scene_file(tmp_path, SCENE), "--speed", "5m/s") == 2
    assert "--speed" in capsys.readouterr().err


SWEEP = ["sweep", "--vehicle", "passenger_car", "--mesh-density", "0.1"]


def test_sweep_prints_a_table(command, capsys, tmp_path):
    table = tmp_path / "runs.csv"
    vary = ["--vary", "impact_speed=20mph,30mph", "--vary", "impact_angle=20:40:10deg"]
    files = ["--csv", str(table), "--store", str(tmp_path / "runs.db"), "--jobs", "2"]
    assert command(*SWEEP, *vary, *files) == 0
    out, err = capsys.readouterr()
    assert "6 runs" in out
    assert "crush" in out
    assert err == f"runs: {table}\n"
    study = Study.load(table)
    assert study["impact_speed"] == pytest.approx(np.repeat([8.9408, 13.4112], 3))
    assert study["impact_angle"].tolist() == [20.0, 30.0, 40.0] * 2
    assert study.grid is not None
    # The same command once more takes all runs from the store.
    assert command(*SWEEP, *vary, *files) == 0
    assert capsys.readouterr().out == out


def test_sweep_of_a_scene_file_as_json(command, capsys, tmp_path):
    path = scene_file(tmp_path, SCENE)
    vary = ["--vary", "barrier.friction=0, 0.2", "--vary", "settings.contact_model=projected"]
    assert command("sweep", path, *vary, "--metrics", "dynamic_crush,exit_angle", "--json") == 0
    outcome = json.loads(capsys.readouterr().out)
    assert outcome["units"]["exit_angle"] == "deg"
    assert outcome["runs"]["barrier.friction"] == [0.0, 0.2]
    assert command("run", path, "--json") == 0
    by_hand = json.loads(capsys.readouterr().out)
    assert outcome["runs"]["dynamic_crush"][0] == by_hand["metrics"]["dynamic_crush"]
    assert outcome["runs"]["state_hash"][0] == by_hand["state_hash"]


def test_tables_of_sweeps_are_in_units_of_practice(command, capsys, tmp_path):
    table = tmp_path / "runs.csv"
    names = "peak_deceleration_cfc60,peak_normal_force_cfc60"
    vary = ["--vary", "impact_speed=9m/s,10m/s", "--metrics", names]
    assert command(*SWEEP, *vary, "--csv", str(table)) == 0
    printed = " ".join(capsys.readouterr().out.split())
    study = Study.load(table)
    assert dict(study.units)["peak_normal_force_cfc60"] == "N", "files are in SI"
    assert "[g]" in printed
    assert "[kN]" in printed
    assert "9.00 to 10.00 m/s" in printed
    for deceleration, force in zip(*(study[name] for name in names.split(",")), strict=True):
        assert f"{deceleration / units.g:,.4g}" in printed
        assert f"{force / 1e3:,.4g}" in printed
    random = ["--vary", "impact_speed=uniform(9m/s, 10m/s)", "--random", "4", "--metrics", names]
    assert command(*SWEEP, "--speed", "20mph", *random) == 0
    printed = capsys.readouterr().out
    assert "[g]" in printed
    assert "m/s^2" not in printed


def test_random_sweep(command, capsys):
    vary = [
        *SWEEP,
        "--speed",
        "20mph",
        "--vary",
        "impact_speed=normal(20mph, 1mph)",
        "--vary",
        "vehicle.gvw=lognormal(4000lb, 0.1)",
    ]
    arguments = [*vary, "--vary", "impact_angle=uniform(60, 90)", "--random", "40"]
    assert command(*arguments, "--seed", "3", "--json") == 0
    outcome = json.loads(capsys.readouterr().out)
    speeds = np.array(outcome["runs"]["impact_speed"])
    assert len(speeds) == outcome["summary"]["dynamic_crush"]["n"] == 40
    assert abs(speeds.mean() - 20 * units.mph) < 3.5 * units.mph / np.sqrt(40)
    assert 60.0 < min(outcome["runs"]["impact_angle"]) < max(outcome["runs"]["impact_angle"]) < 90.0
    assert np.median(outcome["runs"]["vehicle.gvw"]) == pytest.approx(4000 * units.lb, rel=0.1)
    assert command(*arguments) == 0
    assert "standard deviation" in capsys.readouterr().out


def test_failed_runs_of_a_sweep_are_told(command, capsys):
    assert command(*SWEEP, "--vary", "impact_speed=9m/s,-3m/s", "--metrics", "delta_v") == 0
    out, err = capsys.readouterr()
    assert "failed" in out
    assert "1 of 2 runs failed; run 1: ValueError: impact_speed must be" in err


@pytest.mark.parametrize(
    ("arguments", "parts"),
    [
        ([], ["--vary"]),
        (["--vary", "impact_speed"], ["--vary", "NAME=VALUES", "impact_speed"]),
        (["--vary", "impact_speed="], ["impact_speed", "empty"]),
        (["--vary", "impact_sped=5"], ["--speed is missing"]),
        (["--speed", "5m/s", "--vary", "impact_sped=5"], ["impact_speed", "'impact_sped'"]),
        (["--vary", "impact_speed=5kg"], ["speed", "mph", "5kg"]),
        (["--vary", "impact_speed=20,30"], ["impact_speed", "mph", "'20'"]),
        (["--vary", "impact_speed=5:1:1m/s"], ["impact_speed", "step", "5:1:1m/s"]),
        (["--vary", "impact_speed=1:5m/s"], ["impact_speed", "FIRST:LAST:STEP", "1:5m/s"]),
        (["--vary", "impact_speed=5m/s", "--metrics", "crush"], ["metrics", "dynamic_crush", "'crush'"]),
        (
            ["--vary", "impact_speed=5", "--random", "3", "--speed", "5m/s"],
            ["impact_speed", "normal(", "'5'"],
        ),
        (
            ["--vary", "impact_speed=normal(5m/s, 1m/s)", "--random", "0", "--speed", "5m/s"],
            ["n must be", "0"],
        ),
    ],
)
def test_sweep_errors_say_what_is_wrong(command, capsys, arguments, parts):
    assert command(*SWEEP, *arguments) == 2
    out, err = capsys.readouterr()
    assert out == ""
    for part in parts:
        assert part in err


def test_a_stopped_sweep_without_a_store_keeps_what_is_done(monkeypatch, command, capsys, tmp_path):
    monkeypatch.chdir(tmp_path)
    Path("birm3d-sweep.db").write_text("of another study")
    arguments = [*SWEEP, "--vary", "impact_speed=8:12:0.001m/s"]
    timer = threading.Timer(1.0, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    assert command(*arguments) == 130
    timer.join()
    told, advice = capsys.readouterr().err.strip().splitlines()
    done = int(
        re.fullmatch(r"stopped: (\d+) of 4001 runs are finished and kept in 'birm3d-sweep-2.db'", told)[1]
    )
    assert advice == f"go on with: birm3d {shlex.join(arguments)} --store birm3d-sweep-2.db"
    with sqlite3.connect("birm3d-sweep-2.db") as connection:
        assert connection.execute("SELECT count(*) FROM runs").fetchone() == (done,)
    connection.close()
    assert Path("birm3d-sweep.db").read_text() == "of another study"


def test_a_stopped_sweep_says_what_is_kept(command, capsys, tmp_path, interrupt_once_stored):
    store = tmp_path / "runs.db"
    interrupt_once_stored(store)
    vary = ["--vary", "impact_speed=8:20:0.001m/s", "--store", str(store)]
    assert command(*SWEEP, *vary) == 130
    err = capsys.readouterr().err
    assert "of 12001 runs are finished and kept in" in err
    assert f"go on with: {shlex.join(['birm3d', *SWEEP, *vary])}\n" in err
