"""Finite-element vehicles for tests: LS-DYNA keyword files made from the skin of a preset."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt
from birm3d import Vehicle

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


def skin_of(vehicle: Vehicle) -> tuple[Floats, Ints]:
    """Points and triangles of a preset's skin, axes of its file [m]; corners at one place are one."""
    nodes = vehicle.nodes[vehicle.is_skin] + vehicle.center_of_mass
    places, which = np.unique(np.round(nodes, 9), axis=0, return_inverse=True)
    quads = which.reshape(-1)[vehicle.quads]
    return places, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def skin_quads(vehicle: Vehicle, finer: int = 1) -> tuple[Floats, Ints]:
    """Nodes and quadrilaterals of a preset's skin, each cut into finer^2; they share no nodes."""
    corners = (vehicle.nodes + vehicle.center_of_mass)[vehicle.quads]
    share = np.arange(finer + 1) / finer
    u, v = (grid.reshape(-1, 1) for grid in np.meshgrid(share, share, indexing="ij"))
    a, b, c, d = (corners[:, None, i] for i in range(4))
    nodes = (1 - u) * (1 - v) * a + u * (1 - v) * b + u * v * c + (1 - u) * v * d
    i, j = (grid.reshape(-1) for grid in np.indices((finer, finer)))
    one = i * (finer + 1) + j
    cell = np.stack([one, one + finer + 1, one + finer + 2, one + 1], axis=1)
    first = (finer + 1) ** 2 * np.arange(len(corners))
    return nodes.reshape(-1, 3), (first[:, None, None] + cell).reshape(-1, 4)


def cylinder(x: float, y: float, radius: float, width: float, n: int = 48) -> tuple[Floats, Ints]:
    """A tyre: tread and both sides, standing on the ground."""
    angle = 2.0 * np.pi * np.arange(n) / n
    ring = np.stack([x + radius * np.cos(angle), np.zeros(n), radius + radius * np.sin(angle)], axis=1)
    sides = [ring + np.array([0.0, y + 0.5 * sign * width, 0.0]) for sign in (-1, 1)]
    middles = np.array([[x, y - 0.5 * width, radius], [x, y + 0.5 * width, radius]])
    i = np.arange(n)
    k = (i + 1) % n
    quads = [np.stack([i, k, n + k, n + i], axis=1)]
    quads += [
        np.stack([s * n + i, s * n + k, np.full(n, 2 * n + s), np.full(n, 2 * n + s)], 1) for s in (0, 1)
    ]
    return np.concatenate([*sides, middles]), np.concatenate(quads)


def box(low: tuple[float, float, float], high: tuple[float, float, float]) -> tuple[Floats, Ints]:
    corners = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    nodes = np.array(low) + corners * (np.array(high) - np.array(low))
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    return nodes, np.array(quads)


def car_parts(preset: str = "passenger_car", finer: int = 1) -> list[tuple[str, Floats, Ints]]:
    """Titles, nodes [m] and quadrilaterals of a vehicle in pieces: skin with holes, engine, seats, tyres.

    Without side windows, and open below the engine.
    """
    car = Vehicle.preset(preset)
    nodes, quads = skin_quads(car, finer)
    middle = nodes[quads].mean(axis=1)
    x, y, z = middle.T
    window = (z > 1.05) & (np.abs(y) > 0.6) & (x < -1.2) & (x > -2.4) & (z < 1.3)
    below_engine = (x > -0.5) & (z < 0.25) & (np.abs(y) < 0.6)
    keep = ~(window | below_engine)
    hood = keep & (x > -0.5) & (z > 0.7)
    wheels = [(w.center_m, w.radius_m, w.width_m) for w in car._file.wheels]
    parts = [
        ("hood outer", nodes, quads[hood]),
        ("body in white", nodes, quads[keep & ~hood]),
        ("engine", *box((0.0, -0.4, 0.3), (0.6, 0.4, 0.75))),
        ("front seat", *box((-1.9, 0.1, 0.3), (-1.4, 0.6, 0.9))),
        ("mirror left", *box((-0.75, 0.95, 0.95), (-0.6, 1.10, 1.05))),
    ]
    parts += [(f"tire {k}", *cylinder(c[0], c[1], r, w)) for k, (c, r, w) in enumerate(wheels)]
    return parts


def write_deck(path: Path, parts: list[tuple[str, Floats, Ints]], unit: float = 1e-3) -> None:
    """Write parts as a keyword file, columns of fixed width; `unit` is its unit of length [m]."""
    lines = ["*KEYWORD", "$ a finite-element vehicle", "*TITLE", "test"]
    nodes, shells, first, element = [], [], 1, 1
    for number, (title, points, quads) in enumerate(parts, 1):
        lines += ["*PART", "$#   title", title, f"{number:10d}{number:10d}{1:10d}"]
        ids = np.arange(first, first + len(points))
        rows = np.column_stack([ids, points / unit]).tolist()
        nodes += [f"{int(a):8d}{x:16.7g}{y:16.7g}{z:16.7g}" for a, x, y, z in rows]
        rows = (quads + first).tolist()
        shells += [
            f"{element + k:8d}{number:8d}{a:8d}{b:8d}{c:8d}{d:8d}" for k, (a, b, c, d) in enumerate(rows)
        ]
        first += len(points)
        element += len(quads)
    lines += ["*NODE", "$    nid               x               y               z", *nodes]
    lines += ["*ELEMENT_SHELL", "$    eid     pid      n1      n2      n3      n4", *shells, "*END", ""]
    path.write_text("\n".join(lines), encoding="ascii")
