"""Blocks of a vehicle file at another size: see :mod:`birm3d.vehicle.scaling` for where places go."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from .file_schema import (
    Bed,
    CoreBox,
    Dimensions,
    End,
    Exterior,
    Indentation,
    NamedPoint,
    Overhang,
    Point,
    Range,
    Solid,
    Upper,
    Wheel,
    Zone,
)
from .scaling import Extent, Factors, Scaling
from .skin_mesh import SkinMesh

__all__ = ["Resize", "extent_of"]


def extent_of(exterior: Exterior, wheels: Sequence[Wheel], core: Sequence[CoreBox]) -> Extent:
    """Return where a vehicle of these blocks ends."""
    roofs = [row for upper in exterior.upper for row in upper.roof_m]
    if exterior.mesh is not None:
        return _extent_of_mesh(exterior, exterior.mesh, wheels, core)
    x = [row[0] for row in exterior.stations_m] + [row[0] for row in roofs]
    x += [wheel.center_m[0] + sign * wheel.radius_m for wheel in wheels for sign in (-1.0, 1.0)]
    half = [row[1] for row in exterior.stations_m] + [row[1] for row in roofs]
    half += [abs(wheel.center_m[1]) + 0.5 * wheel.width_m for wheel in wheels]
    axles = [wheel.center_m[0] for wheel in wheels]
    ends = (min(x), max(x))
    return Extent(
        rear=ends[0],
        front=ends[1],
        width=2.0 * max(half),
        top=max([row[3] for row in exterior.stations_m] + [row[2] for row in roofs]),
        axles=(max(axles), min(axles)) if len(set(axles)) > 1 else None,
        crushed_rear=_inner_end(ends[0], exterior.rear.depth_m, min(box.x_m[0] for box in core)),
        crushed_front=_inner_end(ends[1], exterior.front.depth_m, max(box.x_m[1] for box in core), -1.0),
        wheel=max((wheel.radius_m for wheel in wheels), default=None),
    )


def _inner_end(end: float, depth: float | None, core: float, inwards: float = 1.0) -> float:
    """Return where the structure of an end is taken to begin: at its stated depth, or at the core."""
    return core if depth is None else end + inwards * depth


def _extent_of_mesh(
    exterior: Exterior, mesh: SkinMesh, wheels: Sequence[Wheel], core: Sequence[CoreBox]
) -> Extent:
    """Return where a vehicle ends whose skin is a mesh; mirrors are no part of its width."""
    outline = extent_of(exterior.changed({"mesh": None}), wheels, core)
    low, high = mesh.points.min(axis=0), mesh.points.max(axis=0)
    ends = [wheel.center_m[0] + sign * wheel.radius_m for wheel in wheels for sign in (-1.0, 1.0)]
    return outline._replace(
        rear=float(min([low[0], *ends])), front=float(max([high[0], *ends])), top=float(high[2])
    )


class Resize:
    """Makes blocks of a file of another size and mass.

    Parameters
    ----------
    scaling, extent
        Where places go, and where the vehicle ends.
    weight
        Factor of the masses of solids.
    """

    def __init__(self, scaling: Scaling, extent: Extent, weight: float) -> None:
        self._to, self._extent, self._weight = scaling, extent, weight

    def _point(self, at: Point) -> Point:
        return (self._to.x(at[0]), self._to.y * at[1], self._to.z(at[2]))

    def _across(self, y: float) -> float:
        return self._to.y * y

    def solid(self, solid: Solid) -> Solid:
        """Return a solid at its new place; goods fill their space to the same share."""
        changes: dict[str, Any] = {"mass_kg": self._weight * solid.mass, "density_kg_per_m3": None}
        if solid.box_m is None:
            changes["corners_m"] = tuple(self._point(corner) for corner in solid.corners)
        else:
            x, y, z = solid.box_m
            changes["box_m"] = (_both(self._to.x, x), _both(self._across, y), _both(self._to.z, z))
            changes["fills_to_m"] = None if solid.fills_to_m is None else self._to.z(solid.fills_to_m)
        return solid.changed(changes)

    def wheel(self, wheel: Wheel) -> Wheel:
        """Return a wheel, which goes on standing on the ground."""
        x, y, z = self._point(wheel.center_m)
        return wheel.changed({"center_m": (x, y, z), "radius_m": z, "width_m": self._to.y * wheel.width_m})

    def point(self, point: NamedPoint) -> NamedPoint:
        """Return a named point."""
        return point.changed({"at_m": self._point(point.at_m)})

    def core(self, box: CoreBox) -> CoreBox:
        """Return a box of the rigid core."""
        x, z = _both(self._to.x, box.x_m), _both(self._to.z, box.z_m)
        return box.changed({"x_m": x, "half_width_m": self._to.y * box.half_width_m, "z_m": z})

    def bed(self, bed: Bed | None) -> Bed | None:
        """Return the bed, with holding forces in proportion to its mass."""
        if bed is None:
            return None
        slide = tuple((slip, self._weight * force) for slip, force in bed.slide_m_N)
        return bed.changed({"slide_m_N": slide, "core": tuple(self.core(box) for box in bed.core)})

    def indentation(self, indentation: Indentation | None) -> Indentation | None:
        """Return the indentation."""
        if indentation is None:
            return None
        return indentation.changed({"length_m": self._to.indentation(self._extent) * indentation.length_m})

    def overhang(self, overhang: Overhang | None) -> Overhang | None:
        """Return what reaches out over the frame."""
        if overhang is None:
            return None
        changes = {
            "x_m": _both(self._to.x, overhang.x_m),
            "beyond_y_m": self._to.y * overhang.beyond_y_m,
            "z_m": self._to.z(overhang.z_m),
        }
        return overhang.changed(changes)

    def dimensions(self, dimensions: Dimensions) -> Dimensions:
        """Return the stated dimensions."""
        extent = self._extent
        first, last = extent.axles if extent.axles is not None else (extent.front, extent.rear)
        changes = {
            "length_m": self._to.length(extent) * dimensions.length_m,
            "width_m": self._to.y * dimensions.width_m,
            "height_m": self._to.height(extent) * dimensions.height_m,
            "wheelbase_m": self._to.x.stretch(last, first) * dimensions.wheelbase_m,
            "front_overhang_m": self._to.x.stretch(first, extent.front) * dimensions.front_overhang_m,
        }
        return dimensions.changed(changes)

    def exterior(self, exterior: Exterior) -> Exterior:
        """Return the exterior, of about as many elements."""
        to, stations = self._to, exterior.stations_m
        front, rear = stations[0][0], stations[-1][0]
        at_front = to.x.stretch(front - exterior.front.blend_m, front)
        at_rear = to.x.stretch(rear, rear + exterior.rear.blend_m)
        changes = {
            "element_size_m": exterior.element_size_m * to.volume(self._extent) ** (1.0 / 3.0),
            "stations_m": tuple(
                (to.x(x), to.y * half, to.z(low), to.z(high)) for x, half, low, high in stations
            ),
            "front": self._end(exterior.front, at_front, to.front_depth(self._extent)),
            "rear": self._end(exterior.rear, at_rear, to.rear_depth(self._extent)),
            "upper": tuple(self._upper(upper) for upper in exterior.upper),
            "mesh": None if exterior.mesh is None else self._mesh(exterior.mesh),
        }
        return exterior.changed(changes)

    def _mesh(self, mesh: SkinMesh) -> SkinMesh:
        return mesh.moved_to(np.array([self._point(tuple(point)) for point in mesh.points.tolist()]))

    def _upper(self, upper: Upper) -> Upper:
        roof = tuple((self._to.x(x), self._to.y * half, self._to.z(z)) for x, half, z in upper.roof_m)
        return upper.changed({"base_x_m": _both(self._to.x, upper.base_x_m), "roof_m": roof})

    def _end(self, end: End, along: float, deep: float) -> End:
        return end.changed(
            {
                "bow_m": along * end.bow_m,
                "profile_m": tuple((self._to.z(z), along * setback) for z, setback in end.profile_m),
                "blend_m": along * end.blend_m,
                "depth_m": None if end.depth_m is None else deep * end.depth_m,
            }
        )

    def zone(self, zone: Zone, factors: Mapping[str, Factors]) -> Zone:
        """Return a zone with its part of the exterior; its laws have their factors, by their names."""
        changes: dict[str, Any] = {
            "x_m": None if zone.x_m is None else _both(self._to.x, zone.x_m),
            "y_m": None if zone.y_m is None else _both(self._across, zone.y_m),
            "z_m": None if zone.z_m is None else _both(self._to.z, zone.z_m),
        }
        return zone.scaled(factors).changed(changes)


def _both(change: Callable[[float], float], limits: Range) -> Range:
    return (change(limits[0]), change(limits[1]))
