"""Capsules: one file that holds a run, what made it and how it ended, to be run again years later.

A capsule is a zip archive. Any tool opens it, and nothing in it is a pickle:

- ``manifest.json``: format and its version, versions, source (:mod:`birm3d._source`) and platform that made
  it, steps, state hash, metrics, and checksums (BLAKE2b, 32 hexadecimal digits) of itself and of each other
  member;
- ``result.npz``: what :meth:`birm3d.Result.save` writes: scene, settings and histories by value;
- ``vehicle.toml``: the vehicle as a file of its own, where it has one (else the result alone has it);
- ``report.txt``: the report as it was written then;
- ``README.txt``: what the file is, and how it is run again.
"""

from __future__ import annotations

import hashlib
import io
import json
import tempfile
import zipfile
from dataclasses import dataclass
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

from .. import _core
from ..io.atomic_write import check_format, whole_file
from ..io.file_format import MOST_BYTES, FileFormatError, check_sum, checksum, read_json, received
from ..io.made_with import code_text, code_to_install, platform_facts
from . import result_file

if TYPE_CHECKING:
    from ..scene.scene import Scene
    from ..vehicle.vehicle import Vehicle
    from .analysis import RunAnalysis

__all__ = [
    "FORMAT_VERSION",
    "MANIFEST",
    "Capsule",
    "is_capsule",
    "read",
    "run_again",
    "write",
]

FORMAT_VERSION = 1
MANIFEST = "manifest.json"
_FORMAT = "birm3d capsule"
_RESULT, _VEHICLE, _REPORT, _README = "result.npz", "vehicle.toml", "report.txt", "README.txt"
_MEMBERS = (_RESULT, _VEHICLE, _REPORT, _README)
_EPOCH = (1980, 1, 1, 0, 0, 0)  # all members have this date, so that equal contents give equal bytes


@dataclass(frozen=True)
class Capsule:
    """What a capsule holds, as it is read.

    Attributes
    ----------
    manifest : dict
        Of ``manifest.json``.
    parts : dict
        What a result is made of.
    report : str or None
    """

    manifest: dict[str, Any]
    parts: dict[str, Any]
    report: str | None


def run_again(scene: Scene, steps: int | None) -> _core.Simulation:
    """Return the finished run of a scene, or the run after so many steps where it was not over."""
    core = scene.start()
    if steps is None:
        core.run()
    else:
        while core.statistics.steps < steps and core.step():
            pass
    return core


def write(result: RunAnalysis, report: str | None, path: str | Path) -> None:
    """Write the capsule of a result; the file is complete or is not there.

    The scene is run once more first: a capsule is written only of what runs again to the same bits.

    Raises
    ------
    ValueError
        If the scene does not end in the same bits, or the path is a folder or lies in none.
    """
    with whole_file(path) as part:
        found = run_again(result.scene, steps_of(result)).state_hash
        if found != result.state_hash:
            raise ValueError(
                f"result must run again to the same bits to become a capsule, got state {found:016x} after "
                f"{result.state_hash:016x} (result of {code_text(result.made_with)}; this is "
                f"{code_text(platform_facts())}); Result.save() keeps it as it is"
            )
        members = _members(result, report)
        document = json.loads(json.dumps(_manifest(result, members), allow_nan=False))
        manifest = json.dumps({**document, "checksum": checksum(document)}, indent=1)
        with zipfile.ZipFile(part, "w", zipfile.ZIP_DEFLATED) as archive:
            for name, content in {MANIFEST: manifest.encode(), **members}.items():
                entry = zipfile.ZipInfo(name, _EPOCH)
                packed = name.endswith(".npz")  # is an archive itself
                entry.compress_type = zipfile.ZIP_STORED if packed else zipfile.ZIP_DEFLATED
                entry.external_attr = 0o644 << 16
                archive.writestr(entry, content)


def steps_of(result: RunAnalysis) -> int | None:
    """Return how many steps lead to a result of a run that was not over; ``None``: run to the end."""
    return int(result.statistics.steps) if result.end_reason == "running" else None


def _members(result: RunAnalysis, report: str | None) -> dict[str, bytes]:
    stream = io.BytesIO()
    result_file.write(result, report, stream)
    members = {_RESULT: stream.getvalue()}
    vehicle = _vehicle_file(result.scene.vehicle)
    if vehicle is not None:
        members[_VEHICLE] = vehicle
    if report is not None:
        members[_REPORT] = f"{report}\n".encode()
    members[_README] = _readme(result, vehicle is not None).encode()
    return members


def _vehicle_file(vehicle: Vehicle) -> bytes | None:
    """Return the vehicle as a file; ``None`` where it is one that only a result can hold."""
    from ..vehicle.vehicle_writer import check_savable  # pydantic takes long to load

    try:
        check_savable(vehicle)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / _VEHICLE
            vehicle.save(path)
            return path.read_bytes()
    except ValueError:  # from arrays: the result holds it by value
        return None


def _readme(result: RunAnalysis, has_vehicle: bool) -> str:
    vehicle = (
        f"{_VEHICLE}: the vehicle as a file." if has_vehicle else "The vehicle is in the result, by value."
    )
    return "\n".join(
        [
            f"A run of BIRM3D {result.version}, kept whole.",
            "",
            'Run it again:    birm3d rerun FILE        (or in Python: birm3d.rerun("FILE"))',
            f"It ended in the state {result.state_hash:016x}. The same bits give the same state.",
            f"Other bits: install the code that wrote this. {code_to_install(platform_facts())}.",
            "",
            f"{MANIFEST}: versions, source, platform, state hash, metrics (SI, degrees), checksums. JSON.",
            f"{_RESULT}: scene, settings, histories. numpy.load(), or birm3d.load().",
            vehicle,
            f"{_REPORT}: what was computed and what was left out.",
            "",
        ]
    )


def _manifest(result: RunAnalysis, members: dict[str, bytes]) -> dict[str, Any]:
    scene = result.scene
    barrier = None if scene.barrier is None else type(scene.barrier).__name__
    return {
        "format": _FORMAT,
        "format_version": FORMAT_VERSION,
        "made_with": platform_facts(),
        "scene": {
            "vehicle": scene.vehicle.name,
            "barrier": barrier,
            "impact_speed": scene.impact_speed,
            "impact_angle": scene.impact_angle,
        },
        "outcome": result.outcome,
        "end_reason": result.end_reason,
        "steps": int(result.statistics.steps),
        "state_hash": f"{result.state_hash:016x}",
        "metrics": dict(result.metrics) if len(result.time) > 1 else {},
        "checksums": {name: _digest(content) for name, content in members.items()},
    }


def _digest(content: bytes) -> str:
    return hashlib.blake2b(content, digest_size=16).hexdigest()


def is_capsule(stream: IO[bytes]) -> bool:
    """Return whether an open file is an archive with a manifest; leaves the file at its start."""
    stream.seek(0)
    try:
        with zipfile.ZipFile(stream) as archive:
            return MANIFEST in archive.namelist()
    except zipfile.BadZipFile:
        return False
    finally:
        stream.seek(0)


def read(stream: IO[bytes], path: Path) -> Capsule:
    """Return what a capsule holds; `path` is for messages.

    Raises
    ------
    FileFormatError
        If the file is no capsule, is of a newer version, is damaged or was changed.
    """
    with zipfile.ZipFile(stream) as archive:
        if MANIFEST not in archive.namelist():
            raise FileFormatError.at(path, None, f"must have a {MANIFEST}, got none: no capsule")
        manifest = read_json(path, _member(archive, MANIFEST, path))
        check_format(path, manifest, _FORMAT, FORMAT_VERSION)
        check_sum(path, manifest.pop("checksum", None), manifest)
        sums = manifest["checksums"]
        members = {name: _member(archive, name, path) for name in _MEMBERS if name in sums}
    for name, content in members.items():
        if _digest(content) != sums[name]:
            reason = f"checksum of {name} must be {received(sums[name])}, got {_digest(content)}"
            raise FileFormatError.at(path, None, f"{reason}: the file was changed")
    if _RESULT not in members:
        raise FileFormatError.at(path, None, f"must have a {_RESULT}, got none")
    parts, report = result_file.read(io.BytesIO(members[_RESULT]), path)
    if manifest["state_hash"] != f"{parts['state_hash']:016x}":
        reason = f"state_hash must be that of {_RESULT}, {parts['state_hash']:016x}"
        raise FileFormatError.at(path, None, f"{reason}, got {received(manifest['state_hash'])}")
    return Capsule(manifest, parts, report)


def _member(archive: zipfile.ZipFile, name: str, path: Path) -> bytes:
    entry = archive.getinfo(name)
    if entry.file_size > MOST_BYTES:
        reason = f"{name} must have at most {MOST_BYTES:,} bytes, got {entry.file_size:,}"
        raise FileFormatError.at(path, None, reason)
    return archive.read(entry)
