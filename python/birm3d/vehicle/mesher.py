"""Mesh of a vehicle's exterior shell: four-node elements and one truss per node (paper §4.1).

A lattice i (front to rear), j (right to left), k (up) is laid through the body and through each upper block
on it. The outer faces of the lattices are the shell. Body and upper blocks share the nodes where they meet,
so the shell is closed.

Every element belongs to one zone. A node on the border of two zones is repeated, once for each, with the area
of that zone's elements. So a truss has one law, and the stiffness of a zone does not depend on the mesh.
"""

# Longer than 300 lines: one mesher, from sections to elements.
from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .skin_mesh import PANELS, SkinSurface
from .vehicle_file import CoreBox, End, Upper, VehicleFile, Zone

__all__ = ["ExteriorMesh", "build_mesh", "match_zones", "winding_number"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

_DENSITY = (0.01, 100.0)  # a handful of elements ... a million; outside it is a mistake in units
_SAME = 1e-9  # m, positions along the body closer than this are one column of nodes


@dataclass(frozen=True, eq=False)
class ExteriorMesh:
    """Exterior shell and its trusses: SI units, file axes (x forward, y left, z up), read-only arrays.

    Attributes
    ----------
    nodes
        Position of the shell nodes, (n, 3) m.
    anchors
        Point of the rigid core that the node's truss starts from, (n, 3) m.
    quads
        Nodes of the elements, counter-clockwise seen from outside, (m, 4).
    area
        Tributary area of the nodes, (n,) m^2.
    zone
        Zone of the nodes, index into zone_names, (n,). The four nodes of an element share one zone.
    zone_names
        Names of the zones.
    """

    nodes: Floats
    anchors: Floats
    quads: Ints
    area: Floats
    zone: Ints
    zone_names: tuple[str, ...]

    def __post_init__(self) -> None:
        for array in (self.nodes, self.anchors, self.quads, self.area, self.zone):
            array.setflags(write=False)


def build_mesh(vehicle_file: VehicleFile, density: float = 1.0) -> ExteriorMesh:
    """Mesh the exterior of a vehicle.

    Parameters
    ----------
    vehicle_file
        The vehicle, as read from its file.
    density
        Number of elements relative to the vehicle's own element size, 0.01 to 100.

    Raises
    ------
    ValueError
        If density is out of range, an element belongs to no zone, or the core leaves the exterior.
    """
    low, high = _DENSITY
    if not low <= density <= high:
        raise ValueError(f"mesh_density must be between {low:g} and {high:g}, got {density!r}")
    exterior = vehicle_file.exterior
    surface: _Surface | SkinSurface
    if exterior.mesh is None:
        surface = _Surface(vehicle_file, density)
    else:
        surface = exterior.mesh.surface(exterior.blocks, density)
    quad_zone = _zones_of_quads(vehicle_file, surface)
    nodes, quads, zone = _split_at_zone_borders(surface.points, surface.quads, quad_zone)
    area = node_areas(nodes, quads)
    anchors = np.empty_like(nodes)
    for index, law in enumerate(vehicle_file.zones):
        anchors[zone == index] = _closest(nodes[zone == index], _boxes(vehicle_file, law))
    _check_core(vehicle_file, nodes, quads, anchors)
    return ExteriorMesh(nodes, anchors, quads, area, zone, vehicle_file.zone_names)


def node_areas(nodes: Floats, quads: Ints) -> Floats:
    """Tributary areas of the nodes: each has its share of its elements, (n,) m^2."""
    area = np.zeros(len(nodes))
    triangle = quads[:, 2:3] == quads[:, 3:]  # its last corner is there twice
    shares = np.where(triangle, np.array([2.0, 2.0, 1.0, 1.0]) / 6.0, 0.25)
    np.add.at(area, quads, quad_areas(nodes, quads)[:, None] * shares)
    return area


def quad_areas(nodes: Floats, quads: Ints) -> Floats:
    """Areas of elements as the sum of the triangles 0-1-2 and 0-2-3, (m,) m^2."""
    a, b, c, d = (nodes[quads[:, corner]] for corner in range(4))
    triangles = np.cross(b - a, c - a), np.cross(c - a, d - a)
    return np.asarray(sum(0.5 * np.linalg.norm(t, axis=1) for t in triangles))


class _Surface:
    """The shell before it is cut into zones: points, quads, and the panel and block of every quad."""

    def __init__(self, vehicle: VehicleFile, density: float) -> None:
        shell = vehicle.exterior
        self._shell = shell
        self._size = shell.element_size_m / math.sqrt(density)
        self._stations = np.array(shell.stations_m)
        self._overhang = vehicle.overhang
        self._x, marks = self._columns(vehicle)
        self._eta = self._across(vehicle)
        self._zeta = self._rows(vehicle)

        shape = (len(self._x), len(self._eta), len(self._zeta))
        size = math.prod(shape)  # nodes numbered so far, most of them inside and never made
        lattices: list[Ints] = [np.arange(size, dtype=np.int64).reshape(shape)]
        points: list[Floats] = []
        covered = np.zeros(shape[0] - 1, dtype=bool)  # parts of the body's top that carry an upper block
        for upper in shell.upper:
            first, last = (marks[_key(x)] for x in upper.base_x_m)
            block = self._upper(upper, first, last)
            ids = np.arange(size, size + block[..., 0].size, dtype=np.int64).reshape(block.shape[:3])
            size += ids.size
            ids[:, :, 0] = lattices[0][first : last + 1, :, -1]  # it stands on the body's upper edge
            points.append(block.reshape(-1, 3))
            lattices.append(ids)
            covered[first:last] = True

        quads: list[Ints] = []
        origin: list[tuple[int, int]] = []
        for block_index, lattice in enumerate(lattices):
            for panel, name in enumerate(PANELS):
                if name == "bottom" and block_index > 0:
                    continue
                face = _face(name, lattice)
                if name == "top" and block_index == 0:
                    face = face[~covered]
                quads.append(face.reshape(-1, 4))
                origin.append((panel, block_index))
        used, renumbered = np.unique(np.concatenate(quads), return_inverse=True)
        on_body = used[used < lattices[0].size]
        body = self._body(*np.unravel_index(on_body, shape))
        above = np.concatenate([np.empty((0, 3)), *points])[used[len(on_body) :] - lattices[0].size]
        self.points = np.concatenate([body, above])
        self.quads = renumbered.reshape(-1, 4)
        self.panel, self.block = np.repeat(np.array(origin), [len(part) for part in quads], axis=0).T

    def _columns(self, vehicle: VehicleFile) -> tuple[Floats, dict[int, int]]:
        """Positions x of the columns of nodes, falling, and the index of the marked ones."""
        ends = self._stations[0, 0], self._stations[-1, 0]
        marks = {_key(x): x for upper in self._shell.upper for x in upper.base_x_m}
        marks.update((_key(x), x) for zone in vehicle.zones for x in zone.x_m or ())
        marks = {key: x for key, x in marks.items() if ends[1] < x < ends[0]}
        marks.update((_key(x), x) for x in ends)
        x, index = _divide(np.array(sorted(marks.values(), reverse=True)), self._size)
        return x, {_key(x[i]): int(i) for i in index}

    def _across(self, vehicle: VehicleFile) -> Floats:
        """Positions across the body, -1 (right) to 1 (left): exactly symmetric, one on the centre line.

        Nodes stand where zones of the front meet.
        """
        half_width = float(self._stations[:, 1].max())
        at_front = float(self._stations[0, 1])
        cuts = {y for zone in vehicle.zones if "front" in zone.panels for y in zone.y_m or ()}
        marks = [0.0, *sorted(y / at_front for y in cuts if 0.0 < y < at_front), 1.0]
        if len(marks) == 2:
            half = max(1, round(half_width / self._size))
            return np.arange(-half, half + 1) / half
        left = _divide(np.array(marks) * half_width, self._size)[0] / half_width
        return np.concatenate([-left[:0:-1], left])

    def _rows(self, vehicle: VehicleFile) -> Floats:
        """Positions up the body, 0 (underside) to 1 (upper edge), a row where zones of the front meet."""
        bottom, top = self._stations[0, 2:]
        cuts = {z for zone in vehicle.zones if "front" in zone.panels for z in zone.z_m or ()}
        marks = [0.0, *sorted((z - bottom) / (top - bottom) for z in cuts if bottom < z < top), 1.0]
        x, _, low, high = self._stations.T
        middle = 0.5 * ((high - low)[1:] + (high - low)[:-1])
        height = float(np.sum(middle * np.diff(x)) / (x[-1] - x[0]))
        return _divide(np.array(marks) * height, self._size)[0] / height

    def _body(self, i: Ints, j: Ints, k: Ints) -> Floats:
        """Points of the body's lattice, (..., 3) m."""
        xs = self._stations[::-1, 0]
        half_width, bottom, top = (
            np.interp(self._x, xs, self._stations[::-1, column])[i] for column in (1, 2, 3)
        )
        eta, zeta = self._eta[j], self._zeta[k]
        x = self._x[i]
        if (over := self._overhang) is not None:
            out = (np.abs(eta * half_width) > over.beyond_y_m) & (over.x_m[0] <= x) & (x < over.x_m[1])
            bottom = np.where(out, over.z_m, bottom)
        x_front, x_rear = self._stations[0, 0], self._stations[-1, 0]
        front = _setback(self._shell.front, self._stations[0], eta, zeta)
        rear = _setback(self._shell.rear, self._stations[-1], eta, zeta)
        x = x - front * np.maximum(0.0, 1.0 - (x_front - x) / self._shell.front.blend_m)
        x = x + rear * np.maximum(0.0, 1.0 - (x - x_rear) / self._shell.rear.blend_m)
        return np.stack([x, eta * half_width, bottom + zeta * (top - bottom)], axis=-1)

    def _upper(self, upper: Upper, first: int, last: int) -> Floats:
        """Points of an upper block's lattice, (i, j, k, 3) m: straight from the body's edge to the roof."""
        roof = np.array(upper.roof_m)
        i, j = np.indices((last - first + 1, len(self._eta)))
        base = self._body(i + first, j, np.full_like(i, len(self._zeta) - 1))
        x0, x1 = self._x[first], self._x[last]
        share = (x0 - self._x[first : last + 1]) / (x0 - x1)
        x = roof[0, 0] + share * (roof[-1, 0] - roof[0, 0])
        half_width, z = (np.interp(x, roof[::-1, 0], roof[::-1, column])[i] for column in (1, 2))
        top = np.stack([x[i], self._eta[j] * half_width, z], axis=-1)
        height = float(np.linalg.norm(top - base, axis=-1).mean())
        rows = max(1, round(height / self._size))
        t = (np.arange(rows + 1) / rows)[:, None]
        return base[:, :, None] * (1.0 - t) + top[:, :, None] * t


def _key(x: float) -> int:
    return round(x / _SAME)


def _divide(marks: Floats, size: float) -> tuple[Floats, Ints]:
    """Divide the intervals between marks into near-equal parts of about a size; also the marks' indices."""
    counts = np.maximum(1, np.rint(np.abs(np.diff(marks)) / size)).astype(np.int64)
    parts = [np.linspace(a, b, n, endpoint=False) for a, b, n in zip(marks, marks[1:], counts, strict=False)]
    return np.append(np.concatenate(parts), marks[-1]), np.append(0, np.cumsum(counts))


def _setback(end: End, station: Floats, eta: Floats, zeta: Floats) -> Floats:
    """How far the end of the body lies behind its outermost point, m."""
    setback = end.bow_m * eta**2
    if end.profile_m:
        z, depth = np.array(end.profile_m).T
        setback = setback + np.interp(station[2] + zeta * (station[3] - station[2]), z, depth)
    return np.asarray(setback)


def _face(name: str, ids: Ints) -> Ints:
    """Quads (..., 4) of one face of a lattice of node numbers (i, j, k), counter-clockwise from outside.

    x falls with i, y grows with j, z with k. A quad is split along its corners 0 and 2; for the split to be
    the mirror image on the other side of the vehicle, quads on the right start at another corner.
    """
    if name == "side":
        left, right = _cells(ids[:, -1]), np.roll(_cells(ids[:, 0])[..., ::-1], 1, axis=-1)
        return np.concatenate([left, right])
    if name in ("front", "rear"):
        quads = _cells(ids[0] if name == "front" else ids[-1])
        across = np.arange(quads.shape[0])[:, None, None]
    else:
        quads = _cells(ids[:, :, -1 if name == "top" else 0])[..., ::-1]
        across = np.arange(quads.shape[1])[None, :, None]
    if name in ("rear", "bottom"):
        quads = quads[..., ::-1]
    right_side = across < (ids.shape[1] - 1) // 2
    return np.where(right_side, np.roll(quads, 1, axis=-1), quads)


def _cells(ids: Ints) -> Ints:
    """Cells (a, b, 4) of a sheet of node numbers, in the sense that turns its first axis into its second."""
    return np.stack([ids[:-1, :-1], ids[1:, :-1], ids[1:, 1:], ids[:-1, 1:]], axis=-1)


def _zones_of_quads(vehicle: VehicleFile, surface: _Surface | SkinSurface) -> Ints:
    """Zone of every element: the first one whose panels, blocks and ranges hold its middle."""
    middle = surface.points[surface.quads].mean(axis=1)
    zone = match_zones(vehicle, middle, surface.panel, surface.block)
    if (missing := np.flatnonzero(zone < 0)).size:
        quad = missing[0]
        where = f"{PANELS[surface.panel[quad]]} of {vehicle.exterior.blocks[surface.block[quad]]}"
        at = ", ".join(f"{value:.3f}" for value in middle[quad])
        raise ValueError(
            f"zone: every element of the exterior must belong to a zone of '{vehicle.name}'; "
            f"{missing.size} do not, the first at ({at}) m, {where}"
        )
    return zone


def match_zones(vehicle: VehicleFile, middle: Floats, panel: Ints, block: Ints) -> Ints:
    """Return the zone of elements with middles (m, 3) [m], panels and blocks (m,); -1 where none matches."""
    names = vehicle.exterior.blocks
    zone = np.full(len(middle), -1, dtype=np.int64)
    for index, law in enumerate(vehicle.zones):
        match = np.isin(panel, [PANELS.index(one) for one in law.panels if one != "tire"])
        if law.blocks:
            match &= np.isin(block, [names.index(one) for one in law.blocks])
        beside = np.abs(middle[:, 1])
        for place, limits in ((middle[:, 0], law.x_m), (beside, law.y_m), (middle[:, 2], law.z_m)):
            if limits is not None:
                match &= (limits[0] <= place) & (place <= limits[1])
        zone[match & (zone < 0)] = index
    return zone


def _split_at_zone_borders(points: Floats, quads: Ints, quad_zone: Ints) -> tuple[Floats, Ints, Ints]:
    """Nodes (n, 3), quads (m, 4) and the zone of the nodes (n,): one node per point and zone."""
    n_zones = int(quad_zone.max()) + 1
    pairs, index = np.unique(quads * n_zones + quad_zone[:, None], return_inverse=True)
    return points[pairs // n_zones], index.reshape(quads.shape), pairs % n_zones


def _boxes(vehicle: VehicleFile, zone: Zone) -> list[CoreBox]:
    return [box for box in vehicle.core if not zone.core or box.name in zone.core]


def _closest(points: Floats, boxes: list[CoreBox]) -> Floats:
    """Point of the nearest box closest to each point, (n, 3) m."""
    candidates = []
    for box in boxes:
        low = np.array([box.x_m[0], -box.half_width_m, box.z_m[0]])
        high = np.array([box.x_m[1], box.half_width_m, box.z_m[1]])
        candidates.append(np.clip(points, low, high))
    stack = np.stack(candidates)
    nearest = np.argmin(np.linalg.norm(stack - points, axis=-1), axis=0)
    return np.asarray(stack[nearest, np.arange(len(points))])


def _check_core(vehicle: VehicleFile, nodes: Floats, quads: Ints, anchors: Floats) -> None:
    """Require every truss to have a length and every core box to lie inside the shell."""
    if (short := np.flatnonzero((nodes == anchors).all(axis=1))).size:
        at = ", ".join(f"{value:.3f}" for value in nodes[short[0]])
        raise ValueError(f"core: '{vehicle.name}' reaches the exterior at ({at}) m; it must lie inside")
    sides = [(box.x_m, (-box.half_width_m, box.half_width_m), box.z_m) for box in vehicle.core]
    corners = np.array([corner for box in sides for corner in itertools.product(*box)])
    for row in np.flatnonzero(winding_number(corners, nodes, quads) < 0.5):
        at = ", ".join(f"{value:.3f}" for value in corners[row])
        name = vehicle.core[row // 8].name  # a box has eight corners
        raise ValueError(
            f"core.{name}: must lie inside the exterior of '{vehicle.name}', got corner ({at}) m"
        )


def winding_number(points: Floats, nodes: Floats, quads: Ints) -> Floats:
    """How often the closed shell goes around each point: 1 inside, 0 outside, (p,).

    Sum of the solid angles of the triangles (van Oosterom and Strackee 1983) over 4 pi.
    """
    corners = np.concatenate([quads[:, :3], quads[:, [0, 2, 3]]]).T
    a, b, c = nodes[corners]
    # For corners u and v: (u - p) . (v - p) = u . v - (u + v) . p + p . p. Only p differs between points.
    # Likewise (a - p) . ((b - p) x (c - p)) = a . (b x c) - (a x b + b x c + c x a) . p.
    products = [(np.einsum("ij,ij->i", u, v), u + v) for u, v in ((b, c), (c, a), (a, b))]
    normal = np.cross(a, b) + np.cross(b, c) + np.cross(c, a)
    volume = np.einsum("ij,ij->i", a, np.cross(b, c))
    result = np.empty(len(points))
    for row, p in enumerate(points):
        distance = np.sqrt(((nodes - p) ** 2).sum(axis=1))
        la, lb, lc = distance[corners]
        bc, ca, ab = (product - both @ p + p @ p for product, both in products)
        angle = np.arctan2(volume - normal @ p, la * lb * lc + ab * lc + bc * la + ca * lb)
        result[row] = angle.sum() / (2.0 * math.pi)
    return result
