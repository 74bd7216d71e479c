"""A vehicle whose skin is a mesh: see :meth:`birm3d.Vehicle.from_mesh`.

Stiffness, rigid core, distribution of mass and tyres are those of the preset of its class, scaled to mass and
size of the mesh. The mesh takes the place of the preset's skin.
"""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ..file_schema import Assumption, Source
from ..inertia import INERTIAS
from ..recipe import VehicleRecipe
from ..skin_mesh import PANELS, SkinMesh, table_of
from ..vehicle_file import VehicleFile
from .class_of import MeshShape, expected_vehicle, file_of, recipe_of, recipe_of_class
from .closed import closed_skin
from .core_fit import core_inside
from .facts import MeshFacts
from .file_blocks import with_core, with_zones
from .labels import labelled
from .mass_solid import mass_of_deck, solid_of
from .placing import in_vehicle_axes
from .raw_mesh import RawMesh
from .remesh import even_mesh, is_even
from .surface_file import read_mesh
from .tires import find_wheels, tire_parts
from .wrap import WheelSpace, cube_size, enclosed, fitted_to, sampled

__all__ = ["recipe_of_mesh"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

_ON_GROUND = 0.03  # m, a mesh that comes so near to the ground has wheels
_FEWEST_NODES, _MOST_NODES = 50, 100_000
_HOUSE = 1.2  # of the wheel's radius: the wheel house


def recipe_of_mesh(facts: MeshFacts, mesh_density: float) -> VehicleRecipe:
    """Return the recipe of the vehicle of a mesh and of what is known beside it."""
    mesh = _selected(read_mesh(facts.path), facts)
    placed = in_vehicle_axes(mesh, facts.unit, facts.forward, facts.up, expected_vehicle(facts).length)
    points = placed.points + np.array([0.0, 0.0, facts.clearance])
    height = placed.height + facts.clearance
    wheels = find_wheels(mesh, placed.points) if facts.clearance == 0.0 else ()
    shape = MeshShape(mesh, points, placed.length, placed.width, height, wheels)
    told: list[str] = []
    wrap = facts.holes == "wrap" or (facts.holes is None and mesh.is_deck)
    if wrap:
        recipe, skin, shift = _around(shape, facts, told)
    else:
        recipe, skin, shift = _as_given(shape, facts, told)
    if facts.use_densities:
        own = mass_of_deck(mesh, points + shift, facts, told)
        facts = dataclasses.replace(facts, center_of_mass=own.center, inertia=own.inertia)
    return _finished(recipe, skin, facts, mesh, told, mesh_density)


def _selected(mesh: RawMesh, facts: MeshFacts) -> RawMesh:
    keep = np.ones(len(mesh.triangles), dtype=bool)
    if facts.parts is not None:
        keep &= np.isin(mesh.part, sorted(mesh.numbers_of("parts", facts.parts)))
    if facts.without_parts:
        keep &= ~np.isin(mesh.part, sorted(mesh.numbers_of("without_parts", facts.without_parts)))
    return mesh if keep.all() else mesh.only(keep).checked()


# ---- the two ways to a skin --------------------------------------------------------------------------------


_Made = tuple[VehicleRecipe, tuple[Floats, Ints], Floats]


def _as_given(shape: MeshShape, facts: MeshFacts, told: list[str]) -> _Made:
    """Return the recipe of the class, the closed mesh with its front at the recipe's, and its shift."""
    mesh = shape.mesh
    points, faces = closed_skin(mesh, shape.points, mesh.triangles, facts.holes or "refuse")
    recipe = recipe_of_class(shape, facts, told)
    file = file_of(recipe)
    if file.wheels and points[:, 2].min() < _ON_GROUND:
        raise mesh.fault(
            f"clearance must say how high the skin is above the ground, got {facts.clearance:g} m. A mesh "
            "with wheels in it needs holes='wrap', which takes them out"
        )
    size = file.exterior.element_size_m if facts.element_size is None else facts.element_size
    shift = np.array([file.extent.front, 0.0, 0.0])
    points = points + shift
    if not is_even(points, faces, size):
        points, faces = even_mesh(points, faces, _count(points, faces, size))
        told.append(f"the skin of the mesh, with {len(points):,} nodes at about {size:.3g} m in its place")
    return recipe, (points, faces), shift


def _around(shape: MeshShape, facts: MeshFacts, told: list[str]) -> _Made:
    """Return the recipe of the class, a closed skin around all parts but the wheels, and their shift."""
    expected = file_of(recipe_of(expected_vehicle(facts))).exterior.element_size_m
    size = facts.element_size or expected * (shape.length / expected_vehicle(facts).length) ** (2.0 / 3.0)
    mesh = shape.mesh
    body = ~np.isin(mesh.part, sorted(tire_parts(mesh))) if shape.wheels else np.ones(len(mesh.part), bool)
    samples = sampled(shape.points, mesh.triangles[body], 0.5 * cube_size(size))
    inside = enclosed(samples, size)
    right, left = inside.sides
    middle, width = 0.5 * (right + left), left - right
    inside = inside.moved(np.array([0.0, -middle, 0.0]))
    wheels = tuple(wheel._replace(y=wheel.y - middle) for wheel in shape.wheels)
    recipe = recipe_of_class(shape._replace(width=width, wheels=wheels), facts, told)
    file = file_of(recipe)
    ahead = file.extent.front
    underside, houses = None, []
    if file.wheels and facts.clearance < _ON_GROUND:
        underside = np.array([(x - ahead, z) for x, _, z, _ in file.exterior.stations_m])
        houses = [_house(file, index, ahead, width) for index in range(len(file.wheels))]
        told.append(
            "what lies below the preset's underside, and wheels, are cut off; wheel houses are filled"
        )
    points, faces = inside.skin(underside, houses)
    points, faces = even_mesh(points, faces, _count(points, faces, size))
    points = fitted_to(points, faces, inside.samples, 2.0 * inside.size)
    told.append(f"a closed skin of {len(points):,} nodes around all parts, at about {size:.3g} m")
    return recipe, (points + np.array([ahead, 0.0, 0.0]), faces), np.array([ahead, -middle, 0.0])


def _house(file: VehicleFile, index: int, ahead: float, width: float) -> WheelSpace:
    wheel = file.wheels[index]
    x, y, _ = wheel.center_m
    room = _HOUSE * wheel.radius_m
    side = 0.5 * width if abs(y) + wheel.width_m > 0.4 * width else abs(y) + 0.5 * wheel.width_m
    inner = max(0.0, abs(y) - wheel.width_m)
    return WheelSpace(
        (x - ahead - room, x - ahead + room), (0.0, wheel.radius_m + room), (inner, 0.985 * side)
    )


def _count(points: Floats, faces: Ints, size: float) -> int:
    a, b, c = (points[faces[:, i]] for i in range(3))
    area = 0.5 * float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())
    count = round(area / size**2)
    if not _FEWEST_NODES <= count <= _MOST_NODES:
        raise ValueError(
            f"element_size must give {_FEWEST_NODES} to {_MOST_NODES:,} nodes on {area:.3g} m^2, got "
            f"{count:,} with {size:g} m"
        )
    return count


# ---- the vehicle -------------------------------------------------------------------------------------------


def _finished(
    recipe: VehicleRecipe,
    skin: tuple[Floats, Ints],
    facts: MeshFacts,
    mesh: RawMesh,
    told: list[str],
    mesh_density: float,
) -> VehicleRecipe:
    """Return the recipe with the mesh as its skin, its own zones, core and mass properties."""
    points, faces = np.round(skin[0], 5), skin[1]
    recipe = with_zones(with_core(recipe, facts.core), facts.zones)
    if facts.center_of_mass is not None or facts.inertia is not None:
        recipe = _with_mass_properties(recipe, facts)
    file = core_inside(file_of(recipe), points, faces, told)
    panel, block = labelled(file, points, faces)
    size = facts.element_size or file.exterior.element_size_m
    name = facts.name or _name_of(facts.path)
    origin = Source(
        id="mesh",
        text=f"Skin from {facts.path.name}: {len(mesh.triangles):,} triangles of {len(np.unique(mesh.part))} "
        f"parts, in {facts.unit}, forward {facts.forward}, up {facts.up}",
        status="published",
    )
    sources = {source.id: source for source in (origin, *_given(facts), *file.sources)}
    exterior = file.exterior.changed(
        {"mesh": _skin_mesh(file, points, faces, panel, block), "element_size_m": size}
    )
    changes: dict[str, Any] = {
        "name": name,
        "title": f"{name.replace('_', ' ').capitalize()} of {facts.mass:,.0f} kg",
        "description": f"Skin from the mesh {facts.path.name}; what a mesh does not say, from {file.title}.",
        "sources": tuple(sources.values()),
        "exterior": exterior.changed({"source": ("mesh",)}),
        **_still_assumed(file, facts, told),
        "targets": (),
        "overhang": None,  # the mesh has the underside
    }
    whole = VehicleFile.model_validate(_as_data(file.changed(changes)))
    return dataclasses.replace(recipe, name=name, file=whole, mesh_density=mesh_density)


def _as_data(file: VehicleFile) -> dict[str, Any]:
    return file.model_dump(by_alias=True)


def _still_assumed(file: VehicleFile, facts: MeshFacts, told: list[str]) -> dict[str, Any]:
    """Return the assumptions and the scatter of the class that the facts of the user leave standing."""
    known = set() if facts.inertia is None else set(INERTIAS)
    if facts.center_of_mass is not None:
        known.add("mass_center_height")
    kept = [one for one in file.assumptions if one.name not in known]
    gone = {one.name for one in file.assumptions} & known
    return {
        "assumptions": (*kept, *(Assumption(quantity="mesh", text=text) for text in told)),
        "scatter": tuple(one for one in file.scatter if one.name not in gone),
    }


def _given(facts: MeshFacts) -> tuple[Source, ...]:
    text = f"Stated by who made the vehicle of {facts.path.name}"
    return (Source(id="given", text=text, status="estimated"),)


def _skin_mesh(file: VehicleFile, points: Floats, faces: Ints, panel: Ints, block: Ints) -> SkinMesh:
    names = file.exterior.blocks
    rows = zip(faces.tolist(), panel.tolist(), block.tolist(), strict=True)
    lines = "".join(f"{a} {b} {c} {PANELS[p]} {names[k]}\n" for (a, b, c), p, k in rows)
    return SkinMesh(points_m=table_of(points), triangles=f"\n{lines}")


def _with_mass_properties(recipe: VehicleRecipe, facts: MeshFacts) -> VehicleRecipe:
    center, inertia = recipe.mass_properties()
    center = center if facts.center_of_mass is None else facts.center_of_mass
    inertia = inertia if facts.inertia is None else facts.inertia
    file = file_of(recipe)
    extent = file.extent
    if not (extent.rear < center[0] < extent.front and 0.0 < center[2] < extent.top):
        limit = f"x in {extent.rear:.3g} to {extent.front:.3g} m and z in 0 to {extent.top:.3g} m"
        raise ValueError(f"center_of_mass must be inside the vehicle, {limit}; got {center.tolist()}")
    file = file.changed({"solids": (solid_of(facts.mass, center, inertia),), "gvw_kg": facts.mass})
    if file.zones_at_kg is None:
        file = file.changed({"zones_at_kg": file_of(recipe).gvw_kg})
    return dataclasses.replace(
        recipe, file=file, mass=facts.mass, mass_center_height=None, spread=None, load_density=None
    )


def _name_of(path: Path) -> str:
    words = "".join(letter if letter.isalnum() and letter.isascii() else "_" for letter in path.stem.lower())
    return words if words[:1].isalpha() else f"vehicle_{words}"
