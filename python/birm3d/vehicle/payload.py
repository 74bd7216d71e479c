"""What a vehicle weighs and where: its solids at a gross vehicle weight."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from .vehicle_file import Solid, VehicleFile

__all__ = ["check_load", "core_ranges", "load_height", "solids_at", "structure_mass"]

Floats = npt.NDArray[np.float64]

# Goods are not spread thinner, m: a solid needs a volume, and what is left of a load weighs nothing then.
_THINNEST = 1e-3


def structure_mass(file: VehicleFile) -> float:
    """Mass of a vehicle without its payload [kg]; 0 where a file names none: then all of it is rescaled."""
    mass, payload = _masses(file)
    return float(mass[~payload].sum())


def solids_at(file: VehicleFile, gvw: float, load_density: float | None = None) -> tuple[Floats, Floats]:
    """Corners (n, 8, 3) [m] and densities (n,) [kg/m^3] of the solids at a gross vehicle weight [kg].

    Payload takes the difference first: all of it is multiplied by one factor. Goods in a load space keep
    their density, the file's or `load_density`, and stand higher; in a full space they are packed denser.
    Other payload (people on seats) gets heavier where it is. Below the unladen mass the structure is
    rescaled, without payload.
    """
    mass, payload, corners, density = _solids(_Same(file))
    corners, density = corners.copy(), density.copy()
    structure = float(mass[~payload].sum())
    factor = max(0.0, (gvw - structure) / float(mass[payload].sum()))
    density[~payload] *= min(1.0, gvw / structure) if structure else 1.0
    for i in np.flatnonzero(payload):
        solid = file.solids[i]
        if factor == 0.0 or solid.fills_to_m is None:
            density[i] *= factor
            continue
        height = load_height(solid, factor * solid.mass, load_density)
        corners[i, 4:, 2] = corners[i, 0, 2] + height
        density[i] = factor * solid.mass / (_floor_area(solid) * height)
    return corners, density


class _Same:
    """A file as a key: files are immutable, and it takes long to compare all of their numbers."""

    def __init__(self, file: VehicleFile) -> None:
        self.file = file

    def __hash__(self) -> int:
        return id(self.file)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Same) and other.file is self.file


@lru_cache(maxsize=16)
def _solids(same: _Same) -> tuple[Floats, npt.NDArray[np.bool_], Floats, Floats]:
    """Mass of each solid [kg]; whether it is payload: all, where a file names none; corners and densities."""
    solids = same.file.solids
    payload = np.array([solid.payload for solid in solids])
    return (
        np.array([solid.mass for solid in solids]),
        payload if payload.any() else np.ones_like(payload),
        np.array([solid.corners for solid in solids], float),
        np.array([solid.density for solid in solids]),
    )


@lru_cache(maxsize=16)
def _core_ranges(same: _Same) -> Floats:
    boxes = [box for box in same.file.core if not box.gives_way]
    ranges = np.array([(box.x_m, (-box.half_width_m, box.half_width_m), box.z_m) for box in boxes])
    return ranges.reshape(-1, 3, 2)


def core_ranges(file: VehicleFile) -> Floats:
    """Return where the rigid body's boxes begin and end along each axis of the file, shape (k, 3, 2) [m].

    Boxes that give way are no part of it.
    """
    return _core_ranges(_Same(file))


def _masses(file: VehicleFile) -> tuple[Floats, npt.NDArray[np.bool_]]:
    """Mass of each solid [kg], and whether it is payload; shape (n,)."""
    return _solids(_Same(file))[:2]


def load_height(solid: Solid, mass: float, density: float | None = None) -> float:
    """Height of goods of a mass [kg] on the floor of their space [m]: 1 mm at least, the space at most."""
    height = mass / (_floor_area(solid) * (solid.density if density is None else density))
    return min(max(height, _THINNEST), _space(solid))


def check_load(file: VehicleFile, mass: float, density: float | None, height: float | None) -> float | None:
    """Return the density of goods of a payload [kg] [kg/m^3]; ``None``: the file's.

    Raises
    ------
    ValueError
        If both are given, the vehicle has no load space, or the goods do not fit in it.
    """
    if density is None and height is None:
        return None
    if density is not None and height is not None:
        raise ValueError(f"density must not be given together with height, got {density} and {height}")
    key = "density" if height is None else "height"
    spaces = [solid for solid in file.solids if solid.fills_to_m is not None]
    if not spaces:
        raise ValueError(f"{key} of a payload needs a vehicle with a load space, got {file.name!r}")
    payload_ratio = mass / sum(solid.mass for solid in file.solids if solid.payload)
    highest = min(_space(solid) for solid in spaces)
    if height is not None:
        if not 0.0 < height <= highest:
            raise ValueError(f"height must be > 0 and at most that of the space, {highest:g} m; got {height}")
        return payload_ratio * sum(s.mass for s in spaces) / (sum(_floor_area(s) for s in spaces) * height)
    assert density is not None  # one of the two is given, see above
    if not 0.0 < density < float("inf"):
        raise ValueError(f"density must be finite and > 0, got {density}")
    for solid in spaces:
        least = payload_ratio * solid.mass / (_floor_area(solid) * _space(solid))
        if density < least:
            raise ValueError(
                f"density must be at least {least:g} kg/m^3 for {mass:g} kg to fit, got {density}"
            )
    return density


def _floor_area(solid: Solid) -> float:
    assert solid.box_m is not None  # a load space has one, see Solid
    (x0, x1), (y0, y1), _ = solid.box_m
    return (x1 - x0) * (y1 - y0)


def _space(solid: Solid) -> float:
    assert solid.box_m is not None  # a load space has both, see Solid
    assert solid.fills_to_m is not None
    return solid.fills_to_m - solid.box_m[2][0]
