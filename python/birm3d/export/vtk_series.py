"""Series of VTK files that ParaView opens: a .pvd with the instants, a folder with a .vtp for each part."""

from __future__ import annotations

import shutil
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree

import numpy as np
import numpy.typing as npt

from ..base.arguments import checked
from ..io.atomic_write import whole_file
from .instants import Instants, instants_of, truss_forces

if TYPE_CHECKING:
    from ..result.result import Result

__all__ = ["write_vtk"]

Floats = npt.NDArray[np.float64]

_WHEEL_WIDTH = 0.6  # of the radius; drawn, not modelled


@checked
def write_vtk(result: Result, path: str | Path, *, frames: int = 101) -> None:
    """Write a run as a series that ParaView opens: vehicle and barrier over time.

    ``crash.pvd`` lists the instants [s]; the folder ``crash`` beside it has a ``.vtp`` for each part and
    instant. World axes, SI. The skin has data at its nodes: ``crush`` (distance from the uncrushed place
    [m]), ``displacement`` (the same as a vector, world axes [m]), ``truss_force`` [N] and ``contact``. That
    is 1 where the truss carries a force: something holds its node. Elements have their ``zone``.

    Parameters
    ----------
    result
        Is run once more.
    path
        Ends in ``.pvd``; in a folder that exists. Files of an earlier series of this name are replaced.
    frames
        Number of instants, >= 2; no more than the result's rows are written.

    Raises
    ------
    ValueError
        If the path or the number is out of range, or the scene does not run the same way again.
    ImportError
        If pyvista is not installed.
    """
    path = Path(path)
    if path.suffix.lower() != ".pvd":
        raise ValueError(f"path must end in .pvd, got {str(path)!r}")
    folder = path.with_suffix("")
    if folder.exists() and not folder.is_dir():
        raise ValueError(f"path must leave room for a folder {folder.name!r}, got a file of that name")
    pyvista = _pyvista()
    with whole_file(path) as part:
        run = instants_of(result, frames)
        forces = truss_forces(result, run.time)
        root = ElementTree.Element("VTKFile", type="Collection", version="0.1", byte_order="LittleEndian")
        listed = ElementTree.SubElement(root, "Collection")
        with tempfile.TemporaryDirectory(dir=path.parent, prefix=".birm3d-") as made:
            for k, time in enumerate(run.time.tolist()):
                for number, (name, mesh) in enumerate(_parts(pyvista, run, forces[k], k)):
                    file = f"{name}_{k:04d}.vtp"
                    mesh.save(Path(made) / file)
                    place = f"{folder.name}/{file}"
                    entry = {"timestep": f"{time:.9g}", "group": name, "part": str(number), "file": place}
                    ElementTree.SubElement(listed, "DataSet", entry)
            _replace(Path(made), folder)
        ElementTree.indent(root)
        ElementTree.ElementTree(root).write(part, encoding="utf-8", xml_declaration=True)


def _pyvista() -> Any:
    try:
        import pyvista
    except ImportError as error:
        raise ImportError("write_vtk() needs pyvista: pip install 'birm3d[export]'") from error
    return pyvista


def _replace(made: Path, folder: Path) -> None:
    """Put the files that were made into the folder, in the place of those of an earlier series."""
    folder.mkdir(exist_ok=True)
    for old in folder.glob("*_[0-9][0-9][0-9][0-9].vtp"):
        old.unlink()
    for file in made.iterdir():
        shutil.move(file, folder / file.name)


def _parts(pyvista: Any, run: Instants, forces: tuple[Floats, ...], k: int) -> list[tuple[str, Any]]:
    """Return names and meshes of all parts at an instant."""
    found = []
    for unit, (shape, skin) in enumerate(zip(run.shapes, run.skins[k], strict=True)):
        name = "vehicle" if len(run.shapes) == 1 else f"vehicle_unit_{unit + 1}"
        if len(shape.quads):
            n = int(shape.quads.max()) + 1  # further nodes belong to second trusses and to treads
            mesh = pyvista.PolyData(skin.world[:n], _polygons(shape.quads))
            mesh.cell_data["zone"] = shape.zone_of_node[shape.quads[:, 0]]
        else:
            n = len(shape.nodes)
            mesh = pyvista.PolyData(skin.world)
        mesh.point_data["crush"] = skin.crush[:n]
        mesh.point_data["displacement"] = skin.displacement[:n] @ skin.rotation.T
        mesh.point_data["truss_force"] = forces[unit][:n]
        mesh.point_data["contact"] = (forces[unit][:n] > 0.0).astype(np.uint8)
        found.append((name, mesh))
        if len(shape.wheels):
            found.append((f"wheels_{unit + 1}", _wheels(pyvista, shape.wheels, skin.center, skin.rotation)))
    if run.surfaces:
        count = [len(corners) for corners, _ in run.surfaces]
        first = np.cumsum([0, *count[:-1]])
        corners = np.vstack([run.surface_at(k, i) for i in range(len(run.surfaces))])
        faces = [faces + start for (_, faces), start in zip(run.surfaces, first.tolist(), strict=True)]
        barrier = pyvista.PolyData(corners, _polygons(np.vstack(faces)))
        barrier.cell_data["element"] = np.repeat(np.arange(len(faces)), [len(one) for one in faces])
        found.append(("barrier", barrier))
    return found


def _polygons(corners: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
    """Return faces (m, k) as VTK has them; of quadrilaterals that repeat a corner, triangles."""
    if corners.shape[1] == 4 and (corners[:, 2] == corners[:, 3]).all():
        corners = corners[:, :3]
    return np.column_stack([np.full(len(corners), corners.shape[1]), corners]).reshape(-1)


def _wheels(pyvista: Any, wheels: Floats, center: Floats, rotation: Floats) -> Any:
    shapes = []
    for x, y, z, radius in wheels.tolist():
        size = {"radius": radius, "height": _WHEEL_WIDTH * radius, "resolution": 36}
        shapes.append(pyvista.Cylinder(center=(x, y, z), direction=(0.0, 1.0, 0.0), **size))
    mesh = pyvista.merge(shapes).extract_surface(algorithm=None) if len(shapes) > 1 else shapes[0]
    mesh.points = center + np.asarray(mesh.points, float) @ rotation.T
    mesh.clear_data()
    return mesh
