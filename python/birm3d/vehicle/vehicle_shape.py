"""What vehicles of the same file share: the mesh, and its trusses for the core.

Another mass moves the mass centre and nothing else: the trusses are cut into blocks once, and moved.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Mapping
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _core
from .front_height import strong_height
from .mesher import build_mesh
from .second_trusses import build_second
from .tire_nodes import build_tread, zones_of_wheels
from .vehicle_file import VehicleFile
from .zone import Zone

__all__ = ["VehicleShape", "shape_of"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

_SHAPES = 16  # files and mesh densities that are remembered
_LAWS = 4  # of each, sets of laws for which the core has the trusses
_PLACES = 4  # of each, mass centres from which nodes and anchors were seen


class VehicleShape:
    """Nodes and trusses of a vehicle's file at a mesh density; immutable, in file axes.

    Attributes
    ----------
    nodes, anchors, area, zone_of_node, wheel_of_node, along_of_node, quads
        As :class:`birm3d.Vehicle` has them, but in the axes of the file.
    wheels : ndarray, shape (w, 4)
        Centres and radius [m].
    zone_of_wheel
        As :class:`birm3d.Vehicle` has it.
    """

    def __init__(
        self,
        nodes: Floats,
        anchors: Floats,
        area: Floats,
        zone_of_node: Ints,
        wheel_of_node: Ints,
        along_of_node: Ints,
        quads: Ints,
        wheels: Floats,
        zone_of_wheel: Ints,
    ) -> None:
        self.nodes = nodes
        self.anchors = anchors
        self.area = area
        self.zone_of_node = zone_of_node
        self.wheel_of_node = wheel_of_node
        self.along_of_node = along_of_node
        self.quads = quads
        self.wheels = wheels
        self.zone_of_wheel = zone_of_wheel
        of_nodes = (nodes, anchors, area, zone_of_node, wheel_of_node, along_of_node)
        for array in (*of_nodes, quads, wheels, zone_of_wheel):
            array.setflags(write=False)
        self._trusses: OrderedDict[tuple[object, ...], _core.TrussMesh] = OrderedDict()
        self._seen: OrderedDict[bytes, tuple[Floats, Floats]] = OrderedDict()
        self._heights: OrderedDict[tuple[object, ...], float | None] = OrderedDict()

    @cached_property
    def without_tire_nodes(self) -> VehicleShape:
        """The same without the nodes by which tyres meet barriers."""
        shell = self.wheel_of_node < 0
        return VehicleShape(
            nodes=self.nodes[shell],
            anchors=self.anchors[shell],
            area=self.area[shell],
            zone_of_node=self.zone_of_node[shell],
            wheel_of_node=self.wheel_of_node[shell],
            along_of_node=self.along_of_node[shell],
            quads=self.quads,
            wheels=self.wheels,
            zone_of_wheel=self.zone_of_wheel,
        )

    @cached_property
    def node_spacing(self) -> float:
        """Distance between neighbours of the skin [m]: the median, see :mod:`birm3d.vehicle.node_spacing`."""
        from .node_spacing import node_spacing

        return node_spacing(self.nodes[(self.wheel_of_node < 0) & (self.along_of_node < 0)])

    def seen_from(self, center: Floats) -> tuple[Floats, Floats]:
        """Return nodes and anchors in axes with their origin at `center` (3,) [m]; the last few are kept."""
        key = center.tobytes()
        seen = self._seen.get(key)
        if seen is None:
            seen = (_moved(self.nodes, center), _moved(self.anchors, center))
            for array in seen:
                array.setflags(write=False)
            self._seen[key] = seen
            _forget_first(self._seen, _PLACES)
        return seen

    def truss_arguments(
        self, zones: Mapping[str, Zone], rate_sensitivity: float, indentation_length: float
    ) -> dict[str, Any]:
        """Return the arguments of the core's TrussMesh, in file axes."""
        return {
            "nodes": self.nodes,
            "anchors": self.anchors,
            "curves": [zone.curve for zone in zones.values()],
            "curve_of": self.zone_of_node,
            "scale": self.area,
            "wheels": self.wheels,
            "rate_sensitivity": rate_sensitivity,
            "indentation_length": indentation_length,
            "wheel_of": self.wheel_of_node,
            "along_of": self.along_of_node,
        }

    def trusses(
        self, zones: Mapping[str, Zone], rate_sensitivity: float, indentation_length: float
    ) -> _core.TrussMesh:
        """Return the trusses for the core, in file axes, with these laws; the last few are remembered."""
        key = (*zones.items(), rate_sensitivity, indentation_length)
        known = self._trusses.get(key)
        if known is None:
            known = _core.TrussMesh(**self.truss_arguments(zones, rate_sensitivity, indentation_length))
            self._trusses[key] = known
            _forget_first(self._trusses, _LAWS)
        return known

    def strong_height(self, zones: Mapping[str, Zone]) -> float | None:
        """Return :func:`birm3d.vehicle.front_height.strong_height`; the last few are remembered."""
        key = tuple(zones.items())
        if key not in self._heights:
            skin = (self.wheel_of_node < 0) & (self.along_of_node < 0)
            inwards = self.anchors[skin] - self.nodes[skin]
            laws = tuple(zones.values())
            self._heights[key] = strong_height(
                self.nodes[skin], inwards, self.area[skin], self.zone_of_node[skin], laws
            )
            _forget_first(self._heights, _LAWS)
        return self._heights[key]

    def __reduce__(self) -> tuple[object, ...]:
        arrays = (self.nodes, self.anchors, self.area, self.zone_of_node, self.wheel_of_node)
        return (VehicleShape, (*arrays, self.along_of_node, self.quads, self.wheels, self.zone_of_wheel))


def _moved(points: Floats, origin: Floats) -> Floats:
    """Return points - origin, column by column: three times as fast as row by row."""
    moved = np.empty_like(points)
    for axis in range(3):
        np.subtract(points[:, axis], origin[axis], out=moved[:, axis])
    return moved


def _forget_first(known: OrderedDict[Any, Any], most: int) -> None:
    """Forget the oldest until there are `most`; other threads may do the same, and be faster."""
    while len(known) > most:
        try:
            known.popitem(last=False)
        except KeyError:
            return


@lru_cache(maxsize=_SHAPES)
def shape_of(file: VehicleFile, mesh_density: float) -> VehicleShape:
    """Return the shape of a file; equal files have one.

    Raises
    ------
    ValueError
        What :func:`birm3d.vehicle.mesher.build_mesh` and :func:`birm3d.vehicle.tire_nodes.build_tread` raise.
    """
    mesh, tread = build_mesh(file, mesh_density), build_tread(file, mesh_density)
    second = build_second(file, mesh)
    parts = (mesh, second, tread)
    none = [np.full(len(part.nodes), -1, np.int64) for part in parts]
    wheels = np.array([[*wheel.center_m, wheel.radius_m] for wheel in file.wheels], float).reshape(-1, 4)
    return VehicleShape(
        nodes=np.concatenate([part.nodes for part in parts]),
        anchors=np.concatenate([part.anchors for part in parts]),
        area=np.concatenate([part.area for part in parts]),
        zone_of_node=np.concatenate([part.zone for part in parts]),
        wheel_of_node=np.concatenate([none[0], none[1], tread.wheel]),
        along_of_node=np.concatenate([none[0], second.of, none[2]]),
        quads=np.array(mesh.quads, np.int64),
        wheels=wheels,
        zone_of_wheel=zones_of_wheels(file),
    )
