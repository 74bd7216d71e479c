"""Capsules: one file, run again to the same bits; what was changed, damaged or is newer is refused."""

from __future__ import annotations

import json
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import birm3d
import numpy as np
import pytest
from birm3d import Barrier, FreeStanding, Result, Settings, Simulation, Vehicle, scenes, units
from birm3d._source import installed_source, shortened
from birm3d.io.file_format import checksum
from birm3d.io.made_with import platform_facts

CAR = Vehicle.preset("passenger_car", mesh_density=0.15)
SOURCE = installed_source()


def preset() -> Simulation:
    return Simulation(CAR, Barrier.rigid_wall(friction=0.3, heading=20.0, origin=(1.0, 2.0, 0.0)), 15.0, 30.0)


def changed_zone() -> Simulation:
    car = CAR.with_gvw(1500.0).with_zone("bumper", k_unloading=3e8)
    return Simulation(car, Barrier.pole(diameter=0.3), 12.0, impact_offset=0.2)


def articulated() -> Simulation:
    semi = Vehicle.preset("semi_truck", mesh_density=0.1)
    return Simulation(semi, Barrier.jersey(), 20.0, 20.0, duration=0.2)


def free_standing() -> Simulation:
    barrier = Barrier.jersey(length=15.0, segments=5, free_standing=FreeStanding(joint="loose"))
    return Simulation(CAR, barrier, 25.0, 20.0, duration=0.3)


def mesh() -> Simulation:
    corners = [[0.0, y, z] for y in (-2.0, 2.0) for z in (0.0, 1.0)]
    corners += [[0.5, y, z] for y in (-2.0, 2.0) for z in (0.0, 1.0)]
    faces = [
        [0, 1, 2], [1, 3, 2], [4, 6, 5], [5, 6, 7], [0, 4, 1], [1, 4, 5],
        [2, 3, 6], [3, 7, 6], [0, 2, 4], [2, 6, 4], [1, 5, 3], [3, 5, 7],
    ]  # fmt: skip
    return Simulation(CAR, Barrier.from_mesh(corners, faces), 14.0)


def planter() -> Simulation:
    return Simulation(CAR, Barrier.planter(), 12.0)


def every_setting() -> Simulation:
    settings = Settings(
        time_step=2e-5, output_interval=2e-4, gravity=9.7, mu_tire=0.5, mu_body=0.3, mu_tire_barrier=0.4,
        braking=0.7, cornering_stiffness=8.0, restitution=0.2, contact_model="along_truss", tire_model="skid",
    )  # fmt: skip
    posts = Barrier.bollards(count=3, spacing=1.1, rows=2, row_spacing=1.5)
    return Simulation(CAR, posts, 10.0, 80.0, 0.3, standoff=0.1, impact_yaw=5.0, impact_roll=2.0,
                      duration=0.1, settings=settings)  # fmt: skip


def arrays() -> Simulation:
    block = scenes.laboratory_block(16, k_initial=3e6, knee=0.4, k_hardening=6e6, k_unloading=6e7)
    return Simulation(block, Barrier.rigid_wall(), 10.0, settings=Settings(ground=False, gravity=0.0))


def no_barrier() -> Simulation:
    return Simulation(CAR, None, 10.0, duration=0.05)


KINDS = [preset, changed_zone, articulated, free_standing, mesh, planter, every_setting, arrays, no_barrier]


@pytest.mark.filterwarnings("ignore::UserWarning")  # of the paper's force law, and of a coarse skin
@pytest.mark.parametrize("make", KINDS)
def test_runs_again_to_the_same_bits(make: Callable[[], Simulation], tmp_path: Path) -> None:
    result = make().run()
    result.capsule(tmp_path / "crash.birm3d")
    again = birm3d.rerun(tmp_path / "crash.birm3d")
    assert again.same
    assert again.expected_hash == again.found_hash == result.state_hash
    assert again.differences == {}
    for name in ("position", "velocity", "barrier_force", "nodes"):
        assert getattr(again.result, name).tobytes() == getattr(result, name).tobytes(), name
    loaded = birm3d.load(tmp_path / "crash.birm3d")
    assert loaded.scene == result.scene
    assert loaded.report() == result.report()


@pytest.fixture(scope="module")
def result() -> Result:
    return preset().run()


@pytest.fixture
def path(result: Result, tmp_path: Path) -> Path:
    birm3d.write_capsule(result, tmp_path / "crash.birm3d")
    return tmp_path / "crash.birm3d"


def members(path: Path) -> dict[str, bytes]:
    with zipfile.ZipFile(path) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def test_a_stranger_can_open_it(path: Path, result: Result, tmp_path: Path) -> None:
    found = members(path)
    manifest = json.loads(found["manifest.json"])
    assert manifest["format_version"] == 1
    assert manifest["state_hash"] == f"{result.state_hash:016x}"
    assert manifest["metrics"] == dict(result.metrics)
    assert {"birm3d", "source", "python", "numpy", "system", "machine", "libc"} <= set(manifest["made_with"])
    assert found["report.txt"].decode() == result.report() + "\n"
    (tmp_path / "vehicle.toml").write_bytes(found["vehicle.toml"])
    assert Vehicle.from_file(tmp_path / "vehicle.toml") == result.scene.vehicle
    (tmp_path / "result.npz").write_bytes(found["result.npz"])
    with np.load(tmp_path / "result.npz") as file:  # no pickle is needed
        assert np.array_equal(file["history/0/position"], result.position)
    readme = found["README.txt"].decode()
    assert "birm3d rerun" in readme
    assert f"source {manifest['made_with']['source'][:12]}" in readme


def test_the_same_run_gives_the_same_file(path: Path, result: Result, tmp_path: Path) -> None:
    """Nothing in it depends on the clock but what the run says of itself."""
    result.capsule(tmp_path / "again.birm3d")
    assert (tmp_path / "again.birm3d").read_bytes() == path.read_bytes()


def test_a_run_that_was_not_over(tmp_path: Path) -> None:
    simulation = preset()
    for _ in range(40):
        simulation.step()
    simulation.result().capsule(tmp_path / "half.birm3d")
    again = birm3d.rerun(tmp_path / "half.birm3d")
    assert again.same
    assert again.result.statistics.steps == 40
    result = preset().result()  # nothing has been done yet: there are no metrics
    result.capsule(tmp_path / "start.birm3d")
    assert birm3d.rerun(tmp_path / "start.birm3d").same


def test_a_saved_result_is_run_again_too(result: Result, tmp_path: Path) -> None:
    result.save(tmp_path / "crash.npz")
    again = birm3d.rerun(tmp_path / "crash.npz")
    assert again.same
    assert again.made_with == again.made_here == result.made_with


def with_another_end(result: Result, path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Write a capsule as a version with another law would have: its run ended in other bits."""
    other = birm3d.Simulation.from_scene(result.scene).run()
    other.state_hash ^= 1
    other.__dict__["metrics"] = {**result.metrics, "delta_v": 2.0 * result.metrics["delta_v"], "gone": 1.0}
    with monkeypatch.context() as patch:
        patch.setattr("birm3d.result.capsule.run_again", lambda scene, steps: other)
        other.capsule(path)


def test_other_bits_are_told(
    result: Result,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    command: Callable[..., int],
    capsys: pytest.CaptureFixture[str],
) -> None:
    path = tmp_path / "other.birm3d"
    with_another_end(result, path, monkeypatch)
    again = birm3d.rerun(path)
    assert not again.same
    assert again.expected_hash == result.state_hash ^ 1
    value = result.metrics["delta_v"]
    assert dict(again.differences) == {"delta_v": (2.0 * value, value), "gone": (1.0, None)}
    text = again.summary()
    assert "OTHER BITS" in text
    assert f"written by  birm3d {birm3d.__version__}, source {shortened(SOURCE.digest)}" in text
    assert "the source is the same: compare compiler, C library, NumPy, Python and machine" in text
    assert "-5.00e-01" in text
    assert command("rerun", str(path)) == 1
    assert f"{result.state_hash:016x}" in capsys.readouterr().out


def test_other_bits_of_another_source_name_the_code(
    result: Result, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "other.birm3d"
    facts = {**platform_facts(), "source": "a" * 32, "commit": "b" * 40}
    with monkeypatch.context() as patch:
        patch.setattr("birm3d.result.capsule.platform_facts", lambda: facts)
        with_another_end(result, path, monkeypatch)
    again = birm3d.rerun(path)
    text = again.summary()
    assert f"written by  birm3d {birm3d.__version__}, source {'a' * 12}, commit {'b' * 12}, python" in text
    assert f"run now by  birm3d {birm3d.__version__}, source {shortened(SOURCE.digest)}" in text
    assert f"for the same bits install what wrote it: birm3d {birm3d.__version__}, commit {'b' * 40}" in text
    assert again.to_dict()["made_with"]["source"] == "a" * 32
    result.capsule(tmp_path / "same.birm3d")
    assert "install" not in birm3d.rerun(tmp_path / "same.birm3d").summary()


def test_a_result_that_does_not_run_again_has_no_capsule(result: Result, tmp_path: Path) -> None:
    other = birm3d.Simulation.from_scene(result.scene).run()
    other.state_hash ^= 1
    with pytest.raises(ValueError, match="must run again to the same bits"):
        other.capsule(tmp_path / "crash.birm3d")
    assert list(tmp_path.iterdir()) == []
    for place in (tmp_path, tmp_path / "none" / "a.birm3d"):
        with pytest.raises(ValueError, match="path must be"):
            result.capsule(place)


def rewritten(path: Path, change: Callable[[dict[str, Any]], object]) -> Path:
    found = members(path)
    manifest = json.loads(found["manifest.json"])
    del manifest["checksum"]
    change(manifest)
    manifest["checksum"] = checksum(manifest)
    found["manifest.json"] = json.dumps(manifest).encode()
    return packed(path, found)


def packed(path: Path, found: dict[str, bytes]) -> Path:
    other = path.with_name("bad.birm3d")
    with zipfile.ZipFile(other, "w") as archive:
        for name, content in found.items():
            archive.writestr(name, content)
    return other


@pytest.mark.parametrize(
    ("change", "parts"),
    [
        (lambda m: m.update(format_version=2), ["format_version must be 1, got 2", "a newer birm3d"]),
        (lambda m: m.update(format="zip"), ["format must be 'birm3d capsule'"]),
        (lambda m: m.update(state_hash="0" * 16), ["state_hash must be that of result.npz"]),
        (lambda m: m["checksums"].pop("result.npz"), ["must have a result.npz"]),
        (lambda m: m["checksums"].update({"report.txt": "0"}), ["checksum of report.txt", "was changed"]),
        (lambda m: m.pop("checksums"), ["checksums"]),
    ],
)
def test_other_capsules_are_refused(path: Path, change: Callable[..., None], parts: list[str]) -> None:
    for read in (birm3d.rerun, birm3d.load):
        with pytest.raises(birm3d.FileFormatError, match=r"bad\.birm3d") as raised:
            read(rewritten(path, change))
        for part in parts:
            assert part in str(raised.value)


def test_a_changed_manifest_or_member_is_refused(path: Path, tmp_path: Path) -> None:
    found = members(path)
    speed = found["manifest.json"].replace(b'"impact_speed": 15.0', b'"impact_speed": 16.0')
    assert speed != found["manifest.json"]
    with pytest.raises(birm3d.FileFormatError, match="the file was changed"):
        birm3d.rerun(packed(path, {**found, "manifest.json": speed}))
    toml = found["vehicle.toml"] + b"\n"
    with pytest.raises(birm3d.FileFormatError, match=r"checksum of vehicle\.toml"):
        birm3d.rerun(packed(path, {**found, "vehicle.toml": toml}))
    (tmp_path / "text.birm3d").write_text("no archive", encoding="utf-8")
    with pytest.raises(birm3d.FileFormatError, match=r"text\.birm3d: must be"):
        birm3d.rerun(tmp_path / "text.birm3d")


def test_command_line(
    command: Callable[..., int], capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    path = tmp_path / "crash.birm3d"
    run = ["run", "--vehicle", "passenger_car", "--speed", "30mph", "--mesh-density", "0.2", "--json"]
    assert command(*run, "--capsule", str(path)) == 0
    state = json.loads(capsys.readouterr().out)["state_hash"]
    assert birm3d.load(path).scene.impact_speed == units.mph(30.0)
    assert command("rerun", str(path)) == 0
    out = capsys.readouterr().out
    assert out.startswith(f"the same bits: state {state} then, {state} now")
    assert command("rerun", str(path), "--json") == 0
    assert json.loads(capsys.readouterr().out)["same"] is True
    assert command(*run, "--capsule", str(tmp_path / "crash.zip")) == 2
    assert "--capsule must end in .birm3d" in capsys.readouterr().err
    path.write_bytes(path.read_bytes()[:500])
    assert command("rerun", str(path)) == 2
    assert "crash.birm3d" in capsys.readouterr().err
