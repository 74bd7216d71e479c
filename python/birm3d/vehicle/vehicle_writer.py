"""Writer of vehicle files: what :meth:`birm3d.Vehicle.from_file` reads back as the same vehicle."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .._version import __version__
from ..io.atomic_write import whole_file
from ..io.toml import plain
from .file_recipe import changes_of

if TYPE_CHECKING:
    from .mass_variants import MassVariants
    from .vehicle_fields import VehicleFields

__all__ = ["check_savable", "save_vehicle"]

_HEAD = (
    f"Saved by BIRM3D {__version__}. SI; x forward, y left, z up; origin on the ground below the front axle.",
    "The block [changes], if there is one, says how the vehicle differs from what the others describe.",
)


def save_vehicle(vehicle: MassVariants, path: str | Path, read: Callable[[Path], MassVariants]) -> None:
    """Write a vehicle to a file that `read` gives back; see :meth:`birm3d.Vehicle.save`."""
    import tomlkit

    check_savable(vehicle)
    document = tomlkit.document()
    for line in _HEAD:
        document.add(tomlkit.comment(line))
    content = _of_one_unit(vehicle) if vehicle.joint is None else _of_two_units(vehicle)
    for key, value in content.items():
        document.add(key, tomlkit.item(_with_lines(value)))
    with whole_file(path) as part:
        part.write_text(tomlkit.dumps(document), encoding="utf-8", newline="\n")
        lost = _differences(vehicle, read(part))
        if lost:
            raise ValueError(
                f"vehicle must differ from its file only in what a file can hold (see the methods with_...), "
                f"got {vehicle.name!r} with another {', '.join(lost)}"
            )


def _with_lines(value: Any) -> Any:
    """Return a value of a file whose text of several lines is written as such."""
    import tomlkit

    if isinstance(value, dict):
        return {key: _with_lines(item) for key, item in value.items()}
    if isinstance(value, list) and any(isinstance(item, dict) for item in value):
        return [_with_lines(item) for item in value]
    return tomlkit.string(value, multiline=True) if isinstance(value, str) and "\n" in value else value


def check_savable(vehicle: MassVariants) -> None:
    """Refuse a vehicle that has no file.

    Raises
    ------
    ValueError
        Naming the vehicle, and what keeps it instead.
    """
    for unit in vehicle.units:
        if unit._file is None:
            raise ValueError(
                f"vehicle must come from a preset or a file to be saved as one, got {unit.name!r} from "
                "arrays; Result.save() and pickle keep it by value"
            )


def _of_one_unit(vehicle: VehicleFields) -> dict[str, Any]:
    file = vehicle._file
    assert file is not None  # see check_savable
    content = plain(file)
    content["zone"] = {zone.pop("name"): zone for zone in content["zone"]}
    changes = plain(changes_of(vehicle, file))
    return {**content, "changes": changes} if changes else content


def _of_two_units(vehicle: MassVariants) -> dict[str, Any]:
    joint = vehicle.joint
    assert joint is not None  # else there is one unit
    units = [_of_one_unit(unit) for unit in vehicle.units]
    return {
        "format_version": 1,
        "name": vehicle.name,
        "title": vehicle.name,
        "description": "A vehicle of two units, each with all that its own file has.",
        "gvw_kg": sum(unit["gvw_kg"] for unit in units),
        "source": [
            {
                "id": "saved",
                "text": "Joint as it was when the vehicle was saved; sources of its numbers are not kept",
                "status": "estimated",
            }
        ],
        "joint": {
            "kind": joint.kind,
            "place_on_leading_m": list(joint.place_on_leading),
            "place_on_trailing_m": list(joint.place_on_trailing),
            "roll_limit_deg": float(joint.roll_limit),
            "slide_m_N": [list(pair) for pair in joint.slide],
            "source": ["saved"],
            "status": "estimated",
        },
        "unit": units,
    }


def _differences(vehicle: MassVariants, other: MassVariants) -> list[str]:
    """Names of the fields in which two vehicles differ; of units where there are two."""
    if vehicle == other:
        return []
    if vehicle.joint is not None and other.joint is not None:
        found = [name for a, b in zip(vehicle.units, other.units, strict=True) for name in _differences(a, b)]
        return list(dict.fromkeys(found)) or ["joint or name"]
    names = [field.name for field in dataclasses.fields(vehicle) if field.compare]
    return [name for name in names if not vehicle._same(other, name)]
