"""Scenes as JSON and arrays: everything by value, so that a file holds all that a run needs.

Plain values stand as they are. The rest is a mapping with one key that says what it is. ``$array`` names an
array beside the JSON, ``$float`` is a number that JSON does not have. The others are ``$tuple``,
``$mapping``, and ``$`` with the name of a class and its fields. Only the classes listed here are ever made.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from functools import cache
from typing import Any

import numpy as np
import numpy.typing as npt

__all__ = ["decode", "encode"]

Arrays = Mapping[str, npt.NDArray[Any]]


@cache
def _classes() -> Mapping[str, type[Any]]:
    """Return the classes that scenes are made of by the names they have in files."""
    from ..barrier.free_standing import FreeStanding
    from ..barrier.kinds import KINDS, MeshBarrier
    from ..barrier.yielding import Foundation
    from ..vehicle.joint import Joint
    from ..vehicle.mesher import ExteriorMesh
    from ..vehicle.vehicle import ArticulatedVehicle, Vehicle, Zone
    from ..vehicle.vehicle_file import VehicleFile
    from .scene import Scene
    from .settings import Settings

    known: tuple[type[Any], ...] = (
        *(ArticulatedVehicle, Joint, Vehicle, VehicleFile, ExteriorMesh, Zone),
        *KINDS.values(),
        *(MeshBarrier, FreeStanding, Foundation),
        *(Scene, Settings),
    )
    return {kind.__name__: kind for kind in known}


def encode(value: Any, arrays: dict[str, npt.NDArray[Any]], name: str) -> Any:
    """Return a value for JSON; its arrays are added to `arrays` under names that begin with `name`.

    Raises
    ------
    TypeError
        If something in it is of a kind that files do not know.
    """
    if isinstance(value, np.generic):
        value = value.item()
    if value is None or isinstance(value, (bool, int, str)):
        return value
    if isinstance(value, float):
        return value if math.isfinite(value) else {"$float": repr(value)}
    if isinstance(value, np.ndarray):
        arrays[name] = value
        return {"$array": name}
    if isinstance(value, list):
        return [encode(item, arrays, f"{name}/{i}") for i, item in enumerate(value)]
    if isinstance(value, tuple):
        return {"$tuple": [encode(item, arrays, f"{name}/{i}") for i, item in enumerate(value)]}
    if isinstance(value, Mapping) and not dataclasses.is_dataclass(value):
        return {"$mapping": {key: encode(item, arrays, f"{name}/{key}") for key, item in value.items()}}
    kind = type(value).__name__
    if _classes().get(kind) is not type(value):
        raise TypeError(f"{name} must be of a kind that files know, got {type(value).__qualname__}")
    if hasattr(value, "model_dump"):  # a model of pydantic, which is not imported here: that takes long
        fields = value.model_dump(by_alias=True)
    elif kind == "ArticulatedVehicle":  # its other fields follow from these
        fields = {"units": value.units, "joint": value.joint, "name": value.name}
    else:
        stored = (field for field in dataclasses.fields(value) if field.metadata.get("stored", True))
        fields = {field.name: getattr(value, field.name) for field in stored}
    return {f"${kind}": {key: encode(item, arrays, f"{name}/{key}") for key, item in fields.items()}}


def decode(plain: Any, arrays: Arrays) -> Any:
    """Return the value that :func:`encode` was given.

    Raises
    ------
    ValueError
        If it names a class, a field or an array that is not known, or values that a class refuses.
    """
    if isinstance(plain, list):
        return [decode(item, arrays) for item in plain]
    if not isinstance(plain, dict):
        return plain
    ((marker, content),) = plain.items()
    if marker == "$array":
        if content not in arrays:
            raise ValueError(f"array {content!r} is missing")
        return arrays[content]
    if marker == "$float":
        return float(content)
    if marker == "$tuple":
        return tuple(decode(item, arrays) for item in content)
    fields = {key: decode(item, arrays) for key, item in content.items()}
    if marker == "$mapping":
        return fields
    kind = _classes().get(marker.removeprefix("$"))
    if kind is None:
        raise ValueError(f"kind must be one of {', '.join(_classes())}; got {marker!r}")
    if kind.__name__ == "VehicleFile":
        from ..vehicle.old_keys import with_todays_keys

        fields, _ = with_todays_keys(fields)
    if hasattr(kind, "model_validate"):
        return kind.model_validate(fields)
    if kind.__name__ == "ArticulatedVehicle":
        from ..vehicle.vehicle import articulate

        return articulate(**fields)
    if kind.__name__ == "Vehicle":  # as files of 0.1.0 have it
        fields.pop("_mesh", None)
        fields.pop("_draft", None)
        if fields.pop("_raised", 0.0) != 0.0:
            fields["_height"] = fields["mass_center_height"]
        from ..vehicle.old_keys import OLD_FIELDS

        fields = {OLD_FIELDS.get(key, key): value for key, value in fields.items()}
    known = {field.name for field in dataclasses.fields(kind)}
    for key in fields:
        if key not in known:
            raise ValueError(f"{kind.__name__} has no {key!r}; a newer birm3d may have made the file")
    return kind(**fields)
