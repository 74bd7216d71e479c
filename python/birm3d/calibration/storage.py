"""Calibrations as files: JSON, with a format version."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path
from typing import Any

import numpy as np

from ..io.atomic_write import check_format, whole_file
from ..io.file_format import check_sum, checksum, read_bytes, read_json, reads
from .evaluation import Evaluation
from .fitted import FittedParameter, FittedTarget
from .identifiability import Spread
from .profile import Profile
from .record import CalibrationRecord

__all__ = ["FORMAT_VERSION", "read", "save"]

FORMAT_VERSION = 2
_FORMAT = "birm3d calibration"


def save(result: CalibrationRecord, path: str | Path) -> None:
    """Write a result; floats keep all their digits. The file is complete or is not there."""
    document = as_plain(result)
    text = json.dumps({**document, "checksum": checksum(document)}, indent=1, allow_nan=False)
    with whole_file(path) as part:
        part.write_text(text, encoding="utf-8")


def as_plain(result: CalibrationRecord) -> dict[str, Any]:
    """Return a result as numbers, texts, lists and mappings."""
    document: dict[str, Any] = {"format": _FORMAT, "format_version": FORMAT_VERSION}
    for field in dataclasses.fields(CalibrationRecord):
        if not field.name.startswith("_"):
            document[field.name] = _plain(getattr(result, field.name))
    return document


@reads("must be a complete calibration")
def read(path: str | Path) -> dict[str, Any]:
    """Return what a result is made of, see :func:`birm3d.calibration.load`."""
    document = _document(Path(path))
    return dict(
        parameters=tuple(_parameter(item) for item in document["parameters"]),
        targets=tuple(FittedTarget(**_arrays(item, FittedTarget)) for item in document["targets"]),
        chi_square=document["chi_square"],
        spread=Spread(**document["spread"]),
        confidence=document["confidence"],
        covariance=_matrix(document["covariance"]),
        correlation=_matrix(document["correlation"]),
        condition_number=document["condition_number"],
        notes=tuple(document["notes"]),
        starts=tuple(document["starts"]),
        history=tuple(
            Evaluation(**{**item, "values": tuple(item["values"])}) for item in document["history"]
        ),
        settings=document["settings"],
        doubts=tuple(document.get("doubts", ())),  # files of earlier versions have none
        profiles={name: Profile(**_arrays(item, Profile)) for name, item in document["profiles"].items()},
    )


def _document(path: Path) -> dict[str, Any]:
    document = read_json(path, read_bytes(path))
    check_format(path, document, _FORMAT, 1, FORMAT_VERSION)
    assert isinstance(document, dict)  # see check_format()
    found = document.pop("checksum", None)
    if found is not None or document["format_version"] != 1:  # that had none
        check_sum(path, found, document)
    return document


def _parameter(item: dict[str, Any]) -> FittedParameter:
    interval = item["interval"]
    return FittedParameter(
        **{**item, "names": tuple(item["names"]), "interval": None if interval is None else tuple(interval)}
    )


def _arrays(item: dict[str, Any], kind: type[FittedTarget] | type[Profile]) -> dict[str, Any]:
    """Turn the lists of a document back into arrays."""
    names = {field.name for field in dataclasses.fields(kind)}
    return {
        name: np.array(value) if isinstance(value, list) else value
        for name, value in item.items()
        if name in names
    }


def _matrix(rows: list[list[float]]) -> Any:
    return np.array(rows, float).reshape(len(rows), len(rows))


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, np.generic):
        return value.item()
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return {field.name: _plain(getattr(value, field.name)) for field in dataclasses.fields(value)}
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    return value
