"""From the axes and the unit of a mesh to those of a vehicle, and whether they can be meant."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .raw_mesh import RawMesh

__all__ = ["AXES", "UNITS", "Placed", "check_unit", "in_vehicle_axes", "rotation"]

Floats = npt.NDArray[np.float64]

UNITS: Mapping[str, float] = {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "in": 0.0254, "ft": 0.3048}
"""Units of meshes [m]."""

AXES = ("+x", "-x", "+y", "-y", "+z", "-z")
_LENGTHS = (1.5, 30.0)  # m, of vehicles
_LIKELY = 1.6  # a length beyond this factor of that of the preset is in another unit


class Placed(NamedTuple):
    """Points in metres: x forward, y left from the middle, z up; x = 0 at the front, lowest at z = 0."""

    points: Floats
    length: float
    width: float
    height: float


def rotation(forward: str, up: str) -> Floats:
    """Return the matrix (3, 3) from the axes of a mesh to x forward, y left, z up."""
    for name, axis in (("forward", forward), ("up", up)):
        if axis not in AXES:
            raise ValueError(f"{name} must be one of {', '.join(AXES)}; got {axis!r}")
    if forward[1] == up[1]:
        raise ValueError(f"up must be another axis than forward, {forward!r}; got {up!r}")
    ahead, above = _unit_vector(forward), _unit_vector(up)
    return np.stack([ahead, np.cross(above, ahead), above])


def _unit_vector(axis: str) -> Floats:
    vector = np.zeros(3)
    vector["xyz".index(axis[1])] = 1.0 if axis[0] == "+" else -1.0
    return vector


def in_vehicle_axes(mesh: RawMesh, unit: str | None, forward: str, up: str, expected: float) -> Placed:
    """Return the points of a mesh in metres and in the axes of a vehicle.

    Parameters
    ----------
    mesh
        As read.
    unit
        One of :data:`UNITS`.
    forward, up
        Axes of the mesh, see :data:`AXES`.
    expected
        Length that a vehicle of this kind and mass has [m].

    Raises
    ------
    ValueError
        If the unit is missing or can not be meant, or the vehicle would be wider than long.
    """
    points = mesh.points @ rotation(forward, up).T
    low, high = points.min(axis=0), points.max(axis=0)
    size = high - low
    if size[1] > size[0] and size[1] > size[2]:
        sideways = next(a for a in AXES if a[1] not in (forward[1], up[1]))
        other = f"{'-' if sideways[0] == '+' else '+'}{sideways[1]}"
        raise mesh.fault(
            f"forward must be the axis along the vehicle, got {forward!r} with a length of {size[0]:.4g} and "
            f"a width of {size[1]:.4g}; forward={sideways!r} or {other!r} may be meant"
        )
    if size[2] > size[0]:
        raise mesh.fault(
            f"up must be the axis across the ground, got {up!r} with a height of {size[2]:.4g} and a length "
            f"of {size[0]:.4g}"
        )
    scale = check_unit(mesh, unit, float(size[0]), expected)
    if not size.min() * scale > 0.1:
        thin = ("length", "width", "height")[int(size.argmin())]
        raise mesh.fault(f"{thin} must be above 0.1 m to be a vehicle's, got {size.min() * scale:.4g} m")
    shift = np.array([high[0], 0.5 * (low[1] + high[1]), low[2]])
    return Placed((points - shift) * scale, *(float(one) for one in size * scale))


def check_unit(mesh: RawMesh, unit: str | None, length: float, expected: float) -> float:
    """Return the size of a unit [m] in which a mesh of a length can be a vehicle; see in_vehicle_axes()."""
    likely = min(UNITS, key=lambda name: abs(math.log(length * UNITS[name] / expected)))
    hint = f"{length:.4g} along the vehicle would be {length * UNITS[likely]:.3g} m with unit={likely!r}"
    if unit is None:
        raise mesh.fault(f"unit must be given, one of {', '.join(UNITS)}: {hint}")
    if unit not in UNITS:
        raise mesh.fault(f"unit must be one of {', '.join(UNITS)}, got {unit!r}; {hint}")
    got = length * UNITS[unit]
    low, high = _LENGTHS
    if low <= got <= high and (unit == likely or max(got / expected, expected / got) < _LIKELY):
        return UNITS[unit]
    if unit == likely:
        raise mesh.fault(
            f"length must be {low:g} to {high:g} m, got {got:.4g} m in {unit!r}; no other unit fits better: "
            "parts that are not of the vehicle can be left out by without_parts"
        )
    raise mesh.fault(
        f"unit must make a vehicle of about {expected:.2g} m, got {got:.4g} m in {unit!r}; {hint}"
    )
