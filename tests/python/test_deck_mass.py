"""Mass centre and inertia by the densities of a keyword file: boxes, tetrahedra, cards, refusals."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from birm3d import Vehicle
from birm3d.io.file_format import FileFormatError
from birm3d.vehicle.mesh_import.deck_mass import lumps_of_solids
from birm3d.vehicle.mesh_import.surface_file import read_mesh
from keyword_decks import box, car_parts, write_deck

STEEL = 7.89e-9  # t/mm^3
FACTS = {"mass": 1700.0, "kind": "car", "unit": "mm", "use_densities": True, "element_size": 0.2}
THICKNESS = {1: 0.8, 2: 1.1, 3: 9.0, 4: 2.0, 5: 0.5}  # mm, by part; tyres have their own material


def cards(*lines: str) -> str:
    return "\n".join(lines) + "\n"


def with_masses(path: Path, extra: str = "") -> Path:
    """A car in pieces in mm, with sheets of steel, tyres of rubber."""
    parts = car_parts(finer=1)
    write_deck(path, parts)
    text = path.read_text(encoding="ascii").removesuffix("*END\n")
    for number in range(1, len(parts) + 1):
        sheet = THICKNESS.get(number, 12.0)
        text += cards("*SECTION_SHELL", f"{number:10d}{2:10d}", 4 * f"{sheet:10.3f}")
    text += cards("*MAT_ELASTIC_TITLE", "steel", f"{1:10d}{STEEL:10.3e}{2.1e5:10.3g}")
    path.write_text(f"{text}{extra}*END\n", encoding="ascii")
    return path


def expected(extra: list[tuple[np.ndarray, float]]) -> tuple[np.ndarray, np.ndarray, float]:
    """Mass centre and inertia of all sheets, a triangle at a time, SI, axes of the preset's file."""
    points, masses = [], []
    for number, (_, nodes, quads) in enumerate(car_parts(finer=1), 1):
        for i, j, k in ((0, 1, 2), (0, 2, 3)):
            a, b, c = (nodes[quads[:, m]] for m in (i, j, k))
            sheet = THICKNESS.get(number, 12.0) * 1e-3
            area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
            points.append((a + b + c) / 3.0)
            masses.append(7890.0 * sheet * area)
    for place, mass in extra:
        points.append(place[None])
        masses.append(np.array([mass]))
    where, mass = np.concatenate(points), np.concatenate(masses)
    center = mass @ where / mass.sum()
    x, y, z = (where - center).T
    products = [[mass @ (p * q) for q in (x, y, z)] for p in (x, y, z)]
    return center, np.trace(products) * np.eye(3) - np.array(products), float(mass.sum())


@pytest.mark.parametrize("added", [False, True])
def test_mass_properties_are_those_of_the_sheets(tmp_path: Path, added: bool) -> None:
    extra, lumps = "", []
    if added:  # 0.3 t at a node of the engine
        parts = car_parts(finer=1)
        node = 1 + sum(len(one[1]) for one in parts[:2])
        extra = cards("*ELEMENT_MASS", f"{900001:8d}{node:8d}{0.3:16.6f}{3:8d}")
        lumps = [(parts[2][1][0], 300.0)]
    deck = with_masses(tmp_path / "car.k", extra)
    car = Vehicle.from_mesh(deck, **FACTS)
    center, inertia, total = expected(lumps)
    mesh = read_mesh(deck)
    assert mesh.mass is not None
    assert mesh.mass.lumps().properties()[0] * 1e3 == pytest.approx(total, rel=1e-4)  # t
    # The front of both is the same place: the mesh keeps its distances from it.
    front = max(float(one[1][:, 0].max()) for one in car_parts(finer=1))
    ahead = float((car.nodes[car.is_skin] + car.center_of_mass)[:, 0].max())
    assert car.center_of_mass[0] - ahead == pytest.approx(center[0] - front, abs=0.02)
    assert car.center_of_mass[2] == pytest.approx(center[2], abs=0.02)
    assert car.inertia == pytest.approx(inertia * 1700.0 / total, rel=2e-3, abs=2e-3 * inertia.max())
    assert car.mass == pytest.approx(1700.0)
    (told,) = [one.text for one in car.assumptions if "densities" in one.text]
    assert "brought to 1,700 kg" in told


def test_axes_of_the_file_do_not_matter(tmp_path: Path) -> None:
    """The tail ahead: the mass centre goes with the vehicle, not with the file."""
    deck = with_masses(tmp_path / "car.k")
    one, other = (Vehicle.from_mesh(deck, forward=axis, **FACTS) for axis in ("+x", "-x"))
    ends = [
        float((car.nodes[car.is_skin] + car.center_of_mass)[:, 0].max()) - car.center_of_mass[0]
        for car in (one, other)
    ]
    assert sum(ends) == pytest.approx(one.length, abs=0.05)
    assert other.inertia[2, 2] == pytest.approx(one.inertia[2, 2], rel=1e-9)
    assert other.inertia[0, 2] == pytest.approx(-one.inertia[0, 2], rel=1e-9)


def test_solids_have_their_volume_and_centroid() -> None:
    """A turned brick, a wedge, a tetrahedron with repeated corners, as the manual orders them."""
    brick, _ = box((0.0, 0.0, 0.0), (2.0, 3.0, 4.0))
    order = [0, 4, 6, 2, 1, 5, 7, 3]
    a = 0.3
    turn = np.array([[np.cos(a), -np.sin(a), 0.0], [np.sin(a), np.cos(a), 0.0], [0.0, 0.0, 1.0]])
    tetrahedron = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    wedge = np.array([[0.0, 0, 0], [2, 0, 0], [2, 3, 0], [0, 3, 0], [0, 0, 4], [0, 3, 4]])
    centers, volumes = lumps_of_solids(
        np.array(
            [brick[order] @ turn.T, tetrahedron[[0, 1, 2, 3, 3, 3, 3, 3]], wedge[[0, 1, 2, 3, 4, 4, 5, 5]]]
        )
    )
    assert volumes == pytest.approx([24.0, 1.0 / 6.0, 12.0])
    assert centers[0] == pytest.approx(turn @ [1.0, 1.5, 2.0])
    assert centers[1] == pytest.approx([0.25, 0.25, 0.25])
    assert centers[2] == pytest.approx([2.0 / 3.0, 1.5, 4.0 / 3.0])


def test_cards_of_parts(tmp_path: Path) -> None:
    """Densities in free format, thickness of an element, masses of whole parts, what has none."""
    nodes = "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n"
    text = (
        f"*KEYWORD\n{nodes}"
        "*ELEMENT_SHELL\n1,1,1,2,3,4\n2,2,1,2,3,4\n3,5,5,6,7,8\n"
        "*ELEMENT_SHELL_THICKNESS\n" + f"{4:8d}{1:8d}{5:8d}{6:8d}{7:8d}{8:8d}\n" + 4 * f"{0.5:16.3f}" + "\n"
        "*ELEMENT_SOLID\n10,3,1,2,3,4,5,6,7,8\n11,4,1,2,3,4,5,6,7,8\n"
        "*PART\none\n1,1,1\ntwo\n2,1,2\nthree\n3,9,1\n"
        "*PART_INERTIA\nfour\n4,9,1\n0.5,0.5,0.5,77.0\n1,0,0,1,0,1\n"
        "*SECTION_SHELL_TITLE\nsheet\n1,2\n0.1,0.1,0.1,0.1\n"
        "*MAT_ELASTIC\n1,10.0,1.0\n*MAT_SPRING_ELASTIC\n2,99.0\n"
        "*ELEMENT_MASS_PART\n" + f"{3:8d}{2.5:16.3f}\n*END\n"
    )
    (tmp_path / "m.k").write_text(text, encoding="ascii")
    mesh = read_mesh(tmp_path / "m.k")
    assert mesh.mass is not None
    lumps = mesh.mass.lumps()
    found = {n: float(lumps.mass[lumps.part == n].sum()) for n in (1, 3, 4)}
    assert found == pytest.approx({1: 10.0 * 0.1 + 10.0 * 0.5, 3: 10.0 + 2.5, 4: 77.0})
    assert lumps.silent == (2, 5)  # a spring's card has no density; part 5 has no card
    assert lumps.of_parts(np.array([1, 2])).silent == (2,)


def test_refused(tmp_path: Path) -> None:
    write_deck(tmp_path / "bare.k", car_parts(finer=1))
    with pytest.raises(FileFormatError, match=r"use_densities must be False for a mesh without densities"):
        Vehicle.from_mesh(tmp_path / "bare.k", **FACTS)
    wrong = with_masses(tmp_path / "wrong.k", "*MAT_ELASTIC\n         2    steely\n")
    with pytest.raises(FileFormatError, match=r"wrong.k: densities and thicknesses must be numbers"):
        Vehicle.from_mesh(wrong, **FACTS)
    with pytest.raises(ValueError, match="use_densities must be False where inertia is given"):
        Vehicle.from_mesh(wrong, **FACTS, inertia=[1.0, 2.0, 2.0])
