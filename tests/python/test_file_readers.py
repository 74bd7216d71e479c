"""Readers of files: damaged ones are refused by their own error, soon; sizes are bounded; changes seen."""

from __future__ import annotations

import importlib
import io
import json
import os
import pickle
import sqlite3
import subprocess
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import birm3d
import numpy as np
import pytest
from birm3d import FileFormatError, Settings, StudyStoppedError, scenes
from birm3d.io.file_format import depth
from birm3d.io.toml import Document
from birm3d.study.store import RunStore

FUZZ = Path(__file__).resolve().parents[1] / "fuzz"
NAMES = [
    "result", "result, repacked", "capsule", "capsule, repacked", "study table", "calibration",
    "store of runs", "store of runs, by SQL", "scene", "fit", "vehicle", "vehicle that extends",
    "vehicle of two units", "CSV channels", "NHTSA header", "NHTSA curve", "ISO MME header", "ISO MME index",
    "ISO MME channel",
]  # fmt: skip


@pytest.fixture(scope="module")
def fuzz() -> ModuleType:
    sys.path.insert(0, str(FUZZ))
    try:
        return importlib.import_module("fuzz_readers")
    finally:
        sys.path.remove(str(FUZZ))


def test_no_reader_is_forgotten(fuzz: ModuleType) -> None:
    assert [reader.name for reader in fuzz.READERS] == NAMES


@pytest.mark.parametrize("name", NAMES)
def test_damaged_files_are_read_or_refused(fuzz: ModuleType, tmp_path: Path, name: str) -> None:
    (reader,) = (one for one in fuzz.READERS if one.name == name)
    reader.prepare(tmp_path)
    tally = fuzz.Tally()
    fuzz.fuzz(reader, tmp_path, 40, None, tally)
    assert tally.refused > 0


def test_the_fuzz_program_finds_a_reader_that_lets_errors_through(fuzz: ModuleType, tmp_path: Path) -> None:
    def read(path: Path) -> object:
        return json.loads(path.read_bytes())["a"]

    reader = fuzz.Reader("bad", lambda: {"a.json": b'{"a": 12, "b": [1, 2, 3]}'}, read)
    reader.prepare(tmp_path)
    with pytest.raises(Exception, match=r".") as caught:
        fuzz.fuzz(reader, tmp_path, 200, None, fuzz.Tally())
    assert not isinstance(caught.value, FileFormatError)
    careless = fuzz.Reader("careless", lambda: {"a.txt": b"1 2 3"}, Path.read_bytes, checked=True)
    careless.prepare(tmp_path)
    with pytest.raises(AssertionError, match="changed and accepted"):
        fuzz.fuzz(careless, tmp_path, 50, None, fuzz.Tally())


def test_the_fuzz_program_prints_its_table(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, FUZZ / "fuzz_readers.py", "--seconds", "0.1", "--reader", "CSV channels"],
        stdin=subprocess.DEVNULL, capture_output=True, text=True, check=True,
    )  # fmt: skip
    head, row = done.stdout.splitlines()
    assert head.split()[:3] == ["reader", "files", "read"]
    assert row.startswith("CSV channels")


# ---- the error ---------------------------------------------------------------------------------------------


def test_the_error_has_path_line_and_reason(tmp_path: Path) -> None:
    path = tmp_path / "sled.csv"
    path.write_text("time [ms],force [kN]\n0,1\n1,x\n")
    with pytest.raises(FileFormatError) as caught:
        birm3d.read_csv_channels(path)
    error = caught.value
    assert (error.path, error.line, error.reason) == (path, 3, "column 'force' must be a number, got 'x'")
    assert str(error) == f"{path}:3: column 'force' must be a number, got 'x'"
    assert isinstance(error, ValueError)
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), again.path, again.line) == (str(error), path, 3)
    with pytest.raises(FileFormatError, match="can not be read: No such file") as missing:
        birm3d.read_csv_channels(tmp_path / "none.csv")
    assert (missing.value.path, missing.value.line) == (tmp_path / "none.csv", None)


@pytest.mark.parametrize(
    ("text", "line", "reason"),
    [
        ("a = 1\nb = \n", 2, "not valid TOML"),
        ("a = " + "[" * 5000 + "]" * 5000, None, "must not be nested deeper than 64 levels"),
        ("a = " + "[" * 70 + "]" * 70, None, "must not be nested deeper than 64 levels"),
        ("x = 1\n" + "a." * 60_000 + "b = 1", 2, "a key must have at most 64 parts"),
        ("a = 1" + " " * 16 * 2**20, None, "must have at most 16,777,216 bytes"),
    ],
    ids=["syntax", "deep", "too deep", "dots", "large"],
)
def test_documents_that_ask_for_too_much(tmp_path: Path, text: str, line: int | None, reason: str) -> None:
    path = tmp_path / "a.toml"
    path.write_text(text)
    with pytest.raises(FileFormatError, match=reason) as caught:
        Document(path)
    assert (caught.value.path, caught.value.line) == (path, line)


def test_a_row_of_numbers_is_no_key_of_many_parts(tmp_path: Path) -> None:
    path = tmp_path / "a.toml"
    path.write_text(f"a = [{', '.join(['0.25'] * 1000)}]\nb = '{'...' * 100}'\n")
    assert len(Document(path).data["a"]) == 1000


def test_bytes_that_are_no_text_are_told_by_line(tmp_path: Path) -> None:
    path = tmp_path / "a.toml"
    path.write_bytes(b"a = 1\nb = 2\nc = '\xff'\n")
    with pytest.raises(FileFormatError, match=r"a\.toml:3: must be UTF-8 text, got byte 0xff"):
        Document(path)


def test_depth_is_found_without_recursion() -> None:
    deep: list[object] = []
    for _ in range(100_000):
        deep = [deep]
    assert depth(deep) == 65
    assert depth({"a": [1, {"b": ()}]}) == 4
    assert depth(1) == 0


@pytest.mark.parametrize("cell", [" " * 60_000, "a" + " " * 60_000 + "b", "(" * 60_000, "[" * 60_000 + "]"])
def test_long_cells_of_a_head_take_no_time(tmp_path: Path, cell: str) -> None:
    path = tmp_path / "a.csv"
    path.write_text(f"time [s],{cell}\n0,1\n1,2\n")
    with pytest.raises(FileFormatError, match=r"a\.csv:1: column"):
        birm3d.read_csv_channels(path)


def test_a_scene_says_where_the_block_stands_that_can_not_be_made(tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    scene = (
        '[vehicle]\npreset = "pickup"\n\n[impact]\nspeed = "10 m/s"\nangle = "200 deg"\n\n'
        '[barrier]\nkind = "pole"\n'
    )
    path.write_text(scene)
    from birm3d.simulation.scene_file import read_scene_file

    with pytest.raises(FileFormatError, match=r"scene\.toml:4: impact_angle must be within 0 and 180"):
        read_scene_file(path)
    path.write_text(scene.replace('"pickup"', '"tank"'))
    with pytest.raises(FileFormatError, match=r"scene\.toml:1: preset must be one of"):
        read_scene_file(path)


@pytest.mark.parametrize("half_width", ["1_000", "1e300", "0.89e30"])
def test_a_vehicle_of_a_million_elements_is_refused(tmp_path: Path, half_width: str) -> None:
    from birm3d.vehicle.vehicle_file import preset_path

    text = preset_path("passenger_car").read_text(encoding="utf-8")
    assert "[0.60, 0.89, 0.20, 0.84]" in text
    path = tmp_path / "car.toml"
    path.write_text(text.replace("[0.60, 0.89,", f"[0.60, {half_width},"), encoding="utf-8")
    with pytest.raises(
        FileFormatError, match=r"element_size_m: must be for at most 300,000 elements"
    ) as told:
        birm3d.Vehicle.from_file(path)
    assert text.splitlines()[told.value.line - 1].startswith("element_size_m")


# ---- archives ----------------------------------------------------------------------------------------------


def archive(path: Path, members: dict[str, bytes]) -> Path:
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as file:
        for name, content in members.items():
            file.writestr(name, content)
    return path


def npy(array: np.ndarray) -> bytes:
    stream = io.BytesIO()
    np.save(stream, array)
    return stream.getvalue()


def test_an_archive_that_unpacks_to_too_much_is_refused(tmp_path: Path) -> None:
    zeros = npy(np.zeros(2**24))  # 128 MB, which pack to 130 kB
    path = archive(tmp_path / "bomb.npz", {f"history/{i}.npy": zeros for i in range(3)})
    assert path.stat().st_size < 2**20
    with pytest.raises(FileFormatError, match=r"must unpack to at most .* bytes, 100 times .* got 402,65"):
        birm3d.load(path)


def test_an_array_is_as_long_as_its_head_says(tmp_path: Path) -> None:
    good = npy(np.zeros(4))
    longer = good.replace(b"(4,), }", b"(9999999999999,), }")
    path = archive(tmp_path / "a.npz", {"header.npy": longer})
    with pytest.raises(FileFormatError, match=r"array 'header' must have 79999999999992 bytes, got"):
        birm3d.load(path)


def test_nothing_is_unpickled(tmp_path: Path) -> None:
    class Trap:
        def __reduce__(self) -> tuple[Callable[..., object], tuple[str, ...]]:
            return (os.mkdir, (str(tmp_path / "sprung"),))

    path = archive(tmp_path / "trap.npz", {"header.npy": npy(np.array([Trap()], dtype=object))})
    with pytest.raises(FileFormatError, match=r"must be of numbers or text, got object"):
        birm3d.load(path)
    path.write_bytes(pickle.dumps(Trap()))
    with pytest.raises(FileFormatError, match=r"must be a file of Result\.save"):
        birm3d.load(path)
    assert not (tmp_path / "sprung").exists()


def test_a_value_that_was_changed_is_seen(tmp_path: Path) -> None:
    path = tmp_path / "result.npz"
    result = scenes.w2(4).run()
    result.save(path)
    with np.load(path) as file:
        arrays = {name: file[name] for name in file.files}
    assert birm3d.load(path).state_hash == result.state_hash
    arrays["history/0/velocity"][3, 0] += 1e-9
    np.savez(path, **arrays)
    with pytest.raises(FileFormatError, match=r"checksum must be .*: the file was changed"):
        birm3d.load(path)


# ---- studies -----------------------------------------------------------------------------------------------


def study() -> birm3d.Study:
    return birm3d.sweep(scenes.w2(4), impact_speed=[4.0, 5.0, 6.0], metrics=["delta_v"], progress=False)


def test_a_table_that_was_changed_is_refused_by_line(tmp_path: Path) -> None:
    path = tmp_path / "study.csv"
    study().save(path)
    text = path.read_text()
    lines = text.splitlines()
    path.write_text(text.replace(lines[3], lines[3].replace("5.0", "5.5", 1)))
    with pytest.raises(FileFormatError, match=r"checksum must be .* the file was changed"):
        birm3d.Study.load(path)
    path.write_text(text.replace("\n1,5.0,", "\n1,five,"))
    with pytest.raises(FileFormatError, match=r"study\.csv"):
        birm3d.Study.load(path)
    path.write_text(text.replace(lines[3], lines[3] + ",1"))
    with pytest.raises(FileFormatError, match=r"study\.csv:4: a row must have \d cells, got \d"):
        birm3d.Study.load(path)


def test_a_table_without_a_checksum_is_of_the_first_format(tmp_path: Path) -> None:
    path = tmp_path / "study.csv"
    study().save(path)
    first, rest = path.read_text().split("\n", 1)
    head = json.loads(first.removeprefix("# "))
    del head["checksum"]
    path.write_text(f"# {json.dumps(head)}\n{rest}")
    with pytest.raises(FileFormatError, match="checksum must be"):
        birm3d.Study.load(path)
    head["format"] = "birm3d study 1"
    path.write_text(f"# {json.dumps(head)}\n{rest}")
    assert np.array_equal(birm3d.Study.load(path)["delta_v"], study()["delta_v"])


def test_a_store_that_was_changed_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "runs.db"

    def run() -> birm3d.Study:
        return birm3d.sweep(
            scenes.w2(4), impact_speed=[4.0, 5.0], metrics=["delta_v"], progress=False, store=path
        )

    first = run()
    assert run().state_hash == first.state_hash
    with sqlite3.connect(path) as connection:
        connection.execute("UPDATE runs SET delta_v = delta_v + 1e-9 WHERE run = 1")
    connection.close()
    with pytest.raises(FileFormatError, match=r"runs\.db: run 1 must have the checksum of its values"):
        run()


@pytest.mark.parametrize("executor", ["threads", "one"])
def test_a_full_disk_hands_over_what_is_done(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, executor: str
) -> None:
    """The store is as small as SQLite allows a disk to be."""
    from concurrent.futures import ThreadPoolExecutor

    path = tmp_path / "runs.db"
    opened = RunStore._open

    def small(self: RunStore, *arguments: object) -> None:
        opened(self, *arguments)  # type: ignore[arg-type]
        self._connection.execute("PRAGMA max_page_count = 8")

    monkeypatch.setattr(RunStore, "_open", small)
    speeds = np.linspace(3.0, 6.0, 400).tolist()
    with ThreadPoolExecutor(1) as one, pytest.raises(StudyStoppedError) as caught:
        birm3d.sweep(
            scenes.w2(1), impact_speed=speeds, metrics=["delta_v"], progress=False, store=path,
            executor=one if executor == "one" else None,
        )  # fmt: skip
    message = str(caught.value)
    done = caught.value.study
    assert "database or disk is full" in message
    assert f"{len(done)} are finished and kept in the error's 'study'" in message
    assert str(path) in message
    assert len(done) > 0
    assert not done.failed
    monkeypatch.undo()
    with sqlite3.connect(path) as connection:
        (stored,) = connection.execute("SELECT count(*) FROM runs").fetchone()
    connection.close()
    assert f"it has {stored} of 400 runs" in message
    again = birm3d.sweep(scenes.w2(1), impact_speed=speeds, metrics=["delta_v"], progress=False, store=path)
    assert np.array_equal(again["delta_v"][done.run], done["delta_v"])


# ---- sizes -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("interval", [1e-300, 1e-10, 0.0, float("nan"), float("inf")])
def test_output_intervals_have_a_least_length(interval: float) -> None:
    with pytest.raises(ValueError, match="output_interval must be"):
        Settings(output_interval=interval)


def test_a_history_of_too_many_rows_is_refused_before_the_run() -> None:
    car = birm3d.Vehicle.preset("passenger_car", mesh_density=0.1)
    with pytest.raises(ValueError, match=r"output_interval must be >= duration / 2e\+06 = 5e-05 s"):
        birm3d.Simulation(car, None, 1.0, duration=100.0, settings=Settings(output_interval=1e-8))
