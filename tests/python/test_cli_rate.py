"""The command line: ratings and occupant risk."""

from __future__ import annotations

import json

import pytest

TRUCK = [
    *("--vehicle", "cargo_truck", "--speed", "50mph", "--barrier", "bollards", "--count", "3"),
    *("--mesh-density", "0.3"),
]


def test_rate(command, capsys) -> None:
    assert command("rate", *TRUCK, "--standard", "ASTM F2656", "--standard", "SD-STD-02.01") == 0
    out, err = capsys.readouterr()
    assert "ASTM F2656, indicative: M50-P1 (vehicle M)" in out
    assert "SD-STD-02.01, indicative: K12-L3" in out
    assert "Caution: " in out
    assert err == ""


def test_run_with_ratings_as_json(command, capsys) -> None:
    arguments = ["run", *TRUCK, "--rate", "ASTM F2656", "--occupant-risk", "--json"]
    assert command(*arguments) == 0
    found = json.loads(capsys.readouterr().out)
    (rating,) = found["ratings"]
    assert rating["designation"] == "M50-P1"
    assert rating["contained"] is True
    assert found["occupant_risk"]["oiv_x"] > 10.0
    assert "dynamic_crush" in found["metrics"]


@pytest.mark.parametrize("first", ["run", "rate"])
def test_a_standard_that_does_not_know_the_vehicle_leaves_the_rest(command, capsys, tmp_path, first) -> None:
    option, plot = ("--rate" if first == "run" else "--standard"), tmp_path / "run.png"
    more = ["--plot", str(plot)] if first == "run" else []
    assert command(first, *TRUCK, option, "PAS 68", option, "ASTM F2656", *more) == 0
    out, err = capsys.readouterr()
    assert "ASTM F2656, indicative: M50-P1" in out
    assert "no rating by PAS 68: vehicle must be one that PAS 68 knows" in err
    assert plot.exists() == bool(more)
    assert command(first, *TRUCK, option, "PAS 68", "--occupant-risk", *more, "--json") == 2
    out, err = capsys.readouterr()
    found = json.loads(out)
    assert list(found["not_rated"]) == ["PAS 68"]
    assert "ratings" not in found
    assert "oiv_x" in found["occupant_risk"]
    assert ("metrics" in found) == (first == "run")
    assert "no rating by PAS 68" in err


def test_of_a_scene_file_and_a_result(command, capsys, tmp_path) -> None:
    scene, result = tmp_path / "scene.toml", tmp_path / "r.npz"
    scene.write_text(
        '[vehicle]\npreset = "cargo_truck"\nmesh_density = 0.3\n[barrier]\nkind = "bollards"\ncount = 3\n'
        '[impact]\nspeed = "50 mph"\n',
        encoding="utf-8",
    )
    assert command("run", str(scene), "--save", str(result), "--rate", "PAS 68") == 2
    assert "vehicle must be one that PAS 68 knows" in capsys.readouterr().err
    assert command("run", str(scene), "--save", str(result)) == 0
    capsys.readouterr()
    texts = []
    for file in (scene, result):
        arguments = ["rate", str(file), "--standard", "PAS 68", "--vehicle-class", "N2", "--occupant-risk"]
        assert command(*arguments) == 0
        texts.append(capsys.readouterr().out)
    assert texts[0] == texts[1]
    assert "no rating: mass" in texts[0]
    assert "OIV, longitudinal (MASH)" in texts[0]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--standard", "BS 5400"], "standard must be one of ASTM F2656"),
        (["--standard", "MASH"], "vehicle must be one that MASH knows"),
        (
            ["--standard", "ASTM F2656", "--reference-point", "1,b,2"],
            "--reference-point must be a name or x,y,z",
        ),
        (["--standard", "ASTM F2656", "--reference-point", "antenna"], "reference_point must be one of"),
        ([], "Missing option '--standard'"),
    ],
)
def test_errors_say_what_is_wrong(command, capsys, arguments, message) -> None:
    assert command("rate", *TRUCK, *arguments) == 2
    assert message in capsys.readouterr().err


def test_options_beside_a_result_are_refused(command, capsys, tmp_path) -> None:
    result = tmp_path / "r.npz"
    assert command("run", *TRUCK, "--save", str(result)) == 0
    assert command("rate", str(result), "--speed", "30mph", "--standard", "ASTM F2656") == 2
    assert "--speed must not be given beside a result" in capsys.readouterr().err
    point = ["--reference-point", "-1.7,1.2,1.0", "--standard", "ASTM F2656", "--json"]
    assert command("rate", str(result), *point) == 0
    assert json.loads(capsys.readouterr().out)["ratings"][0]["designation"] == "M50-P1"


def test_vehicles_of_the_class(command, capsys) -> None:
    """Probabilities, bands of occupant risk and of design loads from the command line."""
    assert command("rate", *TRUCK, "--standard", "ASTM F2656", "--occupant-risk", "--draws", "8") == 0
    out = capsys.readouterr().out
    assert "ASTM F2656, indicative: probability of each class" in out
    assert "occupant risk of 8 runs" in out
    assert command("loads", *TRUCK, "--draws", "8") == 0
    assert "80 % band over 8 vehicles of the class" in capsys.readouterr().out


@pytest.mark.filterwarnings("always::birm3d.LeaningPostWarning", "ignore::birm3d.CoreContactWarning")
def test_rows_of_a_study_that_is_not_shown_are_not_named(command, capsys) -> None:
    van = ["--vehicle", "van_3500", "--mesh-density", "0.3", "--speed", "22.35m/s"]
    tubes = ["--barrier", "bollards", "--diameter", "0.273", "--height", "0.7", "--wall-thickness", "16mm"]
    assert command("rate", *van, *tubes, "--standard", "IWA 14-1", "--draws", "8") == 0
    warning = capsys.readouterr().err
    assert "posts throw the vehicle" in warning
    assert "(row " not in warning
    assert " of the runs)" in warning
