"""Runs as glTF 2.0: rigid bodies that move, skins that crush by morph targets; for Blender and browsers."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from .._version import __version__
from ..barrier.surfaces import cylinder
from ..base.arguments import checked
from ..io.atomic_write import whole_file
from ..result.skin import Skin
from ..vehicle.unit_shapes import UnitShape
from .gltf_writer import GltfWriter
from .instants import Instants, instants_of

if TYPE_CHECKING:
    from ..result.result import Result

__all__ = ["write_gltf"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

# glTF has y up: a quarter turn about x.
_Y_UP = (-(0.5**0.5), 0.0, 0.0, 0.5**0.5)
_SKIN, _WHEEL, _BARRIER = (0.86, 0.89, 0.91, 1.0), (0.17, 0.17, 0.17, 1.0), (0.60, 0.58, 0.55, 1.0)
_WHEEL_WIDTH = 0.6  # drawn width over the radius; the model has no width
_DEEP = (0.69, 0.06, 0.10)  # colour of the greatest crush
_LEAST_SCALE = 0.05  # the colours of crush range over this at least, m


@checked
def write_gltf(result: Result, path: str | Path, *, frames: int = 41) -> None:
    """Write a run as one glTF file that Blender, three.js and others play.

    Each unit of the vehicle is a node that moves and turns as the rigid body; its skin crushes by morph
    targets, one for each instant after the first, in body axes. Elements of the barrier are nodes of their
    own; those that stand free move. The skin is coloured by the greatest crush of its nodes. Metres, seconds,
    y up.

    Parameters
    ----------
    result
        Is run once more, unless it has frames.
    path
        Ends in ``.glb`` (binary) or ``.gltf`` (text with all data in it).
    frames
        Number of instants, >= 2; no more than the result's rows are written. Players are linear between them.

    Raises
    ------
    ValueError
        If the path or the number is out of range, or the scene does not run the same way again.
    ImportError
        If pygltflib is not installed.
    """
    path = Path(path)
    if path.suffix.lower() not in (".glb", ".gltf"):
        raise ValueError(f"path must end in .glb or .gltf, got {str(path)!r}")
    writer = GltfWriter(f"BIRM3D {__version__}")
    with whole_file(path) as part:
        run = instants_of(result, frames)
        root = writer.node(result.scene.vehicle.name, rotation=_Y_UP)
        time = writer.times(run.time - run.time[0])
        for unit, shape in enumerate(run.shapes):
            name = "vehicle" if len(run.shapes) == 1 else f"vehicle unit {unit + 1}"
            _unit(writer, root, time, name, shape, [skins[unit] for skins in run.skins])
        _barrier(writer, root, time, run)
        writer.write(part, binary=path.suffix.lower() == ".glb")


def _unit(writer: GltfWriter, root: int, time: int, name: str, shape: UnitShape, skins: list[Skin]) -> None:
    """Add one unit: a node that moves as the rigid body, its skin and wheels below it."""
    from scipy.spatial.transform import Rotation

    centers = np.stack([skin.center for skin in skins])
    quaternions = _continuous(Rotation.from_matrix(np.stack([skin.rotation for skin in skins])).as_quat())
    body = writer.node(name, parent=root, translation=centers[0], rotation=quaternions[0])
    writer.animate(body, "translation", time, centers)
    writer.animate(body, "rotation", time, quaternions)
    if len(shape.quads):
        used, faces = _triangles(shape.quads)
        moved = np.stack([skin.displacement[used] for skin in skins])
        crush = np.linalg.norm(moved, axis=2).max(axis=0)
        colors = _colors(crush)
        # glTF has places at the first instant, and displacements from there for later ones.
        mesh = writer.mesh(
            f"skin of {name}", skins[0].nodes[used], faces, _SKIN, colors=colors, targets=moved[1:] - moved[0]
        )
        node = writer.node(f"skin of {name}", parent=body, mesh=mesh)
        writer.animate(node, "weights", time, np.eye(len(skins))[:, 1:])
    for number, (x, y, z, radius) in enumerate(shape.wheels.tolist(), 1):
        points, faces = cylinder(np.zeros(3), radius, _WHEEL_WIDTH * radius)
        lying = np.stack([points[:, 0], points[:, 2] - 0.5 * _WHEEL_WIDTH * radius, -points[:, 1]], axis=1)
        mesh = writer.mesh(f"wheel {number}", lying + np.array([x, y, z]), faces, _WHEEL)
        writer.node(f"wheel {number} of {name}", parent=body, mesh=mesh)


def _barrier(writer: GltfWriter, root: int, time: int, run: Instants) -> None:
    """Add the elements of the barrier, each with the point that it turns about as the origin."""
    from scipy.spatial.transform import Rotation

    for element, (corners, faces) in enumerate(run.surfaces):
        moves = element < run.motion.movable
        center = run.motion.center[element] if moves else np.zeros(3)
        mesh = writer.mesh(f"barrier {element + 1}", corners - center, faces, _BARRIER)
        node = writer.node(f"barrier {element + 1}", parent=root, mesh=mesh, translation=center)
        if moves:
            turn = Rotation.from_matrix(run.motion.turn[:, element]).as_quat()
            writer.animate(node, "translation", time, center + run.motion.shift[:, element])
            writer.animate(node, "rotation", time, _continuous(turn))


def _triangles(quads: Ints) -> tuple[Ints, Ints]:
    """Return the nodes that elements have, and triangles of numbers among these."""
    second = quads[:, [0, 2, 3]]
    triangles = np.concatenate([quads[:, [0, 1, 2]], second[quads[:, 2] != quads[:, 3]]])
    used, faces = np.unique(triangles, return_inverse=True)
    return used, faces.reshape(-1, 3)


def _colors(crush: Floats) -> Floats:
    share = np.clip(crush / max(_LEAST_SCALE, float(crush.max())), 0.0, 1.0)[:, None]
    return np.asarray((1.0 - share) + share * np.array(_DEEP) / np.array(_SKIN[:3]))


def _continuous(quaternions: Floats) -> Floats:
    """Return quaternions (k, 4) of which each goes the shorter way to the next."""
    signs = np.where(np.einsum("ij,ij->i", quaternions[1:], quaternions[:-1]) < 0.0, -1.0, 1.0)
    return np.asarray(quaternions * np.cumprod(np.append(1.0, signs))[:, None])
