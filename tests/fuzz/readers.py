"""The readers that are fuzzed, each with a good file."""

from __future__ import annotations

import io
import operator
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import birm3d
import numpy as np
from birm3d.calibration import CurveTarget, Parameter, load
from birm3d.calibration.fit_file import read_fit_file
from birm3d.calibration.storage import as_plain
from birm3d.simulation.scene_file import read_scene_file
from birm3d.study.store import RunStore
from birm3d.vehicle.combination_file import read_combination
from birm3d.vehicle.vehicle_file import preset_path, unit_paths
from mutations import Change, damaged, damaged_member, damaged_store

__all__ = ["READERS", "Reader"]

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


@dataclass
class Reader:
    """A reader and its good files; the first one is damaged.

    ``read`` returns something that compares equal to ``content`` only where the values are those of the good
    file; ``None``: it has no checksum, and other values may be good ones.
    """

    name: str
    files: Callable[[], dict[str, bytes]]
    read: Callable[[Path], Any]
    errors: tuple[type[Exception], ...] = (birm3d.FileFormatError,)
    damaged: Callable[[bytes, list[Change]], bytes] = damaged
    in_place: Callable[[Path, list[Change]], None] | None = None
    checked: bool = False
    same: Callable[[Any, Any], bool] = operator.eq
    content: Any = None

    def prepare(self, folder: Path) -> None:
        """Write the good files and read them."""
        for name, content in self.files().items():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_bytes(content)
        good = self.read(folder / next(iter(self.files())))
        self.content = good if self.checked else None

    def damage(self, folder: Path, applied: list[Change]) -> Path:
        """Damage the first file anew and return its path."""
        name, content = next(iter(self.files().items()))
        path = folder / name
        for left in folder.glob(f"{name}-*"):  # of SQLite
            left.unlink()
        if self.in_place is None:
            path.write_bytes(self.damaged(content, applied))
        else:
            path.write_bytes(content)
            self.in_place(path, applied)
        return path


# ---- files of the package's own ----------------------------------------------------------------------------


@cache
def result() -> birm3d.Result:
    """Return a short run of a small vehicle, with frames."""
    car = birm3d.Vehicle.preset("passenger_car", mesh_density=0.1)
    wall = birm3d.Barrier.rigid_wall()
    return birm3d.Simulation(car, wall, 10.0, 60.0, duration=0.01).run(frames=3)


@cache
def result_file() -> dict[str, bytes]:
    stream = io.BytesIO()
    from birm3d.result.result_file import write

    write(result(), result().report(), stream)
    return {"result.npz": stream.getvalue()}


def read_result(path: Path) -> Any:
    found = birm3d.load(path)
    names = ("position", "velocity", "barrier_force", "roll", "pitch", "yaw", "tire_reaction", "nodes")
    arrays = tuple(getattr(found, name).tobytes() for name in names)
    assert found.frames is not None
    return (
        dict(found.metrics),
        found.report(),
        repr(found.scene),
        found.end_reason,
        found.state_hash,
        arrays,
    )


def save(write: Callable[[Path], None]) -> bytes:
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "file"
        write(path)
        return path.read_bytes()


@cache
def capsule_file() -> dict[str, bytes]:
    return {"run.birm3d": save(result().capsule)}


@cache
def study_file() -> dict[str, bytes]:
    study = birm3d.sweep(
        birm3d.scenes.w2(6), impact_speed=[4.0, 5.0], impact_angle=[80.0, 90.0], progress=False,
        metrics=["peak_normal_force", "delta_v", "exit_angle"],
    )  # fmt: skip
    return {"study.csv": save(study.save)}


def read_study(path: Path) -> Any:
    found = birm3d.Study.load(path)
    columns = {name: repr(values.tolist()) for name, values in found.columns().items()}
    return (columns, dict(found.units), found.vehicle, found.version, repr(found.grid), found.run.tolist())


NAMES, UNITS = ("impact_speed", "settings.ground", "what"), {"delta_v": "m/s", "exit_angle": "deg"}
ROWS = [(4.0, True, "a"), (5.0, False, "b"), (6.0, True, "c")]


def open_store(path: Path) -> RunStore:
    return RunStore(path, study="0123", version="0", names=NAMES, rows=ROWS, units=UNITS)


@cache
def store_file() -> dict[str, bytes]:
    from birm3d.study.store import Outcome

    def write(path: Path) -> None:
        store = open_store(path)
        store.add({0: Outcome((1.5, float("nan")), "stopped", "ab"), 2: Outcome((0.1, 3.0), error="why")})
        store.close()

    return {"runs.db": save(write)}


def read_store(path: Path) -> Any:
    store = open_store(path)
    try:
        return {run: repr(outcome) for run, outcome in store.finished().items()}
    finally:
        store.close()


@cache
def calibration_file() -> dict[str, bytes]:
    time = np.arange(0.0, 0.1, 5e-3)
    target = CurveTarget(time, birm3d.scenes.w2_force(time), sigma=2e4)
    knee = Parameter("truss.knee", 0.1, 0.9, start=0.5)
    return {"fit.json": save(birm3d.calibrate(birm3d.scenes.w2(6), target, knee, starts=1).save)}


def read_calibration(path: Path) -> Any:
    found = load(path)
    found.summary()
    return repr(as_plain(found))


def part_of(found: dict[int, str], content: dict[int, str]) -> bool:
    """Rows of a store may be lost, which are run again; none may differ."""
    return found.items() <= content.items()


# ---- what users write --------------------------------------------------------------------------------------

SCENE = b"""\
[vehicle]
file = "block.toml"
gvw = "1800 kg"
mesh_density = 0.1

[barrier]
kind = "bollards"
count = 3
diameter_m = 0.3
height_m = 1.0
spacing_m = 1.2
friction = 0.2

[impact]
speed = "50 km/h"
angle = "80 deg"
offset = "0.1 m"
standoff = "0.2 m"
duration = "0.1 s"

[settings]
tolerance = 1e-3
output_interval = 1e-4
mu_tire = 0.8
"""


def scene_files() -> dict[str, bytes]:
    return {"scene.toml": SCENE, "block.toml": preset_path("passenger_car").read_bytes()}


def fit_files() -> dict[str, bytes]:
    text = (EXAMPLES / "nhtsa_10146_fit.toml").read_bytes().replace(b"nhtsa_10146.toml", b"scene.toml")
    return {"fit.toml": text, "nhtsa_10146.csv": (EXAMPLES / "nhtsa_10146.csv").read_bytes(), **scene_files()}


def vehicle_files() -> dict[str, bytes]:
    return {"car.toml": preset_path("passenger_car").read_bytes()}


def semi_files() -> dict[str, bytes]:
    files = {"semi.toml": preset_path("semi_truck").read_bytes()}
    units = unit_paths()
    return {
        **files,
        **{f"units/{name}.toml": units[name].read_bytes() for name in ("semi_tractor", "semi_trailer")},
    }


def extending_files() -> dict[str, bytes]:
    text = b'extends = "base.toml"\ntitle = "heavier"\n\n[zone.bumper]\n'
    base = preset_path("passenger_car").read_bytes()
    block = base[base.index(b"[zone.bumper]") + len(b"[zone.bumper]\n") :]
    end = block.find(b"\n[")
    return {"car.toml": text + block[: end if end > 0 else None] + b"\n", "base.toml": base}


def from_file(path: Path) -> None:
    birm3d.Vehicle.from_file(path, mesh_density=0.1)


TABLE = b"# a sled\ntime [ms],force (kN),sill [g]\n" + b"".join(
    f"{0.1 * i:.1f},{1.5 * i:.2f},-{i}\n".encode() for i in range(40)
)
EV5 = b"""\
# layout of an NHTSA header
----- EV5 -----
----- TEST -----
V5|TITLE|OBJECTIVES|01/JAN/2020|LAB|CONTRACT|REF|NCA|VTB|CON|DRY|20|OTH|OTH|54.0|0|0|0|4|RECORDER
----- VEHICLE -----
1|16|03|2018|M1|4S|VIN|4CIF|2.5|AF|1500|1400|2800|4900|1840|1200|UN|UNK|P||0
----- INSTRUMENTATION -----
1|1|AC|NA|FLLR|XG|SEC|G'S|2800|MFG: A|01/JAN/2020|800|21|54.0|-2|3|100|AM|P|LEFT REAR SEAT X
0|2|LC|NA|LC0101|XG|SEC|NWT|2800|MFG: B|01/JAN/2020|300000|1|0.0|-2|3|100|AM|P|BARRIER A-01 Fx
"""
CURVE = b"".join(f"{1e-4 * i:.6f}\t{i * i:.3f}\n".encode() for i in range(-2, 4))
MME = {
    "T1.mme": b"Data format :ISO-MME\nTest number :T1\nComments :first\nComments :18 \xb0C\n",
    "Channel/T1.chn": b"""\
Number of channels          :2
Name of channel 001         :11ENGN000000ACXC / Engine top
Name of channel 002         :11TIRS000000TI00
""",
    "Channel/T1.001": b"""\
Channel code                :11ENGN000000ACXC
Unit                        :m/(s*s)
Reference channel           :explicit
Reference channel name      :11TIRS000000TI00
Number of samples           :3
0.0
-1.5E+1
-2.5
""",
    "Channel/T1.002": b"Channel code :11TIRS000000TI00\nUnit :ms\nNumber of samples :3\n0\n1\n2.5\n",
}


def first(name: str, files: dict[str, bytes]) -> dict[str, bytes]:
    return {name: files[name], **files}


def read_test(path: Path) -> None:
    test = birm3d.read_nhtsa(next(path.parent.glob("*.EV5")))
    for curve in test.curves:
        test.channel(curve)


def read_mme(path: Path) -> None:
    folder = path.parent.parent if path.parent.name == "Channel" else path.parent
    test = birm3d.read_iso_mme(folder / "T1.mme")
    test.channels()


def quiet(read: Callable[[Path], Any]) -> Callable[[Path], None]:
    """Read; warnings of the vehicle or scene are no concern here."""

    def without(path: Path) -> None:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            read(path)

    return without


NHTSA = {"v1.EV5": EV5, "v1.001": CURVE, "v1.002": CURVE}
STORE_ERRORS = (birm3d.FileFormatError, ValueError)
READERS = [
    Reader("result", result_file, read_result, checked=True),
    Reader("result, repacked", result_file, read_result, damaged=damaged_member, checked=True),
    Reader("capsule", capsule_file, read_result, checked=True),
    Reader("capsule, repacked", capsule_file, read_result, damaged=damaged_member, checked=True),
    Reader("study table", study_file, read_study, checked=True),
    Reader("calibration", calibration_file, read_calibration, checked=True),
    Reader("store of runs", store_file, read_store, STORE_ERRORS, checked=True, same=part_of),
    Reader(
        "store of runs, by SQL",
        store_file,
        read_store,
        STORE_ERRORS,
        in_place=damaged_store,
        checked=True,
        same=part_of,
    ),
    Reader("scene", scene_files, quiet(read_scene_file)),
    Reader("fit", fit_files, quiet(read_fit_file)),
    Reader("vehicle", vehicle_files, quiet(from_file)),
    Reader("vehicle that extends", extending_files, quiet(from_file)),
    Reader("vehicle of two units", semi_files, quiet(read_combination)),
    Reader("CSV channels", lambda: {"sled.csv": TABLE}, quiet(birm3d.read_csv_channels)),
    Reader("NHTSA header", lambda: NHTSA, quiet(read_test)),
    Reader("NHTSA curve", lambda: first("v1.001", NHTSA), quiet(read_test)),
    Reader("ISO MME header", lambda: MME, quiet(read_mme)),
    Reader("ISO MME index", lambda: first("Channel/T1.chn", MME), quiet(read_mme)),
    Reader("ISO MME channel", lambda: first("Channel/T1.001", MME), quiet(read_mme)),
]
