"""Results as files: NumPy's npz with a JSON header, readable without this package.

``numpy.load(path)`` has every array by name. ``history/...`` has rows at the output interval, angles in rad.
Of them ``history/0/...`` are those of unit 0, ``history/element/2/...`` those of element 2 of the barrier, if
it was touched; there is ``history/joint/0/...``, too. ``final/0/...`` is unit 0 at the end; ``scene/...`` and
``frames/...`` are the rest. The text ``header`` is JSON with format and versions, the scene (see
:mod:`birm3d.scene.codec`), scalars, metrics and report.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .. import _core
from ..base.fingerprint import fingerprint
from ..io.atomic_write import check_format, whole_file
from ..io.file_format import FileFormatError, checksum, read_json, reading, received
from ..io.npz_arrays import read_arrays
from ..scene.codec import decode, encode
from .frames import Frames
from .metrics import ALONG_LINE
from .stored import Stored, StoredHistory
from .unit_result import UnitResult, read_only

if TYPE_CHECKING:
    from ..scene.scene import Scene
    from .analysis import RunAnalysis

__all__ = ["FORMAT_VERSION", "read", "save", "write"]

FORMAT_VERSION = 4
_FORMAT = "birm3d result"
_OLD_TERMS = {
    "joint_work": "joints",
    "segment_friction": "barrier_ground_friction",
    "suspension": "springs",
}
_LISTED = "elements"  # of the history: records of their own
_FINAL = ("nodes", "deflection", "peak_deflection", "final_velocity")


def save(result: RunAnalysis, report: str | None, path: str | Path) -> None:
    """Write a result and its report, every array bit for bit. The file is complete or is not there."""
    with whole_file(path) as part, part.open("wb") as stream:
        write(result, report, stream)


def write(result: RunAnalysis, report: str | None, stream: IO[bytes]) -> None:
    """Write a result and its report to an open binary file."""
    arrays: dict[str, npt.NDArray[Any]] = {}
    scene = encode(result.scene, arrays, "scene")
    history = _parts(result._history, _core.History, arrays, "history")
    vehicle = result.scene.vehicle
    units = [
        _parts(result._history.unit(i), _core.UnitHistory, arrays, f"history/{i}")
        for i in range(len(vehicle.units))
    ]
    joints = [
        _parts(result._history.joint(i), _core.JointHistory, arrays, f"history/joint/{i}")
        for i in range(0 if vehicle.joint is None else 1)
    ]
    elements = [
        _parts(one, _core.ObstacleHistory, arrays, f"history/element/{one.element}")
        for one in result._history.elements
    ]
    for i in range(len(vehicle.units)):
        for name in _FINAL:
            arrays[f"final/{i}/{name}"] = getattr(result.unit(i), name)
    if result.frames is not None:
        arrays["frames/time"] = result.frames.time
        for i, displacement in enumerate(result.frames.displacement):
            arrays[f"frames/{i}/displacement"] = displacement
    long_enough = len(result.time) > 1  # compute_metrics() needs two rows
    header = {
        "format": _FORMAT,
        "format_version": FORMAT_VERSION,
        "made_with": dict(result.made_with),
        "scene": scene,
        "history": history,
        "units": units,
        "joints": joints,
        "elements": elements,
        "statistics": _parts(result.statistics, _core.StepStatistics, arrays, "statistics"),
        "event": None if result._event is None else _parts(result._event, _core.Event, arrays, "event"),
        "end_reason": result.end_reason,
        "state_hash": f"{result.state_hash:016x}",
        "run_time": result.run_time,
        "metrics": dict(result.metrics) if long_enough else None,
        "report": report,
    }
    header["checksum"] = _checksum(json.loads(json.dumps(header, allow_nan=False)), arrays)
    arrays["header"] = np.array(json.dumps(header, allow_nan=False))
    # numpy's stub takes a keyword for allow_pickle where ours are names of arrays
    np.savez_compressed(stream, **arrays)  # type: ignore[arg-type]


def read(stream: IO[bytes], path: Path) -> tuple[dict[str, Any], str | None]:
    """Return what a result is made of, and its report, from an open binary file; `path` is for messages."""
    with reading(path, "must be a file of Result.save(), npz"):
        arrays = read_arrays(stream, path)
    if "header" not in arrays:
        raise FileFormatError.at(path, None, "must have a header in JSON, got none")
    header = read_json(path, str(arrays.pop("header")))
    check_format(path, header, _FORMAT, 2, 3, FORMAT_VERSION)
    with reading(path, "must be a complete result"):
        parts = _parts_of_result(header, arrays)
        found = header.pop("checksum", None)
        if found is not None or header["format_version"] != 2:  # that had none
            expected = _checksum(header, arrays)
            if found != expected:
                reason = f"checksum must be {expected}, got {received(found)}: the file was changed"
                raise FileFormatError.at(path, None, reason)
    return parts, header["report"]


def _checksum(header: Mapping[str, Any], arrays: Mapping[str, npt.NDArray[Any]]) -> str:
    """Of all that a file has, however it is packed."""
    return fingerprint(checksum(header), *(part for name in sorted(arrays) for part in (name, arrays[name])))


def _parts_of_result(header: Mapping[str, Any], arrays: Mapping[str, npt.NDArray[Any]]) -> dict[str, Any]:
    units, joints, elements = (
        [Stored(_values(one, arrays)) for one in header[name]] for name in ("units", "joints", "elements")
    )
    scene = decode(header["scene"], arrays)
    units = [_with_normal_force(unit, scene) for unit in units]
    frames = None
    if "frames/time" in arrays:
        moved = tuple(arrays[f"frames/{i}/displacement"] for i in range(len(units)))
        frames = Frames(arrays["frames/time"], moved)
    event = header.get("event")  # files of 0.1.0 have none
    return dict(
        scene=scene,
        history=StoredHistory(
            _with_energy_terms(_values(header["history"], arrays)), units, joints, elements
        ),
        statistics=Stored(_values(header["statistics"], arrays)),
        end_reason=header["end_reason"],
        state_hash=int(header["state_hash"], 16),
        run_time=header["run_time"],
        units=tuple(
            UnitResult(unit, **{name: arrays[f"final/{i}/{name}"] for name in _FINAL})
            for i, unit in enumerate(units)
        ),
        event=None if event is None else Stored(_values(event, arrays)),
        frames=frames,
        made_with=header["made_with"],
        saved_metrics=header["metrics"],
    )


def _with_energy_terms(history: dict[str, Any]) -> dict[str, Any]:
    """Return a history with its energies by today's names.

    Before version 4 of the format, springs and dampers of wheels were one column.
    """
    for then, now in _OLD_TERMS.items():
        if then in history:
            history[now] = history.pop(then)
    if "springs" in history:
        history.setdefault("dampers", np.zeros_like(history["springs"]))
    return history


def _with_normal_force(unit: Stored, scene: Scene) -> Stored:
    """Return the history of a unit with the force along the normal, as files of 0.1.0 do not have it.

    What they call ``barrier_normal_force`` is the sum of the magnitudes over all nodes.
    """
    if "sum_of_contact_forces" in unit._values:
        return unit
    component = read_only(-unit.barrier_force @ _towards(scene))
    sums = unit.barrier_normal_force
    return Stored({**unit._values, "barrier_normal_force": component, "sum_of_contact_forces": sums})


def _towards(scene: Scene) -> npt.NDArray[np.float64]:
    """Return the direction along which the normal force pushes back, as ``Scene::towards`` of the core."""
    angle = math.radians(scene.impact_angle)
    if scene.barrier is not None and abs(math.sin(angle)) >= ALONG_LINE:
        return -np.asarray(scene.barrier.core.normal)
    yaw = 0.5 * math.pi - angle + math.radians(scene.barrier.heading if scene.barrier else 0.0)
    return np.array([math.cos(yaw), math.sin(yaw), 0.0])


def _parts(record: Any, kind: type, arrays: dict[str, npt.NDArray[Any]], name: str) -> dict[str, Any]:
    """Return all properties that a record of the core has, for JSON."""
    properties = [key for key, value in vars(kind).items() if isinstance(value, property) and key != _LISTED]
    return {key: encode(getattr(record, key), arrays, f"{name}/{key}") for key in properties}


def _values(parts: Mapping[str, Any], arrays: Mapping[str, npt.NDArray[Any]]) -> dict[str, Any]:
    return {key: decode(value, arrays) for key, value in parts.items()}
