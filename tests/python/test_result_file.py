"""Results as files: every bit comes back, the scene runs again, and what is no result is refused."""

from __future__ import annotations

import json
import pickle
from collections.abc import Callable
from pathlib import Path

import birm3d
import numpy as np
import pytest
from birm3d import Barrier, Result, Settings, Simulation, Vehicle, Zone, _core, scenes
from birm3d.result.result_file import FORMAT_VERSION
from birm3d.scene.codec import decode, encode

ARRAYS = (
    "time", "position", "velocity", "acceleration", "angular_velocity", "roll", "pitch", "yaw",
    "barrier_force", "barrier_normal_force", "tire_reaction", "tire_friction_force",
    "nodes", "deflection", "peak_deflection", "final_velocity",
)  # fmt: skip


def small(**options: object) -> Simulation:
    """An oblique crash with a friction, a heading and everything that is not a default."""
    car = Vehicle.preset("passenger_car", gvw=1719.0, mesh_density=0.2).with_zone("bumper", k_unloading=3e8)
    wall = Barrier.rigid_wall(friction=0.15, heading=20.0, origin=(1.0, 2.0, 0.0))
    settings = Settings(tolerance=2e-3, output_interval=2e-4, **options)  # type: ignore[arg-type]
    return Simulation(car, wall, 15.0, 30.0, 0.2, standoff=0.1, settings=settings)


@pytest.fixture(scope="module")
def original() -> Result:
    return small().run(frames=9)


@pytest.fixture
def path(tmp_path: Path, original: Result) -> Path:
    original.save(tmp_path / "crash.npz")
    return tmp_path / "crash.npz"


def test_every_array_comes_back_bit_for_bit(original: Result, path: Path) -> None:
    loaded = birm3d.load(path)
    for name in ARRAYS:
        array = getattr(loaded, name)
        assert array.tobytes() == getattr(original, name).tobytes(), name
        assert array.shape == getattr(original, name).shape, name
        assert not array.flags.writeable, name
    for name, values in original.energy.items():
        assert loaded.energy[name].tobytes() == values.tobytes(), name
    assert loaded.frames is not None
    assert original.frames is not None
    assert loaded.frames.time.tobytes() == original.frames.time.tobytes()
    assert loaded.frames.displacement[0].dtype == np.float32
    assert loaded.frames.displacement[0].tobytes() == original.frames.displacement[0].tobytes()


def test_everything_else_comes_back(original: Result, path: Path) -> None:
    loaded = birm3d.load(path)
    assert dict(loaded.metrics) == dict(original.metrics)
    assert loaded.report() == original.report()
    for name in ("end_reason", "state_hash", "run_time", "version", "momentum_residual"):
        assert getattr(loaded, name) == getattr(original, name), name
    properties = [name for name, value in vars(_core.StepStatistics).items() if isinstance(value, property)]
    assert len(properties) >= 7
    for name in properties:
        assert getattr(loaded.statistics, name) == getattr(original.statistics, name), name
    assert repr(loaded) == repr(original)
    assert loaded.plot_histories().get_axes()[0].get_lines()


def test_scene_comes_back_and_runs_the_same_way(original: Result, path: Path) -> None:
    scene = birm3d.load(path).scene
    assert scene == original.scene
    assert Simulation.from_scene(scene).run().state_hash == original.state_hash
    again = scene.vehicle.with_gvw(1900.0).with_mesh_density(0.3)
    assert again == original.scene.vehicle.with_gvw(1900.0).with_mesh_density(0.3)


def test_metrics_are_those_of_the_file(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("birm3d.result.event.compute_metrics", lambda result: {"peak_deceleration": 0.0})
    assert birm3d.load(path).metrics["peak_deceleration"] > 1.0


def test_vehicle_of_arrays_without_a_barrier(tmp_path: Path) -> None:
    block = scenes.laboratory_block(16, k_initial=3e6, knee=0.4, k_hardening=6e6, k_unloading=6e7)
    result = Simulation(block, None, 10.0, duration=0.05, settings=Settings(ground=False)).run()
    result.save(tmp_path / "free")  # any name will do
    loaded = birm3d.load(tmp_path / "free")
    assert loaded.scene == result.scene  # with infinite numbers in its laws
    assert loaded.scene.barrier is None
    assert loaded.frames is None
    assert Simulation.from_scene(loaded.scene).run().state_hash == result.state_hash


def test_result_too_short_for_metrics(tmp_path: Path) -> None:
    result = small().result()  # nothing has been done yet
    assert len(result.time) < 2
    result.save(tmp_path / "short.npz")
    with pytest.raises(ValueError, match="output_interval must be shorter"):
        _ = birm3d.load(tmp_path / "short.npz").metrics


def test_pickle_is_the_same_file(original: Result) -> None:
    copy = pickle.loads(pickle.dumps(original))
    assert copy.state_hash == original.state_hash
    assert np.array_equal(copy.position, original.position)


def test_file_is_open(original: Result, path: Path) -> None:
    """numpy alone reads it."""
    with np.load(path) as file:
        assert np.array_equal(file["history/0/position"], original.position)
        header = json.loads(str(file["header"]))
    assert header["format_version"] == FORMAT_VERSION
    assert header["made_with"]["birm3d"] == birm3d.__version__
    assert header["metrics"]["delta_v"] == original.metrics["delta_v"]


def test_nothing_of_the_core_is_forgotten(original: Result) -> None:
    """Records have properties, which are stored by themselves, and these methods, which storage knows."""
    methods = {
        kind: {name for name in vars(kind) if not name.startswith("_")}
        - {name for name, value in vars(kind).items() if isinstance(value, property)}
        for kind in (
            *(_core.History, _core.UnitHistory, _core.JointHistory, _core.ObstacleHistory),
            _core.StepStatistics,
        )
    }
    # Extremes follow from the rest, and what is made of them is stored with the metrics.
    assert methods.pop(_core.History) == {"unit", "joint", "extremes"}
    assert all(names == set() for names in methods.values())


def rewritten(path: Path, change: Callable[[dict[str, object]], None]) -> Path:
    with np.load(path) as file:
        arrays = {name: file[name] for name in file.files}
    header = json.loads(str(arrays["header"]))
    change(header)
    other = path.with_name("other.npz")
    with other.open("wb") as stream:
        np.savez(stream, **{**arrays, "header": np.array(json.dumps(header))})
    return other


@pytest.mark.parametrize(
    ("change", "parts"),
    [
        (lambda h: h.update(format_version=99), ["format_version must be 2 or 3 or 4", "99", "newer birm3d"]),
        (lambda h: h.update(format="other"), ["format must be 'birm3d result'", "other"]),
        (lambda h: h["scene"]["$Scene"].update(color=1), ["Scene has no 'color'", "newer"]),
        (lambda h: h["scene"]["$Scene"].update(barrier={"$Path": {}}), ["kind must be one of", "$Path"]),
        (lambda h: h["scene"]["$Scene"]["settings"]["$Settings"].update(tolerance=9.0), ["tolerance", "9"]),
        (lambda h: h["history"].update(time={"$array": "gone"}), ["'gone' is missing"]),
        (lambda h: h.pop("statistics"), ["complete result", "statistics"]),
    ],
)
def test_other_files_are_refused(path: Path, change: Callable[..., None], parts: list[str]) -> None:
    with pytest.raises(ValueError, match=r"other\.npz") as raised:
        birm3d.load(rewritten(path, change))
    for part in parts:
        assert part in str(raised.value)


def test_what_is_no_file_of_results_is_refused(path: Path, tmp_path: Path) -> None:
    content = path.read_bytes()
    bad = tmp_path / "bad.npz"
    damaged = bytearray(content)
    damaged[len(content) // 2] ^= 0xFF
    for data in (b"", b"some text", content[: len(content) // 2], bytes(damaged)):
        bad.write_bytes(data)
        with pytest.raises(ValueError, match=r"bad\.npz: must be"):
            birm3d.load(bad)
    with bad.open("wb") as stream:
        np.save(stream, np.zeros(3))
    with pytest.raises(ValueError, match=r"bad\.npz: must be"):
        birm3d.load(bad)
    np.savez(bad, time=np.zeros(3))
    with pytest.raises(ValueError, match="must have a header"):
        birm3d.load(bad)
    with pytest.raises(ValueError, match="can not be read"):
        birm3d.load(tmp_path / "missing.npz")


def test_save_is_whole_or_not_there(
    original: Result, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for place in (tmp_path, tmp_path / "none" / "a.npz"):
        with pytest.raises(ValueError, match="path must be"):
            original.save(place)
    kept = tmp_path / "kept.npz"
    kept.write_bytes(b"before")

    def fail(*arguments: object, **more: object) -> None:
        raise OSError("disk full")

    monkeypatch.setattr("numpy.savez_compressed", fail)
    with pytest.raises(OSError, match="disk full"):
        original.save(kept)
    assert [p.name for p in tmp_path.iterdir()] == ["kept.npz"]
    assert kept.read_bytes() == b"before"


def test_codec_refuses_what_it_does_not_know() -> None:
    arrays: dict[str, np.ndarray] = {}
    with pytest.raises(TypeError, match=r"thing/1 must be of a kind that files know, got Path|PosixPath"):
        encode((1, Path()), arrays, "thing")
    zone = Zone(envelope=((0.0, 0.0), (0.1, 1e6)), k_unloading=1e9)
    value = {"a": [1.5, float("inf"), None, True], "zone": zone, "n": np.float64(0.1)}
    plain = json.loads(json.dumps(encode(value, arrays, "v"), allow_nan=False))
    assert decode(plain, arrays) == value
