"""Names of earlier versions go on working, and the warning says what to write."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import birm3d
import numpy as np
import numpy.typing as npt
import pytest
from birm3d import Barrier, Simulation, Vehicle, scene_parameters
from birm3d.result.skin import Skin
from birm3d.scene.codec import decode, encode
from birm3d.study.sobol import SobolDesign, SobolIndices
from birm3d.vehicle.vehicle_file import VehicleFileError

CAR = Vehicle.preset("passenger_car", mesh_density=0.05)
SIMULATION = Simulation(CAR, Barrier.pole(), impact_speed=10.0)

OLD = {
    "[indentation]": "[dents]",
    "length_m = 0.65": "reach_m = 0.65",
    "indentation_length_m": "dent_reach_m",
}
"""Keys of today -> those of earlier versions, as they stand in a saved vehicle."""


def old_text(vehicle: Vehicle, folder: Path) -> str:
    """Return a saved vehicle as an earlier version wrote it."""
    vehicle.save(folder / "today.toml")
    text = (folder / "today.toml").read_text(encoding="utf-8")
    for today, old in OLD.items():
        text = text.replace(today, old)
    return text


@pytest.mark.parametrize(
    ("use", "message"),
    [
        (lambda: CAR.dent_reach, "dent_reach has a new name: write indentation_length"),
        (
            lambda: CAR.with_dent_reach(dent_reach="400 mm").indentation_length,
            "with_dent_reach() has a new name: write with_indentation_length()",
        ),
        (
            lambda: birm3d.vehicle.build(CAR.recipe.each(dent_reach=0.4)).indentation_length,
            "dent_reach has a new name: write indentation_length",
        ),
        (
            lambda: scene_parameters.value_of(SIMULATION, "vehicle.dent_reach"),
            "vehicle.dent_reach has a new name: write vehicle.indentation_length",
        ),
        (
            lambda: (
                scene_parameters.varied(
                    SIMULATION, {"vehicle.dent_reach": 0.4}
                ).scene.vehicle.indentation_length
            ),
            "vehicle.dent_reach has a new name: write vehicle.indentation_length",
        ),
    ],
)
def test_the_length_of_indentations_by_its_old_name(use: Callable[[], float], message: str) -> None:
    with pytest.warns(DeprecationWarning, match=f"^{re.escape(message)}$") as told:
        found = use()
    assert found in (0.65, 0.4)
    assert told[0].filename == __file__  # it points at the caller
    assert scene_parameters.unit_of("vehicle.dent_reach") == "m"


@pytest.mark.parametrize("change", [lambda v: v, lambda v: v.with_indentation_length(0.4)])
def test_a_vehicle_file_of_an_earlier_version(change: Callable[[Vehicle], Vehicle], tmp_path: Path) -> None:
    vehicle = change(CAR)
    path = tmp_path / "old.toml"
    path.write_text(old_text(vehicle, tmp_path), encoding="utf-8")
    lines = path.read_text(encoding="utf-8").split("\n")
    block = lines.index("[dents]")
    length = next(i for i in range(block, len(lines)) if lines[i].startswith("reach_m"))
    message = f"write indentation for dents (line {block + 1}), "
    message += f"indentation.length_m for indentation.reach_m (line {length + 1})"
    if vehicle is not CAR:
        changed = next(i for i, line in enumerate(lines) if line.startswith("dent_reach_m"))
        message += f", changes.indentation_length_m for changes.dent_reach_m (line {changed + 1})"
    with pytest.warns(
        DeprecationWarning, match=f"^{re.escape(f'{path}: keys have new names: {message}')}$"
    ) as told:
        assert Vehicle.from_file(path) == vehicle
    assert told[0].filename == __file__


def test_an_old_block_takes_the_place_of_the_block_that_its_file_extends(tmp_path: Path) -> None:
    path = tmp_path / "own.toml"
    block = 'reach_m = 0.3\nsource = ["indentation-length"]\nstatus = "estimated"\n'
    path.write_text(f'extends = "passenger_car"\n[dents]\n{block}', encoding="utf-8")
    with pytest.warns(DeprecationWarning, match="write indentation"):
        assert Vehicle.from_file(path, mesh_density=0.05).indentation_length == 0.3
    wrong = path.read_text(encoding="utf-8").replace("0.3", "-0.3")
    path.write_text(wrong, encoding="utf-8")
    with (
        pytest.warns(DeprecationWarning, match="write indentation"),
        pytest.raises(VehicleFileError, match=r"own\.toml:3: indentation\.length_m: must be"),
    ):
        Vehicle.from_file(path)
    path.write_text(
        wrong.replace("-0.3", "0.3") + f"[indentation]\n{block.replace('reach_m', 'length_m')}",
        encoding="utf-8",
    )
    with pytest.raises(VehicleFileError, match="dents: unknown key"):
        Vehicle.from_file(path)


def test_a_file_of_two_units_of_an_earlier_version(tmp_path: Path) -> None:
    semi = Vehicle.preset("semi_truck", mesh_density=0.05)
    path = tmp_path / "old.toml"
    text = old_text(semi, tmp_path).replace("[unit.indentation]", "[unit.dents]")
    assert text.count("[unit.dents]") == 2
    path.write_text(text, encoding="utf-8")
    with pytest.warns(
        DeprecationWarning, match=r"old\.toml: keys have new names: write indentation for dents"
    ):
        assert Vehicle.from_file(path) == semi


def renamed(plain: Any) -> Any:
    """Return an encoded scene with the names that earlier versions gave to fields."""
    old = {"indentation_length": "dent_reach", "indentation": "dents", "length_m": "reach_m"}
    if isinstance(plain, list):
        return [renamed(item) for item in plain]
    if not isinstance(plain, dict):
        return plain
    if "$Vehicle" in plain or "$VehicleFile" in plain:
        ((kind, fields),) = plain.items()
        fields = {old.get(key, key): renamed(value) for key, value in fields.items()}
        if isinstance(block := fields.get("dents"), dict):
            (block,) = block.values()
            fields["dents"] = {"$mapping": {old.get(key, key): value for key, value in block.items()}}
        return {kind: fields}
    return {key: renamed(value) for key, value in plain.items()}


@pytest.mark.parametrize("name", ["passenger_car", "semi_truck", "paper_pickup"])
def test_a_scene_in_a_result_of_an_earlier_version(name: str) -> None:
    scene = Simulation(
        Vehicle.preset(name, mesh_density=0.05).with_indentation_length(0.4), Barrier.pole(), impact_speed=9.0
    ).scene
    arrays: dict[str, npt.NDArray[np.generic]] = {}
    plain = renamed(encode(scene, arrays, "scene"))
    assert '"dent_reach"' in (text := repr(plain).replace("'", '"'))
    assert '"indentation' not in text.replace('"indentation-length"', "")
    assert decode(plain, arrays) == scene  # a warning would be an error: a user can not rewrite a result


def test_parts_of_results_by_their_old_names() -> None:
    skin = Skin(*(np.full((3, 3), float(k)) for k in range(4)))
    indices = SobolIndices(
        SobolDesign({}, 2), birm3d.sweep(SIMULATION, impact_speed=[5.0]), {}, {"delta_v": "constant"}
    )
    for part, old, new in ((skin, "turn", "rotation"), (indices, "left_out", "omitted")):
        with pytest.warns(DeprecationWarning, match=f"^{old} has a new name: write {new}$") as told:
            assert getattr(part, old) is getattr(part, new)
        assert told[0].filename == __file__
    assert indices.omitted == {"delta_v": "constant"}
