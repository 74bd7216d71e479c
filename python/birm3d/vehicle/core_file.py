"""Writer of prepared vehicles for the C++ library; vehicle_text.hpp of the core describes the form."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..io.atomic_write import whole_file
from .wheel_arguments import PLAIN

if TYPE_CHECKING:
    from .variants import VehicleVariants

__all__ = ["export_core"]

VERSION = 8


def export_core(vehicle: VehicleVariants, path: str | Path) -> None:
    """Write a prepared vehicle; see :meth:`birm3d.Vehicle.export_core`."""
    with whole_file(path) as part:
        part.write_text("\n".join(_lines(vehicle)) + "\n", encoding="ascii", newline="\n")


def _lines(vehicle: VehicleVariants) -> Iterator[str]:
    arguments = vehicle._core_arguments()
    yield f"birm3d-vehicle {VERSION}"
    for name, value in vehicle._own_settings().items():
        yield f"{name} {_numbers([value])}"
    yield f"units {len(arguments)}"
    for unit in arguments:
        yield from _of_unit(unit)
    joint = vehicle.joint
    if joint is None:
        yield "joints 0"
    else:
        leading, trailing = vehicle.units
        places = (
            *(joint.place_on_leading - leading.center_of_mass),
            *(joint.place_on_trailing - trailing.center_of_mass),
        )
        yield "joints 1"
        yield f"{joint.kind} 0 1 {_numbers((*places, math.radians(joint.roll_limit)))}"
        if joint.kind == "sliding":
            yield from _rows("slide", joint.slide)
    yield "end"


def _of_unit(unit: dict[str, Any]) -> Iterator[str]:
    yield f"mass {_numbers([unit['mass']])}"
    yield f"inertia {_numbers(np.asarray(unit['inertia']).ravel())}"
    yield f"mass_center_height {_numbers([unit['mass_center_height']])}"
    yield f"offset {_numbers(unit['offset'])}"
    yield from _rows(
        "wheels", np.hstack([unit["wheels"], unit["breakaway"], unit["suspension"], unit["tires"]]).tolist()
    )
    yield from _rows("boxes", unit["core"])
    yield f"mesh_origin {_numbers(unit['origin'])}"
    mesh = unit["trusses"]
    yield from _rows("mesh_wheels", [[*wheel, *PLAIN] for wheel in np.asarray(mesh["wheels"]).tolist()])
    yield f"rate_sensitivity {_numbers([mesh['rate_sensitivity']])}"
    yield f"indentation_length {_numbers([mesh['indentation_length']])}"
    yield f"curves {len(mesh['curves'])}"
    for curve in mesh["curves"]:
        numbers = (curve.k_unloading, curve.elastic_recovery, curve.friction_share, curve.springback)
        yield f"{len(curve.deflection)} {_numbers(numbers)}"
        for point in zip(curve.deflection, curve.slope, strict=True):
            yield _numbers(point)
    yield f"trusses {len(mesh['nodes'])}"
    names = ("nodes", "anchors", "curve_of", "scale", "wheel_of", "along_of")
    columns = (np.asarray(mesh[name]).tolist() for name in names)
    for node, anchor, curve, scale, wheel, along in zip(*columns, strict=True):
        yield f"{_numbers(node)} {_numbers(anchor)} {curve} {_numbers([scale])} {wheel} {along}"


def _rows(name: str, rows: Sequence[Sequence[float]]) -> Iterator[str]:
    yield f"{name} {len(rows)}"
    for row in rows:
        yield _numbers(row)


def _numbers(values: Iterable[float]) -> str:
    """Return numbers exactly, as C's %a writes them."""
    return " ".join(float(value).hex() for value in values)
