"""Reader of surface meshes: STL, OBJ, PLY, OFF, GLB and glTF by trimesh, VTK and others by meshio."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from ...io.file_format import reading
from .keyword_file import KEYWORD_ENDINGS, read_keyword_file
from .raw_mesh import MeshFileError, RawMesh, triangulated

__all__ = ["needed", "read_mesh"]

_TRIMESH = (".stl", ".obj", ".ply", ".off", ".glb", ".gltf")
_MESHIO = (".vtk", ".vtu", ".msh", ".inp", ".nas", ".bdf", ".fem", ".med", ".xdmf", ".e", ".su2")


def needed(module: str) -> Any:
    """Return a module of the extra `mesh`.

    Raises
    ------
    ImportError
        Saying what to install.
    """
    try:
        return import_module(module)
    except ImportError as error:
        raise ImportError(f"from_mesh() needs {module} here: pip install 'birm3d[mesh]'") from error


def read_mesh(path: str | Path) -> RawMesh:
    """Return the triangles of a mesh file, which is known by its ending.

    Raises
    ------
    MeshFileError
        If the ending is unknown, or the file is damaged.
    ImportError
        If what reads it is not installed.
    """
    path = Path(path)
    ending = path.suffix.lower()
    known = (*KEYWORD_ENDINGS, *_TRIMESH, *_MESHIO)
    if ending not in known:
        raise MeshFileError.at(path, None, f"name must end in one of {', '.join(known)}; got {ending!r}")
    if not path.is_file():
        raise MeshFileError.at(path, None, "must be a file, got none there")
    if ending in _TRIMESH:
        needed("trimesh")
    elif ending in _MESHIO:
        needed("meshio")
    with reading(path, "must be a mesh", MeshFileError):
        if ending in KEYWORD_ENDINGS:
            return read_keyword_file(path).checked()
        return (_by_trimesh(path) if ending in _TRIMESH else _by_meshio(path)).checked()


def _by_trimesh(path: Path) -> RawMesh:
    scene = needed("trimesh").load_scene(path, process=False)
    points, triangles, parts, titles = [], [], [], {}
    count = 0
    for number, (name, mesh) in enumerate(_placed(scene), 1):
        points.append(np.asarray(mesh.vertices, float))
        triangles.append(np.asarray(mesh.faces, np.int64) + count)
        parts.append(np.full(len(mesh.faces), number, np.int64))
        titles[number] = str(name)
        count += len(mesh.vertices)
    if not points:
        raise MeshFileError.at(path, None, "must have triangles, got none")
    return RawMesh(path, np.concatenate(points), np.concatenate(triangles), np.concatenate(parts), titles)


def _placed(scene: Any) -> list[tuple[str, Any]]:
    """Return the meshes of a scene with their names, each where the scene has it."""
    found = []
    for node in scene.graph.nodes_geometry:
        place, name = scene.graph[node]
        mesh = scene.geometry[name]
        if hasattr(mesh, "faces"):
            found.append((name, mesh.copy().apply_transform(place)))
    return found


def _by_meshio(path: Path) -> RawMesh:
    try:
        mesh = needed("meshio").read(path)
    except SystemExit as error:  # what meshio does with a damaged file of a kind that it knows
        raise MeshFileError.at(path, None, "must be a mesh, but meshio can not read it") from error
    triangles, parts, titles = [], [], {}
    for number, block in enumerate(mesh.cells, 1):
        if block.type not in ("triangle", "quad"):
            continue
        cells = np.asarray(block.data, np.int64)
        faces = cells if block.type == "triangle" else triangulated(cells)
        triangles.append(faces)
        parts.append(np.full(len(faces), number, np.int64))
        titles[number] = f"{block.type}s, block {number}"
    points = np.asarray(mesh.points, float)
    if not triangles or points.ndim != 2 or points.shape[1] != 3:
        raise MeshFileError.at(path, None, "must have triangles or quadrilaterals in space, got none")
    return RawMesh(path, points, np.concatenate(triangles), np.concatenate(parts), titles)
